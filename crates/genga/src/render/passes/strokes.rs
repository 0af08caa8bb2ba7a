//! Visible pieces of lines → round-ended strokes.

use super::{
    link::LinkPass,
    surface::{cleared, cleared_depth, shader},
};
use crate::render::gpu::{
    bindings::{group, pipeline_layout},
    timing::Timer,
};
use crate::render::{
    layouts::Layouts,
    prepare::Prepared,
    targets::{COVERAGE_FORMAT, DEPTH_FORMAT, LINE_COLOR_FORMAT, Targets},
};

pub(crate) struct StrokePass {
    pipeline: wgpu::RenderPipeline,
    colors: wgpu::RenderPipeline,
}

impl StrokePass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "strokes", include_str!("../generated/strokes.wgsl"));
        let groups = [&layouts.strokes, &layouts.linked];
        let entries = ["stroke_vertex", "stroke_fragment"];
        let color_entries = ["stroke_vertex", "stroke_color_fragment"];
        Self {
            pipeline: coverage_pipeline(device, "strokes", &groups, &module, entries),
            colors: color_pipeline(device, &groups, &module, color_entries),
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
        let seen = group(
            device,
            "strokes",
            &layouts.strokes,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, R::TextureView(targets.full_depth())),
                (2, R::TextureView(&targets.ids.view)),
                (3, R::TextureView(&strokes.curves)),
            ],
        );
        let linked = group(
            device,
            "linked pieces",
            &layouts.linked,
            &[
                (0, strokes.pieces.as_entire_binding()),
                (1, strokes.states.as_entire_binding()),
                (2, strokes.links.as_entire_binding()),
                (3, strokes.ranks[LinkPass::RANKED].as_entire_binding()),
                (4, strokes.places.as_entire_binding()),
                (5, targets.marks.as_entire_binding()),
            ],
        );
        let draw = |pass: &mut wgpu::RenderPass<'_>, pipeline| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &seen, &[]);
            pass.set_bind_group(1, &linked, &[]);
            pass.draw_indirect(&strokes.indirect, 0);
        };
        draw(&mut begin_coverage(encoder, targets, timer), &self.pipeline);
        if let Some([colors, depth]) = &targets.line_colors {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("line colours"),
                color_attachments: &[cleared(&colors.view, None)],
                depth_stencil_attachment: cleared_depth(&depth.view, wgpu::StoreOp::Store),
                timestamp_writes: timer.render("line colours"),
                ..Default::default()
            });
            draw(&mut pass, &self.colors);
        }
    }
}

/// The nearest stroke's colour wins, so the order of strokes does not matter.
fn color_pipeline(
    device: &wgpu::Device,
    groups: &[&wgpu::BindGroupLayout],
    module: &wgpu::ShaderModule,
    entries: [&str; 2],
) -> wgpu::RenderPipeline {
    let targets = [Some(LINE_COLOR_FORMAT.into())];
    nearest_pipeline(device, "line colours", (groups, &targets), module, entries)
}

/// A pipeline without vertex buffers that writes the depth of what is nearest.
pub(crate) fn depth_pipeline(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout],
    module: &wgpu::ShaderModule,
    entries: [&str; 2],
) -> wgpu::RenderPipeline {
    nearest_pipeline(device, label, (groups, &[]), module, entries)
}

fn nearest_pipeline(
    device: &wgpu::Device,
    label: &str,
    (groups, targets): (&[&wgpu::BindGroupLayout], &[Option<wgpu::ColorTargetState>]),
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
) -> wgpu::RenderPipeline {
    let layout = pipeline_layout(device, label, groups);
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
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
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
