//! Hatching by a picture of the user's: the same strokes and the asked tone at every distance.

use genga::scene::Pose;
use genga_tests::hatching::pictures::{self, Pattern, Strokes};
use genga_tests::hatching::subjects;
use genga_tests::hatching::surface::Frame;

/// Planes over four octaves of size, a fifth of one apart.
fn over_four_octaves(pattern: Pattern, tone: f64, tilt_deg: f32) -> Vec<Strokes> {
    let style = pictures::pictured(pattern, 48.0, tone, 256);
    let metres = |i: u8| 0.7 * (0.19 * f32::from(i)).exp2();
    (0..=21).map(|i| pictures::measure(&style, metres(i), tilt_deg)).collect()
}

#[test]
fn strokes_of_pictures_keep_width_and_distance_on_the_picture() {
    for tilt_deg in [0.0, 45.0] {
        for pattern in [Pattern::Ruled, Pattern::Drawn] {
            let (mut thinnest, mut widest) = (f64::INFINITY, 0.0_f64);
            for s in over_four_octaves(pattern, 0.3, tilt_deg) {
                // Four strokes above each other in 48 px; drawn ones leave gaps at their ends.
                let spacing = s.spacing;
                assert!(spacing > 6.0 && spacing < 15.0, "{pattern:?}, {tilt_deg}°: {s:?}");
                (thinnest, widest) = (thinnest.min(s.width), widest.max(s.width));
            }
            let widths = format!("{pattern:?}, {tilt_deg}°: {thinnest:.2} to {widest:.2} px");
            assert!(thinnest > 2.5 && widest < 1.25 * thinnest, "{widths}");
        }
    }
}

#[test]
fn pictures_cover_the_asked_tone() {
    for pattern in [Pattern::Ruled, Pattern::Drawn] {
        for tone in [0.1, 0.3, 0.5, 0.8] {
            for s in over_four_octaves(pattern, tone, 0.0) {
                assert!((s.coverage - tone).abs() <= 0.02, "{pattern:?}, tone {tone}: {s:?}");
            }
        }
    }
}

#[test]
fn a_slow_zoom_on_a_picture_changes_few_pixels() {
    let scene = subjects::standing("sphere");
    let pose = Pose::rest(&scene);
    for pattern in [Pattern::Ruled, Pattern::Drawn] {
        let mut style = pictures::pictured(pattern, 48.0, 0.4, 192);
        // Thin strokes along a row of pixels are in one row or in two.
        style.paint.hatch.angle_deg = 40.0;
        let frame = |zoom| Frame::draw(&scene, &pose, &style, &subjects::magnified(192, zoom));
        for i in 0_u8..16 {
            let zoom = (0.21 * f32::from(i)).exp2();
            let changed = frame(zoom * 1.01).changed_since(&frame(zoom));
            assert!(changed <= 0.02, "{pattern:?}, zoom {zoom}: {:.2} %", 100.0 * changed);
        }
    }
}
