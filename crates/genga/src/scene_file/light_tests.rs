//! Lights on nodes, skies, and edited shading in assembled scenes.

use glam::{Quat, Vec3};

use super::tests::{assemble, near, read};
use crate::scene::{LightKind, Proxy};

/// Where the model's moving joint is at the end of its clip, with a light on it.
fn on_joint(light: &str) -> String {
    format!(
        "version = 1\n[[model]]\nfile = 'a.glb'\nname = 'a'\nrotation_deg = [0, 90, 0]\n\
         clip = 'Walk'\ntime = 1\n{light}"
    )
}

#[test]
fn a_light_moves_with_its_node() {
    let scene = assemble(&on_joint("")).scene;
    let joint = scene.clips[0].channels[0].node;
    let name = &scene.nodes[joint].name;
    let light =
        format!("[[light]]\nname = 'torch'\ntype = 'point'\nnode = '{name}'\nposition = [0, 0, 1]");
    let assembled = assemble(&on_joint(&light));
    let nodes = &assembled.scene.nodes;
    let torch = nodes.iter().position(|node| node.name == "torch").expect("it is there");
    assert!(nodes[joint].children.contains(&torch));
    let place = |node: usize| Vec3::from(assembled.pose.world_from_node[node].translation);
    let offset = Quat::from_rotation_y(90_f32.to_radians()) * Vec3::Z;
    assert!(near(place(torch), place(joint) + offset), "{}", place(torch) - place(joint));
}

#[test]
fn a_sky_is_over_the_ground() {
    let file = read(
        "version = 1\n[[light]]\ntype = 'sky'\n[[light]]\ntype = 'sky'\ndirection = [1, 0, 0]",
    );
    let ups = [Vec3::Y, Vec3::NEG_X];
    for (entry, up) in file.lights.iter().zip(ups) {
        assert_eq!(entry.light.kind, LightKind::Sky);
        assert!(near(entry.transform.parent_from_node().transform_vector3(Vec3::Y), up));
    }
}

#[test]
fn shading_belongs_to_its_model() {
    let text = "version = 1\n[[model]]\nfile = 'a.glb'\nname = 'a'\n[[shading]]\n\
                materials = ['skin']\nproxy = { type = 'ellipsoid', radii = [1, 2, 1] }";
    let scene = assemble(text).scene;
    let [shading] = scene.shadings.as_slice() else { panic!("one shading") };
    let top = scene.nodes.iter().position(|node| node.name == "a");
    assert_eq!((shading.node, shading.under), (top, top));
    assert!(matches!(shading.proxy, Some(Proxy::Ellipsoid { radii, .. }) if radii.y == 2.0));
    assert!((shading.amount - 0.8).abs() < 1e-6);
}
