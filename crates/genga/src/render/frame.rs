//! The uniform that every pass of a frame reads.

use glam::Vec2;

use super::{
    generated::{self as gpu, Detect, Frame, LineSet},
    prepare::{Prepared, looks::in_blend_space},
    view::{Projected, View},
};
use crate::style::{BlendSpace, LineMethod, LineType};

/// A part of the picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Tile {
    pub(crate) origin: [u32; 2],
    pub(crate) size: [u32; 2],
}

/// What the viewport of the passes that draw surfaces spans: the whole picture, if the device can
/// have such a viewport, so that triangles are clipped alike in every tile; or else the tile.
pub(crate) fn viewport(device: &wgpu::Device, view: &View, tile: Tile) -> Tile {
    let limit = device.limits().max_texture_dimension_2d / view.supersample.max(1);
    if view.size.iter().all(|&side| side <= limit) {
        Tile { origin: [0, 0], size: view.size }
    } else {
        tile
    }
}

/// Where the passes that draw surfaces look from, and to.
pub(crate) struct Aim {
    /// As `Frame::eye`, for sorting.
    pub(crate) eye: glam::Vec4,
    pub(crate) tile: Tile,
    /// See [`viewport`].
    pub(crate) viewport: Tile,
}

impl Aim {
    /// Sets the viewport, which may begin before the target does.
    pub(crate) fn set_viewport(&self, pass: &mut wgpu::RenderPass<'_>, texels_per_pixel: u32) {
        let scale = texels_per_pixel as f32;
        let (tile, viewport) = (self.tile, self.viewport);
        let at = |axis: usize| (viewport.origin[axis] as f32 - tile.origin[axis] as f32) * scale;
        let [width, height] = viewport.size.map(|side| side as f32 * scale);
        pass.set_viewport(at(0), at(1), width, height, 0.0, 1.0);
    }
}

/// What a composite shows and how it is stored.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Output {
    pub(crate) background: bool,
    pub(crate) paint: bool,
    pub(crate) lines: bool,
    /// The waves.
    pub(crate) glow: bool,
    /// Whether the glow is dithered for 8 bits a channel.
    pub(crate) dithered: bool,
    /// Linear light instead of sRGB-encoded values.
    pub(crate) linear: bool,
    /// Straight alpha instead of premultiplied.
    pub(crate) straight: bool,
}

/// G-buffer texels per pixel: the mask that is itself the line is supersampled with the paint,
/// strokes only look things up in it.
pub(crate) fn gbuffer_scale(prepared: &Prepared, view: &View) -> u32 {
    if prepared.style.lines.method == LineMethod::Image { view.supersample } else { 1 }
}

pub(crate) fn frame_values(
    prepared: &Prepared,
    view: &View,
    projected: &Projected,
    [tile, viewport]: [Tile; 2],
    output: Output,
    light_count: u32,
) -> Frame {
    let style = &prepared.style;
    let blend = style.paint.blend_space;
    let line_scale = line_scale(prepared, view);
    let no_set: LineSet = bytemuck::Zeroable::zeroed();
    let mut line_sets = [no_set; 4];
    for (slot, set) in line_sets.iter_mut().zip(&style.lines.sets) {
        let mut color = in_blend_space(set.color, blend);
        color.w *= set.opacity;
        slot.color = color;
        slot.types = if set.types.is_empty() {
            u32::MAX
        } else {
            set.types.iter().fold(0, |bits, &t| bits | type_bit(t))
        };
        slot.radius = 0.5 * set.width * line_scale;
    }
    let detect = &style.lines.detect;
    let identity = |on: bool, bit: u32| if on { bit } else { 0 };
    let top = in_blend_space(style.background.color, blend);
    let bottom = style.background.bottom.map_or(top, |color| in_blend_space(color, blend));
    let flag = |on: bool, bit: u32| if on { bit } else { 0 };
    Frame {
        clip_from_world: projected.clip_from_world,
        eye: projected.eye,
        background_top: top,
        background_bottom: bottom,
        picture_size: vec2(view.size),
        tile_origin: vec2(tile.origin),
        tile_size: vec2(tile.size),
        viewport_origin: vec2(viewport.origin),
        viewport_size: vec2(viewport.size),
        depth_range: projected.depth_range,
        pixel_footprint: projected.pixel_footprint,
        line_scale,
        paint_scale: view.supersample as f32,
        gbuffer_scale: gbuffer_scale(prepared, view) as f32,
        light_count,
        flags: flag(blend == BlendSpace::Linear, gpu::FRAME_LINEAR_BLEND)
            | flag(projected.orthographic, gpu::FRAME_ORTHOGRAPHIC)
            | flag(output.background, gpu::FRAME_BACKGROUND)
            | flag(output.linear, gpu::FRAME_OUTPUT_LINEAR)
            | flag(output.paint, gpu::FRAME_SHOW_PAINT)
            | flag(output.lines, gpu::FRAME_SHOW_LINES)
            | flag(output.straight, gpu::FRAME_OUTPUT_STRAIGHT),
        line_set_count: style.lines.sets.len().min(4) as u32,
        line_method: match style.lines.method {
            LineMethod::None => gpu::METHOD_NONE,
            LineMethod::Contour => gpu::METHOD_CONTOUR,
            LineMethod::Reference => gpu::METHOD_REFERENCE,
            LineMethod::Hull => gpu::METHOD_HULL,
            LineMethod::Rim => gpu::METHOD_RIM,
            LineMethod::Image => gpu::METHOD_IMAGE,
        },
        line_sets,
        detect: Detect {
            depth: detect.depth,
            crease_cos: if detect.crease_deg > 0.0 {
                detect.crease_deg.to_radians().cos()
            } else {
                -2.0
            },
            identities: identity(detect.objects, gpu::LINE_OBJECT)
                | identity(detect.materials, gpu::LINE_MATERIAL)
                | identity(detect.user, gpu::LINE_USER),
            max_width_factor: prepared.max_width_factor,
        },
    }
}

/// Pixels per pixel at the style's reference height.
pub(crate) fn line_scale(prepared: &Prepared, view: &View) -> f32 {
    view.size[1] as f32 / prepared.style.lines.reference_height.max(1.0)
}

/// Pixels along a line that decide what is drawn at a place of it: see `walk` in
/// `shaders/passes/candidates.wesl`.
const LOOKUP_MARGIN: u32 = 48;

/// Pixels that a tile needs on each side beyond what it keeps: half the widest line, and what the
/// walk along lines looks at.
pub(crate) fn apron(prepared: &Prepared, view: &View) -> u32 {
    let widest = prepared.style.lines.sets.iter().map(|set| set.width).fold(0.0, f32::max);
    let radius = 0.5 * widest * line_scale(prepared, view) * prepared.max_width_factor.max(1.0);
    radius.ceil().min(256.0) as u32 + LOOKUP_MARGIN
}

fn vec2(n: [u32; 2]) -> Vec2 {
    Vec2::new(n[0] as f32, n[1] as f32)
}

fn type_bit(line_type: LineType) -> u32 {
    match line_type {
        LineType::Silhouette => gpu::LINE_SILHOUETTE,
        LineType::Crease => gpu::LINE_CREASE,
        LineType::Object => gpu::LINE_OBJECT,
        LineType::Material => gpu::LINE_MATERIAL,
        LineType::Border => gpu::LINE_BORDER,
        LineType::User => gpu::LINE_USER,
    }
}
