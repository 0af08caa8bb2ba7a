//! Energy waves against adaptive quadrature: every shape, 3,600 rays from each of three cameras.

use genga::render::View;
use genga::scene::{Wave, WaveMethod, WavePlacement, WaveShape};
use genga_tests::waves::cases::{Random, energies, errors, look, scaled, scene_of, shapes, views};
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
    against_simpson(report);
    finite(report);
    core_profile(report);
    steady(report);
}

/// The curves of the benchmark, by the exact method and by Simpson's rule with 500 points: with the
/// thinnest core that the model has, half a pixel, which is nearest to Abe's density, and with one
/// of 2 cm.
fn against_simpson(report: &mut Report) {
    let no_end = |_: &genga_tests::waves::Ray| 1e9;
    let [(_, view), ..] = views([512, 512]);
    println!("  curve, core: largest error % (and of 99 in 100 rays), exact, fine, m = 500");
    for (name, shape) in shapes() {
        if !["helix", "trig", "bezier", "b-spline"].contains(&name) {
            continue;
        }
        for core in [0.0, 0.02] {
            let wave = Wave {
                shape: shape.clone(),
                core,
                radius: Some(0.5),
                reach: 12.0,
                ..Wave::default()
            };
            let fine = Wave { tolerance: 0.001, ..wave.clone() };
            let mut simpson = scene_of(std::slice::from_ref(&wave));
            simpson.wave_method = WaveMethod::Simpson { points: 500, thinning: 1, de_boor: false };
            let scenes = [scene_of(std::slice::from_ref(&wave)), scene_of(&[fine]), simpson];
            let found =
                scenes.map(|scene| errors(&wave, &view, &energies(&scene, &view), 1200, &no_end));
            let text = found.map(|e| format!("{:.4} ({:.4})", 100.0 * e.largest, 100.0 * e.p99));
            println!("  {name}, {core}: {}", text.join(", "));
            report.check(found[0].largest <= 0.01 && found[1].largest <= 0.001, || {
                format!("{name}, core {core}: {:?} and {:?}", found[0], found[1])
            });
        }
    }
}

/// A million random rays of waves of all sizes, some through the middle, along the axis and across
/// it.
fn finite(report: &mut Report) {
    let mut random = Random(5);
    let (mut rays, mut bad) = (0_usize, 0_usize);
    for (_, shape) in shapes() {
        for case in 0..8 {
            let scale = 10.0_f32.powi(case - 3);
            let is_singular = case % 2 == 0;
            let direction = match is_singular {
                true => Vec3::X,
                false => Vec3::new(random.signed(), random.signed(), random.signed() + 1.1),
            };
            let wave = Wave {
                shape: scaled(&shape, scale),
                core: 0.02 * scale,
                radius: (random.below(3) > 0).then_some(0.8 * scale),
                reach: 1000.0 * scale,
                attenuation: 0.5 * random.below(5) as f32,
                swell: [0.1, 0.3],
                placement: WavePlacement::At {
                    anchor: Default::default(),
                    direction,
                    follow: false,
                    roll: if is_singular { 0.0 } else { random.signed() },
                },
                ..Wave::default()
            };
            // An odd size has a pixel in the very middle.
            let (eye, at) = match case {
                0 => (Vec3::new(-3.0, 0.0, 0.0), Vec3::ZERO),
                2 => (Vec3::new(2.0, 0.0, 5.0), Vec3::new(2.0, 0.0, 0.0)),
                4 => (Vec3::ZERO, Vec3::X),
                _ => {
                    (Vec3::new(random.signed(), random.signed(), random.signed()) * 6.0, Vec3::ZERO)
                }
            };
            let mut camera = look(eye * scale, at * scale);
            camera.near = 0.1 * scale;
            let view = View { supersample: 1, ..View::new(camera, [121, 121]) };
            let energies = energies(&scene_of(&[wave]), &view);
            rays += energies.len();
            bad += energies.iter().filter(|e| !(e.is_finite() && **e > -1e-3)).count();
        }
    }
    println!("  {rays} random rays, {bad} without a usable number");
    report.check(bad == 0 && rays >= 1_000_000, || format!("{bad} of {rays} rays"));
}

/// A core over a pixel wide looks alike at 512 and 2048 rows.
fn core_profile(report: &mut Report) {
    let shape = WaveShape::Capsule { length: 4.0 };
    let wave = Wave { shape, radius: Some(0.8), core: 0.02, ..Wave::default() };
    let scene = scene_of(&[wave]);
    let camera = look(Vec3::new(2.0, 0.0, 4.0), Vec3::new(2.0, 0.0, 0.0));
    let view = |side| View { supersample: 1, ..View::new(camera, [16, side]) };
    let (small, large) = (energies(&scene, &view(512)), energies(&scene, &view(2048)));
    let mut worst = 0.0_f32;
    for y in 0..512 {
        // The middle of a pixel of the small picture is a corner of four of the large one.
        let fine = [4 * y + 1, 4 * y + 2].map(|y| 0.5 * (large[y * 16 + 7] + large[y * 16 + 8]));
        let coarse = 0.5 * (small[y * 16 + 7] + small[y * 16 + 8]);
        let fine = 0.5 * (fine[0] + fine[1]);
        worst = worst.max((coarse - fine).abs() / fine.max(0.01));
    }
    println!("  the core at 512 and 2048 rows differs by {:.3} %", 100.0 * worst);
    report.check(worst <= 0.02, || format!("the core's profile differs by {worst}"));
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
