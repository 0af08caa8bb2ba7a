//! Which way hatching strokes run over a mesh at rest: one direction a vertex, smooth over the
//! surface, for the looks that need one.

use std::collections::HashMap;

use glam::{Mat3, Vec2, Vec3};

use super::{stroke_axes::between_borders, turning::turning};
use crate::scene::{Mesh, Primitive, Scene};
use crate::style::HatchDirection;

/// Strokes at a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Direction {
    /// Unit, across the normal.
    pub(crate) along: Vec3,
    /// How fast that turns over the surface, and the direction across it, in radians a unit of the
    /// mesh's space.
    pub(crate) turning: [f32; 2],
}

/// Where a mesh's directions come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Source {
    /// The surface's own bends.
    Curvature,
    /// The bones of a skin (its number).
    Bone(usize),
    /// The vertex attribute, else the bends.
    Painted,
}

impl Source {
    /// `None` for directions that pixels know by themselves.
    pub(crate) fn of(direction: HatchDirection, skin: Option<usize>) -> Option<Self> {
        match (direction, skin) {
            (HatchDirection::Light | HatchDirection::Fixed, _) => None,
            (HatchDirection::Bone, Some(skin)) => Some(Self::Bone(skin)),
            (HatchDirection::Painted, _) => Some(Self::Painted),
            (HatchDirection::Bone | HatchDirection::Curvature, _) => Some(Self::Curvature),
        }
    }
}

/// Directions by primitive and vertex, each primitive's from its own source; nothing for those
/// without one.
pub(crate) fn of_primitives(
    scene: &Scene,
    mesh: &Mesh,
    sources: &[Option<Source>],
) -> Vec<Vec<Direction>> {
    let mut known: HashMap<Source, Vec<Vec<Direction>>> = HashMap::new();
    let of = |(p, source): (usize, &Option<Source>)| {
        let source = (*source)?;
        let all = known.entry(source).or_insert_with(|| directions(scene, mesh, source));
        all.get_mut(p).map(std::mem::take)
    };
    sources.iter().enumerate().map(of).map(Option::unwrap_or_default).collect()
}

/// Radius over which bends are averaged, as a part of the mesh's diagonal.
const RADIUS: f32 = 0.04;
/// Rounds of averaging.
const MIN_ROUNDS: usize = 6;
const MAX_ROUNDS: usize = 60;

/// Most normals that are remembered of a place.
const MAX_NORMALS: usize = 16;
/// How far the normals of a flat part may be from their mean.
const FLAT_DEG: f32 = 6.0;

/// A line on the picture: the two ends are the same, so it is stored as d dᵀ, weighted.
type Tensor = [f32; 6];

fn tensor(d: Vec3, weight: f32) -> Tensor {
    [d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x].map(|x| x * weight)
}

fn add(sum: &mut Tensor, t: &Tensor, weight: f32) {
    for (s, t) in sum.iter_mut().zip(t) {
        *s += t * weight;
    }
}

/// Places of a mesh, whatever its primitives and seams; several where hard edges meet.
struct Places {
    /// By primitive and vertex.
    of: Vec<Vec<u32>>,
    positions: Vec<Vec3>,
    /// Unit, mean of all vertices there.
    normals: Vec<Vec3>,
    /// Ends of every triangle side.
    sides: Vec<[u32; 2]>,
}

/// Normals at one position that differ by less are of one surface, as on models of few flat faces
/// that stand for something round; between others lies an edge.
const HARD_DEG: f32 = 35.0;

