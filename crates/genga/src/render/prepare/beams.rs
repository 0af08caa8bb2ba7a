//! Beams of a scene → triangles and uniforms for `beams`, and lights.

use glam::{Vec3, Vec4};

use super::{geometry::octahedral_pack, looks::in_blend_space};
use crate::render::{
    generated::{self as gpu, Light, WorldVertex},
    gpu::bindings,
};
use crate::scene::{Beam, BeamMesh, BeamOrder, BeamShape, Pose, Scene};
use crate::style::{BlendSpace, Color};

/// The beams of a scene at a pose.
pub(crate) struct BeamData {
    pub(crate) items: Vec<BeamItem>,
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// A [`gpu::Beam`] each, [`bindings::DYNAMIC_STRIDE`] apart.
    pub(crate) values: wgpu::Buffer,
    /// What they light, with a weight of its own each.
    lights: Vec<Light>,
}

/// One beam.
pub(crate) struct BeamItem {
    pub(crate) order: BeamOrder,
    pub(crate) occluded: bool,
    /// Its number in the scene.
    pub(crate) beam: usize,
    /// Whether it has a line round it.
    pub(crate) outlined: bool,
    /// Marked surfaces have none of their own.
    pub(crate) first_index: u32,
    pub(crate) index_count: u32,
    pub(crate) center: Vec3,
}

impl BeamItem {
    /// Layer of the composite.
    pub(crate) fn layer(&self) -> usize {
        match self.order {
            BeamOrder::Under => 0,
            BeamOrder::LinesThrough => 1,
            BeamOrder::Over | BeamOrder::Hide => 2,
        }
    }
}

/// The beam that a surface is drawn as.
pub(crate) fn beam_of(scene: &Scene, node: usize, object: &str, material: &str) -> Option<usize> {
    scene.beams.iter().rposition(|beam| {
        let BeamShape::Surfaces { under, objects, materials } = &beam.shape else { return false };
        under.is_none_or(|top| is_under(scene, node, top))
            && objects.matches(object)
            && materials.matches(material)
    })
}

fn is_under(scene: &Scene, node: usize, top: usize) -> bool {
    let mut at = Some(node);
    // As long as a path in a forest can be.
    for _ in 0..=scene.nodes.len() {
        match at {
            Some(node) if node == top => return true,
            Some(node) => at = scene.nodes.get(node).and_then(|node| node.parent),
            None => return false,
        }
    }
    false
}

impl BeamData {
    /// Without any beams.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        use wgpu::BufferUsages as Usage;
        let buffer = |label, usage| bindings::buffer(device, queue, label, usage, &[0_u8; 256]);
        Self {
            items: Vec::new(),
            vertices: buffer("beam vertices", Usage::VERTEX),
            indices: buffer("beam indices", Usage::INDEX),
            values: buffer("beams", Usage::UNIFORM),
            lights: Vec::new(),
        }
    }

    /// Whether some beam lies over lines that are farther away.
    pub(crate) fn any_over(&self) -> bool {
        self.items.iter().any(|item| item.layer() == 2)
    }

    /// Takes over beams, which must be valid.
    pub(crate) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        beams: &[Beam],
        pose: &Pose,
        blend: BlendSpace,
    ) {
        use wgpu::BufferUsages as Usage;
        self.items.clear();
        self.lights.clear();
        let (mut vertices, mut indices, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for (number, beam) in beams.iter().enumerate() {
            values.push(beam_values(beam, blend));
            if beam.size <= 0.0 || beam.opacity <= 0.0 {
                continue;
            }
            let mesh = beam.mesh(pose);
            let is_marked = matches!(beam.shape, BeamShape::Surfaces { .. });
            if mesh.indices.is_empty() && !is_marked {
                continue;
            }
            let (first, base) = (indices.len() as u32, vertices.len() as u32);
            indices.extend(mesh.indices.iter().map(|i| base + i));
            vertices.extend(packed(&mesh));
            let count = mesh.positions.len().max(1) as f32;
            self.items.push(BeamItem {
                order: beam.order,
                occluded: beam.occluded,
                beam: number,
                outlined: beam.outline.is_some_and(|outline| outline.width > 0.0),
                first_index: first,
                index_count: mesh.indices.len() as u32,
                center: mesh.positions.iter().map(|p| *p / count).sum(),
            });
            self.lights.extend(light_of(beam, pose, blend));
        }
        let fill = |buffer: &mut wgpu::Buffer, label, usage, bytes: &[u8]| {
            if buffer.size() < bytes.len() as u64 {
                *buffer = bindings::buffer(device, queue, label, usage, bytes);
            } else if !bytes.is_empty() {
                queue.write_buffer(buffer, 0, bytes);
            }
        };
        fill(&mut self.vertices, "beam vertices", Usage::VERTEX, bytemuck::cast_slice(&vertices));
        fill(&mut self.indices, "beam indices", Usage::INDEX, bytemuck::cast_slice(&indices));
        if !values.is_empty() {
            self.values = bindings::dynamic_uniforms(device, queue, "beams", &values);
        }
    }

    pub(crate) fn light_count(&self) -> usize {
        self.lights.len()
    }

    /// The lights that there is room for, the strongest first.
    pub(crate) fn lights(&self) -> Vec<Light> {
        let mut lights = self.lights.clone();
        lights.sort_by(|a, b| b.factors.x.total_cmp(&a.factors.x));
        lights
    }
}

