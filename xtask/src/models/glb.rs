//! Writing binary glTF 2.0: just what our own models need, the same bytes on every run.

use genga_shapes::Shape;
use glam::{Quat, Vec3};
use serde::Serialize;

use crate::{Error, Result};

/// Constants of the glTF 2.0 specification.
const MAGIC: u32 = 0x4654_6C67;
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// Refers to a material of a [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct MaterialId(usize);

/// Refers to a mesh of a [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct MeshId(usize);

/// A model under construction.
pub(crate) struct Model {
    document: Document,
    binary: Vec<u8>,
}

impl Model {
    /// An empty model; `name` becomes the scene's name.
    pub(crate) fn new(name: &'static str) -> Self {
        let document = Document {
            asset: Asset { generator: "genga xtask models", version: "2.0", copyright: "CC0" },
            extensions_used: Vec::new(),
            extensions: None,
            scene: 0,
            scenes: [Scene { name, nodes: Vec::new() }],
            nodes: Vec::new(),
            cameras: Vec::new(),
            materials: Vec::new(),
            meshes: Vec::new(),
            accessors: Vec::new(),
            buffer_views: Vec::new(),
            buffers: [Buffer { byte_length: 0 }],
        };
        Self { document, binary: Vec::new() }
    }

    /// Adds a rough, non-metallic material. `color` is its sRGB colour as `0xRRGGBB`;
    /// `double_sided` is for open sheets whose backs can be seen.
    pub(crate) fn material(
        &mut self,
        name: &'static str,
        color: u32,
        double_sided: bool,
    ) -> MaterialId {
        let linear = |shift: u32| linear_from_srgb(((color >> shift) & 0xFF) as u8);
        self.document.materials.push(Material {
            name,
            pbr_metallic_roughness: Pbr {
                base_color_factor: [linear(16), linear(8), linear(0), 1.0],
                metallic_factor: 0.0,
                roughness_factor: 1.0,
            },
            double_sided,
        });
        MaterialId(self.document.materials.len() - 1)
    }

    /// Adds a mesh of one material.
    pub(crate) fn mesh(
        &mut self,
        name: &'static str,
        shape: &Shape,
        material: MaterialId,
    ) -> MeshId {
        let vertices = shape.positions.len();
        let least = shape.positions.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let most = shape.positions.iter().copied().reduce(Vec3::max).unwrap_or_default();
        let positions = floats(shape.positions.iter().flat_map(|p| p.to_array()));
        let position = self.accessor(&positions, ARRAY_BUFFER, FLOAT, "VEC3", vertices);
        self.document.accessors[position].min = Some(least.to_array());
        self.document.accessors[position].max = Some(most.to_array());
        let normals = floats(shape.normals.iter().flat_map(|n| n.to_array()));
        let normal = self.accessor(&normals, ARRAY_BUFFER, FLOAT, "VEC3", vertices);
        let texcoord = (!shape.uvs.is_empty()).then(|| {
            let uvs = floats(shape.uvs.iter().flat_map(|uv| uv.to_array()));
            self.accessor(&uvs, ARRAY_BUFFER, FLOAT, "VEC2", vertices)
        });
        // The largest 16-bit index is reserved for restarting a primitive.
        let (component, indices): (u32, Vec<u8>) = if vertices <= usize::from(u16::MAX) {
            let short = |&i: &u32| (i as u16).to_le_bytes();
            (UNSIGNED_SHORT, shape.indices.iter().flat_map(short).collect())
        } else {
            (UNSIGNED_INT, shape.indices.iter().flat_map(|i| i.to_le_bytes()).collect())
        };
        let count = shape.indices.len();
        let indices = self.accessor(&indices, ELEMENT_ARRAY_BUFFER, component, "SCALAR", count);
        self.document.meshes.push(Mesh {
            name,
            primitives: [Primitive {
                attributes: Attributes { position, normal, texcoord },
                indices,
                material: material.0,
            }],
        });
        MeshId(self.document.meshes.len() - 1)
    }

    /// Adds a node that shows a mesh at that place.
    pub(crate) fn object(&mut self, name: &'static str, mesh: MeshId, translation: Vec3) {
        self.node(Node { mesh: Some(mesh.0), translation, ..Node::new(name) });
    }

    /// Adds a mesh and a node of the same name that shows it.
    pub(crate) fn shape(
        &mut self,
        name: &'static str,
        shape: &Shape,
        material: MaterialId,
        translation: Vec3,
    ) {
        let mesh = self.mesh(name, shape, material);
        self.object(name, mesh, translation);
    }

    /// Adds a perspective camera at `eye` that looks at `target`, with that vertical angle of
    /// view in degrees and no far plane.
    pub(crate) fn camera(&mut self, eye: Vec3, target: Vec3, fov_y_deg: f32) {
        let perspective = Perspective { yfov: fov_y_deg.to_radians(), znear: 0.05 };
        self.document.cameras.push(Camera { name: "camera", kind: "perspective", perspective });
        self.node(Node {
            camera: Some(self.document.cameras.len() - 1),
            translation: eye,
            rotation: looking_along(target - eye),
            ..Node::new("camera")
        });
    }

    /// Adds a white directional light that shines along `direction`. Call it once.
    pub(crate) fn sun(&mut self, direction: Vec3) {
        let light = Light { name: "sun", kind: "directional", intensity: 3.0 };
        self.document.extensions_used = vec![LIGHTS];
        self.document.extensions = Some(Extensions { lights: Lights { lights: [light] } });
        self.node(Node {
            extensions: Some(NodeExtensions { light: LightRef { light: 0 } }),
            rotation: looking_along(direction),
            ..Node::new("sun")
        });
    }

