//! Speed lines and smears.

use genga::render::{LayerKind, Picture};
use genga::scene::{
    Beam, BeamOrder, BeamShape, BeamTone, Channel, ChannelTarget, Clip, Interpolation, MorphTarget,
    Pose, Scene,
};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{Builder, moved, ortho_view, style};
use genga_tests::{Pixels, shared};
use glam::{Vec3, Vec4};

/// Metres per second along x.
const SPEED: f32 = 2.0;

/// A cube of half a metre that moves along x, and one that stands above it.
fn cubes() -> Scene {
    let mut scene = Builder::new();
    let cube = || shapes::cuboid(Vec3::splat(0.5));
    let node = scene.object("fast", cube(), None, moved(0.0, 0.0, 0.0));
    scene.object("still", cube(), None, moved(0.0, 1.0, 0.0));
    scene.raw().clips.push(Clip {
        name: "go".to_owned(),
        channels: vec![Channel {
            node,
            target: ChannelTarget::Translation,
            interpolation: Interpolation::Linear,
            times: vec![0.0, 10.0],
            values: vec![-10.0, 0.0, 0.0, 10.0 * SPEED - 10.0, 0.0, 0.0],
        }],
    });
    scene.build()
}

/// The shutter is open for a quarter of a second; only speed lines are in the set.
const LINES: &str = "[motion]\nshutter = { angle_deg = 2160, fps = 24 }\n\
    [motion.speed_lines]\ndensity = 900\nirregularity = 0\nset = \"speed\"\n\
    [lines]\nreference_height = 256\n[[lines.sets]]\nname = \"speed\"\ntypes = [\"user\"]\nwidth = 8\n";

fn draw_at(scene: &Scene, style: &Style, time: f32, stands: bool) -> Picture {
    let shared = shared();
    let _turn = shared.turn();
    let mut prepared = shared.renderer.prepare(scene, style).expect("it can be drawn");
    set_time(&mut prepared, scene, style, time, stands);
    picture(&prepared)
}

fn set_time(
    prepared: &mut genga::render::Prepared,
    scene: &Scene,
    style: &Style,
    time: f32,
    stands: bool,
) {
    let pose = Pose::at(scene, 0, time);
    let before = |ago: f32| Pose::at(scene, 0, if stands { time } else { time - ago });
    let past: Vec<Pose> = style.motion.moments().into_iter().map(before).collect();
    shared().renderer.set_motion(prepared, scene, &pose, &past).expect("the poses fit");
}

fn picture(prepared: &genga::render::Prepared) -> Picture {
    let layers = [LayerKind::LineMask, LayerKind::Ids];
    let view = ortho_view([384, 256], 4.0);
    let mut quiet = |_, _| {};
    let drawn = shared().renderer.picture(prepared, &view, &layers, &mut quiet);
    pollster::block_on(drawn).expect("it can be drawn")
}

/// First and last column with something, in rows.
fn columns(
    picture: &Picture,
    rows: std::ops::Range<u32>,
    is: impl Fn(u32, u32) -> bool,
) -> Option<[u32; 2]> {
    let columns = (0..picture.width).filter(|&x| rows.clone().any(|y| is(x, y)));
    let columns: Vec<u32> = columns.collect();
    Some([*columns.first()?, *columns.last()?])
}

#[test]
fn a_speed_line_is_as_long_as_speed_times_shutter() {
    let (scene, style) = (cubes(), style(LINES));
    let picture = draw_at(&scene, &style, 5.25, false);
    let mask = picture.floats(LayerKind::LineMask);
    let has_ink = |x: u32, y: u32| mask[4 * (picture.width * y + x) as usize] > 0.0;
    // x = 0.5 − 0.25 m at its trailing side, 64 pixels a metre.
    let trailing = 192.0 + 64.0 * 0.25;
    let [first, _] = columns(&picture, 90..170, has_ink).expect("there are speed lines");
    let length = trailing - first as f32;
    let expected = 64.0 * SPEED * style.motion.shutter_s();
    assert!((length - expected).abs() <= 1.0, "{length} pixels, not {expected}");
    let beside = columns(&picture, 0..84, has_ink);
    assert_eq!(beside, None, "what stands still has none");
}

#[test]
fn a_still_pose_has_no_speed_lines_and_no_smear() {
    let smear = format!("{LINES}[motion.smear]\namount = 1\n");
    let scene = cubes();
    let still = draw_at(&scene, &style(&smear), 5.25, true);
    assert!(still.floats(LayerKind::LineMask).iter().all(|&coverage| coverage == 0.0));
    let off = draw_at(&scene, &style(&LINES.replace("2160", "0")), 5.25, false);
    assert!(off.floats(LayerKind::LineMask).iter().all(|&coverage| coverage == 0.0));
    let object = |p: &Picture| {
        (0..256)
            .flat_map(|y| (0..384).map(move |x| (x, y)))
            .map(|(x, y)| p.ids(x, y))
            .collect::<Vec<_>>()
    };
    assert_eq!(object(&still), object(&off), "nothing is smeared");
}

