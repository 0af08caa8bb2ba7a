use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::fmt;

use glam::DVec3;

use crate::Shape;

/// More would overflow 32-bit indices on the way.
const MOST_TRIANGLES: usize = 1 << 31;

/// A number of triangles or vertices that no closed object can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountError {
    /// The triangles asked for.
    Triangles(usize),
    /// The vertices asked for.
    Vertices(usize),
}

impl fmt::Display for CountError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangles(count) => write!(
                f,
                "a closed object cannot have {count} triangles: ask for an even number from 6 \
                 to {MOST_TRIANGLES}"
            ),
            Self::Vertices(count) => write!(
                f,
                "a closed object cannot have {count} vertices: ask for 5 to {}",
                MOST_TRIANGLES / 2 + 2
            ),
        }
    }
}

impl std::error::Error for CountError {}

/// A smooth, closed, bumpy object about 2 m across with exactly that many triangles.
///
/// It is a stack of rings between two poles. A band between rings of `a` and `b` vertices takes
/// `a + b` triangles and the cap on a ring of `a` takes `a`, so all of them together are twice
/// the rings' vertices, whatever the rings: 9,566 triangles are rings with 4,783 vertices (a
/// prime number, which no regular grid reaches). The rings' sizes follow the sine of the polar
/// angle, so triangles are alike all over. Vertices are shared throughout; there are
/// `triangles / 2 + 2` of them, and no texture coordinates, which would need a seam.
///
/// # Errors
/// An odd number (no closed surface has one), fewer than 6 or more than 2³¹.
pub fn smooth_object(triangles: usize) -> Result<Shape, CountError> {
    if !triangles.is_multiple_of(2) || !(6..=MOST_TRIANGLES).contains(&triangles) {
        return Err(CountError::Triangles(triangles));
    }
    Ok(stack_of_rings(&ring_sizes(triangles / 2)))
}

/// As [`smooth_object`], with exactly that many vertices and `2 · vertices − 4` triangles.
///
/// # Errors
/// Fewer than 5 vertices or more than 2³⁰ + 2.
pub fn smooth_object_with_vertices(vertices: usize) -> Result<Shape, CountError> {
    if !(5..=MOST_TRIANGLES / 2 + 2).contains(&vertices) {
        return Err(CountError::Vertices(vertices));
    }
    Ok(stack_of_rings(&ring_sizes(vertices - 2)))
}

/// Shares `total` ≥ 3 vertices among rings so that they stand about as far apart along a ring
/// as from ring to ring. Every ring gets at least 3.
fn ring_sizes(total: usize) -> Vec<u32> {
    // A sphere's n rings, π/(n + 1) apart, hold about Σ 2(n + 1) sin θ ≈ 4/π (n + 1)² vertices.
    let bands = ((total as f64 * FRAC_PI_4).sqrt().round() as usize).max(2);
    let weights: Vec<f64> =
        (1..bands).map(|ring| libm::sin(PI * ring as f64 / bands as f64)).collect();
    let sum: f64 = weights.iter().sum();
    // Rounding the running total, not each ring, keeps the sum exact.
    let (mut running, mut used) = (0.0, 0);
    let mut sizes = Vec::with_capacity(weights.len());
    for (i, weight) in weights.iter().enumerate() {
        running += weight;
        let last = i + 1 == weights.len();
        let end = if last { total } else { (total as f64 * running / sum).round() as usize };
        sizes.push((end - used) as u32);
        used = end;
    }
    sizes
}

fn stack_of_rings(sizes: &[u32]) -> Shape {
    let vertices = sizes.iter().map(|&size| size as usize).sum::<usize>() + 2;
    let mut shape = Shape {
        positions: Vec::with_capacity(vertices),
        normals: Vec::with_capacity(vertices),
        uvs: Vec::new(),
        indices: Vec::with_capacity(6 * (vertices - 2)),
    };
    push_on_object(&mut shape, DVec3::Y);
    let bands = sizes.len() + 1;
    for (ring, &size) in sizes.iter().enumerate() {
        let (sin, cos) = libm::sincos(PI * (ring + 1) as f64 / bands as f64);
        for i in 0..size {
            let (east, north) = libm::sincos(TAU * f64::from(i) / f64::from(size));
            push_on_object(&mut shape, DVec3::new(-sin * east, cos, -sin * north));
        }
    }
    let bottom = push_on_object(&mut shape, DVec3::NEG_Y);

    let mut first = 1;
    if let Some(&size) = sizes.first() {
        for i in 0..size {
            shape.indices.extend([0, first + i, first + (i + 1) % size]);
        }
    }
    for pair in sizes.windows(2) {
        stitch(&mut shape.indices, (first, pair[0]), (first + pair[0], pair[1]));
        first += pair[0];
    }
    if let Some(&size) = sizes.last() {
        for i in 0..size {
            shape.indices.extend([first + i, bottom, first + (i + 1) % size]);
        }
    }
    shape
}

