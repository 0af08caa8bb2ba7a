use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};

use crate::Shape;

/// A box round the origin with flat faces: 24 vertices, each face with the whole picture on it.
///
/// `size` is the full length along each axis in metres.
#[must_use]
pub fn cuboid(size: Vec3) -> Shape {
    let faces = [
        (Vec3::X, Vec3::NEG_Z, Vec3::Y),
        (Vec3::NEG_X, Vec3::Z, Vec3::Y),
        (Vec3::Y, Vec3::X, Vec3::NEG_Z),
        (Vec3::NEG_Y, Vec3::X, Vec3::Z),
        (Vec3::Z, Vec3::X, Vec3::Y),
        (Vec3::NEG_Z, Vec3::NEG_X, Vec3::Y),
    ];
    let mut shape = Shape::default();
    for (normal, right, up) in faces {
        push_rectangle(&mut shape, normal, [normal, right, up].map(|axis| axis * size / 2.0));
    }
    shape
}

/// A standing rectangle in the plane z = 0, facing +Z, with its middle at the origin.
///
/// `size` is its width and height in metres.
#[must_use]
pub fn plane(size: Vec2) -> Shape {
    let mut shape = Shape::default();
    let half = size / 2.0;
    push_rectangle(&mut shape, Vec3::Z, [Vec3::ZERO, Vec3::X * half.x, Vec3::Y * half.y]);
    shape
}

fn push_rectangle(shape: &mut Shape, normal: Vec3, [middle, right, up]: [Vec3; 3]) {
    let first = shape.positions.len() as u32;
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        // Adding zero turns −0 into 0.
        shape.positions.push(middle + right * x + up * y + Vec3::ZERO);
        shape.normals.push(normal + Vec3::ZERO);
        shape.uvs.push(Vec2::new((x + 1.0) / 2.0, (1.0 - y) / 2.0));
    }
    shape.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
}

/// A ball of meridians and parallels round the origin, poles on the Y axis.
///
/// The texture runs once round it, its seam at −Z, where vertices stand twice at exactly
/// the same place. `segments` (round the axis) is kept within [3, 4096], `rings` (pole to pole)
/// within [2, 4096]. It has `2 · segments · (rings − 1)` triangles.
#[must_use]
pub fn uv_sphere(segments: u32, rings: u32, radius: f32) -> Shape {
    let (segments, rings) = (segments.clamp(3, 4096), rings.clamp(2, 4096));
    let mut shape = Shape::default();
    for ring in 0..=rings {
        let v = f64::from(ring) / f64::from(rings);
        let (sin, cos) = match ring {
            0 => (0.0, 1.0),
            _ if ring == rings => (0.0, -1.0),
            _ => libm::sincos(PI * v),
        };
        // A pole has one vertex for each segment, which lies over that segment's middle.
        let at_pole = ring == 0 || ring == rings;
        let (columns, shift) = if at_pole { (segments, 0.5) } else { (segments + 1, 0.0) };
        for column in 0..columns {
            let turns = f64::from(column % segments) / f64::from(segments);
            let (east, north) = libm::sincos(TAU * turns);
            let normal = DVec3::new(-sin * east, cos, -sin * north) + DVec3::ZERO;
            shape.push(normal * f64::from(radius), normal);
            let u = (f64::from(column) + shift) / f64::from(segments);
            shape.uvs.push(Vec2::new(u as f32, v as f32));
        }
    }
    for ring in 0..rings {
        for column in 0..segments {
            let upper = if ring == 0 { 0 } else { ring * (segments + 1) - 1 } + column;
            let lower = (ring + 1) * (segments + 1) - 1 + column;
            if ring > 0 {
                let below = if ring + 1 == rings { lower } else { lower + 1 };
                shape.indices.extend([upper, below, upper + 1]);
            }
            if ring + 1 < rings {
                shape.indices.extend([upper, lower, lower + 1]);
            }
        }
    }
    shape
}

