//! Nodes and what hangs on them: skins, cameras and lights.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::{Affine3A, Mat4, Quat, Vec3};

use super::super::Problem;
use super::accessor::{Accessor, Shape};
use super::document::{Int, Light as LightItem, Node as Item};
use super::{GltfFile, label, usable};
use crate::scene::{Camera, Light, LightKind, Node, Projection, Scene, Skin, Transform};

/// Reads all nodes, with the roots of the scene that is shown.
pub(super) fn read_nodes(
    file: &GltfFile,
    scene: &Scene,
) -> Result<(Vec<Node>, Vec<usize>), Problem> {
    let items = &file.document.nodes;
    let mut nodes: Vec<Node> =
        items.iter().enumerate().map(|(index, item)| read_node(file, scene, index, item)).collect();
    charge_for_instances(file, scene, &nodes)?;
    for (index, item) in items.iter().enumerate() {
        for &Int(child) in &item.children {
            let part = || label("node", index, item.name.as_deref());
            let Some(child_node) = nodes.get_mut(child) else {
                let why = format!("its child {child} does not exist");
                return Err(Problem::invalid(part(), why));
            };
            if let Some(other) = child_node.parent.replace(index) {
                let why = format!(
                    "its child {child} is also a child of node {other}; a node has one parent"
                );
                return Err(Problem::invalid(part(), why));
            }
        }
    }
    refuse_cycles(&nodes)?;
    let roots = read_roots(file, &nodes);
    Ok((nodes, roots))
}

fn read_node(file: &GltfFile, scene: &Scene, index: usize, item: &Item) -> Node {
    let what = label("node", index, item.name.as_deref());
    // Something that a node refers to; a wrong index is left out.
    let refer = |kind: &str, index: Option<Int>, count: usize| match index {
        Some(Int(index)) if index >= count => {
            file.warn(format!("The {kind} {index} of {what} does not exist and is left out."));
            None
        }
        index => index.map(|Int(index)| index),
    };
    let mesh = refer("mesh", item.mesh, scene.meshes.len());
    let mut skin = refer("skin", item.skin, scene.skins.len());
    if let (Some(mesh), Some(_)) = (mesh.and_then(|mesh| scene.meshes.get(mesh)), skin)
        && mesh.primitives.iter().all(|primitive| primitive.joints.is_empty())
    {
        file.warn(format!("The mesh of {what} has no joints; its skin is ignored."));
        skin = None;
    }
    let light = item.extensions.light.as_ref().and_then(|light| light.light);
    let name = [item.name.as_deref(), mesh_name(scene, mesh)]
        .into_iter()
        .flatten()
        .find(|name| !name.is_empty())
        .map_or_else(|| format!("node-{index}"), str::to_owned);
    let morph_weights = if usable(&item.weights) { item.weights.clone() } else { Vec::new() };
    Node {
        name,
        parent: None,
        children: item.children.iter().map(|child| child.0).collect(),
        transform: read_transform(file, &what, item),
        mesh,
        skin,
        camera: refer("camera", item.camera, scene.cameras.len()),
        light: refer("light", light, scene.lights.len()),
        morph_weights,
    }
}

fn mesh_name(scene: &Scene, mesh: Option<usize>) -> Option<&str> {
    Some(scene.meshes.get(mesh?)?.name.as_str())
}

fn read_transform(file: &GltfFile, what: &str, item: &Item) -> Transform {
    let parts = [item.translation, item.scale];
    let numbers = item.matrix.iter().flatten().chain(parts.iter().flatten().flatten());
    if !numbers.chain(item.rotation.iter().flatten()).all(|number| usable(&[*number])) {
        file.warn(format!(
            "The transform of {what} is not finite or far too large; it is ignored."
        ));
        return Transform::default();
    }
    if let Some(matrix) = &item.matrix {
        return Transform::Matrix(Mat4::from_cols_array(matrix));
    }
    let rotation = item.rotation.map_or(Quat::IDENTITY, Quat::from_array);
    let length = rotation.length_squared();
    Transform::Parts {
        translation: item.translation.map_or(Vec3::ZERO, Vec3::from),
        rotation: if (length - 1.0).abs() < 1e-6 {
            rotation
        } else if length > 1e-12 {
            rotation.normalize()
        } else {
            Quat::IDENTITY
        },
        scale: item.scale.map_or(Vec3::ONE, Vec3::from),
    }
}

