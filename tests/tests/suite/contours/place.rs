//! Lines are where the mesh has them in f64, whole and nowhere else.

use genga::render::{Orbit, View};
use genga::scene::Pose;
use genga_tests::edges::cameras;
use genga_tests::lines::figures::{Sight, contour_style};
use genga_tests::lines::outline::outline;
use genga_tests::lines::subjects::{SUBJECTS, ball, subject};
use genga_tests::lines::{Figures, measure, measure_owners};
use genga_tests::scenes::orbit_view;
use glam::DVec3;

use super::ink_of;

#[test]
fn expected_lines_are_drawn_whole_and_nothing_else() {
    for name in SUBJECTS {
        let scene = subject(name);
        // A near one, a far one and a parallel one of twenty.
        for view in cameras(&scene, 20, [240, 180]).iter().skip(2).step_by(7) {
            let figures = measure(&scene, 2.5, view);
            assert!(figures.expected_px > 200.0, "{name}: hardly any lines: {figures:?}");
            assert_eq!(
                figures.faults(),
                [""; 0],
                "{name}, {:?}: {:?}",
                view.camera,
                figures.places
            );
        }
    }
}

#[test]
fn no_object_is_drawn_over_what_hides_it() {
    for name in ["cube-before-plane", "teapot-on-box", "two-boxes"] {
        let scene = subject(name);
        let views = cameras(&scene, 20, [240, 180]);
        let views = views.iter().skip(1).step_by(8);
        let figures = views.map(|view| measure_owners(&scene, 4.0, view, name));
        let all = figures.fold(Figures::default(), Figures::and);
        assert_eq!(all.over, 0, "{name}: {:?}", all.places);
    }
}

#[test]
fn a_balls_outline_is_its_smooth_contour() {
    for (segments, rings) in [(24, 16), (200, 100)] {
        let scene = ball(segments, rings);
        for (azimuth_deg, orthographic) in [(0.0, true), (17.0, false), (71.0, false)] {
            let orbit = Orbit { azimuth_deg, orthographic, ..Orbit::default() };
            let view = View { supersample: 1, ..orbit_view(&scene, &orbit, [256, 256]) };
            let ink = ink_of(&scene, &contour_style(3.0, 256, ""), &view);
            let sight = Sight::new(&scene, &Pose::rest(&scene), &view);
            let found = outline(&ink, &sight.lines, &sight.eye, DVec3::ZERO, 3.0);
            let what = format!("{segments} × {rings}, {azimuth_deg}°: {found:?}");
            assert_eq!((found.open, found.doubled), (0, 0), "{what}");
            assert!(found.off_px <= 0.5 && found.rms_px <= 0.2, "{what}");
            assert!(found.width_off_px <= 0.5 && found.turn_deg <= 5.0, "{what}");
        }
    }
}
