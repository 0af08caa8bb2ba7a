//! Normals, identities and depth for the detection of lines.

use super::surface::{
    SurfacePipelines, Variant, cleared, cleared_depth, draw_items, shader, sorted_items,
};
use crate::render::gpu::timing::Timer;
use crate::render::{
    frame::Aim,
    layouts::Layouts,
    prepare::Prepared,
    targets::{BASE_FORMAT, IDS_FORMAT, NORMAL_FORMAT, Targets},
};

pub(crate) struct GBufferPass {
    pipelines: SurfacePipelines,
}

impl GBufferPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "gbuffer", include_str!("../generated/gbuffer.wgsl"));
        let entries = ["gbuffer_vertex", "gbuffer_fragment"];
        let formats = [NORMAL_FORMAT, IDS_FORMAT, BASE_FORMAT];
        Self {
            pipelines: SurfacePipelines::new(device, layouts, "gbuffer", module, entries, &formats),
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        aim: &Aim,
        timer: &mut Timer,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("gbuffer"),
            color_attachments: &[
                cleared(&targets.normal.view, None),
                cleared(&targets.ids.view, None),
                cleared(&targets.base.view, None),
            ],
            depth_stencil_attachment: cleared_depth(&targets.depth.view, wgpu::StoreOp::Store),
            timestamp_writes: timer.render("gbuffer"),
            ..Default::default()
        });
        // Blended surfaces enter where they are at least half opaque; the shader decides.
        aim.set_viewport(&mut pass, targets.size.gbuffer_scale.factor());
        let [opaque, blended] = sorted_items(prepared, aim.eye);
        let items =
            opaque.into_iter().chain(blended).map(|(i, item)| (i, item, Variant::of(item, 1)));
        draw_items(device, &mut pass, prepared, &self.pipelines, items);
    }
}
