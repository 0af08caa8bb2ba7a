//! Meshes on the GPU: rest vertices, attributes, triangles, edges and morph targets, in pages.

use glam::{Vec3, Vec4};

use super::{
    edges::{self, FaceEdge},
    pages::{PAGE_BYTES, Pages, Place},
};
use crate::render::generated::{Edge, NO_VERTEX, RestVertex, WorldVertex};
use crate::scene::Primitive;

/// What a vertex keeps through deformation.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct VertexAttributes {
    pub(crate) uv0: [f32; 2],
    pub(crate) uv1: [f32; 2],
    /// Linear unorm16 RGBA: 8 bits would show in dark tones.
    pub(crate) color: [u16; 4],
}

/// A part of a primitive that fits one page; almost always the whole.
#[derive(Clone, Debug)]
pub(crate) struct Chunk {
    pub(crate) rest: Place,
    pub(crate) vertex_count: u32,
    pub(crate) indices: Place,
    pub(crate) index_count: u32,
    /// Runs of edges: place and count.
    pub(crate) edges: Vec<(Place, u32)>,
    pub(crate) morph: Place,
    pub(crate) target_count: u32,
    /// Middle of the rest positions.
    pub(crate) center: Vec3,
}

/// Most vertices of a chunk: a page of rest vertices, with room for the far corners of edges that
/// cross to another chunk.
const MAX_CHUNK_VERTICES: usize = PAGE_BYTES / size_of::<RestVertex>();
/// Most indices of a chunk: a page of u32.
const MAX_CHUNK_INDICES: usize = PAGE_BYTES / 4 / 3 * 3;

/// All pages while they are filled.
pub(crate) struct GeometryBuilder {
    pub(crate) rest: Pages<RestVertex>,
    pub(crate) attributes: Vec<Vec<VertexAttributes>>,
    pub(crate) indices: Pages<u32>,
    pub(crate) edges: Pages<Edge>,
    pub(crate) morph: Pages<f32>,
    pub(crate) warnings: Vec<String>,
    /// Largest factor on line widths of any vertex, at least 1.
    pub(crate) max_line_width: f32,
    max_vertices: usize,
    max_indices: usize,
}

/// Sets of texture coordinates that the materials of one primitive use, as (base, emissive).
pub(crate) type UvSets = [usize; 2];

impl GeometryBuilder {
    pub(crate) fn new() -> Self {
        Self {
            rest: Pages::new(),
            attributes: Vec::new(),
            indices: Pages::new(),
            edges: Pages::new(),
            morph: Pages::new(),
            warnings: Vec::new(),
            max_line_width: 1.0,
            max_vertices: MAX_CHUNK_VERTICES,
            max_indices: MAX_CHUNK_INDICES,
        }
    }

    /// Adds a primitive; `uv_sets` are the two sets that go to the shaders.
    pub(crate) fn add(&mut self, mesh: &str, primitive: &Primitive, uv_sets: UvSets) -> Vec<Chunk> {
        if primitive.indices.is_empty() {
            return Vec::new();
        }
        let welded = edges::weld(primitive);
        let smooth = edges::smooth_normals(primitive, &welded);
        let face_edges = edges::unique_edges(&primitive.indices, &welded);
        let fits = primitive.positions.len() <= self.max_vertices
            && primitive.indices.len() <= self.max_indices;
        if fits {
            let all: Vec<u32> = (0..primitive.positions.len() as u32).collect();
            let edges: Vec<Edge> = face_edges.iter().map(|e| e.edge).collect();
            let part = Part { vertices: &all, indices: &primitive.indices, edges: &edges };
            return vec![self.add_part(mesh, primitive, &smooth, uv_sets, &part)];
        }
        split(primitive, &face_edges, self.max_vertices, self.max_indices)
            .iter()
            .map(|(vertices, indices, edges)| {
                let part = Part { vertices, indices, edges };
                self.add_part(mesh, primitive, &smooth, uv_sets, &part)
            })
            .collect()
    }

