use std::cell::Cell;
use std::path::Path;

use glam::{Affine3A, Quat, Vec3};

use super::*;
use crate::scene::{
    Camera, Channel, ChannelTarget, Clip, Image, Interpolation, Light, LightKind, Material, Mesh,
    Node, Pose, Primitive, Projection, Scene, Skin, Texture, TextureRef, Transform, UvTransform,
};
use crate::toml_file::mutate;

/// root(0) → body(1, skinned mesh), bone(2) → hat(3, mesh), eye(4, camera), lamp(5, light)
pub(super) fn model() -> Scene {
    let triangle = Primitive {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        normals: vec![Vec3::Z; 3],
        joints: vec![[0; 4]; 3],
        weights: vec![[1.0, 0.0, 0.0, 0.0]; 3],
        indices: vec![0, 1, 2],
        material: Some(0),
        ..Primitive::default()
    };
    let hat = Primitive { joints: vec![], weights: vec![], material: None, ..triangle.clone() };
    let node = |name: &str, parent, children: &[usize]| Node {
        name: name.to_owned(),
        parent,
        children: children.to_vec(),
        ..Node::default()
    };
    let texture = TextureRef { texture: 0, uv_set: 0, transform: UvTransform::default() };
    Scene {
        nodes: vec![
            node("root", None, &[1, 2, 4, 5]),
            Node { mesh: Some(0), skin: Some(0), ..node("body", Some(0), &[]) },
            node("bone", Some(0), &[3]),
            Node { mesh: Some(1), ..node("Hat", Some(2), &[]) },
            Node { camera: Some(0), ..node("eye", Some(0), &[]) },
            Node { light: Some(0), ..node("lamp", Some(0), &[]) },
        ],
        roots: vec![0],
        meshes: vec![
            Mesh { primitives: vec![triangle], ..Mesh::default() },
            Mesh { primitives: vec![hat], ..Mesh::default() },
        ],
        materials: vec![Material { base_color_texture: Some(texture), ..Material::default() }],
        textures: vec![Texture {
            name: String::new(),
            image: Some(0),
            sampler: crate::scene::Sampler::default(),
        }],
        images: vec![Image { name: String::new(), width: 1, height: 1, rgba: vec![255; 4] }],
        skins: vec![Skin {
            name: String::new(),
            joints: vec![2],
            joint_from_mesh: vec![Affine3A::IDENTITY],
        }],
        clips: vec![Clip {
            name: "Walk".to_owned(),
            channels: vec![Channel {
                node: 2,
                target: ChannelTarget::Translation,
                interpolation: Interpolation::Linear,
                times: vec![0.0, 1.0],
                values: vec![0.0, 0.0, 0.0, 0.0, 4.0, 0.0],
            }],
        }],
        cameras: vec![Camera {
            name: "Main".to_owned(),
            projection: Projection::Perspective { fov_y: 0.5 },
            aspect: None,
            near: 0.1,
        }],
        lights: vec![Light {
            name: String::new(),
            kind: LightKind::Directional,
            color: Vec3::ONE,
            intensity: 1.0,
            pinned_to_camera: false,
            casts_shadow: true,
        }],
        ..Scene::default()
    }
}

