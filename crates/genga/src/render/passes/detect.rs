//! Where lines are: differences in the G-buffer → the mask of line types, or the list of texels where
//! surfaces may meet.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{Binding as B, compute_pipeline, group, layout, pipeline_layout},
    timing::Timer,
};
use crate::render::{
    prepare::Prepared,
    targets::{MASK_FORMAT, Targets},
};

pub(crate) struct DetectPass {
    layout: wgpu::BindGroupLayout,
    mask: wgpu::ComputePipeline,
    seams: wgpu::ComputePipeline,
}

impl DetectPass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let module = shader(device, "detect", include_str!("../generated/detect.wgsl"));
        let bindings = [
            (0, B::Uniform),
            (1, B::Float),
            (2, B::Uint),
            (3, B::Depth),
            (4, B::Written(MASK_FORMAT)),
            (5, B::StorageWrite),
            (6, B::StorageWrite),
        ];
        let layout = layout(device, "detect", wgpu::ShaderStages::COMPUTE, &bindings);
        let pipeline_layout = pipeline_layout(device, "detect", &[&layout]);
        let make = |entry| compute_pipeline(device, &pipeline_layout, &module, entry);
        Self { mask: make("detect_lines"), seams: make("list_seams"), layout }
    }

    /// The types of lines in each texel.
    pub(crate) fn mask(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        self.run(&self.mask, device, encoder, (prepared, targets), timer);
    }

    /// The texels where surfaces may meet without an edge.
    pub(crate) fn seams(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        encoder.clear_buffer(&prepared.strokes.counters, 0, None);
        self.run(&self.seams, device, encoder, (prepared, targets), timer);
    }

    fn run(
        &self,
        pipeline: &wgpu::ComputePipeline,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        (prepared, targets): (&Prepared, &Targets),
        timer: &mut Timer,
    ) {
        use wgpu::BindingResource as R;
        let group = group(
            device,
            "detect",
            &self.layout,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, R::TextureView(&targets.normal.view)),
                (2, R::TextureView(&targets.ids.view)),
                (3, R::TextureView(&targets.depth.view)),
                (4, R::TextureView(&targets.mask.view)),
                (5, targets.seam_texels.as_entire_binding()),
                (6, prepared.strokes.counters.as_entire_binding()),
            ],
        );
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("detect"),
            timestamp_writes: timer.compute("detect"),
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        // 64 columns and 8 rows a workgroup.
        let [width, height] = targets.size.gbuffer();
        pass.dispatch_workgroups(width.div_ceil(64), height.div_ceil(8), 1);
    }
}
