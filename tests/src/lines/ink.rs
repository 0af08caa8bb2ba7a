//! The drawn lines of a picture as plain coverage, and what hangs together in it.

use genga::render::{LayerData, LayerKind, Picture};

/// Coverage of lines, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ink {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Coverage, 255 is full.
    pub values: Vec<u8>,
}

/// Pixels that touch at sides or corners.
#[derive(Clone, Debug, Default)]
pub struct Component {
    /// Their places.
    pub pixels: Vec<(u32, u32)>,
    /// Whether one of them lies at the picture's border.
    pub at_border: bool,
}

impl Component {
    /// Length of the longer side of the box round it in pixels.
    #[must_use]
    pub fn extent(&self) -> u32 {
        let range = |values: &dyn Fn(&(u32, u32)) -> u32| {
            let all = || self.pixels.iter().map(values);
            all().max().unwrap_or(0) + 1 - all().min().unwrap_or(0)
        };
        range(&|p| p.0).max(range(&|p| p.1))
    }
}

impl Ink {
    /// The line layer's alpha.
    ///
    /// # Panics
    /// If the picture was drawn without that layer.
    #[must_use]
    pub fn of(picture: &Picture) -> Self {
        let layer = picture.layers.iter().find(|layer| layer.kind == LayerKind::Lines);
        let Some(LayerData::Rgba8(bytes)) = layer.map(|layer| &layer.data) else {
            panic!("the picture was drawn without its lines");
        };
        let values = bytes.as_chunks::<4>().0.iter().map(|rgba| rgba[3]).collect();
        Self { width: picture.width, height: picture.height, values }
    }

    /// Coverage of a pixel; 0 outside of the picture.
    #[must_use]
    pub fn at(&self, x: i64, y: i64) -> u8 {
        let inside =
            (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y);
        if inside { self.values[y as usize * self.width as usize + x as usize] } else { 0 }
    }

    /// Coverage at a place in pixels, linear between the middles of pixels, in [0, 1].
    #[must_use]
    pub fn between(&self, x: f64, y: f64) -> f64 {
        let (x, y) = (x - 0.5, y - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let (u, v) = (x - column, y - row);
        let at = |dx: i64, dy: i64| f64::from(self.at(column as i64 + dx, row as i64 + dy)) / 255.0;
        let upper = at(0, 0) * (1.0 - u) + at(1, 0) * u;
        let lower = at(0, 1) * (1.0 - u) + at(1, 1) * u;
        upper * (1.0 - v) + lower * v
    }

    /// Every pixel with at least that coverage.
    pub fn places(&self, least: u8) -> impl Iterator<Item = (u32, u32)> + '_ {
        let width = self.width as usize;
        let inked = self.values.iter().enumerate().filter(move |(_, value)| **value >= least);
        inked.map(move |(i, _)| ((i % width) as u32, (i / width) as u32))
    }

    /// What hangs together among pixels for which `is_in` holds.
    #[must_use]
    pub fn components(&self, is_in: impl Fn(u32, u32) -> bool) -> Vec<Component> {
        let (width, height) = (self.width, self.height);
        let mut left: Vec<bool> =
            (0..width * height).map(|i| is_in(i % width, i / width)).collect();
        let mut components = Vec::new();
        for first in 0..left.len() {
            if !std::mem::take(&mut left[first]) {
                continue;
            }
            let mut component = Component::default();
            let mut queue = vec![(first as u32 % width, first as u32 / width)];
            while let Some((x, y)) = queue.pop() {
                component.at_border |= x == 0 || y == 0 || x + 1 == width || y + 1 == height;
                component.pixels.push((x, y));
                for next_y in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                    for next_x in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                        if std::mem::take(&mut left[(next_y * width + next_x) as usize]) {
                            queue.push((next_x, next_y));
                        }
                    }
                }
            }
            components.push(component);
        }
        components
    }

    /// Which pixels have ink of at least `least` within `reach` pixels along both axes.
    #[must_use]
    pub fn near(&self, least: u8, reach: u32) -> Vec<bool> {
        let (width, height) = (self.width, self.height);
        let mut near = vec![false; self.values.len()];
        for (x, y) in self.places(least) {
            for row in y.saturating_sub(reach)..=(y + reach).min(height - 1) {
                let start = (row * width + x.saturating_sub(reach)) as usize;
                let end = (row * width + (x + reach).min(width - 1)) as usize;
                near[start..=end].fill(true);
            }
        }
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ink() -> Ink {
        let rows = ["....#", "##...", "..#..", "....#"];
        let values = rows.concat().bytes().map(|b| if b == b'#' { 255 } else { 0 }).collect();
        Ink { width: 5, height: 4, values }
    }

    #[test]
    fn pixels_that_touch_at_corners_are_one_component() {
        let ink = ink();
        let components = ink.components(|x, y| ink.at(i64::from(x), i64::from(y)) > 0);
        let sizes: Vec<_> = components.iter().map(|c| (c.pixels.len(), c.extent())).collect();
        assert_eq!(sizes, [(1, 1), (3, 3), (1, 1)]);
        assert!(components[1].at_border);
    }

    #[test]
    fn coverage_between_pixels_is_linear() {
        let ink = ink();
        assert!((ink.between(0.5, 1.5) - 1.0).abs() < 1e-9);
        assert!((ink.between(2.0, 1.5) - 0.5).abs() < 1e-9);
        assert!((ink.between(2.0, 2.0) - 0.5).abs() < 1e-9);
        assert!(ink.between(-3.0, 1.0).abs() < 1e-9);
    }

    #[test]
    fn nearness_reaches_as_far_as_asked() {
        let near = ink().near(128, 1);
        assert_eq!(near.iter().filter(|n| **n).count(), 19);
        assert!(!near[15] && near[14]);
    }
}
