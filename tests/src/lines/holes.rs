//! Holes of outlines: places where something ends before the background and no line is drawn.

use genga::render::{LayerData, LayerKind, Picture};

use super::ink::{Component, Ink};

/// Pixels between an outline's place and its ink.
const REACH_PX: u32 = 2;
/// Least coverage of an outline.
const DRAWN: u8 = 64;

/// Pixels of surfaces beside the background without ink of a line near them, as they hang together.
///
/// # Panics
/// If the picture was drawn without its lines or its depth.
#[must_use]
pub fn holes(picture: &Picture) -> Vec<Component> {
    let ink = Ink::of(picture);
    let layer = picture.layers.iter().find(|layer| layer.kind == LayerKind::Depth);
    let Some(LayerData::F32 { values: depths, .. }) = layer.map(|layer| &layer.data) else {
        panic!("the picture was drawn without its depth");
    };
    let (width, height) = (ink.width, ink.height);
    let is_surface = |x: u32, y: u32| depths[(y * width + x) as usize].is_finite();
    let near = ink.near(DRAWN, REACH_PX);
    ink.components(|x, y| {
        let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
        is_inside
            && is_surface(x, y)
            && (!is_surface(x - 1, y)
                || !is_surface(x + 1, y)
                || !is_surface(x, y - 1)
                || !is_surface(x, y + 1))
            && !near[(y * width + x) as usize]
    })
}
