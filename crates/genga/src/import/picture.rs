use std::io::Cursor;

use image::{ImageFormat, ImageReader, Limits};

use crate::scene::Image;

/// Longest side in pixels: the most that common graphics adapters take.
const MAX_SIDE: u32 = 16_384;

/// Most bytes of one decoded picture: that many pixels on both sides.
const MAX_BYTES: u64 = 4 * (MAX_SIDE as u64) * (MAX_SIDE as u64);
/// Most bytes of all decoded pictures of a model.
const MAX_ALL_BYTES: u64 = 4 << 30;

/// Decodes the pictures of one model, within bounds.
pub(super) struct Decoder {
    bytes_left: u64,
}

impl Default for Decoder {
    fn default() -> Self {
        Self { bytes_left: MAX_ALL_BYTES }
    }
}

impl Decoder {
    /// Decodes a picture. The content decides the format, then the ending of `path`.
    ///
    /// # Errors
    /// A clause that says why it cannot be decoded.
    pub(super) fn decode(&mut self, name: &str, bytes: &[u8], path: &str) -> Result<Image, String> {
        let image = decode(name, bytes, path, self.bytes_left.min(MAX_BYTES))?;
        self.bytes_left = self.bytes_left.saturating_sub(image.rgba.len() as u64);
        Ok(image)
    }
}

fn decode(name: &str, bytes: &[u8], path: &str, max_bytes: u64) -> Result<Image, String> {
    let format = image::guess_format(bytes)
        .or_else(|_| ImageFormat::from_path(path))
        .map_err(|_| "its format is unknown; PNG, JPEG and WebP can be read".to_owned())?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(max_bytes);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let picture = reader.decode().map_err(|error| error.to_string())?;
    let (width, height) = (picture.width(), picture.height());
    if width == 0 || height == 0 {
        return Err("it has no pixels".to_owned());
    }
    if u64::from(width) * u64::from(height) * 4 > max_bytes {
        return Err(format!("{width}×{height} pixels are more than memory is allowed for"));
    }
    let rgba = picture.into_rgba8().into_raw();
    Ok(Image { name: name.to_owned(), width, height, rgba })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageBuffer, Luma, Rgb};

    fn png(picture: &DynamicImage) -> Vec<u8> {
        let mut bytes = Vec::new();
        picture.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png).unwrap();
        bytes
    }

    #[test]
    fn sixteen_bits_become_eight() {
        let picture = ImageBuffer::from_pixel(2, 1, Rgb([65_535_u16, 32_896, 0]));
        let image = decode("a", &png(&picture.into()), "", 1 << 20).unwrap();
        assert_eq!((image.name.as_str(), image.width, image.height), ("a", 2, 1));
        assert_eq!(image.rgba, [255, 128, 0, 255, 255, 128, 0, 255]);
    }

    #[test]
    fn grey_becomes_rgb_and_the_content_wins_over_the_ending() {
        let picture = ImageBuffer::from_pixel(1, 1, Luma([7_u8]));
        let image = decode("", &png(&picture.into()), "a.jpg", 1 << 20).unwrap();
        assert_eq!(image.rgba, [7, 7, 7, 255]);
    }

    #[test]
    fn broken_and_huge_pictures_are_refused() {
        assert!(decode("", b"no picture", "a.txt", 1 << 20).unwrap_err().contains("unknown"));
        let picture = ImageBuffer::from_pixel(64, 64, Luma([7_u8]));
        let bytes = png(&picture.into());
        assert!(decode("", &bytes[..bytes.len() / 2], "", 1 << 20).is_err());
        assert!(decode("", &bytes, "", 1000).is_err());
        // The width of 64 becomes 4 GiB, as a decompression bomb would claim.
        let mut bomb = bytes.clone();
        bomb[16..20].copy_from_slice(&[0xff; 4]);
        assert!(decode("", &bomb, "", 1 << 40).is_err());
        let mut decoder = Decoder { bytes_left: 4 * 64 * 64 + 1 };
        assert!(decoder.decode("", &bytes, "").is_ok());
        assert!(decoder.decode("", &bytes, "").is_err());
    }
}
