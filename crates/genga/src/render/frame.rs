//! The uniform that every pass of a frame reads.

use glam::Vec2;

use super::{
    generated::{self as gpu, Detect, Frame, LineSet},
    prepare::{Prepared, looks::in_blend_space, shine, strokes::curves},
    targets::Scale,
    view::{Projected, View},
};
use crate::style::{
    BlendSpace, DetectScale, LineColorBy, LineMethod, LineParts, LineType, Style, Wobble,
};

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
    pub(crate) fn set_viewport(&self, pass: &mut wgpu::RenderPass<'_>, texels_per_pixel: f32) {
        let scale = texels_per_pixel;
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
    pub(crate) beams: bool,
    /// The waves' energy beside it.
    pub(crate) energy: bool,
    /// Whether the glow is dithered for 8 encoded bits a channel.
    pub(crate) dithered: bool,
    /// Straight alpha instead of premultiplied.
    pub(crate) straight: bool,
}

/// G-buffer texels per pixel: the mask that is itself the line is supersampled with the paint,
/// strokes only look things up in it.
pub(crate) fn gbuffer_scale(prepared: &Prepared, view: &View) -> Scale {
    let lines = &prepared.style.lines;
    match lines.method {
        LineMethod::Image => Scale::whole(view.supersample),
        LineMethod::Contour | LineMethod::Reference => match lines.detect.scale {
            DetectScale::Full => Scale::whole(1),
            DetectScale::TwoThirds => Scale { texels: 2, pixels: 3 },
            DetectScale::Third => Scale { texels: 1, pixels: 3 },
            DetectScale::Sixth => Scale { texels: 1, pixels: 6 },
        },
        LineMethod::None | LineMethod::Hull | LineMethod::Rim => Scale::whole(1),
    }
}

/// A `METHOD_*`.
pub(crate) fn line_method(style: &Style) -> u32 {
    match style.lines.method {
        LineMethod::None => gpu::METHOD_NONE,
        LineMethod::Contour => gpu::METHOD_CONTOUR,
        LineMethod::Reference => gpu::METHOD_REFERENCE,
        LineMethod::Hull => gpu::METHOD_HULL,
        LineMethod::Rim => gpu::METHOD_RIM,
        LineMethod::Image => gpu::METHOD_IMAGE,
    }
}

/// Whether line sets take their colour from surfaces.
pub(crate) fn has_line_colors(style: &Style) -> bool {
    style.lines.method == LineMethod::Contour
        && style.lines.sets.iter().any(|set| set.color_by != LineColorBy::Fixed)
}

/// Whether beams must know which strokes are nearer than they.
pub(crate) fn needs_line_depths(prepared: &Prepared) -> bool {
    prepared.style.lines.method == LineMethod::Contour && prepared.beams.any_over()
}

/// A line set for the GPU; `scale` is that of `line_scale`.
fn line_set(set: &crate::style::LineSet, prepared: &Prepared, view: &View, scale: f32) -> LineSet {
    let blend = prepared.style.paint.blend_space;
    let with_opacity = |color: crate::style::Color| {
        let mut color = in_blend_space(color, blend);
        color.w *= set.opacity;
        color
    };
    let flag = |on: bool, bit: u32| if on { bit } else { 0 };
    let curves = curves(set).into_iter().enumerate();
    let [dash, dash_gap] = set.dash.unwrap_or_default().map(|length| length * scale);
    let wobble = set.wobble.unwrap_or(Wobble { amplitude: 0.0, ..Wobble::default() });
    // Every drawing has a hand of its own.
    let drawing = view.frame.checked_div(wobble.redraw_every).unwrap_or(0);
    LineSet {
        color: with_opacity(set.color),
        lit_color: with_opacity(set.lit_color),
        types: if set.types.is_empty() {
            u32::MAX
        } else {
            set.types.iter().fold(0, |bits, &t| bits | type_bit(t))
        },
        flags: flag(set.parts == LineParts::Hidden, gpu::SET_HIDDEN)
            | flag(set.color_by == LineColorBy::Base, gpu::SET_COLOR_BASE)
            | flag(set.color_by == LineColorBy::Light, gpu::SET_COLOR_LIGHT)
            | curves.fold(0, |bits, (i, curve)| bits | flag(curve.is_some(), gpu::SET_CURVES << i)),
        radius: 0.5 * set.width * scale,
        radius_m: 0.5 * set.width_m.unwrap_or(0.0),
        darken: set.darken,
        dash,
        dash_gap,
        wobble: wobble.amplitude * scale,
        wobble_length: wobble.wavelength * scale,
        wobble_seed: wobble.seed.wrapping_mul(0x9e37_79b9).wrapping_add(drawing),
        depth_from: depth_from(set, prepared, view),
        reserved: 0,
    }
}

/// Distance along the camera's axis of the object that a set's depth curve counts from.
fn depth_from(set: &crate::style::LineSet, prepared: &Prepared, view: &View) -> f32 {
    let object = set.width_by.depth_from.as_ref().and_then(|name| prepared.place_of(name));
    let camera = &view.camera.world_from_camera;
    object.map_or(0.0, |p| (camera.translation - glam::Vec3A::from(p)).dot(camera.matrix3.z_axis))
}

