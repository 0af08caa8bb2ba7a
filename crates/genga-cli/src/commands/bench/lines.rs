use genga::render::{Orbit, Prepared, View, ViewCamera, Workload};
use genga::scene::Pose;
use genga::shapes;
use genga::style::{DetectScale, LineMethod, Style};
use serde::Serialize;

use super::sample::{Samples, Summary};
use crate::args::BenchArgs;
use crate::console::Console;
use crate::failure::{Failure, Outcome};
use crate::gpu::Graphics;
use crate::style_choice;
use crate::text::{one_line, table, thousands};

/// Triangles of the grid (Okuya et al. 2015, table 3, and one more).
const TRIANGLES: [usize; 4] = [960, 9_566, 66_400, 300_000];
/// Sizes of the grid.
const SIZES: [[u32; 2]; 3] = [[640, 360], [1280, 720], [1920, 1080]];
/// Triangles of the paper's table 4.
const SCALED_TRIANGLES: usize = 66_440;
/// Its detection scales, with their names in styles.
const SCALES: [(DetectScale, &str); 4] = [
    (DetectScale::Full, "1"),
    (DetectScale::TwoThirds, "2/3"),
    (DetectScale::Third, "1/3"),
    (DetectScale::Sixth, "1/6"),
];
/// Passes that a picture without lines has, too.
const NOT_LINES: [&str; 3] = ["deform", "paint", "composite"];
/// Frames of each method that are drawn before those that count.
const WARM_UP: usize = 3;

/// What lines cost, by the paper's method and by ours, taken by turns.
#[derive(Debug, Serialize)]
pub(super) struct LinesReport {
    pub(super) style: String,
    pub(super) runs: usize,
    /// By triangles and size, detection at full size.
    pub(super) grid: Vec<LineCost>,
    /// By scale of detection.
    pub(super) scales: Vec<LineCost>,
}

#[derive(Debug, Serialize)]
pub(super) struct LineCost {
    pub(super) triangles: usize,
    pub(super) width: u32,
    pub(super) height: u32,
    /// Of detection.
    pub(super) scale: &'static str,
    /// GPU time of the frame without that of deform, paint and composite.
    pub(super) reference: Summary,
    pub(super) contour: Summary,
    /// Median of `reference` over that of `contour`.
    pub(super) ratio: f64,
}

/// One place of the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    triangles: usize,
    size: [u32; 2],
    scale: (DetectScale, &'static str),
}

/// Every place of both tables; the grid's come first.
pub(super) fn cells(args: &BenchArgs) -> Vec<Cell> {
    let sizes = args.size.map_or(SIZES.to_vec(), |size| vec![size]);
    let grid = TRIANGLES.into_iter().flat_map(|triangles| {
        sizes.iter().map(move |&size| Cell { triangles, size, scale: SCALES[0] })
    });
    let size = args.size.unwrap_or([1920, 1080]);
    let scales = SCALES.map(|scale| Cell { triangles: SCALED_TRIANGLES, size, scale });
    grid.chain(scales).collect()
}

/// An empty report for that style.
pub(super) fn report(args: &BenchArgs) -> Outcome<LinesReport> {
    let style = style_choice::find(args.style.as_deref().unwrap_or(style_choice::DEFAULT))?.name;
    let runs = args.runs as usize;
    Ok(LinesReport { style, runs, grid: Vec::new(), scales: Vec::new() })
}

/// Times one place.
pub(super) fn measure(
    cell: Cell,
    args: &BenchArgs,
    graphics: &Graphics,
    console: &Console,
    step: &mut dyn FnMut(usize),
) -> Outcome<LineCost> {
    let style = style_choice::find(args.style.as_deref().unwrap_or(style_choice::DEFAULT))?.style;
    let primitive = shapes::smooth_object(cell.triangles).map_err(Failure::message)?;
    let scene = shapes::scene_of("smooth object", primitive);
    let Some(bounds) = scene.bounds(&Pose::rest(&scene)) else {
        return Err(Failure::Message("lines: there is nothing to draw".to_owned()));
    };
    let aspect = cell.size[0] as f32 / cell.size[1] as f32;
    let view = View {
        supersample: args.supersample,
        ..View::new(ViewCamera::orbit(&bounds, &Orbit::default(), aspect), cell.size)
    };
    let prepared = |method| {
        let mut style: Style = style.clone();
        style.lines.method = method;
        style.lines.detect.scale = cell.scale.0;
        graphics.prepare(&scene, &style, console)
    };
    let frames = [prepared(LineMethod::Reference)?, prepared(LineMethod::Contour)?];
    let mut samples = [Samples::default(), Samples::default()];
    for run in 0..WARM_UP + args.runs as usize {
        // Each goes first as often as the other, since clocks and caches drift.
        for method in if run % 2 == 0 { [0, 1] } else { [1, 0] } {
            let milliseconds = line_ms(&frames[method], &view, graphics)?;
            if run >= WARM_UP {
                samples[method].push(milliseconds);
            }
        }
        step((run + 1).saturating_sub(WARM_UP));
    }
    let [reference, contour] = samples.map(|samples| samples.summary());
    Ok(LineCost {
        triangles: cell.triangles,
        width: cell.size[0],
        height: cell.size[1],
        scale: cell.scale.1,
        reference,
        contour,
        ratio: quotient(reference.median_ms, contour.median_ms),
    })
}

