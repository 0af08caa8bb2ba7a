//! Single pictures of a sheet.

use genga::render::{LayerKind, Picture, View};
use genga::scene::Scene;
use genga::style::Style;
use genga_tests::{Pixels, draw_layers, scenes::style};
use image::{Rgb, RgbImage};

fn picture(scene: &Scene, style: &Style, view: &View, layers: &[LayerKind]) -> Picture {
    draw_layers(scene, style, view, layers)
}

fn by_pixel(picture: &Picture, color: impl Fn(u32, u32) -> [u8; 3]) -> RgbImage {
    RgbImage::from_fn(picture.width, picture.height, |x, y| Rgb(color(x, y)))
}

/// Lines of a `[lines]` table, black on white, on flat paint.
pub(crate) fn drawing(scene: &Scene, lines: &str, view: &View) -> RgbImage {
    let style = style(&format!("[background]\ncolor = \"#ffffff\"\n[lines]\n{lines}"));
    let picture = picture(scene, &style, view, &[]);
    by_pixel(&picture, |x, y| {
        let [r, g, b, _] = picture.at(x, y);
        [r, g, b]
    })
}

/// Lines of a `[lines]` table alone, black on white.
pub(crate) fn lines_only(scene: &Scene, lines: &str, view: &View) -> RgbImage {
    let style = style(&format!("[background]\ncolor = \"#ffffff\"\n[lines]\n{lines}"));
    let picture = picture(scene, &style, view, &[LayerKind::Lines]);
    by_pixel(&picture, |x, y| [255 - picture.ink(x, y); 3])
}

/// The anime style without lines.
pub(crate) fn painted(scene: &Scene, view: &View) -> RgbImage {
    drawing(scene, "method = \"none\"", view)
}

/// The distance along the camera's axis: near is light.
pub(crate) fn depths(scene: &Scene, view: &View) -> RgbImage {
    let picture = picture(scene, &style(""), view, &[LayerKind::Depth]);
    let finite = || picture.floats(LayerKind::Depth).iter().copied().filter(|d| d.is_finite());
    let (near, far) = (finite().fold(f32::MAX, f32::min), finite().fold(0.0, f32::max));
    by_pixel(&picture, |x, y| {
        let depth = picture.depth(x, y);
        let grey = if depth.is_finite() { 1.0 - 0.8 * (depth - near) / (far - near) } else { 0.0 };
        [(255.0 * grey) as u8; 3]
    })
}

/// World-space normals as colours.
pub(crate) fn normals(scene: &Scene, view: &View) -> RgbImage {
    let picture = picture(scene, &style(""), view, &[LayerKind::Normal]);
    by_pixel(&picture, |x, y| {
        let normal = picture.normal(x, y);
        normal.to_array().map(|n| (127.5 + 127.5 * n) as u8)
    })
}

/// Every pixel as a square of `factor` × `factor`.
pub(crate) fn enlarged(picture: &RgbImage, factor: u32) -> RgbImage {
    let [width, height] = [picture.width(), picture.height()].map(|side| side * factor);
    RgbImage::from_fn(width, height, |x, y| *picture.get_pixel(x / factor, y / factor))
}