    fn add_part(
        &mut self,
        mesh: &str,
        primitive: &Primitive,
        smooth: &[Vec3],
        uv_sets: UvSets,
        part: &Part<'_>,
    ) -> Chunk {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut rest = Vec::with_capacity(part.vertices.len());
        let mut attributes = Vec::with_capacity(part.vertices.len());
        for &v in part.vertices {
            let v = v as usize;
            let p = primitive.positions[v];
            low = low.min(p);
            high = high.max(p);
            let joints = primitive.joints.get(v).copied().unwrap_or_default().map(u32::from);
            let weights = primitive.weights.get(v).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
            let weights = weights.map(|w| (w.clamp(0.0, 1.0) * 65535.0).round() as u32);
            let line_width = primitive.line_widths.get(v).map_or(1.0, |w| w.clamp(0.0, 100.0));
            self.max_line_width = self.max_line_width.max(line_width);
            rest.push(RestVertex {
                x: p.x,
                y: p.y,
                z: p.z,
                normal: octahedral_pack(primitive.normals[v]),
                smooth_normal: octahedral_pack(smooth[v]),
                line_width,
                joints_01: joints[0] | joints[1] << 16,
                joints_23: joints[2] | joints[3] << 16,
                weights_01: weights[0] | weights[1] << 16,
                weights_23: weights[2] | weights[3] << 16,
            });
            let uv = |set: usize| {
                let uv = primitive.uvs.get(set).and_then(|uvs| uvs.get(v));
                uv.map_or([0.0; 2], |uv| uv.to_array().map(|x| if x.is_finite() { x } else { 0.0 }))
            };
            let color = primitive.colors.get(v).copied().unwrap_or(Vec4::ONE);
            attributes.push(VertexAttributes {
                uv0: uv(uv_sets[0]),
                uv1: uv(uv_sets[1]),
                color: color.to_array().map(|c| (c.clamp(0.0, 1.0) * 65535.0).round() as u16),
            });
        }
        let rest_place = self.rest.add(&rest);
        if self.attributes.len() <= rest_place.page {
            self.attributes.resize_with(rest_place.page + 1, Vec::new);
        }
        self.attributes[rest_place.page].extend(attributes);
        let (morph, target_count) = self.add_morph(mesh, primitive, part.vertices);
        Chunk {
            rest: rest_place,
            vertex_count: part.vertices.len() as u32,
            indices: self.indices.add(part.indices),
            index_count: part.indices.len() as u32,
            edges: self.edges.add_pieces(part.edges),
            morph,
            target_count,
            center: 0.5 * (low + high),
        }
    }

    fn add_morph(&mut self, mesh: &str, primitive: &Primitive, vertices: &[u32]) -> (Place, u32) {
        let nothing = (Place { page: 0, first: 0 }, 0);
        let targets = &primitive.morph_targets;
        if targets.is_empty() {
            return nothing;
        }
        let fitting = self.morph.capacity() / (6 * vertices.len().max(1));
        if fitting < targets.len() {
            self.warnings.push(format!(
                "mesh '{mesh}' has {} morph targets of {} vertices, of which the GPU holds {fitting}: \
                 the others are not applied",
                targets.len(),
                vertices.len(),
            ));
        }
        let mut offsets = Vec::with_capacity(6 * vertices.len() * targets.len());
        for target in targets.iter().take(fitting) {
            for &v in vertices {
                let at = |offsets: &[Vec3]| offsets.get(v as usize).copied().unwrap_or(Vec3::ZERO);
                offsets.extend(at(&target.positions).to_array());
                offsets.extend(at(&target.normals).to_array());
            }
        }
        if offsets.is_empty() {
            return nothing;
        }
        (self.morph.add(&offsets), targets.len().min(fitting) as u32)
    }
}

/// Vertices (numbers in the primitive), and triangles and edges in numbers of the part.
struct Part<'a> {
    vertices: &'a [u32],
    indices: &'a [u32],
    edges: &'a [Edge],
}

