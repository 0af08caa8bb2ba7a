//! Edges that can be lines → segments on the picture.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{compute_pipeline, pipeline_layout, workgroups},
    timing::Timer,
};
use crate::render::{layouts::Layouts, prepare::Prepared};

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

    pub(crate) fn run(&self, encoder: &mut wgpu::CommandEncoder, prepared: &Prepared, timer: &mut Timer) {
        let strokes = &prepared.strokes;
        encoder.clear_buffer(&strokes.arguments, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("candidates"),
            timestamp_writes: timer.compute("candidates"),
        });
        pass.set_bind_group(0, &strokes.candidate_group, &[]);
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
