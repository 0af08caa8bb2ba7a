//! `cargo xtask test`: everything that must hold before a change is done.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::process::{WORKSPACE, build, cargo, run, succeeds};
use crate::{Error, Result, adapter, models};

/// Runs all checks, goes on after one that fails, and says at the end which did.
pub(crate) fn test(root: &Path) -> Result<()> {
    let start = Instant::now();
    ensure_components(root)?;
    // Both programs of the workspace, with the features that all later steps use.
    let bins = ["--bin", "genga", "--bin", "xtask"];
    let arguments: Vec<&str> = WORKSPACE.iter().chain(&bins).copied().collect();
    let genga = build(root, &arguments, "genga")?;
    let xtask = build(root, &arguments, "xtask")?;
    adapter::ensure(&genga)?;

    let mut failures = Vec::new();
    let mut step = |result: Result<()>| {
        if let Err(error) = result {
            eprintln!("error: {error}");
            failures.push(error.to_string());
        }
    };
    step(run(cargo(root).args(["fmt", "--all", "--check"])));
    step(run(cargo(root).arg("clippy").args(WORKSPACE).args([
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ])));
    step(models::check(root));
    step(run(Command::new(xtask).current_dir(root).args(["shaders", "--check"])));
    step(run(cargo(root)
        .args(["doc", "--no-deps"])
        .args(WORKSPACE)
        .env("RUSTDOCFLAGS", "-D warnings")));
    step(run(cargo(root).args(["test", "--no-fail-fast"]).args(WORKSPACE)));

    let minutes = start.elapsed().as_secs_f64() / 60.0;
    if failures.is_empty() {
        println!("All checks passed in {minutes:.1} minutes.");
        return Ok(());
    }
    Err(Error::new(format!(
        "{} of 6 checks failed in {minutes:.1} minutes:\n  {}",
        failures.len(),
        failures.join("\n  ")
    )))
}

/// A minimal toolchain lacks rustfmt and clippy; rustup can add them without a question.
fn ensure_components(root: &Path) -> Result<()> {
    for (tool, component) in [("fmt", "rustfmt"), ("clippy", "clippy")] {
        if succeeds(cargo(root).args([tool, "--version"])) {
            continue;
        }
        run(Command::new("rustup").current_dir(root).args(["component", "add", component]))?;
    }
    Ok(())
}