#[test]
fn the_trailing_side_is_left_behind_by_its_part_of_the_way() {
    let text = LINES.replace("density = 900", "density = 0")
        + "[motion.smear]\namount = 0.5\nnoise = 0\nobjects = [\"fast\"]\n";
    let picture = draw_at(&cubes(), &style(&text), 5.25, false);
    let fast = |x: u32, y: u32| picture.ids(x, y)[0] == 1;
    let [first, last] = columns(&picture, 120..136, fast).expect("the cube is there");
    // At corners, the smooth normal has 1/√3 along the way.
    let left_behind = 0.5 * SPEED * 0.25 * 64.0 / 3.0_f32.sqrt();
    assert!((first as f32 - (208.0 - left_behind)).abs() <= 1.0, "{first}");
    assert!((last as f32 - 239.0).abs() <= 1.0, "its front stays: {last}");
    let still = |x: u32, y: u32| picture.ids(x, y)[0] == 2;
    let still = columns(&picture, 50..78, still).expect("the other cube is there");
    assert_eq!(still, [176, 207]);
}

#[test]
fn speed_lines_lie_before_beams_that_are_farther_away() {
    let style = style(&LINES.replace("width = 8", "width = 8\ncolor = \"#0f0\""));
    let drawn = |z: f32| {
        let mut scene = cubes();
        scene.beams.push(Beam {
            shape: BeamShape::Path {
                points: vec![Vec3::new(-3.0, 0.0, z), Vec3::new(3.0, 0.0, z)],
                is_bezier: false,
                radius: [0.4; 2],
            },
            ramp: vec![BeamTone { at: 0.0, color: Vec4::new(1.0, 0.0, 0.0, 1.0), softness: 0.0 }],
            order: BeamOrder::Over,
            ..Beam::default()
        });
        draw_at(&scene, &style, 5.25, false)
    };
    let (before, behind) = (drawn(-2.0), drawn(2.0));
    let mask = before.floats(LayerKind::LineMask);
    // Behind the cube, in the middle of the beam.
    let places = || (110..145_u32).flat_map(|y| (150..200_u32).map(move |x| (x, y)));
    let is_inked = |x: u32, y: u32| mask[4 * (before.width * y + x) as usize] >= 1.0;
    let inked: Vec<_> = places().filter(|&(x, y)| is_inked(x, y)).collect();
    assert!(inked.len() > 50, "only {} pixels of ink", inked.len());
    for (x, y) in inked {
        assert_eq!(before.at(x, y), [0, 255, 0, 255], "({x}, {y})");
        assert_eq!(behind.at(x, y), [255, 0, 0, 255], "({x}, {y})");
    }
}

#[test]
fn morph_targets_smear_too() {
    let mut scene = Builder::new();
    let cube = shapes::cuboid(Vec3::splat(0.5));
    let count = cube.positions.len();
    let node = scene.object("fast", cube, None, moved(-20.0, 0.0, 0.0));
    let mesh = scene.raw().nodes[node].mesh.expect("it has a mesh");
    scene.raw().meshes[mesh].primitives[0].morph_targets =
        vec![MorphTarget { positions: vec![Vec3::X * 10.0; count], normals: Vec::new() }];
    scene.raw().clips.push(Clip {
        name: "go".to_owned(),
        channels: vec![Channel {
            node,
            target: ChannelTarget::MorphWeights { count: 1 },
            interpolation: Interpolation::Linear,
            times: vec![0.0, 10.0],
            // To where the cube of the other tests is at any moment.
            values: vec![1.0, 1.0 + SPEED],
        }],
    });
    let text =
        LINES.replace("density = 900", "density = 0") + "[motion.smear]\namount = 0.5\nnoise = 0\n";
    let picture = draw_at(&scene.build(), &style(&text), 5.25, false);
    let fast = |x: u32, y: u32| picture.ids(x, y)[0] == 1;
    let [first, last] = columns(&picture, 120..136, fast).expect("the cube is there");
    let left_behind = 0.5 * SPEED * 0.25 * 64.0 / 3.0_f32.sqrt();
    assert!((first as f32 - (208.0 - left_behind)).abs() <= 1.0, "{first}");
    assert!((last as f32 - 239.0).abs() <= 1.0, "its front stays: {last}");
}

#[test]
fn a_frame_alone_is_the_frame_in_a_sequence() {
    let text = format!("{LINES}[motion.smear]\namount = 0.5\n");
    let (scene, style) = (cubes(), style(&text));
    let alone = draw_at(&scene, &style, 5.3, false);
    let shared = shared();
    let _turn = shared.turn();
    let mut prepared = shared.renderer.prepare(&scene, &style).expect("it can be drawn");
    for time in [5.0, 5.1, 5.2, 5.3] {
        set_time(&mut prepared, &scene, &style, time, false);
    }
    assert_eq!(picture(&prepared).rgba, alone.rgba);
}

#[test]
fn speed_lines_without_their_set_are_told() {
    let shared = shared();
    let _turn = shared.turn();
    for (text, part) in [
        (LINES.replace("set = \"speed\"", "set = \"sped\""), "which there is not (known: speed)"),
        (
            LINES.replace("[[lines.sets]]", "method = \"hull\"\n[[lines.sets]]"),
            "'contour' and 'reference'",
        ),
    ] {
        let prepared = shared.renderer.prepare(&cubes(), &style(&text)).expect("it can be drawn");
        assert!(prepared.warnings().iter().any(|w| w.contains(part)), "{:?}", prepared.warnings());
    }
}
