//! Looks: the style with the overrides that apply to a part of the scene. Selectors that name
//! objects and materials are decided here; those that look at pixels become rules, and every
//! combination of them one look.

use std::{collections::HashMap, sync::Arc};

use glam::{Vec2, Vec3, Vec4};

use super::shine;
use crate::render::generated::{self as gpu, Look, Rule, Tone};
use crate::render::passes::surface::HatchVariant;
use crate::scene::Image;
use crate::srgb::linear_from_srgb;
use crate::style::{
    BaseColor, BlendSpace, Color, Hatch, HatchDirection, HatchMapping, HatchPattern, Lines,
    Override, Paint, Ramp, ShadeSource, Style, ToneBlend,
};

/// Most per-pixel selectors that can apply to one object and material: each doubles its looks.
pub(crate) const MAX_RULES: usize = 6;
/// Width of the texture that holds the ramp pictures.
pub(crate) const RAMP_PICTURE_WIDTH: u32 = 1024;

/// Where a draw finds its looks and rules.
#[derive(Clone, Debug)]
pub(crate) struct LookRange {
    pub(crate) look_first: u32,
    pub(crate) rule_first: u32,
    pub(crate) rule_count: u32,
    /// Whether it casts shadows.
    pub(crate) casts_shadow: bool,
    /// Picture of the shade map.
    pub(crate) shade_image: Option<Arc<Image>>,
    /// Picture of the id-texture selectors, if there are any.
    pub(crate) id_image: Option<Arc<Image>>,
    pub(crate) hatch: HatchRange,
}

/// What the looks of a draw hatch with.
#[derive(Clone, Debug, Default)]
pub(crate) struct HatchRange {
    /// What its pipeline needs; `None` if nothing is hatched.
    pub(crate) variant: Option<HatchVariant>,
    /// Whose directions the vertices get, if any look takes theirs.
    pub(crate) direction: Option<HatchDirection>,
    pub(crate) image: Option<Arc<Image>>,
    /// Whether texture coordinates are needed.
    pub(crate) on_uv: bool,
}

impl HatchRange {
    fn include(&mut self, hatch: &Hatch) {
        let no_image = hatch.pattern == HatchPattern::Image && hatch.image.is_none();
        if hatch.pattern == HatchPattern::None || no_image {
            return;
        }
        let mut variant = self.variant.unwrap_or_default();
        let is_drawn = match hatch.pattern {
            HatchPattern::Strokes | HatchPattern::Pencil => {
                variant.has_strokes = true;
                variant.has_pencil |= hatch.pattern == HatchPattern::Pencil;
                true
            }
            HatchPattern::Cross => {
                variant.has_strokes = true;
                variant.has_cross = true;
                true
            }
            HatchPattern::Stipple => {
                variant.has_stipple = true;
                true
            }
            HatchPattern::Image => {
                variant.has_image = true;
                self.image = self.image.take().or_else(|| hatch.image.clone());
                true
            }
            HatchPattern::Dots => {
                variant.has_dots = true;
                false
            }
            HatchPattern::None | HatchPattern::Solid => false,
        };
        if is_drawn && hatch.mapping == HatchMapping::Surface {
            variant.has_surface = true;
            match hatch.direction {
                HatchDirection::Light => variant.has_light = true,
                HatchDirection::Fixed => variant.has_axis = true,
                direction => self.direction = self.direction.or(Some(direction)),
            }
        } else if is_drawn {
            variant.has_plane = true;
            self.on_uv |= hatch.mapping == HatchMapping::Uv;
        }
        self.variant = Some(variant);
    }
}

/// Looks and rules of a scene under a style.
pub(crate) struct Looks<'a> {
    style: &'a Style,
    pub(crate) looks: Vec<Look>,
    pub(crate) rules: Vec<Rule>,
    /// Rows of RGBA8.
    pub(crate) ramp_rows: Vec<u8>,
    ramp_images: Vec<Arc<Image>>,
    ranges: HashMap<Vec<usize>, LookRange>,
    pub(crate) warnings: Vec<String>,
}

impl<'a> Looks<'a> {
    pub(crate) fn new(style: &'a Style) -> Self {
        Self {
            style,
            looks: Vec::new(),
            rules: Vec::new(),
            ramp_rows: Vec::new(),
            ramp_images: Vec::new(),
            ranges: HashMap::new(),
            warnings: Vec::new(),
        }
    }

    /// Whether any look so far has stipple.
    pub(crate) fn have_stipple(&self) -> bool {
        self.looks.iter().any(|look| look.hatch.pattern == gpu::HATCH_STIPPLE)
    }

