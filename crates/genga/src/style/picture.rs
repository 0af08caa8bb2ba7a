//! Pictures that a style refers to by path.

use std::path::Path;
use std::sync::Arc;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

use crate::scene::Image;

/// The picture at the path in the file (made absolute or relative to the current directory).
pub(super) fn load<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Arc<Image>, D::Error> {
    let path = String::deserialize(deserializer)?;
    open(Path::new(&path)).map(Arc::new).map_err(D::Error::custom)
}

/// As [`load`], for a key that may be missing.
pub(super) fn load_some<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Arc<Image>>, D::Error> {
    load(deserializer).map(Some)
}

/// Longest side in pixels: the most that common graphics adapters take.
const MAX_SIDE: u32 = 16_384;

/// The picture of a file, or the end of a sentence that says why there is none.
pub(crate) fn open(path: &Path) -> Result<Image, String> {
    let shown = path.display();
    // Reading a pipe or a device might never end.
    if path.metadata().is_ok_and(|metadata| !metadata.is_file()) {
        return Err(format!("must be a picture, but '{shown}' is not a file"));
    }
    let mut reader = image::ImageReader::open(path)
        .and_then(image::ImageReader::with_guessed_format)
        .map_err(|e| format!("must be a picture, but '{shown}' cannot be read: {e}"))?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    let picture = reader
        .decode()
        .map_err(|e| format!("must be a picture, but '{shown}' cannot be decoded: {e}"))?
        .into_rgba8();
    let (width, height) = picture.dimensions();
    if width == 0 || height == 0 {
        return Err(format!("must be a picture, but '{shown}' is empty"));
    }
    Ok(Image { name: shown.to_string(), width, height, rgba: picture.into_raw() })
}