/// Cuts a primitive into parts of at most `max_vertices` and `max_indices`; an edge goes with its
/// left triangle, and takes a copy of the far corner of the other one along.
fn split(
    primitive: &Primitive,
    face_edges: &[FaceEdge],
    max_vertices: usize,
    max_indices: usize,
) -> Vec<(Vec<u32>, Vec<u32>, Vec<Edge>)> {
    let mut by_triangle: Vec<&FaceEdge> = face_edges.iter().collect();
    by_triangle.sort_unstable_by_key(|e| e.triangle);
    let mut next_edge = by_triangle.into_iter().peekable();
    let mut parts = Vec::new();
    let mut local = vec![u32::MAX; primitive.positions.len()];
    let (mut vertices, mut indices, mut edges) = (Vec::new(), Vec::new(), Vec::new());
    for (t, triangle) in primitive.indices.chunks_exact(3).enumerate() {
        // At most three new corners and three far corners.
        if vertices.len() + 6 > max_vertices || indices.len() + 3 > max_indices {
            for &v in &vertices {
                local[v as usize] = u32::MAX;
            }
            parts.push((
                std::mem::take(&mut vertices),
                std::mem::take(&mut indices),
                std::mem::take(&mut edges),
            ));
        }
        let mut to_local = |v: u32| {
            let slot = &mut local[v as usize];
            if *slot == u32::MAX {
                *slot = vertices.len() as u32;
                vertices.push(v);
            }
            *slot
        };
        for &v in triangle {
            indices.push(to_local(v));
        }
        while let Some(e) = next_edge.next_if(|e| e.triangle == t as u32) {
            let right = if e.edge.right == NO_VERTEX { NO_VERTEX } else { to_local(e.edge.right) };
            edges.push(Edge {
                v0: to_local(e.edge.v0),
                v1: to_local(e.edge.v1),
                left: to_local(e.edge.left),
                right,
            });
        }
    }
    parts.push((vertices, indices, edges));
    parts
}

