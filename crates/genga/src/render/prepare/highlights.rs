//! Highlights: which surfaces carry which, their textures, and once a frame where they stand.

use std::sync::Arc;

use glam::{Affine3A, DMat2, DVec2, Mat2, Mat3, Vec2, Vec3, Vec4};

use super::{Prepared, lights::PlacedLight, looks::in_blend_space};
use crate::render::{
    View,
    generated::{self as gpu, HighlightBlock, LIGHT_DIRECTIONAL, LIGHT_SKY, Light},
    gpu::bindings,
    layouts::Layouts,
    passes::surface::HighlightVariant,
};
use crate::scene::{
    Drawing, FIELD_EXTENT, FIELD_SIZE, Highlight, HighlightBlend, HighlightFrame, HighlightTone,
    Image, Moment, NORMAL_MAP_SIZE, Placed, Placement, Pose, Proxy, ProxyShape, Scene, nodes_below,
};
use crate::style::{BlendSpace, Style};

/// Most highlights of one surface.
pub(crate) const MAX_ON_SURFACE: usize = 4;
/// Texels along a side of a mask.
const MASK_SIZE: usize = 512;

/// The sets of highlights that surfaces carry, while a scene is put together. Set 0 is empty.
pub(crate) struct HighlightSets<'a> {
    scene: &'a Scene,
    sets: Vec<Vec<usize>>,
    /// For each highlight, the nodes that may carry it; `None` for all.
    under: Vec<Option<Vec<bool>>>,
    warnings: Vec<String>,
}

impl<'a> HighlightSets<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let under = scene.highlights.iter().map(|h| h.under.map(|top| nodes_below(scene, top)));
        Self { scene, sets: vec![Vec::new()], under: under.collect(), warnings: Vec::new() }
    }

    /// The set of an object's part of a material.
    pub(crate) fn of(&mut self, node: usize, object: &str, material: &str) -> usize {
        let carried = |(index, highlight): (usize, &Highlight)| {
            let is_under = match self.under.get(index) {
                Some(Some(nodes)) => nodes.get(node).copied().unwrap_or(false),
                _ => true,
            };
            let names = highlight.objects.matches(object) && highlight.materials.matches(material);
            (is_under && names).then_some(index)
        };
        let mut set: Vec<usize> =
            self.scene.highlights.iter().enumerate().filter_map(carried).collect();
        if set.len() > MAX_ON_SURFACE {
            set.truncate(MAX_ON_SURFACE);
            let warning = format!(
                "object '{object}', material '{material}': more than {MAX_ON_SURFACE} highlights lie on \
                 it; the later ones are not drawn there"
            );
            if self.warnings.len() < 20 && !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        self.sets.iter().position(|known| *known == set).unwrap_or_else(|| {
            self.sets.push(set);
            self.sets.len() - 1
        })
    }

    /// The sets, and warnings about highlights that no surface carries.
    pub(crate) fn finish(self) -> (Vec<Vec<usize>>, Vec<String>) {
        let mut warnings = self.warnings;
        for (index, highlight) in self.scene.highlights.iter().enumerate() {
            if !self.sets.iter().any(|set| set.contains(&index)) {
                warnings.push(format!(
                    "highlight {index} '{}' lies on no surface: no object and material has such names",
                    highlight.name
                ));
            }
        }
        (self.sets, warnings)
    }
}

/// The highlights of a prepared scene.
pub(crate) struct Highlights {
    pub(crate) items: Vec<Highlight>,
    sets: Vec<Vec<usize>>,
    layers: Vec<Layers>,
    /// For each highlight, where its node stands.
    world_from_node: Vec<Affine3A>,
    blocks: wgpu::Buffer,
    group: wgpu::BindGroup,
    blend: BlendSpace,
}

/// Texture layers of a highlight.
#[derive(Clone, Copy)]
struct Layers {
    drawing: u32,
    mask: i32,
    normal_map: i32,
}

