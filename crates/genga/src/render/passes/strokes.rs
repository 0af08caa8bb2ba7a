//! Visible pieces of lines → round-ended strokes.

use super::surface::{cleared, shader};
use crate::render::gpu::{
    bindings::{group, pipeline_layout},
    timing::Timer,
};
use crate::render::{
    layouts::Layouts,
    prepare::Prepared,
    targets::{COVERAGE_FORMAT, Targets},
};

pub(crate) struct StrokePass {
    pipeline: wgpu::RenderPipeline,
}

impl StrokePass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "strokes", include_str!("../generated/strokes.wgsl"));
        let groups = [&layouts.strokes, &layouts.segments];
        let entries = ["stroke_vertex", "stroke_fragment"];
        Self { pipeline: coverage_pipeline(device, "strokes", &groups, &module, entries) }
    }

    pub(crate) fn run(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        group: &wgpu::BindGroup,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        let mut pass = begin_coverage(encoder, targets, timer);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(1, &prepared.strokes.segment_group, &[]);
        pass.draw_indirect(&prepared.strokes.arguments, 0);
    }
}

/// The pass that writes the coverage of the line sets.
pub(crate) fn begin_coverage<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    targets: &Targets,
    timer: &mut Timer,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("strokes"),
        color_attachments: &[cleared(&targets.coverage.view, None)],
        timestamp_writes: timer.render("strokes"),
        ..Default::default()
    })
}

/// A pipeline without vertex buffers that writes coverage by MAX.
pub(crate) fn coverage_pipeline(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout],
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
) -> wgpu::RenderPipeline {
    let layout = pipeline_layout(device, label, groups);
    let max = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Max,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: COVERAGE_FORMAT,
                blend: Some(wgpu::BlendState { color: max, alpha: max }),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Group 0 of `strokes` and `reference`.
pub(crate) fn stroke_group(
    device: &wgpu::Device,
    layouts: &Layouts,
    prepared: &Prepared,
    targets: &Targets,
) -> wgpu::BindGroup {
    use wgpu::BindingResource as R;
    group(
        device,
        "strokes",
        &layouts.strokes,
        &[
            (0, prepared.frame.as_entire_binding()),
            (1, prepared.draw_data.as_entire_binding()),
            (4, R::TextureView(&targets.mask.view)),
            (5, R::TextureView(&targets.ids.view)),
            (6, R::TextureView(&targets.depth.view)),
            (7, R::TextureView(&targets.normal.view)),
        ],
    )
}