/// As `octahedral_pack` in `shaders/lib/octahedral.wesl`.
pub(crate) fn octahedral_pack(n: Vec3) -> u32 {
    let sum = (n.x.abs() + n.y.abs() + n.z.abs()).max(1e-20);
    let (mut x, mut y) = (n.x / sum, n.y / sum);
    if n.z < 0.0 {
        let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
        (x, y) = ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y));
    }
    let snorm = |v: f32| u32::from((v.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    snorm(x) | snorm(y) << 16
}

/// Pages on the GPU.
pub(crate) struct Geometry {
    pub(crate) rest: Vec<wgpu::Buffer>,
    pub(crate) attributes: Vec<wgpu::Buffer>,
    pub(crate) indices: Vec<wgpu::Buffer>,
    pub(crate) edges: Vec<wgpu::Buffer>,
    pub(crate) morph: Vec<wgpu::Buffer>,
    pub(crate) world: Vec<wgpu::Buffer>,
}

impl Geometry {
    /// Uploads everything and makes world pages of the given numbers of vertices.
    pub(crate) fn upload(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        builder: &GeometryBuilder,
        world: &[u32],
    ) -> Self {
        use crate::render::gpu::bindings::buffer;
        use wgpu::BufferUsages as Usage;
        let all = |label: &str, usage, pages: &[Vec<_>]| -> Vec<wgpu::Buffer> {
            pages.iter().map(|page: &Vec<u32>| buffer(device, queue, label, usage, page)).collect()
        };
        let indices = all("indices", Usage::INDEX | Usage::STORAGE, &builder.indices.pages);
        let mut morph: Vec<_> = builder
            .morph
            .pages
            .iter()
            .map(|page| buffer(device, queue, "morph targets", Usage::STORAGE, page))
            .collect();
        if morph.is_empty() {
            morph.push(buffer(device, queue, "no morph targets", Usage::STORAGE, &[0.0_f32]));
        }
        Self {
            rest: builder
                .rest
                .pages
                .iter()
                .map(|page| buffer(device, queue, "rest vertices", Usage::STORAGE, page))
                .collect(),
            attributes: builder
                .attributes
                .iter()
                .map(|page| buffer(device, queue, "vertex attributes", Usage::VERTEX, page))
                .collect(),
            indices,
            edges: builder
                .edges
                .pages
                .iter()
                .map(|page| buffer(device, queue, "edges", Usage::STORAGE, page))
                .collect(),
            morph,
            world: world
                .iter()
                .map(|&count| {
                    device.create_buffer(&wgpu::BufferDescriptor {
                        label: Some("world vertices"),
                        size: u64::from(count.max(1)) * size_of::<WorldVertex>() as u64,
                        usage: Usage::STORAGE | Usage::VERTEX,
                        mapped_at_creation: false,
                    })
                })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn octahedral_unpack(bits: u32) -> Vec3 {
        let snorm = |v: u32| (f32::from(v as u16 as i16) / 32767.0).max(-1.0);
        let (x, y) = (snorm(bits & 0xffff), snorm(bits >> 16));
        let mut n = Vec3::new(x, y, 1.0 - x.abs() - y.abs());
        if n.z < 0.0 {
            let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
            n = Vec3::new((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y), n.z);
        }
        n.normalize()
    }

    #[test]
    fn packed_normals_are_within_a_hundredth_of_a_degree() {
        for i in 0..10_000 {
            let (u, v) = ((i as f32 * 0.618_034).fract(), (i as f32 + 0.5) / 10_000.0);
            let z = 2.0 * v - 1.0;
            let (sin, cos) = (std::f32::consts::TAU * u).sin_cos();
            let n = Vec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vec3::Z * z;
            let angle = n.cross(octahedral_unpack(octahedral_pack(n))).length();
            assert!(angle < 1.0e-4, "{n}: {angle}");
        }
    }

    /// A strip of quads, so that every inner edge has two faces.
    fn strip(quads: u32) -> Primitive {
        let positions: Vec<Vec3> = (0..=quads)
            .flat_map(|i| [Vec3::new(i as f32, 0.0, 0.0), Vec3::new(i as f32, 1.0, 0.0)])
            .collect();
        let indices = (0..quads).flat_map(|i| {
            let a = 2 * i;
            [a, a + 2, a + 3, a, a + 3, a + 1]
        });
        Primitive {
            normals: vec![Vec3::Z; positions.len()],
            positions,
            indices: indices.collect(),
            ..Primitive::default()
        }
    }

    #[test]
    fn a_split_primitive_keeps_every_triangle_and_edge() {
        let primitive = strip(100);
        let mut whole = GeometryBuilder::new();
        let chunks = whole.add("strip", &primitive, [0, 1]);
        assert_eq!(chunks.len(), 1);
        let mut parts = GeometryBuilder::new();
        parts.max_vertices = 20;
        let split_chunks = parts.add("strip", &primitive, [0, 1]);
        assert!(split_chunks.len() > 5);
        assert_eq!(split_chunks.iter().map(|c| c.index_count).sum::<u32>(), 600);
        assert!(split_chunks.iter().all(|c| c.vertex_count <= 20));
        let place = |builder: &GeometryBuilder, chunk: &Chunk, v: u32| {
            let vertex = builder.rest.pages[chunk.rest.page][(chunk.rest.first + v) as usize];
            [vertex.x as i32, vertex.y as i32]
        };
        let all_edges = |builder: &GeometryBuilder, chunks: &[Chunk]| {
            let mut all = Vec::new();
            for chunk in chunks {
                for (at, count) in &chunk.edges {
                    let page = &builder.edges.pages[at.page];
                    for e in &page[at.first as usize..(at.first + count) as usize] {
                        let right = (e.right != NO_VERTEX).then(|| place(builder, chunk, e.right));
                        let [a, b, c] = [e.v0, e.v1, e.left].map(|v| place(builder, chunk, v));
                        all.push((a, b, c, right));
                    }
                }
            }
            all.sort_unstable();
            all
        };
        assert_eq!(all_edges(&whole, &chunks), all_edges(&parts, &split_chunks));
    }
}
