//! Hatching: the formula on every pixel, distance and tone at every size, strokes that stay on the
//! surface, follow it, and are no comb. The long forms run under `cargo xtask verify`.

use genga::scene::Pose;
use genga_tests::hatching::surface::Frame;
use genga_tests::hatching::{directions, hatching, planes, subjects};

/// As the presets have it.
const HAND: &str = "pattern = \"strokes\"\nspacing = 8\nlength = 60\nirregularity = 0.5\n\
                    tones = [{ at = 0.1, lum = 0.3 }, { at = 0.7, lum = 0.6 }]";

/// Strokes far enough apart to be told from each other, of the same tone everywhere: what changes
/// is their place.
fn sparse(more: &str) -> genga::style::Style {
    hatching(
        &format!(
            "pattern = \"strokes\"\nspacing = 12\nlength = 60\nirregularity = 0.5\nangle_deg = 40\n\
             tones = [{{ at = 0, lum = 0.55 }}]\n{more}"
        ),
        384,
    )
}

#[test]
fn strokes_are_the_formula_on_every_pixel() {
    for (spacing, lum, threshold) in [(9.0, 0.55, 0.5), (14.0, 0.4, 0.5), (6.5, 0.7, 0.8)] {
        for metres in [0.8, 1.3, 2.1] {
            let error = planes::formula_error(spacing, lum, threshold, metres);
            // A half for rounding to 8 bits.
            assert!(error <= 1.5, "{spacing} px, Lum {lum}, {metres} m: {error:.2}/255");
        }
    }
}

#[test]
fn distance_and_tone_are_kept_at_every_size() {
    for metres in [0.002, 0.05, 0.9, 17.0, 150.0] {
        for (lum, tone) in [(0.65, 0.2), (0.45, 0.6)] {
            let figures = planes::measure(&planes::even_strokes(10.0, lum, 0.5), metres, 50.0);
            let spacing = figures.spacing;
            assert!(spacing > 4.9 && spacing < 10.2, "{metres} m: {spacing:.2} px");
            let off = (figures.coverage - tone).abs();
            assert!(off <= 0.02, "{metres} m, tone {tone}: {:.3}", figures.coverage);
        }
    }
}

#[test]
fn a_slow_zoom_changes_few_pixels() {
    let scene = subjects::standing("sphere");
    let (pose, style) = (Pose::rest(&scene), hatching(HAND, 256));
    let frame = |zoom| Frame::draw(&scene, &pose, &style, &subjects::magnified(256, zoom));
    for zoom in [1.0, 1.3, 1.7] {
        let changed = frame(zoom * 1.01).changed_since(&frame(zoom));
        assert!(changed <= 0.02, "zoom {zoom}: {:.2} %", 100.0 * changed);
    }
}

#[test]
fn strokes_stay_on_a_turning_body_but_not_with_the_mapping_screen() {
    let scene = subjects::standing("cylinder");
    let drift = |mapping: &str| {
        let style = sparse(&format!("mapping = \"{mapping}\""));
        let view = subjects::front(384);
        let frame =
            |degrees| Frame::draw(&scene, &subjects::turned(&scene, degrees), &style, &view);
        frame(24.0).drift_since(&frame(0.0))
    };
    let (surface, screen) = (drift("surface"), drift("screen"));
    assert!(surface <= 1.0, "surface: {surface} px");
    assert!(screen > 1.0, "screen: {screen} px, so this proves nothing");
}

#[test]
fn strokes_stay_on_a_skin() {
    let scene = subjects::skinned();
    let style = sparse("");
    let frame = |degrees| {
        Frame::draw(&scene, &subjects::bent(&scene, degrees), &style, &subjects::front(384))
    };
    let drift = frame(24.0).drift_since(&frame(0.0));
    assert!(drift <= 1.0, "{drift} px");
}

