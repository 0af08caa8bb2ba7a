//! What cannot be drawn is refused with a sentence; what is odd is drawn.

use genga::render::{Gpu, GpuOptions, Picture, RenderError, Renderer, View, Workload};
use genga::scene::{Pose, Primitive, Projection, Scene};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{model, ortho_view, perspective_view, style};
use genga_tests::{Pixels, draw, shared};
use glam::{Vec2, Vec3};

fn square() -> Scene {
    shapes::scene_of("square", shapes::plane(Vec2::ONE))
}

fn try_draw(view: &View) -> Result<Picture, RenderError> {
    let shared = shared();
    let _turn = shared.turn();
    let prepared = shared.renderer.prepare(&square(), &Style::default())?;
    let result = pollster::block_on(shared.renderer.picture(&prepared, view, &[], &mut |_, _| {}));
    assert_eq!(shared.gpu.take_fault(), None, "the driver was asked for something impossible");
    result
}

fn refusal(view: &View) -> String {
    match try_draw(view) {
        Ok(picture) => panic!("{}×{} pixels were drawn", picture.width, picture.height),
        Err(error) => error.to_string(),
    }
}

#[test]
fn impossible_sizes_are_refused() {
    let view = ortho_view([16, 16], 2.0);
    for size in [[0, 16], [16, 0], [16_385, 16], [16, u32::MAX]] {
        let sentence = refusal(&View { size, ..view });
        let shown = format!("{}×{}", size[0], size[1]);
        assert!(sentence.contains(&shown) && sentence.contains("16384"), "{sentence}");
    }
    for supersample in [0, 5, u32::MAX] {
        let sentence = refusal(&View { supersample, ..view });
        assert!(sentence.contains(&format!("not {supersample}")), "{sentence}");
    }
}

#[test]
fn impossible_cameras_are_refused() {
    let view = perspective_view([16, 16], 40.0, 3.0);
    let changed = |change: &dyn Fn(&mut View)| {
        let mut view = view;
        change(&mut view);
        refusal(&view)
    };
    let sentences = [
        changed(&|v| v.camera.world_from_camera.translation.x = f32::NAN),
        changed(&|v| v.camera.world_from_camera.matrix3.y_axis.z = f32::INFINITY),
        changed(&|v| v.camera.near = 0.0),
        changed(&|v| v.camera.near = f32::NAN),
        changed(&|v| v.camera.projection = Projection::Perspective { fov_y: f32::NAN }),
        changed(&|v| v.camera.projection = Projection::Perspective { fov_y: 0.0 }),
        changed(&|v| v.camera.projection = Projection::Perspective { fov_y: -1.0 }),
        changed(&|v| v.camera.projection = Projection::Orthographic { height: 0.0 }),
        changed(&|v| v.camera.projection = Projection::Orthographic { height: f32::INFINITY }),
    ];
    for sentence in sentences {
        assert!(sentence.contains("camera"), "{sentence}");
    }
}

#[test]
fn a_pose_of_another_scene_is_refused() {
    let shared = shared();
    let _turn = shared.turn();
    let scene = square();
    let mut prepared =
        shared.renderer.prepare(&scene, &Style::default()).expect("a square can be prepared");
    let other = model("teapot-on-box");
    for (scene, pose) in
        [(&scene, Pose::rest(&other)), (&other, Pose::rest(&other)), (&other, Pose::rest(&scene))]
    {
        let error = shared.renderer.set_pose(&mut prepared, scene, &pose);
        assert!(error.is_err_and(|e| e.to_string().contains("pose")));
    }
    assert!(shared.renderer.set_pose(&mut prepared, &scene, &Pose::rest(&scene)).is_ok());
}

#[test]
fn an_inconsistent_scene_is_refused() {
    let shared = shared();
    let mut scene = square();
    scene.meshes[0].primitives[0].indices[0] = 99;
    let error = shared.renderer.prepare(&scene, &Style::default()).err();
    assert!(error.is_some_and(|e| e.to_string().contains("vertex")));
}

#[test]
fn nothing_is_drawn_as_background() {
    let no_triangles = shapes::scene_of("empty", Primitive::default());
    for scene in [Scene::default(), no_triangles] {
        for method in ["contour", "reference", "hull", "rim", "image", "none"] {
            let style = style(&format!(
                "[background]\ncolor = \"#336699\"\n[lines]\nmethod = \"{method}\""
            ));
            for view in [ortho_view([24, 16], 2.0), perspective_view([24, 16], 40.0, 3.0)] {
                let picture = draw(&scene, &style, &view);
                let at = |(x, y)| picture.at(x, y);
                assert!(picture.places().all(|p| at(p) == [0x33, 0x66, 0x99, 255]), "{method}");
            }
        }
    }
}

#[test]
fn triangles_without_area_and_huge_places_do_no_harm() {
    let mut square = shapes::plane(Vec2::ONE);
    let far = Vec3::splat(1e30);
    square.positions.extend([far, -far, Vec3::new(f32::MAX, 0.0, 0.0)]);
    square.normals.extend([Vec3::Z; 3]);
    square.uvs.clear();
    square.indices.extend([0, 0, 1, 2, 2, 2, 4, 5, 6]);
    let scene = shapes::scene_of("odd", square);
    for method in ["contour", "reference", "hull", "rim", "image"] {
        let style = style(&format!("[lines]\nmethod = \"{method}\""));
        let picture = draw(&scene, &style, &perspective_view([32, 32], 40.0, 3.0));
        assert_eq!(picture.at(16, 16)[3], 255, "{method}");
    }
}

#[test]
fn a_target_of_another_format_is_refused() {
    let shared = shared();
    let _turn = shared.turn();
    let renderer = &shared.renderer;
    let prepared = renderer.prepare(&square(), &Style::default()).expect("a square is valid");
    let target = shared.gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 16, height: 16, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let target = target.create_view(&Default::default());
    let view = ortho_view([16, 16], 2.0);
    let wrong = wgpu::TextureFormat::Bgra8Unorm;
    assert!(renderer.render(&prepared, &view, &target, wrong).is_err());
    let right = wgpu::TextureFormat::Rgba8Unorm;
    assert!(renderer.render(&prepared, &view, &target, right).is_ok());
    assert_eq!(shared.gpu.take_fault(), None);
}

#[test]
fn many_vertices_are_drawn() {
    let object = shapes::smooth_object(200_000).expect("an even number");
    let scene = shapes::scene_of("object", object);
    let view = genga_tests::orbit_view(&scene, &genga::render::Orbit::default(), [96, 96]);
    let picture = draw(&scene, &Style::default(), &view);
    let inked = picture.places().filter(|&(x, y)| picture.at(x, y) != [255; 4]).count();
    assert!((100..3000).contains(&inked), "{inked} pixels of lines");
}

#[test]
fn a_lost_device_is_an_error_and_no_panic() {
    let gpu = pollster::block_on(Gpu::headless(&GpuOptions::default())).expect("an adapter");
    let renderer = Renderer::new(&gpu.device, &gpu.queue).expect("the pipelines are valid");
    let prepared = renderer.prepare(&square(), &Style::default()).expect("the scene is valid");
    let view = ortho_view([16, 16], 2.0);
    gpu.device.destroy();
    let drawn = pollster::block_on(renderer.picture(&prepared, &view, &[], &mut |_, _| {}));
    assert!(drawn.is_err(), "a picture came from a destroyed device");
    assert!(renderer.prepare(&square(), &Style::default()).is_err());
    let timed = pollster::block_on(renderer.time_frame(&prepared, &view, Workload::Styled));
    assert!(timed.is_err());
}
