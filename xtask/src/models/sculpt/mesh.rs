//! Closed triangle meshes with what lies across each edge.

use std::collections::HashMap;

use glam::DVec3;

/// A closed, consistently wound triangle mesh. Half edge `3 t + i` runs from corner `i` of
/// triangle `t` to the next one; `twins` has the half edge that runs the other way.
pub(in crate::models) struct Mesh {
    pub(in crate::models) points: Vec<DVec3>,
    /// The corner that each half edge starts from.
    pub(in crate::models) corners: Vec<u32>,
    pub(super) twins: Vec<u32>,
}

/// The half edge after this one in its triangle.
pub(super) fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The half edge before this one in its triangle.
pub(super) fn prev(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// Marks the corners of a triangle that was removed.
const GONE: u32 = u32::MAX;

impl Mesh {
    /// From points and triangles; `None` unless every edge has exactly two triangles, wound
    /// alike.
    pub(super) fn new(points: Vec<DVec3>, corners: Vec<u32>) -> Option<Self> {
        let mut open = HashMap::with_capacity(corners.len() / 2);
        let mut twins = vec![GONE; corners.len()];
        for h in 0..corners.len() as u32 {
            let (from, to) = (corners[h as usize], corners[next(h) as usize]);
            if let Some(twin) = open.remove(&(to, from)) {
                twins[h as usize] = twin;
                twins[twin as usize] = h;
            } else if open.insert((from, to), h).is_some() {
                return None;
            }
        }
        open.is_empty().then_some(Self { points, corners, twins })
    }

    pub(super) fn from(&self, h: u32) -> u32 {
        self.corners[h as usize]
    }

    pub(super) fn to(&self, h: u32) -> u32 {
        self.corners[next(h) as usize]
    }

    pub(super) fn twin(&self, h: u32) -> u32 {
        self.twins[h as usize]
    }

    pub(super) fn point(&self, vertex: u32) -> DVec3 {
        self.points[vertex as usize]
    }

    pub(super) fn half_edges(&self) -> u32 {
        self.corners.len() as u32
    }

    pub(super) fn is_gone(&self, h: u32) -> bool {
        self.corners[h as usize] == GONE
    }

    fn join(&mut self, a: u32, b: u32) {
        self.twins[a as usize] = b;
        self.twins[b as usize] = a;
    }

    /// All half edges that start where `h` does, `h` first.
    pub(super) fn around(&self, h: u32) -> Vec<u32> {
        let mut fan = Vec::with_capacity(8);
        let mut at = h;
        loop {
            fan.push(at);
            at = self.twin(prev(at));
            if at == h || fan.len() > 256 {
                return fan;
            }
        }
    }

    /// One outgoing half edge of every vertex.
    pub(super) fn outgoing(&self) -> Vec<u32> {
        let mut outgoing = vec![GONE; self.points.len()];
        for h in (0..self.half_edges()).rev().filter(|&h| !self.is_gone(h)) {
            outgoing[self.from(h) as usize] = h;
        }
        outgoing
    }

    /// Puts a new vertex at `p` on an edge; gives the vertex. Two triangles are added.
    pub(super) fn split(&mut self, h: u32, p: DVec3) -> u32 {
        let g = self.twin(h);
        let (h1, g1) = (next(h), next(g));
        let (a, b, c, d) = (self.from(h), self.from(g), self.from(prev(h)), self.from(prev(g)));
        let (bc, ad) = (self.twin(h1), self.twin(g1));
        let m = self.points.len() as u32;
        self.points.push(p);
        let n = self.half_edges();
        let q = n + 3;
        self.corners.extend([m, b, c, m, a, d]);
        self.twins.extend([GONE; 6]);
        self.corners[h1 as usize] = m;
        self.corners[g1 as usize] = m;
        self.join(n + 1, bc);
        self.join(h1, n + 2);
        self.join(q + 1, ad);
        self.join(g1, q + 2);
        self.join(h, q);
        self.join(n, g);
        m
    }

    /// Turns an edge to join the two other corners of its triangles, unless they are joined.
    pub(super) fn flip(&mut self, h: u32) -> bool {
        let g = self.twin(h);
        let (h1, h2, g1, g2) = (next(h), prev(h), next(g), prev(g));
        let (a, b, c, d) = (self.from(h), self.from(g), self.from(h2), self.from(g2));
        if c == d || self.around(h2).iter().any(|&e| self.to(e) == d) {
            return false;
        }
        let (bc, ca, ad, db) = (self.twin(h1), self.twin(h2), self.twin(g1), self.twin(g2));
        for (half, vertex) in [(h, d), (h1, c), (h2, a), (g, c), (g1, d), (g2, b)] {
            self.corners[half as usize] = vertex;
        }
        self.join(h1, ca);
        self.join(h2, ad);
        self.join(g1, db);
        self.join(g2, bc);
        true
    }

    /// Draws the start of `h` into its end, which goes to `p`. Refused, with no change, where the
    /// surface would be pinched or folded, or an edge would become longer than `longest`.
    pub(super) fn collapse(&mut self, h: u32, p: DVec3, longest: f64) -> bool {
        let g = self.twin(h);
        let (a, b, c, d) = (self.from(h), self.from(g), self.from(prev(h)), self.from(prev(g)));
        let (fan_a, fan_b) = (self.around(h), self.around(g));
        if fan_a.len() < 4 || fan_b.len() < 4 || c == d {
            return false;
        }
        for &e in &fan_a {
            let v = self.to(e);
            if v != b && v != c && v != d && fan_b.iter().any(|&f| self.to(f) == v) {
                return false;
            }
        }
        // The corners opposite keep at least three triangles.
        for opposite in [prev(h), prev(g)] {
            if self.around(opposite).len() < 4 {
                return false;
            }
        }
        for (fan, other) in [(&fan_a, b), (&fan_b, a)] {
            for &e in fan {
                let (u, v) = (self.to(e), self.from(prev(e)));
                if u != other && self.point(u).distance(p) > longest {
                    return false;
                }
                if u == other || v == other {
                    continue;
                }
                let (o, u, v) = (self.point(self.from(e)), self.point(u), self.point(v));
                let (old, new) = ((u - o).cross(v - o), (u - p).cross(v - p));
                if old.dot(new) <= 0.3 * old.length() * new.length() {
                    return false;
                }
            }
        }
        for e in fan_a {
            self.corners[e as usize] = b;
        }
        self.points[b as usize] = p;
        let (bc, ca) = (self.twin(next(h)), self.twin(prev(h)));
        let (ad, db) = (self.twin(next(g)), self.twin(prev(g)));
        self.join(bc, ca);
        self.join(ad, db);
        for t in [h / 3, g / 3] {
            for i in 0..3 {
                self.corners[(3 * t + i) as usize] = GONE;
            }
        }
        true
    }

    /// Leaves out removed triangles and the vertices that nothing uses.
    /// Also gives the old number of each vertex.
    pub(super) fn compact(&self) -> (Self, Vec<usize>) {
        let mut new_vertex = vec![GONE; self.points.len()];
        let mut points = Vec::new();
        let mut old = Vec::new();
        let mut new_half = vec![GONE; self.corners.len()];
        let mut corners = Vec::new();
        for h in (0..self.half_edges()).filter(|&h| !self.is_gone(h)) {
            let v = self.from(h) as usize;
            if new_vertex[v] == GONE {
                new_vertex[v] = points.len() as u32;
                points.push(self.points[v]);
                old.push(v);
            }
            new_half[h as usize] = corners.len() as u32;
            corners.push(new_vertex[v]);
        }
        let kept = (0..self.half_edges()).filter(|&h| !self.is_gone(h));
        let twins = kept.map(|h| new_half[self.twin(h) as usize]).collect();
        (Self { points, corners, twins }, old)
    }

    /// Tangential smoothing: moves each vertex where `free` says so by `strength` of the way to
    /// the mean of its neighbours, along the surface only.
    pub(super) fn smoothed(&self, strength: f64, free: &dyn Fn(usize) -> bool) -> Vec<DVec3> {
        let outgoing = self.outgoing();
        let mut moved = self.points.clone();
        for (v, &start) in outgoing.iter().enumerate() {
            if start == GONE || !free(v) {
                continue;
            }
            let fan = self.around(start);
            let p = self.points[v];
            let mut normal = DVec3::ZERO;
            let mut sum = DVec3::ZERO;
            let mut weights = 0.0;
            for &e in &fan {
                let (u, w) = (self.point(self.to(e)), self.point(self.from(prev(e))));
                let area = (u - p).cross(w - p);
                normal += area;
                // The centroids of the triangles weigh by area, which evens out the triangles.
                let weight = area.length();
                sum += (p + u + w) / 3.0 * weight;
                weights += weight;
            }
            let normal = normal.normalize_or_zero();
            if weights > 0.0 {
                let step = (sum / weights - p) * strength;
                moved[v] = p + step - normal * step.dot(normal);
            }
        }
        moved
    }
}