/// Every node has at most one parent here, so a node belongs to a cycle or hangs below one
/// exactly if no parentless node leads to it.
fn refuse_cycles(nodes: &[Node]) -> Result<(), Problem> {
    let mut reached = vec![false; nodes.len()];
    let mut stack: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect();
    while let Some(index) = stack.pop() {
        if let (Some(reached), Some(node)) = (reached.get_mut(index), nodes.get(index)) {
            *reached = true;
            stack.extend(&node.children);
        }
    }
    match reached.iter().position(|&reached| !reached) {
        Some(index) => {
            let name = nodes.get(index).map(|node| node.name.as_str());
            let why = "it is among its own descendants; nodes must form a tree";
            Err(Problem::invalid(label("node", index, name), why))
        }
        None => Ok(()),
    }
}

/// The roots of the default scene, or of the first one, or all parentless nodes.
fn read_roots(file: &GltfFile, nodes: &[Node]) -> Vec<usize> {
    let document = &file.document;
    let index = document.scene.map_or(0, |scene| scene.0);
    let Some(scene) = document.scenes.get(index).or_else(|| document.scenes.first()) else {
        return (0..nodes.len()).filter(|&i| nodes[i].parent.is_none()).collect();
    };
    let mut is_root = vec![false; nodes.len()];
    let mut roots = Vec::new();
    for &Int(root) in &scene.nodes {
        match is_root.get_mut(root) {
            None => file.warn(format!("The scene's node {root} does not exist and is left out.")),
            Some(known) if !*known => {
                *known = true;
                roots.push(root);
            }
            Some(_) => {}
        }
    }
    // Some exporters list nodes together with their ancestors.
    let mut is_below_root = vec![false; nodes.len()];
    let mut stack: Vec<(usize, bool)> = (0..nodes.len())
        .filter(|&index| nodes[index].parent.is_none())
        .map(|index| (index, false))
        .collect();
    while let Some((index, below)) = stack.pop() {
        is_below_root[index] = below;
        let below = below || is_root[index];
        stack.extend(nodes[index].children.iter().map(|&child| (child, below)));
    }
    roots.retain(|&root| !is_below_root[root]);
    roots
}

/// A pose takes memory for each node that shows a mesh with morph targets or a skin, so that
/// many nodes of one mesh must be paid for.
fn charge_for_instances(file: &GltfFile, scene: &Scene, nodes: &[Node]) -> Result<(), Problem> {
    for node in nodes {
        let mesh = node.mesh.and_then(|mesh| scene.meshes.get(mesh));
        let skin = node.skin.and_then(|skin| scene.skins.get(skin));
        file.charge(mesh.map_or(0, |mesh| mesh.morph_weights.len() * size_of::<f32>()))?;
        file.charge(skin.map_or(0, |skin| skin.joints.len() * size_of::<Affine3A>()))?;
    }
    Ok(())
}

/// Reads all skins.
pub(super) fn read_skins(file: &GltfFile) -> Result<Vec<Skin>, Problem> {
    let document = &file.document;
    let mut skins = Vec::new();
    for (index, item) in document.skins.iter().enumerate() {
        let what = label("skin", index, item.name.as_deref());
        let joints: Vec<usize> = item.joints.iter().map(|joint| joint.0).collect();
        if joints.len() > usize::from(u16::MAX) {
            return Err(Problem::invalid(what, "it has more than 65,535 joints"));
        }
        let mut matrices: Vec<[f32; 16]> = match item.inverse_bind_matrices {
            Some(accessor) => Accessor::of_shape(file, accessor.0, &[Shape::Mat4])?.floats(),
            None => vec![Mat4::IDENTITY.to_cols_array(); joints.len()],
        };
        let unusable = matrices.iter().filter(|matrix| !usable(&matrix[..])).count();
        if matrices.len() < joints.len() || unusable > 0 {
            file.warn(format!(
                "Some inverse bind matrices of {what} are missing or not finite; the identity is used."
            ));
        }
        matrices.resize(joints.len(), Mat4::IDENTITY.to_cols_array());
        let joint_from_mesh = matrices
            .iter()
            .map(|matrix| {
                if usable(matrix) {
                    Affine3A::from_mat4(Mat4::from_cols_array(matrix))
                } else {
                    Affine3A::IDENTITY
                }
            })
            .collect();
        skins.push(Skin { name: item.name.clone().unwrap_or_default(), joints, joint_from_mesh });
    }
    Ok(skins)
}

