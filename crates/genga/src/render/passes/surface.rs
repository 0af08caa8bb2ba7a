//! What the passes that draw surfaces have in common: vertex layout, pipelines by winding and
//! culling, and the walk over the draw list.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use crate::render::generated::{RestVertex, WorldVertex};
use crate::render::gpu::bindings::{DYNAMIC_STRIDE, pipeline_layout};
use crate::render::layouts::Layouts;
use crate::render::prepare::{DrawItem, Prepared, geometry::VertexAttributes, shine::Features};
use crate::render::targets::DEPTH_FORMAT;

/// What differs between the pipelines of one pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Variant {
    /// The transform mirrors: triangles wind the other way.
    pub(crate) mirrored: bool,
    /// Which faces are left out.
    pub(crate) cull: Option<wgpu::Face>,
    /// Blended over what is there, without writing depth.
    pub(crate) blend: bool,
    /// Samples per texel.
    pub(crate) samples: u32,
    /// With highlights on top; `None` for a pipeline that knows nothing of them.
    pub(crate) highlights: Option<HighlightVariant>,
    /// With cast shadows.
    pub(crate) shadows: bool,
    /// An `OUTPUT_*` of `paint.wesl`.
    pub(crate) output: u32,
    /// With ink over the ramp; `None` for a pipeline that knows nothing of it.
    pub(crate) hatch: Option<HatchVariant>,
    /// Comic highlights and the print's colours.
    pub(crate) features: Features,
    /// With other normals for shading.
    pub(crate) edited_shading: bool,
    /// Some of them those of meshes.
    pub(crate) proxy_meshes: bool,
    pub(crate) material: MaterialVariant,
    /// How many lights there are; only paint has a loop over so many.
    pub(crate) lights: u32,
    /// How many of these, the last ones, are beams'.
    pub(crate) beam_lights: u32,
    /// Whether any light stands somewhere.
    pub(crate) placed_lights: bool,
    /// Whether any light but beams' has a colour.
    pub(crate) light_colors: bool,
}

/// What the materials of a pipeline have; see `shaders/shading/material.wesl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct MaterialVariant {
    pub(crate) base: BaseKind,
    pub(crate) emits: bool,
    pub(crate) has_rules: bool,
}

/// Where base colours come from: a `BASE_*`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum BaseKind {
    /// A texture whose values stay as they are.
    #[default]
    Texture,
    /// One colour.
    Color,
    /// A texture, vertex colours and a factor.
    Product,
}

/// What a pipeline with ink is specialised for; see `shaders/shading/hatch.wesl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct HatchVariant {
    pub(crate) has_strokes: bool,
    pub(crate) has_cross: bool,
    pub(crate) has_pencil: bool,
    pub(crate) has_stipple: bool,
    pub(crate) has_dots: bool,
    pub(crate) has_image: bool,
    /// On surfaces; on texture coordinates or the picture.
    pub(crate) has_surface: bool,
    pub(crate) has_plane: bool,
    /// By the light; along an axis of the mesh.
    pub(crate) has_light: bool,
    pub(crate) has_axis: bool,
}

/// What a pipeline with highlights is specialised for; see `shaders/shading/highlight.wesl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct HighlightVariant {
    /// Highlights of the block that are drawn.
    pub(crate) count: u32,
    pub(crate) on_panorama: bool,
    pub(crate) share_proxy: bool,
    pub(crate) has_axis: bool,
    pub(crate) has_ball: bool,
    pub(crate) has_matrix: bool,
    pub(crate) has_normal_map: bool,
    pub(crate) blends_normals: bool,
    pub(crate) is_reshaped: bool,
    pub(crate) replaces: bool,
    pub(crate) has_tone: bool,
    pub(crate) has_mask: bool,
}

impl Variant {
    /// As the material of a draw asks.
    pub(crate) fn of(item: &DrawItem, samples: u32) -> Self {
        let cull = (!item.double_sided).then_some(wgpu::Face::Back);
        Self {
            mirrored: item.mirrored,
            cull,
            blend: false,
            samples,
            highlights: None,
            shadows: false,
            output: 0,
            hatch: None,
            features: Features::default(),
            edited_shading: false,
            proxy_meshes: false,
            material: item.look,
            lights: 0,
            beam_lights: 0,
            placed_lights: false,
            light_colors: false,
        }
    }
}

