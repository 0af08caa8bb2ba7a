//! Detection on a smaller picture draws the same lines, or leaves thin parts out whole.

use genga::scene::{Pose, Scene};
use genga::shapes;
use genga::style::Style;
use genga_tests::Eye;
use genga_tests::edges::cameras;
use genga_tests::lines::broad::{broad_lines, differing};
use genga_tests::lines::capsules::union_of_capsules;
use genga_tests::lines::figures::{FAINT, Sight, compare, contour_style};
use genga_tests::lines::ink::Ink;
use genga_tests::lines::subjects::{SUBJECTS, subject};
use genga_tests::scenes::{Builder, ortho_view, parts};
use glam::{DVec2, DVec3, Quat, Vec2, Vec3};

use super::ink_of;

const SCALES: [&str; 3] = ["2/3", "1/3", "1/6"];

fn scaled(style: &Style, scale: &str) -> Style {
    let mut style = style.clone();
    style.lines.detect.scale = match scale {
        "2/3" => genga::style::DetectScale::TwoThirds,
        "1/3" => genga::style::DetectScale::Third,
        "1/6" => genga::style::DetectScale::Sixth,
        _ => genga::style::DetectScale::Full,
    };
    style
}

#[test]
fn broad_parts_have_the_same_lines_at_every_scale() {
    let size = [384, 288];
    let style = contour_style(3.0, size[1], "");
    for name in SUBJECTS {
        let scene = subject(name);
        for view in cameras(&scene, 20, size).iter().skip(2).step_by(9) {
            let sight = Sight::new(&scene, &Pose::rest(&scene), view);
            let broad = broad_lines(&sight, size, 6.0, 3.0);
            let whole = ink_of(&scene, &style, view);
            for scale in SCALES {
                let ink = ink_of(&scene, &scaled(&style, scale), view);
                let (differ, inked) = differing(&whole, &ink, &broad);
                let what = format!("{name}, {scale}, {:?}", view.camera);
                assert!(inked > 500, "{what}: {inked} pixels of lines");
                assert!(100 * differ < inked, "{what}: {differ} of {inked} pixels differ");
                // Half the width and 1.5 pixels are 3 pixels here.
                let figures = compare(&ink, &sight, 3.0);
                assert_eq!(figures.astray, 0, "{what}: {:?}", figures.places);
            }
        }
    }
}

#[test]
fn seams_of_round_parts_are_whole_at_a_sixth() {
    // A handle that leaves a body at a flat angle, as large as a few texels.
    let size = [960, 720];
    let style = scaled(&contour_style(3.0, size[1], ""), "1/6");
    let scene = subject("teapot-on-box");
    let view = &cameras(&scene, 20, size)[4];
    let sight = Sight::new(&scene, &Pose::rest(&scene), view);
    let figures = compare(&ink_of(&scene, &style, view), &sight, 3.0);
    let part = figures.coverage();
    assert!(part > 0.999, "{part} is drawn: {:?}", figures.places);
    assert!(figures.longest_gap_px < 4.0, "a gap of {} px", figures.longest_gap_px);
    assert_eq!(figures.astray, 0, "{:?}", figures.places);
}

/// A bar `width` pixels wide and 100 long, tilted by `degrees` from upright, 0.3 pixels off the
/// middle of a picture of 128 pixels, with its outline.
fn bar(width: f64, degrees: f64) -> (Scene, Vec<[DVec2; 2]>) {
    let metres = 2.0 / 128.0;
    let size = DVec2::new(width, 100.0) * metres;
    let turn = Quat::from_rotation_z(degrees.to_radians() as f32);
    let middle = Vec3::new(0.3 * metres as f32, 0.0, 0.0);
    let mut scene = Builder::new();
    let plane = shapes::plane(Vec2::new(size.x as f32, size.y as f32));
    scene.object("bar", plane, None, parts(middle, turn, Vec3::ONE));
    let eye = Eye::new(&ortho_view([128, 128], 2.0));
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| {
        let p = DVec3::new(x * 0.5 * size.x, y * 0.5 * size.y, 0.0);
        eye.project(turn.as_dquat() * p + middle.as_dvec3())
    });
    (scene.build(), (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect())
}

/// Part of the ink that should be there, and ink where none should be.
fn kept(ink: &Ink, expected: &Ink) -> (f64, usize) {
    let pairs = || ink.values.iter().zip(&expected.values);
    let full = pairs().filter(|(_, wanted)| **wanted >= 200);
    let there = full.clone().filter(|(value, _)| **value >= 100).count();
    let elsewhere = pairs().filter(|(value, wanted)| **value >= FAINT && **wanted < 4).count();
    (there as f64 / full.count().max(1) as f64, elsewhere)
}

#[test]
fn thin_bars_keep_their_outline_or_lose_it_whole() {
    let view = ortho_view([128, 128], 2.0);
    let style = contour_style(2.0, 128, "");
    for scale in ["1", "2/3", "1/3", "1/6"] {
        for width in 1..=6 {
            for degrees in [0.0, 3.0, 20.0, 45.0, 71.0, 90.0] {
                let (scene, outline) = bar(f64::from(width), degrees);
                let ink = ink_of(&scene, &scaled(&style, scale), &view);
                let expected = union_of_capsules(&outline, 2.0, [128, 128]);
                let (part, elsewhere) = kept(&ink, &expected);
                let what = format!("{scale}, {width} px, {degrees}°");
                assert_eq!(elsewhere, 0, "{what}: ink beside the outline");
                let is_lost = ink.places(FAINT).next().is_none();
                assert!(part > 0.98 || is_lost, "{what}: {part} of the outline is left");
                assert!(!is_lost || width < 6, "{what}: a broad bar is lost");
            }
        }
    }
}
