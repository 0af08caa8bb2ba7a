//! Which way hatching strokes run over a mesh at rest: one direction a vertex, smooth over the
//! surface, for the looks that need one.

use std::collections::HashMap;

use glam::{Mat3, Vec2, Vec3};

use crate::scene::{Mesh, Primitive, Scene};
use crate::style::HatchDirection;

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
) -> Vec<Vec<Vec3>> {
    let mut known: HashMap<Source, Vec<Vec<Vec3>>> = HashMap::new();
    let of = |(p, source): (usize, &Option<Source>)| {
        let source = (*source)?;
        let all = known.entry(source).or_insert_with(|| directions(scene, mesh, source));
        all.get_mut(p).map(std::mem::take)
    };
    sources.iter().enumerate().map(of).map(Option::unwrap_or_default).collect()
}

/// Radius over which bends are averaged, as a part of the mesh's diagonal.
const RADIUS: f32 = 0.04;
/// Most rounds of averaging.
const MAX_ROUNDS: usize = 60;

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

/// Places of a mesh, whatever its primitives and seams.
struct Places {
    /// By primitive and vertex.
    of: Vec<Vec<u32>>,
    positions: Vec<Vec3>,
    /// Unit, mean of all vertices there.
    normals: Vec<Vec3>,
    /// Ends of every triangle side.
    sides: Vec<[u32; 2]>,
}

impl Places {
    fn new(mesh: &Mesh) -> Self {
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        let mut places =
            Self { of: Vec::new(), positions: Vec::new(), normals: Vec::new(), sides: Vec::new() };
        for primitive in &mesh.primitives {
            let mut of = Vec::with_capacity(primitive.positions.len());
            for (p, n) in primitive.positions.iter().zip(&primitive.normals) {
                // Both zeros are one place.
                let key = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
                let place = *known.entry(key).or_insert(places.positions.len() as u32);
                if place as usize == places.positions.len() {
                    places.positions.push(*p);
                    places.normals.push(Vec3::ZERO);
                }
                places.normals[place as usize] += *n;
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
        let rounds = ((steps * steps).ceil() as usize).clamp(2, MAX_ROUNDS);
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

    /// The strongest direction of each place in its tangent plane.
    fn strongest(&self, values: &[Tensor]) -> Vec<Vec3> {
        let of = |(t, n): (&Tensor, &Vec3)| {
            let (u, v) = n.any_orthonormal_pair();
            let m = Mat3::from_cols(
                Vec3::new(t[0], t[3], t[5]),
                Vec3::new(t[3], t[1], t[4]),
                Vec3::new(t[5], t[4], t[2]),
            );
            let (a, b, c) = (u.dot(m * u), u.dot(m * v), v.dot(m * v));
            let angle = 0.5 * (2.0 * b).atan2(a - c);
            u * angle.cos() + v * angle.sin()
        };
        values.iter().zip(&self.normals).map(of).collect()
    }

    /// Gives neighbours the same end of their lines, as far as the surface allows it: directions
    /// are interpolated over triangles.
    fn align(&self, directions: &mut [Vec3]) {
        let mut first = vec![0_u32; directions.len() + 1];
        for side in &self.sides {
            side.iter().for_each(|&v| first[v as usize + 1] += 1);
        }
        for i in 0..directions.len() {
            first[i + 1] += first[i];
        }
        let mut next = first.clone();
        let mut neighbours = vec![0_u32; 2 * self.sides.len()];
        for &[a, b] in &self.sides {
            for (from, to) in [(a, b), (b, a)] {
                let at = &mut next[from as usize];
                neighbours[*at as usize] = to;
                *at += 1;
            }
        }
        let mut seen = vec![false; directions.len()];
        let mut queue = std::collections::VecDeque::new();
        for start in 0..directions.len() {
            if std::mem::replace(&mut seen[start], true) {
                continue;
            }
            queue.push_back(start);
            while let Some(v) = queue.pop_front() {
                for &w in &neighbours[first[v] as usize..first[v + 1] as usize] {
                    let w = w as usize;
                    if std::mem::replace(&mut seen[w], true) {
                        continue;
                    }
                    if directions[v].dot(directions[w]) < 0.0 {
                        directions[w] = -directions[w];
                    }
                    queue.push_back(w);
                }
            }
        }
    }
}

/// Unit directions of the strokes of a mesh, by primitive and vertex, across the normals.
fn directions(scene: &Scene, mesh: &Mesh, source: Source) -> Vec<Vec<Vec3>> {
    let places = Places::new(mesh);
    let count = places.positions.len();
    // Round the vertical, where nothing else is known.
    let mut wanted: Vec<Vec3> = places.normals.iter().map(|n| Vec3::Y.cross(*n)).collect();
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
    wanted = places.strongest(&values);
    for ((direction, given), n) in wanted.iter_mut().zip(&given).zip(&places.normals) {
        let painted = *given - *n * n.dot(*given);
        if source == Source::Painted && painted.length() > 1e-6 {
            *direction = painted.normalize();
        }
    }
    places.align(&mut wanted);
    places.of.iter().map(|of| of.iter().map(|&p| wanted[p as usize]).collect()).collect()
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
            assert!((round[v].length() - 1.0).abs() < 1e-4);
            assert!(round[v].y.abs() < 0.5, "{v}: {}", round[v]);
        }
        primitive.hatch_directions = vec![Vec3::Y * 3.0; primitive.positions.len()];
        let sources = [Some(Source::Painted)];
        let painted = of_primitives(&scene, &mesh(&primitive), &sources).remove(0);
        for v in (0..painted.len()).filter(|&v| on_side(&primitive, v)) {
            assert!(painted[v].y.abs() > 0.5, "{v}: {}", painted[v]);
        }
        assert!(of_primitives(&scene, &mesh(&primitive), &[None]).remove(0).is_empty());
    }
}