/// A bar round the Y axis with flat ends, its middle at the origin.
///
/// Its side is smooth, its ends have vertices of their own and so sharp rims. `segments` is kept
/// within [3, 4096]; `radius` and `height` are in metres. It has `4 · segments − 4` triangles.
/// The texture runs once round the side, its seam at −Z; the ends show its upper left corner.
#[must_use]
pub fn cylinder(segments: u32, radius: f32, height: f32) -> Shape {
    let segments = segments.clamp(3, 4096);
    let (radius, half) = (f64::from(radius), 0.5 * f64::from(height));
    let mut shape = Shape::default();
    let around = |column: u32| {
        let turns = f64::from(column % segments) / f64::from(segments);
        let (east, north) = libm::sincos(TAU * turns);
        DVec3::new(-east, 0.0, -north) + DVec3::ZERO
    };
    for column in 0..=segments {
        let out = around(column);
        let u = (f64::from(column) / f64::from(segments)) as f32;
        for (y, v) in [(half, 0.0), (-half, 1.0)] {
            shape.push(out * radius + DVec3::Y * y, out);
            shape.uvs.push(Vec2::new(u, v));
        }
    }
    for column in 0..segments {
        let top = 2 * column;
        shape.indices.extend([top, top + 1, top + 3, top, top + 3, top + 2]);
    }
    for side in [1.0, -1.0] {
        let first = shape.positions.len() as u32;
        for column in 0..segments {
            shape.push(around(column) * radius + DVec3::Y * (side * half), DVec3::Y * side);
            shape.uvs.push(Vec2::ZERO);
        }
        for i in 1..segments - 1 {
            let [a, b] = if side > 0.0 { [i, i + 1] } else { [i + 1, i] };
            shape.indices.extend([first, first + a, first + b]);
        }
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::assert_closed_and_outward;

    #[test]
    fn a_cuboid_is_closed_and_has_its_size() {
        let shape = cuboid(Vec3::new(1.0, 2.0, 3.0));
        assert_closed_and_outward(&shape);
        assert_eq!((shape.positions.len(), shape.triangle_count()), (24, 12));
        assert!((shape.signed_volume() - 6.0).abs() < 1e-6);
    }

    #[test]
    fn a_plane_faces_forward() {
        let shape = plane(Vec2::new(4.0, 2.0));
        let [a, b, c] = [0, 1, 2].map(|i| shape.positions[shape.indices[i] as usize]);
        assert_eq!((b - a).cross(c - a).normalize(), Vec3::Z);
        assert_eq!(shape.positions[2], Vec3::new(2.0, 1.0, 0.0));
        assert_eq!(shape.uvs[2], Vec2::new(1.0, 0.0));
    }

    #[test]
    fn spheres_are_closed_and_nearly_round() {
        for (segments, rings) in [(3, 2), (4, 3), (48, 24)] {
            let shape = uv_sphere(segments, rings, 0.5);
            assert_closed_and_outward(&shape);
            assert_eq!(shape.triangle_count() as u32, 2 * segments * (rings - 1));
            for (position, normal) in shape.positions.iter().zip(&shape.normals) {
                assert!((*position - *normal * 0.5).length() < 1e-6);
            }
        }
        let full = 4.0 / 3.0 * PI;
        assert!((uv_sphere(96, 48, 1.0).signed_volume() / full - 1.0).abs() < 0.005);
    }

    #[test]
    fn a_cylinder_is_closed_and_has_its_size() {
        for segments in [3, 48] {
            let shape = cylinder(segments, 0.5, 2.0);
            assert_closed_and_outward(&shape);
            assert_eq!(shape.triangle_count() as u32, 4 * segments - 4);
            let angle = TAU / f64::from(segments);
            let base = 0.5 * f64::from(segments) * 0.25 * angle.sin();
            assert!((shape.signed_volume() - 2.0 * base).abs() < 1e-6);
        }
    }

    #[test]
    fn texture_coordinates_run_to_the_right_seen_from_outside() {
        let shape = uv_sphere(16, 8, 1.0);
        for t in shape.indices.chunks_exact(3) {
            let [a, b, c] = [t[0], t[1], t[2]].map(|i| shape.uvs[i as usize]);
            // v points down, so counter-clockwise on the surface is clockwise in (u, v).
            assert!((b - a).perp_dot(c - a) < 0.0);
        }
    }
}
