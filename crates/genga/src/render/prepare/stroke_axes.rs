//! The axes across hatching strokes.

use glam::Vec3;

/// The axes that strokes are cut out by, as `shaders/shading/hatch_surface.wesl` has them: whole numbers
/// up to 2, of length 1, one of two opposite ones.
fn axes() -> impl Iterator<Item = Vec3> {
    let triple = |i: i32| [i / 25 - 2, i / 5 % 5 - 2, i % 5 - 2];
    let is_axis = |v: &[i32; 3]| v.iter().any(|x| x % 2 != 0) && *v > [0; 3];
    let unit = |v: [i32; 3]| Vec3::from(v.map(|x| x as f32)).normalize();
    (0..125).map(triple).filter(is_axis).map(unit)
}

/// By how much the best axis has to be nearer than the second one for strokes of the best alone.
pub(super) const LEAD: f32 = 0.011;

/// The direction next to a wanted one whose strokes are all of one axis: on a flat part they would
/// be of two everywhere, if the wanted one happened to lie between both.
pub(super) fn between_borders(wanted: Vec3, n: Vec3) -> Vec3 {
    let across = n.cross(wanted);
    let snapped = axes().filter_map(|axis| (axis - n * n.dot(axis)).try_normalize());
    let best = [across]
        .into_iter()
        .chain(snapped)
        .filter(|across| lead(*across) > LEAD)
        .max_by(|a, b| a.dot(across).abs().total_cmp(&b.dot(across).abs()));
    best.map_or(wanted, |across| across.cross(n))
}

/// By how much the nearest axis is nearer than the second one.
pub(super) fn lead(across: Vec3) -> f32 {
    let [mut first, mut second] = [0.0_f32; 2];
    for axis in axes() {
        let nearness = axis.dot(across).abs();
        second = second.max(nearness.min(first));
        first = first.max(nearness);
    }
    first - second
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_those_of_the_shader() {
        let all: Vec<Vec3> = axes().collect();
        assert_eq!(all.len(), 49);
        for (i, a) in all.iter().enumerate() {
            assert!(all[..i].iter().all(|b| a.dot(*b).abs() < 0.999), "{a}");
        }
    }
}
