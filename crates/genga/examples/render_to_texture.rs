//! Draws a GLB into a texture of the program's own wgpu device, and saves it.
//!
//! `cargo run --example render_to_texture -- model.glb picture.png`

use std::error::Error;

use genga::render::{Orbit, Renderer, View, ViewCamera};
use genga::scene::Pose;
use genga::style::Style;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let model = arguments.next().ok_or("usage: render_to_texture MODEL [PICTURE]")?;
    let output = arguments.next().unwrap_or_else(|| "picture.png".to_owned());

    // The program's own device; any will do, with WebGPU's default limits.
    let instance = wgpu::Instance::default();
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

    // Load, prepare, pose.
    let scene = genga::import::load(model.as_ref())?.scene;
    let style = Style::preset("american-comic").ok_or("no such style")?;
    let renderer = Renderer::new(&device, &queue)?;
    let prepared = renderer.prepare(&scene, &style)?;

    // Draw into our own texture.
    let size = [800, 600];
    let points = scene.extremes(&Pose::rest(&scene));
    let camera = ViewCamera::orbit_points(&points, &Orbit::default(), 800.0 / 600.0);
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("our texture"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let target = texture.create_view(&Default::default());
    let view = View::new(camera, size);
    renderer.render(&prepared, &view, &target, texture.format())?;

    // The same view as bytes, for a file.
    let picture = pollster::block_on(renderer.picture(&prepared, &view, &[], &mut |_, _| {}))?;
    image::save_buffer(&output, &picture.rgba, 800, 600, image::ColorType::Rgba8)?;
    Ok(())
}
