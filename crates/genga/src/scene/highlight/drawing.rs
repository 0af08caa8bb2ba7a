//! What a highlight is drawn as: outlines, from pictures or by code.

use std::f32::consts::{PI, TAU};
use std::sync::Arc;

use glam::Vec2;

use super::distance::{Segment, field};
use crate::scene::Image;

/// The shape of a highlight. Only its outline counts.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// One that comes with the library.
    BuiltIn(BuiltInDrawing),
    /// A picture: inside is where alpha is at least one half or, in a picture without
    /// transparency, where the luminance is. Its longer side is that of the drawing's square.
    Image(Arc<Image>),
}

/// The drawings that come with the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BuiltInDrawing {
    /// A round spot.
    Disc,
    /// A bar with round ends, across the whole width.
    Band,
    /// A jagged band, as on shining hair.
    AngelRing,
    /// Four panes.
    Window,
    /// Five points.
    Star,
    /// A heart.
    Heart,
    /// A large dot and a small one below it, as in eyes.
    DoubleDot,
    /// A stroke that is pointed at both ends, across the whole width.
    Streak,
}

/// A drawing cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DrawingError {
    /// There is nothing in it.
    #[error(
        "an empty drawing: no pixel is at least half opaque or, without transparency, half bright"
    )]
    Empty,
}

impl BuiltInDrawing {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Disc,
        Self::Band,
        Self::AngelRing,
        Self::Window,
        Self::Star,
        Self::Heart,
        Self::DoubleDot,
        Self::Streak,
    ];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Disc => "disc",
            Self::Band => "band",
            Self::AngelRing => "angel-ring",
            Self::Window => "window",
            Self::Star => "star",
            Self::Heart => "heart",
            Self::DoubleDot => "double-dot",
            Self::Streak => "streak",
        }
    }

    /// Its closed outlines in [−1, 1]², y up. What lies in an odd number of them is inside.
    #[must_use]
    pub fn outlines(self) -> Vec<Vec<Vec2>> {
        match self {
            Self::Disc => vec![circle(Vec2::ZERO, 1.0)],
            Self::Band => vec![band()],
            Self::AngelRing => vec![angel_ring()],
            Self::Window => window(),
            Self::Star => vec![star()],
            Self::Heart => vec![heart()],
            Self::DoubleDot => {
                vec![circle(Vec2::new(-0.3, 0.3), 0.65), circle(Vec2::new(0.62, -0.62), 0.34)]
            }
            Self::Streak => vec![streak()],
        }
    }
}

impl Drawing {
    /// Signed distances to the outline, negative inside, in halves of the drawing's side:
    /// `FIELD_SIZE`² values that cover [−1.25, 1.25]², the top row first.
    ///
    /// # Errors
    /// [`DrawingError::Empty`].
    pub fn distance_field(&self) -> Result<Vec<f32>, DrawingError> {
        let segments = match self {
            Self::BuiltIn(drawing) => drawing
                .outlines()
                .iter()
                .flat_map(|outline| {
                    let next = outline.iter().cycle().skip(1);
                    outline.iter().zip(next).map(|(a, b)| Segment { a: *a, b: *b })
                })
                .collect(),
            Self::Image(image) => Contour::of(image).segments(),
        };
        if segments.is_empty() { Err(DrawingError::Empty) } else { Ok(field(&segments)) }
    }

    pub(super) fn validate(&self) -> Result<(), String> {
        let Self::Image(image) = self else { return Ok(()) };
        let pixels = image.width as usize * image.height as usize;
        let is_whole = pixels > 0 && image.rgba.len() == 4 * pixels;
        if is_whole && shares(image).iter().any(|&share| share >= 0.5) {
            Ok(())
        } else {
            Err(format!("has {}", DrawingError::Empty))
        }
    }
}

fn circle(center: Vec2, radius: f32) -> Vec<Vec2> {
    let at = |i: u32| center + radius * Vec2::from_angle(i as f32 / 256.0 * TAU);
    (0..256).map(at).collect()
}

fn band() -> Vec<Vec2> {
    let radius = 0.3;
    let end = |middle: Vec2, from: f32| {
        (0..=64).map(move |i| middle + radius * Vec2::from_angle(from + i as f32 / 64.0 * PI))
    };
    let x = Vec2::X * (1.0 - radius);
    end(x, -0.5 * PI).chain(end(-x, 0.5 * PI)).collect()
}

