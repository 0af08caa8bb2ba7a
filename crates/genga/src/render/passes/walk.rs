//! Lines in view → pieces on the picture.

use std::sync::OnceLock;

use super::{link::SizePass, surface::shader};
use crate::render::gpu::{
    bindings::{compute_pipeline, group, pipeline_layout, specialised_pipeline},
    timing::Timer,
};
use crate::render::{layouts::Layouts, prepare::Prepared, targets::Targets};

pub(crate) struct WalkPass {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    pipeline: wgpu::ComputePipeline,
    /// Made when detection is first smaller than the picture.
    small: OnceLock<wgpu::ComputePipeline>,
}

impl WalkPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "walk", include_str!("../generated/walk.wgsl"));
        let layout = pipeline_layout(device, "walk", &[&layouts.lines]);
        let pipeline = compute_pipeline(device, &layout, &module, "walk_lines");
        Self { module, layout, pipeline, small: OnceLock::new() }
    }

    /// `lines` is from [`lines_group`].
    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (sizes, lines): (&SizePass, &wgpu::BindGroup),
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        encoder.clear_buffer(&targets.marks, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("walk"),
            timestamp_writes: timer.compute("walk"),
        });
        sizes.lines(device, &mut pass, prepared, targets);
        let pipeline = if targets.size.gbuffer_scale.is_small() {
            self.small.get_or_init(|| {
                let constants = [("SMALL_DETECTION", 1.0)];
                specialised_pipeline(device, (&self.layout, &self.module), "walk_lines", &constants)
            })
        } else {
            &self.pipeline
        };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, lines, &[]);
        pass.dispatch_workgroups_indirect(&prepared.strokes.indirect, 64);
    }
}

/// Group 0 of `walk` and `seams`.
pub(crate) fn lines_group(
    device: &wgpu::Device,
    layouts: &Layouts,
    prepared: &Prepared,
    targets: &Targets,
) -> wgpu::BindGroup {
    use wgpu::BindingResource as R;
    let strokes = &prepared.strokes;
    group(
        device,
        "lines",
        &layouts.lines,
        &[
            (0, prepared.frame.as_entire_binding()),
            (1, prepared.draw_data.as_entire_binding()),
            (2, strokes.pieces.as_entire_binding()),
            (3, strokes.counters.as_entire_binding()),
            (4, prepared.light_data.as_entire_binding()),
            (5, R::TextureView(targets.full_depth())),
            (6, R::TextureView(&targets.ids.view)),
            (7, R::TextureView(&targets.normal.view)),
            (8, R::TextureView(&targets.base.view)),
            (9, targets.marks.as_entire_binding()),
            (10, strokes.lines.as_entire_binding()),
            (11, R::TextureView(&targets.depth.view)),
        ],
    )
}
