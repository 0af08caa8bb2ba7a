//! A slow turn: nothing pops.

use genga::render::{LayerKind, Orbit, View, ViewCamera};
use genga::scene::Pose;
use genga_tests::draw_layers;
use genga_tests::lines::figures::contour_style;
use genga_tests::lines::ink::Ink;
use genga_tests::lines::motion::pops;
use genga_tests::lines::subjects::subject;
use genga_tests::scenes::root;

use crate::Report;

/// 120 frames of 1° each.
pub(crate) fn motion(report: &mut Report) {
    // The figure that turns; without one, the teapot.
    let hero = root().join("assets/models/hero.glb").is_file();
    let names = if hero { vec!["hero", "teapot-on-box"] } else { vec!["teapot-on-box"] };
    for name in names {
        let scene = subject(name);
        let pose = Pose::rest(&scene);
        let extremes = scene.extremes(&pose);
        let size = [480, 360];
        let style = contour_style(2.5, size[1], "");
        let mut before: Option<Ink> = None;
        let (mut popped, mut longest) = (0, 0);
        for degrees in 0_u8..120 {
            let azimuth_deg = f32::from(degrees);
            let orbit = Orbit { azimuth_deg, elevation_deg: 20.0, ..Orbit::default() };
            let camera = ViewCamera::turntable(&extremes, &orbit, 4.0 / 3.0);
            let view = View::new(camera, size);
            let ink = Ink::of(&draw_layers(&scene, &style, &view, &[LayerKind::Lines]));
            for part in before.iter().flat_map(|before| pops(before, &ink)) {
                popped += 1;
                longest = longest.max(part.extent());
                let (at, extent) = (part.pixels[0], part.extent());
                report
                    .check(false, || format!("{name}, frame {degrees}: {extent} px pop at {at:?}"));
            }
            before = Some(ink);
        }
        println!("  {name}: {popped} parts of lines pop in 120 frames, the longest {longest} px");
    }
}
