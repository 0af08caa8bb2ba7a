use glam::Vec3;

use super::{
    Pose, Scene, Wave, WaveAnchor, WaveMethod, WaveMotion, WaveNoise, WavePlacement, WaveShape,
    wave_curve::WaveCurve,
};

fn fault(wave: Wave) -> String {
    let scene = Scene { waves: vec![wave], ..Scene::default() };
    scene.validate().expect_err("this wave must be refused").to_string()
}

fn of(shape: WaveShape) -> Wave {
    Wave { shape, ..Wave::default() }
}

#[test]
fn what_cannot_be_drawn_gets_a_sentence() {
    let points =
        |xs: &[f32]| xs.iter().map(|&x| Vec3::new(x, 0.1 * x * x, 0.0)).collect::<Vec<_>>();
    let spline = |order, knots: &[f32]| {
        let (points, knots) = (points(&[0.0, 1.0, 2.0, 3.0]), knots.to_vec());
        of(WaveShape::BSpline { points, order, knots })
    };
    let sums = |y| of(WaveShape::Trig { length: 4.0, turns: 1.0, y, z: Vec::new() });
    let cases = [
        (sums(vec![[0.1, 0.0], [1e7, 0.0]]), "term 10000000"),
        (sums(vec![[f32::NAN, 0.0]]), "term NaN"),
        (sums(vec![[0.0, 0.1]; 10_001]), "10001 terms"),
        (of(WaveShape::Capsule { length: 0.0 }), "length 0"),
        (of(WaveShape::Capsule { length: f32::NAN }), "length NaN"),
        (Wave { alpha: f32::NAN, ..Wave::default() }, "alpha NaN"),
        (Wave { reach: f32::INFINITY, ..Wave::default() }, "reach inf"),
        (of(WaveShape::Bezier { points: points(&[0.0, 2.0, 1.0, 1.5, 1.1]) }), "folds back"),
        (of(WaveShape::Polyline { points: points(&[0.0, 1.0, 0.5, 2.0]) }), "folds back"),
        (of(WaveShape::Polyline { points: points(&[1.0, 1.0]) }), "same place"),
        (of(WaveShape::Polyline { points: points(&[1.0]) }), "1 control points"),
        (of(WaveShape::Bezier { points: points(&[0.0, f32::NAN]) }), "NaN"),
        (of(WaveShape::Bezier { points: vec![Vec3::ZERO; 10_000] }), "10000 control points"),
        (spline(4, &[0.0, 1.0]), "2 knots: 4 points of order 4 need 8"),
        (spline(4, &[0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 1.0, 1.0]), "must not fall"),
        (spline(5, &[]), "order 5"),
        (spline(2, &[0.0, 0.0, 1.0, 1.0, 2.0, 2.0]), "tears the curve apart"),
        (Wave { growth: [0.6, 0.4], ..Wave::default() }, "grows from 0.6"),
        (Wave { profile: vec![[0.5, 1.0], [0.5, 2.0]], ..Wave::default() }, "profile"),
    ];
    for (wave, part) in cases {
        let fault = fault(wave);
        assert!(fault.contains(part) && fault.starts_with("wave 0"), "{part}: {fault}");
    }
    let anchor = WaveAnchor { nodes: vec![3], offset: Vec3::ZERO };
    let placement = WavePlacement::At { anchor, direction: Vec3::X, follow: false, roll: 0.0 };
    assert!(fault(Wave { placement, ..Wave::default() }).contains("only 0 nodes"));
    let many = Scene { waves: vec![Wave::default(); 300], ..Scene::default() };
    assert!(many.validate().expect_err("too many").to_string().contains("300 waves"));
    let method = WaveMethod::Simpson { points: 0, thinning: 1, de_boor: false };
    assert!(Scene { wave_method: method, ..Scene::default() }.validate().is_err());
}

