//! Energy waves → glow layers and the energy itself.

use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

use super::surface::{cleared, shader};
use crate::render::gpu::{
    bindings::{Binding as B, compute_pipeline, group, layout, pipeline_layout, workgroups},
    timing::Timer,
};
use crate::render::{
    prepare::{
        Prepared,
        waves::{ExactKind, ReferenceKind},
    },
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
    collect_layout: wgpu::PipelineLayout,
    collector: wgpu::ShaderModule,
    /// `collect_energy` and `collect_full`, those that were asked for.
    exact: Mutex<HashMap<ExactKind, [wgpu::ComputePipeline; 2]>>,
    /// Those that were asked for.
    references: Mutex<HashMap<ReferenceKind, wgpu::ComputePipeline>>,
}

impl WavePass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let bindings = [(0, B::Uniform), (1, B::Uniform), (2, B::Storage), (3, B::Storage)];
        let source = layout(device, "waves", compute, &bindings);
        let bake = layout(device, "waves to bake", compute, &bindings[..3]);
        let nodes = layout(device, "wave nodes", compute, &[(0, B::StorageWrite)]);
        let lists = layout(
            device,
            "wave lists",
            compute,
            &[(0, B::StorageWrite), (1, B::StorageWrite), (2, B::StorageWrite), (3, B::Float)],
        );
        let targets = layout(
            device,
            "wave targets",
            compute,
            &[
                (0, B::Storage),
                (1, B::Float),
                (2, B::WrittenLayers(GLOW_FORMAT)),
                (3, B::Written(ENERGY_FORMAT)),
                (4, B::Storage),
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
            collector,
            exact: Mutex::default(),
            collect_layout,
            references: Mutex::default(),
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
        (prepared, kind): (&Prepared, ExactKind),
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
        encoder.clear_buffer(&waves.used_squares, 0, Some(16));
        encoder.clear_buffer(&waves.full_squares, 0, Some(16));
        let lists = [
            (0, waves.lists.as_entire_binding()),
            (1, waves.used_squares.as_entire_binding()),
            (2, waves.full_squares.as_entire_binding()),
            (3, R::TextureView(targets.full_depth())),
        ];
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
        let written = |squares: &wgpu::Buffer| {
            group(
                device,
                "wave targets",
                &self.targets,
                &[
                    (0, waves.lists.as_entire_binding()),
                    (1, R::TextureView(targets.full_depth())),
                    (2, R::TextureView(&targets.glow.view)),
                    (3, R::TextureView(&waves.energy.view)),
                    (4, squares.as_entire_binding()),
                ],
            )
        };
        clear(encoder, targets, waves);
        let [used, full] = [&waves.used_squares, &waves.full_squares];
        let groups = [written(used), written(full)];
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("waves"),
            timestamp_writes: timer.compute("waves"),
        });
        pass.set_bind_group(0, &source, &[]);
        if is_exact {
            let pipelines = self.exact(device, kind);
            for ((pipeline, group), squares) in pipelines.iter().zip(&groups).zip([used, full]) {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, group, &[]);
                pass.dispatch_workgroups_indirect(squares, 0);
            }
        } else {
            pass.set_pipeline(&self.reference(device, data.kind));
            pass.set_bind_group(1, &groups[0], &[]);
            let [width, height] = targets.size.pixels.map(|n| n.div_ceil(8));
            pass.dispatch_workgroups(width, height, 1);
        }
    }

    fn exact(&self, device: &wgpu::Device, kind: ExactKind) -> [wgpu::ComputePipeline; 2] {
        let mut made = self.exact.lock().unwrap_or_else(PoisonError::into_inner);
        let number = |on: bool| f64::from(u8::from(on));
        let constants = [("fades", number(kind.fades)), ("core_grows", number(kind.core_grows))];
        let make = || {
            ["collect_energy", "collect_full"]
                .map(|entry| self.specialised(device, &self.collector, entry, &constants))
        };
        made.entry(kind).or_insert_with(make).clone()
    }

    fn specialised(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> wgpu::ComputePipeline {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: Some(&self.collect_layout),
            module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants,
                ..Default::default()
            },
            cache: None,
        })
    }

    fn reference(&self, device: &wgpu::Device, kind: ReferenceKind) -> wgpu::ComputePipeline {
        let mut made = self.references.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            let wgsl = include_str!("../generated/waves_reference.wgsl");
            let number = |on: bool| f64::from(u8::from(on));
            let constants = [
                ("curve_kind", f64::from(kind.curve_kind)),
                ("point_count", f64::from(kind.point_count)),
                ("second_count", f64::from(kind.second_count)),
                ("order", f64::from(kind.order)),
                ("is_even", number(kind.is_even)),
                ("has_more", number(kind.has_more)),
                ("thins", number(kind.thins)),
            ];
            let module = shader(device, "waves_reference", wgsl);
            self.specialised(device, &module, "collect_reference", &constants)
        };
        made.entry(kind).or_insert_with(make).clone()
    }
}

/// Clears the layers and the energy.
fn clear(encoder: &mut wgpu::CommandEncoder, targets: &Targets, waves: &WaveTargets) {
    let layers = (0..targets.size.glow_layers).map(|layer| {
        targets.glow.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        })
    });
    for view in layers.chain([waves.energy.view.clone()]) {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("clear waves"),
            color_attachments: &[cleared(&view, None)],
            ..Default::default()
        });
    }
}
