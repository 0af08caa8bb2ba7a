//! Scene and style → buffers, bind groups and draw lists. The passes read only what is here.

pub(crate) mod beams;
mod build;
mod directions;
mod drawn;
pub(crate) mod geometry;
mod hatch_picture;
pub(crate) mod highlights;
pub(crate) mod lights;
pub(crate) mod looks;
pub(crate) mod pages;
pub(crate) mod shading;
pub(crate) mod shadows;
pub(crate) mod shine;
mod smears;
pub(crate) mod speed_lines;
mod stipple;
mod stroke_axes;
pub(crate) mod strokes;
mod textures;
pub(crate) mod topology;
mod turning;
pub(crate) mod waves;

use std::collections::HashMap;

use glam::{Affine3A, Vec3, Vec4};

use self::{
    beams::BeamData,
    build::Builder,
    geometry::{Chunk, Geometry},
    highlights::Highlights,
    lights::PlacedLight,
    pages::Place,
    shading::Shadings,
    shadows::Shadows,
    speed_lines::SpeedLineData,
    strokes::StrokeData,
    waves::WaveData,
};
use super::{
    RenderError,
    generated::{self as gpu, Draw},
    gpu::scope,
    layouts::Layouts,
};
use crate::render::passes::surface::{HatchVariant, MaterialVariant};
use crate::scene::{Aabb, Pose, Scene};
use crate::style::Style;

/// A scene under a style, ready to be drawn in any view.
pub struct Prepared {
    pub(crate) style: Style,
    pub(crate) geometry: Geometry,
    pub(crate) draws: Vec<DrawItem>,
    pub(crate) materials: Vec<wgpu::BindGroup>,
    pub(crate) frame: wgpu::Buffer,
    pub(crate) draw_data: wgpu::Buffer,
    pub(crate) light_data: wgpu::Buffer,
    /// Group 0 of the passes that draw surfaces.
    pub(crate) surface_group: wgpu::BindGroup,
    pub(crate) lights: Vec<PlacedLight>,
    pub(crate) shadows: Shadows,
    pub(crate) shadings: Shadings,
    pub(crate) deform: DeformData,
    pub(crate) strokes: StrokeData,
    pub(crate) highlights: Highlights,
    pub(crate) waves: WaveData,
    pub(crate) beams: BeamData,
    pub(crate) speed_lines: SpeedLineData,
    pub(crate) bounds: Option<Aabb>,
    pub(crate) max_width_factor: f32,
    /// Nodes that depth curves count from: number, and place in the present pose.
    anchors: HashMap<String, (usize, Vec3)>,
    draw_values: Vec<Draw>,
    warnings: Vec<String>,
    pub(crate) node_count: usize,
}

/// One chunk of a primitive of a node.
pub(crate) struct DrawItem {
    pub(crate) chunk: Chunk,
    pub(crate) world: Place,
    pub(crate) material: usize,
    /// Which set of highlights it carries.
    pub(crate) highlights: usize,
    pub(crate) double_sided: bool,
    pub(crate) blend: bool,
    pub(crate) mirrored: bool,
    pub(crate) casts_shadow: bool,
    /// Whether parts of it may be cut out or see-through.
    pub(crate) tests_alpha: bool,
    /// Its node and the number of its primitive.
    pub(crate) surface: [usize; 2],
    /// Middle in world space, for sorting.
    pub(crate) center: Vec3,
    /// What its base colour and looks need.
    pub(crate) look: MaterialVariant,
    /// Its first joint matrix.
    matrix_first: u32,
    /// What its hatching needs; `None` if it has none.
    pub(crate) hatch: Option<HatchVariant>,
    /// The beam that it is drawn as, instead of as a surface.
    pub(crate) beam: Option<usize>,
}

/// What the deformation of a scene needs.
pub(crate) struct DeformData {
    matrices: wgpu::Buffer,
    weights: wgpu::Buffer,
    pub(crate) groups: HashMap<[usize; 3], wgpu::BindGroup>,
    pub(crate) uniforms: wgpu::BindGroup,
    nodes: Vec<NodeDeform>,
    matrix_count: usize,
    /// Whether the matrices and weights of the past follow, by which what trails is smeared.
    pub(crate) has_smear: bool,
    weight_count: usize,
}

/// Where the matrices and weights of a node lie.
#[derive(Clone, Copy)]
struct NodeDeform {
    node: usize,
    matrix_first: u32,
    /// Joints; the node's own matrix follows them.
    joint_count: u32,
    weight_first: u32,
    weight_count: u32,
}

impl Prepared {
    /// What could not be drawn as the file or style asks, in sentences for the user.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Bounds of the scene in its present pose; `None` if there is nothing to draw.
    #[must_use]
    pub fn bounds(&self) -> Option<Aabb> {
        self.bounds
    }

