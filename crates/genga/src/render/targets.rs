//! Every render target: its format, who writes it, who reads it.

use super::wave_targets::WaveTargets;

/// Colour of surfaces, premultiplied, in the blend space. Written by `paint`, read by `composite`.
pub(crate) const PAINT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Reverse-Z depth of `paint` and of `gbuffer`; the latter is read by `detect` and `strokes`.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// World normal and width factor. Written by `gbuffer`, read by `detect` and `strokes`.
pub(crate) const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Object; material and user line. Written by `gbuffer`, read by `detect` and `strokes`.
pub(crate) const IDS_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;
/// Displayed base colour. Written by `gbuffer`, read by `candidates`.
pub(crate) const BASE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Depth of the picture where detection's own is smaller. Written by `depth`, read by `candidates`
/// and `strokes`.
pub(crate) const PICTURE_DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// LINE_* bits. Written by `detect`, read by `reference` and `composite`.
pub(crate) const MASK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// Coverage of the line sets, one a channel. Written by `strokes`, read by `composite`.
pub(crate) const COVERAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Base colour and ramp coordinate of the nearest stroke's surface. Written by `strokes` where a
/// line set takes its colour from there, read by `composite`.
pub(crate) const LINE_COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Glow of the waves, a layer for each order and blend space. Written by `waves`, read by
/// `composite`.
pub(crate) const GLOW_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Colours of beams, and distances of those over lines, both as `paint`. Written by `beams`, read by
/// `composite`.
const BEAM_FORMAT: wgpu::TextureFormat = PAINT_FORMAT;
/// Energy of all waves. Written by `waves`.
pub(crate) const ENERGY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// The benchmark's baseline. Written by `plain`.
pub(crate) const PLAIN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Samples per texel of the paint pass: supersampled pictures have several texels a pixel already.
pub(crate) fn paint_samples(paint_scale: u32) -> u32 {
    if paint_scale > 1 { 1 } else { 4 }
}

/// Sizes that decide the targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TargetSize {
    /// Tile in pixels.
    pub(crate) pixels: [u32; 2],
    /// Paint texels per pixel along each axis.
    pub(crate) paint_scale: u32,
    /// G-buffer texels per pixel along each axis.
    pub(crate) gbuffer_scale: Scale,
    /// Whether line sets take their colour from surfaces, or the depth of strokes is needed.
    pub(crate) line_colors: bool,
    /// Glow layers; without any there are no targets for waves.
    pub(crate) glow_layers: u32,
    /// Whether there are beams.
    pub(crate) beams: bool,
}

/// Texels per pixel along each axis, as a fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Scale {
    pub(crate) texels: u32,
    pub(crate) pixels: u32,
}

impl Scale {
    pub(crate) fn whole(texels: u32) -> Self {
        Self { texels, pixels: 1 }
    }

    pub(crate) fn factor(self) -> f32 {
        self.texels as f32 / self.pixels as f32
    }

    /// Texels that cover so many pixels.
    pub(crate) fn of(self, pixels: u32) -> u32 {
        (pixels * self.texels).div_ceil(self.pixels)
    }

    /// The texel that the middle of a pixel lies in.
    pub(crate) fn at(self, pixel: u32) -> u32 {
        (2 * pixel + 1) * self.texels / (2 * self.pixels)
    }

    /// Detection's picture is smaller than the drawn one.
    pub(crate) fn is_small(self) -> bool {
        self.texels < self.pixels
    }
}

impl TargetSize {
    /// Size of the G-buffer in texels.
    pub(crate) fn gbuffer(self) -> [u32; 2] {
        self.pixels.map(|n| self.gbuffer_scale.of(n))
    }
}

/// A texture with its view.
#[derive(Clone)]
pub(crate) struct Target {
    pub(crate) texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
}

/// The targets of one tile.
pub(crate) struct Targets {
    pub(crate) size: TargetSize,
    /// Only where the paint is multisampled.
    pub(crate) paint_samples: Option<Target>,
    pub(crate) paint: Target,
    pub(crate) paint_depth: Target,
    pub(crate) normal: Target,
    pub(crate) ids: Target,
    pub(crate) depth: Target,
    pub(crate) mask: Target,
    pub(crate) coverage: Target,
    pub(crate) base: Target,
    /// Where the G-buffer's own depth is too small.
    pub(crate) picture_depth: Option<Target>,
    /// Colours of strokes with their depth.
    pub(crate) line_colors: Option<[Target; 2]>,
    /// What stands for `line_colors` where there are none.
    pub(crate) no_colors: Target,
    /// See `marks` in `shaders/lib/line.wesl`.
    pub(crate) marks: wgpu::Buffer,
    /// See `seam_texels` in `shaders/passes/detect.wesl`.
    pub(crate) seam_texels: wgpu::Buffer,
    /// One texel without waves.
    pub(crate) glow: Target,
    pub(crate) waves: Option<WaveTargets>,
    pub(crate) beams: BeamTargets,
}

