//! Writing pictures: PNG for what people look at, OpenEXR for layers that go on to compositing.
//!
//! Both write to anything that is [`std::io::Write`] and take the pixels by reference: a picture
//! may be as large as 16384 × 16384, so none is copied as a whole.

mod exr_layer;
mod png_picture;

use std::io;

use thiserror::Error;

pub use exr_layer::{Samples, write_exr};
pub use png_picture::write_png;

/// Why a picture could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The numbers do not fit together.
    #[error(
        "{width} × {height} pixels with {channels} channels do not fit {count} values: there must be one value for each channel of each pixel, and at least one pixel"
    )]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Values per pixel.
        channels: usize,
        /// Values given.
        count: usize,
    },
    /// A layer has no channels or too many, or two of the same name.
    #[error("an EXR layer needs 1 to 4 channels with different names that are not empty")]
    Channels,
    /// The bytes could not be written.
    #[error(transparent)]
    Write(#[from] io::Error),
    /// The encoder refused the picture.
    #[error("the picture cannot be encoded: {0}")]
    Encode(String),
}

/// Checks that there are `channels` values for each pixel.
fn check_size(width: u32, height: u32, channels: usize, count: usize) -> Result<(), ExportError> {
    let expected = (width as usize)
        .checked_mul(height as usize)
        .and_then(|pixels| pixels.checked_mul(channels));
    if expected == Some(count) && count > 0 {
        Ok(())
    } else {
        Err(ExportError::Size { width, height, channels, count })
    }
}