pub(super) fn read(text: &str) -> SceneFile {
    SceneFile::from_toml_str(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

pub(super) fn assemble(text: &str) -> Assembled {
    let load = |_: &Path| Ok::<_, String>(model());
    let assembled = read(text).assemble(load).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assembled.scene.validate().expect("what is assembled is valid");
    let nodes = assembled.scene.nodes.len();
    assert_eq!(assembled.pose.world_from_node.len(), nodes);
    assert_eq!(assembled.pose.morph_weights.len(), nodes);
    assert_eq!(assembled.pose.visible.len(), nodes);
    assembled
}

pub(super) fn near(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-5
}

const EVERY_KEY: &str = r##"
    version = 1
    style = "anime"
    [[model]]
    file = "a/hero.glb"
    name = "Hero"
    translation = [1, 2, 3]
    rotation_deg = [0, 90, 0]
    scale = [1, 2, 3]
    clip = 2
    time = 0.5
    hide = ["Cape*"]
    [[model]]
    file = "b.glb"
    scale = 2
    clip = "Run"
    [camera]
    azimuth_deg = 1
    elevation_deg = 2
    zoom = 3
    fov_deg = 4
    orthographic = true
    [[light]]
    type = "directional"
    azimuth_deg = 90
    pinned_to = "camera"
    [[light]]
    type = "point"
    name = "Lamp"
    position = [0, 1, 0]
    color = "#808080"
    intensity = 5
    range = 10
    [[light]]
    type = "spot"
    position = [0, 2, 0]
    direction = [0, -2, 0]
    inner_angle_deg = 10
    outer_angle_deg = 20
    [picture]
    size = [640, 480]
    background = false
    supersample = 3
"##;

#[test]
fn every_key_is_read() {
    let file = read(EVERY_KEY);

    assert_eq!(file.style.as_deref().map(String::as_str), Some("anime"));
    let [hero, other] = file.models.as_slice() else { panic!("two models") };
    assert_eq!((hero.file.as_str(), hero.node_name().as_str()), ("a/hero.glb", "Hero"));
    assert_eq!((hero.translation, hero.time), ([1.0, 2.0, 3.0], 0.5));
    assert_eq!(hero.clip.as_deref(), Some(&ClipEntry::Index(2)));
    assert!(hero.hide.matches("cape.001"));
    assert_eq!(hero.scale.to_vec3(), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!((other.node_name().as_str(), other.scale), ("b", Scale::Uniform(2.0)));
    assert_eq!(other.clip.as_deref(), Some(&ClipEntry::Name("Run".to_owned())));
    let orbit = OrbitCamera {
        azimuth_deg: 1.0,
        elevation_deg: 2.0,
        zoom: 3.0,
        fov_deg: 4.0,
        orthographic: true,
    };
    assert_eq!(file.camera, Some(CameraEntry::Orbit(orbit)));
    let [sun, lamp, spot] = file.lights.as_slice() else { panic!("three lights") };
    assert_eq!((sun.light.kind, sun.light.pinned_to_camera), (LightKind::Directional, true));
    let toward = |light: &LightEntry| light.transform.parent_from_node().transform_vector3(Vec3::Z);
    assert!(near(toward(sun), Vec3::X), "an azimuth of 90° comes from the right");
    assert_eq!(lamp.light.kind, LightKind::Point { range: Some(10.0) });
    assert!((lamp.light.color.x - 0.215_86).abs() < 1e-4, "{}", lamp.light.color);
    assert_eq!((lamp.light.intensity, lamp.light.pinned_to_camera), (5.0, false));
    assert!(near(toward(spot), Vec3::Y), "a light along −Y comes from above");
    let angles = (10_f32.to_radians(), 20_f32.to_radians());
    let kind = LightKind::Spot { range: None, inner_angle: angles.0, outer_angle: angles.1 };
    assert_eq!(spot.light.kind, kind);
    let picture = Picture { size: Some([640, 480]), background: Some(false), supersample: Some(3) };
    assert_eq!(file.picture, picture);
}

#[test]
fn errors_name_the_place_and_the_remedy() {
    for (text, expected) in [
        ("", "1:1: missing key 'version'"),
        ("version = 1\n[[modle]]", "2:3: unknown key 'modle', did you mean 'model'?"),
        ("version = 1\n[[model]]", "2:1: missing key 'file'"),
        (
            "version = 1\n[[model]]\nfile = 'a'\nrotation = [0,0,0]",
            "4:1: unknown key 'rotation', did you mean 'rotation_deg'?",
        ),
        (
            "version = 1\n[[model]]\nfile = 'a'\nscale = 0",
            "4:9: 'scale' must be a number from 0.000001 to 1000000, not 0",
        ),
        (
            "version = 1\n[[model]]\nfile = 'a'\nscale = [1, 1]",
            "4:9: 'scale' must be a list of 3, each a number from 0.000001 to 1000000, not a list of 2",
        ),
        (
            "version = 1\n[[model]]\nfile = 'a'\nscale = 'x'",
            "4:9: 'scale' must be a number from 0.000001 to 1000000 or a list of 3, each a number from 0.000001 to 1000000, not \"x\"",
        ),
        (
            "version = 1\n[[model]]\nfile = 'a'\ntranslation = [0, nan, 0]",
            "4:19: 'translation' must be a number from -1000000 to 1000000, not nan",
        ),
        (
            "version = 1\n[[model]]\nfile = 'a'\nclip = -1",
            "4:8: 'clip' must be a whole number from 0 to 65535, not -1",
        ),
        (
            "version = 1\n[camera]\nnode = 'a'\nzoom = 2",
            "2:1: 'camera' must not have 'zoom' together with 'node'",
        ),
        (
            "version = 1\ncamera = { near = 1 }",
            "2:10: 'camera' must not have 'near' together with an orbit: it needs a 'position'",
        ),
        (
            "version = 1\ncamera = { position = [0, 0, 0] }",
            "2:10: 'camera' must have a 'target' beside its 'position'",
        ),
        (
            "version = 1\ncamera = { position = [0, 0, 0], target = [0, 0, 0] }",
            "2:10: 'camera' must have its 'target' away from its 'position'",
        ),
        (
            "version = 1\ncamera = { position = [0, 9, 0], target = [0, 0, 0] }",
            "2:10: 'camera' must not look along its 'up': give another one",
        ),
        (
            "version = 1\n[[light]]\ntype = 'spto'",
            "3:8: 'type' must be \"directional\", \"point\", \"spot\" or \"sky\", not \"spto\"",
        ),
        ("version = 1\n[[light]]\ntype = 'point'", "2:1: 'light' must have a 'position'"),
        (
            "version = 1\n[[light]]\ntype = 'point'\nposition = [0, 0, 0]\n[[light]]\ntype = 'directional'\nrange = 3",
            "5:1: 'light' must not have 'range': a directional light has none",
        ),
        (
            "version = 1\nlight = [{type = 'directional', direction = [0, 0, 0]}]",
            "2:10: 'light' must have a 'direction' that is not zero",
        ),
        (
            "version = 1\nlight = [{type = 'directional', direction = [0, 0, 1], azimuth_deg = 1}]",
            "2:10: 'light' must have either a 'direction' or its two angles, not both",
        ),
        (
            "version = 1\nlight = [{type = 'spot', position = [0,0,0], inner_angle_deg = 50}]",
            "2:10: 'light' must have an 'outer_angle_deg' that is larger than its inner one, not 45 and 50",
        ),
        (
            "version = 1\npicture.size = [0, 1]",
            "2:17: 'size' must be a whole number from 1 to 16384, not 0",
        ),
        (
            "version = 1\npicture.supersample = 5",
            "2:23: 'supersample' must be a whole number from 1 to 4, not 5",
        ),
    ] {
        let error =
            SceneFile::from_toml_str(text).err().unwrap_or_else(|| panic!("accepted: {text}"));
        assert_eq!(error.to_string(), expected, "{text}");
    }
}

#[test]
fn an_empty_scene_is_a_scene() {
    let assembled = assemble("version = 1");
    assert!(assembled.scene.nodes.is_empty() && assembled.camera.is_none());
}

#[test]
fn models_stand_side_by_side_and_share_their_data() {
    let loads = Cell::new(0);
    let text = "version = 1
        [[model]]
        file = 'a.glb'
        translation = [1, 0, 0]
        [[model]]
        file = './a.glb'
        translation = [2, 0, 0]
        [[model]]
        file = 'b.glb'
        scale = 3
        [[light]]
        type = 'point'
        position = [7, 8, 9]";
    let file = read(text);
    let assembled = file
        .assemble(|_| {
            loads.set(loads.get() + 1);
            Ok::<_, String>(model())
        })
        .expect("it is valid");
    let Assembled { scene, pose, .. } = &assembled;
    assert_eq!(scene.validate(), Ok(()));
    assert_eq!(loads.get(), 2, "a file is loaded once");
    assert_eq!((scene.nodes.len(), scene.roots.len()), (3 * 7 + 1, 4));
    assert_eq!((scene.meshes.len(), scene.images.len(), scene.skins.len()), (4, 2, 3));
    assert_eq!((scene.lights.len(), scene.cameras.len(), scene.clips.len()), (3, 2, 3));
    let names: Vec<&str> = scene.roots.iter().map(|&i| scene.nodes[i].name.as_str()).collect();
    assert_eq!(names, ["a", "a", "b", ""]);
    // Without clips the pose is that of the merged scene itself.
    assert_eq!(*pose, Pose::rest(scene));
    let bodies: Vec<usize> =
        (0..scene.nodes.len()).filter(|&i| scene.nodes[i].name == "body").collect();
    for (body, (x, material)) in bodies.into_iter().zip([(1.0, 0), (2.0, 0), (0.0, 1)]) {
        let joints = pose.world_from_rest(scene, body).expect("it has a skin");
        assert!(near(joints[0].translation.into(), Vec3::new(x, 0.0, 0.0)));
        let mesh = &scene.meshes[scene.nodes[body].mesh.expect("it has a mesh")];
        assert_eq!(mesh.primitives[0].material, Some(material));
    }
    assert_eq!(scene.materials[1].base_color_texture.map(|t| t.texture), Some(1));
    assert_eq!(scene.textures[1].image, Some(1));
    let light = scene.nodes.last().expect("there is one");
    assert_eq!(light.light, Some(2));
    let world = pose.world_from_node.last().expect("there is one");
    assert!(near(world.translation.into(), Vec3::new(7.0, 8.0, 9.0)));
}

#[test]
fn rotations_are_about_x_then_y_then_z() {
    let file = read("version = 1\n[[model]]\nfile = 'a'\nrotation_deg = [90, 90, 0]");
    let Transform::Parts { rotation, .. } = file.models[0].transform() else { panic!("parts") };
    // Y goes to Z about x, and from there to X about y.
    assert!(near(rotation * Vec3::Y, Vec3::X), "{}", rotation * Vec3::Y);
    let file = read("version = 1\n[[model]]\nfile = 'a'\nrotation_deg = [0, 90, 90]");
    let Transform::Parts { rotation, .. } = file.models[0].transform() else { panic!("parts") };
    // Z goes to X about y, and from there to Y about z.
    assert!(near(rotation * Vec3::Z, Vec3::Y), "{}", rotation * Vec3::Z);
}

#[test]
fn each_model_has_its_own_clip_and_time() {
    let assembled = assemble(
        "version = 1
        [[model]]
        file = 'a.glb'
        clip = 'walk'
        time = 0.25
        [[model]]
        file = 'a.glb'
        clip = 0
        time = 0.5
        scale = 10
        [[model]]
        file = 'a.glb'",
    );
    let heights: Vec<f32> = assembled
        .scene
        .nodes
        .iter()
        .zip(&assembled.pose.world_from_node)
        .filter(|(node, _)| node.name == "bone")
        .map(|(_, world)| world.translation.y)
        .collect();
    assert_eq!(heights, [1.0, 20.0, 0.0]);
    // The merged clips still move their own models.
    let second = Pose::at(&assembled.scene, 1, 1.0);
    assert_eq!(second.world_from_node[7 + 3].translation.y, 40.0);
    assert_eq!(second.world_from_node[3].translation.y, 0.0);
}

#[test]
fn hidden_nodes_are_not_drawn_but_still_move_joints() {
    let assembled = assemble(
        "version = 1\n[[model]]\nfile = 'a.glb'\nhide = ['BONE']\ntranslation = [5, 0, 0]",
    );
    let scene = &assembled.scene;
    let find = |name: &str| scene.nodes.iter().position(|n| n.name == name).expect("it is there");
    assert_eq!(scene.nodes[find("Hat")].mesh, None, "it hangs under the bone");
    assert!(scene.nodes[find("body")].mesh.is_some());
    let joints = assembled.pose.world_from_rest(scene, find("body")).expect("it has a skin");
    assert!(near(joints[0].translation.into(), Vec3::new(5.0, 0.0, 0.0)));
    assert_eq!(assembled.warnings, Vec::<String>::new());

    let assembled = assemble("version = 1\n[[model]]\nfile = 'a.glb'\nhide = ['nobody']");
    assert_eq!(assembled.warnings, ["4:8: 'hide' fits no node of the model"]);
    assert_eq!(assembled.scene.triangle_count(), 2);
}

#[test]
fn cameras_are_placed_or_found() {
    let assembled = assemble(
        "version = 1\ncamera = { position = [0, 0, 5], target = [0, 0, 0], fov_deg = 90, near = 2 }",
    );
    let Some(SceneCamera::Placed(camera)) = assembled.camera else { panic!("placed") };
    assert!(camera.world_from_camera.abs_diff_eq(
        Affine3A::from_rotation_translation(Quat::IDENTITY, Vec3::new(0.0, 0.0, 5.0)),
        1e-6
    ));
    assert_eq!(camera.projection, Projection::Perspective { fov_y: 90_f32.to_radians() });
    assert_eq!(camera.near, 2.0);

    let assembled = assemble(
        "version = 1\ncamera = { position = [3, 4, 5], target = [1, 2, 2], up = [1, 0, 0], height = 2 }",
    );
    let Some(SceneCamera::Placed(camera)) = assembled.camera else { panic!("placed") };
    assert_eq!(camera.projection, Projection::Orthographic { height: 2.0 });
    let forward = camera.world_from_camera.transform_vector3(Vec3::NEG_Z);
    assert!(near(forward, Vec3::new(-2.0, -2.0, -3.0).normalize()));
    let m = camera.world_from_camera.matrix3;
    assert!((m.determinant() - 1.0).abs() < 1e-5 && m.y_axis.x > 0.5);

    for name in ["eye", "Main"] {
        let text = format!("version = 1\n[[model]]\nfile = 'a.glb'\n[camera]\nnode = '{name}'");
        let assembled = assemble(&text);
        let Some(SceneCamera::Node(node)) = assembled.camera else { panic!("a node") };
        assert_eq!(assembled.scene.nodes[node].name, "eye");
    }
}

#[test]
fn what_is_not_in_the_models_is_shown_at_its_place() {
    let text = "version = 1\n[[model]]\nfile = 'x/a.glb'\n";
    for (more, expected) in [
        ("clip = 'Walc'", "4:8: there is no clip 'Walc', did you mean 'Walk'? (known: Walk)"),
        ("clip = 3", "4:8: there is no clip 3: the model has 1"),
        ("[camera]\nnode = 'ey'", "5:8: there is no camera 'ey', did you mean 'eye'? (known: eye)"),
    ] {
        let file = read(&format!("{text}{more}"));
        let error = file.assemble(|_| Ok::<_, String>(model())).expect_err("it is wrong");
        assert_eq!(error.to_string(), expected);
    }
    let file = read(text);
    let error = file.assemble(|_| Err("it is gone")).expect_err("it is wrong");
    assert_eq!(error.to_string(), "3:8: cannot use this model: it is gone");
    let mut broken = model();
    broken.nodes[1].mesh = Some(9);
    let error = file.assemble(|_| Ok::<_, String>(broken.clone())).expect_err("it is wrong");
    assert!(error.to_string().starts_with("3:8: cannot use this model: x/a.glb: node 1 'body'"));
}

#[test]
fn paths_start_at_the_file() {
    let directory = tempfile::tempdir().expect("a temporary directory can be made");
    let path = directory.path().join("a.scene.toml");
    let write = |path: &Path, text| std::fs::write(path, text).expect("it can be written");
    write(&path, "version = 1\nstyle = './b.style.toml'\n[[model]]\nfile = './sub/m.glb'");
    let file = SceneFile::load(&path).expect("it is valid");
    let mut seen = Vec::new();
    let assembled = file.assemble(|path| {
        seen.push(path.to_owned());
        Ok::<_, String>(model())
    });
    assert_eq!(assembled.expect("it is valid").scene.name, "a");
    assert_eq!(seen, [directory.path().join("sub/m.glb")]);

    let shown = |file: &SceneFile| {
        let error = file.load_style().expect_err("it is wrong").to_string();
        error.replace(&format!("{}/", directory.path().display()), "")
    };
    assert!(
        shown(&file).starts_with("a.scene.toml:2:9: cannot read the style 'b.style.toml': "),
        "{}",
        shown(&file)
    );
    write(&directory.path().join("b.style.toml"), "version = 1\nx = 1");
    assert_eq!(shown(&file), "b.style.toml:2:1: unknown key 'x'");
    write(&directory.path().join("b.style.toml"), "version = 1\nname = 'B'");
    let style = file.load_style().expect("it is valid").expect("it is given");
    assert_eq!(style.name, "B");

    let unknown = read("version = 1\nstyle = 'animee'").load_style().expect_err("no such preset");
    assert!(unknown.to_string().starts_with("2:9: unknown style 'animee', did you mean 'anime'?"));
    let missing = SceneFile::load(directory.path().join("no.scene.toml")).expect_err("missing");
    assert!(missing.to_string().starts_with("cannot read the scene '"), "{missing}");
}

#[test]
fn the_committed_schema_is_fresh() {
    crate::toml_file::assert_schema_is_fresh("scene.schema.json", &json_schema());
}

#[test]
fn mutated_files_never_panic() {
    let text = EVERY_KEY.replace("clip = 2", "clip = 0").replace("\"Run\"", "\"Walk\"");
    let accepted = mutate(&text, 1500, |text| {
        let assembled = SceneFile::from_toml_str(text)?.assemble(|_| Ok::<_, String>(model()))?;
        assert_eq!(assembled.scene.validate(), Ok(()));
        assert!(assembled.pose.world_from_node.iter().all(|world| world.is_finite()));
        Ok(())
    });
    assert!(accepted > 10, "the changes are too rough: {accepted} accepted");
}
