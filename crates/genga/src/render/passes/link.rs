//! Pieces of lines → strokes with lengths.

use super::surface::shader;
use crate::render::gpu::{
    bindings::{Binding as B, compute_pipeline, group, layout, pipeline_layout},
    timing::Timer,
};
use crate::render::{prepare::Prepared, targets::Targets};
use wgpu::BindingResource as R;

/// Rounds of the ranking, an even number: strokes of up to 2^12 pieces have ends.
const ROUNDS: usize = 12;
/// Where the dispatches over pieces and over ends begin in the arguments, in bytes.
const OVER_PIECES: u64 = 16;
const OVER_ENDS: u64 = 32;

pub(crate) struct LinkPass {
    layout: wgpu::BindGroupLayout,
    gather: wgpu::ComputePipeline,
    join: wgpu::ComputePipeline,
    close: wgpu::ComputePipeline,
    gather_ends: wgpu::ComputePipeline,
    bridge: wgpu::ComputePipeline,
    begin_rank: wgpu::ComputePipeline,
    jump: wgpu::ComputePipeline,
}

impl LinkPass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let module = shader(device, "link", include_str!("../generated/link.wgsl"));
        let bindings = [
            (0, B::Uniform),
            (1, B::Storage),
            (2, B::Storage),
            (3, B::StorageWrite),
            (4, B::StorageWrite),
            (5, B::StorageWrite),
            (6, B::StorageWrite),
            (7, B::StorageWrite),
            (8, B::StorageWrite),
            (9, B::Float),
        ];
        let layout = layout(device, "link", wgpu::ShaderStages::COMPUTE, &bindings);
        let pipeline_layout = pipeline_layout(device, "link", &[&layout]);
        let make = |entry| compute_pipeline(device, &pipeline_layout, &module, entry);
        Self {
            gather: make("gather"),
            join: make("join"),
            close: make("close"),
            gather_ends: make("gather_ends"),
            bridge: make("bridge"),
            begin_rank: make("begin_rank"),
            jump: make("jump"),
            layout,
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        sizes: &SizePass,
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        let strokes = &prepared.strokes;
        let turn = |here: usize| {
            group(
                device,
                "link",
                &self.layout,
                &[
                    (0, prepared.frame.as_entire_binding()),
                    (1, strokes.pieces.as_entire_binding()),
                    (2, strokes.counters.as_entire_binding()),
                    (3, strokes.buckets.as_entire_binding()),
                    (4, strokes.links.as_entire_binding()),
                    (5, strokes.ranks[here].as_entire_binding()),
                    (6, strokes.ranks[1 - here].as_entire_binding()),
                    (7, strokes.states.as_entire_binding()),
                    (8, strokes.places.as_entire_binding()),
                    (9, R::TextureView(targets.full_depth())),
                ],
            )
        };
        let turns = [turn(0), turn(1)];
        encoder.clear_buffer(&strokes.buckets, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("link"),
            timestamp_writes: timer.compute("link"),
        });
        sizes.pieces(device, &mut pass, prepared, targets);
        pass.set_bind_group(0, &turns[0], &[]);
        let steps = [
            (&self.gather, OVER_ENDS),
            (&self.join, OVER_ENDS),
            (&self.close, OVER_PIECES),
            (&self.gather_ends, OVER_ENDS),
            (&self.bridge, OVER_ENDS),
            (&self.begin_rank, OVER_ENDS),
        ];
        for (pipeline, work) in steps {
            pass.set_pipeline(pipeline);
            pass.dispatch_workgroups_indirect(&strokes.indirect, work);
        }
        pass.set_pipeline(&self.jump);
        for round in 1..=ROUNDS {
            pass.set_bind_group(0, &turns[round % 2], &[]);
            pass.dispatch_workgroups_indirect(&strokes.indirect, OVER_ENDS);
        }
    }

    /// Which of the two buffers has the ranks in the end.
    pub(crate) const RANKED: usize = 1;
}

/// Counts → arguments of indirect work.
pub(crate) struct SizePass {
    layout: wgpu::BindGroupLayout,
    lines: wgpu::ComputePipeline,
    seams: wgpu::ComputePipeline,
    pieces: wgpu::ComputePipeline,
}

impl SizePass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let module = shader(device, "sizes", include_str!("../generated/sizes.wgsl"));
        let bindings = [
            (0, B::Uniform),
            (1, B::Storage),
            (2, B::StorageWrite),
            (3, B::Storage),
            (4, B::Storage),
        ];
        let layout = layout(device, "sizes", wgpu::ShaderStages::COMPUTE, &bindings);
        let pipeline_layout = pipeline_layout(device, "sizes", &[&layout]);
        let make = |entry| compute_pipeline(device, &pipeline_layout, &module, entry);
        Self {
            lines: make("size_lines"),
            seams: make("size_seams"),
            pieces: make("size_pieces"),
            layout,
        }
    }

    /// For the dispatch over the listed lines.
    pub(crate) fn lines(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::ComputePass<'_>,
        prepared: &Prepared,
        targets: &Targets,
    ) {
        self.run(device, pass, &self.lines, prepared, targets);
    }

    /// For the dispatch over the listed texels.
    pub(crate) fn seams(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::ComputePass<'_>,
        prepared: &Prepared,
        targets: &Targets,
    ) {
        self.run(device, pass, &self.seams, prepared, targets);
    }

    /// For the strokes' draw and the dispatches over pieces and ends.
    pub(crate) fn pieces(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::ComputePass<'_>,
        prepared: &Prepared,
        targets: &Targets,
    ) {
        self.run(device, pass, &self.pieces, prepared, targets);
    }

    fn run(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::ComputePass<'_>,
        pipeline: &wgpu::ComputePipeline,
        prepared: &Prepared,
        targets: &Targets,
    ) {
        let strokes = &prepared.strokes;
        let group = group(
            device,
            "sizes",
            &self.layout,
            &[
                (0, prepared.frame.as_entire_binding()),
                (1, strokes.counters.as_entire_binding()),
                (2, strokes.indirect.as_entire_binding()),
                (3, strokes.links.as_entire_binding()),
                (4, targets.seam_texels.as_entire_binding()),
            ],
        );
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
