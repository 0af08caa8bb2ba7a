//! Contour lines against their definition: where they are, how wide, how they change.

mod hand;
mod joined;
mod motion;
mod parts;
mod place;
mod scale;
mod shape;
mod widths;

use genga::render::{LayerKind, View};
use genga::scene::Scene;
use genga::style::Style;
use genga_tests::draw_layers;
use genga_tests::lines::ink::Ink;

fn ink_of(scene: &Scene, style: &Style, view: &View) -> Ink {
    Ink::of(&draw_layers(scene, style, view, &[LayerKind::Lines]))
}
