//! The project's own tasks, run as `cargo xtask TASK`.

mod error;
mod models;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use error::{Error, Result};

/// The project's own tasks
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Write the project's own models to assets/models
    Models {
        /// Only check that the committed files are what the code makes
        #[arg(long)]
        check: bool,
        /// Instead, write a smooth object with exactly this many triangles (an even number)
        #[arg(long, value_name = "TRIANGLES", requires = "output", conflicts_with = "check")]
        bench_mesh: Option<usize>,
        /// Where the object of --bench-mesh goes
        #[arg(short, long, value_name = "FILE", requires = "bench_mesh")]
        output: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    match run(Arguments::parse().task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(task: Task) -> Result<()> {
    let root = &root();
    match task {
        Task::Models { bench_mesh: Some(triangles), output: Some(file), .. } => {
            models::write_bench_mesh(triangles, &file)
        }
        Task::Models { check: true, .. } => models::check(root),
        Task::Models { .. } => models::write(root),
    }
}

/// The repository's root.
fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_owned()
}

/// The files in `folder` with that extension, sorted by name.
fn files_with_extension(folder: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).map_err(Error::io("cannot list", folder))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(Error::io("cannot list", folder))?.path();
        if path.extension().is_some_and(|found| found == extension) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