fn packed(mesh: &BeamMesh) -> impl Iterator<Item = WorldVertex> + '_ {
    mesh.positions.iter().zip(&mesh.normals).map(|(p, n)| WorldVertex {
        x: p.x,
        y: p.y,
        z: p.z,
        normal: octahedral_pack(*n),
        smooth_normal: octahedral_pack(*n),
        ..bytemuck::Zeroable::zeroed()
    })
}

fn beam_values(beam: &Beam, blend: BlendSpace) -> gpu::Beam {
    let mut values: gpu::Beam = bytemuck::Zeroable::zeroed();
    let last = beam.ramp.len().saturating_sub(1);
    for i in 0..values.tones.len() {
        let Some(tone) = beam.ramp.get(i.min(last)) else { break };
        let [r, g, b, a] = tone.color.to_array();
        let color = in_blend_space(Color { r, g, b, a }, blend);
        let alpha = color.w * beam.opacity;
        values.tones[i] = (color.truncate() * alpha).extend(alpha);
        let (at, softness) = if i <= last { (tone.at, tone.softness) } else { (2.0, 0.0) };
        let both = &mut values.places[i / 2];
        *both = if i % 2 == 0 {
            Vec4::new(at, softness, both.z, both.w)
        } else {
            Vec4::new(both.x, both.y, at, softness)
        };
    }
    if let Some(outline) = &beam.outline {
        let [r, g, b, a] = outline.color.to_array();
        let color = in_blend_space(Color { r, g, b, a }, blend);
        let alpha = color.w * beam.opacity;
        values.outline = (color.truncate() * alpha).extend(alpha);
        values.outline_width = outline.width;
    }
    let flag = |on: bool, bit: u32| if on { bit } else { 0 };
    values.flags = flag(beam.smooth, gpu::BEAM_SMOOTH)
        | flag(!beam.occluded || beam.order == BeamOrder::Under, gpu::BEAM_BEFORE_ALL)
        | flag(beam.order == BeamOrder::Hide, gpu::BEAM_HIDES)
        | flag(matches!(beam.shape, BeamShape::Surfaces { .. }), gpu::BEAM_TWO_SIDED);
    values
}

/// Its light's shadows go in all directions.
pub(crate) const BEAM_SHADOW_MAPS: u32 = 6;

/// A line of light from a beam's beginning to its end.
fn light_of(beam: &Beam, pose: &Pose, blend: BlendSpace) -> Option<Light> {
    let light = beam.light.filter(|light| light.intensity > 0.0)?;
    let path = beam.path(pose);
    let (first, last) = (*path.first()?, *path.last()?);
    // A pose may have no usable numbers; a light of these would spoil the whole picture.
    if !(first.is_finite() && last.is_finite()) {
        return None;
    }
    let [r, g, b] = beam.light_color().to_array();
    Some(Light {
        position: first.extend(1.0),
        direction: (last - first).extend(0.0),
        factors: Vec4::new(
            light.intensity * beam.opacity * beam.size.min(1.0),
            light.range,
            1.0,
            0.0,
        ),
        kind: gpu::LIGHT_BEAM,
        shadow_first: 0,
        shadow_maps: if light.casts_shadow { BEAM_SHADOW_MAPS } else { 0 },
        reserved_0: 0,
        color: in_blend_space(Color { r, g, b, a: 1.0 }, blend),
    })
}
