//! Contour lines as Okuya et al. 2015 print them.

use super::{
    strokes::{begin_coverage, coverage_pipeline},
    surface::shader,
};
use crate::render::gpu::{bindings::group, timing::Timer};
use crate::render::{layouts::Layouts, prepare::Prepared, targets::Targets};

pub(crate) struct ReferencePass {
    pipeline: wgpu::RenderPipeline,
}

impl ReferencePass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "reference", include_str!("../generated/reference.wgsl"));
        let groups = [&layouts.reference, &layouts.stroke_source];
        let entries = ["reference_vertex", "reference_fragment"];
        Self { pipeline: coverage_pipeline(device, "reference", &groups, &module, entries) }
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
        let group = group(
            device,
            "reference",
            &layouts.reference,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, prepared.draw_data.as_entire_binding()),
                (4, wgpu::BindingResource::TextureView(&targets.mask.view)),
            ],
        );
        let mut pass = begin_coverage(encoder, targets, timer);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &group, &[]);
        for (group, offset, index_count) in &prepared.strokes.reference {
            pass.set_bind_group(1, group, &[*offset]);
            // Six corners for each of a triangle's three edges.
            pass.draw(0..6 * index_count, 0..1);
        }
    }
}
