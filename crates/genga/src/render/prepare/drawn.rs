//! What is the same for all pixels of a draw: its number, and what its pipeline is made for.

use glam::Vec3;

use crate::render::{
    generated::{Draw, DrawNumber},
    gpu::bindings,
    passes::surface::{BaseKind, MaterialVariant},
};
use crate::scene::{Material, Primitive};
use crate::srgb::srgb_from_linear;

/// The uniforms that say which draw it is, at dynamic offsets.
pub(super) fn numbers(device: &wgpu::Device, queue: &wgpu::Queue, draws: &[Draw]) -> wgpu::Buffer {
    // White stays white, whatever the function rounds to.
    let displayed = |linear: f32| if linear == 1.0 { 1.0 } else { srgb_from_linear(linear) };
    let number = |(draw, values): (usize, &Draw)| DrawNumber {
        draw: draw as u32,
        look_first: values.look_first,
        reserved_0: 0,
        reserved_1: 0,
        base: values.base_color.truncate().map(displayed).extend(1.0),
    };
    let values: Vec<DrawNumber> = draws.iter().enumerate().map(number).collect();
    bindings::dynamic_uniforms(device, queue, "draw numbers", &values)
}

/// What the pipeline of a primitive is made for.
pub(super) fn variant(
    material: &Material,
    primitive: &Primitive,
    has_rules: bool,
) -> MaterialVariant {
    let is_colored = primitive.colors.iter().any(|color| color.truncate() != Vec3::ONE);
    let has_texture = material.base_color_texture.is_some();
    let is_tinted = material.base_color.truncate() != Vec3::ONE;
    let base = match (is_colored, has_texture, is_tinted) {
        (false, false, _) => BaseKind::Color,
        (false, true, false) => BaseKind::Texture,
        _ => BaseKind::Product,
    };
    MaterialVariant { base, emits: material.emissive != Vec3::ZERO, has_rules }
}
