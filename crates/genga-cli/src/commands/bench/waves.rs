//! Energy waves: the exact method beside Abe's own (2024, tables 4.4 and 4.5).

use genga::render::{LayerData, LayerKind, Prepared, View, ViewCamera, Workload};
use genga::scene::{Pose, Projection, Scene, Wave, WaveMethod, WaveShape};
use genga::style::{LineMethod, Style};
use glam::{Affine3A, Vec3};
use serde::Serialize;

use super::sample::Samples;
use crate::args::BenchArgs;
use crate::console::Console;
use crate::failure::Outcome;
use crate::gpu::Graphics;
use crate::text::table;

/// Sides of the square pictures, as in the paper's tables.
const SIDES: [u32; 3] = [512, 1024, 2048];
/// Milliseconds after which a measurement has enough runs.
const ENOUGH_MS: f64 = 2000.0;
/// Side of the pictures whose errors are taken.
const ERROR_SIDE: u32 = 512;
/// Metres from the curve within which it glows.
const RADIUS: f32 = 0.5;
/// Metres. Otherwise the core is the thinnest that the model has, half a pixel: nearest to the
/// paper's density, which has none.
const WIDE_CORE: f32 = 0.02;

/// Times of the waves' passes alone.
#[derive(Debug, Serialize)]
pub(super) struct WaveReport {
    /// `gpu` (timestamp queries) or `wall` (software drivers: they do not time compute passes).
    clock: &'static str,
    rows: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Row {
    curve: String,
    width: u32,
    height: u32,
    waves: usize,
    method: String,
    runs: usize,
    median_ms: f64,
    /// The time over that of the exact method in the same picture.
    ratio: f64,
    /// The largest error relative to the energy (at least 1/255 of the brightest), against the exact
    /// method at its finest tolerance, at 512 × 512.
    max_error: Option<f64>,
    /// What 99 of 100 pixels have at most.
    p99_error: Option<f64>,
}

/// Measures everything, or only pictures of the size and the curve that are asked for.
pub(super) fn measure(
    args: &BenchArgs,
    graphics: &Graphics,
    console: &Console,
) -> Outcome<WaveReport> {
    let clock = if graphics.gpu.is_software() { "wall" } else { "gpu" };
    let (runs, size) = (args.runs as usize, args.size);
    let mut bench = Bench { graphics, console, runs, clock, rows: Vec::new() };
    let sizes = size.map_or_else(|| SIDES.map(|side| [side; 2]).to_vec(), |size| vec![size]);
    let middle = size.unwrap_or([1024; 2]);
    let simpson = |points, thinning| WaveMethod::Simpson { points, thinning, de_boor: false };
    let is_asked = |name| args.curve.as_deref().is_none_or(|curve| curve == name);
    for (name, shape) in curves().into_iter().filter(|(name, _)| is_asked(*name)) {
        let wave = [wave(shape)];
        for &size in &sizes {
            let mut methods = vec![simpson(100, 1), simpson(300, 1), simpson(500, 1)];
            // The paper's table 4.5.
            if size[0] == 2048 && ["helix", "b-spline"].contains(&name) {
                methods.extend([simpson(500, 2), simpson(500, 4)]);
            }
            if name == "b-spline" {
                methods.push(WaveMethod::Simpson { points: 500, thinning: 1, de_boor: true });
            }
            bench.compare(name, &wave, size, &methods)?;
            // Wide enough for the reference to resolve.
            let wide = [Wave { core: WIDE_CORE, ..wave[0].clone() }];
            bench.compare(&format!("{name}, core 2 cm"), &wide, size, &[simpson(500, 1)])?;
        }
    }
    if args.curve.is_some() {
        return Ok(WaveReport { clock, rows: bench.rows });
    }
    for count in [1, 10, 100] {
        bench.compare("volley of helices", &volley(count), middle, &[])?;
    }
    for points in [4, 16, 64] {
        let name = format!("b-spline, {points} points");
        bench.compare(&name, &[wave(spline(points))], middle, &[])?;
    }
    let unlimited = Wave { radius: None, ..wave(helix()) };
    bench.compare("helix without a radius", &[unlimited], middle, &[simpson(500, 1)])?;
    Ok(WaveReport { clock, rows: bench.rows })
}

fn helix() -> WaveShape {
    WaveShape::Helix { length: 4.0, radius: 0.5, turns: 5.0, phase: 0.3 }
}

/// A B-spline of order 4 whose x is in proportion to s, so that the reference need not solve for s.
fn spline(count: usize) -> WaveShape {
    let spans = (count - 3) as f32;
    let points = (0..count).map(|i| {
        // Greville's abscissae: means of three knots in a row.
        let knot = |k: usize| ((i + k) as f32 - 3.0).clamp(0.0, spans);
        let x = (knot(1) + knot(2) + knot(3)) / (3.0 * spans) * 4.0;
        // It begins and ends on the axis, which is then its direction.
        let (t, end, part) = (3.25 * x, 13.0_f32, x / 4.0);
        let y = (1.3 * t).sin() - part * (1.3 * end).sin();
        let z = (0.9 * t).cos() - 1.0 - part * ((0.9 * end).cos() - 1.0);
        Vec3::new(x, 0.7 * y, 0.6 * z)
    });
    WaveShape::BSpline { points: points.collect(), order: 4, knots: Vec::new() }
}

/// The paper's four curves, about as it shows them.
fn curves() -> [(&'static str, WaveShape); 4] {
    let trig = WaveShape::Trig {
        length: 4.0,
        turns: 2.0,
        y: vec![[0.3, 0.1], [0.1, 0.05]],
        z: vec![[0.1, 0.3], [0.0, 0.1], [0.05, 0.0]],
    };
    let points =
        [[0.0, 0.0, 0.0], [1.0, 1.5, 0.2], [2.0, -1.5, 0.8], [3.0, 1.0, -1.0], [4.0, 0.0, 0.0]];
    let bezier = WaveShape::Bezier { points: points.map(Vec3::from).to_vec() };
    [("helix", helix()), ("trig", trig), ("bezier", bezier), ("b-spline", spline(12))]
}

fn wave(shape: WaveShape) -> Wave {
    Wave { shape, core: 0.0, radius: Some(RADIUS), reach: 12.0, ..Wave::default() }
}

/// Helices that fan out.
fn volley(count: usize) -> Vec<Wave> {
    (0..count)
        .map(|i| {
            let angle = 2.4 * i as f32;
            let spread = 0.6 * (i as f32 / count as f32).sqrt();
            let placement = genga::scene::WavePlacement::At {
                anchor: Default::default(),
                direction: Vec3::new(1.0, spread * angle.sin(), spread * angle.cos()),
                follow: false,
                roll: angle,
            };
            let shape = WaveShape::Helix { length: 4.0, radius: 0.1, turns: 4.0, phase: 0.0 };
            Wave { placement, radius: Some(0.2), ..wave(shape) }
        })
        .collect()
}

fn view(size: [u32; 2]) -> View {
    let (eye, at) = (Vec3::new(1.2, 1.0, 5.5), Vec3::new(2.0, 0.0, 0.0));
    let camera = ViewCamera {
        world_from_camera: Affine3A::look_at_rh(eye, at, Vec3::Y).inverse(),
        projection: Projection::Perspective { fov_y: 0.8 },
        near: 0.1,
    };
    View { supersample: 1, ..View::new(camera, size) }
}

struct Bench<'a> {
    graphics: &'a Graphics,
    console: &'a Console,
    runs: usize,
    clock: &'static str,
    rows: Vec<Row>,
}

impl Bench<'_> {
    /// Rows for the exact method and for others, in one picture.
    fn compare(
        &mut self,
        curve: &str,
        waves: &[Wave],
        size: [u32; 2],
        methods: &[WaveMethod],
    ) -> Outcome {
        let mut style = Style::default();
        style.lines.method = LineMethod::None;
        let scene = Scene { name: curve.to_owned(), waves: waves.to_vec(), ..Scene::default() };
        let mut prepared = self.graphics.prepare(&scene, &style, self.console)?;
        let pose = Pose::rest(&scene);
        let has_errors = size == [ERROR_SIDE; 2] && waves.len() == 1;
        let finest: Vec<Wave> =
            waves.iter().map(|wave| Wave { tolerance: 1e-4, ..wave.clone() }).collect();
        let wanted = match has_errors {
            true => Some(self.energies(&mut prepared, &finest, WaveMethod::Exact, &pose, size)?),
            false => None,
        };
        let mut exact_ms = 0.0;
        for &method in [WaveMethod::Exact].iter().chain(methods) {
            let errors = match &wanted {
                Some(wanted) => {
                    let got = self.energies(&mut prepared, waves, method, &pose, size)?;
                    Some(errors(&got, wanted))
                }
                None => None,
            };
            let set = self.graphics.renderer.set_waves(&mut prepared, waves, method, &pose);
            self.graphics.check(curve, set)?;
            let (median_ms, runs) = self.time(curve, &prepared, size)?;
            if method == WaveMethod::Exact {
                exact_ms = median_ms;
            }
            self.rows.push(Row {
                curve: curve.to_owned(),
                width: size[0],
                height: size[1],
                waves: waves.len(),
                method: match method {
                    WaveMethod::Exact => "exact".to_owned(),
                    WaveMethod::Simpson { points, de_boor: true, .. } => {
                        format!("m = {points}, de Boor")
                    }
                    WaveMethod::Simpson { points, thinning: 1, .. } => format!("m = {points}"),
                    WaveMethod::Simpson { points, thinning, .. } => {
                        format!("m = {points}, n = {thinning}")
                    }
                },
                runs,
                median_ms,
                ratio: if exact_ms > 0.0 { median_ms / exact_ms } else { 0.0 },
                max_error: errors.map(|e| e[0]),
                p99_error: errors.map(|e| e[1]),
            });
        }
        Ok(())
    }