    /// The file.
    pub(crate) fn to_glb(&self) -> Result<Vec<u8>> {
        let mut json = serde_json::to_vec(&self.document)?;
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + json.len() + 8 + self.binary.len();
        let too_long = |_| Error::new(format!("{length} bytes do not fit into a GLB file (4 GiB)"));
        let length_word = u32::try_from(length).map_err(too_long)?;
        let mut glb = Vec::with_capacity(length);
        for word in [MAGIC, 2, length_word, json.len() as u32, JSON_CHUNK] {
            glb.extend(word.to_le_bytes());
        }
        glb.extend(json);
        for word in [self.binary.len() as u32, BINARY_CHUNK] {
            glb.extend(word.to_le_bytes());
        }
        glb.extend(&self.binary);
        Ok(glb)
    }

    fn node(&mut self, node: Node) {
        self.document.scenes[0].nodes.push(self.document.nodes.len());
        self.document.nodes.push(node);
    }

    fn accessor(
        &mut self,
        bytes: &[u8],
        target: u32,
        component_type: u32,
        kind: &'static str,
        count: usize,
    ) -> usize {
        self.document.buffer_views.push(BufferView {
            buffer: 0,
            byte_offset: self.binary.len(),
            byte_length: bytes.len(),
            target,
        });
        self.binary.extend(bytes);
        // Every view starts at a multiple of four, which suits every component type.
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.document.buffers[0].byte_length = self.binary.len();
        let buffer_view = self.document.buffer_views.len() - 1;
        let accessor = Accessor { buffer_view, component_type, count, kind, min: None, max: None };
        self.document.accessors.push(accessor);
        self.document.accessors.len() - 1
    }
}

fn floats(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}

/// Rotation of a node whose −Z looks that way with +Y as upright as can be. By square roots
/// alone, so that it is the same on every machine.
fn looking_along(direction: Vec3) -> Quat {
    let back = -direction.normalize();
    let right = Vec3::Y.cross(back).normalize();
    Quat::from_mat3(&glam::Mat3::from_cols(right, back.cross(right), back)).normalize()
}

fn linear_from_srgb(value: u8) -> f32 {
    let value = f64::from(value) / 255.0;
    let linear =
        if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) };
    linear as f32
}

const LIGHTS: &str = "KHR_lights_punctual";

// The document's parts, in the specification's names. Structs rather than JSON values keep the
// order of keys fixed.

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Document {
    asset: Asset,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    extensions_used: Vec<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    extensions: Option<Extensions>,
    scene: usize,
    scenes: [Scene; 1],
    nodes: Vec<Node>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    cameras: Vec<Camera>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    materials: Vec<Material>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    meshes: Vec<Mesh>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<BufferView>,
    buffers: [Buffer; 1],
}

#[derive(Serialize)]
struct Asset {
    generator: &'static str,
    version: &'static str,
    copyright: &'static str,
}

#[derive(Serialize)]
struct Extensions {
    #[serde(rename = "KHR_lights_punctual")]
    lights: Lights,
}

#[derive(Serialize)]
struct Lights {
    lights: [Light; 1],
}

#[derive(Serialize)]
struct Light {
    name: &'static str,
    #[serde(rename = "type")]
    kind: &'static str,
    intensity: f32,
}

#[derive(Serialize)]
struct Scene {
    name: &'static str,
    nodes: Vec<usize>,
}

#[derive(Serialize)]
struct Node {
    name: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    camera: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    extensions: Option<NodeExtensions>,
    #[serde(skip_serializing_if = "is_zero")]
    translation: Vec3,
    #[serde(skip_serializing_if = "is_identity")]
    rotation: Quat,
}

impl Node {
    fn new(name: &'static str) -> Self {
        let (translation, rotation) = (Vec3::ZERO, Quat::IDENTITY);
        Self { name, mesh: None, camera: None, extensions: None, translation, rotation }
    }
}

fn is_zero(translation: &Vec3) -> bool {
    *translation == Vec3::ZERO
}

fn is_identity(rotation: &Quat) -> bool {
    *rotation == Quat::IDENTITY
}

#[derive(Serialize)]
struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    light: LightRef,
}

#[derive(Serialize)]
struct LightRef {
    light: usize,
}

#[derive(Serialize)]
struct Camera {
    name: &'static str,
    #[serde(rename = "type")]
    kind: &'static str,
    perspective: Perspective,
}

#[derive(Serialize)]
struct Perspective {
    yfov: f32,
    znear: f32,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Material {
    name: &'static str,
    pbr_metallic_roughness: Pbr,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    double_sided: bool,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Pbr {
    base_color_factor: [f32; 4],
    metallic_factor: f32,
    roughness_factor: f32,
}

#[derive(Serialize)]
struct Mesh {
    name: &'static str,
    primitives: [Primitive; 1],
}

#[derive(Serialize)]
struct Primitive {
    attributes: Attributes,
    indices: usize,
    material: usize,
}

#[derive(Serialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: usize,
    #[serde(rename = "NORMAL")]
    normal: usize,
    #[serde(rename = "TEXCOORD_0", skip_serializing_if = "Option::is_none")]
    texcoord: Option<usize>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<[f32; 3]>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct BufferView {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
    target: u32,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    byte_length: usize,
}
