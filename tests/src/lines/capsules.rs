//! Strokes drawn on the CPU: unions of round-ended segments.

use glam::DVec2;

use super::ink::Ink;
use crate::reference::distance_to_segment;

/// Coverage of segments `width` pixels wide with round ends: for each pixel the largest of
/// `clamp(0.5 − d, 0, 1)`, where d is the distance of its middle from the outline of a segment,
/// negative inside.
#[must_use]
pub fn union_of_capsules(segments: &[[DVec2; 2]], width: f64, size: [u32; 2]) -> Ink {
    let mut values = vec![0; (size[0] * size[1]) as usize];
    let reach = 0.5 * width + 1.0;
    for &segment in segments {
        let (low, high) = (segment[0].min(segment[1]) - reach, segment[0].max(segment[1]) + reach);
        let range = |low: f64, high: f64, size: u32| {
            low.clamp(0.0, f64::from(size)) as u32..high.ceil().clamp(0.0, f64::from(size)) as u32
        };
        for y in range(low.y, high.y, size[1]) {
            for x in range(low.x, high.x, size[0]) {
                let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let d = distance_to_segment(p, segment) - 0.5 * width;
                let coverage = ((0.5 - d).clamp(0.0, 1.0) * 255.0).round() as u8;
                let value = &mut values[(y * size[0] + x) as usize];
                *value = coverage.max(*value);
            }
        }
    }
    Ink { width: size[0], height: size[1], values }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capsule_has_its_area() {
        let segment = [DVec2::new(20.3, 30.7), DVec2::new(70.1, 55.2)];
        let ink = union_of_capsules(&[segment], 6.0, [96, 96]);
        let area: f64 = ink.values.iter().map(|&v| f64::from(v) / 255.0).sum();
        let length = (segment[1] - segment[0]).length();
        let expected = 6.0 * length + std::f64::consts::PI * 9.0;
        assert!((area - expected).abs() < 0.01 * expected, "{area}, not {expected}");
        // Twice the same segment is the same ink.
        assert_eq!(union_of_capsules(&[segment, segment], 6.0, [96, 96]), ink);
    }
}
