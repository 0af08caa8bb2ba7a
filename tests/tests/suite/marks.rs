//! Marks besides strokes and stipple: screen tone, cross-hatching, solid black, pencil.

use genga_tests::draw;
use genga_tests::hatching::{hatching, ink_of, planes};

const SIDE: usize = planes::SIZE as usize;

/// The ink on a plane of one tone, row by row.
fn ink(keys: &str, lum: f64) -> Vec<f64> {
    let style = hatching(&format!("{keys}\ntones = [{{ at = 0, lum = {lum} }}]"), planes::SIZE);
    let (scene, view) = planes::plane(1.0, 0.0);
    ink_of(&draw(&scene, &style, &view))
}

fn mean(ink: &[f64]) -> f64 {
    ink.iter().sum::<f64>() / ink.len() as f64
}

#[test]
fn screen_tone_has_its_lines_per_inch_its_angle_and_its_tone() {
    // Ten pixels from dot to dot, so that a dot lies (8, 6) pixels from the next one.
    let keys = "pattern = \"dots\"\nlines_per_inch = 12.8\npage_height_in = 2\nangle_deg = 36.8699";
    for tone in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let ink = ink(keys, 0.75 - 0.5 * tone);
        let found = mean(&ink);
        assert!((found - tone).abs() <= 0.02, "tone {tone}: {found:.3}");
        // y points down, and angles go from x to the left.
        for (dx, dy) in [(8_usize, -6_isize), (6, 8)] {
            let rows = 10..SIDE - 10;
            let worst = rows
                .flat_map(|y| (0..SIDE - dx).map(move |x| (x, y)))
                .map(|(x, y)| {
                    let other = y.saturating_add_signed(dy) * SIDE + x + dx;
                    (ink[y * SIDE + x] - ink[other]).abs()
                })
                .fold(0.0, f64::max);
            assert!(worst < 0.03, "tone {tone}: moved by ({dx}, {dy}), {worst:.3} differs");
        }
    }
}

#[test]
fn cross_hatching_begins_below_its_tone() {
    let strokes = "pattern = \"strokes\"\nspacing = 10\nirregularity = 0\nlength = 0";
    let cross =
        "pattern = \"cross\"\nspacing = 10\nirregularity = 0\nlength = 0\ncross_below = 0.55";
    assert_eq!(ink(strokes, 0.6), ink(cross, 0.6), "above it there is one direction");
    let below = ink(cross, 0.42);
    // Rows between strokes of one direction are white; the second one crosses all of them.
    let least = |ink: &[f64]| ink.chunks_exact(SIDE).map(mean).fold(f64::INFINITY, f64::min);
    assert!(least(&ink(strokes, 0.6)) < 0.01 && least(&below) > 0.1);
    let all = [0.6, 0.5, 0.42, 0.35, 0.3].map(|lum| mean(&ink(cross, lum)));
    assert!(all.windows(2).all(|pair| pair[0] < pair[1]), "darker tones have more ink: {all:.3?}");
    // Together both directions carry the tone, whatever part of it the second one has.
    for lum in [0.6, 0.5, 0.42, 0.35] {
        let style =
            hatching(&format!("{cross}\ntones = [{{ at = 0, lum = {lum} }}]"), planes::SIZE);
        let at = |step: u8| planes::measure(&style, (0.125 * f32::from(step)).exp2(), 0.0).coverage;
        let found = (0..8).map(at).sum::<f64>() / 8.0;
        let tone: f64 = 1.5 - 2.0 * lum;
        assert!((found - tone).abs() <= 0.02, "lum {lum}: {found:.3}, not {tone:.3}");
    }
}

#[test]
fn solid_black_ends_where_half_of_a_stroke_would() {
    let solid = "pattern = \"solid\"";
    assert!(ink(solid, 0.49).iter().all(|&ink| ink == 1.0));
    assert!(ink(solid, 0.51).iter().all(|&ink| ink == 0.0));
    assert!(ink(&format!("{solid}\nthreshold = 0.7"), 0.59).iter().all(|&ink| ink == 1.0));
}

#[test]
fn pencil_has_a_grain_and_gets_darker_with_the_tone() {
    let all =
        [0.7, 0.6, 0.5, 0.4, 0.3, 0.1].map(|lum| ink("pattern = \"pencil\"\nspacing = 8", lum));
    let means = all.each_ref().map(|ink| mean(ink));
    assert!(means.windows(2).all(|pair| pair[0] < pair[1]), "{means:.3?}");
    // Graphite is 0.9 of black, and covers its part of the tone.
    for irregularity in [0.0, 0.5] {
        for tone in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let lum = 0.75 - 0.5 * tone;
            let keys = format!(
                "pattern = \"pencil\"\nspacing = 6\nirregularity = {irregularity}\n\
                 tones = [{{ at = 0, lum = {lum} }}]"
            );
            let style = hatching(&keys, planes::SIZE);
            let at =
                |step: u8| planes::measure(&style, (0.125 * f32::from(step)).exp2(), 0.0).coverage;
            let found = (0..8).map(at).sum::<f64>() / 8.0;
            let off = (found - 0.9 * tone).abs();
            assert!(off <= 0.02, "hand {irregularity}, tone {tone}: {found:.3}");
        }
    }
    let grey = all[2].iter().filter(|&&ink| ink > 0.1 && ink < 0.8).count();
    assert!(grey > SIDE * SIDE / 20, "only {grey} pixels are neither paper nor graphite");
    assert!(all[5].iter().all(|&ink| ink <= 0.91), "graphite is not black");
}