    /// Place of a node that a depth curve counts from.
    pub(crate) fn place_of(&self, node: &str) -> Option<Vec3> {
        self.anchors.get(node).map(|&(_, place)| place)
    }

    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layouts: &Layouts,
        scene: &Scene,
        style: &Style,
    ) -> Result<Self, RenderError> {
        scene.validate()?;
        scope::checked(device, || Ok(Builder::new(device, queue, layouts, scene, style).build()))
    }

    /// Whether a scene and pose have the nodes, skins and meshes that this was prepared from.
    pub(crate) fn fits(&self, scene: &Scene, pose: &Pose) -> bool {
        let nodes = scene.nodes.len();
        nodes == self.node_count
            && [pose.world_from_node.len(), pose.morph_weights.len(), pose.visible.len()]
                == [nodes; 3]
    }

    /// Matrices of all joints and nodes, as the deformation wants them.
    fn matrices(&self, scene: &Scene, pose: &Pose) -> Vec<Affine3A> {
        let mut matrices = vec![Affine3A::IDENTITY; self.deform.matrix_count];
        for deform in &self.deform.nodes {
            let first = deform.matrix_first as usize;
            let joints = pose.world_from_rest(scene, deform.node).unwrap_or_default();
            let count = joints.len().min(deform.joint_count as usize);
            matrices[first..first + count].copy_from_slice(&joints[..count]);
            matrices[first + deform.joint_count as usize] = pose.world_from_node[deform.node];
        }
        matrices
    }

    /// Weights of all morph targets.
    fn weights(&self, pose: &Pose) -> Vec<f32> {
        let mut weights = vec![0.0_f32; self.deform.weight_count];
        for deform in &self.deform.nodes {
            let (first, count) = (deform.weight_first as usize, deform.weight_count as usize);
            let posed = &pose.morph_weights[deform.node];
            for (slot, weight) in weights[first..first + count].iter_mut().zip(posed) {
                *slot = if weight.is_finite() { *weight } else { 0.0 };
            }
        }
        weights
    }

    /// Brings the scene to a pose, with the poses before it for speed lines and smears: matrices, weights, lights, waves. The caller then runs `deform`.
    pub(crate) fn write_pose(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        (pose, past): (&Pose, &[Pose]),
    ) {
        self.waves.write(device, queue, &scene.waves, scene.wave_method, pose);
        self.beams.write(device, queue, &scene.beams, pose, self.style.paint.blend_space);
        let motion = (pose, past);
        self.speed_lines.write(device, queue, scene, motion, self.style.motion.shutter_s());
        let mut matrices = self.matrices(scene, pose);
        let mut weights = self.weights(pose);
        if self.deform.has_smear {
            let opened = past.last().unwrap_or(pose);
            matrices.extend(self.matrices(scene, opened));
            weights.extend(self.weights(opened));
        }
        weights.resize(weights.len().max(1), 0.0);
        let rows: Vec<[Vec4; 3]> = matrices
            .iter()
            .map(|m| {
                let (r, t) = (m.matrix3.transpose(), m.translation);
                [
                    Vec3::from(r.x_axis).extend(t.x),
                    Vec3::from(r.y_axis).extend(t.y),
                    Vec3::from(r.z_axis).extend(t.z),
                ]
            })
            .collect();
        queue.write_buffer(&self.deform.matrices, 0, bytemuck::cast_slice(&rows));
        queue.write_buffer(&self.deform.weights, 0, bytemuck::cast_slice(&weights));
        for (item, values) in self.draws.iter_mut().zip(&mut self.draw_values) {
            let matrix = matrices[item.matrix_first as usize];
            item.mirrored = matrix.matrix3.determinant() < 0.0;
            let volume = matrix.matrix3.determinant().abs().max(1e-30);
            values.rest_scale = volume.cbrt().recip();
            item.center = matrix.transform_point3(item.chunk.center);
            if item.mirrored {
                values.flags |= gpu::DRAW_MIRRORED;
            } else {
                values.flags &= !gpu::DRAW_MIRRORED;
            }
        }
        queue.write_buffer(&self.draw_data, 0, bytemuck::cast_slice(&self.draw_values));
        self.lights = lights::placed_lights(scene, pose, &self.style);
        for (node, place) in self.anchors.values_mut() {
            *place = pose.world_from_node[*node].translation.into();
        }
        self.highlights.set_pose(pose);
        self.shadings.set_pose(pose);
        self.bounds = scene.bounds(pose);
    }
}

pub(super) fn dynamic_binding<T>(buffer: &wgpu::Buffer) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer,
        offset: 0,
        size: wgpu::BufferSize::new(size_of::<T>() as u64),
    })
}