    /// The median, and how often it was measured.
    fn time(&self, curve: &str, prepared: &Prepared, size: [u32; 2]) -> Outcome<(f64, usize)> {
        let view = view(size);
        let once = || -> Outcome<f64> {
            let times = self.graphics.renderer.time_frame(prepared, &view, Workload::Waves);
            let times = self.graphics.check(curve, pollster::block_on(times))?;
            let gpu = times.gpu_ms.filter(|_| self.clock == "gpu");
            Ok(gpu.unwrap_or(times.wall_ms))
        };
        // The first one makes pipelines and targets.
        let mut spent = once()?;
        let (mut samples, mut runs) = (Samples::default(), 0);
        while runs == 0 || (runs < self.runs && spent < ENOUGH_MS) {
            let time = once()?;
            samples.push(time);
            spent += time;
            runs += 1;
        }
        Ok((samples.summary().median_ms, runs))
    }

    fn energies(
        &self,
        prepared: &mut Prepared,
        waves: &[Wave],
        method: WaveMethod,
        pose: &Pose,
        size: [u32; 2],
    ) -> Outcome<Vec<f32>> {
        let set = self.graphics.renderer.set_waves(prepared, waves, method, pose);
        self.graphics.check("waves", set)?;
        let layers = &[LayerKind::Energy];
        let step = &mut |_, _| {};
        let picture = self.graphics.picture("waves", prepared, &view(size), layers, step)?;
        Ok(match picture.layers.into_iter().next().map(|layer| layer.data) {
            Some(LayerData::F32 { values, .. }) => values,
            _ => Vec::new(),
        })
    }
}