#[test]
fn strokes_run_round_the_form() {
    for name in subjects::BODIES {
        let scene = subjects::standing(name);
        let style = hatching(HAND, 384);
        let frame = Frame::draw(&scene, &Pose::rest(&scene), &style, &subjects::front(384));
        let wanted = |hit, _| subjects::round(&frame, hit);
        let (within, all) = directions::within_30_degrees(&frame, wanted);
        assert!(all > 1000, "{name}: only {all} pixels are hatched");
        assert!(within >= 0.95, "{name}: {:.1} %", 100.0 * within);
    }
}

/// A direction has no front: as vectors, opposite ones at neighbours would pass through zero, and
/// strokes would turn half round between them.
#[test]
fn painted_directions_may_point_to_either_end() {
    let ink = |opposite: bool| {
        let mut tube = subjects::body("cylinder");
        tube.hatch_directions = (0..tube.positions.len())
            .map(|v| {
                glam::Vec3::new(0.0, 1.0, 0.0) * if opposite && v % 3 == 0 { -1.0 } else { 1.0 }
            })
            .collect();
        let mut scene = genga_tests::scenes::Builder::new();
        scene.object("tube", tube, None, Default::default());
        let scene = scene.build();
        let style = hatching(&format!("{HAND}\ndirection = \"painted\""), 256);
        Frame::draw(&scene, &Pose::rest(&scene), &style, &subjects::front(256)).ink
    };
    let (one, other) = (ink(false), ink(true));
    assert!(one.iter().sum::<f64>() > 1000.0);
    let off = one.iter().zip(&other).filter(|(a, b)| (*a - *b).abs() > 0.02).count();
    assert_eq!(off, 0, "pixels that differ");
}

/// A square whose normal was the direction that stood for none: its strokes went by how it stood in
/// the world.
#[test]
fn strokes_along_an_axis_turn_with_what_they_lie_on() {
    use genga::render::{View, ViewCamera};
    use glam::{Affine3A, Quat, Vec2, Vec3};
    let style = hatching(
        "pattern = \"strokes\"\nspacing = 8\ndirection = \"fixed\"\naxis = [1, 0.4, 0]\n\
         tones = [{ at = 0, lum = 0.5 }]",
        192,
    );
    let ink = |turn: Quat| {
        let mut scene = genga_tests::scenes::Builder::new();
        let standing = genga_tests::scenes::parts(Vec3::ZERO, turn, Vec3::ONE);
        scene.object("square", genga::shapes::plane(Vec2::splat(2.0)), None, standing);
        let scene = scene.build();
        let slanted = Affine3A::from_rotation_y(0.9) * Affine3A::from_translation(Vec3::Z * 4.0);
        let camera = ViewCamera {
            world_from_camera: Affine3A::from_quat(turn) * slanted,
            ..subjects::front(192).camera
        };
        let view = View { camera, ..subjects::front(192) };
        Frame::draw(&scene, &Pose::rest(&scene), &style, &view).ink
    };
    let (standing, turned) =
        (ink(Quat::IDENTITY), ink(Quat::from_euler(glam::EulerRot::ZXY, 0.8, 0.3, 0.0)));
    assert!(standing.iter().sum::<f64>() > 1000.0);
    let off = standing.iter().zip(&turned).filter(|(a, b)| (*a - *b).abs() > 0.1).count();
    assert!(off < standing.len() / 500, "{off} pixels differ");
}