/// What beams are drawn into; one texel without any.
pub(crate) struct BeamTargets {
    /// Only where the paint is multisampled.
    pub(crate) samples: Option<Target>,
    pub(crate) place_samples: Option<Target>,
    /// Under the paint, under lines, over lines.
    pub(crate) layers: [Target; 3],
    /// See `OverLines` in `shaders/passes/beams.wesl`.
    pub(crate) places: Target,
}

impl BeamTargets {
    fn new(device: &wgpu::Device, size: TargetSize) -> Self {
        use wgpu::TextureUsages as Usage;
        let paint = if size.beams { size.pixels.map(|n| n * size.paint_scale) } else { [1, 1] };
        let samples = if size.beams { paint_samples(size.paint_scale) } else { 1 };
        let drawn = Usage::RENDER_ATTACHMENT;
        let kept =
            |label| target(device, label, paint, 1, BEAM_FORMAT, drawn | Usage::TEXTURE_BINDING);
        let sampled = |label| {
            (samples > 1).then(|| target(device, label, paint, samples, BEAM_FORMAT, drawn))
        };
        Self {
            samples: sampled("beam samples"),
            place_samples: sampled("beam place samples"),
            // Not layers of one texture: Mesa's software driver resolves samples into the wrong one.
            layers: [(); 3].map(|()| kept("beams")),
            places: kept("beam places"),
        }
    }
}

/// The glow's layers, or one texel if there are none.
fn glow_target(device: &wgpu::Device, size: TargetSize) -> Target {
    use wgpu::TextureUsages as Usage;
    let has_glow = size.glow_layers > 0;
    let [width, height] = if has_glow { size.pixels } else { [1, 1] };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("glow"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: size.glow_layers.max(1) },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: GLOW_FORMAT,
        usage: Usage::STORAGE_BINDING | Usage::TEXTURE_BINDING | Usage::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    });
    Target { texture, view }
}

/// A 2-D texture with its view.
pub(crate) fn target(
    device: &wgpu::Device,
    label: &str,
    [width, height]: [u32; 2],
    sample_count: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> Target {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    Target { texture, view }
}

impl Targets {
    /// Depth of the picture, a texel a pixel.
    pub(crate) fn full_depth(&self) -> &wgpu::TextureView {
        self.picture_depth.as_ref().map_or(&self.depth.view, |target| &target.view)
    }

    pub(crate) fn new(device: &wgpu::Device, size: TargetSize) -> Self {
        use wgpu::TextureUsages as Usage;
        let scaled = |scale: u32| size.pixels.map(|n| n * scale);
        let paint = scaled(size.paint_scale);
        let gbuffer = size.gbuffer();
        let texels = gbuffer.map(|n| n as usize).iter().product::<usize>();
        let pixels = size.pixels.map(|n| n as usize).iter().product::<usize>();
        let stored = |label, bytes: usize| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes as u64,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let drawn = Usage::RENDER_ATTACHMENT;
        let read = drawn | Usage::TEXTURE_BINDING | Usage::COPY_SRC;
        let mask_usage = Usage::STORAGE_BINDING | Usage::TEXTURE_BINDING | Usage::COPY_SRC;
        let samples = paint_samples(size.paint_scale);
        Self {
            size,
            paint_samples: (samples > 1)
                .then(|| target(device, "paint samples", paint, samples, PAINT_FORMAT, drawn)),
            paint: target(device, "paint", paint, 1, PAINT_FORMAT, read),
            paint_depth: target(
                device,
                "paint depth",
                paint,
                samples,
                DEPTH_FORMAT,
                drawn | Usage::TEXTURE_BINDING,
            ),
            normal: target(device, "normals", gbuffer, 1, NORMAL_FORMAT, read),
            ids: target(device, "ids", gbuffer, 1, IDS_FORMAT, read),
            depth: target(device, "depth", gbuffer, 1, DEPTH_FORMAT, read),
            mask: target(device, "line mask", gbuffer, 1, MASK_FORMAT, mask_usage),
            coverage: target(device, "line coverage", size.pixels, 1, COVERAGE_FORMAT, read),
            base: target(device, "base colours", gbuffer, 1, BASE_FORMAT, read),
            picture_depth: size.gbuffer_scale.is_small().then(|| {
                target(device, "picture depth", size.pixels, 1, PICTURE_DEPTH_FORMAT, read)
            }),
            line_colors: size.line_colors.then(|| {
                [
                    target(device, "line colours", size.pixels, 1, LINE_COLOR_FORMAT, read),
                    target(device, "line depth", size.pixels, 1, DEPTH_FORMAT, read),
                ]
            }),
            no_colors: target(device, "no line colours", [1, 1], 1, LINE_COLOR_FORMAT, read),
            marks: stored("marked pixels", 4 * pixels.div_ceil(32)),
            // A quarter of all texels is far more than pictures have.
            seam_texels: stored("seam texels", 4 * (texels / 4 + 64)),
            glow: glow_target(device, size),
            waves: (size.glow_layers > 0)
                .then(|| WaveTargets::new(device, size.pixels, size.glow_layers)),
            beams: BeamTargets::new(device, size),
        }
    }
}
