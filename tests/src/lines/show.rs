//! Pictures of drawn lines under expected ones, to look at where a figure is wrong.

use std::path::PathBuf;

use image::{Rgb, RgbImage};

use super::figures::Sight;
use super::ink::Ink;
use super::places::Seen;
use crate::scenes::root;

/// Pixels along the sides of a drawn pixel.
const FACTOR: u32 = 4;

/// Ink in grey, lines that must be seen in green, those that may be in orange, hidden ones in
/// pale blue.
#[must_use]
pub fn overlay(ink: &Ink, sight: &Sight) -> RgbImage {
    let mut picture = RgbImage::from_fn(FACTOR * ink.width, FACTOR * ink.height, |x, y| {
        let value = ink.at(i64::from(x / FACTOR), i64::from(y / FACTOR));
        Rgb([255 - value / 3 * 2; 3])
    });
    let mut places: Vec<_> = sight.places.iter().collect();
    places.sort_by_key(|place| place.seen);
    for place in places {
        let color = match place.seen {
            Seen::Not => [170, 190, 255],
            Seen::Maybe => [255, 140, 0],
            Seen::Wholly => [0, 160, 0],
        };
        let at = (place.p_px * f64::from(FACTOR)).as_uvec2();
        if at.x < picture.width() && at.y < picture.height() {
            picture.put_pixel(at.x, at.y, Rgb(color));
        }
    }
    picture
}

/// Leaves an overlay in `out/lines` and returns its path.
///
/// # Panics
/// If it cannot be written.
pub fn leave(ink: &Ink, sight: &Sight, name: &str) -> PathBuf {
    let folder = root().join("out/lines");
    std::fs::create_dir_all(&folder).expect("the folder for pictures can be made");
    let path = folder.join(format!("{name}.png"));
    overlay(ink, sight).save(&path).expect("the picture can be written");
    path
}
