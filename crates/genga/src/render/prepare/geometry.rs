//! Meshes on the GPU: rest vertices, attributes, triangles, edges and morph targets, in pages.

use glam::{Vec3, Vec4};

use super::{
    directions::Direction,
    pages::{PAGE_BYTES, Pages, Place},
    topology::{LineEdge, Topology},
};
use crate::render::generated::{EDGE_NONE, Edge, RestVertex, WorldVertex};
use crate::scene::{Mesh, MorphTarget};

/// What a vertex keeps through deformation.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct VertexAttributes {
    pub(crate) uv0: [f32; 2],
    pub(crate) uv1: [f32; 2],
    /// Linear unorm16 RGBA: 8 bits would show in dark tones.
    pub(crate) color: [u16; 4],
    /// User line id of the triangles that begin at this vertex; then its shade bias, a half float.
    pub(crate) line_id: u32,
}

/// A part of a primitive that fits one page; almost always the whole.
#[derive(Clone, Debug)]
pub(crate) struct Chunk {
    pub(crate) rest: Place,
    pub(crate) vertex_count: u32,
    pub(crate) indices: Place,
    /// Own triangles; the neighbours' that its edges need follow them.
    pub(crate) index_count: u32,
    /// Runs of edges: place and count.
    pub(crate) edges: Vec<(Place, u32)>,
    /// Runs of triangles that contours run through, among the edges.
    pub(crate) contours: Vec<(Place, u32)>,
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

/// A direction that is not along the normal: strokes that go by the light or an axis need one to know
/// how the surface lies in the world.
fn any_direction(normal: Vec3) -> Vec3 {
    if normal.z.abs() > 0.9 { Vec3::X } else { Vec3::Z }
}

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

