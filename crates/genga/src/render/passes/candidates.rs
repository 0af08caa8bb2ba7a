//! Edges → visible pieces of lines on the picture.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{compute_pipeline, group, pipeline_layout, workgroups},
    timing::Timer,
};
use crate::render::{layouts::Layouts, prepare::Prepared, targets::Targets};

pub(crate) struct CandidatePass {
    find: wgpu::ComputePipeline,
    finish: wgpu::ComputePipeline,
}

impl CandidatePass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "candidates", include_str!("../generated/candidates.wgsl"));
        let groups = [&layouts.candidates, &layouts.stroke_source];
        let layout = pipeline_layout(device, "candidates", &groups);
        let finish_layout = pipeline_layout(device, "finish candidates", &groups[..1]);
        Self {
            find: compute_pipeline(device, &layout, &module, "find_candidates"),
            finish: compute_pipeline(device, &finish_layout, &module, "finish_candidates"),
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        layouts: &Layouts,
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        use wgpu::BindingResource as R;
        let strokes = &prepared.strokes;
        let group = group(
            device,
            "candidates",
            &layouts.candidates,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, prepared.draw_data.as_entire_binding()),
                (2, strokes.segments.as_entire_binding()),
                (3, strokes.arguments.as_entire_binding()),
                (4, R::TextureView(&targets.mask.view)),
                (5, R::TextureView(&targets.ids.view)),
                (6, R::TextureView(&targets.depth.view)),
                (7, R::TextureView(&targets.normal.view)),
            ],
        );
        encoder.clear_buffer(&strokes.arguments, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("candidates"),
            timestamp_writes: timer.compute("candidates"),
        });
        pass.set_bind_group(0, &group, &[]);
        pass.set_pipeline(&self.find);
        for (group, offset, count) in &strokes.candidates {
            pass.set_bind_group(1, group, &[*offset]);
            let [x, y] = workgroups(*count);
            pass.dispatch_workgroups(x, y, 1);
        }
        pass.set_pipeline(&self.finish);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
