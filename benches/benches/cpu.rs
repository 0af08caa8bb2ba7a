//! What the CPU does before a frame: reading styles and models, posing, preparing. The GPU's times
//! come from `genga bench`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use genga::render::{Gpu, GpuOptions, Orbit, Renderer, ViewCamera};
use genga::scene::{Pose, Scene};
use genga::shapes;
use genga::style::Style;

/// A smooth object of a hundred thousand triangles.
fn scene() -> Scene {
    let primitive = shapes::smooth_object(100_000).expect("an even number of triangles");
    shapes::scene_of("object", primitive)
}

fn styles(c: &mut Criterion) {
    let (_, text) = Style::presets().next().expect("there are presets");
    c.bench_function("read a style", |b| {
        b.iter(|| Style::from_toml_str(black_box(text)).expect("presets are valid"));
    });
}

fn models(c: &mut Criterion) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/models/teapot-on-box.glb");
    c.bench_function("load teapot-on-box", |b| {
        b.iter(|| genga::import::load(black_box(path.as_ref())).expect("the model is committed"));
    });
}

fn framing(c: &mut Criterion) {
    let scene = scene();
    let pose = Pose::rest(&scene);
    c.bench_function("frame 100,000 triangles", |b| {
        b.iter(|| {
            let points = black_box(&scene).extremes(&pose);
            ViewCamera::orbit_points(&points, &Orbit::default(), 1.5)
        });
    });
}

fn preparing(c: &mut Criterion) {
    let gpu = pollster::block_on(Gpu::headless(&GpuOptions::default())).expect("an adapter");
    let renderer = Renderer::new(&gpu.device, &gpu.queue).expect("the pipelines are valid");
    let (scene, style) = (scene(), Style::default());
    let mut group = c.benchmark_group("prepare");
    group.sample_size(20);
    group.bench_function("100,000 triangles", |b| {
        b.iter(|| {
            let prepared = renderer.prepare(black_box(&scene), &style).expect("the scene is valid");
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device is there");
            prepared
        });
    });
    group.finish();
}

criterion_group!(benches, styles, models, framing, preparing);
criterion_main!(benches);