    /// Adds a mesh; `uv_sets` are the two sets of each primitive that go to the shaders.
    /// `directions` are those of hatching strokes by primitive and vertex, or nothing.
    pub(crate) fn add(
        &mut self,
        mesh: &Mesh,
        uv_sets: &[UvSets],
        directions: &[Vec<Direction>],
    ) -> Vec<Vec<Chunk>> {
        let topology = Topology::new(mesh);
        let mut edges = topology.edges.as_slice();
        let mut chunks = Vec::with_capacity(mesh.primitives.len());
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let end = 3 * topology.first_triangle[p + 1];
            let (own, others) = edges.split_at(edges.partition_point(|edge| edge.left < end));
            edges = others;
            let limits = [self.max_vertices, self.max_indices];
            let uv_sets = uv_sets.get(p).copied().unwrap_or_default();
            let mut of_primitive = Vec::new();
            if !primitive.indices.is_empty() {
                for part in Part::split(mesh, &topology, p, own, limits) {
                    of_primitive.push(self.add_part(
                        mesh,
                        p,
                        &topology,
                        (uv_sets, directions),
                        &part,
                    ));
                }
            }
            chunks.push(of_primitive);
        }
        chunks
    }

    fn add_part(
        &mut self,
        mesh: &Mesh,
        own_primitive: usize,
        topology: &Topology,
        (uv_sets, directions): (UvSets, &[Vec<Direction>]),
        part: &Part,
    ) -> Chunk {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut rest = Vec::with_capacity(part.vertices.len());
        let mut attributes = Vec::with_capacity(part.vertices.len());
        for &whole in &part.vertices {
            let of = topology.first_vertex.partition_point(|&first| first <= whole) - 1;
            let primitive = &mesh.primitives[of];
            let v = (whole - topology.first_vertex[of]) as usize;
            let p = primitive.positions[v];
            if of == own_primitive {
                low = low.min(p);
                high = high.max(p);
            }
            let joints = primitive.joints.get(v).copied().unwrap_or_default().map(u32::from);
            let weights = primitive.weights.get(v).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
            let weights = weights.map(|w| (w.clamp(0.0, 1.0) * 65535.0).round() as u32);
            let line_width = primitive.line_widths.get(v).map_or(1.0, |w| w.clamp(0.0, 100.0));
            self.max_line_width = self.max_line_width.max(line_width);
            let half = |x: f32| u32::from(half::f16::from_f32(x).to_bits());
            let direction = directions.get(of).and_then(|all| all.get(v));
            // The largest half float is 65504.
            let turning = direction.map_or([0.0; 2], |d| d.turning).map(|x| x.min(6e4));
            rest.push(RestVertex {
                x: p.x,
                y: p.y,
                z: p.z,
                normal: octahedral_pack(primitive.normals[v]),
                smooth_normal: octahedral_pack(topology.smooth_normals[whole as usize]),
                line: half(line_width) | half(topology.curvatures[whole as usize]) << 16,
                joints_01: joints[0] | joints[1] << 16,
                joints_23: joints[2] | joints[3] << 16,
                weights_01: weights[0] | weights[1] << 16,
                weights_23: weights[2] | weights[3] << 16,
                hatch: octahedral_pack(
                    direction.map_or_else(|| any_direction(primitive.normals[v]), |d| d.along),
                ),
                hatch_turning: half(turning[0]) | half(turning[1]) << 16,
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
                line_id: primitive.line_ids.get(v).map_or(0, |&id| id.min(0xffff))
                    | half(primitive.shade_biases.get(v).map_or(0.0, |b| b.clamp(-1.0, 1.0))) << 16,
            });
        }
        let rest_place = self.rest.add(&rest);
        if self.attributes.len() <= rest_place.page {
            self.attributes.resize_with(rest_place.page + 1, Vec::new);
        }
        self.attributes[rest_place.page].extend(attributes);
        let (morph, target_count) = self.add_morph(mesh, own_primitive, topology, &part.vertices);
        Chunk {
            rest: rest_place,
            vertex_count: part.vertices.len() as u32,
            indices: self.indices.add(&part.indices),
            index_count: part.own_indices as u32,
            edges: self.edges.add_pieces(&part.edges),
            contours: self.edges.add_pieces(&part.contours),
            morph,
            target_count,
            center: 0.5 * (low + high),
        }
    }

    fn add_morph(
        &mut self,
        mesh: &Mesh,
        own_primitive: usize,
        topology: &Topology,
        vertices: &[u32],
    ) -> (Place, u32) {
        let nothing = (Place { page: 0, first: 0 }, 0);
        let count = mesh.primitives[own_primitive].morph_targets.len();
        if count == 0 {
            return nothing;
        }
        let fitting = self.morph.capacity() / (6 * vertices.len().max(1));
        if fitting < count {
            self.warnings.push(format!(
                "mesh '{}' has {count} morph targets of {} vertices, of which the GPU holds {fitting}: \
                 the others are not applied",
                mesh.name,
                vertices.len(),
            ));
        }
        let mut offsets = Vec::with_capacity(6 * vertices.len() * count);
        for target in 0..count.min(fitting) {
            for &whole in vertices {
                let of = topology.first_vertex.partition_point(|&first| first <= whole) - 1;
                let v = (whole - topology.first_vertex[of]) as usize;
                let target = mesh.primitives[of].morph_targets.get(target);
                let at = |of: fn(&MorphTarget) -> &Vec<Vec3>| {
                    target.and_then(|t| of(t).get(v)).copied().unwrap_or(Vec3::ZERO).to_array()
                };
                offsets.extend(at(|t| &t.positions));
                offsets.extend(at(|t| &t.normals));
            }
        }
        if offsets.is_empty() {
            return nothing;
        }
        (self.morph.add(&offsets), count.min(fitting) as u32)
    }
}

/// A part of a primitive: vertices as numbers in the whole mesh, triangles and edges in numbers of
/// the part.
struct Part {
    vertices: Vec<u32>,
    /// The part's own triangles, then copies of neighbours that its edges need.
    indices: Vec<u32>,
    own_indices: usize,
    edges: Vec<Edge>,
    /// Triangles that contours run through.
    contours: Vec<Edge>,
}

/// Corners that an own triangle and its three neighbours can bring.
const CORNERS_WITH_NEIGHBOURS: usize = 12;

/// A triangle's corners in the whole mesh, turned so that the first one has the triangle's line id,
/// and by how many corners.
fn turned(mesh: &Mesh, topology: &Topology, triangle: u32) -> ([u32; 3], u32) {
    let p = topology.primitive_of(triangle);
    let primitive = &mesh.primitives[p];
    let own = 3 * (triangle - topology.first_triangle[p]) as usize;
    let corners = [0, 1, 2].map(|i| primitive.indices[own + i]);
    let id = topology.line_ids[triangle as usize];
    let has_id = |&v: &u32| primitive.line_ids.get(v as usize).is_none_or(|&own| own == id);
    let turn = corners.iter().position(has_id).unwrap_or(0);
    let first = topology.first_vertex[p];
    ([0, 1, 2].map(|i| first + corners[(i + turn) % 3]), turn as u32)
}

