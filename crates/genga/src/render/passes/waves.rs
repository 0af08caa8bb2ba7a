//! Energy waves → glow layers and the energy itself.

use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

use super::surface::{cleared, shader};
use crate::render::gpu::{
    bindings::{
        Binding as B, compute_pipeline, group, layout, pipeline_layout, specialised_pipeline,
        workgroups,
    },
    timing::Timer,
};
use crate::render::{
    prepare::{
        Prepared,
        waves::{ExactKind, ReferenceKind},
    },
    targets::{ENERGY_FORMAT, GLOW_FORMAT, Targets},
    wave_targets::{LEVELS, WaveTargets},
};
use crate::scene::WaveMethod;

/// `waves_bake` makes the trees. Then, from coarse squares of pixels to fine ones, `waves_tiles`
/// finds what each square needs of them; in all but the finest `waves` integrates a few rays of it,
/// and `waves_patches` decides whether they stand for all of its pixels, or its quarters are looked
/// at in their turn. `waves_smooth` draws the patches, `waves` the pixels of what is left.
pub(crate) struct WavePass {
    /// View, waves, data, nodes.
    source: wgpu::BindGroupLayout,
    /// The same without the nodes, which baking writes.
    bake: wgpu::BindGroupLayout,
    nodes: wgpu::BindGroupLayout,
    depths: wgpu::BindGroupLayout,
    lists: wgpu::BindGroupLayout,
    collect: wgpu::BindGroupLayout,
    patches: wgpu::BindGroupLayout,
    smooth: wgpu::BindGroupLayout,
    bake_leaves: wgpu::ComputePipeline,
    bake_tree: wgpu::ComputePipeline,
    find_ranges: wgpu::ComputePipeline,
    list_squares: wgpu::ComputePipeline,
    list_quarters: wgpu::ComputePipeline,
    fit_patches: wgpu::ComputePipeline,
    smooth_layout: wgpu::PipelineLayout,
    collect_layout: wgpu::PipelineLayout,
    drawer: wgpu::ShaderModule,
    collector: wgpu::ShaderModule,
    /// Those that were asked for.
    exact: Mutex<HashMap<ExactKind, ExactPipelines>>,
    /// Those that were asked for.
    references: Mutex<HashMap<(ReferenceKind, bool), wgpu::ComputePipeline>>,
}

#[derive(Clone)]
struct ExactPipelines {
    sample_patches: wgpu::ComputePipeline,
    draw_patches: wgpu::ComputePipeline,
    collect_energy: wgpu::ComputePipeline,
    collect_full: wgpu::ComputePipeline,
}