/// Pipelines of one vertex and fragment stage, made when they are first needed.
pub(crate) struct SurfacePipelines {
    label: &'static str,
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    vertex_entry: &'static str,
    fragment_entry: &'static str,
    /// Layout and fragment stages of the pipelines with highlights, without and with ink.
    highlit: Option<(wgpu::PipelineLayout, [&'static str; 2])>,
    /// Vertex and fragment stage of the pipelines with ink.
    hatched: Option<[&'static str; 2]>,
    formats: Vec<wgpu::TextureFormat>,
    made: Mutex<HashMap<Variant, Arc<wgpu::RenderPipeline>>>,
}

impl SurfacePipelines {
    pub(crate) fn new(
        device: &wgpu::Device,
        layouts: &Layouts,
        label: &'static str,
        module: wgpu::ShaderModule,
        [vertex_entry, fragment_entry]: [&'static str; 2],
        formats: &[wgpu::TextureFormat],
    ) -> Self {
        Self {
            label,
            module,
            layout: pipeline_layout(device, label, &[&layouts.surface, &layouts.material]),
            vertex_entry,
            fragment_entry,
            highlit: None,
            hatched: None,
            formats: formats.to_vec(),
            made: Mutex::new(HashMap::new()),
        }
    }

    /// Adds pipelines with ink, by other stages of the same module.
    pub(crate) fn with_ink(mut self, entries: [&'static str; 2]) -> Self {
        self.hatched = Some(entries);
        self
    }

    /// Adds pipelines with highlights, by other fragment stages of the same module: without and
    /// with ink.
    pub(crate) fn with_highlights(
        mut self,
        device: &wgpu::Device,
        layouts: &Layouts,
        fragment_entries: [&'static str; 2],
    ) -> Self {
        let groups = [&layouts.surface, &layouts.material, &layouts.highlights];
        self.highlit = Some((pipeline_layout(device, self.label, &groups), fragment_entries));
        self
    }

    /// The pipeline of a variant.
    pub(crate) fn get(&self, device: &wgpu::Device, variant: Variant) -> Arc<wgpu::RenderPipeline> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(made.entry(variant).or_insert_with(|| Arc::new(self.make(device, variant))))
    }

    fn make(&self, device: &wgpu::Device, variant: Variant) -> wgpu::RenderPipeline {
        let blend = variant.blend.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let targets: Vec<_> = self
            .formats
            .iter()
            .map(|&format| {
                Some(wgpu::ColorTargetState { format, blend, write_mask: wgpu::ColorWrites::ALL })
            })
            .collect();
        let hatched = self.hatched.filter(|_| variant.hatch.is_some());
        let (layout, fragment_entry) = match (&self.highlit, variant.highlights, hatched) {
            (Some((layout, entries)), Some(_), hatched) => {
                (layout, entries[usize::from(hatched.is_some())])
            }
            (_, _, Some([_, entry])) => (&self.layout, entry),
            _ => (&self.layout, self.fragment_entry),
        };
        let vertex_entry = hatched.map_or(self.vertex_entry, |[entry, _]| entry);
        let hatch = variant.hatch.unwrap_or_default();
        let highlights = variant.highlights.unwrap_or_default();
        let yes = |on: bool| f64::from(u8::from(on));
        let shading = [
            ("SHADOWS", yes(variant.shadows)),
            ("OUTPUT", f64::from(variant.output)),
            ("SPECULAR", yes(variant.features.specular)),
            ("RIM_LIGHT", yes(variant.features.rim_light)),
            ("SHEEN", yes(variant.features.sheen)),
            ("PALETTE", yes(variant.features.palette)),
            ("DOTS", yes(variant.features.dots)),
            ("RIM_LINE", yes(variant.features.rim_line)),
            ("SHADE_PICTURES", yes(variant.features.shade_pictures)),
            ("EDITED_SHADING", yes(variant.edited_shading)),
            ("LINEAR_BLEND", yes(variant.features.linear_blend)),
            ("LIGHTS", f64::from(variant.lights)),
            ("PLACED_LIGHTS", yes(variant.placed_lights)),
            ("LIGHT_COLORS", yes(variant.light_colors)),
            ("BEAM_LIGHTS", f64::from(variant.beam_lights)),
        ];
        let hatch_constants = [
            ("HATCH_HAS_STROKES", yes(hatch.has_strokes)),
            ("HATCH_HAS_CROSS", yes(hatch.has_cross)),
            ("HATCH_HAS_PENCIL", yes(hatch.has_pencil)),
            ("HATCH_HAS_STIPPLE", yes(hatch.has_stipple)),
            ("HATCH_HAS_DOTS", yes(hatch.has_dots)),
            ("HATCH_HAS_IMAGE", yes(hatch.has_image)),
            ("HATCH_HAS_SURFACE", yes(hatch.has_surface)),
            ("HATCH_HAS_PLANE", yes(hatch.has_plane)),
            ("HATCH_HAS_LIGHT", yes(hatch.has_light)),
            ("HATCH_HAS_AXIS", yes(hatch.has_axis)),
        ];
        let highlight_constants = [
            ("HIGHLIGHTS", f64::from(highlights.count)),
            ("ON_PANORAMA", yes(highlights.on_panorama)),
            ("SHARE_PROXY", yes(highlights.share_proxy)),
            ("HAS_AXIS", yes(highlights.has_axis)),
            ("HAS_BALL", yes(highlights.has_ball)),
            ("HAS_MATRIX", yes(highlights.has_matrix)),
            ("HAS_NORMAL_MAP", yes(highlights.has_normal_map)),
            ("BLENDS_NORMALS", yes(highlights.blends_normals)),
            ("IS_RESHAPED", yes(highlights.is_reshaped)),
            ("REPLACES", yes(highlights.replaces)),
            ("HAS_TONE", yes(highlights.has_tone)),
            ("HAS_MASK", yes(highlights.has_mask)),
        ];
        let material = variant.material;
        let mut constants: Vec<(&str, f64)> = vec![
            ("BASE", f64::from(material.base as u8)),
            ("EMITS", yes(material.emits)),
            ("HAS_RULES", yes(material.has_rules)),
        ];
        if variant.highlights.is_some() {
            constants.extend(highlight_constants);
        }
        if hatched.is_some() {
            constants.extend(hatch_constants);
        }
        // Only the paint pass has these.
        constants.extend(shading.into_iter().filter(|(_, value)| *value != 0.0));
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex_entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: match (variant.edited_shading, variant.proxy_meshes) {
                        (true, true) => &[("EDITED_SHADING", 1.0), ("PROXY_MESHES", 1.0)],
                        (true, false) => &[("EDITED_SHADING", 1.0)],
                        _ => &[],
                    },
                    ..Default::default()
                },
                buffers: &VERTEX_BUFFERS[..if hatched.is_some() { 3 } else { 2 }],
            },
            primitive: wgpu::PrimitiveState {
                front_face: if variant.mirrored {
                    wgpu::FrontFace::Cw
                } else {
                    wgpu::FrontFace::Ccw
                },
                cull_mode: variant.cull,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(!variant.blend),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: variant.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(fragment_entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..Default::default()
                },
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// World vertices, attributes, and for ink the vertices at rest.
static VERTEX_BUFFERS: [wgpu::VertexBufferLayout<'_>; 3] = [
    wgpu::VertexBufferLayout {
        array_stride: size_of::<WorldVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Uint32, 2 => Uint32, 3 => Float16x2, 8 => Uint32
        ],
    },
    wgpu::VertexBufferLayout {
        array_stride: size_of::<VertexAttributes>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![
            4 => Float32x2, 5 => Float32x2, 6 => Unorm16x4, 7 => Uint32
        ],
    },
    wgpu::VertexBufferLayout {
        array_stride: size_of::<RestVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &[
            attribute(9, wgpu::VertexFormat::Float32x3, 0),
            attribute(10, wgpu::VertexFormat::Uint32, std::mem::offset_of!(RestVertex, normal)),
            attribute(11, wgpu::VertexFormat::Uint32, std::mem::offset_of!(RestVertex, hatch)),
            attribute(
                12,
                wgpu::VertexFormat::Float16x2,
                std::mem::offset_of!(RestVertex, hatch_turning),
            ),
        ],
    },
];

const fn attribute(
    shader_location: u32,
    format: wgpu::VertexFormat,
    offset: usize,
) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset: offset as u64, shader_location }
}

/// A shader module of linked WGSL.
pub(crate) fn shader(device: &wgpu::Device, label: &str, wgsl: &'static str) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    })
}

/// The colour attachment of targets that may be multisampled, cleared to zero; what is kept is
/// `resolved`.
pub(crate) fn cleared_samples<'a>(
    samples: Option<&'a wgpu::TextureView>,
    resolved: &'a wgpu::TextureView,
) -> Option<wgpu::RenderPassColorAttachment<'a>> {
    samples.map_or_else(|| cleared(resolved, None), |samples| cleared(samples, Some(resolved)))
}

/// A colour attachment that is cleared to zero and kept.
pub(crate) fn cleared<'a>(
    view: &'a wgpu::TextureView,
    resolve_target: Option<&'a wgpu::TextureView>,
) -> Option<wgpu::RenderPassColorAttachment<'a>> {
    // With a resolve target only that one is needed afterwards.
    let store =
        if resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store },
    })
}

