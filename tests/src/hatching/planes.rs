//! Strokes on a plane: every pixel against the formula in f64, their distance, their tone.

use genga::render::View;
use genga::shapes;
use genga::style::Style;
use glam::{Quat, Vec2, Vec3};

use super::{hatching, ink_of};
use crate::scenes::{Builder, ortho_view, parts};
use crate::{Pixels, draw};

/// Pixels along a side of the pictures.
pub const SIZE: u32 = 256;

/// What strokes on a plane look like.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Mean distance of neighbouring strokes in pixels, across them.
    pub spacing: f64,
    /// Part of the plane that is ink.
    pub coverage: f64,
}

/// A ruler's strokes of a tone that is the same everywhere.
#[must_use]
pub fn even_strokes(spacing: f64, lum: f64, threshold: f64) -> Style {
    let toml = format!(
        "pattern = \"strokes\"\nspacing = {spacing}\nlength = 0\nirregularity = 0\n\
         threshold = {threshold}\ntones = [{{ at = 0, lum = {lum} }}]"
    );
    hatching(&toml, SIZE)
}

/// A plane that fills a view of so many metres, its rows of strokes level, tilted by `tilt_deg`
/// round the horizontal. It stands beside the origin, so that no stroke lies in its middle.
#[must_use]
pub fn plane(metres: f32, tilt_deg: f32) -> (genga::scene::Scene, View) {
    let mut scene = Builder::new();
    let mut primitive = shapes::plane(Vec2::splat(metres * 4.0));
    let middle = Vec3::new(0.37, 0.71, 0.0) * metres;
    primitive.positions.iter_mut().for_each(|p| *p += middle);
    let rotation = Quat::from_rotation_x(tilt_deg.to_radians());
    let transform = parts(-(rotation * middle), rotation, Vec3::ONE);
    scene.object("plane", primitive, None, transform);
    let mut view = ortho_view([SIZE, SIZE], metres);
    view.supersample = 1;
    view.camera.world_from_camera.translation = (Vec3::Z * metres * 10.0).into();
    view.camera.near = metres;
    (scene.build(), view)
}

/// Draws a plane and measures it.
#[must_use]
pub fn measure(style: &Style, metres: f32, tilt_deg: f32) -> Figures {
    let (scene, view) = plane(metres, tilt_deg);
    let picture = draw(&scene, style, &view);
    let ink = ink_of(&picture);
    let coverage = ink.iter().sum::<f64>() / ink.len() as f64;
    // A stroke begins where ink begins, down a column.
    let column = |y: u32| ink[(y * SIZE + SIZE / 2) as usize] > 0.02;
    let begins: Vec<u32> = (1..SIZE).filter(|&y| column(y) && !column(y - 1)).collect();
    let spacing = match (begins.first(), begins.last()) {
        (Some(first), Some(last)) if begins.len() > 1 => {
            f64::from(last - first) / (begins.len() - 1) as f64
        }
        _ => f64::INFINITY,
    };
    Figures { spacing, coverage }
}

/// The coverage that a row of pixels must have, by the formula in f64: strokes at whole multiples of
/// a power of two, each second one thinner the nearer the next power is.
#[must_use]
pub fn expected(y_rest: f64, metres_per_px: f64, spacing: f64, darkness: f64) -> f64 {
    let rho = (metres_per_px * spacing).log2();
    let (period, frac) = (rho.floor().exp2(), rho - rho.floor());
    let x = y_rest / period;
    let even = 2.0 * (0.5 * x).round();
    let odd = even + if x >= even { 1.0 } else { -1.0 };
    let grown = (frac - 1.0).exp2();
    let texel = metres_per_px / period;
    let width = darkness.clamp(0.0, 0.999);
    let covered = |d: f64, half: f64| {
        let clamp = |v: f64| v.clamp(-0.5 * texel, 0.5 * texel);
        (clamp(d.abs() + half) - clamp(d.abs() - half)) / texel
    };
    (covered(x - even, width * grown) + covered(x - odd, width * (1.0 - grown))).min(1.0)
}

/// Largest difference in 1/255 between the picture of a plane that faces the eye and [`expected`].
#[must_use]
pub fn formula_error(spacing: f64, lum: f64, threshold: f64, metres: f32) -> f64 {
    let (scene, view) = plane(metres, 0.0);
    let picture = draw(&scene, &even_strokes(spacing, lum, threshold), &view);
    let px = f64::from(metres) / f64::from(SIZE);
    let darkness = threshold + 1.0 - 2.0 * lum;
    let mut worst = 0.0_f64;
    for y in 0..SIZE {
        let in_world = (f64::from(SIZE) / 2.0 - f64::from(y) - 0.5) * px;
        let wanted = expected(in_world + 0.71 * f64::from(metres), px, spacing, darkness);
        for x in 0..SIZE {
            let ink = 255.0 - f64::from(picture.at(x, y)[0]);
            worst = worst.max((ink - 255.0 * wanted).abs());
        }
    }
    worst
}