/// Bytes from one set's block to the next.
const STRIDE: usize =
    size_of::<HighlightBlock>().next_multiple_of(bindings::DYNAMIC_STRIDE as usize);

impl Highlights {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layouts: &Layouts,
        scene: &Scene,
        sets: Vec<Vec<usize>>,
        style: &Style,
    ) -> Self {
        let items = scene.highlights.clone();
        let (mut drawings, mut masks) = (Vec::<&Drawing>::new(), Vec::<&Arc<Image>>::new());
        let mut maps = Vec::<&Proxy>::new();
        let layers = items.iter().map(|highlight| Layers {
            drawing: layer_of(&mut drawings, &highlight.drawing) as u32,
            mask: highlight.mask.as_ref().map_or(-1, |mask| layer_of(&mut masks, mask) as i32),
            normal_map: match &highlight.proxy {
                proxy @ Proxy::Mesh { .. } => layer_of(&mut maps, proxy) as i32,
                _ => -1,
            },
        });
        let layers = layers.collect();
        let fields = drawings.iter().map(|drawing| packed_field(drawing));
        let fields =
            layered(device, queue, FIELD_SIZE, wgpu::TextureFormat::R32Uint, fields.collect());
        let masks = masks.iter().map(|mask| mask_texels(mask)).collect();
        let masks = layered(device, queue, MASK_SIZE, wgpu::TextureFormat::R8Unorm, masks);
        let maps = normal_maps(device, queue, &maps);
        let uniform = wgpu::BufferUsages::UNIFORM;
        let bytes = vec![0_u8; STRIDE * sets.len()];
        let blocks = bindings::buffer(device, queue, "highlights", uniform, &bytes);
        let sampler = |mode| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("highlights"),
                address_mode_u: mode,
                address_mode_v: mode,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            })
        };
        let clamped = sampler(wgpu::AddressMode::ClampToEdge);
        let repeated = sampler(wgpu::AddressMode::Repeat);
        use wgpu::BindingResource as R;
        let group = bindings::group(
            device,
            "highlights",
            &layouts.highlights,
            &[
                (0, super::dynamic_binding::<HighlightBlock>(&blocks)),
                (1, R::TextureView(&fields)),
                (2, R::TextureView(&masks)),
                (3, R::TextureView(&maps)),
                (4, R::Sampler(&clamped)),
                (5, R::Sampler(&repeated)),
            ],
        );
        let world_from_node = vec![Affine3A::IDENTITY; items.len()];
        Self { items, sets, layers, world_from_node, blocks, group, blend: style.paint.blend_space }
    }

    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// Whether a primitive of a node of the prepared scene carries a highlight.
    pub(crate) fn carries(
        &self,
        scene: &Scene,
        index: usize,
        node: usize,
        primitive: usize,
    ) -> bool {
        let Some(object) = scene.nodes.get(node) else { return false };
        let mesh = object.mesh.and_then(|mesh| scene.meshes.get(mesh));
        let material = mesh.and_then(|mesh| mesh.primitives.get(primitive)?.material);
        let material = material.and_then(|m| scene.materials.get(m)).map_or("", |m| &m.name);
        let mut sets = HighlightSets::new(scene);
        let set = sets.of(node, &object.name, material);
        sets.sets[set].contains(&index)
    }

    /// Whether any surface carries one.
    pub(crate) fn any(&self) -> bool {
        self.sets.len() > 1
    }

    /// Dynamic offset of a set's block.
    pub(crate) fn offset(&self, set: usize) -> u32 {
        (set * STRIDE) as u32
    }

    /// What the pipelines of a set are specialised for.
    pub(crate) fn variant(&self, set: usize) -> HighlightVariant {
        let indices = self.sets.get(set).map_or(&[][..], Vec::as_slice);
        let mut variant = HighlightVariant { share_proxy: true, ..HighlightVariant::default() };
        for &index in indices {
            let (highlight, layers) = (&self.items[index], self.layers[index]);
            let first = &self.items[indices[0]];
            variant.count += 1;
            variant.share_proxy &= highlight.proxy == first.proxy
                && highlight.node == first.node
                && highlight.gamma == first.gamma;
            match &highlight.placement {
                Placement::Panorama(_) => variant.on_panorama = true,
                Placement::Free(free) => {
                    variant.is_reshaped |=
                        free.keys.iter().any(|key| key.split != Vec2::ZERO || key.square != 0.0);
                }
            }
            variant.has_axis |= matches!(highlight.proxy, Proxy::Capsule { .. });
            let is_ball = matches!(highlight.proxy, Proxy::Ball { .. });
            let is_round =
                is_ball || matches!(highlight.proxy, Proxy::Sphere { .. } | Proxy::Capsule { .. });
            variant.has_ball |= is_ball;
            variant.has_matrix |= !(is_round && is_evenly_scaled(&self.world_from_node[index]));
            variant.has_normal_map |= layers.normal_map >= 0;
            variant.blends_normals |= highlight.gamma < 1.0;
            variant.replaces |= highlight.blend == HighlightBlend::Replace;
            variant.has_tone |= highlight.tone != HighlightTone::All;
            variant.has_mask |= layers.mask >= 0;
        }
        variant
    }

    /// Takes the places of the highlights' nodes from a pose.
    pub(crate) fn set_pose(&mut self, pose: &Pose) {
        for (slot, highlight) in self.world_from_node.iter_mut().zip(&self.items) {
            let node = highlight.node.and_then(|node| pose.world_from_node.get(node));
            *slot = node.copied().unwrap_or(Affine3A::IDENTITY);
        }
    }

    /// A highlight's frame in the present pose.
    pub(crate) fn frame(&self, index: usize) -> Option<HighlightFrame> {
        let world_from_node = self.world_from_node.get(index)?;
        Some(HighlightFrame::new(self.items.get(index)?, world_from_node))
    }

    /// Light and view as a highlight sees them.
    pub(crate) fn moment(
        &self,
        index: usize,
        placed: &[PlacedLight],
        lights: &[Light],
        view: &View,
    ) -> Option<(HighlightFrame, Moment)> {
        let frame = self.frame(index)?;
        let wanted = self.items.get(index)?.light;
        let number = placed.iter().position(|light| Some(light.node) == wanted).unwrap_or(0);
        let to_light = lights.get(number).or(lights.first()).map_or(Vec3::Y, |light| {
            if light.kind == LIGHT_DIRECTIONAL || light.kind == LIGHT_SKY {
                light.direction.truncate()
            } else {
                light.position.truncate() - frame.center
            }
        });
        let moment = frame.moment(to_light, view.camera.to_eye(frame.center));
        Some((frame, moment))
    }

    /// Evaluates the keys for a view and writes what the shaders need.
    pub(crate) fn write(
        &self,
        queue: &wgpu::Queue,
        prepared: &Prepared,
        view: &View,
        lights: &[Light],
    ) {
        if !self.any() {
            return;
        }
        let values: Vec<gpu::Highlight> = (0..self.items.len())
            .map(|index| {
                let none: gpu::Highlight = bytemuck::Zeroable::zeroed();
                let moment = self.moment(index, &prepared.lights, lights, view);
                moment.map_or(none, |(frame, moment)| self.values(index, &frame, &moment))
            })
            .collect();
        let mut bytes = vec![0_u8; STRIDE * self.sets.len()];
        for (set, slot) in self.sets.iter().zip(bytes.chunks_exact_mut(STRIDE)) {
            let mut block: HighlightBlock = bytemuck::Zeroable::zeroed();
            for (item, &index) in block.items.iter_mut().zip(set) {
                *item = values[index];
            }
            slot[..size_of::<HighlightBlock>()].copy_from_slice(bytemuck::bytes_of(&block));
        }
        queue.write_buffer(&self.blocks, 0, &bytes);
    }

    fn values(&self, index: usize, frame: &HighlightFrame, moment: &Moment) -> gpu::Highlight {
        let (highlight, layers) = (&self.items[index], self.layers[index]);
        let placed = highlight.placement.evaluate(moment);
        let shape = ProxyShape::new(&highlight.proxy, &frame.world_from_node);
        let axes = frame.world_from_frame * placed.axes.as_mat3();
        let [x, y, z] = rows(shape.normals);
        let [right, up] = [axes.x_axis, axes.y_axis];
        let m = drawing_from_place(highlight, &placed);
        let [right, up] = match placed.panorama {
            Some(_) => [right, up],
            None => [m.x_axis.x * right + m.y_axis.x * up, m.x_axis.y * right + m.y_axis.y * up],
        };
        let [yaw, pitch] = placed.panorama.unwrap_or_default();
        let mut flags = 0;
        let mut set = |condition: bool, flag: u32| flags |= if condition { flag } else { 0 };
        set(placed.panorama.is_some(), gpu::HIGHLIGHT_ON_PANORAMA);
        set(highlight.blend == HighlightBlend::Replace, gpu::HIGHLIGHT_REPLACES);
        set(highlight.tone == HighlightTone::Light, gpu::HIGHLIGHT_IN_LIGHT);
        set(highlight.tone == HighlightTone::Shadow, gpu::HIGHLIGHT_IN_SHADOW);
        let mut color = in_blend_space(highlight.color, self.blend);
        color.w *= placed.opacity as f32;
        gpu::Highlight {
            center: shape.origin,
            gamma: highlight.gamma,
            axis: shape.axis,
            axis_length: shape.axis_length,
            normals_x: x.extend(shape.offset.x),
            normals_y: y.extend(shape.offset.y),
            normals_z: z.extend(shape.offset.z),
            right,
            drawing: layers.drawing,
            up,
            mask: layers.mask,
            middle: axes.z_axis,
            normal_map: layers.normal_map,
            drawing_from_angles: Vec4::new(m.x_axis.x, m.x_axis.y, m.y_axis.x, m.y_axis.y),
            panorama: Vec2::new(yaw as f32, pitch as f32),
            split: Vec2::new(placed.split[0] as f32, placed.split[1] as f32),
            square: placed.square.clamp(0.0, 1.0) as f32,
            flags,
            radius: shape.radius,
            reserved_1: 0,
            color,
        }
    }
}

