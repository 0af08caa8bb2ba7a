//! Lines of the mesh → pieces on the picture.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{compute_pipeline, group, pipeline_layout, workgroups},
    timing::Timer,
};
use crate::render::{layouts::Layouts, prepare::Prepared, targets::Targets};

pub(crate) struct CandidatePass {
    edges: wgpu::ComputePipeline,
    contours: wgpu::ComputePipeline,
}

impl CandidatePass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "candidates", include_str!("../generated/candidates.wgsl"));
        let groups = [&layouts.lines, &layouts.stroke_source];
        let layout = pipeline_layout(device, "candidates", &groups);
        Self {
            edges: compute_pipeline(device, &layout, &module, "find_edges"),
            contours: compute_pipeline(device, &layout, &module, "find_contours"),
        }
    }

    pub(crate) fn run(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        group: &wgpu::BindGroup,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        encoder.clear_buffer(&targets.marks, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("candidates"),
            timestamp_writes: timer.compute("candidates"),
        });
        pass.set_bind_group(0, group, &[]);
        let strokes = &prepared.strokes;
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

/// Group 0 of `candidates` and `seams`.
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
        ],
    )
}