    /// The looks of one object's part of one material.
    pub(crate) fn range(&mut self, object: &str, material: &str) -> LookRange {
        let style = self.style;
        let mut applying: Vec<usize> = Vec::new();
        let mut rule_count = 0;
        for (i, o) in style.overrides.iter().enumerate() {
            if !o.select.matches(object, material) {
                continue;
            }
            if o.select.is_per_pixel() {
                if rule_count == MAX_RULES {
                    self.warn(format!(
                        "object '{object}', material '{material}': more than {MAX_RULES} selectors by \
                         colour apply; the later ones are ignored"
                    ));
                    continue;
                }
                rule_count += 1;
            }
            applying.push(i);
        }
        if let Some(range) = self.ranges.get(&applying) {
            return range.clone();
        }
        let range = self.add(&applying, object, material);
        self.ranges.insert(applying, range.clone());
        range
    }

    fn add(&mut self, applying: &[usize], object: &str, material: &str) -> LookRange {
        let style = self.style;
        let overrides: Vec<&Override> = applying.iter().map(|&i| &style.overrides[i]).collect();
        let per_pixel: Vec<&Override> =
            overrides.iter().copied().filter(|o| o.select.is_per_pixel()).collect();
        let mut id_image: Option<Arc<Image>> = None;
        let rule_first = self.rules.len() as u32;
        for o in &per_pixel {
            let mut rule = rule_of(o);
            if let Some(id) = &o.select.id_texture {
                match &id_image {
                    Some(first) if !Arc::ptr_eq(first, &id.image) && **first != *id.image => {
                        self.warn(format!(
                            "object '{object}', material '{material}': selectors use more than one id \
                             texture; only the first one counts"
                        ));
                        // A rule that can never hold.
                        rule.id_tolerance = -1.0;
                    }
                    _ => id_image = Some(Arc::clone(&id.image)),
                }
            }
            self.rules.push(rule);
        }
        let look_first = self.looks.len() as u32;
        let mut hatch = HatchRange::default();
        for combination in 0..1_u32 << per_pixel.len() {
            let (mut paint, mut lines) = (style.paint.clone(), LineLook::default());
            let mut bit = 0;
            for o in &overrides {
                let holds = if o.select.is_per_pixel() {
                    bit += 1;
                    combination >> (bit - 1) & 1 == 1
                } else {
                    true
                };
                if holds {
                    apply(o, &mut paint, &mut lines);
                }
            }
            if paint.hatch.pattern == HatchPattern::Image && paint.hatch.image.is_none() {
                self.warn(format!(
                    "object '{object}', material '{material}': its hatching is an image, but the \
                     style names none: none is drawn"
                ));
            }
            hatch.include(&paint.hatch);
            let look = self.look(&paint, &lines);
            self.looks.push(look);
        }
        let by_name = overrides.iter().filter(|o| !o.select.is_per_pixel());
        // One picture a surface: that of the last override by name, or the style's.
        let mut maps = by_name.clone().filter_map(|o| o.paint.shade_map.as_ref());
        let map = maps.next_back().or(style.paint.shade_map.as_ref());
        let shade_image = map.and_then(|map| map.image.clone());
        let casts_shadow = by_name.filter_map(|o| o.paint.shadow.cast).next_back().unwrap_or(true);
        LookRange {
            look_first,
            rule_first,
            rule_count: per_pixel.len() as u32,
            casts_shadow,
            shade_image,
            id_image,
            hatch,
        }
    }

