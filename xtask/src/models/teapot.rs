//! The teapot that Martin Newell modelled in 1975 as 32 bicubic Bézier patches, from its
//! published control points (in the later form with a bottom).
//!
//! Rim, body, lid and bottom are quarters of a surface of revolution, whose circle the teapot
//! approximates by control points at 0.56 of the radius; handle and spout are halves, mirrored.
//! So a profile or a half tube says all of it.

use genga_shapes::Shape;
use glam::DVec3;

/// Pieces of each patch along both of its sides.
const PIECES: usize = 10;
/// Metres in one of Newell's units: a teapot about 65 cm from handle to spout.
const METRES: f64 = 0.1;
/// How far a quarter circle's inner control points lie from its ends, in radii.
const QUARTER: f64 = 0.56;

/// The teapot's four parts, its bottom at y = 0, its axis x = z = 0, its spout towards +X.
pub(super) struct Teapot {
    pub(super) body: Shape,
    pub(super) lid: Shape,
    pub(super) handle: Shape,
    pub(super) spout: Shape,
}

impl Teapot {
    pub(super) fn new() -> Self {
        Self {
            body: grid(&BODY.map(revolved)),
            lid: grid(&LID.map(revolved)),
            handle: grid(&HANDLE.map(mirrored)),
            spout: grid(&SPOUT.map(mirrored)),
        }
    }
}

/// (radius, height) from the inside of the rim, outwards, down and to the middle below.
const BODY: [[(f64, f64); 4]; 4] = [
    [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)],
    [(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)],
    [(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)],
    [(1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)],
];

/// (radius, height) from the knob's top to the lid's lower edge.
const LID: [[(f64, f64); 4]; 2] = [
    [(0.0, 3.15), (0.8, 3.15), (0.0, 2.85), (0.2, 2.7)],
    [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)],
];

/// Rows (along the tube) of half rings, each (x, sideways, height).
type HalfTube = [[(f64, f64, f64); 4]; 4];

/// From the upper end to the lower.
const HANDLE: [HalfTube; 2] = [
    [
        [(-1.6, 0.0, 2.025), (-1.6, 0.3, 2.025), (-1.5, 0.3, 2.25), (-1.5, 0.0, 2.25)],
        [(-2.3, 0.0, 2.025), (-2.3, 0.3, 2.025), (-2.5, 0.3, 2.25), (-2.5, 0.0, 2.25)],
        [(-2.7, 0.0, 2.025), (-2.7, 0.3, 2.025), (-3.0, 0.3, 2.25), (-3.0, 0.0, 2.25)],
        [(-2.7, 0.0, 1.8), (-2.7, 0.3, 1.8), (-3.0, 0.3, 1.8), (-3.0, 0.0, 1.8)],
    ],
    [
        [(-2.7, 0.0, 1.8), (-2.7, 0.3, 1.8), (-3.0, 0.3, 1.8), (-3.0, 0.0, 1.8)],
        [(-2.7, 0.0, 1.575), (-2.7, 0.3, 1.575), (-3.0, 0.3, 1.35), (-3.0, 0.0, 1.35)],
        [(-2.5, 0.0, 1.125), (-2.5, 0.3, 1.125), (-2.65, 0.3, 0.9375), (-2.65, 0.0, 0.9375)],
        [(-2.0, 0.0, 0.9), (-2.0, 0.3, 0.9), (-1.9, 0.3, 0.6), (-1.9, 0.0, 0.6)],
    ],
];

