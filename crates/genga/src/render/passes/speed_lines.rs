//! Strokes behind what is fast → coverage of their line set.

use std::sync::OnceLock;

use super::{
    strokes::{coverage_pipeline, depth_pipeline},
    surface::shader,
};
use crate::render::gpu::{
    bindings::{Binding as B, group, layout},
    timing::Timer,
};
use crate::render::{frame::needs_line_depths, prepare::Prepared, targets::Targets};

pub(crate) struct SpeedLinePass {
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    pipeline: wgpu::RenderPipeline,
    /// Writes the strokes' depths, for beams.
    depths: OnceLock<wgpu::RenderPipeline>,
}

impl SpeedLinePass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let bindings = [(0, B::Uniform), (1, B::Float), (2, B::Storage)];
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let layout = layout(device, "speed lines", stages, &bindings);
        let module = shader(device, "speed lines", include_str!("../generated/speed_lines.wgsl"));
        let entries = ["speed_line_vertex", "speed_line_fragment"];
        let pipeline = coverage_pipeline(device, "speed lines", &[&layout], &module, entries);
        Self { layout, module, pipeline, depths: OnceLock::new() }
    }

    /// Draws over the coverage that is there, and over the depths of strokes if beams need them.
    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        let group = group(
            device,
            "speed lines",
            &self.layout,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, wgpu::BindingResource::TextureView(targets.full_depth())),
                (2, prepared.speed_lines.strokes.as_entire_binding()),
            ],
        );
        let kept = wgpu::RenderPassColorAttachment {
            view: &targets.coverage.view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("speed lines"),
            color_attachments: &[Some(kept)],
            timestamp_writes: timer.render("speed lines"),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..6 * prepared.speed_lines.count, 0..1);
        drop(pass);
        let line_colors = targets.line_colors.as_ref().filter(|_| needs_line_depths(prepared));
        let Some([_, depth]) = line_colors else { return };
        let pipeline = self.depths.get_or_init(|| {
            let entries = ["speed_line_vertex", "speed_line_depth_fragment"];
            depth_pipeline(device, "depths of speed lines", &[&self.layout], &self.module, entries)
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depths of speed lines"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth.view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Load,
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: timer.render("depths of speed lines"),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..6 * prepared.speed_lines.count, 0..1);
    }
}
