//! The long proofs about highlights, for `cargo xtask verify`.

use genga::render::{LayerKind, Orbit, View};
use genga::scene::{
    BuiltInDrawing, Drawing, FreePlacement, Highlight, PanoramaPlacement, Placement, Pose, Proxy,
    Scene,
};
use genga::scene_file::SceneFile;
use genga::shapes;
use glam::{DVec3, Vec2, Vec3};

use crate::highlights::{
    Random, bare_style, bumpy_ball, covered, free_place, lit_scene, overlap, paint_times,
    panorama_place, put_everywhere,
};
use crate::scenes::{model, orbit_view, root, style};
use crate::{Pixels, draw_layers, perspective_view};

/// What is reported: whether it holds, and what is wrong if it does not.
pub type Check<'a> = &'a mut dyn FnMut(bool, String);

/// Pixels round a panorama 2048 pixels wide.
const PIXEL: f64 = std::f64::consts::TAU / 2048.0;

/// Largest distances from the formulas in f64 of `count` random placements, in pixels: on the
/// panorama, and of the middle of a free drawing.
#[must_use]
pub fn placement_errors(count: usize, seed: u64) -> [f64; 2] {
    let mut random = Random(seed);
    let mut worst = [0.0_f64; 2];
    let angle = |a: DVec3, b: DVec3| a.cross(b).length().atan2(a.dot(b));
    for _ in 0..count {
        let moment = random.moment();
        let panorama = random.panorama_keys(5);
        let expected = panorama_place(&panorama, &moment);
        let placed = Placement::Panorama(panorama).evaluate(&moment);
        for (found, expected) in placed.panorama.unwrap_or_default().into_iter().zip(expected) {
            let off = found - expected;
            let off = off - std::f64::consts::TAU * (off / std::f64::consts::TAU).round();
            worst[0] = worst[0].max(off.abs());
        }
        let free = random.free_keys(5);
        let expected = free_place(&free, &moment);
        let placed = Placement::Free(free).evaluate(&moment);
        worst[1] = worst[1].max(angle(placed.middle(), expected.axes.z_axis));
    }
    worst.map(|angle| angle / PIXEL)
}

/// The head of `assets/models` with a highlight on its hair.
#[must_use]
pub fn head_with(highlight: Highlight) -> Scene {
    let mut scene = model("head");
    let hair = genga::style::Globs::new(["hair"]).unwrap_or_default();
    let proxy = Proxy::Sphere { center: Vec3::new(0.0, 0.26, -0.02) };
    scene.highlights = vec![Highlight { materials: hair, proxy, ..highlight }];
    scene
}

/// A scene file of `assets/scenes/highlights` with everything that it needs.
///
/// # Panics
/// If it cannot be read.
#[must_use]
pub fn scene_file(name: &str) -> Scene {
    let file = SceneFile::load(root().join("assets/scenes/highlights").join(name));
    let file = file.expect("the project's own scenes can be read");
    let load = |path: &std::path::Path| genga::import::load(path).map(|model| model.scene);
    file.assemble(load).expect("the project's own scenes fit their models").scene
}

fn star() -> Highlight {
    Highlight {
        drawing: Drawing::BuiltIn(BuiltInDrawing::Star),
        size: Vec2::splat(1.3),
        ..Highlight::default()
    }
}

/// Placement, putting, and the shape on bumps.
pub fn places(check: Check<'_>) {
    let [panorama, free] = placement_errors(100_000, 1);
    println!("  off the formulas, 100,000 placements: {panorama:.2e} px, {free:.2e} px");
    check(panorama <= 0.5 && free <= 0.5, format!("placement is off by {panorama}, {free} px"));

    let ball = || shapes::uv_sphere(256, 128, 1.0);
    let from = Vec3::new(-0.6, 0.8, 0.7);
    let near = perspective_view([160, 160], 30.0, 4.4);
    for (what, placement) in [
        ("free", Placement::Free(FreePlacement::default())),
        ("panorama", Placement::Panorama(PanoramaPlacement::default())),
    ] {
        let highlight = Highlight { placement, ..star() };
        let scene = lit_scene(ball(), from, vec![highlight.clone()]);
        let puts = put_everywhere(&scene, &near, 250, 3);
        println!("  {what}, {} pixels of a ball: {:.3} px off at most", puts.tried, puts.worst_px);
        check(puts.worst_px <= 1.0, format!("{what} on a ball is off by {} px", puts.worst_px));
        let scene = head_with(highlight);
        let view = orbit_view(&scene, &Orbit::default(), [160, 160]);
        let puts = put_everywhere(&scene, &view, 250, 4);
        println!(
            "  {what}, {} pixels of the head: {:.3} px off at most",
            puts.tried, puts.worst_px
        );
        check(puts.worst_px <= 1.0, format!("{what} on the head is off by {} px", puts.worst_px));
    }

    let shape = |primitive, gamma| {
        let highlight = Highlight { gamma, ..star() };
        let scene = lit_scene(primitive, Vec3::new(0.4, 0.5, 1.0), vec![highlight]);
        let layers = [LayerKind::Highlight];
        covered(&draw_layers(&scene, &bare_style(), &near, &layers))
    };
    let smooth = shape(ball(), 1.0);
    for gamma in [0.0, 0.5, 0.9, 1.0] {
        let same = overlap(&smooth, &shape(bumpy_ball(0.03), gamma));
        println!("  γ = {gamma}: overlap with the shape on a ball {same:.3}");
        check(gamma < 1.0 || same >= 0.9, format!("γ = 1 keeps only {same} of the shape"));
        check(gamma > 0.0 || same < 0.9, format!("γ = 0 keeps {same} of the shape"));
    }
    let same = overlap_on_head(1.0, false);
    println!("  γ = 1, by normals from the centre: overlap of a star on the head's hair {same:.3}");
    for gamma in [0.0, 1.0] {
        let same = overlap_on_head(gamma, true);
        println!(
            "  γ = {gamma}: overlap of a star on the head's hair with one on a ball {same:.3}"
        );
        check((same >= 0.9) == (gamma == 1.0), format!("γ = {gamma} keeps {same} on the head"));
    }
}