impl Places {
    fn new(mesh: &Mesh) -> Self {
        // The places at each position, each with the normals seen there.
        let mut known: HashMap<[u32; 3], Vec<u32>> = HashMap::new();
        let mut seen: Vec<Vec<Vec3>> = Vec::new();
        let mut places =
            Self { of: Vec::new(), positions: Vec::new(), normals: Vec::new(), sides: Vec::new() };
        let limit = HARD_DEG.to_radians().cos();
        for primitive in &mesh.primitives {
            let mut of = Vec::with_capacity(primitive.positions.len());
            for (p, n) in primitive.positions.iter().zip(&primitive.normals) {
                // Both zeros are one place.
                let key = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
                let here = known.entry(key).or_default();
                let near = |place: &&u32| seen[**place as usize].iter().any(|m| m.dot(*n) > limit);
                let place = here.iter().find(near).copied().unwrap_or_else(|| {
                    let place = places.positions.len() as u32;
                    places.positions.push(*p);
                    places.normals.push(Vec3::ZERO);
                    seen.push(Vec::new());
                    here.push(place);
                    place
                });
                places.normals[place as usize] += *n;
                let normals = &mut seen[place as usize];
                if normals.len() < MAX_NORMALS && !normals.contains(n) {
                    normals.push(*n);
                }
                of.push(place);
            }
            for corners in primitive.indices.chunks_exact(3) {
                for i in 0..3 {
                    let ends = [corners[i], corners[(i + 1) % 3]].map(|v| of[v as usize]);
                    if ends[0] != ends[1] {
                        places.sides.push(ends);
                    }
                }
            }
            places.of.push(of);
        }
        for n in &mut places.normals {
            *n = n.normalize_or(Vec3::Y);
        }
        places
    }

    /// For each place the number of its part: parts hang together without hard edges.
    fn parts(&self) -> Vec<usize> {
        let mut parts: Vec<usize> = (0..self.positions.len()).collect();
        fn root(parts: &mut [usize], mut v: usize) -> usize {
            while parts[v] != v {
                parts[v] = parts[parts[v]];
                v = parts[v];
            }
            v
        }
        for &[a, b] in &self.sides {
            let (a, b) = (root(&mut parts, a as usize), root(&mut parts, b as usize));
            parts[a.max(b)] = a.min(b);
        }
        (0..parts.len()).map(|v| root(&mut parts, v)).collect()
    }

