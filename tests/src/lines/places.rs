//! Which parts of expected lines can be seen.

use std::collections::HashMap;

use genga::render::View;
use glam::{DVec2, DVec3};

use super::expected::Line;
use crate::eye::Eye;
use crate::reference::Triangle;

/// A place on an expected line, on the picture.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Pixels from the top left.
    pub p_px: DVec2,
    /// The place in the world.
    pub p: DVec3,
    /// Index of its line.
    pub line: usize,
    /// Length of line in pixels that it stands for.
    pub length_px: f64,
    /// Whether it can be seen for certain, cannot, or whether that is open.
    pub seen: Seen,
}

/// How much of a place can be seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Seen {
    /// Something hides it.
    Not,
    /// Whether it is drawn is open.
    Maybe,
    /// Nothing hides it.
    Wholly,
}

/// Distance between places in pixels.
pub const STEP_PX: f64 = 0.5;
/// Pixels along the sides of a cell of the grid.
const CELL: u32 = 16;

/// Triangles that can hide something, by the part of the picture where they are.
struct Grid<'a> {
    triangles: &'a [Triangle],
    eye: Eye,
    columns: u32,
    cells: Vec<Vec<u32>>,
    /// Triangles round each corner of each object.
    round_corner: HashMap<(usize, [u64; 3]), Vec<u32>>,
}

fn bits(p: DVec3) -> [u64; 3] {
    (p + DVec3::ZERO).to_array().map(f64::to_bits)
}

impl<'a> Grid<'a> {
    fn new(triangles: &'a [Triangle], view: &View) -> Self {
        let eye = Eye::new(view);
        let [columns, rows] = view.size.map(|side| side.div_ceil(CELL));
        let mut cells = vec![Vec::new(); (columns * rows) as usize];
        let mut round_corner: HashMap<_, Vec<u32>> = HashMap::new();
        for (index, triangle) in triangles.iter().enumerate() {
            let index = index as u32;
            for p in triangle.corners {
                round_corner.entry((triangle.owner.0, bits(p))).or_default().push(index);
            }
            if !triangle.double_sided && !triangle.faces(&eye) {
                continue;
            }
            let corners = triangle.corners.map(|p| eye.project(p));
            let low = corners[0].min(corners[1]).min(corners[2]) - 1.0;
            let high = corners[0].max(corners[1]).max(corners[2]) + 1.0;
            let range = |low: f64, high: f64, count: u32| {
                let cell = f64::from(CELL);
                let last = f64::from(count);
                (low / cell).floor().clamp(0.0, last) as u32
                    ..(high / cell).ceil().clamp(0.0, last) as u32
            };
            for row in range(low.y, high.y, rows) {
                for column in range(low.x, high.x, columns) {
                    cells[(row * columns + column) as usize].push(index);
                }
            }
        }
        Self { triangles, eye, columns, cells, round_corner }
    }

    /// Whether something hides a place of a line.
    fn seen(&self, p: DVec3, p_px: DVec2, line: &Line) -> Seen {
        let cell = p_px.as_uvec2() / CELL;
        let distance = self.eye.distance(p);
        let ray = self.eye.ray(p_px);
        let rounding = 1e-5 * distance.abs();
        let mut seen = if line.must { Seen::Wholly } else { Seen::Maybe };
        for &index in &self.cells[(cell.y * self.columns + cell.x) as usize] {
            let index = index as usize;
            let triangle = &self.triangles[index];
            let Some((t, _)) = ray.meets(triangle.corners) else { continue };
            let before = distance - t;
            if before <= rounding || line.faces.contains(&index) {
                continue;
            }
            let own = &self.triangles[line.faces[0]];
            if line.slack == 0.0 || triangle.owner.0 != own.owner.0 || before > 2.0 * line.slack {
                return Seen::Not;
            }
            let is_round = own.corners.iter().any(|&corner| {
                self.round_corner[&(own.owner.0, bits(corner))].contains(&(index as u32))
            });
            if !is_round || before > line.slack {
                seen = Seen::Maybe;
            }
        }
        seen
    }
}

/// Places on the lines, at most [`STEP_PX`] apart, of those parts that lie on the picture.
///
/// # Panics
/// If a line reaches behind the camera.
#[must_use]
pub fn places(lines: &[Line], triangles: &[Triangle], view: &View) -> Vec<Place> {
    let grid = Grid::new(triangles, view);
    let eye = &grid.eye;
    let size = DVec2::new(f64::from(view.size[0]), f64::from(view.size[1]));
    let mut places = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let distances = line.ends.map(|p| eye.distance(p));
        assert!(distances.iter().all(|d| *d > eye.near), "a line reaches behind the camera");
        let [a, b] = line.ends.map(|p| eye.project(p));
        let length = (b - a).length();
        let steps = (length / STEP_PX).ceil().max(1.0);
        for i in 0..steps as usize {
            let t_px = (i as f64 + 0.5) / steps;
            // Even steps on the picture: 1/z is linear there, z itself if nothing converges.
            let [w0, w1] = [(1.0 - t_px) / distances[0], t_px / distances[1]];
            let t = if eye.is_orthographic() { t_px } else { w1 / (w0 + w1) };
            let p = line.ends[0].lerp(line.ends[1], t);
            let p_px = a.lerp(b, t_px);
            if p_px.cmpge(DVec2::ZERO).all() && p_px.cmplt(size).all() {
                let seen = grid.seen(p, p_px, line);
                let length_px = length / steps;
                places.push(Place { p_px, p, line: index, length_px, seen });
            }
        }
    }
    places
}
