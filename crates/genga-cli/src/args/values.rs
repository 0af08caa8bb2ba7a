//! Values of options.

use std::ops::RangeInclusive;

use genga::render::MAX_PICTURE_SIDE;

/// `1920x1080`.
pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let form = || "write a width and a height in pixels, such as 1920x1080".to_owned();
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(form)?;
    let side = |text: &str| {
        let side: u64 = text.trim().parse().map_err(|_| form())?;
        match u32::try_from(side) {
            Ok(side) if (1..=MAX_PICTURE_SIDE).contains(&side) => Ok(side),
            _ => Err(format!("each side must be 1 to {MAX_PICTURE_SIDE} pixels")),
        }
    };
    Ok([side(width)?, side(height)?])
}

fn number(text: &str, range: RangeInclusive<f32>, unit: &str) -> Result<f32, String> {
    let number: f32 = text.parse().map_err(|_| "this is not a number".to_owned())?;
    if range.contains(&number) {
        Ok(number)
    } else {
        Err(format!("it must be {} to {}{unit}", range.start(), range.end()))
    }
}

pub(super) fn azimuth(text: &str) -> Result<f32, String> {
    number(text, -36_000.0..=36_000.0, " degrees")
}

pub(super) fn elevation(text: &str) -> Result<f32, String> {
    number(text, -90.0..=90.0, " degrees")
}

pub(super) fn zoom(text: &str) -> Result<f32, String> {
    number(text, 0.001..=10_000.0, "")
}

pub(super) fn fov(text: &str) -> Result<f32, String> {
    number(text, 1.0..=170.0, " degrees")
}

pub(super) fn seconds(text: &str) -> Result<f32, String> {
    number(text, -1e6..=1e6, " seconds")
}

pub(super) fn fps(text: &str) -> Result<f32, String> {
    number(text, 0.001..=10_000.0, " frames a second")
}

/// Frames from the first to the last, which is included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrameRange {
    /// The first frame.
    pub(crate) first: i64,
    /// The last frame, not before the first.
    pub(crate) last: i64,
}

impl FrameRange {
    /// Frames are counted in seconds by dividing; more cannot be told apart anyway.
    const LIMIT: i64 = 1_000_000;

    /// `1..24`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let form = || "write the first and the last frame, such as 0..23".to_owned();
        let (first, last) = text.split_once("..").ok_or_else(form)?;
        let frame = |text: &str| frame(text).map_err(|_| form());
        let (first, last) = (frame(first)?, frame(last.trim_start_matches('='))?);
        if first > last {
            return Err(format!("the last frame {last} is before the first one {first}"));
        }
        Ok(Self { first, last })
    }

    /// How many frames there are.
    pub(crate) fn count(self) -> usize {
        usize::try_from(self.last - self.first + 1).unwrap_or(0)
    }

    /// All frames.
    pub(crate) fn frames(self) -> RangeInclusive<i64> {
        self.first..=self.last
    }
}

pub(super) fn frame(text: &str) -> Result<i64, String> {
    let limit = FrameRange::LIMIT;
    match text.trim().parse() {
        Ok(frame) if (-limit..=limit).contains(&frame) => Ok(frame),
        Ok(_) => Err(format!("it must be {} to {limit}", -limit)),
        Err(_) => Err("this is not a frame number".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!(size("1920x1080"), Ok([1920, 1080]));
        assert_eq!(size("1X16384"), Ok([1, 16_384]));
        for text in
            ["", "x", "100", "0x5", "5x0", "16385x1", "99999999999x1", "-1x5", "1x2x3", "axb"]
        {
            assert!(size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_must_be_in_range() {
        assert_eq!(azimuth("-30"), Ok(-30.0));
        for text in ["nan", "inf", "-inf", "1e9", "", "x"] {
            assert!(azimuth(text).is_err(), "{text}");
        }
        assert!(zoom("0").is_err() && elevation("91").is_err() && fov("0").is_err());
    }

    #[test]
    fn the_last_frame_is_included() {
        let range = FrameRange::parse("-2..3");
        assert_eq!(range, Ok(FrameRange { first: -2, last: 3 }));
        assert_eq!(range.map(FrameRange::count), Ok(6));
        assert_eq!(FrameRange::parse("7..7").map(FrameRange::count), Ok(1));
        assert_eq!(FrameRange::parse("0..=3"), FrameRange::parse("0..3"));
        for text in ["", "..", "1", "1..", "..2", "3..2", "1..9999999", "a..b", "1...3"] {
            assert!(FrameRange::parse(text).is_err(), "{text}");
        }
    }
}
