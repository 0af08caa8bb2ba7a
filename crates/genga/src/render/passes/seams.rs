//! Lines where surfaces meet without an edge → pieces on the picture.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{Binding as B, compute_pipeline, group, layout, pipeline_layout},
    timing::Timer,
};
use crate::render::{
    layouts::Layouts, passes::link::SizePass, prepare::Prepared, targets::Targets,
};

pub(crate) struct SeamPass {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl SeamPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "seams", include_str!("../generated/seams.wgsl"));
        let bindings = [(0, B::Storage)];
        let layout = layout(device, "seams", wgpu::ShaderStages::COMPUTE, &bindings);
        let pipeline_layout = pipeline_layout(device, "seams", &[&layouts.lines, &layout]);
        let pipeline = compute_pipeline(device, &pipeline_layout, &module, "find_seams");
        Self { layout, pipeline }
    }

    /// `lines` is group 0 of `candidates`.
    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (sizes, lines): (&SizePass, &wgpu::BindGroup),
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        let own =
            group(device, "seams", &self.layout, &[(0, targets.seam_texels.as_entire_binding())]);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("seams"),
            timestamp_writes: timer.compute("seams"),
        });
        sizes.seams(device, &mut pass, prepared, targets);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, lines, &[]);
        pass.set_bind_group(1, &own, &[]);
        pass.dispatch_workgroups_indirect(&prepared.strokes.indirect, 48);
    }
}
