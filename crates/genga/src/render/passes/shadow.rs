//! Depth as lights see it, a map at a time.

use super::surface::{cleared_depth, shader};
use crate::render::generated::WorldVertex;
use crate::render::gpu::{
    bindings::{DYNAMIC_STRIDE, pipeline_layout},
    timing::Timer,
};
use crate::render::prepare::{Prepared, geometry::VertexAttributes};
use crate::render::{layouts::Layouts, targets::DEPTH_FORMAT};

pub(crate) struct ShadowPass {
    opaque: wgpu::RenderPipeline,
    /// Tests alpha.
    cut_out: wgpu::RenderPipeline,
}

impl ShadowPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "shadow", include_str!("../generated/shadow.wgsl"));
        let layout = pipeline_layout(device, "shadow", &[&layouts.shadow, &layouts.material]);
        let make = |fragment: Option<&str>| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("shadow"),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("shadow_vertex"),
                    compilation_options: Default::default(),
                    buffers: &[
                        wgpu::VertexBufferLayout {
                            array_stride: size_of::<WorldVertex>() as u64,
                            step_mode: wgpu::VertexStepMode::Vertex,
                            attributes: &wgpu::vertex_attr_array![0 => Float32x3],
                        },
                        wgpu::VertexBufferLayout {
                            array_stride: size_of::<VertexAttributes>() as u64,
                            step_mode: wgpu::VertexStepMode::Vertex,
                            attributes: &[
                                wgpu::VertexAttribute {
                                    format: wgpu::VertexFormat::Float32x2,
                                    offset: 0,
                                    shader_location: 4,
                                },
                                wgpu::VertexAttribute {
                                    format: wgpu::VertexFormat::Unorm16x4,
                                    offset: 16,
                                    shader_location: 6,
                                },
                            ],
                        },
                    ],
                },
                // Both sides of everything: open meshes cast shadows, too.
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState::default(),
                fragment: fragment.map(|entry_point| wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        Self { opaque: make(None), cut_out: make(Some("shadow_fragment")) }
    }

    /// Draws the maps into their layers, so many texels wide and high.
    pub(crate) fn run(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        texels: &[u32],
        timer: &mut Timer,
    ) {
        let shadows = &prepared.shadows;
        for (map, (layer, &texels)) in shadows.layers.iter().zip(texels).enumerate() {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadow"),
                depth_stencil_attachment: cleared_depth(layer, wgpu::StoreOp::Store),
                timestamp_writes: timer.render("shadow"),
                ..Default::default()
            });
            let side = texels as f32;
            pass.set_viewport(0.0, 0.0, side, side, 0.0, 1.0);
            pass.set_bind_group(0, &shadows.group, &[(map as u64 * DYNAMIC_STRIDE) as u32]);
            for (index, item) in prepared.draws.iter().enumerate() {
                if !item.casts_shadow {
                    continue;
                }
                let pipeline = if item.tests_alpha { &self.cut_out } else { &self.opaque };
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, &prepared.materials[item.material], &[]);
                let geometry = &prepared.geometry;
                let chunk = &item.chunk;
                let world_at = u64::from(item.world.first) * size_of::<WorldVertex>() as u64;
                let rest_at = u64::from(chunk.rest.first) * size_of::<VertexAttributes>() as u64;
                pass.set_vertex_buffer(0, geometry.world[item.world.page].slice(world_at..));
                pass.set_vertex_buffer(1, geometry.attributes[chunk.rest.page].slice(rest_at..));
                let indices = &geometry.indices[chunk.indices.page];
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                let (first, instance) = (chunk.indices.first, index as u32);
                pass.draw_indexed(first..first + chunk.index_count, 0, instance..instance + 1);
            }
        }
    }
}
