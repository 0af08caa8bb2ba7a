//! `cargo xtask fuzz`: each fuzz target for a while.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::process::{run, succeeds};
use crate::{Error, Result};

/// Runs every target of `fuzz/`, or only the one named, for that many seconds each.
pub(crate) fn fuzz(root: &Path, target: Option<&str>, seconds: u32) -> Result<()> {
    let folder = root.join("fuzz/fuzz_targets");
    let targets: Vec<String> = crate::files_with_extension(&folder, "rs")?
        .iter()
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .filter(|name| target.is_none_or(|target| target == name))
        .collect();
    if targets.is_empty() {
        return Err(match target {
            Some(target) => Error::new(format!("there is no {target}.rs in {}", folder.display())),
            None => Error::new(format!("there are no fuzz targets in {}", folder.display())),
        });
    }
    if !succeeds(Command::new("rustup").args(["run", "nightly", "rustc", "--version"])) {
        return Err(Error::new(
            "fuzzing needs the nightly toolchain: `rustup toolchain install nightly`",
        ));
    }
    if !succeeds(Command::new("rustup").args(["run", "nightly", "cargo", "fuzz", "--version"])) {
        return Err(Error::new("fuzzing needs cargo-fuzz: `cargo install cargo-fuzz`"));
    }
    let mut failures = Vec::new();
    for target in &targets {
        // What is found goes to the corpus; the seeds are committed and only read.
        let corpus = root.join("fuzz/corpus").join(target);
        fs::create_dir_all(&corpus).map_err(Error::io("cannot make the folder", &corpus))?;
        let seeds = match target.as_str() {
            "style_file" => root.join("assets/styles"),
            _ => root.join("fuzz/seeds").join(target),
        };
        let mut command = Command::new("rustup");
        command.current_dir(root).args(["run", "nightly", "cargo", "fuzz", "run", target]);
        command.arg(&corpus);
        if seeds.is_dir() {
            command.arg(&seeds);
        }
        command.arg("--");
        if let Err(error) = run(command.arg(format!("-max_total_time={seconds}"))) {
            failures.push(error.to_string());
        }
    }
    if failures.is_empty() {
        println!("{} fuzz targets ran for {seconds} s each and found nothing.", targets.len());
        return Ok(());
    }
    Err(Error::new(failures.join("\n  ")))
}
