//! Drawn contours against the lines that a mesh must have, from many cameras. Where something is
//! wrong, a picture of it is left in `out/lines`.

use genga_tests::edges::cameras;
use genga_tests::lines::figures::{compare, look};
use genga_tests::lines::show::leave;
use genga_tests::lines::subjects::{SUBJECTS, subject};
use genga_tests::lines::{Figures, measure_owners};

use crate::Report;

/// Every subject from 20 cameras, near and far.
pub(crate) fn contours(report: &mut Report) {
    println!("  subject, width: covered %, longest gap px, smallest spot, astray of inked, over");
    for name in SUBJECTS {
        let scene = subject(name);
        for width in [1.5, 3.0, 6.0] {
            let views = cameras(&scene, 20, [480, 360]);
            let mut all = Figures::default();
            for (i, view) in views.iter().enumerate() {
                let (ink, sight) = look(&scene, width, view);
                let mut one = compare(&ink, &sight, width);
                if width == 3.0 && scene.nodes.iter().filter(|n| n.mesh.is_some()).count() > 1 {
                    let owners = measure_owners(&scene, width, view, &format!("{name}-{i}"));
                    one.over = owners.over;
                    one.places.extend(owners.places);
                }
                let what = format!("{name}, width {width}, camera {i}");
                if !one.faults().is_empty() {
                    leave(&ink, &sight, &format!("{name}-{width}-{i}"));
                }
                for fault in one.faults() {
                    let places: Vec<_> = one.places.iter().take(4).map(String::as_str).collect();
                    report.check(false, || format!("{what}: {fault} ({})", places.join("; ")));
                }
                all = all.and(one);
            }
            println!(
                "  {name}, {width}: {:.3}, {:.1}, {}, {} of {}, {}",
                100.0 * all.coverage(),
                all.longest_gap_px,
                all.smallest_spot.unwrap_or(0),
                all.astray,
                all.inked,
                all.over,
            );
        }
    }
}
