//! Lines from one frame to the next: whatever comes or goes does so little by little.

use super::ink::{Component, Ink};

/// Coverage of a line that is there beyond doubt.
const STRONG: u8 = 128;
/// Coverage from which there is anything at all.
const ANY: u8 = 13;
/// How far a line may move between two frames in pixels.
const MOVED_PX: u32 = 4;
/// Parts up to this length may come and go, in pixels.
const SHORT_PX: u32 = 8;

/// Parts of lines longer than 8 pixels that are wholly there in `there` while `absent` has no ink
/// at all within 4 pixels of them.
#[must_use]
pub fn sudden(there: &Ink, absent: &Ink) -> Vec<Component> {
    let near = absent.near(ANY, MOVED_PX);
    let is_new = |x: u32, y: u32| {
        let i = (y * there.width + x) as usize;
        there.values[i] >= STRONG && !near[i]
    };
    let mut found = there.components(is_new);
    // What comes into the picture at its border was there before.
    found.retain(|part| part.extent() > SHORT_PX && !part.at_border);
    found
}

/// What pops in and out between two frames that follow each other.
#[must_use]
pub fn pops(before: &Ink, after: &Ink) -> Vec<Component> {
    let mut pops = sudden(after, before);
    pops.extend(sudden(before, after));
    pops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lines::capsules::union_of_capsules;
    use glam::DVec2;

    fn line(y: f64, length: f64, width: f64) -> Ink {
        let ends = [DVec2::new(20.0, y), DVec2::new(20.0 + length, y)];
        union_of_capsules(&[ends], width, [96, 64])
    }

    #[test]
    fn lines_may_move_and_grow_but_not_pop() {
        let empty = Ink { width: 96, height: 64, values: vec![0; 96 * 64] };
        let full = line(30.0, 40.0, 3.0);
        assert_eq!(pops(&empty, &full).len(), 1, "comes");
        assert_eq!(pops(&full, &empty).len(), 1, "goes");
        assert_eq!(pops(&full, &line(33.0, 40.0, 3.0)).len(), 0, "moves a little");
        assert_eq!(pops(&full, &line(45.0, 40.0, 3.0)).len(), 2, "jumps");
        assert_eq!(pops(&full, &line(30.0, 45.0, 3.0)).len(), 0, "grows");
        assert_eq!(pops(&full, &line(30.0, 70.0, 3.0)).len(), 1, "grows by leaps");
        assert_eq!(pops(&empty, &line(30.0, 3.0, 2.0)).len(), 0, "is short");
        let faint =
            union_of_capsules(&[[DVec2::new(20.0, 30.5), DVec2::new(60.0, 30.5)]], -0.6, [96, 64]);
        assert_eq!(pops(&empty, &faint).len(), 0, "comes faintly");
        assert_eq!(pops(&faint, &full).len(), 0, "gets stronger");
    }
}
