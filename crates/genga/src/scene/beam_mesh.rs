//! Beams → triangles in world space.

use std::f32::consts::{PI, TAU};

use glam::{Mat3, Quat, Vec3};

use super::{Beam, BeamShape, Pose, WaveAnchor, WavePlacement};

/// Triangles of a beam in world space.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BeamMesh {
    pub(crate) positions: Vec<Vec3>,
    /// Unit normals that the ramp is taken by.
    pub(crate) normals: Vec<Vec3>,
    pub(crate) indices: Vec<u32>,
}

impl Beam {
    /// Its triangles at a pose; empty where there is nothing to draw, and for marked surfaces.
    pub(crate) fn mesh(&self, pose: &Pose) -> BeamMesh {
        let mut mesh = BeamMesh::default();
        if self.size <= 0.0 || self.opacity <= 0.0 {
            return mesh;
        }
        let size = self.size;
        match &self.shape {
            BeamShape::Surfaces { .. } => {}
            BeamShape::Path { radius, .. } => {
                let path = self.path(pose);
                let [tail, head] = self.growth;
                let at = |t: f32| size * (radius[0] + (radius[1] - radius[0]) * t);
                add_tube(&mut mesh, &path, [at(tail), at(head)]);
            }
            BeamShape::Flash { radius, spikes, spread, seed } => {
                let (origin, axes) = self.frame(pose);
                add_flash(&mut mesh, size * radius, *spikes, *spread, *seed);
                mesh.place(origin, axes);
            }
            BeamShape::Burst { radius, lobes, seed } => {
                let (origin, axes) = self.frame(pose);
                add_burst(&mut mesh, size * radius, *lobes, *seed);
                mesh.place(origin, axes);
            }
        }
        mesh
    }

    /// Whether it is a path that nothing can be seen of, as all of it is at one place.
    pub(crate) fn has_no_length(&self, pose: &Pose) -> bool {
        let whole = Self { growth: [0.0, 1.0], ..self.clone() };
        matches!(self.shape, BeamShape::Path { .. }) && whole.path(pose).is_empty()
    }

    /// The part of the path that is there, in world space: at least 2 places, or none. The middle
    /// for what has no path.
    pub(crate) fn path(&self, pose: &Pose) -> Vec<Vec3> {
        let BeamShape::Path { points, is_bezier, .. } = &self.shape else {
            return vec![self.frame(pose).0];
        };
        let own = if *is_bezier { bezier(points) } else { points.clone() };
        let world: Vec<Vec3> = match &self.placement {
            WavePlacement::At { .. } => {
                let (origin, axes) = self.frame(pose);
                own.iter().map(|p| origin + axes * *p).collect()
            }
            WavePlacement::Between { from, to, roll } => {
                let (from, to) = (place_of(from, pose), place_of(to, pose));
                let (first, last) = (own[0], own[own.len() - 1]);
                let (main, wanted) = (last - first, to - from);
                let turn = axes(wanted, *roll) * axes(main, 0.0).transpose();
                let scale =
                    if main.length() > 1e-9 { wanted.length() / main.length() } else { 0.0 };
                own.iter().map(|p| from + turn * (*p - first) * scale).collect()
            }
        };
        part(&world, self.growth)
    }

    /// Where it is, and the axes of its frame.
    fn frame(&self, pose: &Pose) -> (Vec3, Mat3) {
        match &self.placement {
            WavePlacement::At { anchor, direction, follow, roll } => {
                let mut x = *direction;
                let node = anchor.nodes.first().and_then(|&node| pose.world_from_node.get(node));
                if let (true, Some(node)) = (*follow, node) {
                    x = node.transform_vector3(x);
                }
                (place_of(anchor, pose), axes(x, *roll))
            }
            WavePlacement::Between { from, to, roll } => {
                let (from, to) = (place_of(from, pose), place_of(to, pose));
                (from, axes(to - from, *roll))
            }
        }
    }
}

impl BeamMesh {
    fn place(&mut self, origin: Vec3, axes: Mat3) {
        self.positions.iter_mut().for_each(|p| *p = origin + axes * *p);
        self.normals.iter_mut().for_each(|n| *n = axes * *n);
    }
}

/// Mean place of an anchor's nodes, and its offset.
fn place_of(anchor: &WaveAnchor, pose: &Pose) -> Vec3 {
    let places = anchor.nodes.iter().filter_map(|&node| pose.world_from_node.get(node));
    let (sum, count) = places.fold((Vec3::ZERO, 0.0), |(sum, count), node| {
        (sum + Vec3::from(node.translation), count + 1.0)
    });
    sum / f32::max(count, 1.0) + anchor.offset
}

/// Axes with that x axis, whose y axis is as far up as it can be before the roll.
fn axes(x: Vec3, roll: f32) -> Mat3 {
    let x = x.normalize_or(Vec3::X);
    let up = if x.y.abs() < 0.999_9 { Vec3::Y } else { Vec3::NEG_X };
    let y = (up - x * x.dot(up)).normalize_or(Vec3::Y);
    Mat3::from_cols(x, y, x.cross(y)) * Mat3::from_rotation_x(roll)
}

