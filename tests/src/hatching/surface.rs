//! Where the strokes of one picture are in another one: pictures are compared on the surface.

use genga::render::View;
use genga::scene::{Pose, Scene};
use genga::style::Style;
use glam::{DVec2, DVec3};

use super::{ink_of, median};
use crate::{Eye, draw_posed};

/// Triangles of a scene in a pose, in f64.
#[derive(Clone, Debug, Default)]
pub struct Posed {
    /// Corners in the world.
    pub triangles: Vec<[DVec3; 3]>,
    /// Where each triangle comes from: node, primitive and its three vertices.
    pub sources: Vec<(usize, usize, [usize; 3])>,
}

impl Posed {
    /// All meshes of a scene.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose) -> Self {
        let mut posed = Self::default();
        for (index, node) in scene.nodes.iter().enumerate() {
            let Some(mesh) = node.mesh else { continue };
            let joints = pose.world_from_rest(scene, index).unwrap_or_default();
            for (p, primitive) in scene.meshes[mesh].primitives.iter().enumerate() {
                let place = |v: usize| -> DVec3 {
                    let rest = primitive.positions[v];
                    if joints.is_empty() || primitive.joints.is_empty() {
                        return pose.world_from_node[index].transform_point3(rest).as_dvec3();
                    }
                    let (ids, weights) = (primitive.joints[v], primitive.weights[v]);
                    (0..4)
                        .map(|i| {
                            let p = joints[usize::from(ids[i])].transform_point3(rest).as_dvec3();
                            p * f64::from(weights[i])
                        })
                        .sum()
                };
                for corners in primitive.indices.chunks_exact(3) {
                    let corners = [0, 1, 2].map(|i| corners[i] as usize);
                    posed.triangles.push(corners.map(place));
                    posed.sources.push((index, p, corners));
                }
            }
        }
        posed
    }

    fn point(&self, hit: Hit) -> DVec3 {
        let [a, b, c] = self.triangles[hit.triangle];
        a + (b - a) * hit.weights[0] + (c - a) * hit.weights[1]
    }
}

/// What lies behind a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Number of the triangle.
    pub triangle: usize,
    /// Barycentric weights of its second and third corner.
    pub weights: [f64; 2],
    distance: f64,
}

/// What lies behind each pixel of a view.
#[must_use]
pub fn hits(posed: &Posed, view: &View) -> Vec<Option<Hit>> {
    let eye = Eye::new(view);
    let [width, height] = view.size;
    let mut hits: Vec<Option<Hit>> = vec![None; (width * height) as usize];
    for (triangle, corners) in posed.triangles.iter().enumerate() {
        let px = corners.map(|p| eye.project(p));
        let area = (px[1] - px[0]).perp_dot(px[2] - px[0]);
        // The picture's y points down.
        if area >= 0.0 || corners.iter().any(|&p| eye.distance(p) <= eye.near) {
            continue;
        }
        let low = px[0].min(px[1]).min(px[2]).floor().max(DVec2::ZERO);
        let high = px[0].max(px[1]).max(px[2]).ceil();
        let end = [high.x.min(f64::from(width)) as u32, high.y.min(f64::from(height)) as u32];
        for y in low.y as u32..end[1] {
            for x in low.x as u32..end[0] {
                let Some((distance, weights)) = eye.ray_at(x, y).meets(*corners) else { continue };
                let slot = &mut hits[(y * width + x) as usize];
                if slot.is_none_or(|hit| distance < hit.distance) {
                    *slot = Some(Hit { triangle, weights, distance });
                }
            }
        }
    }
    hits
}

/// A picture with what it shows.
pub struct Frame {
    posed: Posed,
    hits: Vec<Option<Hit>>,
    eye: Eye,
    size: [u32; 2],
    /// Coverage by ink.
    pub ink: Vec<f64>,
}

impl Frame {
    /// Draws a scene in a pose.
    #[must_use]
    pub fn draw(scene: &Scene, pose: &Pose, style: &Style, view: &View) -> Self {
        let posed = Posed::new(scene, pose);
        let hits = hits(&posed, view);
        let ink = ink_of(&draw_posed(scene, pose, style, view, &[]));
        Self { posed, hits, eye: Eye::new(view), size: view.size, ink }
    }

    /// Where the surface under a pixel of this frame is on the picture of another one, if it is
    /// seen there.
    fn place_in(&self, other: &Self, x: u32, y: u32) -> Option<DVec2> {
        let hit = self.hits[(y * self.size[0] + x) as usize]?;
        let p = other.posed.point(hit);
        let place = other.eye.project(p);
        let [column, row] = [place.x.floor(), place.y.floor()];
        let margin = 4.0;
        let inside = |v: f64, side: u32| v >= margin && v < f64::from(side) - margin;
        if !inside(column, self.size[0]) || !inside(row, self.size[1]) {
            return None;
        }
        let seen = other.hits[row as usize * self.size[0] as usize + column as usize]?;
        let near = 4.0 * other.eye.footprint(seen.distance);
        (other.posed.point(seen).distance(p) < near.max(1e-9)).then_some(place)
    }

    /// Ink at a place, between the middles of pixels.
    fn sample(&self, p: DVec2) -> f64 {
        let p = p - 0.5;
        let at = |x: f64, y: f64| {
            let x = x.clamp(0.0, f64::from(self.size[0] - 1)) as usize;
            let y = y.clamp(0.0, f64::from(self.size[1] - 1)) as usize;
            self.ink[y * self.size[0] as usize + x]
        };
        let (low, part) = (p.floor(), p - p.floor());
        let row = |y: f64| at(low.x, y) * (1.0 - part.x) + at(low.x + 1.0, y) * part.x;
        row(low.y) * (1.0 - part.y) + row(low.y + 1.0) * part.y
    }

