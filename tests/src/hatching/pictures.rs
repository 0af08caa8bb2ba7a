//! Hatching by pictures: patterns, and the strokes that are seen of them on a plane.

use std::sync::Arc;

use genga::scene::Image;
use genga::style::Style;

use super::{hatching, ink_of, planes};
use crate::draw;

/// Texels along a side of the patterns.
const SIDE: usize = 128;

/// A pattern of level strokes, four of them above each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Endless, gray towards their sides.
    Ruled,
    /// Finite, slanted, of different weights, and only black and white.
    Drawn,
}

/// The picture of a pattern.
#[must_use]
pub fn pattern(pattern: Pattern) -> Image {
    // Left end, middle, slant, half width; in texels.
    let drawn = [
        (5.0, 15.0, 2.0, 4.0),
        (70.0, 17.0, -3.0, 3.0),
        (30.0, 46.0, 1.0, 3.5),
        (100.0, 50.0, 3.0, 4.0),
        (15.0, 81.0, -2.0, 3.0),
        (80.0, 78.0, 2.0, 4.5),
        (45.0, 114.0, 3.0, 4.0),
        (110.0, 112.0, -1.0, 3.5),
    ];
    let side = SIDE as f64;
    let brightness = |x: f64, y: f64| -> f64 {
        if pattern == Pattern::Ruled {
            return 2.0 * ((y / 32.0).fract() - 0.5).abs();
        }
        let in_stroke = |&(left, middle, slant, half): &(f64, f64, f64, f64)| {
            let along = (x - left).rem_euclid(side) / 48.0;
            let from_end = along.min(1.0 - along);
            let line: f64 = middle + slant * (along - 0.5);
            from_end > 0.0 && (y - line).abs() < half * (4.0 * from_end).min(1.0)
        };
        if drawn.iter().any(in_stroke) { 0.0 } else { 1.0 }
    };
    let texel = |i: usize| {
        let v = brightness((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5);
        let v = (v * 255.0).round() as u8;
        [v, v, v, 255]
    };
    Image {
        name: format!("{pattern:?}"),
        width: SIDE as u32,
        height: SIDE as u32,
        rgba: (0..SIDE * SIDE).flat_map(texel).collect(),
    }
}

/// A style of one tone: the part `tone` of the paper is ink. The picture is at most `height` pixels
/// high.
#[must_use]
pub fn pictured(of: Pattern, height: f64, tone: f64, reference_height: u32) -> Style {
    let lum = 0.75 - 0.5 * tone;
    let toml =
        format!("pattern = \"image\"\nspacing = {height}\ntones = [{{ at = 0, lum = {lum} }}]");
    let mut style = hatching(&toml, reference_height);
    style.paint.hatch.image = Some(Arc::new(pattern(of)));
    style
}

/// What strokes on a plane look like.
#[derive(Clone, Copy, Debug)]
pub struct Strokes {
    /// Mean distance down the picture from stroke to stroke, in pixels.
    pub spacing: f64,
    /// Width in pixels that a tenth of the strokes have or exceed.
    pub width: f64,
    /// Part of the plane that is ink.
    pub coverage: f64,
}

/// Draws a plane that fills a view of so many metres and measures its strokes, down all columns.
#[must_use]
pub fn measure(style: &Style, metres: f32, tilt_deg: f32) -> Strokes {
    let (scene, view) = planes::plane(metres, tilt_deg);
    let ink = ink_of(&draw(&scene, style, &view));
    let side = planes::SIZE as usize;
    let mut widths = Vec::new();
    for x in 0..side {
        let mut width = 0.0;
        for y in 0..side {
            let here = ink[y * side + x];
            if here > 0.1 {
                width += here;
            } else {
                widths.push(width);
                width = 0.0;
            }
        }
    }
    widths.retain(|&width| width > 0.5);
    widths.sort_by(f64::total_cmp);
    let rank = (widths.len() * 9 / 10).min(widths.len().saturating_sub(1));
    Strokes {
        spacing: (side * side) as f64 / widths.len().max(1) as f64,
        width: widths.get(rank).copied().unwrap_or(0.0),
        coverage: ink.iter().sum::<f64>() / ink.len() as f64,
    }
}
