//! A picture of the user's as a hatching pattern that looks the same at every distance.
//!
//! The picture lies on the surface in octaves, each twice as large as the one before. Where the
//! finest one fades, by width, the strokes of the others are as wide as its own were, so strokes keep
//! their width on the picture, and those of coarse octaves are among the strokes of finer ones
//! (as in the tonal art maps of Praun 2001).

use crate::scene::Image;

/// Fewest and most texels along a side: coarser ones have no thin strokes, and the table of tones
/// must fit.
const SIDES: [usize; 2] = [256, 512];

/// Octaves that are seen at once; as in `hatch_marks.wesl`.
const OCTAVES: usize = 4;

/// Sizes and tones of the table; as in `hatch_marks.wesl`.
const SIZES: usize = 9;
const TONES: usize = 33;
/// The largest darkness in the table: octaves that are equally far gone, two thirds of their width,
/// cover everything from there on.
const DARKEST: f32 = 1.5;

/// The RGBA texels of a pattern, row by row:
///
/// * red: S, the part of the picture that is darker than a place, so that `S < d` covers the part d;
///   in flat blacks and whites darker towards the middle of the black, so that its strokes have
///   widths, too;
/// * green: in the first `TONES` columns and `SIZES` rows, the darkness at which the octaves
///   together cover the part of the paper that the column stands for (see `tone_table`);
/// * blue and alpha: change of S along and down a picture height, as `encoded_slope` has it.
///
/// The texture's origin is where strokes of the picture best lie on those of the picture twice as
/// large.
pub(super) fn prepare(image: &Image) -> Image {
    let gray = Field::from_image(image);
    let pattern = gray.by_rank();
    let pattern = pattern.moved(pattern.origin());
    let table = pattern.tone_table();
    let (width, height) = (pattern.width, pattern.height);
    let mut rgba = Vec::with_capacity(4 * width * height);
    for y in 0..height {
        for x in 0..width {
            let here = pattern.at(x, y);
            // The mean of both sides: between them a stroke's middle is a kink.
            let slope =
                |before: f32, after: f32| 0.5 * ((here - before).abs() + (after - here).abs());
            let along = slope(pattern.at(x + width - 1, y), pattern.at(x + 1, y));
            let down = slope(pattern.at(x, y + height - 1), pattern.at(x, y + 1));
            let tone = table.get(y).and_then(|row| row.get(x)).map_or(0.0, |d| d / DARKEST);
            rgba.extend([
                byte(here),
                byte(tone),
                encoded_slope(along * height as f32),
                encoded_slope(down * height as f32),
            ]);
        }
    }
    Image { name: image.name.clone(), width: width as u32, height: height as u32, rgba }
}