/// The largest relative error, and what 99 of 100 pixels that glow have at most.
fn errors(got: &[f32], wanted: &[f32]) -> [f64; 2] {
    let floor = wanted.iter().copied().fold(0.0, f32::max) / 255.0;
    let glowing = got.iter().zip(wanted).filter(|(_, wanted)| **wanted > 0.0);
    let mut errors: Vec<f64> =
        glowing.map(|(a, b)| f64::from((a - b).abs() / b.max(floor))).collect();
    errors.sort_by(f64::total_cmp);
    let at = |i: usize| errors.get(i).copied().unwrap_or_default();
    [at(errors.len().saturating_sub(1)), at(errors.len() * 99 / 100)]
}

impl WaveReport {
    /// The report for people.
    pub(super) fn text(&self) -> String {
        let clock = if self.clock == "gpu" { "GPU time" } else { "wall time" };
        let titles =
            ["waves", "size", "method", "runs", "median", "of exact", "largest error", "99 %"];
        let mut rows = vec![titles.map(str::to_owned).to_vec()];
        for row in &self.rows {
            let count = if row.waves > 1 { format!("{} × ", row.waves) } else { String::new() };
            rows.push(vec![
                format!("{count}{}", row.curve),
                format!("{} × {}", row.width, row.height),
                row.method.clone(),
                row.runs.to_string(),
                format!("{:.2} ms", row.median_ms),
                format!("{:.1}", row.ratio),
                percent(row.max_error),
                percent(row.p99_error),
            ]);
        }
        format!("waves: their passes alone, {clock}\n{}", table(&rows))
    }
}

fn percent(error: Option<f64>) -> String {
    error.map_or_else(String::new, |e| format!("{:.3} %", 100.0 * e))
}
