//! Comic highlights and the print's colours, as the shaders want them.

use glam::{Vec2, Vec3, Vec4};

use super::looks::in_blend_space;
use crate::render::generated::{self as gpu, PaletteColor};
use crate::srgb::linear_from_srgb;
use crate::style::{
    BlendSpace, Color, Dots, LineMethod, RimLight, Sheen, ShineBlend, Specular, SpecularForm, Style,
};

/// Which features of `shaders/shading/shine.wesl` and `print.wesl` a pipeline has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Features {
    pub(crate) specular: bool,
    pub(crate) rim_light: bool,
    pub(crate) sheen: bool,
    pub(crate) palette: bool,
    pub(crate) dots: bool,
    pub(crate) shade_pictures: bool,
    /// Colours are mixed in linear light.
    pub(crate) linear_blend: bool,
    /// Lines are made of the rim.
    pub(crate) rim_line: bool,
}

impl Features {
    /// What any look of a style has.
    pub(crate) fn of(style: &Style) -> Self {
        let (paint, overrides) = (&style.paint, || style.overrides.iter().map(|o| &o.paint));
        Self {
            specular: paint.specular.is_some() || overrides().any(|o| o.specular.is_some()),
            rim_light: paint.rim_light.is_some() || overrides().any(|o| o.rim_light.is_some()),
            sheen: paint.sheen.is_some() || overrides().any(|o| o.sheen.is_some()),
            palette: !paint.palette.is_empty(),
            dots: paint.dots.is_some(),
            shade_pictures: paint.shade_map.is_some() || overrides().any(|o| o.shade_map.is_some()),
            linear_blend: paint.blend_space == BlendSpace::Linear,
            rim_line: style.lines.method == LineMethod::Rim,
        }
    }

    /// Whether anything lies on top of the ramp.
    pub(crate) fn shines(self) -> bool {
        self.specular || self.rim_light || self.sheen
    }

    /// Without what lies on top of the ramp.
    pub(crate) fn without_shine(self) -> Self {
        Self { specular: false, rim_light: false, sheen: false, ..self }
    }
}

pub(crate) fn specular(s: &Specular, paper: Color, blend: BlendSpace) -> gpu::Specular {
    let form = if s.form == SpecularForm::Gradient { gpu::SHINE_GRADIENT } else { 0 };
    gpu::Specular {
        color: shine_color(s.color, s.strength, s.blend, paper, blend),
        translate: Vec2::from(s.translate),
        scale: Vec2::from(s.scale),
        split: Vec2::from(s.split),
        turn: turn(s.rotate_deg),
        exponent: s.exponent,
        threshold: s.threshold,
        gradient: s.gradient,
        square: s.square,
        flags: form | blend_flags(s.blend),
        reserved_0: 0,
        reserved_1: 0,
        reserved_2: 0,
    }
}

pub(crate) fn rim_light(r: &RimLight, paper: Color, blend: BlendSpace) -> gpu::RimLight {
    let (sin_a, cos_a) = r.azimuth_deg.to_radians().sin_cos();
    let (sin_e, cos_e) = r.elevation_deg.to_radians().sin_cos();
    gpu::RimLight {
        color: shine_color(r.color, r.strength, r.blend, paper, blend),
        // Behind is −Z.
        direction: Vec3::new(sin_a * cos_e, sin_e, -cos_a * cos_e),
        threshold: r.threshold,
        softness: r.softness,
        flags: blend_flags(r.blend),
        reserved_0: 0,
        reserved_1: 0,
    }
}

pub(crate) fn sheen(s: &Sheen, paper: Color, blend: BlendSpace) -> gpu::Sheen {
    gpu::Sheen {
        color: shine_color(s.color, s.strength, s.blend, paper, blend),
        turn: turn(s.lean_deg),
        spacing: s.spacing_m,
        offset: s.offset_m,
        width: s.width,
        second: s.second,
        gap: s.gap,
        flags: blend_flags(s.blend),
    }
}

fn turn(degrees: f32) -> Vec2 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec2::new(cos, sin)
}

fn blend_flags(blend: ShineBlend) -> u32 {
    match blend {
        ShineBlend::Add => 0,
        ShineBlend::Replace => gpu::SHINE_REPLACE,
        ShineBlend::Paper => gpu::SHINE_PAPER,
    }
}

fn shine_color(
    color: Color,
    strength: f32,
    blend: ShineBlend,
    paper: Color,
    space: BlendSpace,
) -> Vec4 {
    let color = if blend == ShineBlend::Paper { paper } else { color };
    let mut color = in_blend_space(color, space);
    color.w *= strength;
    color
}

/// The palette, padded with black.
pub(crate) fn palette(style: &Style) -> [PaletteColor; 16] {
    let none = PaletteColor { color: Vec4::ZERO, lab: Vec4::ZERO };
    let mut palette = [none; 16];
    for (slot, &color) in palette.iter_mut().zip(&style.paint.palette) {
        let linear = Vec3::new(color.r, color.g, color.b).map(linear_from_srgb);
        *slot = PaletteColor {
            color: in_blend_space(color, style.paint.blend_space),
            lab: oklab_from_linear(linear).extend(0.0),
        };
    }
    palette
}

/// Oklab (Ottosson 2020) of linear RGB.
fn oklab_from_linear(c: Vec3) -> Vec3 {
    let roots = Vec3::new(
        c.dot(Vec3::new(0.412_221_46, 0.536_332_55, 0.051_445_995)),
        c.dot(Vec3::new(0.211_903_5, 0.680_699_5, 0.107_396_96)),
        c.dot(Vec3::new(0.088_302_46, 0.281_718_85, 0.629_978_7)),
    )
    .map(|x| x.max(0.0).cbrt());
    Vec3::new(
        roots.dot(Vec3::new(0.210_454_26, 0.793_617_8, -0.004_072_047)),
        roots.dot(Vec3::new(1.977_998_5, -2.428_592_2, 0.450_593_7)),
        roots.dot(Vec3::new(0.025_904_037, 0.782_771_77, -0.808_675_77)),
    )
}

/// Cosines and sines of the print's screens: cyan, magenta; yellow.
pub(crate) fn screens(dots: &Dots) -> [Vec4; 2] {
    let [c, m, y] = dots.angles_deg.map(turn);
    [Vec4::new(c.x, c.y, m.x, m.y), Vec4::new(y.x, y.y, 0.0, 0.0)]
}
