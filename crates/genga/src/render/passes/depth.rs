//! Depth of the painted picture, where detection's own picture is smaller.

use super::surface::{cleared, shader};
use crate::render::gpu::{
    bindings::{Binding as B, group, layout, pipeline_layout},
    timing::Timer,
};
use crate::render::targets::{PICTURE_DEPTH_FORMAT, Target, Targets};

pub(crate) struct DepthPass {
    /// From several samples a texel, and from one.
    sources: [(wgpu::BindGroupLayout, wgpu::RenderPipeline); 2],
}

impl DepthPass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let module = shader(device, "depth", include_str!("../generated/depth.wgsl"));
        let make = |binding, kind, entry| {
            let bindings = [(0, B::Uniform), (binding, kind)];
            let layout = layout(device, "depth", wgpu::ShaderStages::FRAGMENT, &bindings);
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("depth"),
                layout: Some(&pipeline_layout(device, "depth", &[&layout])),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("depth_vertex"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    targets: &[Some(PICTURE_DEPTH_FORMAT.into())],
                }),
                multiview_mask: None,
                cache: None,
            });
            (layout, pipeline)
        };
        Self {
            sources: [
                make(1, B::DepthSamples, "depth_of_sample"),
                make(2, B::Depth, "depth_of_texel"),
            ],
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::Buffer,
        targets: &Targets,
        output: &Target,
        timer: &mut Timer,
    ) {
        let is_single = targets.paint_depth.texture.sample_count() == 1;
        let (layout, pipeline) = &self.sources[usize::from(is_single)];
        let source = wgpu::BindingResource::TextureView(&targets.paint_depth.view);
        let bindings = [(0, frame.as_entire_binding()), (1 + u32::from(is_single), source)];
        let group = group(device, "depth", layout, &bindings);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            color_attachments: &[cleared(&output.view, None)],
            timestamp_writes: timer.render("depth"),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}