/// From the body outwards and, at the mouth, inwards again.
const SPOUT: [HalfTube; 2] = [
    [
        [(1.7, 0.0, 1.425), (1.7, 0.66, 1.425), (1.7, 0.66, 0.6), (1.7, 0.0, 0.6)],
        [(2.6, 0.0, 1.425), (2.6, 0.66, 1.425), (3.1, 0.66, 0.825), (3.1, 0.0, 0.825)],
        [(2.3, 0.0, 2.1), (2.3, 0.25, 2.1), (2.4, 0.25, 2.025), (2.4, 0.0, 2.025)],
        [(2.7, 0.0, 2.4), (2.7, 0.25, 2.4), (3.3, 0.25, 2.4), (3.3, 0.0, 2.4)],
    ],
    [
        [(2.7, 0.0, 2.4), (2.7, 0.25, 2.4), (3.3, 0.25, 2.4), (3.3, 0.0, 2.4)],
        [(2.8, 0.0, 2.475), (2.8, 0.25, 2.475), (3.525, 0.25, 2.49375), (3.525, 0.0, 2.49375)],
        [(2.9, 0.0, 2.475), (2.9, 0.15, 2.475), (3.45, 0.15, 2.5125), (3.45, 0.0, 2.5125)],
        [(2.8, 0.0, 2.4), (2.8, 0.15, 2.4), (3.2, 0.15, 2.4), (3.2, 0.0, 2.4)],
    ],
];

/// Control points, `[v][u]`: u runs round the part, v along it, and `∂u × ∂v` points outwards.
type Patch = [[DVec3; 4]; 4];

/// The four quarters of a surface of revolution.
fn revolved(profile: [(f64, f64); 4]) -> Vec<Patch> {
    let quarter = profile.map(|(r, y)| {
        let inner = QUARTER * r;
        [(r, 0.0), (r, inner), (inner, r), (0.0, r)].map(|(x, z)| DVec3::new(x, y, z))
    });
    let turned = |p: DVec3| DVec3::new(-p.z, p.y, p.x);
    let next = |patch: &Patch| Some(patch.map(|row| row.map(turned)));
    std::iter::successors(Some(quarter), next).take(4).collect()
}

/// A half tube and its mirror image, which runs back on the other side.
fn mirrored(half: HalfTube) -> Vec<Patch> {
    let near = half.map(|row| row.map(|(x, sideways, y)| DVec3::new(x, y, sideways)));
    let far = near.map(|row| [row[3], row[2], row[1], row[0]].map(|p| DVec3::new(p.x, p.y, -p.z)));
    vec![near, far]
}

/// One mesh of bands that follow each other, each a closed round of patches. All vertices are
/// shared: where patches meet, the surface and its normal are continuous.
fn grid(bands: &[Vec<Patch>]) -> Shape {
    let mut shape = Shape::default();
    let mut above: Option<Vec<u32>> = None;
    for (band_index, band) in bands.iter().enumerate() {
        let first_row = usize::from(band_index > 0);
        for row in first_row..=PIECES {
            let v = row as f64 / PIECES as f64;
            let mut ring: Vec<u32> = Vec::new();
            for patch in band {
                for column in 0..PIECES {
                    let (point, normal) = evaluate(patch, column as f64 / PIECES as f64, v);
                    ring.push(shape.positions.len() as u32);
                    shape.positions.push((point * METRES).as_vec3());
                    shape.normals.push(normal.as_vec3());
                    if is_pole(patch, row) {
                        break;
                    }
                }
                if is_pole(patch, row) {
                    break;
                }
            }
            if let Some(above) = above {
                connect(&mut shape.indices, &above, &ring);
            }
            above = Some(ring);
        }
    }
    shape
}

/// Whether a patch's first or last row is a single point.
fn is_pole(patch: &Patch, row: usize) -> bool {
    let controls = if row == 0 { patch[0] } else { patch[3] };
    (row == 0 || row == PIECES) && controls.iter().all(|&point| point == controls[0])
}

/// Triangles between two rings of the same size, one of which may be a pole.
fn connect(indices: &mut Vec<u32>, above: &[u32], below: &[u32]) {
    let count = above.len().max(below.len());
    for i in 0..count {
        let j = (i + 1) % count;
        let at = |ring: &[u32], i: usize| ring[i % ring.len()];
        if above.len() > 1 {
            indices.extend([at(above, i), at(above, j), at(below, j)]);
        }
        if below.len() > 1 {
            indices.extend([at(above, i), at(below, j), at(below, i)]);
        }
    }
}

