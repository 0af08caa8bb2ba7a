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
    prepare::{Prepared, waves::GlowKind},
    targets::Targets,
};

pub(crate) struct CompositePass {
    layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    made: Mutex<HashMap<(wgpu::TextureFormat, GlowKind, bool), Arc<wgpu::RenderPipeline>>>,
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
        let glow = prepared.waves.glow_kind(&prepared.style);
        let pipeline = self.pipeline(device, format, glow, targets.size.beams);
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

    fn pipeline(
        &self,
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        glow: GlowKind,
        beams: bool,
    ) -> Arc<wgpu::RenderPipeline> {
        let number = |on: bool| f64::from(u8::from(on));
        let constants = [
            ("has_glow", number(glow.shows)),
            ("glow_mixes", number(glow.mixes)),
            ("has_beams", number(beams)),
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
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            }))
        };
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(made.entry((format, glow, beams)).or_insert_with(make))
    }
}
