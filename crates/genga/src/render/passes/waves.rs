//! Energy waves → glow layers and the energy itself.

use std::sync::OnceLock;

use super::surface::shader;
use crate::render::gpu::{
    bindings::{Binding as B, compute_pipeline, group, layout, pipeline_layout, workgroups},
    timing::Timer,
};
use crate::render::{
    prepare::Prepared,
    targets::{ENERGY_FORMAT, GLOW_FORMAT, Targets, WaveTargets},
};
use crate::scene::WaveMethod;

/// Three steps: `waves_bake` makes the trees, `waves_tiles` finds what each square of pixels needs
/// of them, `waves` collects it.
pub(crate) struct WavePass {
    /// View, waves, data, nodes.
    source: wgpu::BindGroupLayout,
    /// The same without the nodes, which baking writes.
    bake: wgpu::BindGroupLayout,
    nodes: wgpu::BindGroupLayout,
    lists: wgpu::BindGroupLayout,
    targets: wgpu::BindGroupLayout,
    bake_leaves: wgpu::ComputePipeline,
    bake_tree: wgpu::ComputePipeline,
    list_squares: wgpu::ComputePipeline,
    collect: wgpu::ComputePipeline,
    collect_layout: wgpu::PipelineLayout,
    /// Made when it is first asked for.
    reference: OnceLock<wgpu::ComputePipeline>,
}

impl WavePass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let bindings = [(0, B::Uniform), (1, B::Storage), (2, B::Storage), (3, B::Storage)];
        let source = layout(device, "waves", compute, &bindings);
        let bake = layout(device, "waves to bake", compute, &bindings[..3]);
        let nodes = layout(device, "wave nodes", compute, &[(0, B::StorageWrite)]);
        let lists = layout(device, "wave lists", compute, &[(0, B::StorageWrite)]);
        let targets = layout(
            device,
            "wave targets",
            compute,
            &[
                (0, B::Storage),
                (1, B::Depth),
                (2, B::WrittenLayers(GLOW_FORMAT)),
                (3, B::Written(ENERGY_FORMAT)),
            ],
        );
        let baker = shader(device, "waves_bake", include_str!("../generated/waves_bake.wgsl"));
        let tiler = shader(device, "waves_tiles", include_str!("../generated/waves_tiles.wgsl"));
        let collector = shader(device, "waves", include_str!("../generated/waves.wgsl"));
        let bake_layout = pipeline_layout(device, "waves_bake", &[&bake, &nodes]);
        let tile_layout = pipeline_layout(device, "waves_tiles", &[&source, &lists]);
        let collect_layout = pipeline_layout(device, "waves", &[&source, &targets]);
        Self {
            bake_leaves: compute_pipeline(device, &bake_layout, &baker, "bake_leaves"),
            bake_tree: compute_pipeline(device, &bake_layout, &baker, "bake_tree"),
            list_squares: compute_pipeline(device, &tile_layout, &tiler, "list_squares"),
            collect: compute_pipeline(device, &collect_layout, &collector, "collect_energy"),
            collect_layout,
            reference: OnceLock::new(),
            source,
            bake,
            nodes,
            lists,
            targets,
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        (targets, waves): (&Targets, &WaveTargets),
        timer: &mut Timer,
    ) {
        use wgpu::BindingResource as R;
        let data = &prepared.waves;
        let resources = [
            (0, data.view.as_entire_binding()),
            (1, data.waves.as_entire_binding()),
            (2, data.data.as_entire_binding()),
            (3, data.nodes.as_entire_binding()),
        ];
        let source = group(device, "waves", &self.source, &resources);
        let bake = group(device, "waves to bake", &self.bake, &resources[..3]);
        let nodes = [(0, data.nodes.as_entire_binding())];
        let nodes = group(device, "wave nodes", &self.nodes, &nodes);
        let is_exact = data.method == WaveMethod::Exact;
        if is_exact && data.most_leaves > 0 {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("waves: bake"),
                timestamp_writes: timer.compute("waves: bake"),
            });
            pass.set_bind_group(0, &bake, &[]);
            pass.set_bind_group(1, &nodes, &[]);
            pass.set_pipeline(&self.bake_leaves);
            pass.dispatch_workgroups(data.most_leaves.div_ceil(64), data.count, 1);
            pass.set_pipeline(&self.bake_tree);
            pass.dispatch_workgroups(data.count, 1, 1);
        }
        let lists = [(0, waves.lists.as_entire_binding())];
        let lists = group(device, "wave lists", &self.lists, &lists);
        if is_exact {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("waves: lists"),
                timestamp_writes: timer.compute("waves: lists"),
            });
            pass.set_bind_group(0, &source, &[]);
            pass.set_bind_group(1, &lists, &[]);
            pass.set_pipeline(&self.list_squares);
            let [x, y] = workgroups(waves.grid.count());
            pass.dispatch_workgroups(x, y, 1);
        }
        let written = group(
            device,
            "wave targets",
            &self.targets,
            &[
                (0, waves.lists.as_entire_binding()),
                (1, R::TextureView(&targets.depth.view)),
                (2, R::TextureView(&targets.glow.view)),
                (3, R::TextureView(&waves.energy.view)),
            ],
        );
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("waves"),
            timestamp_writes: timer.compute("waves"),
        });
        pass.set_bind_group(0, &source, &[]);
        pass.set_bind_group(1, &written, &[]);
        pass.set_pipeline(if is_exact { &self.collect } else { self.reference(device) });
        let [width, height] = targets.size.pixels.map(|n| n.div_ceil(8));
        pass.dispatch_workgroups(width, height, 1);
    }

    fn reference(&self, device: &wgpu::Device) -> &wgpu::ComputePipeline {
        self.reference.get_or_init(|| {
            let wgsl = include_str!("../generated/waves_reference.wgsl");
            let module = shader(device, "waves_reference", wgsl);
            compute_pipeline(device, &self.collect_layout, &module, "collect_reference")
        })
    }
}
