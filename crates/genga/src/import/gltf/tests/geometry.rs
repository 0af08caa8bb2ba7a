//! Accessors, attributes and primitives.

use std::f32::consts::FRAC_1_SQRT_2;

use glam::{Vec2, Vec3, Vec4};

use super::*;

fn quad(glb: &mut Glb) -> usize {
    glb.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0])
}

#[test]
fn a_triangle_without_anything_else() {
    let primitive = Glb::triangle().primitive();
    assert_eq!(primitive.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(primitive.indices, [0, 1, 2]);
    assert_eq!(primitive.normals, [Vec3::Z; 3]);
    assert_eq!(primitive.material, None);
}

#[test]
fn indices_of_every_type() {
    for (component, bytes) in [
        (U8, vec![2, 1, 0]),
        (U16, vec![2, 0, 1, 0, 0, 0]),
        (U32, vec![2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]),
    ] {
        let mut glb = Glb::triangle();
        let indices = glb.accessor(&bytes, component, "SCALAR", 3);
        glb.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
        assert_eq!(glb.primitive().indices, [2, 1, 0]);
    }
}

#[test]
fn strips_and_fans_keep_their_winding() {
    for (mode, corners, expected) in
        [(5, [0, 1, 3, 2], [0, 1, 3, 1, 2, 3]), (6, [0, 1, 2, 3], [1, 2, 0, 2, 3, 0])]
    {
        let mut glb = Glb::new();
        let positions = quad(&mut glb);
        let indices = glb.shorts("SCALAR", 1, &corners);
        glb.mesh(json!({
            "attributes": { "POSITION": positions }, "indices": indices, "mode": mode,
        }));
        let primitive = glb.primitive();
        assert_eq!(primitive.indices, expected);
        assert_eq!(primitive.normals, [Vec3::Z; 4], "mode {mode} is wound to the front");
    }
}

#[test]
fn stitches_of_strips_are_dropped() {
    let mut glb = Glb::new();
    let positions = quad(&mut glb);
    let indices = glb.shorts("SCALAR", 1, &[0, 1, 2, 2, 0, 2, 3]);
    glb.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices, "mode": 5 }));
    assert_eq!(glb.primitive().indices, [0, 1, 2, 0, 2, 3]);
}

