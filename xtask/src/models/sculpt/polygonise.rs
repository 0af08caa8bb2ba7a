//! A first mesh of a field's surface, by marching tetrahedra: always closed and two-manifold.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

use super::field::Field;
use super::mesh::Mesh;

/// The six tetrahedra of a cube, all round the diagonal from corner 0 to corner 7. Bits of a
/// corner are its x, y and z.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// Meshes the zero surface of `field` between `least` and `most` on a grid of that cell size in
/// metres. The surface must lie wholly within.
pub(in crate::models) fn polygonise(
    field: &dyn Field,
    least: DVec3,
    most: DVec3,
    cell: f64,
) -> Mesh {
    const BLOCK: i32 = 16;
    let size = ((most - least) / (cell * f64::from(BLOCK))).ceil().as_ivec3();
    let mut march = March {
        field,
        least,
        cell,
        values: HashMap::new(),
        cuts: HashMap::new(),
        points: Vec::new(),
        corners: Vec::new(),
    };
    for z in 0..size.z {
        for y in 0..size.y {
            for x in 0..size.x {
                march.block(IVec3::new(x, y, z) * BLOCK, BLOCK);
            }
        }
    }
    Mesh::new(march.points, march.corners).expect("marching tetrahedra close every edge")
}

struct March<'a> {
    field: &'a dyn Field,
    least: DVec3,
    cell: f64,
    values: HashMap<IVec3, f64>,
    cuts: HashMap<(IVec3, IVec3), u32>,
    points: Vec<DVec3>,
    corners: Vec<u32>,
}

impl March<'_> {
    fn place(&self, at: IVec3) -> DVec3 {
        self.least + at.as_dvec3() * self.cell
    }

    /// Goes down into a block of cells unless the surface is too far off.
    fn block(&mut self, at: IVec3, size: i32) {
        if size == 1 {
            return self.cube(at);
        }
        let half = f64::from(size) * self.cell / 2.0;
        let distance = self.field.at(self.place(at) + DVec3::splat(half)).abs();
        // A cube's corner is √3 half sides off; blends and ellipsoids grow faster than distance.
        if distance > 3.0 * half {
            return;
        }
        let step = size / 2;
        for i in 0..8 {
            self.block(at + corner(i) * step, step);
        }
    }

    fn cube(&mut self, at: IVec3) {
        let mut values = [0.0; 8];
        for (i, value) in values.iter_mut().enumerate() {
            let place = at + corner(i);
            let world = self.place(place);
            *value = *self.values.entry(place).or_insert_with(|| self.field.at(world));
        }
        if values.iter().all(|&v| v < 0.0) || values.iter().all(|&v| v >= 0.0) {
            return;
        }
        for tetrahedron in TETRAHEDRA {
            let inside: Vec<usize> = tetrahedron.into_iter().filter(|&i| values[i] < 0.0).collect();
            let outside: Vec<usize> =
                tetrahedron.into_iter().filter(|&i| values[i] >= 0.0).collect();
            let mut cut = |i: usize, o: usize| self.cut(at, i, o, &values);
            let polygon = match (inside.as_slice(), outside.as_slice()) {
                (&[a], &[b, c, d]) => vec![cut(a, b), cut(a, c), cut(a, d)],
                (&[a, b, c], &[d]) => vec![cut(a, d), cut(b, d), cut(c, d)],
                (&[a, b], &[c, d]) => vec![cut(a, c), cut(a, d), cut(b, d), cut(b, c)],
                _ => continue,
            };
            // Wound so that the inside lies behind, which cuts in the middles tell exactly.
            let mean = |of: &[usize]| {
                let sum: DVec3 = of.iter().map(|&i| corner(i).as_dvec3()).sum();
                sum / of.len() as f64
            };
            let outward = mean(&outside) - mean(&inside);
            let middle = |i: usize, o: usize| (corner(i) + corner(o)).as_dvec3();
            let (p, q, r) = match (inside.as_slice(), outside.as_slice()) {
                (&[a], &[b, c, d]) => (middle(a, b), middle(a, c), middle(a, d)),
                (&[a, b, c], &[d]) => (middle(a, d), middle(b, d), middle(c, d)),
                (&[a, b], &[c, d]) => (middle(a, c), middle(a, d), middle(b, d)),
                _ => continue,
            };
            let forward = (q - p).cross(r - p).dot(outward) > 0.0;
            for k in 1..polygon.len() - 1 {
                let (b, c) = if forward { (k, k + 1) } else { (k + 1, k) };
                self.corners.extend([polygon[0], polygon[b], polygon[c]]);
            }
        }
    }

    /// The vertex between two corners of a cube.
    fn cut(&mut self, at: IVec3, inside: usize, outside: usize, values: &[f64; 8]) -> u32 {
        let (a, b) = (at + corner(inside), at + corner(outside));
        if let Some(&vertex) = self.cuts.get(&(a, b)) {
            return vertex;
        }
        // Not quite at the ends, where triangles would have no area.
        let t = (values[inside] / (values[inside] - values[outside])).clamp(0.03, 0.97);
        let vertex = self.points.len() as u32;
        self.points.push(self.place(a).lerp(self.place(b), t));
        self.cuts.insert((a, b), vertex);
        vertex
    }
}

fn corner(i: usize) -> IVec3 {
    IVec3::new((i & 1) as i32, (i >> 1 & 1) as i32, (i >> 2 & 1) as i32)
}
