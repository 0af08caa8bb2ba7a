//! Energy waves against adaptive quadrature: every shape, 3,600 rays from each of three cameras.

use genga::render::View;
use genga::scene::{Wave, WavePlacement};
use genga_tests::waves::cases::{Random, energies, errors, look, scene_of, shapes, views};
use glam::Vec3;

use super::Report;

const RAYS: usize = 3600;

pub(super) fn run(report: &mut Report) {
    let no_end = |_: &genga_tests::waves::Ray| 1e9;
    println!("  shape, camera, tolerance: largest error %, mean %, of the brightest %");
    for (name, shape) in shapes() {
        for (tolerance, bound) in [(0.01, 0.01), (0.001, 0.001)] {
            let wave =
                Wave { shape: shape.clone(), radius: Some(0.8), tolerance, ..Wave::default() };
            for (side, view) in views([480, 480]) {
                let energies = energies(&scene_of(std::slice::from_ref(&wave)), &view);
                let errors = errors(&wave, &view, &energies, RAYS, &no_end);
                println!(
                    "  {name}, {side}, {tolerance}: {:.4}, {:.5}, {:.4}",
                    100.0 * errors.largest,
                    100.0 * errors.mean,
                    100.0 * errors.of_peak
                );
                report.check(errors.largest <= bound, || {
                    format!("{name}, {side}, {tolerance}: {errors:?}")
                });
            }
        }
    }
    finite(report);
    steady(report);
}

/// A million random rays of waves of all sizes.
fn finite(report: &mut Report) {
    let mut random = Random(5);
    let (mut rays, mut bad) = (0_usize, 0_usize);
    for (_, shape) in shapes() {
        for _ in 0..8 {
            let wave = Wave {
                shape: shape.clone(),
                core: 0.02,
                radius: (random.below(3) > 0).then_some(0.8),
                attenuation: 0.5 * random.below(5) as f32,
                swell: [0.1, 0.3],
                placement: WavePlacement::At {
                    anchor: Default::default(),
                    direction: Vec3::new(random.signed(), random.signed(), random.signed() + 1.1),
                    follow: false,
                    roll: random.signed(),
                },
                ..Wave::default()
            };
            let eye = Vec3::new(random.signed(), random.signed(), random.signed()) * 6.0;
            let view = View { supersample: 1, ..View::new(look(eye, Vec3::ZERO), [121, 121]) };
            let energies = energies(&scene_of(&[wave]), &view);
            rays += energies.len();
            bad += energies.iter().filter(|e| !(e.is_finite() && **e > -1e-3)).count();
        }
    }
    println!("  {rays} random rays, {bad} without a usable number");
    report.check(bad == 0 && rays >= 1_000_000, || format!("{bad} of {rays} rays"));
}

/// A camera that moves slowly: how much the error changes from frame to frame, in parts of the
/// brightest energy.
fn steady(report: &mut Report) {
    for (name, shape) in shapes() {
        let mut before: Option<Vec<f32>> = None;
        let mut worst = 0.0_f32;
        for frame in 0..6 {
            let x = 2.5 + 0.004 * frame as f32;
            let camera = look(Vec3::new(x, 1.0, 6.0), Vec3::new(2.0, 0.0, 0.0));
            let view = View { supersample: 1, ..View::new(camera, [200, 200]) };
            let wave = Wave { shape: shape.clone(), radius: Some(0.8), ..Wave::default() };
            let coarse = energies(&scene_of(std::slice::from_ref(&wave)), &view);
            let fine = energies(&scene_of(&[Wave { tolerance: 1e-4, ..wave }]), &view);
            let peak = fine.iter().copied().fold(0.0, f32::max);
            let off: Vec<f32> = coarse.iter().zip(&fine).map(|(a, b)| (a - b) / peak).collect();
            if let Some(before) = &before {
                for (a, b) in off.iter().zip(before) {
                    worst = worst.max((a - b).abs());
                }
            }
            before = Some(off);
        }
        println!("  {name}: the error changes by {:.4}/255 from frame to frame", 255.0 * worst);
        report.check(worst <= 1.0 / 255.0, || format!("{name} flickers by {worst}"));
    }
}
