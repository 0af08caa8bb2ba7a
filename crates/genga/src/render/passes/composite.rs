//! Paint, background and lines → the caller's texture.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

use super::surface::{cleared, shader};
use crate::render::gpu::{
    bindings::{Binding as B, group, layout, pipeline_layout},
    timing::Timer,
};
use crate::render::{
    frame::{has_line_colors, line_method},
    prepare::{Prepared, waves::GlowKind},
    targets::Targets,
};
use crate::style::BlendSpace;

pub(crate) struct CompositePass {
    layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    made: Mutex<HashMap<Kind, Arc<wgpu::RenderPipeline>>>,
}

/// What a pipeline is specialised for; see `shaders/passes/composite.wesl`.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Kind {
    format: wgpu::TextureFormat,
    glow: GlowKind,
    paint_scale: u32,
    line_method: u32,
    line_colors: bool,
    linear_blend: bool,
    beams: bool,
}

impl CompositePass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let bindings = [
            (0, B::Uniform),
            (1, B::Float),
            (2, B::Float),
            (3, B::Uint),
            (4, B::FloatLayers),
            (5, B::Uniform),
            (6, B::Float),
            (7, B::Float),
            (8, B::Float),
            (9, B::Float),
            (10, B::Float),
            (11, B::Depth),
        ];
        let layout = layout(device, "composite", wgpu::ShaderStages::FRAGMENT, &bindings);
        let pipeline_layout = pipeline_layout(device, "composite", &[&layout]);
        let module = shader(device, "composite", include_str!("../generated/composite.wgsl"));
        Self { layout, pipeline_layout, module, made: Mutex::new(HashMap::new()) }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        (output, format): (&wgpu::TextureView, wgpu::TextureFormat),
        timer: &mut Timer,
    ) {
        use wgpu::BindingResource as R;
        let colors = targets.line_colors.as_ref().map_or(&targets.no_colors, |[colors, _]| colors);
        let line_depths = targets.line_colors.as_ref().map_or(&targets.depth, |[_, depth]| depth);
        let group = group(
            device,
            "composite",
            &self.layout,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, R::TextureView(&targets.paint.view)),
                (2, R::TextureView(&targets.coverage.view)),
                (3, R::TextureView(&targets.mask.view)),
                (4, R::TextureView(&targets.glow.view)),
                (5, prepared.waves.glow.as_entire_binding()),
                (6, R::TextureView(&colors.view)),
                (7, R::TextureView(&targets.beams.layers[0].view)),
                (8, R::TextureView(&targets.beams.layers[1].view)),
                (9, R::TextureView(&targets.beams.layers[2].view)),
                (10, R::TextureView(&targets.beams.places.view)),
                (11, R::TextureView(&line_depths.view)),
            ],
        );
        let style = &prepared.style;
        let pipeline = self.pipeline(
            device,
            Kind {
                format,
                glow: prepared.waves.glow_kind(style),
                beams: targets.size.beams,
                paint_scale: targets.size.paint_scale,
                line_method: line_method(style),
                line_colors: has_line_colors(style),
                linear_blend: style.paint.blend_space == BlendSpace::Linear,
            },
        );
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("composite"),
            color_attachments: &[cleared(output, None)],
            timestamp_writes: timer.render("composite"),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn pipeline(&self, device: &wgpu::Device, kind: Kind) -> Arc<wgpu::RenderPipeline> {
        let number = |on: bool| f64::from(u8::from(on));
        let constants = [
            ("has_glow", number(kind.glow.layers > 0)),
            ("glow_mixes", number(kind.glow.mixes)),
            ("glow_covers", number(kind.glow.covers)),
            ("glow_count", f64::from(kind.glow.layers)),
            ("has_beams", number(kind.beams)),
            ("PAINT_SCALE", f64::from(kind.paint_scale)),
            ("LINE_METHOD", f64::from(kind.line_method)),
            ("LINE_COLORS", number(kind.line_colors)),
            ("LINEAR_BLEND", number(kind.linear_blend)),
            ("LINEAR_OUTPUT", number(is_linear(kind.format))),
        ];
        let make = || {
            Arc::new(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("composite"),
                layout: Some(&self.pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &self.module,
                    entry_point: Some("composite_vertex"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &self.module,
                    entry_point: Some("composite_fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..Default::default()
                    },
                    targets: &[Some(kind.format.into())],
                }),
                multiview_mask: None,
                cache: None,
            }))
        };
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(made.entry(kind).or_insert_with(make))
    }
}

/// Whether a target of that format wants linear light.
fn is_linear(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    format.is_srgb()
        || matches!(
            format,
            F::Rgba16Float | F::Rgba32Float | F::Rg11b10Ufloat | F::R16Float | F::R32Float
        )
}
