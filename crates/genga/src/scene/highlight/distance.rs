//! Signed distance fields of outlines.

use glam::Vec2;

/// Values along a side of a distance field.
pub(crate) const FIELD_SIZE: usize = 512;
/// A field covers [−`FIELD_EXTENT`, `FIELD_EXTENT`] along both axes; see `shading/highlight.wesl`.
pub(crate) const FIELD_EXTENT: f32 = 1.25;

/// A piece of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) a: Vec2,
    pub(super) b: Vec2,
}

impl Segment {
    fn distance_squared(&self, p: Vec2) -> f32 {
        let (along, from) = (self.b - self.a, p - self.a);
        let length_squared = along.length_squared();
        let u = if length_squared > 0.0 {
            (from.dot(along) / length_squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (from - along * u).length_squared()
    }
}

/// The middle of a value, in the drawing's coordinates.
fn place(x: usize, y: usize) -> Vec2 {
    let at = |i: usize| ((i as f32 + 0.5) / FIELD_SIZE as f32 * 2.0 - 1.0) * FIELD_EXTENT;
    Vec2::new(at(x), -at(y))
}

/// The number of the value at a coordinate, counted from the left or top; not rounded.
fn index_at(coordinate: f32) -> f32 {
    (coordinate / FIELD_EXTENT + 1.0) * 0.5 * FIELD_SIZE as f32 - 0.5
}

/// Distances to closed outlines, negative in an odd number of them, the top row first.
///
/// Each value knows its nearest segment: first those beside an outline, exactly; then the number of
/// the segment is handed on over the grid (as Danielsson 1980 hands on points).
pub(super) fn field(segments: &[Segment]) -> Vec<f32> {
    let mut grid = Grid {
        segments,
        nearest: vec![u32::MAX; FIELD_SIZE * FIELD_SIZE],
        squared: vec![f32::INFINITY; FIELD_SIZE * FIELD_SIZE],
    };
    grid.begin();
    grid.sweep();
    let inside = inside(segments);
    let signed = |(squared, is_inside): (f32, bool)| {
        if is_inside { -squared.sqrt() } else { squared.sqrt() }
    };
    grid.squared.into_iter().zip(inside).map(signed).collect()
}

struct Grid<'a> {
    segments: &'a [Segment],
    nearest: Vec<u32>,
    squared: Vec<f32>,
}

impl Grid<'_> {
    fn offer(&mut self, x: usize, y: usize, segment: u32) {
        let Some(candidate) = self.segments.get(segment as usize) else { return };
        let squared = candidate.distance_squared(place(x, y));
        let at = y * FIELD_SIZE + x;
        if squared < self.squared[at] {
            self.squared[at] = squared;
            self.nearest[at] = segment;
        }
    }

    /// Offers each segment to the values round it.
    fn begin(&mut self) {
        const BAND: f32 = 2.0;
        let last = FIELD_SIZE as f32 - 1.0;
        let span = |low: f32, high: f32| {
            let clamped = |v: f32| v.clamp(0.0, last) as usize;
            clamped((low - BAND).floor())..=clamped((high + BAND).ceil())
        };
        for (number, segment) in self.segments.iter().enumerate() {
            let (low, high) = (segment.a.min(segment.b), segment.a.max(segment.b));
            for y in span(index_at(-high.y), index_at(-low.y)) {
                for x in span(index_at(low.x), index_at(high.x)) {
                    self.offer(x, y, number as u32);
                }
            }
        }
    }

    /// Twice down and up, each row both ways.
    fn sweep(&mut self) {
        for _ in 0..2 {
            for y in 0..FIELD_SIZE {
                self.row(y, y.checked_sub(1));
            }
            for y in (0..FIELD_SIZE).rev() {
                self.row(y, Some(y + 1).filter(|&y| y < FIELD_SIZE));
            }
        }
    }

    fn row(&mut self, y: usize, before: Option<usize>) {
        if let Some(before) = before {
            for x in 0..FIELD_SIZE {
                for x_before in x.saturating_sub(1)..=(x + 1).min(FIELD_SIZE - 1) {
                    let segment = self.nearest[before * FIELD_SIZE + x_before];
                    self.offer(x, y, segment);
                }
            }
        }
        for x in 1..FIELD_SIZE {
            let segment = self.nearest[y * FIELD_SIZE + x - 1];
            self.offer(x, y, segment);
        }
        for x in (0..FIELD_SIZE - 1).rev() {
            let segment = self.nearest[y * FIELD_SIZE + x + 1];
            self.offer(x, y, segment);
        }
    }
}

/// Whether each value lies in an odd number of outlines, by counting crossings along its row.
fn inside(segments: &[Segment]) -> Vec<bool> {
    let mut crossings: Vec<Vec<f32>> = vec![Vec::new(); FIELD_SIZE];
    for segment in segments {
        let (low, high) =
            if segment.a.y < segment.b.y { (segment.a, segment.b) } else { (segment.b, segment.a) };
        // Rows count from the top. A row through an end belongs to one of its two segments.
        let first = index_at(-high.y).floor().max(0.0) as usize;
        for (y, row) in crossings.iter_mut().enumerate().skip(first) {
            let height = place(0, y).y;
            if height < low.y {
                break;
            }
            if height < high.y {
                let u = (height - low.y) / (high.y - low.y);
                row.push(low.x + (high.x - low.x) * u);
            }
        }
    }
    let mut result = Vec::with_capacity(FIELD_SIZE * FIELD_SIZE);
    for row in &mut crossings {
        row.sort_by(f32::total_cmp);
        for x in 0..FIELD_SIZE {
            let before = row.partition_point(|&crossing| crossing < place(x, 0).x);
            result.push(before % 2 == 1);
        }
    }
    result
}