/// Turns and scales coordinates about the middle to those of the drawing. Stereographic ones are
/// tangents of half the angle to the middle, those of a panorama are angles.
fn drawing_from_place(highlight: &Highlight, placed: &Placed) -> Mat2 {
    let half = highlight.size.as_dvec2().map(|size| {
        let size = size.clamp(1e-4, 6.1);
        if placed.panorama.is_some() { 0.5 * size } else { (0.25 * size).tan() }
    });
    let half = half * DVec2::from(placed.scale).map(|scale| scale.clamp(1e-4, 1e4));
    let turn = DMat2::from_angle(-(placed.rotation + f64::from(highlight.angle)));
    (DMat2::from_diagonal(1.0 / half) * turn).as_mat2()
}

/// Whether balls stay balls.
fn is_evenly_scaled(m: &Affine3A) -> bool {
    let gram = Mat3::from(m.matrix3.transpose() * m.matrix3);
    let even = Mat3::from_diagonal(Vec3::splat(gram.x_axis.x));
    gram.abs_diff_eq(even, 1e-4 * gram.x_axis.x.abs())
}

fn rows(m: Mat3) -> [Vec3; 3] {
    [m.row(0), m.row(1), m.row(2)]
}

/// The number of an item in a list without doubles.
pub(super) fn layer_of<'a, T: PartialEq>(known: &mut Vec<&'a T>, item: &'a T) -> usize {
    known.iter().position(|other| **other == *item).unwrap_or_else(|| {
        known.push(item);
        known.len() - 1
    })
}