/// Teeth of uneven length on both sides of a band that thins out to its ends.
fn angel_ring() -> Vec<Vec2> {
    const UPPER: [f32; 12] =
        [0.30, 0.46, 0.34, 0.62, 0.40, 0.74, 0.48, 0.80, 0.42, 0.60, 0.36, 0.34];
    const LOWER: [f32; 13] =
        [0.24, 0.50, 0.36, 0.70, 0.44, 0.92, 0.52, 1.00, 0.46, 0.78, 0.40, 0.48, 0.26];
    // A tooth's sides are hollow, so that it looks pulled out with a brush.
    let side = |teeth: &[f32], sign: f32| -> Vec<Vec2> {
        const STEPS: usize = 24;
        let count = teeth.len() * STEPS;
        (0..count)
            .map(|i| {
                let across = (i % STEPS) as f32 / STEPS as f32 * 2.0 - 1.0;
                let x = i as f32 / count as f32 * 2.0 - 1.0;
                let point = (1.0 - across.abs()).powf(1.8);
                let envelope = (1.0 - x * x).max(0.0).powf(0.45);
                let tooth = teeth.get(i / STEPS).copied().unwrap_or(0.0);
                // The whole band hangs a little, as round a head.
                let height = envelope * (0.13 + (tooth - 0.13).max(0.0) * 0.55 * point);
                Vec2::new(x, sign * height + 0.12 * x * x)
            })
            .collect()
    };
    let lower = side(&LOWER, -1.0);
    let upper = side(&UPPER, 1.0).into_iter().map(|p| Vec2::new(-p.x, p.y));
    lower.into_iter().chain(upper).collect()
}

/// Panes bulge a little, as on an eye or a bulb.
fn window() -> Vec<Vec<Vec2>> {
    let (gap, steps) = (0.07, 24);
    let bulge = |p: Vec2| {
        Vec2::new(p.x * (0.84 + 0.16 * (1.0 - p.y * p.y)), p.y * (0.84 + 0.16 * (1.0 - p.x * p.x)))
    };
    let pane = |low: Vec2, high: Vec2| -> Vec<Vec2> {
        let corners = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
        (0..4)
            .flat_map(|side| {
                let (a, b) = (corners[side], corners[(side + 1) % 4]);
                (0..steps).map(move |i| bulge(a.lerp(b, i as f32 / steps as f32)))
            })
            .collect()
    };
    let spans = [(-1.0, -gap), (gap, 1.0)];
    spans
        .iter()
        .flat_map(|&(x0, x1)| {
            spans.iter().map(move |&(y0, y1)| pane(Vec2::new(x0, y0), Vec2::new(x1, y1)))
        })
        .collect()
}

fn star() -> Vec<Vec2> {
    let point = |i: u32| {
        let radius = if i.is_multiple_of(2) { 1.0 } else { 0.42 };
        radius * Vec2::from_angle(0.5 * PI + i as f32 * PI / 5.0)
    };
    (0..10).map(point).collect()
}

fn heart() -> Vec<Vec2> {
    let point = |i: u32| {
        let t = i as f32 / 256.0 * TAU;
        let x = 16.0 * t.sin().powi(3);
        let y = 13.0 * t.cos() - 5.0 * (2.0 * t).cos() - 2.0 * (3.0 * t).cos() - (4.0 * t).cos();
        Vec2::new(x, y + 2.5) / 16.0
    };
    (0..256).map(point).collect()
}

fn streak() -> Vec<Vec2> {
    let height = |x: f32| 0.2 * (1.0 - x * x).max(0.0).powf(1.3);
    let along = |i: u32| i as f32 / 64.0 * 2.0 - 1.0;
    let lower = (0..64).map(along).map(|x| Vec2::new(x, -height(x)));
    let upper = (0..64).map(along).map(|x| Vec2::new(-x, height(x)));
    lower.chain(upper).collect()
}

