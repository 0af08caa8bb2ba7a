//! Beams over the depth of the painted picture, a layer for each rank.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use super::surface::shader;
use crate::render::gpu::{
    bindings::{Binding as B, DYNAMIC_STRIDE, group, layout, pipeline_layout},
    timing::Timer,
};
use crate::render::{
    frame::Aim,
    generated::{Beam, WorldVertex},
    prepare::{Prepared, beams::BeamItem},
    targets::{BeamTargets, DEPTH_FORMAT, PAINT_FORMAT, Targets, paint_samples},
};

/// What is drawn of a beam, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Part {
    /// Depth alone.
    Depth,
    /// The colour of what is nearest.
    Color,
    /// Depth of the far side pushed out, and then its colour.
    OutlineDepth,
    Outline,
}

/// What a pipeline draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Kind {
    samples: u32,
    part: Part,
    /// With the distance beside the colour.
    over_lines: bool,
    /// The transform mirrors: triangles wind the other way.
    mirrored: bool,
}

pub(crate) struct BeamPass {
    frame_layout: wgpu::BindGroupLayout,
    beam_layout: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    made: Mutex<HashMap<Kind, Arc<wgpu::RenderPipeline>>>,
}

impl BeamPass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let frame_layout = layout(device, "beams' frame", stages, &[(0, B::Uniform)]);
        let beam_layout = layout(device, "beam", stages, &[(0, B::DynamicUniform)]);
        Self {
            layout: pipeline_layout(device, "beams", &[&frame_layout, &beam_layout]),
            frame_layout,
            beam_layout,
            module: shader(device, "beams", include_str!("../generated/beams.wgsl")),
            made: Mutex::new(HashMap::new()),
        }
    }

    /// Draws over the paint's depth, which is another one afterwards.
    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        (targets, beams): (&Targets, &BeamTargets),
        aim: &Aim,
        timer: &mut Timer,
    ) {
        let frame = [(0, prepared.frame.as_entire_binding())];
        let frame = group(device, "beams' frame", &self.frame_layout, &frame);
        let one = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &prepared.beams.values,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<Beam>() as u64),
        });
        let values = group(device, "beam", &self.beam_layout, &[(0, one)]);
        let samples = paint_samples(targets.size.paint_scale);
        // What lies under the paint comes last: no surface may hide it, but other beams would.
        for layer in [1, 2, 0] {
            let over_lines = layer == 2;
            let mut attachments =
                vec![attachment(beams.samples.as_ref(), &beams.layers[layer].view)];
            if over_lines {
                attachments.push(attachment(beams.place_samples.as_ref(), &beams.places.view));
            }
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("beams"),
                color_attachments: &attachments,
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &targets.paint_depth.view,
                    depth_ops: Some(wgpu::Operations {
                        load: wgpu::LoadOp::Load,
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                timestamp_writes: timer.render("beams"),
                ..Default::default()
            });
            aim.set_viewport(&mut pass, targets.size.paint_scale as f32);
            pass.set_bind_group(0, &frame, &[]);
            for item in sorted(&prepared.beams.items, layer, aim.eye) {
                pass.set_bind_group(1, &values, &[item.beam as u32 * DYNAMIC_STRIDE as u32]);
                let all = [Part::Depth, Part::Color, Part::OutlineDepth, Part::Outline];
                for &part in &all[..if item.outlined { 4 } else { 2 }] {
                    let kind = |mirrored| Kind { samples, part, over_lines, mirrored };
                    let pipeline = |mirrored| self.pipeline(device, kind(mirrored));
                    draw(&mut pass, prepared, item, &pipeline);
                }
            }
        }
    }

    fn pipeline(&self, device: &wgpu::Device, kind: Kind) -> Arc<wgpu::RenderPipeline> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(made.entry(kind).or_insert_with(|| Arc::new(self.make(device, kind))))
    }

    fn make(&self, device: &wgpu::Device, kind: Kind) -> wgpu::RenderPipeline {
        let target = |write_mask| {
            Some(wgpu::ColorTargetState {
                format: PAINT_FORMAT,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask,
            })
        };
        let depth_only = matches!(kind.part, Part::Depth | Part::OutlineDepth);
        let mask = if depth_only { wgpu::ColorWrites::empty() } else { wgpu::ColorWrites::ALL };
        let is_outline = matches!(kind.part, Part::OutlineDepth | Part::Outline);
        let entry = match (is_outline, kind.over_lines) {
            (false, false) => "beam_fragment",
            (false, true) => "beam_over_fragment",
            (true, false) => "outline_fragment",
            (true, true) => "outline_over_fragment",
        };
        let targets = [target(mask), target(mask)];
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("beams"),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(if is_outline { "outline_vertex" } else { "beam_vertex" }),
                compilation_options: Default::default(),
                buffers: &[wgpu::VertexBufferLayout {
                    array_stride: size_of::<WorldVertex>() as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32, 2 => Uint32],
                }],
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: is_outline.then_some(wgpu::Face::Front),
                front_face: if kind.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(depth_only),
                depth_compare: Some(if depth_only {
                    wgpu::CompareFunction::Greater
                } else {
                    wgpu::CompareFunction::Equal
                }),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: kind.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &targets[..if kind.over_lines { 2 } else { 1 }],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn attachment<'a>(
    samples: Option<&'a crate::render::targets::Target>,
    resolved: &'a wgpu::TextureView,
) -> Option<wgpu::RenderPassColorAttachment<'a>> {
    super::surface::cleared_samples(samples.map(|target| &target.view), resolved)
}

/// The beams of a layer: those that nothing hides last, else from back to front.
fn sorted(items: &[BeamItem], layer: usize, eye: glam::Vec4) -> Vec<&BeamItem> {
    let nearness = |item: &BeamItem| {
        if eye.w > 0.0 {
            -item.center.distance_squared(eye.truncate())
        } else {
            item.center.dot(eye.truncate())
        }
    };
    let mut of_layer: Vec<&BeamItem> = items.iter().filter(|item| item.layer() == layer).collect();
    of_layer.sort_by(|a, b| {
        let by_depth = nearness(a).total_cmp(&nearness(b)).then(a.beam.cmp(&b.beam));
        b.occluded.cmp(&a.occluded).then(by_depth)
    });
    of_layer
}

fn draw(
    pass: &mut wgpu::RenderPass<'_>,
    prepared: &Prepared,
    item: &BeamItem,
    pipeline: &dyn Fn(bool) -> Arc<wgpu::RenderPipeline>,
) {
    if item.index_count > 0 {
        pass.set_pipeline(&pipeline(false));
        pass.set_vertex_buffer(0, prepared.beams.vertices.slice(..));
        pass.set_index_buffer(prepared.beams.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(item.first_index..item.first_index + item.index_count, 0, 0..1);
        return;
    }
    for surface in prepared.draws.iter().filter(|surface| surface.beam == Some(item.beam)) {
        let world_at = u64::from(surface.world.first) * size_of::<WorldVertex>() as u64;
        let geometry = &prepared.geometry;
        pass.set_pipeline(&pipeline(surface.mirrored));
        pass.set_vertex_buffer(0, geometry.world[surface.world.page].slice(world_at..));
        let indices = &geometry.indices[surface.chunk.indices.page];
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        let first = surface.chunk.indices.first;
        pass.draw_indexed(first..first + surface.chunk.index_count, 0, 0..1);
    }
}