/// The patch's point and unit normal at (u, v).
fn evaluate(patch: &Patch, u: f64, v: f64) -> (DVec3, DVec3) {
    let sum = |along_u: [f64; 4], along_v: [f64; 4]| -> DVec3 {
        let row = |i: usize| -> DVec3 { (0..4).map(|j| patch[i][j] * along_u[j]).sum() };
        (0..4).map(|i| row(i) * along_v[i]).sum()
    };
    let (bu, bv, du, dv) = (bernstein(u), bernstein(v), slopes(u), slopes(v));
    let mut by_u = sum(du, bv);
    if by_u.length_squared() < 1e-18 {
        // At a pole ∂u vanishes; its direction is that of ∂u a little inside the patch.
        by_u = sum(du, dv) * if v < 0.5 { 1.0 } else { -1.0 };
    }
    (sum(bu, bv), by_u.cross(sum(bu, dv)).normalize_or_zero())
}

/// The cubic Bernstein polynomials.
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t]
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::Vec3;

    use super::*;

    /// Edges used by one face only, after checking that the others are used once each way.
    fn border_edges(shape: &Shape) -> usize {
        let mut uses: HashMap<(u32, u32), [u32; 2]> = HashMap::new();
        for t in shape.indices.chunks_exact(3) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                assert_ne!(a, b);
                uses.entry((a.min(b), a.max(b))).or_default()[usize::from(a < b)] += 1;
            }
        }
        assert!(uses.values().all(|&[back, forth]| back <= 1 && forth <= 1));
        uses.values().filter(|&&[back, forth]| back + forth == 1).count()
    }

    fn parts() -> [(&'static str, Shape, usize); 4] {
        let Teapot { body, lid, handle, spout } = Teapot::new();
        let (round, half_round) = (4 * PIECES, 2 * PIECES);
        [
            ("body", body, round),
            ("lid", lid, round),
            ("handle", handle, 2 * half_round),
            ("spout", spout, 2 * half_round),
        ]
    }

    #[test]
    fn only_the_teapots_own_openings_are_open() {
        for (name, shape, open) in parts() {
            assert_eq!(border_edges(&shape), open, "{name}");
        }
    }

    #[test]
    fn normals_are_unit_and_agree_with_faces_that_have_area() {
        for (name, shape, _) in parts() {
            for t in shape.indices.chunks_exact(3) {
                let [a, b, c] = [t[0], t[1], t[2]].map(|i| shape.positions[i as usize].as_dvec3());
                let face = (b - a).cross(c - a);
                assert!(face.length() > 1e-7, "{name}: {t:?} has area {}", face.length());
                for &i in t {
                    let normal = shape.normals[i as usize].as_dvec3();
                    assert!((normal.length() - 1.0).abs() < 1e-6, "{name}: normal {i}");
                    // The tip of the spout's lip is by far the tightest bend.
                    assert!(normal.dot(face.normalize()) > 0.35, "{name}: normal {i} {normal}");
                }
            }
        }
    }

    #[test]
    fn outermost_points_face_outwards() {
        for (name, shape, _) in parts() {
            for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::Z, Vec3::NEG_Z] {
                let along = |&i: &usize| shape.positions[i].dot(axis);
                let far = (0..shape.positions.len()).max_by(|a, b| along(a).total_cmp(&along(b)));
                // The handle's open ends are sideways to it.
                let facing = shape.normals[far.unwrap()].dot(axis);
                assert!(facing > -1e-6, "{name} along {axis}: {facing}");
            }
        }
    }

    #[test]
    fn the_teapot_has_newells_size() {
        let Teapot { body, lid, handle, spout } = Teapot::new();
        let top = lid.positions.iter().map(|p| p.y).fold(0.0, f32::max);
        let bottom = body.positions.iter().map(|p| p.y).fold(1.0, f32::min);
        let left = handle.positions.iter().map(|p| p.x).fold(0.0, f32::min);
        let right = spout.positions.iter().map(|p| p.x).fold(0.0, f32::max);
        assert_eq!((top, bottom), (0.315, 0.0));
        assert!((-0.3..-0.28).contains(&left) && (0.33..0.3525).contains(&right));
    }
}