    /// Changed pixels over inked ones between a frame and this one: ink that was paper or the other
    /// way round, on the surface.
    #[must_use]
    pub fn changed_since(&self, before: &Self) -> f64 {
        let (mut inked, mut changed) = (0_u32, 0_u32);
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let Some(place) = self.place_in(before, x, y) else { continue };
                let now = self.ink[(y * self.size[0] + x) as usize];
                inked += u32::from(now > 0.5);
                changed += u32::from((now - before.sample(place)).abs() > 0.5);
            }
        }
        f64::from(changed) / f64::from(inked.max(1))
    }

    /// Median distance in pixels by which marks have moved on the surface since another frame: for
    /// each window of this picture, the shift at which the other one fits best, up to 3 px (less
    /// than half of the strokes' distance, or one stroke would be taken for another). Windows
    /// whose strokes have grown or gone so far that nothing fits do not count.
    #[must_use]
    pub fn drift_since(&self, other: &Self) -> f64 {
        const WINDOW: u32 = 24;
        const REACH: i32 = 6;
        let mut drifts = Vec::new();
        for top in (0..self.size[1] - WINDOW).step_by(WINDOW as usize / 2) {
            for left in (0..self.size[0] - WINDOW).step_by(WINDOW as usize / 2) {
                let pixels = (0..WINDOW)
                    .step_by(2)
                    .flat_map(|dy| (0..WINDOW).step_by(2).map(move |dx| (left + dx, top + dy)));
                let pairs: Option<Vec<(f64, DVec2)>> = pixels
                    .map(|(x, y)| {
                        let ink = self.ink[(y * self.size[0] + x) as usize];
                        Some((ink, self.place_in(other, x, y)?))
                    })
                    .collect();
                let Some(pairs) = pairs else { continue };
                let mean = pairs.iter().map(|(ink, _)| ink).sum::<f64>() / pairs.len() as f64;
                if !(0.1..0.9).contains(&mean) {
                    continue;
                }
                let error = |shift: DVec2| -> f64 {
                    pairs.iter().map(|(ink, p)| (ink - other.sample(*p + shift)).powi(2)).sum()
                };
                let errors: Vec<(f64, DVec2)> = (-REACH..=REACH)
                    .flat_map(|y| {
                        (-REACH..=REACH).map(move |x| DVec2::new(x.into(), y.into()) * 0.5)
                    })
                    .map(|shift| (error(shift), shift))
                    .collect();
                let typical = errors.iter().map(|(e, _)| e).sum::<f64>() / errors.len() as f64;
                // The smallest of equal shifts.
                let cost = |(e, s): &(f64, DVec2)| e + 1e-6 * s.length();
                let best = errors.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
                drifts.extend(best.filter(|(e, _)| *e < 0.7 * typical).map(|(_, s)| s.length()));
            }
        }
        assert!(drifts.len() > 10, "only {} windows are hatched", drifts.len());
        median(drifts)
    }

    /// How far the ends of level strokes spread that come out of the dark on the left: the
    /// standard deviation of where they end over their mean length outside of the dark.
    ///
    /// # Panics
    /// If there are hardly any.
    #[must_use]
    pub fn spread_of_ends(&self) -> f64 {
        let [width, height] = self.size.map(|side| side as usize);
        // Each row's run of ink from the left edge of the surface on: longest in the middle of a
        // stroke, shortest between two, where it is the dark.
        let run = |y: usize| -> f64 {
            let row = &self.ink[y * width..(y + 1) * width];
            let first = row.iter().position(|&ink| ink > 0.5).unwrap_or(width);
            row[first..].iter().take_while(|&&ink| ink > 0.25).count() as f64
        };
        let runs: Vec<f64> = (height / 8..height - height / 8).map(run).collect();
        let inner = 1..runs.len() - 1;
        let is_end = |&y: &usize| runs[y] >= runs[y - 1] && runs[y] > runs[y + 1];
        let is_gap = |&y: &usize| runs[y] <= runs[y - 1] && runs[y] < runs[y + 1];
        let ends: Vec<f64> = inner.clone().filter(is_end).map(|y| runs[y]).collect();
        let gaps: Vec<f64> = inner.filter(is_gap).map(|y| runs[y]).collect();
        assert!(ends.len() >= 10, "only {} strokes were found", ends.len());
        let mean = |numbers: &[f64]| numbers.iter().sum::<f64>() / numbers.len().max(1) as f64;
        let middle = mean(&ends);
        let spread = mean(&ends.iter().map(|l| (l - middle).powi(2)).collect::<Vec<_>>()).sqrt();
        spread / (middle - mean(&gaps)).max(1.0)
    }

    /// What lies behind a pixel, and where.
    #[must_use]
    pub fn seen(&self, x: u32, y: u32) -> Option<(Hit, DVec3)> {
        let hit = self.hits[(y * self.size[0] + x) as usize]?;
        Some((hit, self.posed.point(hit)))
    }

    /// Where a point of the world is on the picture.
    #[must_use]
    pub fn project(&self, p: DVec3) -> DVec2 {
        self.eye.project(p)
    }

    /// The posed triangles.
    #[must_use]
    pub fn posed(&self) -> &Posed {
        &self.posed
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}
