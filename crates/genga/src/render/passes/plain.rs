//! The benchmark's baseline: texture and Lambert in one pass.

use super::surface::{
    SurfacePipelines, Variant, cleared_depth, cleared_samples, draw_items, shader, sorted_items,
};
use crate::render::gpu::timing::Timer;
use crate::render::{
    layouts::Layouts,
    prepare::Prepared,
    targets::{DEPTH_FORMAT, PLAIN_FORMAT, paint_samples, target},
};

pub(crate) struct PlainPass {
    pipelines: SurfacePipelines,
}

/// The baseline's own targets, multisampled as the paint pass is.
pub(crate) struct PlainTargets {
    samples: Option<wgpu::TextureView>,
    sample_count: u32,
    resolved: wgpu::TextureView,
    depth: wgpu::TextureView,
}

impl PlainTargets {
    pub(crate) fn new(device: &wgpu::Device, size: [u32; 2], paint_scale: u32) -> Self {
        let size = size.map(|n| n * paint_scale);
        let count = paint_samples(paint_scale);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let make =
            |label, samples, format| target(device, label, size, samples, format, usage).view;
        Self {
            samples: (count > 1).then(|| make("plain samples", count, PLAIN_FORMAT)),
            sample_count: count,
            resolved: make("plain", 1, PLAIN_FORMAT),
            depth: make("plain depth", count, DEPTH_FORMAT),
        }
    }
}

impl PlainPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "plain", include_str!("../generated/plain.wgsl"));
        let entries = ["plain_vertex", "plain_fragment"];
        let formats = [PLAIN_FORMAT];
        Self {
            pipelines: SurfacePipelines::new(device, layouts, "plain", module, entries, &formats),
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &PlainTargets,
        eye: glam::Vec4,
        timer: &mut Timer,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("plain"),
            color_attachments: &[cleared_samples(targets.samples.as_ref(), &targets.resolved)],
            depth_stencil_attachment: cleared_depth(&targets.depth, wgpu::StoreOp::Discard),
            timestamp_writes: timer.render("plain"),
            ..Default::default()
        });
        let [opaque, blended] = sorted_items(prepared, eye);
        let items = opaque
            .into_iter()
            .chain(blended)
            .map(|(i, item)| (i, item, Variant::of(item, targets.sample_count)));
        draw_items(device, &mut pass, prepared, &self.pipelines, items);
    }
}
