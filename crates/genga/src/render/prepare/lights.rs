//! Lights as the ramp sees them, for one camera.

use glam::{Affine3A, Vec3, Vec4};

use crate::render::generated::{LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SKY, LIGHT_SPOT, Light};
use crate::render::prepare::looks::in_blend_space;
use crate::scene::{LightKind, Pose, Scene};
use crate::srgb::srgb_from_linear;
use crate::style::{Color, PinnedTo, Style, StyleLight};

/// A light of the scene with the place of its node.
#[derive(Clone, Debug)]
pub(crate) struct PlacedLight {
    /// Its node.
    pub(crate) node: usize,
    kind: LightKind,
    strength: f32,
    world_from_light: Affine3A,
    pinned_to_camera: bool,
    casts_shadow: bool,
    /// In the blend space, the greatest channel 1.
    color: Vec4,
}

impl PlacedLight {
    /// Whether it is not white.
    pub(crate) fn has_color(&self) -> bool {
        self.color != Vec4::ONE
    }

    /// Whether it shines from a place, and not from a direction.
    pub(crate) fn has_place(&self) -> bool {
        matches!(self.kind, LightKind::Point { .. } | LightKind::Spot { .. })
    }
}

/// Lights that the shaders take at once.
pub(crate) const MAX_LIGHTS: usize = 16;

/// The lights of a posed scene, the strongest first and skies last; empty if the style's own light
/// is to be used alone.
pub(crate) fn placed_lights(scene: &Scene, pose: &Pose, style: &Style) -> Vec<PlacedLight> {
    if style.light.replace_model_lights {
        return Vec::new();
    }
    let nodes = scene.nodes.iter().enumerate().filter(|&(i, _)| pose.visible[i]);
    let mut lights: Vec<_> = nodes
        .filter_map(|(i, node)| {
            let light = scene.lights.get(node.light?)?;
            // How bright a light is and its colour are told apart: a red one is as bright as a
            // white one in red.
            let brightest = light.color.max_element();
            let [r, g, b] = (light.color / brightest).max(Vec3::ZERO).to_array().map(|c| {
                // White is exactly 1: its pipelines know nothing of colours.
                let displayed = if c < 1.0 { srgb_from_linear(c) } else { 1.0 };
                1.0 + style.paint.light_color * (displayed - 1.0)
            });
            Some(PlacedLight {
                node: i,
                kind: light.kind,
                strength: (light.intensity * brightest).max(0.0),
                world_from_light: pose.world_from_node[i],
                pinned_to_camera: light.pinned_to_camera,
                casts_shadow: light.casts_shadow,
                color: in_blend_space(Color { r, g, b, a: 1.0 }, style.paint.blend_space),
            })
        })
        .filter(|light| light.strength > 0.0)
        .collect();
    let is_sky = |light: &PlacedLight| light.kind == LightKind::Sky;
    lights.sort_by(|a, b| is_sky(a).cmp(&is_sky(b)).then(b.strength.total_cmp(&a.strength)));
    lights
}

/// Whether the scene has lights other than skies.
fn has_own_light(placed: &[PlacedLight]) -> bool {
    placed.iter().any(|light| light.kind != LightKind::Sky)
}

/// How many lights [`lights_in_view`] gives.
pub(crate) fn light_count(placed: &[PlacedLight]) -> usize {
    (placed.len() + usize::from(!has_own_light(placed))).min(MAX_LIGHTS)
}

/// The lights for a camera. Their weights `w_i` add up to 1. Where there are only skies, the
/// style's own light comes before them, as strong as an intensity of 1.
pub(crate) fn lights_in_view(
    placed: &[PlacedLight],
    style: &StyleLight,
    world_from_camera: &Affine3A,
) -> Vec<Light> {
    let has_own = has_own_light(placed);
    let placed = &placed[..light_count(placed) - usize::from(!has_own)];
    let of_style = if has_own { 0.0 } else { 1.0 };
    let total = of_style + placed.iter().map(|light| light.strength).sum::<f32>();
    // Out of a lamp's reach is shade, like a surface turned away, but what the sun shines on is lit.
    let has_sun = placed.iter().any(|light| light.kind == LightKind::Directional);
    let beyond_reach = if has_sun { 0.0 } else { -1.0 };
    let of_style = (!has_own).then(|| style_light(style, of_style / total, world_from_camera));
    of_style
        .into_iter()
        .chain(placed.iter().map(|light| {
            let frame = if light.pinned_to_camera {
                *world_from_camera * light.world_from_light
            } else {
                light.world_from_light
            };
            // A light shines along its node's −Z.
            let back = Vec3::from(frame.matrix3.z_axis).normalize_or(Vec3::Z);
            let (kind, direction, range, cones) = match light.kind {
                LightKind::Directional => (LIGHT_DIRECTIONAL, back, None, [1.0, 0.0]),
                LightKind::Point { range } => (LIGHT_POINT, -back, range, [1.0, 0.0]),
                LightKind::Spot { range, inner_angle, outer_angle } => {
                    (LIGHT_SPOT, -back, range, [inner_angle.cos(), outer_angle.cos()])
                }
                LightKind::Sky => {
                    let up = Vec3::from(frame.matrix3.y_axis).normalize_or(Vec3::Y);
                    (LIGHT_SKY, up, None, [1.0, 0.0])
                }
            };
            Light {
                position: Vec3::from(frame.translation).extend(1.0),
                direction: direction.extend(beyond_reach),
                factors: Vec4::new(
                    light.strength / total,
                    range.unwrap_or(0.0),
                    cones[0],
                    cones[1],
                ),
                kind,
                shadow_first: 0,
                shadow_maps: if light.casts_shadow { shadow_maps(light.kind) } else { 0 },
                reserved_0: 0,
                color: light.color,
            }
        }))
        .collect()
}

/// Half angle in radians up to which a spot's cone is one shadow map; wider ones take a cube.
const WIDEST_MAP: f32 = 1.1;

/// How many shadow maps a light needs.
pub(crate) fn shadow_maps(kind: LightKind) -> u32 {
    match kind {
        LightKind::Directional => 1,
        LightKind::Spot { outer_angle, .. } if outer_angle <= WIDEST_MAP => 1,
        LightKind::Spot { .. } | LightKind::Point { .. } => 6,
        LightKind::Sky => 0,
    }
}

fn style_light(style: &StyleLight, weight: f32, world_from_camera: &Affine3A) -> Light {
    let (sin_a, cos_a) = style.azimuth_deg.to_radians().sin_cos();
    let (sin_e, cos_e) = style.elevation_deg.to_radians().sin_cos();
    let mut direction = Vec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
    if style.pinned_to == PinnedTo::Camera {
        direction = world_from_camera.transform_vector3(direction);
    }
    Light {
        position: Vec4::ZERO,
        direction: direction.normalize_or(Vec3::Y).extend(0.0),
        factors: Vec4::new(weight, 0.0, 1.0, 0.0),
        kind: LIGHT_DIRECTIONAL,
        shadow_first: 0,
        shadow_maps: shadow_maps(LightKind::Directional),
        reserved_0: 0,
        color: Vec4::ONE,
    }
}
