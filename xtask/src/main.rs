//! The project's own tasks, run as `cargo xtask TASK`.

mod adapter;
mod check;
mod error;
mod fuzz;
mod gallery;
mod models;
mod process;
#[cfg(feature = "shaders")]
mod shaders;
mod snapshots;

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
    /// Draw every preset on every model, into out/gallery; installs a software driver if needed
    Demo,
    /// Run every check and test; installs a software driver if needed
    Test,
    /// Draw the small pictures of assets/gallery again
    Gallery {
        /// What is drawn; everything if nothing is named
        parts: Vec<gallery::Part>,
    },
    /// List test pictures that differ from the expected ones
    Snapshots {
        /// Take them over as the expected ones
        #[arg(long)]
        update: bool,
    },
    /// Run the long proofs
    Verify {
        /// Which, such as waves; all if nothing is named
        parts: Vec<String>,
    },
    /// Run the fuzz targets
    Fuzz {
        /// Only this one
        target: Option<String>,
        /// Seconds for each target
        #[arg(long, default_value_t = 60)]
        seconds: u32,
    },
    /// Link the shaders and generate the Rust twins of their structs
    Shaders {
        /// Only check that the committed files are what the shaders give
        #[arg(long)]
        check: bool,
    },
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
        Task::Demo => gallery::demo(root),
        Task::Test => check::test(root),
        Task::Gallery { parts } => gallery::gallery(root, &parts),
        Task::Snapshots { update } => snapshots::snapshots(root, update),
        Task::Verify { parts } => {
            let arguments =
                ["run", "--release", "--package", "genga-tests", "--bin", "verify", "--"];
            process::run(process::cargo(root).args(arguments).args(parts))
        }
        Task::Fuzz { target, seconds } => fuzz::fuzz(root, target.as_deref(), seconds),
        Task::Shaders { check } => shaders(root, check),
        Task::Models { bench_mesh: Some(triangles), output: Some(file), .. } => {
            models::write_bench_mesh(triangles, &file)
        }
        Task::Models { check: true, .. } => models::check(root),
        Task::Models { .. } => models::write(root),
    }
}

#[cfg(feature = "shaders")]
fn shaders(root: &Path, check: bool) -> Result<()> {
    shaders::run(root, check).map_err(Error::new)
}

/// The shader tools are slow to build, so only this task builds them.
#[cfg(not(feature = "shaders"))]
fn shaders(root: &Path, check: bool) -> Result<()> {
    let mut cargo = process::cargo(root);
    cargo.args(["run", "--package", "xtask", "--features", "shaders", "--", "shaders"]);
    process::run(cargo.args(check.then_some("--check")))
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
