//! Stipple: the asked tone at every size, points that stay, and no lattice.

use genga::scene::Pose;
use genga::style::Style;
use genga_tests::hatching::surface::Frame;
use genga_tests::hatching::{hatching, ink_of, planes, subjects};
use genga_tests::{draw, scenes};

fn stipple(tone: f64, spacing: f64, reference_height: u32) -> Style {
    let lum = 0.75 - 0.5 * tone;
    let toml =
        format!("pattern = \"stipple\"\nspacing = {spacing}\ntones = [{{ at = 0, lum = {lum} }}]");
    hatching(&toml, reference_height)
}

#[test]
fn stipple_covers_the_asked_tone_at_every_size() {
    for tone in [0.1, 0.4, 0.6, 0.8, 0.9] {
        let style = stipple(tone, 7.0, planes::SIZE);
        for tilt_deg in [0.0, 45.0] {
            let at = |step: u8| {
                let metres = (0.5 * f32::from(step) - 1.0).exp2();
                planes::measure(&style, metres, tilt_deg).coverage
            };
            let all: Vec<f64> = (0..3).map(at).collect();
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            assert!((mean - tone).abs() <= 0.02, "tone {tone}, {tilt_deg}°: {all:.3?}");
        }
    }
}

#[test]
fn a_slow_zoom_changes_few_points() {
    let scene = subjects::standing("sphere");
    let (pose, style) = (Pose::rest(&scene), stipple(0.4, 8.0, 192));
    let frame = |zoom| Frame::draw(&scene, &pose, &style, &subjects::magnified(192, zoom));
    for i in 0_u8..3 {
        let zoom = (0.41 * f32::from(i)).exp2();
        let changed = frame(zoom * 1.01).changed_since(&frame(zoom));
        assert!(changed <= 0.02, "zoom {zoom}: {:.2} %", 100.0 * changed);
    }
}

#[test]
fn points_stay_on_a_turning_body() {
    let scene = subjects::standing("cylinder");
    let style = stipple(0.3, 12.0, 384);
    let frame = |degrees| {
        let pose = subjects::turned(&scene, degrees);
        Frame::draw(&scene, &pose, &style, &subjects::front(384))
    };
    let drift = frame(24.0).drift_since(&frame(0.0));
    assert!(drift <= 1.0, "{drift} px");
}

/// The largest part of the ink's variance that repeats at one distance, of those from 5 to 40 pixels
/// along the picture: near 1 for a grid.
fn repetition(style: &Style) -> f64 {
    const SIDE: usize = planes::SIZE as usize;
    let mut scene = scenes::Builder::new();
    scene.object("plane", genga::shapes::plane(glam::Vec2::splat(8.0)), None, Default::default());
    let view = genga::render::View { supersample: 1, ..scenes::ortho_view([planes::SIZE; 2], 1.3) };
    let ink = ink_of(&draw(&scene.build(), style, &view));
    let mean = ink.iter().sum::<f64>() / ink.len() as f64;
    let together = |dx: usize, dy: usize| -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for y in 0..SIDE - dy {
            for x in 0..SIDE - dx {
                sum += (ink[y * SIDE + x] - mean) * (ink[(y + dy) * SIDE + x + dx] - mean);
                count += 1.0;
            }
        }
        sum / count
    };
    let variance = together(0, 0);
    let far = |&(dx, dy): &(usize, usize)| dx.max(dy) >= 5;
    let steps = (0..=40).flat_map(|dx| (0..=40).map(move |dy| (dx, dy))).filter(far);
    steps.map(|(dx, dy)| together(dx, dy) / variance).fold(0.0, f64::max)
}

#[test]
fn points_are_in_no_lattice() {
    for tone in [0.2, 0.5, 0.8] {
        let repeated = repetition(&stipple(tone, 10.0, planes::SIZE));
        assert!(repeated < 0.3, "tone {tone}: {repeated:.2}");
    }
    let dots = hatching(
        "pattern = \"dots\"\nlines_per_inch = 26\npage_height_in = 1\ntones = [{ at = 0, lum = 0.5 }]",
        planes::SIZE,
    );
    let repeated = repetition(&dots);
    assert!(repeated > 0.6, "screen tone repeats by {repeated:.2}, so this proves nothing");
}
