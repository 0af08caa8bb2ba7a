//! Broken and hostile files: one clear sentence, or what is left of them with a warning.

use super::*;

#[test]
fn truncated_files() {
    let bytes = Glb::triangle().bytes();
    for length in 0..bytes.len() {
        let message = read(&bytes[..length]).unwrap_err().to_string();
        assert!(!message.is_empty());
        if length > 12 {
            assert!(message.contains("cut off"), "{length}: {message}");
        }
    }
    let json = serde_json::to_vec(&Glb::triangle().json).unwrap();
    let message = read(&json[..json.len() / 2]).unwrap_err().to_string();
    assert!(message.contains("cut off") && message.contains("line 1"), "{message}");
}

#[test]
fn files_of_another_kind() {
    let error = from_bytes("a.fbx", b"Kaydara FBX Binary", None, &no_files).unwrap_err();
    assert!(error.to_string().starts_with("a.fbx: this is not a model"), "{error}");
    let one = br#"{ "asset": { "version": "1.0" }, "accessors": { "a": {} } }"#;
    assert!(read(one).unwrap_err().to_string().contains("glTF 1.0"));
    let mut binary_one = Glb::triangle().bytes();
    binary_one[4] = 1;
    assert!(read(&binary_one).unwrap_err().to_string().contains("glTF 1,"));
    let newer = br#"{ "asset": { "version": "2.1", "minVersion": "2.1" } }"#;
    assert!(read(newer).unwrap_err().to_string().contains("glTF 2.1"));
}

#[test]
fn broken_json_is_located() {
    let error = read(b"{\n \"nodes\": [ { \"mesh\": \"no\" } ] }").unwrap_err().to_string();
    assert!(error.contains("line 2, column") && error.contains("whole number"), "{error}");
    let error = read(b"{\n nodes }").unwrap_err().to_string();
    assert!(error.contains("line 2"), "{error}");
}

#[test]
fn deep_json_does_not_overflow_the_stack() {
    for key in ["nodes", "extras", "unknown"] {
        let deep = format!("{{\"{key}\":{}", "[".repeat(1_000_000));
        assert!(read(deep.as_bytes()).is_err());
    }
    let deep = "[".repeat(100_000) + &"]".repeat(100_000);
    let json = format!("{{\"meshes\":[{{\"extras\":{deep}}}]}}");
    assert!(read(json.as_bytes()).unwrap_err().to_string().contains("nested too deeply"));
}

#[test]
fn integers_may_be_written_with_a_zero_fraction() {
    let mut glb = Glb::triangle();
    glb.json["accessors"][0]["count"] = json!(3.0);
    assert_eq!(glb.imported().scene.vertex_count(), 3);
    glb.json["accessors"][0]["count"] = json!(2.5);
    assert!(glb.error().contains("2.5"));
    glb.json["accessors"][0]["count"] = json!(-1);
    assert!(glb.error().contains("-1"));
}

#[test]
fn required_extensions() {
    let mut glb = Glb::triangle();
    for (name, advice) in [
        ("VENDOR_unknown", "without it"),
        ("KHR_draco_mesh_compression", "without mesh compression"),
        ("EXT_meshopt_compression", "without mesh compression"),
        ("KHR_texture_basisu", "PNG"),
    ] {
        glb.json["extensionsRequired"] = json!(["KHR_materials_unlit", name]);
        let error = glb.error();
        assert!(error.contains(&format!("'{name}'")) && error.contains(advice), "{error}");
    }
    glb.json["extensionsRequired"] = json!(["KHR_materials_clearcoat", "KHR_materials_variants"]);
    glb.json["extensionsUsed"] = json!(["VENDOR_unknown", "KHR_materials_ior"]);
    assert!(glb.warning().contains("'VENDOR_unknown'"));
}

#[test]
fn missing_buffers() {
    let mut glb = Glb::triangle();
    glb.json["buffers"] = json!([{ "byteLength": 36, "uri": "gone.bin" }]);
    assert!(glb.error().contains("buffer 0: the file 'gone.bin', which belongs beside"));
    glb.json["buffers"] = json!([{ "byteLength": 37 }]);
    assert!(glb.error().contains("37 bytes, but only 36"));
    glb.json["buffers"] = json!([{ "byteLength": 36, "uri": "/etc/passwd" }]);
    assert!(glb.error().contains("absolute"));
    glb.json["bufferViews"][0]["buffer"] = json!(1);
    glb.json["buffers"] = json!([{ "byteLength": 36 }, { "byteLength": 36 }]);
    assert!(glb.error().contains("buffer 1: it has no data"));
    glb.json["bufferViews"][0]["buffer"] = json!(7);
    assert!(glb.error().contains("buffer 7, which does not exist"));
}

