use serde::Serialize;

use super::frames::FrameReport;
use super::import::ImportReport;
use super::lines::LinesReport;
use super::sample::Summary;
use super::waves::WaveReport;
use crate::commands::adapters::AdapterInfo;
use crate::text::{one_line, table, thousands};

/// Everything that was measured, and on what.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    genga: &'static str,
    debug_build: bool,
    adapter: AdapterInfo,
    /// Whether wgpu checks the arguments of indirect draws, which takes GPU time too.
    indirect_validation: bool,
    pub(super) frames: Vec<FrameReport>,
    pub(super) lines: Option<LinesReport>,
    pub(super) import: Vec<ImportReport>,
    pub(super) waves: Option<WaveReport>,
}

impl Report {
    pub(super) fn new(adapter: AdapterInfo) -> Self {
        let flags = wgpu::InstanceFlags::default().with_env();
        Self {
            genga: env!("CARGO_PKG_VERSION"),
            debug_build: cfg!(debug_assertions),
            adapter,
            indirect_validation: flags.contains(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL),
            frames: Vec::new(),
            lines: None,
            import: Vec::new(),
            waves: None,
        }
    }

    /// The report for people.
    pub(super) fn text(&self) -> String {
        let AdapterInfo { name, kind, driver, backend, .. } = &self.adapter;
        let validation = if self.indirect_validation { "on" } else { "off" };
        let mut text = format!(
            "{} ({kind}, {backend}, {})\nwgpu's validation of indirect draws is {validation}\n",
            one_line(name),
            one_line(driver)
        );
        for frame in &self.frames {
            text.push('\n');
            text.push_str(&frame_text(frame));
        }
        if self.frames.len() > 1 {
            text.push('\n');
            text.push_str(&overview(&self.frames));
        }
        if let Some(lines) = &self.lines {
            text.push('\n');
            text.push_str(&lines.text());
        }
        for import in &self.import {
            text.push('\n');
            text.push_str(&import_text(import));
        }
        if let Some(waves) = &self.waves {
            text.push('\n');
            text.push_str(&waves.text());
        }
        text
    }
}

fn heading(first: &str) -> Vec<String> {
    [first, "min", "median", "max"].map(str::to_owned).to_vec()
}

fn row(name: String, time: Summary) -> Vec<String> {
    let shown = |ms: f64| format!("{ms:.3} ms");
    vec![name, shown(time.min_ms), shown(time.median_ms), shown(time.max_ms)]
}

fn frame_text(frame: &FrameReport) -> String {
    let supersample = match frame.supersample {
        1 => String::new(),
        n => format!(", supersample {n}"),
    };
    let clock = if frame.clock == "gpu" { "GPU time" } else { "wall time" };
    let title = format!(
        "{}: {} triangles, {} vertices, {} × {}{supersample}, {} (lines: {}), {} runs, {clock}\n",
        one_line(&frame.workload),
        thousands(frame.triangles),
        thousands(frame.vertices),
        frame.width,
        frame.height,
        one_line(&frame.style),
        frame.line_method,
        frame.runs,
    );
    let mut rows = vec![heading("")];
    for (name, measured) in [("plain", &frame.plain), (frame.style.as_str(), &frame.styled)] {
        rows.push(row(one_line(name), measured.total));
        for pass in &measured.passes {
            rows.push(row(format!("  {}", pass.name), pass.time));
        }
    }
    let result = format!("ratio {:.3}, added {:.3} ms\n", frame.ratio, frame.added_ms);
    title + &table(&rows) + &result
}

/// One line a frame, to compare them.
fn overview(frames: &[FrameReport]) -> String {
    let titles = ["workload", "triangles", "size", "lines", "plain", "styled", "ratio", "added"];
    let mut rows = vec![titles.map(str::to_owned).to_vec()];
    for frame in frames {
        rows.push(vec![
            one_line(&frame.workload),
            thousands(frame.triangles),
            format!("{} × {}", frame.width, frame.height),
            frame.line_method.to_owned(),
            format!("{:.3} ms", frame.plain.total.median_ms),
            format!("{:.3} ms", frame.styled.total.median_ms),
            format!("{:.3}", frame.ratio),
            format!("{:.3} ms", frame.added_ms),
        ]);
    }
    table(&rows)
}

fn import_text(import: &ImportReport) -> String {
    let title = format!(
        "import: {} triangles, {} vertices, {:.1} MiB, {} runs, wall time\n",
        thousands(import.triangles),
        thousands(import.vertices),
        import.file_bytes as f64 / f64::from(1 << 20),
        import.runs,
    );
    let mut rows = vec![heading("")];
    rows.extend(import.steps.iter().map(|step| row(step.name.to_owned(), step.time)));
    let hint = if cfg!(feature = "bench-gltf") {
        ""
    } else {
        "(to compare with the gltf crate, build with --features bench-gltf)\n"
    };
    title + &table(&rows) + hint
}