/// Fills the band between two rings, each given by its first vertex and its size, by always
/// stepping on along the ring that is behind.
fn stitch(
    indices: &mut Vec<u32>,
    (upper, upper_size): (u32, u32),
    (lower, lower_size): (u32, u32),
) {
    let (mut i, mut j) = (0, 0);
    while i < upper_size || j < lower_size {
        let (a, b) = (upper + i % upper_size, lower + j % lower_size);
        // The fraction of the turn after the step: (i + 1)/upper_size against (j + 1)/lower_size.
        let upper_next = u64::from(i + 1) * u64::from(lower_size);
        let lower_next = u64::from(j + 1) * u64::from(upper_size);
        if upper_next < lower_next {
            i += 1;
            indices.extend([a, b, upper + i % upper_size]);
        } else {
            j += 1;
            indices.extend([a, b, lower + j % lower_size]);
        }
    }
}

/// Waves on the unit sphere: amplitude, wave vector, phase. Low and few, so that the object
/// stays smooth and star-shaped and still has contours inside its outline.
const WAVES: [(f64, DVec3, f64); 4] = [
    (0.10, DVec3::new(5.0, 1.0, 0.0), 0.3),
    (0.08, DVec3::new(0.0, 4.0, 3.0), 1.1),
    (0.07, DVec3::new(-3.0, 2.0, 6.0), 2.0),
    (0.05, DVec3::new(4.0, -7.0, 2.0), 0.7),
];

/// Adds the vertex in that direction: radius r = 1 + Σ a sin(k·d + φ), normal d − ∇ₜr / r with
/// the gradient's part ∇ₜr along the sphere.
fn push_on_object(shape: &mut Shape, direction: DVec3) -> u32 {
    let (mut radius, mut gradient) = (1.0, DVec3::ZERO);
    for (amplitude, wave, phase) in WAVES {
        let (sin, cos) = libm::sincos(wave.dot(direction) + phase);
        radius += amplitude * sin;
        gradient += amplitude * cos * wave;
    }
    let along_sphere = gradient - gradient.dot(direction) * direction;
    shape.push(direction * radius, direction - along_sphere / radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::assert_closed_and_outward;

    #[test]
    fn counts_are_exact() {
        for triangles in [6, 8, 10, 100, 960, 9_566, 66_400, 300_000] {
            let shape = smooth_object(triangles).unwrap();
            assert_eq!(shape.triangle_count(), triangles);
            assert_eq!(shape.positions.len(), triangles / 2 + 2);
            assert_eq!(shape.normals.len(), shape.positions.len());
        }
        assert_eq!(smooth_object_with_vertices(11_098).unwrap().positions.len(), 11_098);
        for triangles in [1_000_000, 10_000_000] {
            let sizes = ring_sizes(triangles / 2);
            assert_eq!(2 * sizes.iter().sum::<u32>() as usize, triangles);
            assert!(*sizes.iter().min().unwrap() >= 3);
        }
    }

    #[test]
    fn no_ring_is_too_small() {
        for total in 3..5_000 {
            let sizes = ring_sizes(total);
            assert!(*sizes.iter().min().unwrap() >= 3, "{total}: {sizes:?}");
            assert_eq!(sizes.iter().sum::<u32>() as usize, total);
        }
    }

    #[test]
    fn objects_are_closed_and_wound_outwards() {
        for triangles in [960, 9_566, 66_400] {
            assert_closed_and_outward(&smooth_object(triangles).unwrap());
        }
    }

    #[test]
    fn triangles_are_alike() {
        let shape = smooth_object(66_400).unwrap();
        let areas: Vec<f64> = shape
            .indices
            .chunks_exact(3)
            .map(|t| {
                let [a, b, c] = [t[0], t[1], t[2]].map(|i| shape.positions[i as usize].as_dvec3());
                (b - a).cross(c - a).length() / 2.0
            })
            .collect();
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        assert!(areas.iter().all(|area| (0.1 * mean..6.0 * mean).contains(area)));
    }

    #[test]
    fn normals_agree_with_the_faces() {
        let shape = smooth_object(66_400).unwrap();
        for t in shape.indices.chunks_exact(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| shape.positions[i as usize].as_dvec3());
            let face = (b - a).cross(c - a).normalize();
            for &i in t {
                assert!(shape.normals[i as usize].as_dvec3().dot(face) > 0.98);
            }
        }
    }

    #[test]
    fn impossible_counts_are_errors() {
        for triangles in [0, 4, 7, 9_567, usize::MAX] {
            assert_eq!(smooth_object(triangles), Err(CountError::Triangles(triangles)));
        }
        for vertices in [0, 4, usize::MAX] {
            assert_eq!(smooth_object_with_vertices(vertices), Err(CountError::Vertices(vertices)));
        }
    }
}
