//! The sRGB transfer functions (IEC 61966-2-1), for the CPU; `shaders/lib/color.wesl` has the GPU's.

/// Linear light of an encoded value, both in [0, 1].
pub(crate) fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The encoded value of linear light, both in [0, 1].
pub(crate) fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_undo_each_other() {
        for i in 0..=1000 {
            let v = i as f32 / 1000.0;
            assert!((srgb_from_linear(linear_from_srgb(v)) - v).abs() < 1e-5, "{v}");
        }
        // The standard's own mid-grey.
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-5);
    }
}