fn byte(x: f32) -> u8 {
    (x.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// `log2(1 + slope) / 10`, which spreads the gentle ones.
fn encoded_slope(slope: f32) -> u8 {
    byte((1.0 + slope).log2() / 10.0)
}

/// Numbers on a torus.
struct Field {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Field {
    /// Brightness over white, in [0, 1], at a size that can be worked with.
    fn from_image(image: &Image) -> Self {
        let [width, height] = [image.width as usize, image.height as usize];
        let brightness = |x: usize, y: usize| -> f32 {
            let at = 4 * (y % height * width + x % width);
            // A pattern of the wrong size, which only code can make, is white.
            let Some(&[r, g, b, a]) = image.rgba.get(at..at + 4) else { return 1.0 };
            let [r, g, b, a] = [r, g, b, a].map(|v| f32::from(v) / 255.0);
            1.0 - a + a * (0.299 * r + 0.587 * g + 0.114 * b)
        };
        let fitted = |side: usize| side.clamp(SIDES[0], SIDES[1]);
        let mut field = Self { width: fitted(width), height: fitted(height), values: Vec::new() };
        // The texels under a texel, or the two it lies between, with weights.
        let under = |i: usize, new: usize, old: usize| -> Vec<(usize, f32)> {
            if old >= new {
                let texels = i * old / new..((i + 1) * old / new).max(i * old / new + 1);
                let weight = 1.0 / texels.len() as f32;
                return texels.map(|texel| (texel, weight)).collect();
            }
            let place = (i as f32 + 0.5) * old as f32 / new as f32 - 0.5 + old as f32;
            let part = place.fract();
            vec![(place as usize, 1.0 - part), (place as usize + 1, part)]
        };
        let columns: Vec<_> = (0..field.width).map(|x| under(x, field.width, width)).collect();
        for y in 0..field.height {
            let rows = under(y, field.height, height);
            for column in &columns {
                let texels = rows.iter().flat_map(|r| column.iter().map(move |c| (c, r)));
                let sum = texels.map(|(c, r)| c.1 * r.1 * brightness(c.0, r.0)).sum();
                field.values.push(sum);
            }
        }
        field
    }

    fn at(&self, x: usize, y: usize) -> f32 {
        self.values[y % self.height * self.width + x % self.width]
    }

    /// Between texels' middles; `u` and `v` in pictures.
    fn sample(&self, u: f32, v: f32) -> f32 {
        let x = (u - u.floor()) * self.width as f32 + self.width as f32 - 0.5;
        let y = (v - v.floor()) * self.height as f32 + self.height as f32 - 0.5;
        let (left, top, dx, dy) = (x as usize, y as usize, x.fract(), y.fract());
        let row = |y| self.at(left, y) * (1.0 - dx) + self.at(left + 1, y) * dx;
        row(top) * (1.0 - dy) + row(top + 1) * dy
    }

    /// The part of the values that are below each value. Equal ones are ordered by their distance
    /// from the border between dark and light; where that is equal, too, they share their mean.
    fn by_rank(&self) -> Self {
        let from_border = self.distance_from_border();
        let key = |i: usize| ((self.values[i] * 255.0).round() as i32, from_border[i]);
        let mut order: Vec<usize> = (0..self.values.len()).collect();
        order.sort_unstable_by_key(|&i| key(i));
        let mut values = vec![0.0; order.len()];
        let mut first = 0;
        while first < order.len() {
            let same = order[first..].partition_point(|&i| key(i) == key(order[first]));
            let rank = (first as f32 + 0.5 * same as f32) / order.len() as f32;
            order[first..first + same].iter().for_each(|&i| values[i] = rank);
            first += same;
        }
        Self { width: self.width, height: self.height, values }
    }

    /// Squared distance in texels to the nearest texel on the other side of middle gray, negative in
    /// the dark (vector distance transform after Danielsson 1980, twice round the torus).
    fn distance_from_border(&self) -> Vec<i32> {
        const FAR: [i32; 2] = [4096, 4096];
        let size = [self.width as i32, self.height as i32];
        let squared = |[x, y]: [i32; 2]| x * x + y * y;
        let mut result = vec![0; self.values.len()];
        for dark in [true, false] {
            let inside = |v: f32| (v < 0.5) == dark;
            let mut nearest: Vec<[i32; 2]> =
                self.values.iter().map(|&v| if inside(v) { FAR } else { [0, 0] }).collect();
            let index =
                |x: i32, y: i32| (y.rem_euclid(size[1]) * size[0] + x.rem_euclid(size[0])) as usize;
            for sweep in 0..4 {
                let way = if sweep % 2 == 0 { 1 } else { -1 };
                let count = size[0] * size[1];
                for step in 0..count {
                    let i = if way > 0 { step } else { count - 1 - step };
                    let [x, y] = [i % size[0], i / size[0]];
                    for [dx, dy] in [[-way, 0], [0, -way], [-way, -way], [way, -way]] {
                        let [far_x, far_y] = nearest[index(x + dx, y + dy)];
                        let through = [far_x + dx, far_y + dy];
                        if squared(through) < squared(nearest[i as usize]) {
                            nearest[i as usize] = through;
                        }
                    }
                }
            }
            for (i, _) in self.values.iter().enumerate().filter(|(_, v)| inside(**v)) {
                // All on one side: there is no border.
                let far = squared(nearest[i]);
                let distance = if far > squared([2048, 2048]) { 0 } else { far };
                result[i] = if dark { -distance } else { distance };
            }
        }
        result
    }

    /// The texel about which the picture is enlarged to the next octave: strokes of that, half as
    /// wide as they are there, should lie in those of the picture itself.
    fn origin(&self) -> [usize; 2] {
        const CANDIDATES: usize = 96;
        const PLACES: usize = 400;
        let mut darkest: Vec<usize> = (0..self.values.len()).collect();
        let few = (darkest.len() / 20).max(1);
        darkest.select_nth_unstable_by(few - 1, |&a, &b| self.values[a].total_cmp(&self.values[b]));
        let in_both = |&i: &usize| {
            let (u, v) = self.middle(i);
            let both = |&(x, y): &(f32, f32)| {
                self.sample(u + x, v + y) < 0.5 && self.sample(u + 0.5 * x, v + 0.5 * y) < 0.25
            };
            places().take(PLACES).map(|(x, y)| (2.0 * x, 2.0 * y)).filter(both).count()
        };
        let candidates = darkest[..few].iter().step_by((few / CANDIDATES).max(1));
        let best = candidates.max_by_key(|i| in_both(i)).copied().unwrap_or(0);
        [best % self.width, best / self.width]
    }

    fn middle(&self, i: usize) -> (f32, f32) {
        let place = |i: usize, side: usize| (i as f32 + 0.5) / side as f32;
        (place(i % self.width, self.width), place(i / self.width, self.height))
    }

    /// The same with another texel in the corner.
    fn moved(&self, [x0, y0]: [usize; 2]) -> Self {
        let rows = 0..self.height;
        let values = rows.flat_map(|y| (0..self.width).map(move |x| self.at(x + x0, y + y0)));
        Self { width: self.width, height: self.height, values: values.collect() }
    }

    /// For sizes of the finest octave from 1 to 2 and parts of the paper from 0 to 1: the darkness d
    /// at which the least `S / width` over the octaves is below d on that part of the paper.
    fn tone_table(&self) -> Vec<Vec<f32>> {
        const PLACES: usize = 8192;
        let scale = (1 << (OCTAVES - 1)) as f32;
        // Texels' corners, as in `origin`: the origin is the middle of the first one.
        let corner = (0.5 / self.width as f32, 0.5 / self.height as f32);
        let octaves: Vec<[f32; OCTAVES]> = places()
            .take(PLACES)
            .map(|(x, y)| {
                std::array::from_fn(|k| {
                    let part = scale / (1 << k) as f32;
                    self.sample(corner.0 + part * x, corner.1 + part * y)
                })
            })
            .collect();
        let row = |i: usize| {
            let widths = widths(1.0 + i as f32 / (SIZES - 1) as f32);
            let least = |s: &[f32; OCTAVES]| -> f32 {
                s.iter().zip(widths).map(|(s, w)| s / w.max(1e-6)).fold(f32::INFINITY, f32::min)
            };
            let mut darkness: Vec<f32> = octaves.iter().map(least).collect();
            darkness.sort_unstable_by(f32::total_cmp);
            let tone = |j: usize| match j * PLACES / (TONES - 1) {
                0 => 0.0,
                PLACES => DARKEST,
                rank => darkness[rank],
            };
            (0..TONES).map(tone).collect()
        };
        (0..SIZES).map(row).collect()
    }
}

/// How wide strokes of each octave are, in their own full width: the finest one goes while the
/// others, which have the width of its strokes at size 1, keep that on the picture; the last one
/// comes from nothing.
fn widths(size: f32) -> [f32; OCTAVES] {
    std::array::from_fn(|k| match k {
        0 => 2.0 - size,
        _ if k == OCTAVES - 1 => size / (1 << k) as f32 * (size - 1.0),
        _ => size / (1 << k) as f32,
    })
}

/// Places spread evenly over the unit square (Roberts's R2 sequence).
fn places() -> impl Iterator<Item = (f32, f32)> {
    (1_u32..).map(|i| {
        let at = |step: f64| (f64::from(i) * step).fract() as f32;
        (at(0.754_877_666_246_692_8), at(0.569_840_290_998_053_3))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Level bars of a height in a picture of 64×64, `count` of them.
    fn bars(count: usize, part: f32) -> Image {
        let gray = |y: usize| if (y * count) as f32 / 64.0 % 1.0 < part { 0 } else { 255 };
        let rgba = (0..64 * 64).flat_map(|i| [gray(i / 64), gray(i / 64), gray(i / 64), 255]);
        Image { name: String::new(), width: 64, height: 64, rgba: rgba.collect() }
    }

    #[test]
    fn a_part_of_every_picture_is_below_that_part() {
        for part in [0.25, 0.5] {
            let pattern = prepare(&bars(4, part));
            for wanted in [0.2, 0.4, 0.6, 0.8] {
                let below =
                    pattern.rgba.chunks_exact(4).filter(|t| f32::from(t[0]) < 255.0 * wanted);
                let part = below.count() as f32 / (256.0 * 256.0);
                assert!((part - wanted).abs() < 0.07, "{part} of {wanted}");
            }
        }
    }

    #[test]
    fn ruled_strokes_lie_on_those_of_the_next_octave() {
        let field = Field::from_image(&bars(4, 0.25)).by_rank();
        let field = field.moved(field.origin());
        for row in field.tone_table() {
            for (j, darkness) in row.iter().enumerate().take(TONES - 1) {
                // Nothing has to be made thinner for strokes that lie beside each other.
                let wanted = j as f32 / (TONES - 1) as f32;
                assert!((darkness - wanted).abs() < 0.06, "{darkness} for {wanted}");
            }
        }
    }

    #[test]
    fn pictures_of_any_size_are_taken() {
        for (width, height) in [(1, 1), (3, 700), (65, 64), (1200, 2)] {
            let count = width as usize * height as usize;
            let image = Image { name: String::new(), width, height, rgba: vec![128; 4 * count] };
            let pattern = prepare(&image);
            assert_eq!(pattern.rgba.len(), 4 * (pattern.width * pattern.height) as usize);
            assert!(pattern.width >= 256 && pattern.height >= 256);
        }
    }
}
