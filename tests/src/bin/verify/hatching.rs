//! Hatching, long: five decades of zoom, slow zooms, 24 frames of motion, the hero's limbs.

use genga::render::Orbit;
use genga::scene::{Pose, Scene};
use genga::style::Style;
use genga_tests::hatching::surface::{Frame, Hit, Posed};
use genga_tests::hatching::{directions, hatching, planes, subjects};
use genga_tests::scenes::{model, orbit_view};
use glam::{DVec3, Vec3};

use crate::Report;

/// All of it.
pub(crate) fn run(report: &mut Report) {
    sizes(report);
    zooms(report);
    drifts(report);
    bodies(report);
    limbs(report);
}

/// Distance and tone of strokes on a plane, from pictures of 1 mm to 100 m.
fn sizes(report: &mut Report) {
    const SPACING: f64 = 10.0;
    let (mut nearest, mut farthest, mut off) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for tone in [0.2, 0.5, 0.8] {
        let style = planes::even_strokes(SPACING, 0.75 - 0.5 * tone, 0.5);
        for tilt_deg in [0.0, 55.0] {
            for step in 0_u8..=50 {
                let metres = 1e-3 * 10_f32.powf(f32::from(step) / 10.0);
                let figures = planes::measure(&style, metres, tilt_deg);
                off = off.max((figures.coverage - tone).abs());
                // Darker strokes touch, and cannot be counted.
                if tone < 0.4 {
                    nearest = nearest.min(figures.spacing);
                    farthest = farthest.max(figures.spacing);
                }
            }
        }
    }
    println!(
        "  planes of 1 mm to 100 m: strokes {nearest:.2} to {farthest:.2} px apart for {SPACING} px, tone off by {:.2} %",
        100.0 * off
    );
    report.check(nearest > 0.49 * SPACING && farthest < 1.02 * SPACING, || {
        format!("strokes are {nearest:.2} to {farthest:.2} px apart")
    });
    report.check(off <= 0.02, || format!("tone is off by {:.2} %", 100.0 * off));
}

fn hand(more: &str) -> Style {
    let toml = format!(
        "pattern = \"strokes\"\nspacing = 8\nlength = 110\nirregularity = 0.5\n\
         tones = [{{ at = 0.1, lum = 0.3 }}, {{ at = 0.7, lum = 0.6 }}]\n{more}"
    );
    hatching(&toml, 320)
}

/// As the suite has it: strokes that can be told from each other, of one tone.
fn sparse(more: &str) -> Style {
    let toml = format!(
        "pattern = \"strokes\"\nspacing = 12\nlength = 60\nirregularity = 0.5\nangle_deg = 40\n\
         tones = [{{ at = 0, lum = 0.55 }}]\n{more}"
    );
    hatching(&toml, 384)
}

/// 140 frames that magnify by 1 % each, which is two octaves.
fn zooms(report: &mut Report) {
    for name in subjects::BODIES {
        let scene = subjects::standing(name);
        let pose = Pose::rest(&scene);
        let style = hand("");
        let mut before: Option<Frame> = None;
        let mut worst = 0.0_f64;
        for step in 0_u16..140 {
            let view = subjects::magnified(320, 1.01_f32.powi(i32::from(step)));
            let frame = Frame::draw(&scene, &pose, &style, &view);
            if let Some(before) = &before {
                worst = worst.max(frame.changed_since(before));
            }
            before = Some(frame);
        }
        println!(
            "  {name}: at most {:.2} % of the ink changes in a frame of a slow zoom",
            100.0 * worst
        );
        report.check(worst <= 0.02, || format!("{name}: {:.2} % changes", 100.0 * worst));
    }
}

/// Largest of the 24 frames' median drifts since the first.
fn drift(frame: impl Fn(f32) -> Frame) -> f64 {
    let first = frame(0.0);
    (1_u8..=24).map(|i| frame(f32::from(i)).drift_since(&first)).fold(0.0, f64::max)
}

