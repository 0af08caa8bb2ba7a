//! The long forms of the picture tests, with their figures: `cargo xtask verify`.
//!
//! Exits with 1 if anything is not as it must be.

mod contours;
mod hatching;
mod motion;
mod outlines;
mod scales;
mod waves;

use std::process::ExitCode;
use std::time::Instant;

use genga::render::{LayerKind, Orbit, Picture, View};
use genga::scene::Scene;
use genga::shapes;
use genga::style::Style;
use genga_tests::compare::byte_difference;
use genga_tests::edges::{Figures, cameras, measure};
use genga_tests::scenes::{model, orbit_view, style};
use genga_tests::{Pixels, Tolerance, difference, shared};

/// What was found wrong.
#[derive(Default)]
struct Report {
    faults: Vec<String>,
}

impl Report {
    fn check(&mut self, holds: bool, fault: impl FnOnce() -> String) {
        if !holds {
            let fault = fault();
            println!("  WRONG: {fault}");
            self.faults.push(fault);
        }
    }
}

/// Name and what runs.
type Part = (&'static str, fn(&mut Report));

fn main() -> ExitCode {
    let info = shared().gpu.info();
    println!("adapter: {} ({:?})", info.name, info.backend);
    let mut report = Report::default();
    let parts: [Part; 12] = [
        ("contours", contours::contours),
        ("outlines", outlines::outlines),
        ("scales", scales::scales),
        ("motion", motion::motion),
        ("edges", edges),
        ("tiles", tiles),
        ("large-picture", large_picture),
        ("large-mesh", large_mesh),
        ("highlights", highlights),
        ("highlight-cost", highlight_cost),
        ("waves", waves::run),
        ("hatching", hatching::run),
    ];
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    if let Some(unknown) = wanted.iter().find(|w| parts.iter().all(|(name, _)| name != w)) {
        let names = parts.map(|(name, _)| name).join(", ");
        eprintln!("there is no part '{unknown}': name some of {names}, or none for all");
        return ExitCode::FAILURE;
    }
    for (name, part) in parts {
        if wanted.is_empty() || wanted.iter().any(|w| w == name) {
            let start = Instant::now();
            println!("\n{name}");
            part(&mut report);
            println!("  {:.1} s", start.elapsed().as_secs_f64());
        }
    }
    if report.faults.is_empty() {
        println!("\nall as it must be");
        return ExitCode::SUCCESS;
    }
    println!("\n{} wrong:", report.faults.len());
    report.faults.iter().for_each(|fault| println!("  {fault}"));
    ExitCode::FAILURE
}

/// Lines of the paper's method on edges: 20 cameras, several widths.
fn edges(report: &mut Report) {
    println!("  model, width: inked, astray, farthest px, hidden, places, covered %");
    for name in ["cube-before-plane", "teapot-on-box"] {
        let scene = model(name);
        for width in [1.0, 2.0, 4.0, 8.0] {
            let views = cameras(&scene, 20, [480, 360]);
            let figures = views.iter().map(|view| measure(&scene, "reference", width, view));
            let all = figures.fold(Figures::default(), Figures::and);
            println!(
                "  {name}, {width}: {}, {}, {:.2}, {}, {}, {:.2}",
                all.inked,
                all.astray,
                all.farthest_px,
                all.hidden,
                all.places,
                100.0 * all.coverage()
            );
            // The paper's method draws every edge that crosses the mask, which on dense meshes is
            // wider than a thin line: what is astray is a figure to report, not a fault.
            report.check(all.coverage() > 0.98, || {
                format!(
                    "{name}, width {width}: {:.2} % of the edges are drawn",
                    100.0 * all.coverage()
                )
            });
        }
    }
}

fn drawn(scene: &Scene, style: &Style, view: &View, max_texels: u32) -> Picture {
    let renderer = &shared().renderer;
    let prepared = renderer.prepare(scene, style).expect("the scene can be prepared");
    let layers = [LayerKind::Lines, LayerKind::Ids];
    let progress = &mut |_, _| {};
    let picture = renderer.picture_in_tiles(&prepared, view, &layers, max_texels, progress);
    pollster::block_on(picture).expect("the picture can be drawn")
}

/// The same picture in tiles of 50 random sizes, with all methods in turn.
fn tiles(report: &mut Report) {
    let scene = model("teapot-on-box");
    let mut state = 12_345_u32;
    let mut random = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % below
    };
    let methods = ["contour", "reference", "hull", "rim", "image"];
    let mut worst = 0;
    let mut pictures_off = [0; 5];
    for run in 0..50 {
        let method = methods[run % methods.len()];
        let style = style(&format!(
            "extends = \"american-comic\"\n[lines]\nmethod = \"{method}\"\nreference_height = 400"
        ));
        let orbit = Orbit {
            azimuth_deg: random(360) as f32,
            elevation_deg: random(60) as f32,
            zoom: 1.0 + random(3) as f32,
            orthographic: random(3) == 0,
            ..Orbit::default()
        };
        let size = [301 + random(200), 251 + random(200)];
        let supersample = 1 + random(3);
        let max_texels = (160 + random(150)) * supersample;
        let view = View { supersample, ..orbit_view(&scene, &orbit, size) };
        let whole = drawn(&scene, &style, &view, 4096);
        let tiled = drawn(&scene, &style, &view, max_texels);
        let same = Tolerance::same_picture();
        let found = [
            difference(&whole, &tiled, same),
            byte_difference(
                whole.width,
                whole.bytes(LayerKind::Lines),
                tiled.bytes(LayerKind::Lines),
                same,
            ),
        ];
        for found in found {
            worst = worst.max(found.worst);
            pictures_off[run % methods.len()] += usize::from(found.is_too_much);
            // The paper's mask has hard thresholds, where rounding can decide.
            let allowed = if method == "reference" { 4 } else { 0 };
            report.check(found.outliers <= allowed, || {
                format!("{method}, {size:?}, {supersample} texels, tiles of {max_texels}, {orbit:?}: {found:?}")
            });
        }
    }
    println!("  50 pictures, largest difference {worst}/255");
    for (method, off) in methods.iter().zip(pictures_off) {
        println!("  {method}: {off} pictures or line layers with single pixels over 1/255");
    }
}