/// Reads all cameras.
pub(super) fn read_cameras(file: &GltfFile) -> Vec<Camera> {
    let is_positive = |value: f32| usable(&[value]) && value > 0.0;
    let read = |(index, item): (usize, &super::document::Camera)| {
        let fix = |value: f32, valid: bool, default: f32| {
            if valid {
                return value;
            }
            let what = label("camera", index, item.name.as_deref());
            file.warn(format!("A number of {what} is out of range; {default} is used."));
            default
        };
        let (projection, aspect, near) = match (&item.perspective, &item.orthographic) {
            (Some(p), _) => (
                Projection::Perspective {
                    fov_y: fix(p.yfov, p.yfov > 0.0 && p.yfov < PI, FRAC_PI_4),
                },
                p.aspect_ratio,
                fix(p.znear, is_positive(p.znear), 0.01),
            ),
            (None, Some(o)) => (
                Projection::Orthographic {
                    // ymag is half of the height; a negative one mirrors, which is not done.
                    height: 2.0 * fix(o.ymag.abs(), is_positive(o.ymag.abs()), 1.0),
                },
                Some((o.xmag / o.ymag).abs()),
                // 0 is allowed here.
                if o.znear == 0.0 { 1e-4 } else { fix(o.znear, is_positive(o.znear), 0.01) },
            ),
            (None, None) => {
                let what = label("camera", index, item.name.as_deref());
                file.warn(format!("The {what} has no projection; a perspective of 45° is used."));
                (Projection::Perspective { fov_y: FRAC_PI_4 }, None, 0.01)
            }
        };
        Camera {
            name: item.name.clone().unwrap_or_default(),
            projection,
            aspect: aspect.filter(|aspect| is_positive(*aspect)),
            near,
        }
    };
    file.document.cameras.iter().enumerate().map(read).collect()
}

/// Reads the lights of KHR_lights_punctual.
pub(super) fn read_lights(file: &GltfFile) -> Vec<Light> {
    let items = file.document.extensions.lights.iter().flat_map(|lights| &lights.lights);
    items.enumerate().map(|(index, item)| read_light(file, index, item)).collect()
}

fn read_light(file: &GltfFile, index: usize, item: &LightItem) -> Light {
    let what = || label("light", index, item.name.as_deref());
    let range = item.range.filter(|range| usable(&[*range]) && *range > 0.0);
    let kind = match item.kind.as_str() {
        "directional" => LightKind::Directional,
        "spot" => {
            let outer = item.spot.outer_cone_angle.unwrap_or(FRAC_PI_4);
            let inner = item.spot.inner_cone_angle.unwrap_or(0.0);
            let is_valid = inner >= 0.0 && inner < outer && outer <= FRAC_PI_2 + 1e-4;
            if !is_valid {
                file.warn(format!("The cone of {} is impossible; its nearest is used.", what()));
            }
            let outer = if outer.is_finite() { outer.clamp(1e-3, FRAC_PI_2) } else { FRAC_PI_4 };
            let inner = if inner.is_finite() { inner.clamp(0.0, outer - 1e-4) } else { 0.0 };
            LightKind::Spot { range, inner_angle: inner, outer_angle: outer }
        }
        kind => {
            if kind != "point" {
                file.warn(format!("The kind of {} is unknown; it becomes a point.", what()));
            }
            LightKind::Point { range }
        }
    };
    let color = item.color.filter(|color| usable(color)).map_or(Vec3::ONE, Vec3::from);
    let intensity = item.intensity.filter(|i| usable(&[*i])).unwrap_or(1.0);
    Light {
        name: item.name.clone().unwrap_or_default(),
        kind,
        color: color.max(Vec3::ZERO),
        intensity: intensity.max(0.0),
        pinned_to_camera: false,
        casts_shadow: true,
    }
}
