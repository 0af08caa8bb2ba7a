//! Balls' outlines against the smooth contours of their meshes.

use genga::render::{LayerKind, Orbit, View};
use genga::scene::Pose;
use genga_tests::draw_layers;
use genga_tests::lines::figures::{Sight, contour_style};
use genga_tests::lines::ink::Ink;
use genga_tests::lines::outline::outline;
use genga_tests::lines::show::leave;
use genga_tests::lines::subjects::ball;
use genga_tests::scenes::orbit_view;
use glam::DVec3;

use crate::Report;

/// Two meshes, three widths, 20 cameras.
pub(crate) fn outlines(report: &mut Report) {
    println!("  mesh, width: off px, rms px, turn °, width off px, open, doubled of rays");
    for (segments, rings) in [(24, 16), (200, 100)] {
        let scene = ball(segments, rings);
        for width in [1.5, 3.0, 6.0] {
            let (mut off, mut rms, mut turn, mut wide) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
            let (mut rays, mut open, mut doubled) = (0, 0, 0);
            for i in 0..20_u8 {
                let orbit = Orbit {
                    azimuth_deg: 17.0 * f32::from(i),
                    elevation_deg: 7.0 * f32::from(i % 8),
                    zoom: if i % 2 == 0 { 1.0 } else { 0.35 },
                    orthographic: i % 5 == 4,
                    ..Orbit::default()
                };
                let view = View { supersample: 1, ..orbit_view(&scene, &orbit, [480, 480]) };
                let style = contour_style(width, 480, "");
                let picture = draw_layers(&scene, &style, &view, &[LayerKind::Lines]);
                let sight = Sight::new(&scene, &Pose::rest(&scene), &view);
                let ink = Ink::of(&picture);
                let found = outline(&ink, &sight.lines, &sight.eye, DVec3::ZERO, width);
                (off, rms) = (off.max(found.off_px), rms.max(found.rms_px));
                (turn, wide) = (turn.max(found.turn_deg), wide.max(found.width_off_px));
                rays += found.rays;
                open += found.open;
                doubled += found.doubled;
                let what = format!("ball of {segments} × {rings}, width {width}, camera {i}");
                if found.off_px > 0.5 || found.open + found.doubled > 0 || found.turn_deg > 5.0 {
                    leave(&ink, &sight, &format!("ball-{segments}-{width}-{i}"));
                }
                report.check(found.off_px <= 0.5 && found.open + found.doubled == 0, || {
                    format!("{what}: {found:?}")
                });
                report.check(found.turn_deg <= 5.0, || format!("{what} zig-zags: {found:?}"));
            }
            println!(
                "  {segments} × {rings}, {width}: {off:.2}, {rms:.2}, {turn:.1}, {wide:.2}, {open}, \
                 {doubled} of {rays}"
            );
        }
    }
}