/// Each value as a signed 16-bit fraction, and above it how it grows to the right and downwards, as
/// signed 8-bit fractions of how far a place moves: a pixel needs one load.
fn packed_field(drawing: &Drawing) -> Vec<u8> {
    // Validation has refused empty drawings.
    let field = drawing.distance_field().unwrap_or_default();
    let value = |x: usize, y: usize| field[y * FIELD_SIZE + x].clamp(-1.0, 1.0);
    let last = FIELD_SIZE - 1;
    let texel = 2.0 * FIELD_EXTENT / FIELD_SIZE as f32;
    let slope = |a: f32, b: f32, texels: usize| {
        ((b - a) / (texel * texels as f32) * 127.0).round().clamp(-127.0, 127.0) as i8
    };
    let mut packed = Vec::with_capacity(4 * field.len());
    for (y, x) in (0..field.len()).map(|i| (i / FIELD_SIZE, i % FIELD_SIZE)) {
        let (left, right) = (x.saturating_sub(1), (x + 1).min(last));
        let (above, below) = (y.saturating_sub(1), (y + 1).min(last));
        let distance = (value(x, y) * 32767.0).round() as i16;
        packed.extend(distance.to_le_bytes());
        packed.extend(slope(value(left, y), value(right, y), right - left).to_le_bytes());
        packed.extend(slope(value(x, above), value(x, below), below - above).to_le_bytes());
    }
    packed
}