/// On a box each side has strokes of one direction, along its edges.
#[test]
fn the_sides_of_a_box_have_one_direction_each() {
    let mut scene = genga_tests::scenes::Builder::new();
    let size = glam::Vec3::new(1.6, 0.7, 0.9);
    scene.object("box", genga::shapes::cuboid(size), None, Default::default());
    let scene = scene.build();
    let orbit =
        genga::render::Orbit { azimuth_deg: -35.0, elevation_deg: 30.0, ..Default::default() };
    let view = genga::render::View {
        supersample: 1,
        ..genga_tests::scenes::orbit_view(&scene, &orbit, [384, 384])
    };
    let style = hatching(
        "pattern = \"strokes\"\nspacing = 8\nlength = 60\nirregularity = 0.5\n\
         tones = [{ at = 0, lum = 0.5 }]",
        384,
    );
    let frame = Frame::draw(&scene, &Pose::rest(&scene), &style, &view);
    // The front's and the top's longer sides go along x, and so do those of both others along z.
    let along = |hit: genga_tests::hatching::surface::Hit, _| {
        let [a, b, c] = frame.posed().triangles[hit.triangle];
        let n = (b - a).cross(c - a).normalize();
        Some(if n.x.abs() > 0.5 { glam::DVec3::Z } else { glam::DVec3::X })
    };
    let (within, all) = directions::within_30_degrees(&frame, along);
    assert!(all > 5000, "only {all} pixels are hatched");
    assert!(within >= 0.97, "{:.1} % within 30°", 100.0 * within);
}

#[test]
fn strokes_are_no_comb() {
    let scene = subjects::standing("cylinder");
    let spread = |irregularity: f32| {
        let of_hand = |seed: u32| {
            let style = hatching(
                &format!(
                    "pattern = \"strokes\"\nspacing = 8\nlength = 110\nseed = {seed}\n\
                     irregularity = {irregularity}\n\
                     tones = [{{ at = 0.2, lum = 0.2 }}, {{ at = 0.7, lum = 0.76 }}]"
                ),
                384,
            );
            let view = subjects::magnified(384, 1.2);
            Frame::draw(&scene, &Pose::rest(&scene), &style, &view).spread_of_ends()
        };
        (0..4).map(of_hand).sum::<f64>() / 4.0
    };
    let (drawn, ruled) = (spread(0.5), spread(0.0));
    assert!(drawn >= 0.15, "{drawn:.3}");
    assert!(ruled < 0.05, "a ruler's ends spread by {ruled:.3}, so this proves nothing");
}

#[test]
fn strokes_of_a_hand_cover_the_asked_tone() {
    let hands = [("", 1), ("irregularity = 0.75", 2), ("irregularity = 1", 2)];
    for (hand, every) in hands {
        for i in (1_u8..=9).step_by(every) {
            let tone = f64::from(i) / 10.0;
            let toml = format!(
                "pattern = \"strokes\"\nspacing = 8\n{hand}\ntones = [{{ at = 0, lum = {} }}]",
                0.75 - 0.5 * tone
            );
            let style = hatching(&toml, 256);
            let at =
                |step: u8| planes::measure(&style, (0.125 * f32::from(step)).exp2(), 0.0).coverage;
            let coverage = (0..8).map(at).sum::<f64>() / 8.0;
            let off = (coverage - tone).abs();
            assert!(off <= 0.02, "{hand} tone {tone}: {coverage:.3}");
        }
    }
}

#[test]
fn small_forms_have_blacks_but_no_crumbs_of_light_strokes() {
    let scene = subjects::standing("sphere");
    let covered = |spacing: u32, lum: f64| {
        let style = hatching(
            &format!(
                "pattern = \"strokes\"\nspacing = {spacing}\ntones = [{{ at = 0, lum = {lum} }}]"
            ),
            256,
        );
        let frame = Frame::draw(&scene, &Pose::rest(&scene), &style, &subjects::front(256));
        let seen = (0..256 * 256).filter(|i| frame.seen(i % 256, i / 256).is_some()).count();
        frame.ink.iter().sum::<f64>() / seen as f64
    };
    // A light tone, where the sphere has room for many strokes of one direction, and for one.
    let (large, small) = (covered(3, 0.6), covered(60, 0.6));
    assert!(large > 0.2, "{large:.3}");
    assert!(small < 0.5 * large, "{small:.3} of {large:.3}");
    let black = covered(60, 0.2);
    assert!(black > 0.97, "{black:.3}");
}
