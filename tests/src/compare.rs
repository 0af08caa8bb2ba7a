//! How far two pictures differ.

use genga::render::Picture;

/// What may differ. There are two kinds, and tests do not make up their own.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    channel: u8,
    outliers: usize,
}

impl Tolerance {
    /// The same picture drawn another way, in tiles for one: 1/255 in every channel, everywhere.
    #[must_use]
    pub fn same_picture() -> Self {
        Self { channel: 1, outliers: 0 }
    }

    /// A picture of cel paint and lines made by another adapter: 2/255, and ten pixels where an
    /// edge falls to the other side. A mean would hide a line that moved by a pixel.
    #[must_use]
    pub fn snapshot() -> Self {
        Self { channel: 2, outliers: 10 }
    }
}

/// Where two pictures differ by more than they may.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// Largest difference in any channel.
    pub worst: u8,
    /// Place of the largest difference.
    pub at: (u32, u32),
    /// Pixels with a channel over the tolerance.
    pub outliers: usize,
    /// Whether that is more than allowed.
    pub is_too_much: bool,
}

/// Compares RGBA bytes of pictures `width` pixels wide.
///
/// # Panics
/// If they are not of equal length.
#[must_use]
pub fn byte_difference(width: u32, a: &[u8], b: &[u8], tolerance: Tolerance) -> Difference {
    assert_eq!(a.len(), b.len(), "the pictures are not of one size");
    let mut difference = Difference::default();
    for (i, (a, b)) in a.as_chunks::<4>().0.iter().zip(b.as_chunks::<4>().0).enumerate() {
        let all = a.iter().zip(b).map(|(&a, &b)| a.abs_diff(b));
        let worst = all.max().unwrap_or(0);
        if worst > difference.worst {
            difference.worst = worst;
            difference.at = (i as u32 % width, i as u32 / width);
        }
        difference.outliers += usize::from(worst > tolerance.channel);
    }
    difference.is_too_much = difference.outliers > tolerance.outliers;
    difference
}

/// Compares two pictures without their layers.
///
/// # Panics
/// If they are not of one size.
#[must_use]
pub fn difference(a: &Picture, b: &Picture, tolerance: Tolerance) -> Difference {
    assert_eq!((a.width, a.height), (b.width, b.height), "the pictures are not of one size");
    byte_difference(a.width, &a.rgba, &b.rgba, tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outliers_are_counted_and_placed() {
        let a = [9; 4 * 6];
        let mut b = a;
        b[4 * 4 + 1] = 12;
        let found = byte_difference(3, &a, &b, Tolerance::same_picture());
        assert_eq!((found.worst, found.at, found.outliers), (3, (1, 1), 1));
        assert!(found.is_too_much);
        assert!(!byte_difference(3, &a, &b, Tolerance::snapshot()).is_too_much);
        assert!(!byte_difference(3, &a, &a, Tolerance::same_picture()).is_too_much);
    }
}