/// The largest picture that there is, compared with a small one of the same view.
fn large_picture(report: &mut Report) {
    let scene = model("cube-before-plane");
    let style = Style::preset("american-comic").expect("a preset");
    let orbit = Orbit::default();
    let side = genga::render::MAX_PICTURE_SIDE;
    let view = View { supersample: 1, ..orbit_view(&scene, &orbit, [side, side]) };
    let renderer = &shared().renderer;
    let prepared = renderer.prepare(&scene, &style).expect("the scene can be prepared");
    let start = Instant::now();
    let mut tiles = 0;
    let progress = &mut |_, all| tiles = all;
    let large = match pollster::block_on(renderer.picture(&prepared, &view, &[], progress)) {
        Ok(large) => large,
        Err(error) => return report.check(false, || format!("{side}×{side} pixels: {error}")),
    };
    let seconds = start.elapsed().as_secs_f64();
    println!("  {side}×{side} pixels in {tiles} tiles: {seconds:.1} s");
    // Means of 64×64 pixels are the picture at a 64th of its size.
    let small_side = side / 64;
    let small = View { size: [small_side; 2], supersample: 4, ..view };
    let small = pollster::block_on(renderer.picture(&prepared, &small, &[], &mut |_, _| {}))
        .expect("a small picture can be drawn");
    let mut off = 0;
    for (x, y) in small.places() {
        let mut sums = [0_u64; 3];
        for row in 64 * y..64 * y + 64 {
            for column in 64 * x..64 * x + 64 {
                let at = large.at(column, row);
                (0..3).for_each(|c| sums[c] += u64::from(at[c]));
            }
        }
        let mean = sums.map(|sum| (sum / 4096) as u8);
        let at = small.at(x, y);
        off += usize::from((0..3).any(|c| mean[c].abs_diff(at[c]) > 48));
    }
    println!("  pixels that differ from the small picture by more than 48/255: {off}");
    // Thin lines are antialiased differently when they are less than a pixel wide.
    report.check(off * 100 < (small_side * small_side) as usize, || {
        format!("{off} pixels of the large picture are not those of the small one")
    });
}

/// Ten million triangles, five million vertices.
fn large_mesh(report: &mut Report) {
    let start = Instant::now();
    let object = shapes::smooth_object(10_000_000).expect("an even number");
    let scene = shapes::scene_of("object", object);
    println!("  made {} vertices: {:.1} s", scene.vertex_count(), start.elapsed().as_secs_f64());
    let style = style("[lines]\nreference_height = 512");
    let renderer = &shared().renderer;
    let start = Instant::now();
    let prepared = match renderer.prepare(&scene, &style) {
        Ok(prepared) => prepared,
        Err(error) => return report.check(false, || format!("10 million triangles: {error}")),
    };
    println!("  prepared: {:.1} s", start.elapsed().as_secs_f64());
    let view = orbit_view(&scene, &Orbit::default(), [512, 512]);
    let start = Instant::now();
    let picture = pollster::block_on(renderer.picture(
        &prepared,
        &view,
        &[LayerKind::Lines, LayerKind::Ids],
        &mut |_, _| {},
    ));
    let picture = match picture {
        Ok(picture) => picture,
        Err(error) => return report.check(false, || format!("10 million triangles: {error}")),
    };
    println!("  drawn: {:.1} s", start.elapsed().as_secs_f64());
    // The same object with fewer triangles looks the same.
    let few = shapes::smooth_object(100_000).expect("an even number");
    let few = drawn(&shapes::scene_of("object", few), &style, &view, 4096);
    let inked = picture.places().filter(|&(x, y)| picture.ink(x, y) > 128).count();
    let seen = picture.places().filter(|&(x, y)| picture.ids(x, y)[0] == 1).count();
    let few_seen = few.places().filter(|&(x, y)| few.ids(x, y)[0] == 1).count();
    println!("  {seen} pixels of surface ({few_seen} with 100,000 triangles), {inked} of ink");
    report.check(seen > 50_000 && seen.abs_diff(few_seen) < seen / 200, || {
        format!("the object covers {seen} pixels, with fewer triangles {few_seen}")
    });
    report.check((2000..40_000).contains(&inked), || format!("{inked} pixels of ink"));
    let off =
        picture.places().filter(|&(x, y)| picture.ink(x, y).abs_diff(few.ink(x, y)) > 128).count();
    println!("  pixels of ink that 100,000 triangles have elsewhere: {off}");
    report.check(5 * off < inked, || format!("{off} of {inked} pixels of ink are elsewhere"));
}

/// Where highlights stand, and what shape they have.
fn highlights(report: &mut Report) {
    genga_tests::highlight_proofs::places(&mut |holds, fault| report.check(holds, || fault));
}

/// What highlights cost.
fn highlight_cost(report: &mut Report) {
    genga_tests::highlight_proofs::cost(&mut |holds, fault| report.check(holds, || fault));
}