/// A picture's luminance times alpha, on a grid of `MASK_SIZE`².
fn mask_texels(mask: &Image) -> Vec<u8> {
    let (width, height) = (mask.width as usize, mask.height as usize);
    // Means over the texels of the picture that fall into one, at least the nearest.
    let span = |i: usize, length: usize| {
        let start = i * length / MASK_SIZE;
        start..((i + 1) * length / MASK_SIZE).max(start + 1).min(length)
    };
    let share = |x: usize, y: usize| {
        let at = 4 * (y * width + x);
        let [r, g, b, a] = [0, 1, 2, 3].map(|c| f32::from(mask.rgba[at + c]));
        (0.2126 * r + 0.7152 * g + 0.0722 * b) * a / 255.0
    };
    (0..MASK_SIZE * MASK_SIZE)
        .map(|i| {
            let (xs, ys) = (span(i % MASK_SIZE, width), span(i / MASK_SIZE, height));
            let count = (xs.len() * ys.len()).max(1) as f32;
            let sum: f32 =
                ys.flat_map(|y| xs.clone().map(move |x| (x, y))).map(|(x, y)| share(x, y)).sum();
            (sum / count).round() as u8
        })
        .collect()
}

/// The normals of meshes by direction, a layer each.
pub(super) fn normal_maps(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    meshes: &[&Proxy],
) -> wgpu::TextureView {
    let side = NORMAL_MAP_SIZE + 2;
    let maps = meshes.iter().map(|proxy| normal_texels(proxy)).collect();
    layered(device, queue, side, wgpu::TextureFormat::Rgba16Float, maps)
}

fn normal_texels(proxy: &Proxy) -> Vec<u8> {
    let Proxy::Mesh { center, mesh } = proxy else { return Vec::new() };
    let texel = |n: Vec3| [n.x, n.y, n.z, 0.0].map(|v| half::f16::from_f32(v).to_le_bytes());
    mesh.normal_map(*center).into_iter().flat_map(texel).flatten().collect()
}

/// A texture of square layers; one black layer if there are none.
fn layered(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    side: usize,
    format: wgpu::TextureFormat,
    layers: Vec<Vec<u8>>,
) -> wgpu::TextureView {
    let texel = format.block_copy_size(None).unwrap_or(1) as usize;
    let (side, layers) = if layers.is_empty() { (1, vec![vec![0; texel]]) } else { (side, layers) };
    let extent = |depth: usize| wgpu::Extent3d {
        width: side as u32,
        height: side as u32,
        depth_or_array_layers: depth as u32,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("highlights"),
        size: extent(layers.len()),
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (layer, bytes) in layers.iter().enumerate() {
        queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: layer as u32 },
                aspect: wgpu::TextureAspect::All,
            },
            bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some((side * texel) as u32),
                rows_per_image: Some(side as u32),
            },
            extent(1),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}