#[test]
fn accessors_that_do_not_fit() {
    let huge = usize::MAX;
    for (path, value) in [
        ("/accessors/0/count", json!(4)),
        ("/accessors/0/count", json!(1_000_000)),
        ("/accessors/0/byteOffset", json!(4)),
        ("/accessors/0/byteOffset", json!(huge)),
        ("/accessors/0/bufferView", json!(1)),
        ("/bufferViews/0/byteLength", json!(37)),
        ("/bufferViews/0/byteLength", json!(35)),
        ("/bufferViews/0/byteLength", json!(huge)),
        ("/bufferViews/0/byteOffset", json!(huge)),
        ("/bufferViews/0/byteStride", json!(4)),
        ("/bufferViews/0/byteStride", json!(huge)),
        ("/accessors/0/componentType", json!(5124)),
        ("/accessors/0/type", json!("VEC9")),
        ("/accessors/0/type", json!("VEC2")),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(1)),
    ] {
        let mut glb = Glb::triangle();
        glb.json["accessors"][0]["byteOffset"] = json!(0);
        glb.json["bufferViews"][0]["byteStride"] = json!(12);
        *glb.json.pointer_mut(path).unwrap() = value.clone();
        let error = glb.error();
        assert!(
            error.contains("accessor") || error.contains("buffer view"),
            "{path} {value}: {error}"
        );
    }
}

#[test]
fn a_small_file_cannot_ask_for_much_memory() {
    // Zeros need no data, so only the budget stops them.
    for count in [100_000_000_usize, usize::MAX] {
        let mut glb = Glb::triangle();
        let accessor = &mut glb.json["accessors"][0];
        accessor["count"] = json!(count);
        accessor.as_object_mut().unwrap().remove("bufferView");
        assert!(glb.error().contains("MiB of geometry"), "{}", glb.error());
    }
    // Many primitives, and many morph targets on some of them.
    let mut glb = Glb::triangle();
    let primitive = glb.json["meshes"][0]["primitives"][0].clone();
    let mut primitives = vec![primitive; 3000];
    primitives[0]["targets"] = json!(vec![json!({}); 3000]);
    glb.json["meshes"][0]["primitives"] = json!(primitives);
    assert!(glb.error().contains("MiB of geometry"));
}

#[test]
fn sparse_accessors_that_do_not_fit() {
    for (path, value) in [
        ("/indices/bufferView", json!(9)),
        ("/indices/byteOffset", json!(2)),
        ("/indices/componentType", json!(F32)),
        ("/values/byteOffset", json!(1)),
        ("/values/bufferView", json!(9)),
        ("/count", json!(4)),
        ("/count", json!(usize::MAX)),
    ] {
        let mut glb = Glb::triangle();
        let at = glb.view(&[1, 2]);
        let values = glb.view(&[0; 24]);
        let mut sparse = json!({
            "count": 2,
            "indices": { "bufferView": at, "componentType": U8, "byteOffset": 0 },
            "values": { "bufferView": values, "byteOffset": 0 },
        });
        *sparse.pointer_mut(path).unwrap() = value;
        glb.json["accessors"][0]["sparse"] = sparse;
        assert!(glb.read().is_err(), "{path}");
    }
    let mut glb = Glb::triangle();
    let at = glb.view(&[1, 3]);
    let values = glb.view(&[0; 24]);
    glb.json["accessors"][0]["sparse"] = json!({
        "count": 2,
        "indices": { "bufferView": at, "componentType": U8 }, "values": { "bufferView": values },
    });
    assert!(glb.error().contains("an element that does not exist"));
}

#[test]
fn wrong_indices() {
    let mut glb = Glb::triangle();
    glb.json["meshes"][0]["name"] = json!("Arm");
    let indices = glb.shorts("SCALAR", 1, &[0, 1, 3]);
    glb.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let error = glb.error();
    assert!(error.contains("mesh 0 'Arm'") && error.contains("index 3"), "{error}");
    glb.json["accessors"][indices]["componentType"] = json!(I16);
    assert!(glb.error().contains("unsigned"));
}

#[test]
fn positions_that_are_not_finite_or_huge_lose_their_triangles() {
    for bad in [f32::NAN, f32::INFINITY, 3e38] {
        let mut glb = Glb::new();
        let positions =
            glb.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, bad, 0.0, 0.0]);
        let indices = glb.shorts("SCALAR", 1, &[0, 1, 2, 0, 1, 3]);
        glb.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices }));
        let warning = glb.warning();
        assert!(warning.contains("1 triangles") && warning.contains("accessor 0"), "{warning}");
        let scene = glb.read().unwrap().scene;
        assert_eq!((scene.triangle_count(), scene.vertex_count()), (1, 3));
    }
}

