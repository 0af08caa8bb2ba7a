//! Detection on smaller pictures against detection at full size.

use genga::render::LayerKind;
use genga::scene::Pose;
use genga::style::{DetectScale, Style};
use genga_tests::draw_layers;
use genga_tests::edges::cameras;
use genga_tests::lines::broad::{broad_lines, differing};
use genga_tests::lines::figures::{Sight, compare, contour_style};
use genga_tests::lines::ink::Ink;
use genga_tests::lines::show::leave;
use genga_tests::lines::subjects::{SUBJECTS, subject};

use crate::Report;

/// Every subject from 20 cameras, with lines 3 pixels wide.
pub(crate) fn scales(report: &mut Report) {
    println!(
        "  subject, scale: pixels that differ on broad parts, of, %; astray; smallest spot; drawn %"
    );
    let size = [960, 720];
    let whole = contour_style(3.0, size[1], "");
    let scales =
        [(DetectScale::TwoThirds, "2/3"), (DetectScale::Third, "1/3"), (DetectScale::Sixth, "1/6")];
    for name in SUBJECTS {
        let scene = subject(name);
        let mut sums = [(0, 0, 0, usize::MAX, 0.0, 0.0); 3];
        for (i, view) in cameras(&scene, 20, size).iter().enumerate() {
            let sight = Sight::new(&scene, &Pose::rest(&scene), view);
            let broad = broad_lines(&sight, size, 6.0, 3.0);
            let draw =
                |style: &Style| Ink::of(&draw_layers(&scene, style, view, &[LayerKind::Lines]));
            let full = draw(&whole);
            for (sum, (scale, scale_name)) in sums.iter_mut().zip(scales) {
                let mut style = whole.clone();
                style.lines.detect.scale = scale;
                let ink = draw(&style);
                let (differ, inked) = differing(&full, &ink, &broad);
                // Half the width and 1.5 pixels are 3 pixels here.
                let figures = compare(&ink, &sight, 3.0);
                let what = format!("{name}, {scale_name}, camera {i}");
                if 100 * differ >= inked || figures.astray > 0 {
                    let scale_name = scale_name.replace('/', "of");
                    leave(&ink, &sight, &format!("{name}-scale-{scale_name}-{i}"));
                }
                report.check(100 * differ < inked, || {
                    format!("{what}: {differ} of {inked} pixels on broad parts differ")
                });
                report.check(figures.astray == 0, || {
                    format!("{what}: {} astray: {:?}", figures.astray, figures.places.first())
                });
                let spot = figures.smallest_spot.unwrap_or(usize::MAX);
                report.check(spot >= 4, || format!("{what}: a crumb of {spot} pixels"));
                sum.0 += differ;
                sum.1 += inked;
                sum.2 += figures.astray;
                sum.3 = sum.3.min(spot);
                sum.4 += figures.covered_px;
                sum.5 += figures.expected_px;
            }
        }
        for ((differ, inked, astray, spot, covered, expected), (_, scale)) in
            sums.into_iter().zip(scales)
        {
            let percent = 100.0 * differ as f64 / f64::max(inked as f64, 1.0);
            let drawn = 100.0 * covered / f64::max(expected, 1.0);
            println!(
                "  {name}, {scale}: {differ}, {inked}, {percent:.2}; {astray}; {spot}; {drawn:.2}"
            );
        }
    }
}
