//! Bind-group layouts that several passes share.

use super::gpu::bindings::{Binding as B, layout};

/// See `shaders/lib/bindings.wesl` and the headers of the passes.
pub(crate) struct Layouts {
    /// Group 0 of passes that draw surfaces: frame, draws, looks, rules, lights, ramp pictures.
    pub(crate) surface: wgpu::BindGroupLayout,
    /// Group 1 of passes that draw surfaces: base colour, emissive, ids.
    pub(crate) material: wgpu::BindGroupLayout,
    /// Group 2 of pipelines that draw highlights; see `shaders/shading/highlight.wesl`.
    pub(crate) highlights: wgpu::BindGroupLayout,
    /// Group 0 of `deform`.
    pub(crate) deform: wgpu::BindGroupLayout,
    /// One uniform with a dynamic offset.
    pub(crate) dynamic: wgpu::BindGroupLayout,
    /// World vertices, edges or indices, range.
    pub(crate) stroke_source: wgpu::BindGroupLayout,
    /// Group 0 of `candidates`: that of `strokes`, segments, arguments.
    pub(crate) candidates: wgpu::BindGroupLayout,
    /// Group 1 of `strokes`.
    pub(crate) segments: wgpu::BindGroupLayout,
    /// Group 0 of `strokes` and `reference`: frame, draws, mask, ids, depth, normals.
    pub(crate) strokes: wgpu::BindGroupLayout,
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
                ],
            ),
            highlights: layout(
                device,
                "highlights",
                S::FRAGMENT,
                &[
                    (0, B::DynamicUniform),
                    (1, B::FilteredLayers),
                    (2, B::FilteredLayers),
                    (3, B::FilteredLayers),
                    (4, B::Sampler),
                    (5, B::Sampler),
                ],
            ),
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
                &[(0, B::Storage), (1, B::Storage), (2, B::DynamicUniform)],
            ),
            candidates: layout(
                device,
                "candidates",
                S::COMPUTE,
                &[
                    (0, B::Uniform),
                    (1, B::Storage),
                    (2, B::StorageWrite),
                    (3, B::StorageWrite),
                    (4, B::Uint),
                    (5, B::Uint),
                    (6, B::Depth),
                    (7, B::Float),
                ],
            ),
            segments: layout(device, "segments", S::VERTEX, &[(0, B::Storage)]),
            strokes: layout(
                device,
                "strokes",
                drawn,
                &[
                    (0, B::Uniform),
                    (1, B::Storage),
                    (4, B::Uint),
                    (5, B::Uint),
                    (6, B::Depth),
                    (7, B::Float),
                ],
            ),
        }
    }
}