/// For each pixel, how much of it belongs to the drawing.
fn shares(image: &Image) -> Vec<f32> {
    let (texels, _) = image.rgba.as_chunks::<4>();
    let by_alpha = texels.iter().any(|texel| texel[3] < 255);
    let share = |texel: &[u8; 4]| {
        let [r, g, b, a] = texel.map(f32::from);
        if by_alpha { a / 255.0 } else { (0.2126 * r + 0.7152 * g + 0.0722 * b) / 255.0 }
    };
    texels.iter().map(share).collect()
}

/// Longest side of a picture whose outline is taken; larger ones are reduced.
const MAX_SIDE: usize = 2048;

/// A grid of shares, with a border of zeros, whose 0.5 contour is the outline.
struct Contour {
    width: usize,
    height: usize,
    /// Pixels in half of the longer side.
    half_side: f32,
    shares: Vec<f32>,
}

impl Contour {
    fn of(image: &Image) -> Self {
        let (mut width, mut height) = (image.width as usize, image.height as usize);
        let mut shares = shares(image);
        while width.max(height) > MAX_SIDE {
            (width, height, shares) = halved(width, height, &shares);
        }
        let mut bordered = vec![0.0; (width + 2) * (height + 2)];
        for (y, row) in shares.chunks_exact(width.max(1)).enumerate().take(height) {
            let at = (y + 1) * (width + 2) + 1;
            bordered[at..at + width].copy_from_slice(row);
        }
        let half_side = 0.5 * width.max(height) as f32;
        Self { width: width + 2, height: height + 2, half_side, shares: bordered }
    }

    /// Marching squares: the contour between the texels' centres, which is closed.
    fn segments(&self) -> Vec<Segment> {
        let mut segments = Vec::new();
        for y in 0..self.height - 1 {
            for x in 0..self.width - 1 {
                self.cell(x, y, &mut segments);
            }
        }
        segments
    }

    fn cell(&self, x: usize, y: usize, segments: &mut Vec<Segment>) {
        let value = |dx: usize, dy: usize| self.shares[(y + dy) * self.width + x + dx] - 0.5;
        // Corners in their order round the cell.
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let values = corners.map(|(dx, dy)| value(dx, dy));
        if values.iter().all(|&v| v >= 0.0) || values.iter().all(|&v| v < 0.0) {
            return;
        }
        let crossing = |i: usize| -> Option<Vec2> {
            let j = (i + 1) % 4;
            if (values[i] >= 0.0) == (values[j] >= 0.0) {
                return None;
            }
            // Neighbouring cells must find the same point, so it is counted from one fixed end.
            let (i, j) = if corners[i] < corners[j] { (i, j) } else { (j, i) };
            let u = values[i] / (values[i] - values[j]);
            let at = |k: usize| Vec2::new(corners[k].0 as f32, corners[k].1 as f32);
            Some(self.place(Vec2::new(x as f32, y as f32) + at(i).lerp(at(j), u)))
        };
        let points: Vec<Vec2> = (0..4).filter_map(crossing).collect();
        match points[..] {
            [a, b] => segments.push(Segment { a, b }),
            [a, b, c, d] => {
                // A saddle: the mean decides which corners are joined.
                let joined = (values.iter().sum::<f32>() >= 0.0) == (values[0] >= 0.0);
                let pairs = if joined { [(a, b), (c, d)] } else { [(d, a), (b, c)] };
                segments.extend(pairs.map(|(a, b)| Segment { a, b }));
            }
            _ => {}
        }
    }

    /// From the grid to the drawing's coordinates.
    fn place(&self, at: Vec2) -> Vec2 {
        let middle = 0.5 * Vec2::new(self.width as f32 - 1.0, self.height as f32 - 1.0);
        (at - middle) / self.half_side * Vec2::new(1.0, -1.0)
    }
}

fn halved(width: usize, height: usize, shares: &[f32]) -> (usize, usize, Vec<f32>) {
    let (w, h) = ((width / 2).max(1), (height / 2).max(1));
    let mean = |x: usize, y: usize| {
        let xs = [2 * x, (2 * x + 1).min(width - 1)];
        let ys = [2 * y, (2 * y + 1).min(height - 1)];
        ys.iter().flat_map(|y| xs.map(|x| shares[y * width + x])).sum::<f32>() / 4.0
    };
    (w, h, (0..w * h).map(|i| mean(i % w, i / w)).collect())
}