/// GPU time that lines take in a frame: from its first pass's beginning to its last one's end, less
/// the passes that are not the lines'. The lines' own passes need not add up: some drivers run
/// compute beside other passes, where timestamps do not see it.
fn line_ms(prepared: &Prepared, view: &View, graphics: &Graphics) -> Outcome<f64> {
    let times = graphics.renderer.time_frame(prepared, view, Workload::Styled);
    let times = graphics.check("lines", pollster::block_on(times))?;
    let Some(whole) = times.gpu_ms else {
        return Err(Failure::Message(
            "lines: this adapter measures no GPU time: choose another one with --adapter"
                .to_owned(),
        ));
    };
    let others = times.passes.iter().filter(|pass| NOT_LINES.contains(&pass.name));
    Ok(whole - others.map(|pass| pass.milliseconds).sum::<f64>())
}

impl LinesReport {
    /// Puts a result into its table.
    pub(super) fn push(&mut self, cost: LineCost) {
        let table =
            if cost.triangles == SCALED_TRIANGLES { &mut self.scales } else { &mut self.grid };
        table.push(cost);
    }

    /// The tables for people.
    pub(super) fn text(&self) -> String {
        let mut text = format!(
            "lines: smooth object, {}, {} runs, medians of the frame's GPU time without {}\n",
            one_line(&self.style),
            self.runs,
            NOT_LINES.join(", ")
        );
        text.push_str(&self.grid_text());
        if !self.scales.is_empty() {
            text.push_str(&format!(
                "\ndetection on a smaller picture, {} triangles\n",
                thousands(SCALED_TRIANGLES)
            ));
            text.push_str(&self.scales_text());
        }
        text
    }

    fn grid_text(&self) -> String {
        let least = TRIANGLES[0];
        let titles = [
            "triangles",
            "size",
            "reference",
            "contour",
            "reference/contour",
            "reference to 960's",
            "contour to 960's",
        ];
        let mut rows = vec![titles.map(str::to_owned).to_vec()];
        for cost in &self.grid {
            let first = self.grid.iter().find(|other| {
                other.triangles == least && (other.width, other.height) == (cost.width, cost.height)
            });
            let growth = |median: fn(&LineCost) -> f64| {
                first.map_or(String::new(), |first| {
                    format!("{:.2}", quotient(median(cost), median(first)))
                })
            };
            rows.push(vec![
                thousands(cost.triangles),
                format!("{} × {}", cost.width, cost.height),
                format!("{:.3} ms", cost.reference.median_ms),
                format!("{:.3} ms", cost.contour.median_ms),
                format!("{:.2}", cost.ratio),
                growth(|cost| cost.reference.median_ms),
                growth(|cost| cost.contour.median_ms),
            ]);
        }
        table(&rows)
    }

    fn scales_text(&self) -> String {
        let titles = ["scale", "size", "reference", "contour", "reference/contour"];
        let mut rows = vec![titles.map(str::to_owned).to_vec()];
        for cost in &self.scales {
            rows.push(vec![
                cost.scale.to_owned(),
                format!("{} × {}", cost.width, cost.height),
                format!("{:.3} ms", cost.reference.median_ms),
                format!("{:.3} ms", cost.contour.median_ms),
                format!("{:.2}", cost.ratio),
            ]);
        }
        table(&rows)
    }
}

fn quotient(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(triangles: usize, reference: f64, contour: f64) -> LineCost {
        let summary = |ms| Summary { min_ms: ms, median_ms: ms, max_ms: ms };
        LineCost {
            triangles,
            width: 640,
            height: 360,
            scale: "1",
            reference: summary(reference),
            contour: summary(contour),
            ratio: quotient(reference, contour),
        }
    }

    #[test]
    fn growth_is_against_the_fewest_triangles_of_the_same_size() {
        let mut report = LinesReport {
            style: "anime".to_owned(),
            runs: 5,
            grid: Vec::new(),
            scales: Vec::new(),
        };
        report.push(cost(960, 4.0, 2.0));
        report.push(cost(66_400, 12.0, 3.0));
        report.push(cost(SCALED_TRIANGLES, 9.0, 3.0));
        assert_eq!((report.grid.len(), report.scales.len()), (2, 1));
        let text = report.text();
        let row = text.lines().find(|line| line.starts_with("66,400")).expect("a row");
        let cells: Vec<_> =
            row.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
        assert_eq!(cells[2..7], ["12.000 ms", "3.000 ms", "4.00", "3.00", "1.50"]);
    }
}
