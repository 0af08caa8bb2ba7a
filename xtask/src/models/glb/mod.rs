//! Writing binary glTF 2.0: just what our own models need, the same bytes on every run.

mod document;

use genga_shapes::Shape;
use glam::{Mat4, Quat, Vec2, Vec3};

use crate::{Error, Result};
use document::{
    Accessor, Animation, Asset, Attributes, Buffer, BufferView, Camera, Channel, ChannelTarget,
    Document, Extensions, LIGHTS, Light, LightRef, Lights, Material, Mesh, MeshExtras, Node,
    NodeExtensions, Pbr, Perspective, Primitive, Sampler, Scene, Skin, Target,
};

/// Constants of the glTF 2.0 specification.
const MAGIC: u32 = 0x4654_6C67;
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// Refers to a material of a [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct MaterialId(usize);

/// Refers to a mesh of a [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct MeshId(usize);

/// Refers to a node of a [`Model`].
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct NodeId(usize);

/// Refers to a skin of a [`Model`].
#[derive(Clone, Copy)]
pub(crate) struct SkinId(usize);

/// Triangles of one material. All but `positions` and `indices` may be empty or have one element
/// per position.
#[derive(Clone, Default)]
pub(crate) struct Surface {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) uvs: Vec<Vec2>,
    /// Indices into the skin's joints.
    pub(crate) joints: Vec<[u8; 4]>,
    /// Weights in 1/65535, which they add up to.
    pub(crate) weights: Vec<[u16; 4]>,
    /// Factors on the width of lines.
    pub(crate) line_widths: Vec<f32>,
    /// Offsets of positions and normals of each morph target.
    pub(crate) targets: Vec<(Vec<Vec3>, Vec<Vec3>)>,
    pub(crate) indices: Vec<u32>,
}

