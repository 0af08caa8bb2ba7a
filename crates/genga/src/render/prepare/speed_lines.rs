//! Places on surfaces that speed lines trail from, and the strokes of a moment.

use std::collections::HashMap;

use glam::Vec3;

use super::DrawItem;
use crate::render::{generated::SpeedLine, gpu::bindings};
use crate::scene::{NodePose, Pose, Scene, SurfacePoint};
use crate::style::{SpeedLines, Style};

/// Most places; more would be too many for the CPU and for the picture.
const MAX_PLACES: usize = 50_000;

/// Speed lines of a scene.
pub(crate) struct SpeedLineData {
    places: Vec<Place>,
    /// The line set that they are part of.
    set: u32,
    style: Option<SpeedLines>,
    pub(crate) strokes: wgpu::Buffer,
    pub(crate) count: u32,
}

struct Place {
    point: SurfacePoint,
    /// Part of its way that it shows.
    part: f32,
}

impl SpeedLineData {
    /// Scatters places over the surfaces of a scene at rest.
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        style: &Style,
        draws: &[DrawItem],
        warnings: &mut Vec<String>,
    ) -> Self {
        let mut data = Self {
            places: Vec::new(),
            set: 0,
            style: None,
            strokes: bindings::buffer(
                device,
                queue,
                "speed lines",
                wgpu::BufferUsages::STORAGE,
                &[<SpeedLine as bytemuck::Zeroable>::zeroed()],
            ),
            count: 0,
        };
        let Some(wanted) = style.motion.speed_lines.as_ref().filter(|_| style.motion.is_drawn())
        else {
            return data;
        };
        use crate::style::LineMethod;
        if !matches!(style.lines.method, LineMethod::Contour | LineMethod::Reference) {
            warnings.push(
                "speed lines are drawn by the line methods 'contour' and 'reference' alone: there \
                 are none"
                    .to_owned(),
            );
            return data;
        }
        let sets = style.lines.sets.iter().take(4);
        let set = match &wanted.set {
            None => style.lines.sets.len().min(4).checked_sub(1),
            Some(name) => sets.clone().position(|set| set.name == *name),
        };
        let Some(set) = set else {
            let name = wanted.set.as_deref().unwrap_or("");
            let known: Vec<_> = sets.map(|set| set.name.as_str()).collect();
            warnings.push(format!(
                "speed lines are to be part of the line set '{name}', which there is not (known: {}): \
                 there are none",
                known.join(", ")
            ));
            return data;
        };
        data.set = set as u32;
        data.style = Some(wanted.clone());
        data.scatter(scene, &style.lines.sets[set], wanted, draws, warnings);
        data
    }

    fn scatter(
        &mut self,
        scene: &Scene,
        set: &crate::style::LineSet,
        wanted: &SpeedLines,
        draws: &[DrawItem],
        warnings: &mut Vec<String>,
    ) {
        let rest = Pose::rest(scene);
        let is_beam = |node: usize, primitive: usize| {
            draws.iter().any(|d| d.surface == [node, primitive] && d.beam.is_some())
        };
        for (node, item) in scene.nodes.iter().enumerate() {
            let Some(mesh) = item.mesh.and_then(|mesh| scene.meshes.get(mesh)) else { continue };
            let Some(posed) = NodePose::new(scene, &rest, node).filter(|_| rest.visible[node])
            else {
                continue;
            };
            for (primitive, triangles) in mesh.primitives.iter().enumerate() {
                let material = triangles.material.map_or("", |m| scene.materials[m].name.as_str());
                let has_lines =
                    set.matches(&item.name, material) && wanted.matches(&item.name, material);
                if !has_lines || is_beam(node, primitive) {
                    continue;
                }
                // Even shares of the area, one place somewhere in each.
                let seed = wanted.seed ^ hashed(node as u32, primitive as u32);
                let (mut area, mut next) = (0.0_f64, 0_u32);
                for corners in triangles.indices.chunks_exact(3) {
                    let corners = [corners[0], corners[1], corners[2]];
                    let third = 1.0 / 3.0;
                    let mut point = SurfacePoint { node, primitive, corners, shares: [third; 3] };
                    let [a, b, c] = posed.corners(&point);
                    let own = 0.5 * f64::from((b - a).cross(c - a).length());
                    if own.is_finite() {
                        area += own * f64::from(wanted.density);
                    }
                    while area > f64::from(next) + f64::from(chance(seed, next, 0)) {
                        if self.places.len() >= MAX_PLACES {
                            warnings.push(format!(
                                "there are more than {MAX_PLACES} places for speed lines: parts of the \
                                 scene have none; make their density less"
                            ));
                            return;
                        }
                        let root = chance(seed, next, 1).sqrt();
                        let across = chance(seed, next, 2);
                        point.shares = [1.0 - root, root * (1.0 - across), root * across];
                        let part = 1.0 - wanted.irregularity * chance(seed, next, 3);
                        self.places.push(Place { point, part });
                        next += 1;
                    }
                }
            }
        }
    }

    /// The strokes of a moment, by the poses before it: see `Motion::moments`.
    pub(crate) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
        (pose, past): (&Pose, &[Pose]),
        shutter_s: f32,
    ) {
        self.count = 0;
        let Some(style) = self.style.clone() else { return };
        if past.is_empty() || shutter_s <= 0.0 {
            return;
        }
        let poses: Vec<&Pose> = std::iter::once(pose).chain(past).collect();
        let mut nodes: HashMap<usize, Vec<NodePose<'_>>> = HashMap::new();
        let mut strokes = Vec::new();
        for place in &self.places {
            let posed = nodes.entry(place.point.node).or_insert_with(|| {
                poses.iter().filter_map(|&p| NodePose::new(scene, p, place.point.node)).collect()
            });
            if posed.len() == poses.len() {
                self.add(&mut strokes, place, posed, &style, shutter_s);
            }
        }
        self.count = strokes.len() as u32;
        if strokes.is_empty() {
            return;
        }
        let bytes: &[u8] = bytemuck::cast_slice(&strokes);
        if self.strokes.size() < bytes.len() as u64 {
            let usage = wgpu::BufferUsages::STORAGE;
            self.strokes = bindings::buffer(device, queue, "speed lines", usage, bytes);
        } else {
            queue.write_buffer(&self.strokes, 0, bytes);
        }
    }

    fn add(
        &self,
        strokes: &mut Vec<SpeedLine>,
        place: &Place,
        poses: &[NodePose<'_>],
        style: &SpeedLines,
        shutter_s: f32,
    ) {
        let point = &place.point;
        let mean =
            |[a, b, c]: [Vec3; 3]| a * point.shares[0] + b * point.shares[1] + c * point.shares[2];
        let [a, b, c] = poses[0].corners(point);
        let now = mean([a, b, c]);
        let first = mean(poses[poses.len() - 1].corners(point));
        let speed = (now - first).length() / shutter_s;
        // Grown in from the threshold, so that none pops.
        let strength = ((speed / style.threshold.max(1e-6) - 1.0) / 0.5).clamp(0.0, 1.0);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let trails = (first - now).normalize_or_zero().dot(normal);
        // Beside the way, too: behind a fist there is only its arm.
        let facing = ((trails + 0.15) / 0.3).clamp(0.0, 1.0);
        // Also where something is no number.
        if !(strength * facing > 0.0 && speed.is_finite()) {
            return;
        }
        let width = style.width * strength * facing;
        let part = style.length * place.part;
        let steps = poses.len() - 1;
        let mut before = now;
        for (i, pose) in poses.iter().enumerate().skip(1) {
            // The way, drawn out by the factor on its length.
            let next = now + (mean(pose.corners(point)) - now) * part;
            if !next.is_finite() {
                break;
            }
            let radius = |i: usize| width * (1.0 - i as f32 / steps as f32);
            strokes.push(SpeedLine {
                a: before.extend(radius(i - 1)),
                b: next.extend(radius(i)),
                line_set: self.set,
                ..bytemuck::Zeroable::zeroed()
            });
            before = next;
        }
    }
}

fn hashed(a: u32, b: u32) -> u32 {
    let mut h = a.wrapping_mul(0x9e37_79b1) ^ b.wrapping_mul(0x85eb_ca77) ^ 0x1656_67b1;
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    h ^ (h >> 15)
}

/// A number in [0, 1).
fn chance(seed: u32, i: u32, what: u32) -> f32 {
    (hashed(hashed(seed, i), what) >> 8) as f32 / 16_777_216.0
}
