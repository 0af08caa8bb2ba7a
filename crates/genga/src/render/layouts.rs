//! Bind-group layouts that several passes share.

use super::gpu::bindings::{Binding as B, layout};

/// See `shaders/lib/bindings.wesl` and the headers of the passes.
pub(crate) struct Layouts {
    /// Group 0 of passes that draw surfaces: frame, draws, looks, rules, lights, ramp pictures,
    /// shadow maps, the draw's number, places of stipple, normals of meshes.
    pub(crate) surface: wgpu::BindGroupLayout,
    /// Group 1 of passes that draw surfaces: base colour, emissive, ids, hatching.
    pub(crate) material: wgpu::BindGroupLayout,
    /// Group 2 of pipelines that draw highlights; see `shaders/shading/highlight.wesl`.
    pub(crate) highlights: wgpu::BindGroupLayout,
    /// Group 0 of `shadow`: its map, draws.
    pub(crate) shadow: wgpu::BindGroupLayout,
    /// Group 0 of `deform`.
    pub(crate) deform: wgpu::BindGroupLayout,
    /// One uniform with a dynamic offset.
    pub(crate) dynamic: wgpu::BindGroupLayout,
    /// World vertices, edges, indices, rest vertices, range.
    pub(crate) stroke_source: wgpu::BindGroupLayout,
    /// Group 0 of `candidates`: frame, draws, lines, counters.
    pub(crate) candidates: wgpu::BindGroupLayout,
    /// Group 0 of `walk` and `seams`, see `shaders/lib/line.wesl`.
    pub(crate) lines: wgpu::BindGroupLayout,
    /// Group 0 of `strokes`: frame, depth, ids, curves.
    pub(crate) strokes: wgpu::BindGroupLayout,
    /// Group 1 of `strokes`: pieces, states, links, ranks, places, marks.
    pub(crate) linked: wgpu::BindGroupLayout,
    /// Group 0 of `reference`: frame, draws, mask.
    pub(crate) reference: wgpu::BindGroupLayout,
}

impl Layouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        use wgpu::ShaderStages as S;
        let drawn = S::VERTEX_FRAGMENT;
        let all = S::VERTEX_FRAGMENT | S::COMPUTE;
        Self {
            surface: layout(
                device,
                "surfaces",
                drawn,
                &[
                    (0, B::Uniform),
                    (1, B::Storage),
                    (2, B::Storage),
                    (3, B::Storage),
                    (4, B::Uniform),
                    (5, B::Float),
                    (6, B::Uniform),
                    (7, B::DepthLayers),
                    (8, B::NearestSampler),
                    (9, B::Uniform),
                    (10, B::DynamicUniform),
                    (11, B::Uint),
                    (12, B::FilteredLayers),
                ],
            ),
            material: layout(
                device,
                "material",
                S::FRAGMENT,
                &[
                    (0, B::Filtered),
                    (1, B::Sampler),
                    (2, B::Filtered),
                    (3, B::Sampler),
                    (4, B::Float),
                    (5, B::Filtered),
                    (6, B::Sampler),
                    (7, B::Filtered),
                    (8, B::Sampler),
                ],
            ),
            highlights: layout(
                device,
                "highlights",
                S::FRAGMENT,
                &[
                    (0, B::DynamicUniform),
                    (1, B::UintLayers),
                    (2, B::FilteredLayers),
                    (3, B::FilteredLayers),
                    (4, B::Sampler),
                    (5, B::Sampler),
                ],
            ),
            shadow: layout(device, "shadow", drawn, &[(0, B::DynamicUniform), (1, B::Storage)]),
            deform: layout(
                device,
                "deform",
                S::COMPUTE,
                &[
                    (0, B::Storage),
                    (1, B::StorageWrite),
                    (2, B::Storage),
                    (3, B::Storage),
                    (4, B::Storage),
                ],
            ),
            dynamic: layout(device, "dynamic", S::COMPUTE, &[(0, B::DynamicUniform)]),
            stroke_source: layout(
                device,
                "stroke source",
                all,
                &[
                    (0, B::Storage),
                    (1, B::Storage),
                    (2, B::Storage),
                    (3, B::Storage),
                    (4, B::DynamicUniform),
                ],
            ),
            candidates: layout(
                device,
                "candidates",
                S::COMPUTE,
                &[(0, B::Uniform), (1, B::Storage), (2, B::StorageWrite), (3, B::StorageWrite)],
            ),
            lines: layout(
                device,
                "lines",
                S::COMPUTE,
                &[
                    (0, B::Uniform),
                    (1, B::Storage),
                    (2, B::StorageWrite),
                    (3, B::StorageWrite),
                    (4, B::Uniform),
                    (5, B::Float),
                    (6, B::Uint),
                    (7, B::Float),
                    (8, B::Float),
                    (9, B::StorageWrite),
                    (10, B::Storage),
                    (11, B::Float),
                ],
            ),
            strokes: layout(
                device,
                "strokes",
                drawn,
                &[(0, B::Uniform), (1, B::Float), (2, B::Uint), (3, B::Float)],
            ),
            linked: layout(
                device,
                "linked pieces",
                S::VERTEX,
                &[
                    (0, B::Storage),
                    (1, B::Storage),
                    (2, B::Storage),
                    (3, B::Storage),
                    (4, B::Storage),
                    (5, B::Storage),
                ],
            ),
            reference: layout(
                device,
                "reference",
                drawn,
                &[(0, B::Uniform), (1, B::Storage), (4, B::Uint)],
            ),
        }
    }
}