/// Straight pieces of a Bézier curve (de Casteljau).
fn bezier(points: &[Vec3]) -> Vec<Vec3> {
    const PIECES: u16 = 64;
    let mut work = points.to_vec();
    (0..=PIECES)
        .map(|i| {
            let t = f32::from(i) / f32::from(PIECES);
            work.copy_from_slice(points);
            for n in (1..work.len()).rev() {
                for k in 0..n {
                    work[k] = work[k].lerp(work[k + 1], t);
                }
            }
            work[0]
        })
        .collect()
}

/// The part of a path between two shares of its length; empty if it has none.
fn part(path: &[Vec3], [tail, head]: [f32; 2]) -> Vec<Vec3> {
    let total: f32 = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if !(total > 0.0 && total.is_finite() && tail < head) {
        return Vec::new();
    }
    let [low, high] = [tail * total, head * total];
    // Points closer than that only make kinks.
    let least = 1e-4 * (high - low);
    let (mut gone, mut result) = (0.0, Vec::new());
    for pair in path.windows(2) {
        let length = pair[0].distance(pair[1]);
        let at = |s: f32| pair[0].lerp(pair[1], ((s - gone) / length.max(1e-20)).clamp(0.0, 1.0));
        let (from, to) = (gone.max(low), (gone + length).min(high));
        if from < to {
            let last = result.last().copied();
            if last.is_none() {
                result.push(at(from));
            }
            if result.last().is_some_and(|last: &Vec3| last.distance(at(to)) >= least) {
                result.push(at(to));
            }
        }
        gone += length;
    }
    if result.len() < 2 { Vec::new() } else { result }
}

/// Sides of a tube, and rings of its round ends.
const SIDES: u32 = 48;
const END_RINGS: u32 = 12;

/// A ring of a tube.
struct Ring {
    center: Vec3,
    /// Unit vector along the tube.
    along: Vec3,
    radius: f32,
    /// Part of the normal that points along the tube; the rest points outwards.
    lean: f32,
}

fn add_tube(mesh: &mut BeamMesh, path: &[Vec3], [first, last]: [f32; 2]) {
    if path.len() < 2 {
        return;
    }
    let total: f32 = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    // The outline of two balls and their common tangents: where the cone begins on each ball.
    let slope = ((first - last) / total.max(1e-20)).clamp(-1.0, 1.0);
    let direction = |i: usize| (path[i + 1] - path[i]).normalize_or(Vec3::X);
    let mut rings = Vec::new();
    let start_angle = slope.asin();
    let end = |center: Vec3, along: Vec3, radius: f32, [from, to]: [f32; 2]| {
        (0..=END_RINGS).map(move |i| {
            let angle = from + (to - from) * i as f32 / END_RINGS as f32;
            let (sin, cos) = angle.sin_cos();
            Ring {
                center: center + along * radius * sin,
                along,
                radius: radius * cos.max(0.0),
                lean: sin,
            }
        })
    };
    rings.extend(end(path[0], direction(0), first, [-PI / 2.0, start_angle]));
    let mut gone = 0.0;
    let cosine = (1.0 - slope * slope).max(0.0).sqrt();
    for i in 1..path.len() - 1 {
        gone += path[i].distance(path[i - 1]);
        let (before, after) = (direction(i - 1), direction(i));
        let along = (before + after).normalize_or(after);
        let radius = first + (last - first) * gone / total;
        // Mitred, so that the tube keeps its width round a bend; sharp ones stay near.
        let mitre = along.dot(after).max(0.4);
        rings.push(Ring {
            center: path[i] + along * radius * slope,
            along,
            radius: radius * cosine / mitre.sqrt(),
            lean: slope,
        });
    }
    let n = path.len();
    rings.extend(end(path[n - 1], direction(n - 2), last, [start_angle, PI / 2.0]));
    let mut side = rings[0].along.any_orthonormal_vector();
    let base = mesh.positions.len() as u32;
    let mut before = rings[0].along;
    for ring in &rings {
        // Parallel transport: no twist.
        side = Quat::from_rotation_arc(before, ring.along) * side;
        side = (side - ring.along * side.dot(ring.along)).normalize_or(side);
        before = ring.along;
        let other = ring.along.cross(side);
        let outward_part = (1.0 - ring.lean * ring.lean).max(0.0).sqrt();
        for i in 0..SIDES {
            let (sin, cos) = (TAU * i as f32 / SIDES as f32).sin_cos();
            let outward = side * cos + other * sin;
            mesh.positions.push(ring.center + outward * ring.radius);
            mesh.normals
                .push((outward * outward_part + ring.along * ring.lean).normalize_or(outward));
        }
    }
    for r in 0..rings.len() as u32 - 1 {
        for i in 0..SIDES {
            let j = (i + 1) % SIDES;
            let at = |ring: u32, side: u32| base + ring * SIDES + side;
            let [a, b, c, d] = [at(r, i), at(r, j), at(r + 1, i), at(r + 1, j)];
            mesh.indices.extend([a, b, c, c, b, d]);
        }
    }
}

