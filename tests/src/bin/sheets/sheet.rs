//! Pictures side by side.

use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ImageEncoder as _, Rgb, RgbImage};

/// Pixels between panels.
const GAP: u32 = 6;
/// Largest file that a repository should have to carry, in bytes.
const MOST_BYTES: usize = 300 << 10;

/// Panels of one size in rows of `columns`.
pub(crate) fn sheet(panels: &[RgbImage], columns: u32) -> RgbImage {
    let [width, height] = panels.first().map_or([0; 2], |p| [p.width(), p.height()]);
    let rows = (panels.len() as u32).div_ceil(columns);
    let sheet_size = [columns * (width + GAP) - GAP, rows * (height + GAP) - GAP];
    let mut sheet = RgbImage::from_pixel(sheet_size[0], sheet_size[1], Rgb([160; 3]));
    for (i, panel) in panels.iter().enumerate() {
        let (column, row) = (i as u32 % columns, i as u32 / columns);
        let place = [column * (width + GAP), row * (height + GAP)].map(i64::from);
        image::imageops::replace(&mut sheet, panel, place[0], place[1]);
    }
    sheet
}

/// Writes a picture as a PNG, without colours if it has none, and returns its bytes.
pub(crate) fn save(picture: &RgbImage, path: &Path) -> Result<usize, String> {
    let is_grey = picture.pixels().all(|p| p.0[0] == p.0[1] && p.0[1] == p.0[2]);
    let picture = DynamicImage::from(picture.clone());
    let picture = if is_grey { DynamicImage::from(picture.to_luma8()) } else { picture };
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
        .write_image(picture.as_bytes(), picture.width(), picture.height(), picture.color().into())
        .map_err(|error| error.to_string())?;
    if bytes.len() > MOST_BYTES {
        return Err(format!("it has {} KiB, more than {}", bytes.len() >> 10, MOST_BYTES >> 10));
    }
    std::fs::write(path, &bytes).map_err(|error| error.to_string())?;
    Ok(bytes.len())
}
