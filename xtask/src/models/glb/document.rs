//! The document's parts, in the specification's names. Structs rather than JSON values keep the
//! order of keys fixed.

use glam::{Quat, Vec3};
use serde::Serialize;

pub(super) const LIGHTS: &str = "KHR_lights_punctual";

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) asset: Asset,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) extensions_used: Vec<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<Extensions>,
    pub(super) scene: usize,
    pub(super) scenes: [Scene; 1],
    pub(super) nodes: Vec<Node>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) cameras: Vec<Camera>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) materials: Vec<Material>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) meshes: Vec<Mesh>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) skins: Vec<Skin>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) animations: Vec<Animation>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<BufferView>,
    pub(super) buffers: [Buffer; 1],
}

#[derive(Serialize)]
pub(super) struct Asset {
    pub(super) generator: &'static str,
    pub(super) version: &'static str,
    pub(super) copyright: &'static str,
}

#[derive(Serialize)]
pub(super) struct Extensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) lights: Lights,
}

#[derive(Serialize)]
pub(super) struct Lights {
    pub(super) lights: [Light; 1],
}

#[derive(Serialize)]
pub(super) struct Light {
    pub(super) name: &'static str,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    pub(super) intensity: f32,
}

#[derive(Serialize)]
pub(super) struct Scene {
    pub(super) name: &'static str,
    pub(super) nodes: Vec<usize>,
}

#[derive(Serialize)]
pub(super) struct Node {
    pub(super) name: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mesh: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) skin: Option<usize>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) children: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) camera: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extensions: Option<NodeExtensions>,
    #[serde(skip_serializing_if = "is_zero")]
    pub(super) translation: Vec3,
    #[serde(skip_serializing_if = "is_identity")]
    pub(super) rotation: Quat,
}

impl Node {
    pub(super) fn new(name: &'static str) -> Self {
        Self {
            name,
            mesh: None,
            skin: None,
            children: Vec::new(),
            camera: None,
            extensions: None,
            translation: Vec3::ZERO,
            rotation: Quat::IDENTITY,
        }
    }
}

pub(super) fn is_zero(translation: &Vec3) -> bool {
    *translation == Vec3::ZERO
}

pub(super) fn is_identity(rotation: &Quat) -> bool {
    *rotation == Quat::IDENTITY
}

#[derive(Serialize)]
pub(super) struct NodeExtensions {
    #[serde(rename = "KHR_lights_punctual")]
    pub(super) light: LightRef,
}

#[derive(Serialize)]
pub(super) struct LightRef {
    pub(super) light: usize,
}

#[derive(Serialize)]
pub(super) struct Camera {
    pub(super) name: &'static str,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    pub(super) perspective: Perspective,
}

#[derive(Serialize)]
pub(super) struct Perspective {
    pub(super) yfov: f32,
    pub(super) znear: f32,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Material {
    pub(super) name: &'static str,
    pub(super) pbr_metallic_roughness: Pbr,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) double_sided: bool,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Pbr {
    pub(super) base_color_factor: [f32; 4],
    pub(super) metallic_factor: f32,
    pub(super) roughness_factor: f32,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Mesh {
    pub(super) name: &'static str,
    pub(super) primitives: Vec<Primitive>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) extras: Option<MeshExtras>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct MeshExtras {
    pub(super) target_names: Vec<&'static str>,
}

#[derive(Serialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: usize,
    pub(super) material: usize,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) targets: Vec<Target>,
}

#[derive(Serialize)]
pub(super) struct Target {
    #[serde(rename = "POSITION")]
    pub(super) position: usize,
    #[serde(rename = "NORMAL")]
    pub(super) normal: usize,
}

#[derive(Serialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) position: usize,
    #[serde(rename = "NORMAL")]
    pub(super) normal: usize,
    #[serde(rename = "TEXCOORD_0", skip_serializing_if = "Option::is_none")]
    pub(super) texcoord: Option<usize>,
    #[serde(rename = "JOINTS_0", skip_serializing_if = "Option::is_none")]
    pub(super) joints: Option<usize>,
    #[serde(rename = "WEIGHTS_0", skip_serializing_if = "Option::is_none")]
    pub(super) weights: Option<usize>,
    #[serde(rename = "_LINE_WIDTH", skip_serializing_if = "Option::is_none")]
    pub(super) line_width: Option<usize>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: usize,
    pub(super) component_type: u32,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) normalized: bool,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) min: Option<Vec<f32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max: Option<Vec<f32>>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) target: Option<u32>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) byte_length: usize,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Skin {
    pub(super) name: &'static str,
    pub(super) inverse_bind_matrices: usize,
    pub(super) skeleton: usize,
    pub(super) joints: Vec<usize>,
}

#[derive(Serialize)]
pub(super) struct Animation {
    pub(super) name: &'static str,
    pub(super) channels: Vec<Channel>,
    pub(super) samplers: Vec<Sampler>,
}

#[derive(Serialize)]
pub(super) struct Channel {
    pub(super) sampler: usize,
    pub(super) target: ChannelTarget,
}

#[derive(Serialize)]
pub(super) struct ChannelTarget {
    pub(super) node: usize,
    pub(super) path: &'static str,
}

#[derive(Serialize)]
pub(super) struct Sampler {
    pub(super) input: usize,
    pub(super) output: usize,
}
