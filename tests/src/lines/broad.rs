//! Where on a picture parts are broad: lines between narrower ones cannot be told apart by a
//! small detection.

use std::collections::HashMap;

use glam::{DVec2, I64Vec2};

use super::figures::Sight;
use super::ink::Ink;
use super::places::Seen;

/// Places this near are on the same line, in pixels.
const SAME_PX: f64 = 0.75;
/// Cosine of the angle from straight across within which another line bounds the same part.
const ACROSS: f64 = 0.8;

/// Pixels within `reach` of visible lines that have no other visible line within `least_px` to
/// either side.
#[must_use]
pub fn broad_lines(sight: &Sight, size: [u32; 2], least_px: f64, reach: f64) -> Vec<bool> {
    let cell = |p: DVec2| (p / least_px).floor().as_i64vec2();
    let mut cells: HashMap<I64Vec2, Vec<DVec2>> = HashMap::new();
    let visible = || sight.places.iter().filter(|place| place.seen != Seen::Not);
    for place in visible() {
        cells.entry(cell(place.p_px)).or_default().push(place.p_px);
    }
    let mut is_broad = vec![true; (size[0] * size[1]) as usize];
    let mut is_line = vec![false; is_broad.len()];
    for place in visible() {
        let ends = sight.lines[place.line].ends.map(|end| sight.eye.project(end));
        let across = (ends[1] - ends[0]).normalize_or(DVec2::X).perp();
        let middle = cell(place.p_px);
        let around = (-1..=1).flat_map(|y| (-1..=1).map(move |x| I64Vec2::new(x, y)));
        let is_narrow = around.filter_map(|step| cells.get(&(middle + step))).flatten().any(|q| {
            let apart = *q - place.p_px;
            let distance = apart.length();
            (SAME_PX..least_px).contains(&distance) && apart.dot(across).abs() > ACROSS * distance
        });
        mark(&mut is_line, size, place.p_px, reach, true);
        if is_narrow {
            mark(&mut is_broad, size, place.p_px, least_px, false);
        }
    }
    is_line.iter().zip(is_broad).map(|(line, broad)| *line && broad).collect()
}

fn mark(pixels: &mut [bool], size: [u32; 2], p: DVec2, reach: f64, value: bool) {
    let range = |at: f64, size: u32| {
        (at - reach - 0.5).clamp(0.0, f64::from(size)) as u32
            ..(at + reach + 1.0).clamp(0.0, f64::from(size)) as u32
    };
    for y in range(p.y, size[1]) {
        for x in range(p.x, size[0]) {
            let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            if (middle - p).length() <= reach {
                pixels[(y * size[0] + x) as usize] = value;
            }
        }
    }
}

/// Pixels of `among` that have a line in one picture and none in the other, and those that have
/// one in `whole`.
#[must_use]
pub fn differing(whole: &Ink, other: &Ink, among: &[bool]) -> (usize, usize) {
    let pairs = whole.values.iter().zip(&other.values).zip(among).filter(|(_, among)| **among);
    let (mut differ, mut inked) = (0, 0);
    for ((a, b), _) in pairs {
        inked += usize::from(*a >= 128);
        differ += usize::from(a.abs_diff(*b) >= 128);
    }
    (differ, inked)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::{Builder, moved, ortho_view};
    use genga::scene::Pose;
    use genga::shapes;
    use glam::Vec2;

    #[test]
    fn narrow_bars_are_not_broad_and_wide_ones_are() {
        let mut scene = Builder::new();
        for (x, width) in [(-0.5, 0.06), (0.5, 0.3)] {
            let bar = shapes::plane(Vec2::new(width, 1.2));
            scene.object("bar", bar, None, moved(x, 0.0, 0.0));
        }
        let scene = scene.build();
        // 64 pixels for 2 m: bars of 1.9 and 9.6 pixels.
        let view = ortho_view([64, 64], 2.0);
        let sight = Sight::new(&scene, &Pose::rest(&scene), &view);
        let broad = broad_lines(&sight, [64, 64], 6.0, 1.0);
        let row = |x: u32| broad[32 * 64 + x as usize];
        assert!((0..32).all(|x| !row(x)), "the thin bar");
        assert!(row(43) && row(52), "both sides of the wide one");
        assert!(!row(47) && !row(60));
    }
}
