//! Texture coordinates that go round things, with vertices doubled along seams.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::sweep::Part;

/// How a part is unwrapped, in charts.
pub(in crate::models) struct Unwrap<'a> {
    /// The chart of a triangle, given its corners' indices.
    pub(in crate::models) chart: &'a dyn Fn([u32; 3]) -> usize,
    /// Where a chart has a point.
    pub(in crate::models) place: &'a dyn Fn(usize, DVec3) -> DVec2,
    /// How far u goes in one turn round a chart.
    pub(in crate::models) turn: &'a dyn Fn(usize) -> f64,
}

impl Unwrap<'_> {
    /// The part with texture coordinates, and which vertex each of its vertices was.
    pub(in crate::models) fn unwrap(&self, part: &Part) -> (Part, Vec<u32>) {
        // Vertices by what they were, their chart, and whether they lie past the seam.
        let mut vertices: BTreeMap<(u32, usize, bool), u32> = BTreeMap::new();
        let (mut result, mut old) = (Part::default(), Vec::new());
        for t in part.indices.chunks_exact(3) {
            let corners = [t[0], t[1], t[2]];
            let chart = (self.chart)(corners);
            let turn = (self.turn)(chart);
            let uvs = corners.map(|i| (self.place)(chart, part.positions[i as usize]));
            let most = uvs[0].x.max(uvs[1].x).max(uvs[2].x);
            for (i, uv) in corners.into_iter().zip(uvs) {
                let past = most - uv.x > turn / 2.0;
                let index = *vertices.entry((i, chart, past)).or_insert_with(|| {
                    old.push(i);
                    result.uvs.push(if past { uv + DVec2::X * turn } else { uv });
                    result.push(part.positions[i as usize], part.normals[i as usize])
                });
                result.indices.push(index);
            }
        }
        (result, old)
    }
}
