//! Every pipeline on wgpu's `noop` backend, with WebGPU's default limits and no features: what
//! wgpu validates there, browsers validate too.

use std::sync::{Arc, Mutex};

use genga::render::{LayerKind, Renderer, View};
use genga::scene::{
    AlphaMode, Beam, BeamOrder, BeamOutline, Highlight, Material, PanoramaPlacement, Placement,
    Pose, Proxy, ProxyMesh, Scene, Shading, Wave, WaveBlend, WaveMethod, WaveOrder, WaveShape,
};
use genga::style::{Globs, HatchMapping};
use genga::{shapes, style::Style};
use genga_tests::scenes::{Builder, moved, ortho_view, parts, perspective_view, style};
use glam::{Quat, Vec3, Vec4};

/// A device that accepts everything valid and does nothing.
fn noop_device() -> (wgpu::Device, wgpu::Queue) {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::NOOP;
    descriptor.backend_options.noop.enable = true;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))
        .expect("the noop backend is part of this build");
    assert_eq!(adapter.get_info().backend, wgpu::Backend::Noop);
    pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: wgpu::Features::empty(),
        required_limits: wgpu::Limits::default(),
        ..Default::default()
    }))
    .expect("the noop backend gives a device")
}

/// All that surfaces can be: mirrored, double-sided, masked, blended.
fn scene_of_all_kinds() -> Scene {
    let mut scene = Builder::new();
    let kinds = [
        (AlphaMode::Opaque, false),
        (AlphaMode::Mask { cutoff: 0.5 }, true),
        (AlphaMode::Blend, false),
        (AlphaMode::Blend, true),
    ];
    for (i, (alpha, double_sided)) in kinds.into_iter().enumerate() {
        let material = scene.material(Material {
            name: format!("material {i}"),
            alpha,
            double_sided,
            base_color: Vec4::new(1.0, 0.5, 0.2, 0.7),
            ..Material::default()
        });
        let at = moved(i as f32, 0.0, 0.0);
        scene.object("plain", shapes::cuboid(Vec3::ONE), Some(material), at);
        let mirror = parts(Vec3::NEG_Y, Quat::IDENTITY, Vec3::new(-1.0, 1.0, 1.0));
        scene.object("mirrored", shapes::cuboid(Vec3::ONE), Some(material), mirror);
    }
    let mut scene = scene.build();
    scene.highlights = highlights_of_all_kinds();
    let proxy = Some(Proxy::Sphere { center: Vec3::ZERO });
    scene.shadings = vec![Shading { proxy, amount: 0.5, ..Shading::default() }];
    scene.waves = [
        (WaveOrder::Under, WaveBlend::Linear),
        (WaveOrder::LinesThrough, WaveBlend::Display),
        (WaveOrder::Over, WaveBlend::Linear),
    ]
    .map(|(order, blend)| Wave { order, blend, attenuation: 2.0, ..Wave::default() })
    .to_vec();
    scene.beams = [BeamOrder::Under, BeamOrder::LinesThrough, BeamOrder::Over, BeamOrder::Hide]
        .map(|order| {
            let outline = Some(BeamOutline { color: Vec4::W, width: 3.0 });
            Beam { order, outline, ..Beam::default() }
        })
        .to_vec();
    scene
}

/// Highlights that need everything that pipelines can be specialised for.
fn highlights_of_all_kinds() -> Vec<Highlight> {
    let triangle = ProxyMesh {
        positions: vec![Vec3::X, Vec3::Y, Vec3::Z],
        normals: vec![Vec3::ONE.normalize(); 3],
        indices: vec![[0, 1, 2]],
    };
    let mask = genga_tests::scenes::image(2, 2, |_, _| [255; 4]);
    vec![
        Highlight::default(),
        Highlight {
            proxy: Proxy::Mesh { center: Vec3::ZERO, mesh: Arc::new(triangle) },
            gamma: 0.5,
            mask: Some(Arc::new(mask)),
            placement: Placement::Panorama(PanoramaPlacement::default()),
            ..Highlight::default()
        },
        Highlight {
            objects: Globs::new(["mirrored"]).expect("a glob"),
            proxy: Proxy::Capsule { from: Vec3::ZERO, to: Vec3::Y },
            ..Highlight::default()
        },
        Highlight {
            proxy: Proxy::Ball { center: Vec3::ZERO, radius: 1.0 },
            ..Highlight::default()
        },
    ]
}

const METHODS: [&str; 6] = ["none", "contour", "reference", "hull", "rim", "image"];