#[test]
fn strides_and_offsets() {
    let mut glb = Glb::new();
    // Position and texture coordinates interleaved, behind four other bytes.
    let vertex = |p: [f32; 3], uv: [f32; 2]| p.into_iter().chain(uv).flat_map(f32::to_le_bytes);
    let mut bytes = vec![9; 4];
    bytes.extend(vertex([0.0, 0.0, 0.0], [0.0, 1.0]));
    bytes.extend(vertex([1.0, 0.0, 0.0], [1.0, 1.0]));
    bytes.extend(vertex([0.0, 1.0, 0.0], [0.0, 0.25]));
    let view = glb.view(&bytes);
    glb.json["bufferViews"][view]["byteStride"] = json!(20);
    let accessor = |offset: usize, shape: &str| {
        json!({
            "bufferView": view, "byteOffset": offset, "componentType": F32, "type": shape, "count": 3,
        })
    };
    let positions = glb.push("accessors", accessor(4, "VEC3"));
    let uvs = glb.push("accessors", accessor(16, "VEC2"));
    glb.mesh(json!({ "attributes": { "POSITION": positions, "TEXCOORD_0": uvs } }));
    let primitive = glb.primitive();
    assert_eq!(primitive.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(primitive.uvs, [[Vec2::Y, Vec2::ONE, Vec2::new(0.0, 0.25)]]);
}

#[test]
fn quantised_attributes_of_every_type() {
    let bytes_of = |numbers: &[i16]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    let i16s: Vec<u8> = bytes_of(&[0, 0, 0, 0, 32_767, 0, 0, 0, 0, -32_768, 0, 0]);
    let i8s = vec![0, 0, 0, 0, 127, 0, 0, 0, 0, 128, 0, 0];
    for (component, bytes, normalized, expected) in [
        (I16, i16s.clone(), true, [Vec3::X, Vec3::NEG_Y]),
        (I16, i16s, false, [Vec3::X * 32_767.0, Vec3::NEG_Y * 32_768.0]),
        (I8, i8s.clone(), true, [Vec3::X, Vec3::NEG_Y]),
        (I8, i8s, false, [Vec3::X * 127.0, Vec3::NEG_Y * 128.0]),
        (U8, vec![0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0], true, [Vec3::X, Vec3::Y * 0.2]),
        (U8, vec![0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0, 0], false, [Vec3::X * 255.0, Vec3::Y * 51.0]),
    ] {
        let mut glb = Glb::new();
        glb.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        let positions = glb.accessor(&bytes, component, "VEC3", 3);
        // Quantised positions are padded to four bytes.
        let size = if component == I16 { 8 } else { 4 };
        glb.json["bufferViews"][0]["byteStride"] = json!(size);
        glb.json["accessors"][0]["normalized"] = json!(normalized);
        glb.mesh(json!({ "attributes": { "POSITION": positions } }));
        assert_eq!(glb.primitive().positions[1..], expected, "{component} {normalized}");
    }
}

#[test]
fn quantised_normals_become_unit_vectors() {
    let mut glb = Glb::triangle();
    let normals = glb.accessor(&[90, 90, 0, 0, 0, 0, 100, 0, 0, 0, 127, 0], I8, "VEC3", 3);
    glb.json["bufferViews"][1]["byteStride"] = json!(4);
    glb.json["accessors"][normals]["normalized"] = json!(true);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    let normals = glb.primitive().normals;
    assert!((normals[0] - Vec3::new(FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0)).length() < 1e-6);
    assert_eq!(normals[1..], [Vec3::Z, Vec3::Z]);
}

#[test]
fn sparse_accessors_replace_and_may_stand_alone() {
    for with_base in [true, false] {
        let mut glb = Glb::triangle();
        let at = glb.view(&[1, 2]);
        let values: Vec<u8> =
            [5.0_f32, 0.0, 0.0, 0.0, 7.0, 0.0].iter().flat_map(|n| n.to_le_bytes()).collect();
        let values = glb.view(&values);
        let accessor = &mut glb.json["accessors"][0];
        accessor["sparse"] = json!({
            "count": 2,
            "indices": { "bufferView": at, "componentType": U8 },
            "values": { "bufferView": values },
        });
        if !with_base {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
        assert_eq!(glb.primitive().positions, [Vec3::ZERO, Vec3::X * 5.0, Vec3::Y * 7.0]);
    }
}

#[test]
fn colors_of_three_and_four_numbers() {
    let mut glb = Glb::triangle();
    let colors = glb.accessor(&[255, 0, 51, 9, 0, 0, 0, 9, 255, 255, 255, 9], U8, "VEC3", 3);
    glb.json["bufferViews"][1]["byteStride"] = json!(4);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    for normalized in [true, false] {
        glb.json["accessors"][colors]["normalized"] = json!(normalized);
        let colors = glb.primitive().colors;
        assert_eq!(colors, [Vec4::new(1.0, 0.0, 0.2, 1.0), Vec4::W, Vec4::ONE]);
    }

    let mut glb = Glb::triangle();
    let numbers = [0.5, 2.0, -1.0, 0.25, f32::NAN, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let colors = glb.floats("VEC4", &numbers);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(colors);
    let colors = glb.primitive().colors;
    assert_eq!(colors, [Vec4::new(0.5, 1.0, 0.0, 0.25), Vec4::ONE, Vec4::ONE]);
}

#[test]
fn texture_coordinate_sets_keep_their_numbers() {
    let mut glb = Glb::triangle();
    let uvs = glb.shorts("VEC2", 2, &[0, 0, 65_535, 0, 0, 65_535]);
    glb.json["accessors"][uvs]["normalized"] = json!(true);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_2"] = json!(uvs);
    let uvs = glb.primitive().uvs;
    assert_eq!(uvs.len(), 3);
    assert!(uvs[0].is_empty() && uvs[1].is_empty());
    assert_eq!(uvs[2], [Vec2::ZERO, Vec2::X, Vec2::Y]);
}

#[test]
fn line_widths_are_read_and_repaired() {
    let mut glb = Glb::triangle();
    let widths = glb.floats("SCALAR", &[0.5, -2.0, f32::NAN]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["_LINE_WIDTH"] = json!(widths);
    assert_eq!(glb.primitive().line_widths, [0.5, 0.0, 1.0]);
}

#[test]
fn shade_biases_and_thresholds_are_one_bias() {
    let mut glb = Glb::triangle();
    let biases = glb.floats("SCALAR", &[0.25, f32::NAN, -3.0]);
    let thresholds = glb.floats("SCALAR", &[0.5, 0.25, 0.5]);
    let attributes = &mut glb.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["_SHADE_THRESHOLD"] = json!(thresholds);
    assert_eq!(glb.primitive().shade_biases, [0.0, 0.25, 0.0]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["_SHADE_BIAS"] = json!(biases);
    assert_eq!(glb.primitive().shade_biases, [0.25, 0.25, -1.0]);
}

#[test]
fn missing_normals_are_smooth_over_all_primitives_of_the_mesh() {
    let mut glb = Glb::new();
    // Two faces of a ridge along z, each a primitive of its own.
    let left = glb.floats("VEC3", &[0.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0, 0.0, 1.0]);
    let right = glb.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, -1.0, 0.0]);
    let mesh = json!({ "primitives": [
        { "attributes": { "POSITION": left } }, { "attributes": { "POSITION": right } },
    ] });
    let mesh = glb.push("meshes", mesh);
    glb.push("nodes", json!({ "mesh": mesh }));
    let primitives = &glb.imported().scene.meshes[0].primitives;
    assert!((primitives[0].normals[0] - primitives[1].normals[0]).length() < 1e-6);
    assert!(primitives[0].normals[0].x.abs() < 1e-6);
    assert!(primitives[0].normals[1].x < -0.5);
}

#[test]
fn zero_and_nan_normals_are_repaired_and_others_kept() {
    let mut glb = Glb::triangle();
    let normals = glb.floats("VEC3", &[0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0]);
    glb.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    assert_eq!(glb.primitive().normals, [Vec3::Z, Vec3::Z, Vec3::X]);
}

#[test]
fn a_shared_vertex_buffer_is_cut_to_what_is_used() {
    let mut glb = Glb::new();
    let positions = quad(&mut glb);
    let uvs = glb.floats("VEC2", &[0.0, 0.0, 0.1, 0.0, 0.2, 0.0, 0.3, 0.0]);
    let indices = glb.shorts("SCALAR", 1, &[1, 2, 3]);
    glb.mesh(json!({
        "attributes": { "POSITION": positions, "TEXCOORD_0": uvs }, "indices": indices,
    }));
    let primitive = glb.primitive();
    assert_eq!(primitive.positions, [Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(primitive.indices, [0, 1, 2]);
    assert_eq!(primitive.uvs[0][2], Vec2::new(0.3, 0.0));
}

#[test]
fn influences_are_reduced_to_the_strongest_four() {
    let mut glb = Glb::triangle();
    let joints_0 = glb.accessor(&[1, 2, 3, 4, 0, 9, 9, 9, 7, 0, 0, 0], U8, "VEC4", 3);
    let joints_1 = glb.shorts("VEC4", 4, &[5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    let weights_0 =
        glb.floats("VEC4", &[0.3, 0.01, 0.2, 0.1, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let weights_1 =
        glb.floats("VEC4", &[0.2, 0.09, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let attributes = &mut glb.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints_0);
    attributes["WEIGHTS_0"] = json!(weights_0);
    attributes["JOINTS_1"] = json!(joints_1);
    attributes["WEIGHTS_1"] = json!(weights_1);
    assert!(glb.warning().contains("1 vertices are held by more than four joints"));
    let primitive = &glb.read().unwrap().scene.meshes[0].primitives[0];
    assert_eq!(primitive.joints, [[1, 3, 5, 4], [0, 0, 0, 0], [7, 0, 0, 0]]);
    for (weight, expected) in primitive.weights[0].iter().zip([0.375, 0.25, 0.25, 0.125]) {
        assert!((weight - expected).abs() < 1e-6);
    }
    assert_eq!(primitive.weights[1..], [[1.0, 0.0, 0.0, 0.0]; 2]);
}

#[test]
fn morph_targets_have_names_and_weights() {
    let mut glb = Glb::triangle();
    let offsets = glb.floats("VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, f32::INFINITY]);
    let mesh = &mut glb.json["meshes"][0];
    mesh["primitives"][0]["targets"] = json!([{ "POSITION": offsets }, {}]);
    mesh["weights"] = json!([0.5]);
    mesh["extras"] = json!({ "targetNames": ["blink", 7, "too many"] });
    assert!(glb.warning().contains("1 morph offsets"));
    let scene = glb.read().unwrap().scene;
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.morph_names, ["blink", ""]);
    assert_eq!(mesh.morph_weights, [0.5, 0.0]);
    let targets = &mesh.primitives[0].morph_targets;
    assert_eq!(targets[0].positions, [Vec3::Z, Vec3::Z * 2.0, Vec3::ZERO]);
    assert!(targets[1].positions.is_empty());
}
