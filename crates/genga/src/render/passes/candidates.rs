//! Where the mesh can have lines → lines in view.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{compute_pipeline, group, pipeline_layout, workgroups},
    timing::Timer,
};
use crate::render::{layouts::Layouts, prepare::Prepared};

pub(crate) struct CandidatePass {
    edges: wgpu::ComputePipeline,
    contours: wgpu::ComputePipeline,
}

impl CandidatePass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "candidates", include_str!("../generated/candidates.wgsl"));
        let groups = [&layouts.candidates, &layouts.stroke_source];
        let layout = pipeline_layout(device, "candidates", &groups);
        Self {
            edges: compute_pipeline(device, &layout, &module, "find_edges"),
            contours: compute_pipeline(device, &layout, &module, "find_contours"),
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        layouts: &Layouts,
        prepared: &Prepared,
        timer: &mut Timer,
    ) {
        let strokes = &prepared.strokes;
        let group = group(
            device,
            "candidates",
            &layouts.candidates,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, prepared.draw_data.as_entire_binding()),
                (2, strokes.lines.as_entire_binding()),
                (3, strokes.counters.as_entire_binding()),
            ],
        );
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("candidates"),
            timestamp_writes: timer.compute("candidates"),
        });
        pass.set_bind_group(0, &group, &[]);
        for (pipeline, runs) in [(&self.edges, &strokes.edges), (&self.contours, &strokes.contours)]
        {
            pass.set_pipeline(pipeline);
            for (group, offset, count) in runs {
                pass.set_bind_group(1, group, &[*offset]);
                let [x, y] = workgroups(*count);
                pass.dispatch_workgroups(x, y, 1);
            }
        }
    }
}