fn styles() -> Vec<Style> {
    let mut styles: Vec<Style> =
        METHODS.iter().map(|m| style(&format!("[lines]\nmethod = \"{m}\""))).collect();
    styles.push(style("[motion.speed_lines]\n[motion.smear]"));
    styles.push(style("[paint]\nblend_space = \"linear\""));
    let mut pictured = style("[paint.hatch]\npattern = \"image\"");
    let picture = genga_tests::scenes::image(2, 2, |x, _| [128 * x as u8; 4]);
    pictured.paint.hatch.image = Some(Arc::new(picture));
    for mapping in [HatchMapping::Surface, HatchMapping::Uv, HatchMapping::Screen] {
        pictured.paint.hatch.mapping = mapping;
        styles.push(pictured.clone());
    }
    for pattern in ["strokes", "cross", "solid", "stipple", "pencil", "dots"] {
        for mapping in ["surface", "uv", "screen"] {
            let hatch = format!("pattern = \"{pattern}\"\nmapping = \"{mapping}\"");
            styles.push(style(&format!("[paint.hatch]\n{hatch}")));
        }
    }
    styles.push(style(
        "[paint]\nspecular = {}\nrim_light = {}\nsheen = {}\npalette = [\"#fff\"]\ndots = {}\n\
         shade_map = { from = \"vertex-red\" }\n[paint.shadow]\nenabled = true\nresolution = 256",
    ));
    styles
}

#[test]
fn every_pipeline_is_valid_with_default_limits() {
    let (device, queue) = noop_device();
    let faults = Arc::new(Mutex::new(Vec::new()));
    let slot = Arc::clone(&faults);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        slot.lock().expect("no test panics while it holds this").push(error.to_string());
    }));
    let renderer = Renderer::new(&device, &queue).expect("the renderer's own pipelines are valid");
    let scene = scene_of_all_kinds();
    let formats = [
        wgpu::TextureFormat::Rgba8Unorm,
        wgpu::TextureFormat::Rgba8UnormSrgb,
        wgpu::TextureFormat::Bgra8Unorm,
        wgpu::TextureFormat::Rgba16Float,
    ];
    for style in styles() {
        let mut prepared = renderer.prepare(&scene, &style).expect("the scene is valid");
        let pose = Pose::rest(&scene);
        let mut past = pose.clone();
        past.world_from_node.iter_mut().for_each(|node| node.translation.x -= 1.0);
        renderer.set_motion(&mut prepared, &scene, &pose, &[past]).expect("the poses fit");
        for view in [perspective_view([48, 32], 40.0, 8.0), ortho_view([48, 32], 4.0)] {
            for supersample in [1, 2] {
                let view = View { supersample, ..view };
                for format in formats {
                    let target = device.create_texture(&wgpu::TextureDescriptor {
                        label: None,
                        size: wgpu::Extent3d { width: 48, height: 32, depth_or_array_layers: 1 },
                        mip_level_count: 1,
                        sample_count: 1,
                        dimension: wgpu::TextureDimension::D2,
                        format,
                        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                        view_formats: &[],
                    });
                    let target = target.create_view(&Default::default());
                    let method = style.lines.method;
                    renderer
                        .render(&prepared, &view, &target, format)
                        .unwrap_or_else(|e| panic!("{method:?}, {supersample}, {format:?}: {e}"));
                }
                let layers = &LayerKind::ALL;
                pollster::block_on(renderer.picture(&prepared, &view, layers, &mut |_, _| {}))
                    .expect("layers can be read back");
            }
        }
    }
    assert_eq!(*faults.lock().expect("nothing panicked"), Vec::<String>::new());
}

#[test]
fn the_waves_reference_is_valid_for_every_curve() {
    let (device, queue) = noop_device();
    let renderer = Renderer::new(&device, &queue).expect("the renderer's own pipelines are valid");
    let points =
        [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [3.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let points = points.to_vec();
    let view = perspective_view([48, 32], 40.0, 8.0);
    for shape in [
        WaveShape::Sphere,
        WaveShape::Capsule { length: 1.0 },
        WaveShape::Helix { length: 1.0, radius: 0.2, turns: 2.0, phase: 0.0 },
        WaveShape::Trig { length: 1.0, turns: 1.0, y: vec![[0.1, 0.2]], z: Vec::new() },
        WaveShape::Bezier { points: points.clone() },
        WaveShape::BSpline { points: points.clone(), order: 3, knots: Vec::new() },
        WaveShape::Polyline { points },
    ] {
        for thinning in [1, 2] {
            let mut scene = scene_of_all_kinds();
            scene.waves = vec![Wave { shape: shape.clone(), ..Wave::default() }];
            scene.wave_method = WaveMethod::Simpson { points: 10, thinning, de_boor: false };
            let prepared = renderer.prepare(&scene, &Style::default()).expect("it is valid");
            let mut progress = |_, _| {};
            let picture = renderer.picture(&prepared, &view, &[], &mut progress);
            pollster::block_on(picture).unwrap_or_else(|e| panic!("{shape:?}: {e}"));
        }
    }
}

#[test]
fn the_benchmarks_baseline_is_valid_too() {
    let (device, queue) = noop_device();
    let renderer = Renderer::new(&device, &queue).expect("the renderer's own pipelines are valid");
    let prepared =
        renderer.prepare(&scene_of_all_kinds(), &Style::default()).expect("the scene is valid");
    let view = perspective_view([48, 32], 40.0, 8.0);
    for workload in [genga::render::Workload::Plain, genga::render::Workload::Styled] {
        let times = pollster::block_on(renderer.time_frame(&prepared, &view, workload))
            .expect("both workloads run");
        assert_eq!(times.gpu_ms, None, "a device without timestamps measures none");
    }
}
