//! What the lines of a scene need: their sources, the buffers that pieces go through, curves.

use std::collections::HashMap;

use super::{DrawItem, dynamic_binding, geometry::Geometry, pages::PAGE_BYTES};
use crate::render::{
    generated::{self as gpu, Line, Piece, StrokeRange},
    gpu::bindings::{self, DYNAMIC_STRIDE},
    layouts::Layouts,
};
use crate::style::{Curve, Style};

/// A run of edges or triangles: group, dynamic offset, count.
pub(crate) type Run = (wgpu::BindGroup, u32, u32);

/// What the strokes of a scene need.
pub(crate) struct StrokeData {
    pub(crate) lines: wgpu::Buffer,
    pub(crate) pieces: wgpu::Buffer,
    pub(crate) counters: wgpu::Buffer,
    pub(crate) indirect: wgpu::Buffer,
    pub(crate) buckets: wgpu::Buffer,
    pub(crate) links: wgpu::Buffer,
    /// Ranks of the ends, read and written by turns.
    pub(crate) ranks: [wgpu::Buffer; 2],
    pub(crate) states: wgpu::Buffer,
    pub(crate) places: wgpu::Buffer,
    /// See `shaders/passes/strokes.wesl`.
    pub(crate) curves: wgpu::TextureView,
    /// Hard edges.
    pub(crate) edges: Vec<Run>,
    /// Triangles of smooth surfaces.
    pub(crate) contours: Vec<Run>,
    /// All triangles of each draw; the count is that of indices.
    pub(crate) reference: Vec<Run>,
}

/// Pieces that there is always room for.
const FEWEST_PIECES: usize = 1 << 16;
/// Most pieces; a picture of the largest size has fewer pixels of lines.
const MOST_PIECES: usize = 1 << 19;
/// Points of a curve, after their number.
const CURVE_TEXELS: u32 = 17;

impl StrokeData {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layouts: &Layouts,
        geometry: &Geometry,
        draws: &[DrawItem],
        style: &Style,
    ) -> Self {
        use wgpu::BufferUsages as Usage;
        let mut ranges: Vec<StrokeRange> = Vec::new();
        let mut pages = Vec::new();
        let mut order = 0_u32;
        let mut run = |item: &DrawItem, draw: usize, edge_page: usize, first: u32, count: u32| {
            pages.push((
                [item.world.page, edge_page, item.chunk.indices.page, item.chunk.rest.page],
                count,
            ));
            ranges.push(StrokeRange {
                world_first: item.world.first,
                rest_first: item.chunk.rest.first,
                index_first: item.chunk.indices.first,
                first,
                count,
                draw: draw as u32,
                order_first: order,
                reserved: 0,
            });
            order = order.wrapping_add(count);
        };
        // Beams have no lines.
        let draws: Vec<(usize, &DrawItem)> =
            draws.iter().enumerate().filter(|(_, item)| item.beam.is_none()).collect();
        let mut line_count = 0_usize;
        for &(i, item) in &draws {
            for &(place, count) in &item.chunk.edges {
                line_count += count as usize;
                run(item, i, place.page, place.first, count);
            }
        }
        for &(i, item) in &draws {
            for &(place, count) in &item.chunk.contours {
                line_count += count as usize / 8;
                run(item, i, place.page, place.first, count);
            }
        }
        for &(i, item) in &draws {
            run(item, i, 0, 0, item.chunk.index_count);
        }
        let uniforms = bindings::dynamic_uniforms(device, queue, "stroke ranges", &ranges);
        let nothing = bindings::buffer(device, queue, "no edges", Usage::STORAGE, &[0_u32; 2]);
        let mut groups: HashMap<[usize; 4], wgpu::BindGroup> = HashMap::new();
        let mut runs = pages.iter().enumerate().map(|(i, &(pages, count))| {
            let [world, edges, indices, rest] = pages;
            let make = || {
                let edges = geometry.edges.get(edges).unwrap_or(&nothing);
                bindings::group(
                    device,
                    "stroke source",
                    &layouts.stroke_source,
                    &[
                        (0, geometry.world[world].as_entire_binding()),
                        (1, edges.as_entire_binding()),
                        (2, geometry.indices[indices].as_entire_binding()),
                        (3, geometry.rest[rest].as_entire_binding()),
                        (4, dynamic_binding::<StrokeRange>(&uniforms)),
                    ],
                )
            };
            let group = groups.entry(pages).or_insert_with(make).clone();
            (group, (i as u64 * DYNAMIC_STRIDE) as u32, count)
        });
        let edge_runs = draws.iter().map(|(_, item)| item.chunk.edges.len()).sum();
        let contour_runs = draws.iter().map(|(_, item)| item.chunk.contours.len()).sum();
        let edges = runs.by_ref().take(edge_runs).collect();
        let contours = runs.by_ref().take(contour_runs).collect();
        let reference = runs.collect();

        let capacity =
            (line_count + FEWEST_PIECES).min(MOST_PIECES).min(PAGE_BYTES / size_of::<Piece>());
        let stored = |label: &str, bytes: usize, usage: Usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: Usage::STORAGE | Usage::COPY_DST | usage,
                mapped_at_creation: false,
            })
        };
        let none = Usage::empty();
        Self {
            lines: stored("lines", capacity * size_of::<Line>(), none),
            pieces: stored("pieces", capacity * size_of::<Piece>(), none),
            counters: stored("line counters", 16, none),
            indirect: stored("line arguments", 80, Usage::INDIRECT),
            buckets: stored("places of ends", 16 * capacity, none),
            links: stored("links", 8 * capacity, none),
            ranks: [stored("ranks", 16 * capacity, none), stored("ranks", 16 * capacity, none)],
            states: stored("states of pieces", 16 * capacity, none),
            places: stored("places of pieces", 16 * capacity, none),
            curves: curve_texture(device, queue, style),
            edges,
            contours,
            reference,
        }
    }
}

/// The curves of a line set in the order of CURVE_*.
pub(crate) fn curves(set: &crate::style::LineSet) -> [Option<&Curve>; gpu::CURVE_COUNT as usize] {
    let by = &set.width_by;
    let all = [&by.depth, &by.curvature, &by.screen_curvature, &by.light, &by.taper];
    all.map(Option::as_ref)
}

fn curve_texture(device: &wgpu::Device, queue: &wgpu::Queue, style: &Style) -> wgpu::TextureView {
    use wgpu::util::DeviceExt as _;
    let rows = 4 * gpu::CURVE_COUNT;
    let mut texels = vec![[0.0_f32; 2]; (CURVE_TEXELS * rows) as usize];
    for (i, set) in style.lines.sets.iter().take(4).enumerate() {
        for (k, curve) in curves(set).into_iter().enumerate() {
            let Some(curve) = curve else { continue };
            let row = (i * gpu::CURVE_COUNT as usize + k) * CURVE_TEXELS as usize;
            texels[row] = [curve.points().len() as f32, 0.0];
            let points = curve.points();
            texels[row + 1..row + 1 + points.len()].copy_from_slice(points);
        }
    }
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some("curves"),
            size: wgpu::Extent3d { width: CURVE_TEXELS, height: rows, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rg32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