fn drifts(report: &mut Report) {
    let view = subjects::front(384);
    let cylinder = subjects::standing("cylinder");
    let turning = |style: &Style| {
        drift(|i| Frame::draw(&cylinder, &subjects::turned(&cylinder, i), style, &view))
    };
    let skin = subjects::skinned();
    let bending =
        |style: &Style| drift(|i| Frame::draw(&skin, &subjects::bent(&skin, i), style, &view));
    let hero = model("hero");
    let clip = hero.clips.iter().position(|clip| clip.name == "walk").unwrap_or(0);
    let orbit = Orbit { azimuth_deg: 30.0, zoom: 1.6, ..Orbit::default() };
    let hero_view = genga::render::View { supersample: 1, ..orbit_view(&hero, &orbit, [384, 512]) };
    let walking = |style: &Style| {
        let pose = |i: f32| Pose::at(&hero, clip, i / 24.0);
        drift(|i| Frame::draw(&hero, &pose(i), style, &hero_view))
    };
    let surface = sparse("");
    let screen = sparse("mapping = \"screen\"");
    for (name, on_surface, on_screen) in [
        ("turning by 1°", turning(&surface), turning(&screen)),
        ("bending skin", bending(&surface), bending(&screen)),
        ("walking hero", walking(&surface), walking(&screen)),
    ] {
        println!(
            "  {name}: strokes drift by {on_surface:.2} px in 24 frames, with `screen` by {on_screen:.2} px"
        );
        report.check(on_surface <= 1.0, || format!("{name}: {on_surface} px of drift"));
        report.check(on_screen > 1.0, || format!("{name}: `screen` does not drift"));
    }
}

fn bodies(report: &mut Report) {
    for name in subjects::BODIES {
        let scene = subjects::standing(name);
        let frame = Frame::draw(&scene, &Pose::rest(&scene), &hand(""), &subjects::front(512));
        let (within, all) =
            directions::within_30_degrees(&frame, |hit, _| subjects::round(&frame, hit));
        println!("  {name}: {:.1} % of {all} pixels within 30°", 100.0 * within);
        report.check(within >= 0.95, || format!("{name}: {:.1} % within 30°", 100.0 * within));
    }
}

/// The hero's arms and legs: strokes run across their bones.
fn limbs(report: &mut Report) {
    let scene = model("hero");
    let pose = Pose::rest(&scene);
    let style = hand("direction = \"bone\"");
    let (mut within, mut all) = (0.0, 0);
    for azimuth_deg in [0.0, 90.0, 180.0, 270.0] {
        let orbit = Orbit { azimuth_deg, zoom: 1.6, ..Orbit::default() };
        let view = orbit_view(&scene, &orbit, [640, 800]);
        let view = genga::render::View { supersample: 1, ..view };
        let frame = Frame::draw(&scene, &pose, &style, &view);
        let wanted = |hit: Hit, _| limb_direction(&scene, &pose, frame.posed(), hit);
        let (part, count) = directions::within_30_degrees(&frame, wanted);
        within += part * count as f64;
        all += count;
    }
    let within = within / all.max(1) as f64;
    println!("  hero's limbs: {:.1} % of {all} pixels within 30°", 100.0 * within);
    report.check(all > 5000 && within >= 0.95, || {
        format!("hero's limbs: {:.1} % of {all} pixels within 30°", 100.0 * within)
    });
}

/// Across the bone and on the surface, where one bone of a limb moves all of a triangle.
fn limb_direction(scene: &Scene, pose: &Pose, posed: &Posed, hit: Hit) -> Option<DVec3> {
    let (node, primitive, corners) = posed.sources[hit.triangle];
    let skin = &scene.skins[scene.nodes[node].skin?];
    let primitive = &scene.meshes[scene.nodes[node].mesh?].primitives[primitive];
    let strongest = |v: usize| {
        let slot = (0..4).find(|&i| primitive.weights[v][i] > 0.9)?;
        Some(usize::from(primitive.joints[v][slot]))
    };
    let joint = strongest(corners[0])?;
    if corners.iter().any(|&v| strongest(v) != Some(joint)) {
        return None;
    }
    let bone = skin.joints[joint];
    let name = scene.nodes[bone].name.as_str();
    if !["UpperArm", "LowerArm", "UpperLeg", "LowerLeg"].iter().any(|limb| name.ends_with(limb)) {
        return None;
    }
    let child = *scene.nodes[bone].children.first()?;
    let place = |node: usize| Vec3::from(pose.world_from_node[node].translation).as_dvec3();
    let [a, b, c] = posed.triangles[hit.triangle];
    (place(child) - place(bone)).cross((b - a).cross(c - a)).try_normalize()
}