#[test]
fn broken_positions_that_no_triangle_uses_do_not_matter() {
    let mut glb = Glb::new();
    let nan = f32::NAN;
    let positions =
        glb.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, nan, nan, nan]);
    let indices = glb.shorts("SCALAR", 1, &[0, 1, 2]);
    glb.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices }));
    assert_eq!(glb.primitive().positions.len(), 3);
}

#[test]
fn what_cannot_be_drawn_is_skipped() {
    let mut glb = Glb::triangle();
    for (mode, why) in [(0, "points"), (1, "lines"), (2, "lines"), (3, "lines"), (7, "mode")] {
        glb.json["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        assert!(glb.warning().contains(why));
        assert_eq!(glb.read().unwrap().scene.triangle_count(), 0);
    }
    let mut glb = Glb::triangle();
    glb.json["meshes"][0]["primitives"][0]["attributes"] = json!({});
    assert!(glb.warning().contains("no positions"));
    let mut glb = Glb::triangle();
    let indices = glb.shorts("SCALAR", 1, &[0, 0, 1]);
    glb.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    assert!(glb.warning().contains("no triangle of it"));
    let mut glb = Glb::triangle();
    let indices = glb.shorts("SCALAR", 1, &[0, 1, 2, 0]);
    glb.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    assert!(glb.warning().contains("incomplete"));
}

#[test]
fn attributes_of_another_length_are_ignored() {
    let mut glb = Glb::triangle();
    let short = glb.floats("VEC3", &[0.0, 1.0, 0.0]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(short);
    assert!(glb.warning().contains("1 elements for 3 vertices"));
}

#[test]
fn zero_area_triangles_keep_unit_normals() {
    let mut glb = Glb::new();
    let positions = glb.floats("VEC3", &[1.0; 9]);
    glb.mesh(json!({ "attributes": { "POSITION": positions } }));
    assert!(glb.primitive().normals.iter().all(|normal| normal.is_normalized()));
}

#[test]
fn nodes_that_are_no_tree() {
    let mut glb = Glb::triangle();
    glb.json["nodes"] = json!([{ "children": [1] }, { "children": [0], "name": "Loop" }]);
    assert!(glb.error().contains("own descendants"));
    glb.json["nodes"] = json!([{ "children": [0] }]);
    assert!(glb.error().contains("own descendants"));
    glb.json["nodes"] = json!([{ "children": [2] }, { "children": [2] }, {}]);
    assert!(glb.error().contains("a node has one parent"));
    glb.json["nodes"] = json!([{ "children": [9] }]);
    assert!(glb.error().contains("child 9 does not exist"));
}

#[test]
fn a_deep_chain_of_nodes() {
    let mut glb = Glb::triangle();
    let count = 100_000;
    let mut nodes: Vec<_> = (1..count).map(|i| json!({ "children": [i] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    glb.json["nodes"] = json!(nodes);
    let scene = glb.imported().scene;
    assert!(crate::scene::Pose::rest(&scene).visible[count - 1]);
}

#[test]
fn references_to_nothing_are_left_out() {
    let mut glb = Glb::triangle();
    glb.json["nodes"] = json!([{ "mesh": 0, "camera": 1 }]);
    assert!(glb.warning().contains("camera 1"));
    glb.json["nodes"] = json!([{ "mesh": 9 }]);
    assert!(glb.warning().contains("mesh 9"));
    glb.json["nodes"] = json!([{ "mesh": 0 }]);
    glb.json["scenes"] = json!([{ "nodes": [0, 5] }]);
    assert!(glb.warning().contains("node 5"));
    let mut glb = Glb::triangle();
    glb.json["meshes"][0]["primitives"][0]["material"] = json!(2);
    assert!(glb.warning().contains("material 2"));
}

#[test]
fn joints_that_do_not_exist() {
    let mut glb = super::scene::skinned();
    let joints = glb.accessor(&[3; 12], U8, "VEC4", 3);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    assert!(glb.error().contains("joint 3"));
    let mut glb = super::scene::skinned();
    glb.json["skins"][0]["joints"] = json!([77]);
    assert!(glb.error().contains("node 77"));
}

#[test]
fn warnings_are_bounded() {
    let mut glb = Glb::triangle();
    let primitive = glb.json["meshes"][0]["primitives"][0].clone();
    let mut points = primitive;
    points["mode"] = json!(0);
    glb.json["meshes"][0]["primitives"] = json!(vec![points; 1000]);
    let warnings = glb.read().unwrap().warnings;
    assert_eq!(warnings.len(), 51);
    assert!(warnings[50].contains("950 more"));
}
