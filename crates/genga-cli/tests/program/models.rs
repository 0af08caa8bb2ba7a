//! Small models.

/// A binary glTF file of this JSON and binary chunk.
pub(crate) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 28 + text.len() + binary.len();
    let size = |n: usize| u32::try_from(n).expect("a small file").to_le_bytes();
    let mut file = b"glTF".to_vec();
    file.extend(size(2));
    file.extend(size(length));
    file.extend(size(text.len()));
    file.extend(b"JSON");
    file.extend(text);
    file.extend(size(binary.len()));
    file.extend(b"BIN\0");
    file.extend(binary);
    file
}

/// Corners of a tetrahedron, and its triangles.
pub(crate) const CORNERS: [[f32; 3]; 4] =
    [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
pub(crate) const TRIANGLES: [u16; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

/// A model of these triangles, without normals and texture coordinates. `extra` goes into the
/// JSON's root, `node` into its only node.
pub(crate) fn model(corners: &[[f32; 3]], triangles: &[u16], node: &str, extra: &str) -> Vec<u8> {
    let mut binary: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let vertices = binary.len();
    binary.extend(triangles.iter().flat_map(|i| i.to_le_bytes()));
    let indices = binary.len() - vertices;
    binary.resize(binary.len().next_multiple_of(4), 0);
    // For animations: two times, then two translations.
    let times = binary.len();
    binary.extend([0.0_f32, 1.0].iter().flat_map(|x| x.to_le_bytes()));
    let moves = binary.len();
    binary.extend([0.0_f32, 0.0, 0.0, 4.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()));
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0{node}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"material":0}}]}}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]}},
            {{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}},
            {{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]}},
            {{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}}],
        "bufferViews":[
            {{"buffer":0,"byteOffset":0,"byteLength":{vertices}}},
            {{"buffer":0,"byteOffset":{vertices},"byteLength":{indices}}},
            {{"buffer":0,"byteOffset":{times},"byteLength":8}},
            {{"buffer":0,"byteOffset":{moves},"byteLength":24}}],
        "buffers":[{{"byteLength":{}}}]{extra}}}"#,
        corners.len(),
        triangles.len(),
        binary.len(),
    );
    glb(&json, &binary)
}

const RED: &str =
    r#","materials":[{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}}]"#;

/// A red tetrahedron.
pub(crate) fn tetrahedron() -> Vec<u8> {
    model(&CORNERS, &TRIANGLES, "", RED)
}

/// A tetrahedron that moves to the right within a second.
pub(crate) fn moving() -> Vec<u8> {
    let extra = format!(
        r#"{RED},"animations":[{{"name":"Slide","channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],"samplers":[{{"input":2,"output":3}}]}}]"#
    );
    model(&CORNERS, &TRIANGLES, "", &extra)
}

/// A tetrahedron with a texture in a file.
pub(crate) fn textured(uri: &str) -> Vec<u8> {
    let extra = format!(
        r#","materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],"textures":[{{"source":0}}],"images":[{{"uri":"{uri}"}}]"#
    );
    model(&CORNERS, &TRIANGLES, "", &extra)
}
