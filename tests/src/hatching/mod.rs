//! What hatching must hold, measured on pictures: distance and tone at every size, strokes that stay
//! on the surface and follow it.

pub mod directions;
pub mod pictures;
pub mod planes;
pub mod subjects;
pub mod surface;

use genga::render::Picture;
use genga::style::Style;

use crate::scenes::style;

/// Black ink on white without lines, `hatch` being the contents of `[paint.hatch]`. The light comes
/// from the right.
#[must_use]
pub fn hatching(hatch: &str, reference_height: u32) -> Style {
    style(&format!(
        "[background]\ncolor = \"#ffffff\"\n[light]\nazimuth_deg = 80\nelevation_deg = 20\n\
         pinned_to = \"world\"\nreplace_model_lights = true\n[lines]\nmethod = \"none\"\n\
         reference_height = {reference_height}\n[paint]\nbase = \"#ffffff\"\n[paint.hatch]\n{hatch}"
    ))
}

/// Coverage by ink, 0 to 1, row by row.
#[must_use]
pub fn ink_of(picture: &Picture) -> Vec<f64> {
    picture.rgba.chunks_exact(4).map(|p| 1.0 - f64::from(p[0]) / 255.0).collect()
}

/// The middle one of some numbers; 0 of none.
#[must_use]
pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
}
