//! Borders of materials: smooth curves on a mesh that its edges follow exactly, and raised
//! regions with walls round them.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::field::{Field, gradient, project};
use super::mesh::{Mesh, prev};
use super::remesh::stays_flat;
use super::sweep::Part;

/// How often normals are mixed with their neighbours'.
const NORMAL_ROUNDS: usize = 2;

/// A part of the surface with a material of its own.
pub(in crate::models) struct Region<'a> {
    /// Negative within the region. The first region that holds a place has it.
    pub(in crate::models) inside: &'a dyn Field,
    /// The region's own surface, which has its normals.
    pub(in crate::models) surface: &'a dyn Field,
    /// Whether that surface lies off the sculpted one, so that walls must join the two.
    pub(in crate::models) raised: bool,
}

/// A mesh whose triangles belong to one region each.
pub(in crate::models) struct Imprinted {
    mesh: Mesh,
    /// Per vertex, a bit for each region on whose border it lies.
    borders: Vec<u32>,
    /// Per triangle, the index of its region.
    labels: Vec<usize>,
}

/// Cuts the borders of the regions into a mesh of `field`'s surface. The last region is what
/// the others leave; its `inside` is not asked.
pub(in crate::models) fn imprint(
    mut mesh: Mesh,
    field: &dyn Field,
    regions: &[Region<'_>],
    length: &dyn Fn(DVec3) -> f64,
) -> Imprinted {
    let mut borders = vec![0u32; mesh.points.len()];
    let rest = regions.len() - 1;
    for (k, region) in regions[..rest].iter().enumerate() {
        let bit = 1 << k;
        let mut g: Vec<f64> = mesh.points.iter().map(|&p| region.inside.at(p)).collect();
        // What lies under an earlier region needs no border.
        let hidden = |p: DVec3| regions[..k].iter().any(|r| r.inside.at(p) < -0.002);
        let crosses = |mesh: &Mesh, borders: &[u32], g: &[f64], h: u32| {
            let (a, b) = (mesh.from(h) as usize, mesh.to(h) as usize);
            let on = (borders[a] | borders[b]) & bit != 0;
            let opposite = (g[a] < 0.0) != (g[b] < 0.0);
            (!on && opposite && !hidden((mesh.points[a] + mesh.points[b]) / 2.0))
                .then(|| g[a] / (g[a] - g[b]))
        };
        // Vertices near the border go onto it.
        for h in 0..mesh.half_edges() {
            let Some(t) = crosses(&mesh, &borders, &g, h) else { continue };
            let v = mesh.from(h) as usize;
            if t < 0.34 && borders[v] == 0 {
                let p = mesh.points[v].lerp(mesh.point(mesh.to(h)), t);
                mesh.points[v] = onto_border(p, field, region.inside);
                borders[v] = bit;
                g[v] = 0.0;
            }
        }
        // Splitting gives sides of the two triangles new numbers, so those are looked at as well.
        let mut h = 0;
        while h < mesh.half_edges() {
            if let Some(t) = crosses(&mesh, &borders, &g, h) {
                let (a, b) = (mesh.from(h), mesh.to(h));
                let p = mesh.point(a).lerp(mesh.point(b), t.clamp(0.05, 0.95));
                let both = borders[a as usize] & borders[b as usize];
                mesh.split(h, onto_border(p, field, region.inside));
                borders.push(bit | both);
                g.push(0.0);
            }
            h += 1;
        }
    }
    let (mesh, borders) = without_short_edges(mesh, borders, length);
    let labels = label(&mesh, &borders, regions);
    Imprinted { mesh, borders, labels }
}

/// Collapses what cutting left much too short, off the borders or along one.
fn without_short_edges(
    mut mesh: Mesh,
    borders: Vec<u32>,
    length: &dyn Fn(DVec3) -> f64,
) -> (Mesh, Vec<u32>) {
    for h in 0..mesh.half_edges() {
        if mesh.is_gone(h) {
            continue;
        }
        let (a, b) = (mesh.from(h), mesh.to(h));
        let (from, to) = (mesh.point(a), mesh.point(b));
        let (of_a, of_b) = (borders[a as usize], borders[b as usize]);
        let may_go = of_a == 0 || (of_a == of_b && of_a.count_ones() == 1);
        let wanted = length(to);
        if may_go && from.distance(to) < 0.42 * wanted {
            mesh.collapse(h, to, 2.0 * wanted);
        }
    }
    let (mesh, old) = mesh.compact();
    let borders = old.into_iter().map(|v| borders[v]).collect();
    (mesh, borders)
}

/// The point nearby that lies on the surface and on the border.
fn onto_border(mut p: DVec3, field: &dyn Field, inside: &dyn Field) -> DVec3 {
    for _ in 0..6 {
        let normal = gradient(field, p).normalize_or_zero();
        let g = gradient(inside, p);
        let along = g - normal * g.dot(normal);
        let step = along * (inside.at(p) / along.length_squared().max(0.05));
        p -= step.clamp_length_max(0.01);
        p = project(field, p);
    }
    p
}

fn label(mesh: &Mesh, borders: &[u32], regions: &[Region<'_>]) -> Vec<usize> {
    let triangles = mesh.corners.chunks_exact(3);
    triangles
        .map(|corners| {
            let holds = |k: usize| {
                let free = corners.iter().filter(|&&v| borders[v as usize] & (1 << k) == 0);
                let mut count = 0;
                let sum: f64 = free
                    .map(|&v| {
                        count += 1;
                        regions[k].inside.at(mesh.point(v))
                    })
                    .sum();
                if count > 0 {
                    return sum < 0.0;
                }
                let mean: DVec3 = corners.iter().map(|&v| mesh.point(v)).sum::<DVec3>() / 3.0;
                regions[k].inside.at(mean) < 0.0
            };
            (0..regions.len() - 1).find(|&k| holds(k)).unwrap_or(regions.len() - 1)
        })
        .collect()
}

/// Evens out the triangles near the borders; border vertices stay on their border.
pub(in crate::models) fn relax(
    imprinted: &mut Imprinted,
    field: &dyn Field,
    regions: &[Region<'_>],
    rounds: usize,
) {
    let Imprinted { mesh, borders, labels } = imprinted;
    for _ in 0..rounds {
        flip_slivers(mesh, labels);
        // Border edges: those between two regions.
        let mut on_border: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for h in 0..mesh.half_edges() {
            if labels[h as usize / 3] != labels[mesh.twin(h) as usize / 3] {
                on_border.entry(mesh.from(h)).or_default().push(mesh.to(h));
            }
        }
        let mut moved = mesh.smoothed(0.6, &|v| !on_border.contains_key(&(v as u32)));
        for (&v, neighbors) in &on_border {
            let bits = borders[v as usize];
            if let &[a, b] = neighbors.as_slice()
                && bits.count_ones() == 1
            {
                let p = mesh.point(v);
                let middle = (mesh.point(a) + mesh.point(b)) / 2.0;
                let inside = regions[bits.trailing_zeros() as usize].inside;
                moved[v as usize] = onto_border(p.lerp(middle, 0.5), field, inside);
            }
        }
        for (v, point) in moved.iter_mut().enumerate() {
            if !on_border.contains_key(&(v as u32)) {
                *point = project(field, *point);
            }
        }
        mesh.points = moved;
    }
    flip_slivers(mesh, labels);
}

/// Flips edges within a region where that makes the smallest angle larger.
fn flip_slivers(mesh: &mut Mesh, labels: &[usize]) {
    for _ in 0..2 {
        for h in 0..mesh.half_edges() {
            let g = mesh.twin(h);
            if h > g || labels[h as usize / 3] != labels[g as usize / 3] {
                continue;
            }
            let [a, b] = [mesh.point(mesh.from(h)), mesh.point(mesh.to(h))];
            let [c, d] = [mesh.point(mesh.from(prev(h))), mesh.point(mesh.from(prev(g)))];
            let before = quality(a, b, c).min(quality(b, a, d));
            let after = quality(d, c, a).min(quality(c, d, b));
            if after > before * 1.05 && stays_flat(mesh, h) {
                mesh.flip(h);
            }
        }
    }
}

/// Twice the root of 3 times area over the sum of squared sides: 1 for an equilateral triangle,
/// 0 for a sliver.
pub(super) fn quality(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let area = (b - a).cross(c - a).length();
    let sides = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    2.0 * 3f64.sqrt() * area / sides.max(1e-30)
}

/// The way down a vertex from region `i` to region `j`, by way of the levels between.
fn descent(levels: &[(usize, DVec3)], i: usize, j: usize) -> Vec<DVec3> {
    let of = |region: usize| levels.iter().find(|(r, _)| *r == region).map(|(_, p)| *p);
    let (Some(top), Some(foot)) = (of(i), of(j)) else { return Vec::new() };
    let way = foot - top;
    let part = |p: DVec3| (p - top).dot(way) / way.length_squared().max(1e-30);
    let between = |t: f64| t > 1e-3 && t < 1.0 - 1e-3;
    let mut inner: Vec<DVec3> =
        levels.iter().map(|&(_, p)| p).filter(|&p| between(part(p))).collect();
    inner.sort_by(|&a, &b| part(a).total_cmp(&part(b)));
    inner.dedup();
    if top == foot {
        return vec![top];
    }
    std::iter::once(top).chain(inner).chain([foot]).collect()
}

impl Imprinted {
    /// One part for each region, each vertex on its region's own surface; where two surfaces lie
    /// apart, the outer one has a wall down to the other.
    pub(in crate::models) fn parts(&self, regions: &[Region<'_>]) -> Vec<Part> {
        let mut parts: Vec<Part> = regions.iter().map(|_| Part::default()).collect();
        let mut vertices: BTreeMap<(u32, usize), u32> = BTreeMap::new();
        let neighbors = self.neighbors();
        let smooth: Vec<_> =
            (0..regions.len()).map(|k| self.smooth_region(&neighbors, regions, k)).collect();
        for (h, &v) in self.mesh.corners.iter().enumerate() {
            let label = self.labels[h / 3];
            let part = &mut parts[label];
            let index = *vertices.entry((v, label)).or_insert_with(|| {
                let (p, normal) = smooth[label][&(v as usize)];
                part.sources.push(v);
                part.push(p, normal)
            });
            part.indices.push(index);
        }
        // The levels of each vertex, as (region, place).
        let mut levels: BTreeMap<u32, Vec<(usize, DVec3)>> = BTreeMap::new();
        for (&(v, label), &index) in &vertices {
            levels.entry(v).or_default().push((label, parts[label].positions[index as usize]));
        }
        let mut walls = Vec::new();
        for h in 0..self.mesh.half_edges() {
            let (i, j) = (self.labels[h as usize / 3], self.labels[self.mesh.twin(h) as usize / 3]);
            if i == j || !regions[i].raised {
                continue;
            }
            let (a, b) = (self.mesh.from(h), self.mesh.to(h));
            let [down_a, down_b] = [a, b].map(|v| descent(&levels[&v], i, j));
            let up = gradient(regions[i].surface, down_a[0]);
            let drop = down_a[0] - down_a[down_a.len() - 1] + down_b[0] - down_b[down_b.len() - 1];
            let outer = if regions[j].raised { drop.dot(up) > 0.0 } else { true };
            if outer {
                walls.push((a, b, i, down_a, down_b));
            }
        }
        // A wall's normal at a vertex is the mean of the walls that meet there.
        let mut normals: BTreeMap<(u32, usize), DVec3> = BTreeMap::new();
        for (a, b, i, down_a, down_b) in &walls {
            let foot = down_a[down_a.len() - 1] - down_a[0] + down_b[down_b.len() - 1] - down_b[0];
            let normal = (down_a[0] - down_b[0]).cross(foot).normalize_or_zero();
            for v in [a, b] {
                *normals.entry((*v, *i)).or_default() += normal;
            }
        }
        let mut corners: BTreeMap<(u32, usize, [u64; 3]), u32> = BTreeMap::new();
        for (a, b, i, down_a, down_b) in walls {
            let mut corner = |v: u32, p: DVec3| {
                let bits = p.to_array().map(f64::to_bits);
                *corners.entry((v, i, bits)).or_insert_with(|| {
                    parts[i].sources.push(v);
                    parts[i].push(p, normals[&(v, i)].normalize_or_zero())
                })
            };
            let left: Vec<u32> = down_a.iter().map(|&p| corner(a, p)).collect();
            let right: Vec<u32> = down_b.iter().map(|&p| corner(b, p)).collect();
            // Down both sides like a zip.
            let (mut l, mut r) = (0, 0);
            while l + 1 < left.len() || r + 1 < right.len() {
                if l + 1 < left.len() && (l <= r || r + 1 == right.len()) {
                    parts[i].indices.extend([right[r], left[l], left[l + 1]]);
                    l += 1;
                } else {
                    parts[i].indices.extend([right[r], left[l], right[r + 1]]);
                    r += 1;
                }
            }
        }
        parts
    }

    /// The vertices that each vertex has an edge to.
    fn neighbors(&self) -> Vec<Vec<usize>> {
        let mut neighbors = vec![Vec::new(); self.mesh.points.len()];
        for h in 0..self.mesh.half_edges() {
            neighbors[self.mesh.from(h) as usize].push(self.mesh.to(h) as usize);
        }
        neighbors
    }

    /// Place and normal of each vertex of a region, on the region's own surface.
    ///
    /// A field turns more sharply in furrows than edges can follow, and tones would end in teeth
    /// there. So normals are those of the triangles, mixed with their neighbours', on the region's
    /// own surface also beyond its border: no hard edge is rounded off, and regions of one surface
    /// agree on it. Lines follow these normals, so they may not stray far from the triangles.
    fn smooth_region(
        &self,
        neighbors: &[Vec<usize>],
        regions: &[Region<'_>],
        label: usize,
    ) -> BTreeMap<usize, (DVec3, DVec3)> {
        let Region { surface, raised, .. } = regions[label];
        let place = |v: usize| {
            let p = self.mesh.points[v];
            let off = if raised { project(surface, p) } else { p };
            // Where the surfaces meet there is no wall.
            let p = if off.distance(p) < 2.5e-4 { p } else { off };
            (p, gradient(surface, p).normalize_or_zero())
        };
        let corners = self.mesh.corners.iter().enumerate();
        let own = corners.filter(|(h, _)| self.labels[h / 3] == label).map(|(_, &v)| v as usize);
        let mut found: BTreeMap<usize, (DVec3, DVec3)> = BTreeMap::new();
        let mut ring: BTreeSet<usize> = own.collect();
        for _ in 0..NORMAL_ROUNDS + 3 {
            found.extend(ring.iter().map(|&v| (v, place(v))));
            let near = ring.iter().flat_map(|&v| &neighbors[v]).copied();
            ring = near.filter(|v| !found.contains_key(v)).collect();
        }
        let mut sums: BTreeMap<usize, DVec3> = BTreeMap::new();
        for t in self.mesh.corners.chunks_exact(3) {
            let corners = [0, 1, 2].map(|i| t[i] as usize);
            if let [Some(a), Some(b), Some(c)] = corners.map(|v| found.get(&v)) {
                let normal = (b.0 - a.0).cross(c.0 - a.0);
                for v in corners {
                    *sums.entry(v).or_default() += normal;
                }
            }
        }
        for (v, sum) in sums {
            if let Some((_, normal)) = found.get_mut(&v) {
                *normal = sum.normalize_or_zero();
            }
        }
        for _ in 0..NORMAL_ROUNDS {
            let mixed = |(&v, &(p, normal)): (&usize, &(DVec3, DVec3))| {
                let near = neighbors[v].iter().filter_map(|n| found.get(n)).map(|(_, n)| *n);
                let sum: DVec3 = near.sum();
                (v, (p, (normal + sum.normalize_or_zero()).normalize_or_zero()))
            };
            found = found.iter().map(mixed).collect();
        }
        found
    }

    /// The vertices before any stood off the surface.
    pub(in crate::models) fn points(&self) -> &[DVec3] {
        &self.mesh.points
    }

    /// Values of the vertices, each mixed with its neighbours' that many times; at each place the
    /// neighbours have the share `rate`.
    pub(in crate::models) fn diffused(
        &self,
        mut values: Vec<Vec<f64>>,
        rounds: usize,
        rate: &dyn Fn(DVec3) -> f64,
    ) -> Vec<Vec<f64>> {
        let rates: Vec<f64> = self.mesh.points.iter().map(|&p| rate(p)).collect();
        let neighbors = self.neighbors();
        for _ in 0..rounds {
            let mixed = |(v, own): (usize, &Vec<f64>)| {
                let near = &neighbors[v];
                let mean = |i: usize| {
                    near.iter().map(|&n| values[n][i]).sum::<f64>() / near.len().max(1) as f64
                };
                let rate = rates[v];
                if rate == 0.0 {
                    return own.clone();
                }
                (0..own.len()).map(|i| own[i] + (mean(i) - own[i]) * rate).collect()
            };
            values = values.iter().enumerate().map(mixed).collect();
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::sculpt::{polygonise, remesh};

    /// Where two regions meet, every corner is on the border: none was left uncut because an edge
    /// had got another number.
    #[test]
    fn borders_of_regions_have_no_snags() {
        let ball = |p: DVec3| p.length() - 0.1;
        let length = |_: DVec3| 0.008;
        let spots = |p: DVec3| (p * 40.0).to_array().map(libm::cos).iter().sum::<f64>() * 0.02;
        let rest = |_: DVec3| -1.0;
        let regions = [
            Region { inside: &spots, surface: &ball, raised: false },
            Region { inside: &rest, surface: &ball, raised: false },
        ];
        let mesh = polygonise(&ball, DVec3::splat(-0.12), DVec3::splat(0.12), 0.006);
        let mesh = remesh(mesh, &ball, &length, 4);
        let mut imprinted = imprint(mesh, &ball, &regions, &length);
        relax(&mut imprinted, &ball, &regions, 2);
        let Imprinted { mesh, labels, .. } = &imprinted;
        let mut corners = 0;
        for h in 0..mesh.half_edges() {
            if labels[h as usize / 3] != labels[mesh.twin(h) as usize / 3] {
                corners += 1;
                let off = spots(mesh.point(mesh.from(h)));
                assert!(off.abs() < 1e-4, "{off} at {}", mesh.point(mesh.from(h)));
            }
        }
        assert!(corners > 100, "{corners}");
    }
}