    /// One direction for each flat part, by the place: that of its outline's longer sides, else
    /// `prior`'s. `None` elsewhere: there the surface bends.
    fn flat(&self, prior: &[Vec3]) -> Vec<Option<Vec3>> {
        let parts = self.parts();
        let count = self.positions.len();
        let mut normals = vec![Vec3::ZERO; count];
        for (&part, n) in parts.iter().zip(&self.normals) {
            normals[part] += *n;
        }
        let mut is_flat = vec![true; count];
        let limit = FLAT_DEG.to_radians().cos();
        for (v, &part) in parts.iter().enumerate() {
            is_flat[part] &= self.normals[v].dot(normals[part].normalize_or_zero()) > limit;
        }
        let mut uses: HashMap<[u32; 2], u32> = HashMap::new();
        for &[a, b] in &self.sides {
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
        let mut outlines = vec![[0.0; 6]; count];
        let mut lengths = vec![0.0; count];
        let mut edges: Vec<[u32; 2]> =
            uses.iter().filter(|(_, uses)| **uses == 1).map(|(&edge, _)| edge).collect();
        // A map has no order, and sums of floats have.
        edges.sort_unstable();
        for [a, b] in edges {
            let part = parts[a as usize];
            if is_flat[part] {
                let step = self.positions[b as usize] - self.positions[a as usize];
                let length = step.length();
                add(&mut outlines[part], &tensor(step.normalize_or_zero(), length), 1.0);
                lengths[part] += length;
            }
        }
        for (v, &part) in parts.iter().enumerate() {
            if v == part {
                add(&mut outlines[v], &tensor(prior[v], 0.1 * lengths[v].max(1e-12)), 1.0);
            }
        }
        let mut of_parts: HashMap<usize, Vec3> = HashMap::new();
        let mut of = |&part: &usize| {
            let n = normals[part].normalize_or(Vec3::Y);
            let of_part = || between_borders(strongest(&outlines[part], n), n);
            is_flat[part].then(|| *of_parts.entry(part).or_insert_with(of_part))
        };
        parts.iter().map(&mut of).collect()
    }

    /// How much and which way the surface bends at each place: the second fundamental form that fits
    /// the sides there best (a side's normal curvature is Δn·Δp / |Δp|²), as |κ1| e1 e1ᵀ +
    /// |κ2| e2 e2ᵀ. With a little of `prior`, which decides where all directions are alike.
    fn bends(&self, prior: &[Vec3]) -> Vec<Tensor> {
        // Normal equations of κ = x² a + 2 x y b + y² c: six sums on the left, three on the right.
        let mut sums = vec![([0.0_f32; 6], [0.0_f32; 3]); self.positions.len()];
        for &[a, b] in &self.sides {
            let step = self.positions[b as usize] - self.positions[a as usize];
            let turn = self.normals[b as usize] - self.normals[a as usize];
            let length = step.length().max(1e-12);
            let curvature = turn.dot(step) / (length * length);
            for v in [a, b] {
                let (e, f) = self.normals[v as usize].any_orthonormal_pair();
                let along = Vec2::new(e.dot(step), f.dot(step)).normalize_or_zero();
                let x = [along.x * along.x, 2.0 * along.x * along.y, along.y * along.y];
                let (left, right) = &mut sums[v as usize];
                let products =
                    [x[0] * x[0], x[1] * x[1], x[2] * x[2], x[0] * x[1], x[1] * x[2], x[2] * x[0]];
                for (sum, product) in left.iter_mut().zip(products) {
                    *sum += length * product;
                }
                for (sum, x) in right.iter_mut().zip(x) {
                    *sum += length * curvature * x;
                }
            }
        }
        let mut bends: Vec<Tensor> = sums
            .iter()
            .zip(&self.normals)
            .map(|((left, right), n)| {
                // Where the sides leave something open it stays small.
                let ridge = 1e-3 * (left[0] + left[1] + left[2]).max(1e-12);
                let m = Mat3::from_cols(
                    Vec3::new(left[0] + ridge, left[3], left[5]),
                    Vec3::new(left[3], left[1] + ridge, left[4]),
                    Vec3::new(left[5], left[4], left[2] + ridge),
                );
                let form = m.inverse() * Vec3::from(*right);
                let (e, f) = n.any_orthonormal_pair();
                let angle = 0.5 * (2.0 * form.y).atan2(form.x - form.z);
                let (sin, cos) = angle.sin_cos();
                let ways = [e * cos + f * sin, f * cos - e * sin];
                let mean = 0.5 * (form.x + form.z);
                let half = (0.5 * (form.x - form.z)).hypot(form.y);
                let mut t = tensor(ways[0], (mean + half).abs());
                add(&mut t, &tensor(ways[1], (mean - half).abs()), 1.0);
                if t.iter().all(|x| x.is_finite()) { t } else { [0.0; 6] }
            })
            .collect();
        let size = |t: &Tensor| t[0] + t[1] + t[2];
        let all = bends.iter().map(size).sum::<f32>() / bends.len().max(1) as f32;
        for ((t, n), prior) in bends.iter_mut().zip(&self.normals).zip(prior) {
            // One sharp fold may not rule its neighbourhood.
            let limit = 3.0 * all;
            if size(t) > limit {
                let factor = limit / size(t);
                t.iter_mut().for_each(|x| *x *= factor);
            }
            let wanted = (*prior - *n * n.dot(*prior)).normalize_or_zero();
            add(t, &tensor(wanted, 0.2 * all.max(1e-12)), 1.0);
        }
        bends
    }

    /// Averages over neighbours.
    fn smooth(&self, values: &mut Vec<Tensor>) {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for p in &self.positions {
            (low, high) = (low.min(*p), high.max(*p));
        }
        let length =
            |&[a, b]: &[u32; 2]| self.positions[a as usize].distance(self.positions[b as usize]);
        let mean = self.sides.iter().map(length).sum::<f32>() / self.sides.len().max(1) as f32;
        let steps = RADIUS * low.distance(high) / mean.max(1e-12);
        // A walk of n steps goes √n far.
        let rounds = ((steps * steps).ceil() as usize).clamp(MIN_ROUNDS, MAX_ROUNDS);
        for _ in 0..rounds {
            let mut sums = values.clone();
            let mut counts = vec![1.0_f32; values.len()];
            for &[a, b] in &self.sides {
                let (a, b) = (a as usize, b as usize);
                add(&mut sums[a], &values[b], 1.0);
                add(&mut sums[b], &values[a], 1.0);
                counts[a] += 1.0;
                counts[b] += 1.0;
            }
            for (sum, count) in sums.iter_mut().zip(&counts) {
                sum.iter_mut().for_each(|x| *x /= count);
            }
            *values = sums;
        }
    }
}

/// The strongest direction across a unit vector.
fn strongest(t: &Tensor, n: Vec3) -> Vec3 {
    let (u, v) = n.any_orthonormal_pair();
    let m = Mat3::from_cols(
        Vec3::new(t[0], t[3], t[5]),
        Vec3::new(t[3], t[1], t[4]),
        Vec3::new(t[5], t[4], t[2]),
    );
    let (a, b, c) = (u.dot(m * u), u.dot(m * v), v.dot(m * v));
    let angle = 0.5 * (2.0 * b).atan2(a - c);
    u * angle.cos() + v * angle.sin()
}

/// Directions of the strokes of a mesh, by primitive and vertex.
fn directions(scene: &Scene, mesh: &Mesh, source: Source) -> Vec<Vec<Direction>> {
    let places = Places::new(mesh);
    let count = places.positions.len();
    // Round the vertical, where nothing else is known, and to the side on what lies level.
    let mut wanted: Vec<Vec3> =
        places.normals.iter().map(|n| Vec3::Y.cross(*n) + 0.01 * Vec3::X).collect();
    let mut given = vec![Vec3::ZERO; count];
    for (primitive, of) in mesh.primitives.iter().zip(&places.of) {
        for (v, &place) in of.iter().enumerate() {
            given[place as usize] += match source {
                Source::Curvature => Vec3::ZERO,
                Source::Painted => primitive.hatch_directions.get(v).copied().unwrap_or_default(),
                Source::Bone(skin) => {
                    bone_direction(scene, skin, primitive, v).cross(places.normals[place as usize])
                }
            };
        }
    }
    let mut values = match source {
        Source::Bone(_) => vec![[0.0; 6]; count],
        Source::Curvature | Source::Painted => places.bends(&wanted),
    };
    if let Source::Bone(_) = source {
        for ((t, d), w) in values.iter_mut().zip(&given).zip(&wanted) {
            let d = if d.length() > 1e-6 { d.normalize() } else { 0.1 * *w };
            *t = tensor(d, 1.0);
        }
    }
    places.smooth(&mut values);
    let flat = match source {
        Source::Bone(_) => vec![None; count],
        Source::Curvature | Source::Painted => places.flat(&wanted),
    };
    for (v, direction) in wanted.iter_mut().enumerate() {
        *direction = flat[v].unwrap_or_else(|| strongest(&values[v], places.normals[v]));
    }
    for ((direction, given), n) in wanted.iter_mut().zip(&given).zip(&places.normals) {
        let painted = *given - *n * n.dot(*given);
        if source == Source::Painted && painted.length() > 1e-6 {
            *direction = painted.normalize();
        }
    }
    let across: Vec<Vec3> = places.normals.iter().zip(&wanted).map(|(n, d)| n.cross(*d)).collect();
    let triangles = || {
        mesh.primitives.iter().zip(&places.of).flat_map(|(primitive, of)| {
            let corners = |t: &[u32]| [0, 1, 2].map(|i| of[t[i] as usize]);
            primitive.indices.chunks_exact(3).map(corners)
        })
    };
    let turning_of = |lines: &[Vec3]| turning(&places.positions, lines, triangles());
    let (turning, across) = (turning_of(&wanted), turning_of(&across));
    let of_place = |&p: &u32| {
        let p = p as usize;
        Direction { along: wanted[p], turning: [turning[p], across[p]] }
    };
    places.of.iter().map(|of| of.iter().map(of_place).collect()).collect()
}

/// From the joint that moves a vertex most to its child, at rest; 0 if there is none.
fn bone_direction(scene: &Scene, skin: usize, primitive: &Primitive, vertex: usize) -> Vec3 {
    let (Some(joints), Some(weights)) =
        (primitive.joints.get(vertex), primitive.weights.get(vertex))
    else {
        return Vec3::ZERO;
    };
    let skin = &scene.skins[skin];
    let strongest = (0..4).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
    let joint = usize::from(joints[strongest]);
    let place = |joint: usize| -> Option<Vec3> {
        let rest_from_joint = skin.joint_from_mesh.get(joint)?.inverse();
        Some(rest_from_joint.translation.into())
    };
    let (Some(&node), Some(from)) = (skin.joints.get(joint), place(joint)) else {
        return Vec3::ZERO;
    };
    let children = &scene.nodes[node].children;
    let child = skin.joints.iter().position(|node| children.contains(node));
    let parent = || skin.joints.iter().position(|&n| scene.nodes[n].children.contains(&node));
    match (child.and_then(place), parent().and_then(place)) {
        (Some(to), _) => to - from,
        // The last joint of a limb goes on like the one before.
        (None, Some(before)) => from - before,
        (None, None) => Vec3::ZERO,
    }
    .normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::prepare::stroke_axes::{LEAD, lead};
    use crate::shapes;

    #[test]
    fn strokes_run_round_a_cylinder_and_along_what_is_painted() {
        let mut primitive = shapes::cylinder(48, 0.3, 2.0);
        let mesh =
            |primitive: &Primitive| Mesh { primitives: vec![primitive.clone()], ..Mesh::default() };
        let scene = Scene::default();
        let on_side = |p: &Primitive, v: usize| p.normals[v].y.abs() < 0.01;
        let sources = [Some(Source::Curvature)];
        let round = of_primitives(&scene, &mesh(&primitive), &sources).remove(0);
        for v in (0..round.len()).filter(|&v| on_side(&primitive, v)) {
            assert!((round[v].along.length() - 1.0).abs() < 1e-4);
            assert!(round[v].along.y.abs() < 0.5, "{v}: {:?}", round[v]);
        }
        // Strokes round it turn with it, and what is across them does not turn.
        let turning = round[(0..round.len()).find(|&v| on_side(&primitive, v)).unwrap()].turning;
        assert!(turning[0] > 2.0 && turning[1] < 0.3 * turning[0], "{turning:?}");
        primitive.hatch_directions = vec![Vec3::Y * 3.0; primitive.positions.len()];
        let sources = [Some(Source::Painted)];
        let painted = of_primitives(&scene, &mesh(&primitive), &sources).remove(0);
        for v in (0..painted.len()).filter(|&v| on_side(&primitive, v)) {
            assert!(painted[v].along.y.abs() > 0.5, "{v}: {:?}", painted[v]);
        }
        assert!(of_primitives(&scene, &mesh(&primitive), &[None]).remove(0).is_empty());
    }

    #[test]
    fn each_side_of_a_box_has_one_direction_along_its_longer_edges() {
        for turn in
            [glam::Quat::IDENTITY, glam::Quat::from_euler(glam::EulerRot::XYZ, 0.7, 0.4, 1.1)]
        {
            let mut primitive = shapes::cuboid(Vec3::new(3.0, 1.0, 2.0));
            for v in primitive.positions.iter_mut().chain(&mut primitive.normals) {
                *v = turn * *v;
            }
            let mesh = Mesh { primitives: vec![primitive.clone()], ..Mesh::default() };
            let sources = [Some(Source::Curvature)];
            let found = of_primitives(&Scene::default(), &mesh, &sources).remove(0);
            for (v, n) in primitive.normals.iter().enumerate() {
                let own = turn.inverse() * *n;
                let longer = turn * if own.x.abs() > 0.5 { Vec3::Z } else { Vec3::X };
                let cosine = found[v].along.dot(longer).abs();
                // In the mesh's own axes, strokes are parallel to edges; else next to them.
                let least = if turn == glam::Quat::IDENTITY { 0.9999 } else { 0.93 };
                assert!(cosine > least, "{own}: {cosine}");
                assert!(lead(n.cross(found[v].along)) > LEAD);
                let same = |&w: &usize| primitive.normals[w] == *n;
                let mut others = (0..found.len()).filter(same);
                assert!(others.all(|w| found[w] == found[v]));
            }
        }
    }

    #[test]
    fn flat_faces_that_stand_for_something_round_are_hatched_as_such() {
        // Twelve flat sides, 30° from each other.
        let mut primitive = Primitive::default();
        for i in 0..12_u32 {
            let at = |i: u32, y: f32| {
                let (sin, cos) = (i as f32 * std::f32::consts::TAU / 12.0).sin_cos();
                Vec3::new(sin, y, cos)
            };
            let corners = [at(i, -0.4), at((i + 1) % 12, -0.4), at((i + 1) % 12, 0.4), at(i, 0.4)];
            let n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
            primitive.positions.extend(corners);
            primitive.normals.extend([n; 4]);
            primitive.indices.extend([0, 1, 2, 0, 2, 3].map(|k| 4 * i + k));
        }
        let mesh = Mesh { primitives: vec![primitive], ..Mesh::default() };
        let round = of_primitives(&Scene::default(), &mesh, &[Some(Source::Curvature)]).remove(0);
        // Though each side is higher than wide.
        assert!(round.iter().all(|d| d.along.y.abs() < 0.3), "{round:?}");
    }
}
