//! `genga bench`: GPU time of each pass, against a plain picture of the same geometry.

mod frames;
mod import;
mod lines;
mod report;
mod sample;
mod waves;
mod workload;

use std::time::Duration;

use crate::args::BenchArgs;
use crate::commands::adapters::AdapterInfo;
use crate::console::{self, Console};
use crate::failure::{Failure, Outcome};
use crate::gpu::Graphics;
use report::Report;
use workload::Job;

/// Measures each workload and prints the report.
pub(crate) fn run(args: &BenchArgs, console: &Console) -> Outcome {
    let jobs = workload::jobs(args, console)?;
    let graphics = Graphics::open(args.adapter.as_deref(), true, console)?;
    if cfg!(debug_assertions) {
        console.warning(
            "this is a debug build: only GPU times mean something; build with --release for the rest",
        );
    }
    let mut report = Report::new(AdapterInfo::of(&graphics.gpu.adapter));
    let runs = args.runs as usize;
    let mut progress = console.progress(jobs.len());
    for (index, job) in jobs.iter().enumerate() {
        let mut step = |done: usize| {
            progress.set(index, u32::try_from(done).unwrap_or(u32::MAX), args.runs);
        };
        match job {
            Job::Frames(case) => {
                report.frames.push(frames::measure(case, runs, &graphics, console, &mut step)?);
            }
            Job::Lines(cell) => {
                let cost = lines::measure(*cell, args, &graphics, console, &mut step)?;
                let lines = match &mut report.lines {
                    Some(lines) => lines,
                    none => none.insert(lines::report(args)?),
                };
                lines.push(cost);
            }
            Job::Waves => {
                report.waves = Some(waves::measure(args, &graphics, console)?);
                step(runs);
            }
            Job::Import { triangles } => {
                report.import.push(import::measure(*triangles, runs, &graphics, &mut step)?);
            }
        }
    }
    drop(progress);
    if args.json {
        let text = serde_json::to_string_pretty(&report).map_err(Failure::message)?;
        console::print(&format!("{text}\n"))
    } else {
        console::print(&report.text())
    }
}

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}