pub(crate) fn frame_values(
    prepared: &Prepared,
    view: &View,
    projected: &Projected,
    [tile, viewport]: [Tile; 2],
    output: Output,
) -> Frame {
    let style = &prepared.style;
    let blend = style.paint.blend_space;
    let line_scale = line_scale(prepared, view);
    let no_set: LineSet = bytemuck::Zeroable::zeroed();
    let mut line_sets = [no_set; 4];
    for (slot, set) in line_sets.iter_mut().zip(&style.lines.sets) {
        *slot = line_set(set, prepared, view, line_scale);
    }
    let dots = style.paint.dots.unwrap_or_default();
    let detect = &style.lines.detect;
    let identity = |on: bool, bit: u32| if on { bit } else { 0 };
    let top = in_blend_space(style.background.color, blend);
    let bottom = style.background.bottom.map_or(top, |color| in_blend_space(color, blend));
    let flag = |on: bool, bit: u32| if on { bit } else { 0 };
    let camera = &view.camera.world_from_camera;
    let axis = |a: glam::Vec3A| glam::Vec3::from(a).extend(0.0);
    let scale = gbuffer_scale(prepared, view);
    let bent = |set: &crate::style::LineSet| set.width_by.screen_curvature.is_some();
    let lit = |set: &crate::style::LineSet| set.width_by.light.is_some();
    Frame {
        clip_from_world: projected.clip_from_world,
        eye: projected.eye,
        camera_right: axis(camera.matrix3.x_axis),
        camera_up: axis(camera.matrix3.y_axis),
        camera_back: axis(camera.matrix3.z_axis),
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
        gbuffer_scale: scale.factor(),
        min_stroke: style.lines.strokes.min_length * line_scale,
        max_gap: style.lines.strokes.gap * line_scale,
        flags: flag(blend == BlendSpace::Linear, gpu::FRAME_LINEAR_BLEND)
            | flag(projected.orthographic, gpu::FRAME_ORTHOGRAPHIC)
            | flag(output.background, gpu::FRAME_BACKGROUND)
            | flag(output.paint, gpu::FRAME_SHOW_PAINT)
            | flag(output.lines, gpu::FRAME_SHOW_LINES)
            | flag(output.straight, gpu::FRAME_OUTPUT_STRAIGHT)
            | flag(
                has_line_colors(style) || style.lines.sets.iter().any(lit),
                gpu::FRAME_LINE_COLORS,
            )
            | flag(style.lines.sets.iter().any(bent), gpu::FRAME_SCREEN_CURVATURE)
            | flag(scale.is_small(), gpu::FRAME_SMALL_DETECTION)
            | flag(needs_line_depths(prepared), gpu::FRAME_LINE_DEPTHS)
            | flag(output.beams, gpu::FRAME_SHOW_BEAMS),
        line_set_count: style.lines.sets.len().min(4) as u32,
        line_method: line_method(style),
        palette_count: style.paint.palette.len().min(16) as u32,
        dots_spacing: dots.spacing * line_scale,
        reserved_0: 0,
        line_sets,
        dots_turns: shine::screens(&dots),
        palette: shine::palette(style),
        detect: Detect {
            depth: detect.depth,
            laplacian: detect.laplacian,
            crease_cos: if detect.crease_deg > 0.0 {
                detect.crease_deg.to_radians().cos()
            } else {
                -2.0
            },
            sources: identity(detect.objects, gpu::LINE_OBJECT)
                | identity(detect.materials, gpu::LINE_MATERIAL)
                | identity(detect.user, gpu::LINE_USER)
                | identity(detect.borders, gpu::LINE_BORDER)
                | identity(detect.uv_seams, gpu::LINE_UV_SEAM)
                | identity(detect.crease_deg > 0.0, gpu::LINE_CREASE),
            max_width_factor: prepared.max_width_factor,
            max_radius: line_sets.iter().map(|set| set.radius).fold(0.0, f32::max),
            reserved_0: 0.0,
            reserved_1: 0.0,
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
    let lines = &prepared.style.lines;
    let scale = line_scale(prepared, view);
    let in_metres = lines.sets.iter().any(|set| set.width_m.is_some());
    let widest = lines.sets.iter().map(|set| set.width).fold(0.0, f32::max);
    let radius = 0.5 * widest * scale * prepared.max_width_factor.max(1.0);
    let radius = if in_metres { MAX_RADIUS } else { radius.ceil().min(MAX_RADIUS) };
    // What the ends of strokes decide: their shape, and whether they are long enough.
    let taper = lines.sets.iter().filter_map(|set| set.width_by.taper.as_ref()?.points().last());
    let taper = taper.map(|point| point[0]).fold(0.0, f32::max);
    let wobble = lines.sets.iter().filter_map(|set| set.wobble).map(|w| w.amplitude);
    let wobble = wobble.fold(0.0, f32::max);
    let strokes = 2.0 * lines.strokes.min_length + lines.strokes.gap;
    // Over which strokes become as thin as the ones that they go on in.
    let handed_over = 0.5 * HANDED_OVER * widest;
    let ends =
        ((taper + strokes + wobble + handed_over + MARGIN_REACH) * scale).ceil().clamp(0.0, 1024.0);
    radius as u32 + ends as u32 + LOOKUP_MARGIN
}

/// As in `shaders/passes/strokes.wesl` and `shaders/passes/link.wesl`.
const HANDED_OVER: f32 = 8.0;
const MARGIN_REACH: f32 = 16.0;

/// Largest half width in pixels, as in `shaders/passes/strokes.wesl`.
const MAX_RADIUS: f32 = 256.0;

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
        LineType::UvSeam => gpu::LINE_UV_SEAM,
    }
}