impl Part {
    /// Cuts a primitive into parts of at most so many vertices and indices, neighbours included; an
    /// edge goes with its left triangle. Almost always there is one.
    fn split(
        mesh: &Mesh,
        topology: &Topology,
        primitive: usize,
        edges: &[LineEdge],
        [max_vertices, max_indices]: [usize; 2],
    ) -> Vec<Self> {
        let triangles = topology.first_triangle[primitive]..topology.first_triangle[primitive + 1];
        let mut next_edge = edges.iter().peekable();
        let mut parts = Vec::new();
        let mut triangle = triangles.start;
        while triangle < triangles.end {
            let start = triangle;
            let mut part = Self {
                vertices: Vec::new(),
                indices: Vec::new(),
                own_indices: 0,
                edges: Vec::new(),
                contours: Vec::new(),
            };
            let mut local = std::collections::HashMap::new();
            // The own vertices of a primitive are usually all there and in order.
            let own = topology.first_vertex[primitive]..topology.first_vertex[primitive + 1];
            let mut own_local = vec![u32::MAX; own.len()];
            let mut turns = Vec::new();
            let mut own_edges = Vec::new();
            let mut neighbours = 0;
            let mut to_local = |vertices: &mut Vec<u32>, v: u32| {
                let slot = match own.contains(&v) {
                    true => &mut own_local[(v - own.start) as usize],
                    false => local.entry(v).or_insert(u32::MAX),
                };
                if *slot == u32::MAX {
                    *slot = vertices.len() as u32;
                    vertices.push(v);
                }
                *slot
            };
            while triangle < triangles.end {
                let corners = part.vertices.len() + 3 * neighbours + CORNERS_WITH_NEIGHBOURS;
                let indices = part.indices.len() + 3 * neighbours + CORNERS_WITH_NEIGHBOURS;
                if triangle > start && (corners > max_vertices || indices > max_indices) {
                    break;
                }
                let (corners, turn) = turned(mesh, topology, triangle);
                turns.push(turn as u8);
                if topology.is_smooth[triangle as usize] {
                    part.contours.push(Edge { left: part.indices.len() as u32, right: EDGE_NONE });
                }
                for v in corners {
                    let v = to_local(&mut part.vertices, v);
                    part.indices.push(v);
                }
                while let Some(edge) = next_edge.next_if(|e| e.left / 3 == triangle) {
                    let is_outside = |h: u32| !(start..=triangle).contains(&(h / 3));
                    neighbours += usize::from(edge.right.is_some_and(is_outside));
                    own_edges.push(edge);
                }
                triangle += 1;
            }
            part.own_indices = part.indices.len();
            let mut copies = std::collections::HashMap::new();
            for edge in own_edges {
                let own_side = |half: u32| {
                    let (t, corner) = (half / 3 - start, half % 3);
                    3 * t + (corner + 3 - u32::from(turns[t as usize])) % 3
                };
                let right = edge.right.map(|half| {
                    if (start..triangle).contains(&(half / 3)) {
                        return own_side(half);
                    }
                    let (first, turn) = *copies.entry(half / 3).or_insert_with(|| {
                        let (corners, turn) = turned(mesh, topology, half / 3);
                        let first = part.indices.len() as u32;
                        for v in corners {
                            let v = to_local(&mut part.vertices, v);
                            part.indices.push(v);
                        }
                        (first, turn)
                    });
                    first + (half % 3 + 3 - turn) % 3
                });
                part.edges.push(edge.packed(own_side(edge.left), right));
            }
            parts.push(part);
        }
        parts
    }
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
                .map(|page| {
                    buffer(device, queue, "rest vertices", Usage::STORAGE | Usage::VERTEX, page)
                })
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
    use super::super::topology::following;
    use super::*;
    use crate::scene::Primitive;

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