#[test]
fn odd_but_right_curves_are_taken() {
    let line = |n: usize| (0..n).map(|i| Vec3::new(i as f32, 0.0, (i % 2) as f32)).collect();
    let twice = vec![Vec3::ZERO, Vec3::ZERO, Vec3::X, Vec3::X, Vec3::X * 2.0];
    for shape in [
        WaveShape::Polyline { points: line(10_000) },
        WaveShape::Polyline { points: twice.clone() },
        WaveShape::BSpline { points: twice, order: 3, knots: Vec::new() },
        WaveShape::BSpline { points: line(10_000), order: 16, knots: Vec::new() },
        WaveShape::Bezier { points: line(101) },
    ] {
        assert_eq!(of(shape).check(0), Ok(()));
    }
}

#[test]
fn a_stretched_wave_begins_and_ends_where_it_should() {
    let (from, to) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-2.0, 0.0, 7.0));
    let place = |offset| WaveAnchor { nodes: Vec::new(), offset };
    for shape in [
        WaveShape::Capsule { length: 2.0 },
        WaveShape::Polyline { points: vec![Vec3::ZERO, Vec3::Y, Vec3::new(1.0, 2.0, 0.0)] },
    ] {
        let placement = WavePlacement::Between { from: place(from), to: place(to), roll: 0.3 };
        let wave = Wave { placement, ..of(shape) };
        let places = wave.places(&Pose::rest(&Scene::default()), 3);
        assert!(places[0].distance(from) < 1e-5 && places[2].distance(to) < 1e-5, "{places:?}");
    }
}

#[test]
fn pieces_of_a_curve_are_parabolas_within_their_tolerance() {
    let noise = WaveNoise { amplitude: 0.2, frequency: 6.0, octaves: 2, seed: 3, phase: 0.4 };
    let helix = WaveShape::Helix { length: 3.0, radius: 0.5, turns: 4.0, phase: 0.0 };
    for wave in [of(helix.clone()), Wave { noise, ..of(helix) }] {
        let curve = WaveCurve::new(&wave);
        let values = curve.values_of_s(1e-3);
        assert_eq!((values[0], values[values.len() - 1]), (0.0, 1.0));
        assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
        for pair in values.windows(2) {
            let at = |part: f64| curve.at(pair[0] + part * (pair[1] - pair[0]));
            let [a, m, b] = [at(0.0), at(0.5), at(1.0)];
            for part in [0.1, 0.3, 0.6, 0.9] {
                // x is in proportion to s here.
                let parabola = a * (2.0 * (part - 0.5) * (part - 1.0))
                    - m * (4.0 * part * (part - 1.0))
                    + b * (2.0 * part * (part - 0.5));
                assert!(parabola.distance(at(part)) < 2e-3, "{pair:?}");
            }
        }
    }
}

#[test]
fn motion_grows_moves_and_turns() {
    let motion = WaveMotion {
        head_speed: 0.5,
        duration: 1.0,
        velocity: Vec3::X,
        spin: 2.0,
        noise_speed: 3.0,
    };
    let wave = motion.at(&of(WaveShape::Capsule { length: 1.0 }), 1.5);
    assert_eq!(wave.growth, [0.25, 0.75]);
    assert_eq!(wave.noise.phase, 4.5);
    let WavePlacement::At { anchor, roll, .. } = wave.placement else { panic!() };
    assert_eq!((anchor.offset, roll), (Vec3::X * 1.5, 3.0));
    assert_eq!(motion.at(&of(WaveShape::Sphere), 100.0).growth, [1.0, 1.0]);
    // A shot is not there before it begins, whole on its way, half when half of it has arrived.
    let shot = Wave { swell: [0.0, 0.4], ..of(WaveShape::Capsule { length: 1.0 }) };
    for (time, left) in [(-0.1, 0.0), (0.5, 1.0), (2.0, 1.0), (2.5, 0.5), (3.0, 0.0), (9.0, 0.0)] {
        let now = motion.at(&shot, time);
        assert_eq!((now.alpha, now.swell), (0.2 * left, [0.0, 0.4 * left]), "after {time} s");
    }
}