    fn look(&mut self, paint: &Paint, lines: &LineLook) -> Look {
        let blend = self.style.paint.blend_space;
        let mut look: Look = bytemuck::Zeroable::zeroed();
        match paint.base {
            BaseColor::Model => {}
            BaseColor::None => look.flags |= gpu::LOOK_BASE_NONE,
            BaseColor::Fixed(color) => {
                look.flags |= gpu::LOOK_BASE_FIXED;
                look.fixed_color = Vec4::from(color.to_array());
            }
            BaseColor::Paper => {
                look.flags |= gpu::LOOK_BASE_FIXED;
                look.fixed_color = Vec4::from(self.style.background.color.to_array());
            }
        }
        if paint.ramp.smooth {
            look.flags |= gpu::LOOK_SMOOTH_RAMP;
        }
        if let Some(image) = &paint.ramp.image {
            look.flags |= gpu::LOOK_RAMP_IMAGE;
            look.ramp_row = self.ramp_row(image);
        }
        let tones = tones_of(&paint.ramp, blend);
        look.tone_count = tones.len() as u32;
        look.tones[..tones.len()].copy_from_slice(&tones);
        look.gain = paint.ramp.gain;
        look.shade_bias = paint.shade_bias;
        look.shade_source = gpu::SHADE_FROM_NOTHING;
        if let Some(map) = &paint.shade_map {
            look.shade_strength = map.strength;
            look.shade_source = match map.from {
                ShadeSource::VertexRed => 0,
                ShadeSource::VertexGreen => 1,
                ShadeSource::VertexBlue => 2,
                ShadeSource::VertexAlpha => 3,
                ShadeSource::Picture if map.image.is_some() => gpu::SHADE_FROM_PICTURE,
                ShadeSource::Picture => gpu::SHADE_FROM_NOTHING,
            };
        }
        let paper = self.style.background.color;
        if let Some(specular) = &paint.specular {
            look.specular = shine::specular(specular, paper, blend);
        }
        if let Some(rim_light) = &paint.rim_light {
            look.rim_light = shine::rim_light(rim_light, paper, blend);
        }
        if let Some(sheen) = &paint.sheen {
            look.sheen = shine::sheen(sheen, paper, blend);
        }
        look.shadow_tone = paint.shadow.tone;
        if !paint.shadow.receive {
            look.flags |= gpu::LOOK_UNSHADOWED;
        }
        let Lines { rim, hull, .. } = &self.style.lines;
        look.line_width = if lines.visible { lines.width } else { 0.0 };
        look.line_id = u32::from(lines.line_id);
        look.rim_threshold = rim.threshold;
        look.rim_softness = rim.softness;
        look.hull_width_m = hull.width_m.unwrap_or(0.0);
        look.hatch = hatch_of(&paint.hatch, blend);
        look
    }

    fn ramp_row(&mut self, image: &Arc<Image>) -> u32 {
        if let Some(row) = self.ramp_images.iter().position(|known| Arc::ptr_eq(known, image)) {
            return row as u32;
        }
        self.ramp_images.push(Arc::clone(image));
        let middle = image.height as usize / 2 * image.width as usize;
        let texel = |x: usize, c: usize| {
            f32::from(image.rgba.get(4 * (middle + x) + c).copied().unwrap_or(255))
        };
        let last = image.width.saturating_sub(1) as usize;
        for i in 0..RAMP_PICTURE_WIDTH {
            let x = (i as f32 + 0.5) / RAMP_PICTURE_WIDTH as f32 * image.width as f32 - 0.5;
            let x = x.clamp(0.0, last as f32);
            let (left, part) = (x.floor() as usize, x.fract());
            for c in 0..4 {
                let value = texel(left, c) * (1.0 - part) + texel((left + 1).min(last), c) * part;
                self.ramp_rows.push(value.round() as u8);
            }
        }
        self.ramp_images.len() as u32 - 1
    }

    /// Largest width factor of any look.
    pub(crate) fn max_width_factor(&self) -> f32 {
        self.looks.iter().map(|look| look.line_width).fold(0.0, f32::max)
    }

    pub(crate) fn warn(&mut self, warning: String) {
        if self.warnings.len() < 20 && !self.warnings.contains(&warning) {
            self.warnings.push(warning);
        }
    }
}

struct LineLook {
    visible: bool,
    width: f32,
    line_id: u16,
}

impl Default for LineLook {
    fn default() -> Self {
        Self { visible: true, width: 1.0, line_id: 0 }
    }
}

fn apply(o: &Override, paint: &mut Paint, lines: &mut LineLook) {
    if let Some(base) = o.paint.base {
        paint.base = base;
    }
    if let Some(ramp) = &o.paint.ramp {
        paint.ramp = ramp.clone();
    }
    if let Some(hatch) = &o.paint.hatch {
        paint.hatch = hatch.clone();
    }
    if let Some(bias) = o.paint.shade_bias {
        paint.shade_bias = bias;
    }
    if let Some(map) = &o.paint.shade_map {
        paint.shade_map = Some(map.clone());
    }
    paint.specular = o.paint.specular.or(paint.specular);
    paint.rim_light = o.paint.rim_light.or(paint.rim_light);
    paint.sheen = o.paint.sheen.or(paint.sheen);
    if let Some(tone) = o.paint.shadow.tone {
        paint.shadow.tone = tone;
    }
    if let Some(receive) = o.paint.shadow.receive {
        paint.shadow.receive = receive;
    }
    if let Some(visible) = o.lines.visible {
        lines.visible = visible;
    }
    if let Some(width) = o.lines.width {
        lines.width = width;
    }
    if let Some(id) = o.lines.line_id {
        lines.line_id = id;
    }
}