/// How much of a star on the head's hair is where it is on a smooth ball, for a part γ of the ball's
/// normals, on average over eight views from all round. The ball is fitted to the hair, as scene
/// files do, and the star is seen on it, or else has its normals at the hair's own places.
///
/// Compared is what the hair itself shows: where there are gaps between locks, there is nothing
/// that could carry the star.
#[must_use]
pub fn overlap_on_head(gamma: f32, seen_on_ball: bool) -> f64 {
    let style = style(
        "[lines]\nmethod = \"none\"\n[light]\nreplace_model_lights = true\npinned_to = \"camera\"",
    );
    let mut head = head_with(star());
    let center = head.highlights[0].proxy.center();
    let fitted = head.fitted_ball(&head.highlights[0], Some(center));
    let radius = match &fitted {
        Some(Proxy::Ball { radius, .. }) => *radius,
        _ => 0.0,
    };
    head.highlights[0].gamma = gamma;
    if let Some(proxy) = fitted.filter(|_| seen_on_ball) {
        head.highlights[0].proxy = proxy;
    }
    let mut ball = shapes::uv_sphere(192, 96, radius);
    ball.positions.iter_mut().for_each(|p| *p += center);
    let proxy = Proxy::Sphere { center };
    let ball = lit_scene(ball, Vec3::ONE, vec![Highlight { proxy, ..star() }]);
    let hair = head.materials.iter().position(|material| material.name == "hair");
    let hair = hair.map_or(0, |index| index as u32 + 1);
    let overlaps = (0_u8..8).map(|step| {
        let (sin, cos) = (f32::from(step) * 45.0).to_radians().sin_cos();
        let eye = center + Vec3::new(0.85 * sin, 0.4, 0.85 * cos);
        let camera = genga::render::ViewCamera {
            world_from_camera: glam::Affine3A::look_at_rh(eye, center, Vec3::Y).inverse(),
            projection: genga::scene::Projection::Perspective { fov_y: 0.4 },
            near: 0.05,
        };
        let view = View { supersample: 1, ..View::new(camera, [320, 320]) };
        let layers = [LayerKind::Highlight, LayerKind::Ids];
        let on_head = draw_layers(&head, &style, &view, &layers);
        let shows_hair = on_head.places().map(|(x, y)| on_head.ids(x, y)[1] == hair);
        let on_ball = covered(&draw_layers(&ball, &style, &view, &layers));
        let on_ball = on_ball.iter().zip(shows_hair).map(|(&star, hair)| star && hair);
        overlap(&covered(&on_head), &on_ball.collect::<Vec<_>>())
    });
    overlaps.sum::<f64>() / 8.0
}

/// What four highlights add to the paint pass.
pub fn cost(check: Check<'_>) {
    let scene = scene_file("head.scene.toml");
    let bounds = scene.bounds(&Pose::rest(&scene)).expect("the head has vertices");
    let orbit = Orbit { azimuth_deg: -22.0, elevation_deg: 4.0, ..Orbit::default() };
    let camera = genga::render::ViewCamera::orbit(&bounds, &orbit, 4.0 / 3.0);
    let view = View { supersample: 1, ..View::new(camera, [800, 600]) };
    let style = genga::style::Style::find("anime").expect("a preset");
    let [plain, highlit] = paint_times(&scene, &style, &view, 41);
    let ratio = highlit / plain;
    let count = scene.highlights.len();
    println!("  {count} on the head: {plain:.2} ms, {highlit:.2} ms, {ratio:.3}");
    check(ratio <= 1.1, format!("{count} highlights make the paint pass {ratio:.3} times as long"));
    for count in 1..=4 {
        let scene = lit_scene(shapes::uv_sphere(128, 64, 1.0), Vec3::ONE, vec![star(); count]);
        let view = View { supersample: 1, ..perspective_view([640, 480], 30.0, 4.4) };
        let [plain, highlit] = paint_times(&scene, &bare_style(), &view, 21);
        let ratio = highlit / plain;
        println!("  {count} on all of a ball: {plain:.2} ms, {highlit:.2} ms, {ratio:.3}");
    }
}