/// What moves one node in a clip: a key for each of the clip's times.
pub(crate) enum Track {
    Rotation(NodeId, Vec<Quat>),
    Translation(NodeId, Vec<Vec3>),
    /// Weights of the morph targets, one after the other for each key.
    Weights(NodeId, Vec<f32>),
}

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
            skins: Vec::new(),
            animations: Vec::new(),
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

    /// Adds a material of that metalness and roughness.
    pub(crate) fn metal(&mut self, name: &'static str, color: u32, roughness: f32) -> MaterialId {
        let id = self.material(name, color, false);
        let pbr = &mut self.document.materials[id.0].pbr_metallic_roughness;
        (pbr.metallic_factor, pbr.roughness_factor) = (1.0, roughness);
        id
    }

    /// Adds a mesh of one material.
    pub(crate) fn mesh(
        &mut self,
        name: &'static str,
        shape: &Shape,
        material: MaterialId,
    ) -> MeshId {
        let surface = Surface {
            positions: shape.positions.clone(),
            normals: shape.normals.clone(),
            uvs: shape.uvs.clone(),
            indices: shape.indices.clone(),
            ..Surface::default()
        };
        self.surfaces(name, &[(surface, material)], &[])
    }

    /// Adds a mesh of several surfaces; `targets` are the names of their morph targets.
    pub(crate) fn surfaces(
        &mut self,
        name: &'static str,
        surfaces: &[(Surface, MaterialId)],
        targets: &[&'static str],
    ) -> MeshId {
        let primitives =
            surfaces.iter().map(|(s, material)| self.primitive(s, *material)).collect();
        let extras = (!targets.is_empty()).then(|| MeshExtras { target_names: targets.to_vec() });
        self.document.meshes.push(Mesh { name, primitives, extras });
        MeshId(self.document.meshes.len() - 1)
    }

    fn primitive(&mut self, surface: &Surface, material: MaterialId) -> Primitive {
        let vertices = surface.positions.len();
        let position = self.vectors(&surface.positions, true);
        let normal = self.vectors(&surface.normals, false);
        let texcoord = (!surface.uvs.is_empty()).then(|| {
            let uvs = floats(surface.uvs.iter().flat_map(|uv| uv.to_array()));
            self.accessor(&uvs, Some(ARRAY_BUFFER), FLOAT, "VEC2", vertices)
        });
        let joints = (!surface.joints.is_empty()).then(|| {
            let joints: Vec<u8> = surface.joints.iter().flatten().copied().collect();
            self.accessor(&joints, Some(ARRAY_BUFFER), UNSIGNED_BYTE, "VEC4", vertices)
        });
        let weights = (!surface.weights.is_empty()).then(|| {
            let shorts = surface.weights.iter().flatten().flat_map(|w| w.to_le_bytes());
            let bytes: Vec<u8> = shorts.collect();
            let id = self.accessor(&bytes, Some(ARRAY_BUFFER), UNSIGNED_SHORT, "VEC4", vertices);
            self.document.accessors[id].normalized = true;
            id
        });
        let line_width = (!surface.line_widths.is_empty()).then(|| {
            let widths = floats(surface.line_widths.iter().copied());
            self.accessor(&widths, Some(ARRAY_BUFFER), FLOAT, "SCALAR", vertices)
        });
        let targets = surface.targets.iter().map(|(positions, normals)| Target {
            position: self.vectors(positions, true),
            normal: self.vectors(normals, false),
        });
        let targets = targets.collect();
        // The largest 16-bit index is reserved for restarting a primitive.
        let (component, indices): (u32, Vec<u8>) = if vertices <= usize::from(u16::MAX) {
            let short = |&i: &u32| (i as u16).to_le_bytes();
            (UNSIGNED_SHORT, surface.indices.iter().flat_map(short).collect())
        } else {
            (UNSIGNED_INT, surface.indices.iter().flat_map(|i| i.to_le_bytes()).collect())
        };
        let count = surface.indices.len();
        let target = Some(ELEMENT_ARRAY_BUFFER);
        let indices = self.accessor(&indices, target, component, "SCALAR", count);
        let attributes = Attributes { position, normal, texcoord, joints, weights, line_width };
        Primitive { attributes, indices, material: material.0, targets }
    }

    /// An accessor of vectors, with its bounds if asked for.
    fn vectors(&mut self, vectors: &[Vec3], bounds: bool) -> usize {
        let bytes = floats(vectors.iter().flat_map(|v| v.to_array()));
        let id = self.accessor(&bytes, Some(ARRAY_BUFFER), FLOAT, "VEC3", vectors.len());
        if bounds {
            let least = vectors.iter().copied().reduce(Vec3::min).unwrap_or_default();
            let most = vectors.iter().copied().reduce(Vec3::max).unwrap_or_default();
            self.document.accessors[id].min = Some(least.to_array().to_vec());
            self.document.accessors[id].max = Some(most.to_array().to_vec());
        }
        id
    }

    /// Adds a joint, or any node that only places what hangs under it.
    pub(crate) fn joint(
        &mut self,
        name: &'static str,
        parent: Option<NodeId>,
        translation: Vec3,
        rotation: Quat,
    ) -> NodeId {
        self.child(parent, Node { translation, rotation, ..Node::new(name) })
    }

    /// Adds a skin; the first joint is the root of the others.
    pub(crate) fn skin(
        &mut self,
        name: &'static str,
        joints: &[NodeId],
        joint_from_mesh: &[Mat4],
    ) -> SkinId {
        let bytes = floats(joint_from_mesh.iter().flat_map(|m| m.to_cols_array()));
        let matrices = self.accessor(&bytes, None, FLOAT, "MAT4", joints.len());
        let joints: Vec<usize> = joints.iter().map(|joint| joint.0).collect();
        let skeleton = joints[0];
        let skin = Skin { name, inverse_bind_matrices: matrices, skeleton, joints };
        self.document.skins.push(skin);
        SkinId(self.document.skins.len() - 1)
    }

    /// Adds a node that shows a skinned mesh.
    pub(crate) fn skinned(&mut self, name: &'static str, mesh: MeshId, skin: SkinId) {
        self.child(None, Node { mesh: Some(mesh.0), skin: Some(skin.0), ..Node::new(name) });
    }

    /// Adds a node under another one that shows a mesh.
    pub(crate) fn attach(&mut self, name: &'static str, parent: NodeId, mesh: MeshId) {
        self.child(Some(parent), Node { mesh: Some(mesh.0), ..Node::new(name) });
    }

    /// Adds an animation clip of linear keys at those seconds, the same for all tracks.
    pub(crate) fn clip(&mut self, name: &'static str, times: &[f32], tracks: &[Track]) {
        let bytes = floats(times.iter().copied());
        let input = self.accessor(&bytes, None, FLOAT, "SCALAR", times.len());
        self.document.accessors[input].min = Some(times[..1].to_vec());
        self.document.accessors[input].max = Some(times[times.len() - 1..].to_vec());
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for track in tracks {
            let (node, path, output) = match track {
                Track::Rotation(node, keys) => {
                    let bytes = floats(keys.iter().flat_map(|q| q.to_array()));
                    (node.0, "rotation", self.accessor(&bytes, None, FLOAT, "VEC4", keys.len()))
                }
                Track::Translation(node, keys) => {
                    let bytes = floats(keys.iter().flat_map(|t| t.to_array()));
                    (node.0, "translation", self.accessor(&bytes, None, FLOAT, "VEC3", keys.len()))
                }
                Track::Weights(node, weights) => {
                    let bytes = floats(weights.iter().copied());
                    let count = weights.len();
                    (node.0, "weights", self.accessor(&bytes, None, FLOAT, "SCALAR", count))
                }
            };
            let target = ChannelTarget { node, path };
            channels.push(Channel { sampler: samplers.len(), target });
            samplers.push(Sampler { input, output });
        }
        self.document.animations.push(Animation { name, channels, samplers });
    }

    /// Adds a node that shows a mesh at that place.
    pub(crate) fn object(&mut self, name: &'static str, mesh: MeshId, translation: Vec3) -> NodeId {
        self.child(None, Node { mesh: Some(mesh.0), translation, ..Node::new(name) })
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
        self.child(None, node);
    }

    fn child(&mut self, parent: Option<NodeId>, node: Node) -> NodeId {
        let id = self.document.nodes.len();
        match parent {
            Some(parent) => self.document.nodes[parent.0].children.push(id),
            None => self.document.scenes[0].nodes.push(id),
        }
        self.document.nodes.push(node);
        NodeId(id)
    }

    fn accessor(
        &mut self,
        bytes: &[u8],
        target: Option<u32>,
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
        self.document.accessors.push(Accessor {
            buffer_view,
            component_type,
            normalized: false,
            count,
            kind,
            min: None,
            max: None,
        });
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