    /// A folded strip of quads with normals of their own, so that the edges between them are hard.
    fn strip(quads: u32) -> Mesh {
        let mut primitive = Primitive::default();
        for i in 0..quads {
            let (x, z) = (i as f32, (i % 2) as f32);
            for (dx, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                let z = if dx > 0.0 { 1.0 - z } else { z };
                primitive.positions.push(Vec3::new(x + dx, y, z));
                primitive.normals.push(Vec3::new(if i % 2 == 0 { -0.6 } else { 0.6 }, 0.0, 0.8));
            }
            primitive.indices.extend([0, 1, 2, 0, 2, 3].map(|v| 4 * i + v));
        }
        Mesh { primitives: vec![primitive], ..Mesh::default() }
    }

    /// The ends of all edges and the far corners of both faces.
    fn all_edges(builder: &GeometryBuilder, chunks: &[Chunk]) -> Vec<[Option<[i32; 2]>; 4]> {
        use crate::render::generated::EDGE_SIDE;
        let mut all = Vec::new();
        for chunk in chunks {
            let corner = |half: u32| {
                let index = (chunk.indices.first + half) as usize;
                let v = builder.indices.pages[chunk.indices.page][index];
                let vertex = builder.rest.pages[chunk.rest.page][(chunk.rest.first + v) as usize];
                Some([vertex.x as i32, vertex.y as i32])
            };
            for (at, count) in &chunk.edges {
                let page = &builder.edges.pages[at.page];
                for e in &page[at.first as usize..(at.first + count) as usize] {
                    let (left, right) = (e.left & EDGE_SIDE, e.right & EDGE_SIDE);
                    let far = |half| corner(following(following(half)));
                    let across = if right == EDGE_NONE { None } else { far(right) };
                    all.push([corner(left), corner(following(left)), far(left), across]);
                }
            }
        }
        all.sort_unstable();
        all
    }

    #[test]
    fn a_split_primitive_keeps_every_triangle_and_edge() {
        let mesh = strip(100);
        let mut whole = GeometryBuilder::new();
        let chunks = whole.add(&mesh, &[[0, 1]], &[]).remove(0);
        assert_eq!(chunks.len(), 1);
        // 99 folds, 2 sides of every quad, 2 ends.
        assert_eq!(all_edges(&whole, &chunks).len(), 99 + 200 + 2);
        let mut parts = GeometryBuilder::new();
        parts.max_vertices = 60;
        let split_chunks = parts.add(&mesh, &[[0, 1]], &[]).remove(0);
        assert!(split_chunks.len() > 5);
        assert_eq!(split_chunks.iter().map(|c| c.index_count).sum::<u32>(), 600);
        assert!(split_chunks.iter().all(|c| c.vertex_count <= 60));
        assert_eq!(all_edges(&whole, &chunks), all_edges(&parts, &split_chunks));
    }

    #[test]
    fn primitives_of_a_mesh_share_the_edge_between_them() {
        let Mesh { primitives, .. } = strip(2);
        let halves = [0, 1].map(|i| {
            let mut half = primitives[0].clone();
            half.indices = primitives[0].indices[6 * i..6 * i + 6].to_vec();
            half.material = Some(i);
            half
        });
        let mesh = Mesh { primitives: halves.to_vec(), ..Mesh::default() };
        let mut builder = GeometryBuilder::new();
        let chunks = builder.add(&mesh, &[[0, 1]; 2], &[]);
        assert_eq!(chunks.iter().map(|c| c[0].index_count).collect::<Vec<_>>(), [6, 6]);
        let edges: Vec<_> = builder.edges.pages.concat();
        let seams = edges.iter().filter(|e| e.left & crate::render::generated::EDGE_MATERIAL != 0);
        assert_eq!((edges.len(), seams.count()), (7, 1));
    }

    #[test]
    fn a_triangle_begins_at_a_corner_with_its_line_id() {
        let mut mesh = strip(1);
        mesh.primitives[0].line_ids = vec![1, 2, 2, 1];
        let mut builder = GeometryBuilder::new();
        let chunk = builder.add(&mesh, &[[0, 1]], &[]).remove(0).remove(0);
        let first = builder.indices.pages[0][chunk.indices.first as usize];
        assert_eq!(builder.attributes[0][first as usize].line_id, 2);
    }
}
