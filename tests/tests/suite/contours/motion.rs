//! Lines in motion come and go little by little, and each frame is drawn from itself alone.

use genga::render::{Orbit, View, ViewCamera};
use genga::scene::{Pose, Scene};
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::motion::pops;
use genga_tests::scenes::model;

use super::ink_of;

/// A frame of a turn round a scene.
fn turned(scene: &Scene, degrees: f32, size: [u32; 2]) -> View {
    let orbit = Orbit { azimuth_deg: degrees, elevation_deg: 20.0, ..Orbit::default() };
    let extremes = scene.extremes(&Pose::rest(scene));
    let aspect = size[0] as f32 / size[1] as f32;
    View::new(ViewCamera::turntable(&extremes, &orbit, aspect), size)
}

#[test]
fn nothing_pops_in_a_slow_turn() {
    let scene = model("teapot-on-box");
    let size = [240, 160];
    let style = contour_style(2.5, size[1], "");
    for start in [0, 100, 215] {
        let mut before = None;
        for degrees in start..start + 12 {
            let ink = ink_of(&scene, &style, &turned(&scene, degrees as f32, size));
            if let Some(before) = &before {
                let popped = pops(before, &ink);
                let places: Vec<_> = popped.iter().map(|p| (p.pixels[0], p.extent())).collect();
                assert!(popped.is_empty(), "{degrees}°: {places:?}");
            }
            before = Some(ink);
        }
    }
}
