//! Short forms for bind-group layouts, bind groups and buffers.

/// What a binding is.
#[derive(Clone, Copy)]
pub(crate) enum Binding {
    /// A uniform buffer.
    Uniform,
    /// A uniform buffer with a dynamic offset.
    DynamicUniform,
    /// A storage buffer that is read.
    Storage,
    /// A storage buffer that is written, too.
    StorageWrite,
    /// A float texture that is only loaded.
    Float,
    /// A float texture with layers that is only loaded.
    FloatLayers,
    /// A float texture that is filtered.
    Filtered,
    /// Layers of float textures that are filtered.
    FilteredLayers,
    /// An unsigned-integer texture.
    Uint,
    /// Layers of unsigned-integer textures.
    UintLayers,
    /// A depth texture.
    Depth,
    /// A depth texture with layers.
    DepthLayers,
    /// A multisampled depth texture.
    DepthSamples,
    /// A storage texture that is written.
    Written(wgpu::TextureFormat),
    /// A storage texture with layers that is written.
    WrittenLayers(wgpu::TextureFormat),
    /// A filtering sampler.
    Sampler,
    /// A sampler that does not filter.
    NearestSampler,
}

impl Binding {
    fn ty(self) -> wgpu::BindingType {
        let buffer = |ty, has_dynamic_offset| wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset,
            min_binding_size: None,
        };
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        match self {
            Self::Uniform => buffer(wgpu::BufferBindingType::Uniform, false),
            Self::DynamicUniform => buffer(wgpu::BufferBindingType::Uniform, true),
            Self::Storage => buffer(wgpu::BufferBindingType::Storage { read_only: true }, false),
            Self::StorageWrite => {
                buffer(wgpu::BufferBindingType::Storage { read_only: false }, false)
            }
            Self::Float => texture(wgpu::TextureSampleType::Float { filterable: false }),
            Self::FloatLayers => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
            Self::Filtered => texture(wgpu::TextureSampleType::Float { filterable: true }),
            Self::FilteredLayers => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: true },
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
            Self::UintLayers => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Uint,
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
            Self::Uint => texture(wgpu::TextureSampleType::Uint),
            Self::Depth => texture(wgpu::TextureSampleType::Depth),
            Self::DepthLayers => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Depth,
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
            Self::DepthSamples => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Depth,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: true,
            },
            Self::Written(format) => written(format, wgpu::TextureViewDimension::D2),
            Self::WrittenLayers(format) => written(format, wgpu::TextureViewDimension::D2Array),
            Self::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            Self::NearestSampler => {
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering)
            }
        }
    }
}

fn written(
    format: wgpu::TextureFormat,
    view_dimension: wgpu::TextureViewDimension,
) -> wgpu::BindingType {
    let access = wgpu::StorageTextureAccess::WriteOnly;
    wgpu::BindingType::StorageTexture { access, format, view_dimension }
}

/// A layout from (binding number, kind), all visible to `stages`.
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    stages: wgpu::ShaderStages,
    bindings: &[(u32, Binding)],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = bindings
        .iter()
        .map(|&(binding, kind)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: stages,
            ty: kind.ty(),
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries,
    })
}

/// A bind group from (binding number, resource).
pub(crate) fn group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[(u32, wgpu::BindingResource<'_>)],
) -> wgpu::BindGroup {
    let entries: Vec<_> = resources
        .iter()
        .map(|(binding, resource)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: resource.clone(),
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout,
        entries: &entries,
    })
}

/// A pipeline layout of these groups.
pub(crate) fn pipeline_layout(
    device: &wgpu::Device,
    label: &str,
    groups: &[&wgpu::BindGroupLayout],
) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// A compute pipeline.
pub(crate) fn compute_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    entry: &str,
) -> wgpu::ComputePipeline {
    specialised_pipeline(device, (layout, module), entry, &[])
}

/// As [`compute_pipeline`], with values of the shader's overrides.
pub(crate) fn specialised_pipeline(
    device: &wgpu::Device,
    (layout, module): (&wgpu::PipelineLayout, &wgpu::ShaderModule),
    entry: &str,
    constants: &[(&str, f64)],
) -> wgpu::ComputePipeline {
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(layout),
        module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    })
}

/// A buffer that holds `data`; at least one element long, since bindings may not be empty.
///
/// Written by the queue: a buffer that is mapped at creation panics where the memory is full or the
/// device is gone, this one reports it.
pub(crate) fn buffer<T: bytemuck::Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    usage: wgpu::BufferUsages,
    data: &[T],
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: (data.len().max(1) * size_of::<T>()) as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, bytemuck::cast_slice(data));
    buffer
}

/// Elements `T` at every multiple of 256 bytes, for dynamic offsets.
pub(crate) fn dynamic_uniforms<T: bytemuck::Pod>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    data: &[T],
) -> wgpu::Buffer {
    let mut bytes = vec![0u8; data.len().max(1) * DYNAMIC_STRIDE as usize];
    for (slot, value) in bytes.chunks_exact_mut(DYNAMIC_STRIDE as usize).zip(data) {
        slot[..size_of::<T>()].copy_from_slice(bytemuck::bytes_of(value));
    }
    buffer(device, queue, label, wgpu::BufferUsages::UNIFORM, &bytes)
}

/// Bytes between the elements of [`dynamic_uniforms`]: WebGPU's largest alignment.
pub(crate) const DYNAMIC_STRIDE: u64 = 256;

/// Workgroups of 64 for `count` invocations, in two dimensions since one holds only 65,535.
pub(crate) fn workgroups(count: u32) -> [u32; 2] {
    let groups = count.div_ceil(64);
    let x = groups.clamp(1, 32_768);
    [x, groups.div_ceil(x)]
}
