use genga::render::{FrameTimes, Workload};
use serde::Serialize;

use super::sample::{Samples, Summary};
use super::workload::{Case, method_name};
use crate::console::Console;
use crate::failure::Outcome;
use crate::gpu::Graphics;

/// Frames of each kind that are drawn before those that count.
const WARM_UP: usize = 5;

/// How long one frame takes, and how long the plain one.
#[derive(Debug, Serialize)]
pub(super) struct FrameReport {
    pub(super) workload: String,
    pub(super) style: String,
    pub(super) line_method: &'static str,
    pub(super) triangles: usize,
    pub(super) vertices: usize,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) supersample: u32,
    pub(super) runs: usize,
    /// `gpu` (timestamp queries) or `wall` (where there are none).
    pub(super) clock: &'static str,
    pub(super) plain: Measured,
    pub(super) styled: Measured,
    /// Median of the styled frame over that of the plain one.
    pub(super) ratio: f64,
    /// Median of the styled frame less that of the plain one.
    pub(super) added_ms: f64,
}

/// Times of a frame and of its passes.
#[derive(Debug, Serialize)]
pub(super) struct Measured {
    pub(super) total: Summary,
    pub(super) passes: Vec<PassReport>,
}

#[derive(Debug, Serialize)]
pub(super) struct PassReport {
    pub(super) name: &'static str,
    #[serde(flatten)]
    pub(super) time: Summary,
}

/// Draws the styled and the plain frame by turns and reports both.
pub(super) fn measure(
    case: &Case,
    runs: usize,
    graphics: &Graphics,
    console: &Console,
    step: &mut dyn FnMut(usize),
) -> Outcome<FrameReport> {
    let prepared = graphics.prepare(&case.scene, &case.style, console)?;
    let time = |workload| {
        let times =
            pollster::block_on(graphics.renderer.time_frame(&prepared, &case.view, workload));
        graphics.check(&case.workload, times)
    };
    for _ in 0..WARM_UP {
        time(Workload::Plain)?;
        time(Workload::Styled)?;
    }
    let (mut plain, mut styled) = (Collected::default(), Collected::default());
    for run in 0..runs {
        // Each goes first as often as the other, since clocks and caches drift.
        let first_plain = run % 2 == 0;
        if first_plain {
            plain.add(&time(Workload::Plain)?);
        }
        styled.add(&time(Workload::Styled)?);
        if !first_plain {
            plain.add(&time(Workload::Plain)?);
        }
        step(run + 1);
    }
    let on_gpu = plain.on_gpu && styled.on_gpu;
    let (plain, styled) = (plain.report(on_gpu), styled.report(on_gpu));
    let (base, full) = (plain.total.median_ms, styled.total.median_ms);
    Ok(FrameReport {
        workload: case.workload.clone(),
        style: case.style_name.clone(),
        line_method: method_name(case.style.lines.method),
        triangles: case.scene.triangle_count(),
        vertices: case.scene.vertex_count(),
        width: case.view.size[0],
        height: case.view.size[1],
        supersample: case.view.supersample,
        runs,
        clock: if on_gpu { "gpu" } else { "wall" },
        ratio: if base > 0.0 { full / base } else { 0.0 },
        added_ms: full - base,
        plain,
        styled,
    })
}

/// Times of one kind of frame.
struct Collected {
    gpu: Samples,
    wall: Samples,
    passes: Vec<(&'static str, Samples)>,
    on_gpu: bool,
}

impl Default for Collected {
    fn default() -> Self {
        let (gpu, wall) = (Samples::default(), Samples::default());
        Self { gpu, wall, passes: Vec::new(), on_gpu: true }
    }
}

impl Collected {
    fn add(&mut self, times: &FrameTimes) {
        self.wall.push(times.wall_ms);
        match times.gpu_ms {
            Some(milliseconds) => self.gpu.push(milliseconds),
            None => self.on_gpu = false,
        }
        for (i, pass) in times.passes.iter().enumerate() {
            // A frame has the same passes in every run.
            match self.passes.get_mut(i) {
                Some((name, samples)) if *name == pass.name => samples.push(pass.milliseconds),
                Some(_) => {}
                None => {
                    let mut samples = Samples::default();
                    samples.push(pass.milliseconds);
                    self.passes.push((pass.name, samples));
                }
            }
        }
    }

    fn report(self, on_gpu: bool) -> Measured {
        let passes = self.passes.into_iter();
        Measured {
            total: if on_gpu { self.gpu.summary() } else { self.wall.summary() },
            passes: passes.map(|(name, s)| PassReport { name, time: s.summary() }).collect(),
        }
    }
}