/// A number in [0, 1) for the `i`th thing of a seed (PCG hash, Jarzynski and Olano 2020).
fn chance(seed: u32, i: u32, what: u32) -> f32 {
    let word = seed ^ i.wrapping_mul(0x9e37_79b9) ^ what.wrapping_mul(0x85eb_ca6b);
    let state = word.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    ((word >> 22) ^ word) as f32 / 4_294_967_296.0
}

/// Directions that share out a cap of the sphere about x, moved a little each (Fibonacci lattice).
fn scattered(count: u32, spread: f32, seed: u32) -> Vec<Vec3> {
    let depth = 1.0 - spread.clamp(0.0, PI).cos();
    let first = TAU * chance(seed, 0, 7);
    (0..count)
        .map(|i| {
            let jitter = 0.7 * (chance(seed, i, 1) - 0.5);
            let x = 1.0 - depth * (i as f32 + 0.5 + jitter) / count as f32;
            let angle = first + 2.399_963_2 * i as f32 + 0.9 * (chance(seed, i, 2) - 0.5);
            let across = (1.0 - x * x).max(0.0).sqrt();
            Vec3::new(x, across * angle.cos(), across * angle.sin())
        })
        .collect()
}

/// A star: spikes with hollow flanks on a ball.
fn add_flash(mesh: &mut BeamMesh, radius: f32, spikes: u32, spread: f32, seed: u32) {
    let ball = if spread < 3.0 { 0.1 } else { 0.2 };
    let mut directions = scattered(spikes, spread, seed);
    if spread < 3.0 {
        // A muzzle's flash is longest ahead.
        directions[0] = Vec3::X;
    }
    let (mut points, triangles) = sphere(6);
    // As wide as their share of the sphere, and no wider than looks sharp.
    let share = (2.0 * (1.0 - spread.max(0.3).cos()) / spikes as f32).sqrt();
    let width = (1.25 * share).clamp(0.16, 0.6);
    let lengths: Vec<f32> =
        (0..spikes).map(|i| if i == 0 { 1.0 } else { 0.42 + 0.5 * chance(seed, i, 3) }).collect();
    // A corner stands on each tip: it would be blunt else.
    for direction in &directions {
        let mut nearest = (0, -2.0);
        for (i, point) in points.iter().enumerate() {
            if point.dot(*direction) > nearest.1 {
                nearest = (i, point.dot(*direction));
            }
        }
        points[nearest.0] = *direction;
    }
    let base = mesh.positions.len() as u32;
    for point in points {
        let spikes: f32 = directions
            .iter()
            .zip(&lengths)
            .map(|(direction, length)| {
                let angle = (point - *direction).length();
                (1.0 - angle / width).max(0.0).powi(3) * (length - ball)
            })
            .fold(0.0, |sum, spike| sum + spike);
        mesh.positions.push(point * radius * (ball + spikes.min(1.0 - ball)));
        mesh.normals.push(point);
    }
    let mut own = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in &triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[(base + i) as usize]);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&i| own[(base + i) as usize] += normal);
    }
    // Halfway to those of the ball: spikes towards the eye would be holes in its middle.
    for (normal, own) in mesh.normals.iter_mut().zip(own).skip(base as usize) {
        *normal = (*normal + own.normalize_or_zero()).normalize_or(*normal);
    }
    mesh.indices.extend(triangles.iter().flatten().map(|i| base + i));
}

/// Balls round a ball.
fn add_burst(mesh: &mut BeamMesh, radius: f32, lobes: u32, seed: u32) {
    let (points, triangles) = sphere(4);
    let mut ball = |center: Vec3, own: f32| {
        let base = mesh.positions.len() as u32;
        mesh.positions.extend(points.iter().map(|p| center + *p * own));
        // Halfway to those of the whole, so that it is hotter in the middle.
        let whole = |p: Vec3| (p + 0.8 * (center + p * own) / radius).normalize_or(p);
        mesh.normals.extend(points.iter().map(|p| whole(*p)));
        mesh.indices.extend(triangles.iter().flatten().map(|i| base + i));
    };
    ball(Vec3::ZERO, 0.62 * radius);
    for (i, direction) in scattered(lobes, PI, seed).into_iter().enumerate() {
        let own = 0.2 + 0.26 * chance(seed, i as u32, 4);
        ball(direction * radius * (1.0 - own), radius * own);
    }
}

/// A unit sphere from an octahedron whose edges are halved so many times.
fn sphere(halvings: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut points = vec![Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..halvings {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |points: &mut Vec<Vec3>, a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize_or(Vec3::X));
                points.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let ab = middle(&mut points, a, b);
                let bc = middle(&mut points, b, c);
                let ca = middle(&mut points, c, a);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    (points, triangles)
}
