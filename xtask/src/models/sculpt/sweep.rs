//! Surfaces by formula: tubes along curves, lathed forms, and cloth.

use glam::{DVec2, DVec3};

/// Triangles of one material.
#[derive(Clone, Default)]
pub(in crate::models) struct Part {
    pub(in crate::models) positions: Vec<DVec3>,
    pub(in crate::models) normals: Vec<DVec3>,
    pub(in crate::models) uvs: Vec<DVec2>,
    pub(in crate::models) indices: Vec<u32>,
    /// For a part cut from a mesh, the mesh's vertex that each vertex comes from.
    pub(in crate::models) sources: Vec<u32>,
}

impl Part {
    pub(in crate::models) fn push(&mut self, position: DVec3, normal: DVec3) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.positions.len() as u32 - 1
    }

    /// Adds another part's triangles.
    pub(in crate::models) fn append(&mut self, other: &Part) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.uvs.extend(&other.uvs);
        self.indices.extend(other.indices.iter().map(|i| i + first));
    }

    /// Adds a grid of quads over `rows` of equally many points, wound so that rows × columns
    /// points outwards; normals by the surface itself, sharp to whatever else there is.
    pub(in crate::models) fn grid(&mut self, rows: &[Vec<DVec3>], closed: bool) {
        let columns = rows[0].len();
        let first = self.positions.len() as u32;
        let count = rows.len();
        let at = |r: usize, c: usize| rows[r][c];
        for r in 0..count {
            for c in 0..columns {
                // A closed grid repeats its first column as its last one.
                let (before, after) = if closed && (c == 0 || c == columns - 1) {
                    (columns - 2, 1)
                } else {
                    (c.saturating_sub(1), (c + 1).min(columns - 1))
                };
                let across = at(r, after) - at(r, before);
                let along = at((r + 1).min(count - 1), c) - at(r.saturating_sub(1), c);
                let mut normal = along.cross(across);
                if normal.length() < 1e-14 {
                    // At a pole the neighbours along tell.
                    let inner = if r == 0 { 1 } else { count - 2 };
                    let across = at(inner, after) - at(inner, before);
                    normal = along.cross(across);
                }
                self.push(at(r, c), normal.normalize_or_zero());
                self.uvs.push(DVec2::new(
                    c as f64 / (columns - 1) as f64,
                    r as f64 / (count - 1) as f64,
                ));
            }
        }
        // Where a row or column shrinks to a point, its nearest neighbours' normal serves.
        let known: Vec<DVec3> = self.normals[first as usize..].to_vec();
        for (i, normal) in self.normals[first as usize..].iter_mut().enumerate() {
            if *normal == DVec3::ZERO {
                let (row, column) = (i / columns, i % columns);
                let in_row = (0..columns).map(|c| (c.abs_diff(column), row * columns + c));
                let in_column = (0..count).map(|r| (r.abs_diff(row), r * columns + column));
                let near = in_row.chain(in_column).filter(|&(_, k)| known[k] != DVec3::ZERO);
                *normal = near.min().map_or(DVec3::Y, |(_, k)| known[k]);
            }
        }
        let index = |r: usize, c: usize| first + (r * columns + c) as u32;
        for r in 0..count - 1 {
            for c in 0..columns - 1 {
                let [a, b, d, e] =
                    [index(r, c), index(r, c + 1), index(r + 1, c), index(r + 1, c + 1)];
                let p = |i: u32| self.positions[i as usize];
                let mut triangle = |i: u32, j: u32, k: u32| {
                    let area = (p(j) - p(i)).cross(p(k) - p(i)).length();
                    if area > 1e-12 {
                        self.indices.extend([i, j, k]);
                    }
                };
                triangle(a, d, b);
                triangle(b, d, e);
            }
        }
    }
}

/// Thin cloth, closed: the rows of a sheet, its front where along × across points, thickened by
/// so many metres, with a hem all round.
pub(in crate::models) fn sheet(rows: &[Vec<DVec3>], thickness: f64) -> Part {
    let mut front = Part::default();
    front.grid(rows, false);
    let columns = rows[0].len();
    thickened(rows, false, &|r, c| rows[r][c] - front.normals[r * columns + c] * thickness)
}

/// A closed plate: the rows of its front, moved by `depth` for its back. The rows of a `round` one
/// are rings, from a point in the middle outwards.
pub(in crate::models) fn plate(rows: &[Vec<DVec3>], round: bool, depth: DVec3) -> Part {
    thickened(rows, round, &|r, c| rows[r][c] + depth)
}

/// Front, back and the hem between them.
fn thickened(rows: &[Vec<DVec3>], round: bool, behind: &dyn Fn(usize, usize) -> DVec3) -> Part {
    let (last, columns) = (rows.len() - 1, rows[0].len());
    // Columns run the other way, so that the back faces backwards.
    let back_row = |r: usize| (0..columns).rev().map(|c| behind(r, c)).collect();
    // Nobody sees the back of a round one: its middle and its rim do.
    let back: Vec<Vec<DVec3>> =
        (0..=last).step_by(if round { last } else { 1 }).map(back_row).collect();
    let mut part = Part::default();
    part.grid(rows, round);
    part.grid(&back, round);
    let mut hem = |ring: Vec<(usize, usize)>| {
        let rows: Vec<Vec<DVec3>> =
            ring.iter().map(|&(r, c)| vec![behind(r, c), rows[r][c]]).collect();
        part.grid(&rows, false);
    };
    hem((0..columns).map(|c| (last, c)).collect());
    if !round {
        hem((0..columns).rev().map(|c| (0, c)).collect());
        hem((0..=last).map(|r| (r, 0)).collect());
        hem((0..=last).rev().map(|r| (r, columns - 1)).collect());
    }
    part
}

/// A form of revolution about +Z through the origin. Each run of (radius, height) is smooth; runs
/// meet at sharp edges. Runs go outwards seen from +Z, or back inwards behind.
pub(in crate::models) fn lathe(runs: &[&[(f64, f64)]], steps: usize) -> Part {
    let mut part = Part::default();
    for run in runs {
        let rows: Vec<Vec<DVec3>> = run
            .iter()
            .map(|&(radius, height)| {
                let point = |i: usize| {
                    // The last column is the first one, exactly.
                    let angle = std::f64::consts::TAU * (i % steps) as f64 / steps as f64;
                    DVec3::new(radius * libm::cos(angle), radius * libm::sin(angle), height)
                };
                (0..=steps).map(point).collect()
            })
            .collect();
        part.grid(&rows, true);
    }
    part
}