impl WavePass {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let layout = |label, bindings: &[(u32, B)]| {
            layout(device, label, wgpu::ShaderStages::COMPUTE, bindings)
        };
        let bindings = [(0, B::Uniform), (1, B::Uniform), (2, B::Storage), (3, B::Storage)];
        let source = layout("waves", &bindings);
        let bake = layout("waves to bake", &bindings[..3]);
        let nodes = layout("wave nodes", &[(0, B::StorageWrite)]);
        let level = (0, B::Uniform);
        let depths = layout("wave depths", &[level, (2, B::StorageWrite), (3, B::Float)]);
        let stored = (1, B::Storage);
        let [written_4, written_5] = [(4, B::StorageWrite), (5, B::StorageWrite)];
        let lists = layout(
            "wave lists",
            &[level, stored, (2, B::StorageWrite), (3, B::Storage), written_4, written_5],
        );
        let collect = layout(
            "wave pixels",
            &[
                level,
                stored,
                (2, B::Storage),
                (3, B::Storage),
                (4, B::Float),
                (5, B::WrittenLayers(GLOW_FORMAT)),
                (6, B::Written(ENERGY_FORMAT)),
                (7, B::StorageWrite),
            ],
        );
        let patches = layout(
            "wave patches",
            &[level, (2, B::Storage), (3, B::Storage), written_4, written_5, (6, B::StorageWrite)],
        );
        let smooth = layout(
            "wave squares",
            &[
                level,
                (2, B::Storage),
                (3, B::Storage),
                (4, B::WrittenLayers(GLOW_FORMAT)),
                (5, B::Written(ENERGY_FORMAT)),
            ],
        );
        let baker = shader(device, "waves_bake", include_str!("../generated/waves_bake.wgsl"));
        let ranger = shader(device, "waves_depths", include_str!("../generated/waves_depths.wgsl"));
        let tiler = shader(device, "waves_tiles", include_str!("../generated/waves_tiles.wgsl"));
        let fitter =
            shader(device, "waves_patches", include_str!("../generated/waves_patches.wgsl"));
        let drawer = shader(device, "waves_smooth", include_str!("../generated/waves_smooth.wgsl"));
        let collector = shader(device, "waves", include_str!("../generated/waves.wgsl"));
        let pipeline = |group: &wgpu::BindGroupLayout, module, entry| {
            let layout = pipeline_layout(device, entry, &[&source, group]);
            compute_pipeline(device, &layout, module, entry)
        };
        let bake_layout = pipeline_layout(device, "waves_bake", &[&bake, &nodes]);
        Self {
            bake_leaves: compute_pipeline(device, &bake_layout, &baker, "bake_leaves"),
            bake_tree: compute_pipeline(device, &bake_layout, &baker, "bake_tree"),
            find_ranges: pipeline(&depths, &ranger, "find_ranges"),
            list_squares: pipeline(&lists, &tiler, "list_squares"),
            list_quarters: pipeline(&lists, &tiler, "list_quarters"),
            fit_patches: pipeline(&patches, &fitter, "fit_patches"),
            smooth_layout: pipeline_layout(device, "waves_smooth", &[&source, &smooth]),
            drawer,
            collect_layout: pipeline_layout(device, "waves", &[&source, &collect]),
            collector,
            exact: Mutex::default(),
            references: Mutex::default(),
            source,
            bake,
            nodes,
            depths,
            lists,
            collect,
            patches,
            smooth,
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
        let data = &prepared.waves;
        let resources = [
            (0, data.view.as_entire_binding()),
            (1, data.waves.as_entire_binding()),
            (2, data.data.as_entire_binding()),
            (3, data.nodes.as_entire_binding()),
        ];
        let source = group(device, "waves", &self.source, &resources);
        clear(encoder, targets, kind.keeps_energy.then_some(waves));
        if data.method != WaveMethod::Exact {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("waves"),
                timestamp_writes: timer.compute("waves"),
            });
            pass.set_bind_group(0, &source, &[]);
            pass.set_pipeline(&self.reference(device, (data.kind, kind.keeps_energy)));
            pass.set_bind_group(1, &self.pixels(device, targets, waves, (0, &waves.used[0])), &[]);
            let [width, height] = targets.size.pixels.map(|n| n.div_ceil(8));
            pass.dispatch_workgroups(width, height, 1);
            return;
        }
        if data.most_leaves > 0 {
            let bake = group(device, "waves to bake", &self.bake, &resources[..3]);
            let nodes = [(0, data.nodes.as_entire_binding())];
            let nodes = group(device, "wave nodes", &self.nodes, &nodes);
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
        for squares in waves.used.iter().chain(&waves.left).chain(&waves.smooth) {
            encoder.clear_buffer(squares, 0, Some(16));
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("waves"),
            timestamp_writes: timer.compute("waves"),
        });
        pass.set_bind_group(0, &source, &[]);
        if !prepared.draws.is_empty() {
            let depths = self.depths(device, targets, waves);
            pass.set_pipeline(&self.find_ranges);
            pass.set_bind_group(1, &depths, &[]);
            let [x, y] = workgroups(waves.grid.finest());
            pass.dispatch_workgroups(x, y, 1);
        }
        let pipelines = self.exact(device, kind);
        for level in 0..LEVELS {
            pass.set_bind_group(1, &self.lists(device, waves, level), &[]);
            if level == 0 {
                pass.set_pipeline(&self.list_squares);
                let [x, y] = workgroups(waves.grid.coarsest());
                pass.dispatch_workgroups(x, y, 1);
            } else {
                pass.set_pipeline(&self.list_quarters);
                pass.dispatch_workgroups_indirect(&waves.left[level - 1], 0);
            }
            let used = &waves.used[level];
            pass.set_bind_group(1, &self.pixels(device, targets, waves, (level, used)), &[]);
            if level + 1 < LEVELS {
                pass.set_pipeline(&pipelines.sample_patches);
                pass.dispatch_workgroups_indirect(used, 0);
                pass.set_pipeline(&self.fit_patches);
                pass.set_bind_group(1, &self.patches(device, waves, level), &[]);
                pass.dispatch_workgroups_indirect(used, 0);
                pass.set_pipeline(&pipelines.draw_patches);
                pass.set_bind_group(1, &self.smooth(device, targets, waves, level), &[]);
                pass.dispatch_workgroups_indirect(&waves.smooth[level], 0);
            } else {
                pass.set_pipeline(&pipelines.collect_energy);
                pass.dispatch_workgroups_indirect(used, 0);
                let full = &waves.left[level];
                pass.set_pipeline(&pipelines.collect_full);
                pass.set_bind_group(1, &self.pixels(device, targets, waves, (level, full)), &[]);
                pass.dispatch_workgroups_indirect(full, 0);
            }
        }
    }

    fn depths(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        waves: &WaveTargets,
    ) -> wgpu::BindGroup {
        let resources = [
            (0, waves.levels[0].as_entire_binding()),
            (2, waves.depths.as_entire_binding()),
            (3, wgpu::BindingResource::TextureView(targets.full_depth())),
        ];
        group(device, "wave depths", &self.depths, &resources)
    }

    fn lists(&self, device: &wgpu::Device, waves: &WaveTargets, level: usize) -> wgpu::BindGroup {
        // The first level has no parents: any other squares stand for them.
        let parents = &waves.left[if level == 0 { LEVELS - 1 } else { level - 1 }];
        let resources = [
            (0, waves.levels[level].as_entire_binding()),
            (1, waves.depths.as_entire_binding()),
            (2, waves.lists.as_entire_binding()),
            (3, parents.as_entire_binding()),
            (4, waves.used[level].as_entire_binding()),
            (5, waves.left[level].as_entire_binding()),
        ];
        group(device, "wave lists", &self.lists, &resources)
    }

    fn pixels(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        waves: &WaveTargets,
        (level, squares): (usize, &wgpu::Buffer),
    ) -> wgpu::BindGroup {
        use wgpu::BindingResource as R;
        let resources = [
            (0, waves.levels[level].as_entire_binding()),
            (1, waves.depths.as_entire_binding()),
            (2, waves.lists.as_entire_binding()),
            (3, squares.as_entire_binding()),
            (4, R::TextureView(targets.full_depth())),
            (5, R::TextureView(&targets.glow.view)),
            (6, R::TextureView(&waves.energy.view)),
            (7, waves.patches.as_entire_binding()),
        ];
        group(device, "wave pixels", &self.collect, &resources)
    }

    fn patches(&self, device: &wgpu::Device, waves: &WaveTargets, level: usize) -> wgpu::BindGroup {
        let resources = [
            (0, waves.levels[level].as_entire_binding()),
            (2, waves.lists.as_entire_binding()),
            (3, waves.used[level].as_entire_binding()),
            (4, waves.patches.as_entire_binding()),
            (5, waves.smooth[level].as_entire_binding()),
            (6, waves.left[level].as_entire_binding()),
        ];
        group(device, "wave patches", &self.patches, &resources)
    }

    fn smooth(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        waves: &WaveTargets,
        level: usize,
    ) -> wgpu::BindGroup {
        use wgpu::BindingResource as R;
        let resources = [
            (0, waves.levels[level].as_entire_binding()),
            (2, waves.smooth[level].as_entire_binding()),
            (3, waves.patches.as_entire_binding()),
            (4, R::TextureView(&targets.glow.view)),
            (5, R::TextureView(&waves.energy.view)),
        ];
        group(device, "wave squares", &self.smooth, &resources)
    }

    fn exact(&self, device: &wgpu::Device, kind: ExactKind) -> ExactPipelines {
        let mut made = self.exact.lock().unwrap_or_else(PoisonError::into_inner);
        let number = |on: bool| f64::from(u8::from(on));
        let collector = |entry, samples| {
            let constants = [
                ("fades", number(kind.fades)),
                ("core_grows", number(kind.core_grows)),
                ("rim_grows", number(kind.rim_grows)),
                ("hides", number(kind.hides)),
                ("keeps_energy", number(kind.keeps_energy)),
                ("samples", number(samples)),
            ];
            specialised_pipeline(device, (&self.collect_layout, &self.collector), entry, &constants)
        };
        let make = || ExactPipelines {
            sample_patches: collector("sample_patches", true),
            draw_patches: specialised_pipeline(
                device,
                (&self.smooth_layout, &self.drawer),
                "draw_patches",
                &[("keeps_energy", number(kind.keeps_energy))],
            ),
            collect_energy: collector("collect_energy", false),
            collect_full: collector("collect_full", false),
        };
        made.entry(kind).or_insert_with(make).clone()
    }

    fn reference(
        &self,
        device: &wgpu::Device,
        (kind, keeps_energy): (ReferenceKind, bool),
    ) -> wgpu::ComputePipeline {
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
                ("de_boor", number(kind.de_boor)),
                ("keeps_energy", number(keeps_energy)),
            ];
            let module = shader(device, "waves_reference", wgsl);
            specialised_pipeline(
                device,
                (&self.collect_layout, &module),
                "collect_reference",
                &constants,
            )
        };
        made.entry((kind, keeps_energy)).or_insert_with(make).clone()
    }
}

/// Clears the layers, and the energy if it is wanted.
fn clear(encoder: &mut wgpu::CommandEncoder, targets: &Targets, waves: Option<&WaveTargets>) {
    let layers = (0..targets.size.glow_layers).map(|layer| {
        targets.glow.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        })
    });
    for view in layers.chain(waves.map(|waves| waves.energy.view.clone())) {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("clear waves"),
            color_attachments: &[cleared(&view, None)],
            ..Default::default()
        });
    }
}