fn hatch_of(hatch: &Hatch, blend: BlendSpace) -> gpu::Hatch {
    let turn = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vec2::new(cos, sin)
    };
    let mut result = gpu::Hatch {
        color: in_blend_space(hatch.color, blend),
        axis: Vec3::from(hatch.axis).extend(0.0),
        turn: turn(hatch.angle_deg),
        cross_turn: turn(hatch.cross_angle_deg),
        pattern: match hatch.pattern {
            HatchPattern::None => gpu::HATCH_NONE,
            HatchPattern::Strokes => gpu::HATCH_STROKES,
            HatchPattern::Cross => gpu::HATCH_CROSS,
            HatchPattern::Solid => gpu::HATCH_SOLID,
            HatchPattern::Stipple => gpu::HATCH_STIPPLE,
            HatchPattern::Pencil => gpu::HATCH_PENCIL,
            HatchPattern::Dots => gpu::HATCH_DOTS,
            HatchPattern::Image => gpu::HATCH_IMAGE,
        },
        mapping: match hatch.mapping {
            HatchMapping::Surface => gpu::HATCH_ON_SURFACE,
            HatchMapping::Uv => gpu::HATCH_ON_UV,
            HatchMapping::Screen => gpu::HATCH_ON_SCREEN,
        },
        direction: match hatch.direction {
            HatchDirection::Light => gpu::HATCH_BY_LIGHT,
            HatchDirection::Fixed => gpu::HATCH_FIXED,
            HatchDirection::Curvature | HatchDirection::Bone | HatchDirection::Painted => 0,
        },
        threshold: hatch.threshold,
        spacing: hatch.spacing,
        length: hatch.length,
        irregularity: hatch.irregularity,
        base_tone: hatch.base_tone,
        cross_below: hatch.cross_below,
        seed: hatch.seed.wrapping_mul(0x9e37_79b9),
        dot_spacing: 1.0 / (hatch.lines_per_inch * hatch.page_height_in).max(1e-3),
        ..bytemuck::Zeroable::zeroed()
    };
    for (slot, tone) in result.tones.iter_mut().zip(&hatch.tones) {
        *slot = Vec4::new(tone.at, tone.lum, 0.0, 0.0);
        result.tone_count += 1;
    }
    result
}

fn tones_of(ramp: &Ramp, blend: BlendSpace) -> Vec<Tone> {
    let stops = ramp.stops.iter().take(8);
    stops
        .map(|stop| Tone {
            color: in_blend_space(stop.color, blend),
            at: stop.at,
            softness: stop.softness,
            replace: f32::from(stop.blend == ToneBlend::Replace),
            reserved_0: 0.0,
        })
        .collect()
}

/// A colour as the shaders of that blend space want it (straight alpha).
pub(crate) fn in_blend_space(color: Color, blend: BlendSpace) -> Vec4 {
    match blend {
        BlendSpace::Display => Vec4::from(color.to_array()),
        BlendSpace::Linear => {
            Vec3::new(color.r, color.g, color.b).map(linear_from_srgb).extend(color.a)
        }
    }
}

fn rule_of(o: &Override) -> Rule {
    let mut rule: Rule = bytemuck::Zeroable::zeroed();
    if let Some(range) = &o.select.base_color {
        rule.conditions |= gpu::RULE_BASE_COLOR;
        // Half an 8-bit step of slack, so that a bound written from a picked colour includes it.
        let slack = 0.5 / 255.0;
        rule.base_low =
            Vec4::new(range.hue[0], range.saturation[0] - slack, range.value[0] - slack, 0.0);
        rule.base_high =
            Vec4::new(range.hue[1], range.saturation[1] + slack, range.value[1] + slack, 0.0);
    }
    if let Some(range) = &o.select.vertex_color {
        rule.conditions |= gpu::RULE_VERTEX_COLOR;
        let slack = 0.5 / 255.0;
        let [r, g, b, a] = [range.red, range.green, range.blue, range.alpha];
        rule.vertex_low = Vec4::new(r[0], g[0], b[0], a[0]) - slack;
        rule.vertex_high = Vec4::new(r[1], g[1], b[1], a[1]) + slack;
    }
    if let Some(id) = &o.select.id_texture {
        rule.conditions |= gpu::RULE_ID_TEXTURE;
        rule.id_color = Vec4::from(id.color.to_array());
        rule.id_tolerance = id.tolerance + 0.5 / 255.0;
    }
    rule
}