/// A depth attachment, cleared to the far end of reverse Z.
pub(crate) fn cleared_depth(
    view: &wgpu::TextureView,
    store: wgpu::StoreOp,
) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
    Some(wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
        stencil_ops: None,
    })
}

/// Draws items in the given order, each with its own pipeline.
pub(crate) fn draw_items<'a>(
    device: &wgpu::Device,
    pass: &mut wgpu::RenderPass<'_>,
    prepared: &'a Prepared,
    pipelines: &SurfacePipelines,
    items: impl Iterator<Item = (usize, &'a DrawItem, Variant)>,
) {
    let (mut variant_set, mut material_set, mut block_set) = (None, None, None);
    for (index, item, variant) in items {
        let number = (index as u64 * DYNAMIC_STRIDE) as u32;
        pass.set_bind_group(0, &prepared.surface_group, &[number]);
        if variant.highlights.is_some() && block_set != Some(item.highlights) {
            let offset = prepared.highlights.offset(item.highlights);
            pass.set_bind_group(2, prepared.highlights.group(), &[offset]);
            block_set = Some(item.highlights);
        }
        if variant_set != Some(variant) {
            pass.set_pipeline(&pipelines.get(device, variant));
            variant_set = Some(variant);
        }
        if material_set != Some(item.material) {
            pass.set_bind_group(1, &prepared.materials[item.material], &[]);
            material_set = Some(item.material);
        }
        let geometry = &prepared.geometry;
        let chunk = &item.chunk;
        let world_at = u64::from(item.world.first) * size_of::<WorldVertex>() as u64;
        let rest_at = u64::from(chunk.rest.first) * size_of::<VertexAttributes>() as u64;
        pass.set_vertex_buffer(0, geometry.world[item.world.page].slice(world_at..));
        pass.set_vertex_buffer(1, geometry.attributes[chunk.rest.page].slice(rest_at..));
        if variant.hatch.is_some() {
            let rest_at = u64::from(chunk.rest.first) * size_of::<RestVertex>() as u64;
            pass.set_vertex_buffer(2, geometry.rest[chunk.rest.page].slice(rest_at..));
        }
        let indices = &geometry.indices[chunk.indices.page];
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        let first = chunk.indices.first;
        pass.draw_indexed(first..first + chunk.index_count, 0, 0..1);
    }
}

/// Draws with their numbers in the draw list.
type NumberedItems<'a> = Vec<(usize, &'a DrawItem)>;

/// The opaque and masked draws in their order, then the blended ones from back to front as seen
/// from `eye` (`w` as in `Frame::eye`).
pub(crate) fn sorted_items(prepared: &Prepared, eye: glam::Vec4) -> [NumberedItems<'_>; 2] {
    let surfaces = prepared.draws.iter().enumerate().filter(|(_, item)| item.beam.is_none());
    let (opaque, mut blended): (Vec<_>, Vec<_>) = surfaces.partition(|(_, item)| !item.blend);
    let nearness = |item: &DrawItem| {
        if eye.w > 0.0 {
            -item.center.distance_squared(eye.truncate())
        } else {
            item.center.dot(eye.truncate())
        }
    };
    blended.sort_by(|(i, a), (j, b)| nearness(a).total_cmp(&nearness(b)).then(i.cmp(j)));
    [opaque, blended]
}
