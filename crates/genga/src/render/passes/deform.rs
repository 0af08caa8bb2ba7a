//! Morph targets, skins and node transforms → world space, once a frame.

use std::sync::OnceLock;

use super::surface::shader;
use crate::render::gpu::{
    bindings::{
        DYNAMIC_STRIDE, compute_pipeline, pipeline_layout, specialised_pipeline, workgroups,
    },
    timing::Timer,
};
use crate::render::{layouts::Layouts, prepare::Prepared};

pub(crate) struct DeformPass {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    pipeline: wgpu::ComputePipeline,
    /// Made when something is smeared first.
    smearing: OnceLock<wgpu::ComputePipeline>,
}

impl DeformPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "deform", include_str!("../generated/deform.wgsl"));
        let layout = pipeline_layout(device, "deform", &[&layouts.deform, &layouts.dynamic]);
        let pipeline = compute_pipeline(device, &layout, &module, "deform_vertices");
        Self { module, layout, pipeline, smearing: OnceLock::new() }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        timer: &mut Timer,
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("deform"),
            timestamp_writes: timer.compute("deform"),
        });
        if prepared.deform.has_smear {
            pass.set_pipeline(self.smearing.get_or_init(|| self.smearing(device)));
        } else {
            pass.set_pipeline(&self.pipeline);
        }
        for (i, item) in prepared.draws.iter().enumerate() {
            let pages = [item.chunk.rest.page, item.world.page, item.chunk.morph.page];
            let offset = (i as u64 * DYNAMIC_STRIDE) as u32;
            pass.set_bind_group(0, &prepared.deform.groups[&pages], &[]);
            pass.set_bind_group(1, &prepared.deform.uniforms, &[offset]);
            let [x, y] = workgroups(item.chunk.vertex_count);
            pass.dispatch_workgroups(x, y, 1);
        }
    }

    fn smearing(&self, device: &wgpu::Device) -> wgpu::ComputePipeline {
        let with = (&self.layout, &self.module);
        specialised_pipeline(device, with, "deform_vertices", &[("SMEAR", 1.0)])
    }
}
