//! The drawn outline of a round thing, ray by ray from its middle.

use glam::{DVec2, DVec3};

use super::expected::{Kind, Line};
use super::ink::Ink;
use crate::eye::Eye;

/// How far from the expected line ink is looked for, in line widths and pixels.
const REACH_PX: f64 = 6.0;
/// Steps along a ray in pixels.
const STEP_PX: f64 = 0.125;

/// A drawn outline against the expected one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outline {
    /// Rays that were looked along.
    pub rays: usize,
    /// Largest distance of the drawn line's middle from the expected one in pixels.
    pub off_px: f64,
    /// Its root of the mean square.
    pub rms_px: f64,
    /// Rays without ink.
    pub open: usize,
    /// Rays that meet more than one line.
    pub doubled: usize,
    /// Largest difference of the line's width from the wanted one in pixels.
    pub width_off_px: f64,
    /// Largest turn of the drawn line's direction within [`TURN_PX`] pixels that the expected one
    /// does not make, in degrees.
    pub turn_deg: f64,
}

/// Length over which a direction is taken, in pixels: lines of pixels bend by what antialiasing
/// rounds, which a shorter base would enlarge.
pub const TURN_PX: f64 = 8.0;

/// Measures the outline of a thing whose contour is one closed curve round `middle`, seen from
/// there in every direction once.
///
/// # Panics
/// If the contour is not closed round the middle.
#[must_use]
pub fn outline(ink: &Ink, lines: &[Line], eye: &Eye, middle: DVec3, width: f64) -> Outline {
    let center = eye.project(middle);
    let contour: Vec<[DVec2; 2]> = lines
        .iter()
        .filter(|line| line.kind == Kind::Contour && line.must)
        .map(|line| line.ends.map(|p| eye.project(p) - center))
        .collect();
    let radius = contour.iter().map(|ends| ends[0].length()).fold(0.0, f64::max);
    let count = (std::f64::consts::TAU * radius).ceil() as usize;
    let mut outline = Outline { rays: count, ..Outline::default() };
    let (mut drawn, mut expected) = (Vec::new(), Vec::new());
    for i in 0..count {
        let angle = std::f64::consts::TAU * i as f64 / count as f64;
        let out = DVec2::new(angle.cos(), angle.sin());
        let at = crossing(&contour, out)
            .unwrap_or_else(|| panic!("the contour has a hole at {:.1}°", angle.to_degrees()));
        expected.push(out * at);
        let profile = profile(ink, center, out, at);
        outline.doubled += usize::from(runs(&profile) > 1);
        let total: f64 = profile.iter().map(|(_, value)| value).sum();
        if total * STEP_PX < 0.25 {
            outline.open += 1;
            drawn.push(out * at);
            continue;
        }
        let drawn_at = profile.iter().map(|(at, value)| at * value).sum::<f64>() / total;
        drawn.push(out * drawn_at);
        let off = (drawn_at - at).abs();
        outline.off_px = outline.off_px.max(off);
        outline.rms_px += off * off / count as f64;
        outline.width_off_px = outline.width_off_px.max((total * STEP_PX - width).abs());
    }
    outline.rms_px = outline.rms_px.sqrt();
    let step = TURN_PX as usize;
    for i in 0..count {
        let turn = |points: &[DVec2]| {
            let at = |j: usize| points[(i + j * step) % count];
            (at(1) - at(0)).angle_to(at(2) - at(1)).to_degrees()
        };
        outline.turn_deg = outline.turn_deg.max((turn(&drawn) - turn(&expected)).abs());
    }
    outline
}

/// Where a ray from the origin meets the curve, farthest out.
fn crossing(contour: &[[DVec2; 2]], out: DVec2) -> Option<f64> {
    let hits = contour.iter().filter_map(|[a, b]| {
        let side = [out.perp_dot(*a), out.perp_dot(*b)];
        let meets = (side[0] >= -1e-9) != (side[1] >= -1e-9) && side[0] != side[1];
        let at = a.lerp(*b, side[0] / (side[0] - side[1])).dot(out);
        (meets && at > 0.0).then_some(at)
    });
    hits.reduce(f64::max)
}

/// Distances along a ray and the coverage there, round the expected one.
fn profile(ink: &Ink, center: DVec2, out: DVec2, at: f64) -> Vec<(f64, f64)> {
    let steps = (2.0 * REACH_PX / STEP_PX) as usize;
    let distances = (0..=steps).map(|i| at - REACH_PX + i as f64 * STEP_PX);
    distances
        .map(|distance| {
            let p = center + out * distance;
            (distance, ink.between(p.x, p.y))
        })
        .collect()
}

/// How many separate stretches of a profile are dark.
fn runs(profile: &[(f64, f64)]) -> usize {
    let mut runs = 0;
    let mut inside = false;
    for (_, value) in profile {
        if !inside && *value > 0.3 {
            runs += 1;
            inside = true;
        } else if inside && *value < 0.15 {
            inside = false;
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::capsules::union_of_capsules;
    use crate::scenes::ortho_view;

    /// A circle of radius `radius` in the plane z = 0.
    fn circle(radius: f64) -> Vec<Line> {
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * (i % 90) as f64 / 90.0;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        };
        let ends = (0..90).map(|i| [at(i), at(i + 1)]);
        let line = |ends| Line { ends, kind: Kind::Contour, faces: [0; 2], slack: 0.0, must: true };
        ends.map(line).collect()
    }

    fn drawn(circles: &[f64]) -> Outline {
        let eye = Eye::new(&ortho_view([160, 160], 2.0));
        let all: Vec<Line> = circles.iter().flat_map(|&radius| circle(radius)).collect();
        let segments: Vec<_> = all.iter().map(|line| line.ends.map(|p| eye.project(p))).collect();
        let ink = union_of_capsules(&segments, 3.0, [160, 160]);
        outline(&ink, &circle(0.75), &eye, DVec3::ZERO, 3.0)
    }

    #[test]
    fn a_true_outline_is_found_true_and_others_are_not() {
        let good = drawn(&[0.75]);
        assert!(good.off_px < 0.1 && good.width_off_px < 0.2 && good.turn_deg < 3.0, "{good:?}");
        assert_eq!((good.open, good.doubled), (0, 0));
        let shifted = drawn(&[0.7625]);
        assert!((shifted.off_px - 1.0).abs() < 0.1, "{shifted:?}");
        let doubled = drawn(&[0.75, 0.69]);
        assert_eq!(doubled.doubled, doubled.rays, "{doubled:?}");
        assert_eq!(drawn(&[]).open, good.rays);
    }
}
