//! Running other programs.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::{Error, Result};

/// Features with which the whole workspace is built, linted and tested, always the same ones so
/// that nothing is built twice.
pub(crate) const WORKSPACE: [&str; 3] = ["--workspace", "--features", "xtask/shaders"];

/// The cargo that runs this program, in the repository's root.
pub(crate) fn cargo(root: &Path) -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(root).stdin(Stdio::null());
    cargo
}

/// Runs it and shows what it prints.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    println!("$ {}", shown(command));
    let status = command.status().map_err(|error| cannot_start(command, &error))?;
    if status.success() {
        return Ok(());
    }
    Err(Error::new(format!("`{}` failed ({status})", shown(command))))
}

/// Runs it silently; whether it succeeded. A program that is not there did not.
pub(crate) fn succeeds(command: &mut Command) -> bool {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Runs it and returns what it writes to standard output; its errors are shown.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let output = command
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| cannot_start(command, &error))?;
    if !output.status.success() {
        return Err(Error::new(format!("`{}` failed ({})", shown(command), output.status)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Builds and returns the path of the program that cargo says it has built under that name.
pub(crate) fn build(root: &Path, arguments: &[&str], program: &str) -> Result<PathBuf> {
    let mut command = cargo(root);
    command.arg("build").args(arguments).arg("--message-format=json-render-diagnostics");
    println!("$ {}", shown(&command));
    output(&mut command)?
        .lines()
        .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
        .filter(|message| message["target"]["name"] == program)
        .find_map(|message| message["executable"].as_str().map(PathBuf::from))
        .ok_or_else(|| Error::new(format!("cargo has built no program called {program}")))
}

fn cannot_start(command: &Command, error: &std::io::Error) -> Error {
    Error::new(format!("cannot start `{}`: {error}", shown(command)))
}

/// The command line for people: programs by their names, not their paths.
fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_stem().unwrap_or(program.as_os_str()).to_string_lossy();
    let arguments = command.get_args().map(|argument| argument.to_string_lossy());
    std::iter::once(name).chain(arguments).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_name_the_command() {
        let error = run(Command::new("/nowhere/genga-no-such-program").arg("-x")).unwrap_err();
        assert!(error.to_string().contains("genga-no-such-program -x"), "{error}");
        let error = output(cargo(&crate::root()).arg("no-such-subcommand")).unwrap_err();
        assert!(error.to_string().contains("cargo no-such-subcommand"), "{error}");
        assert!(!succeeds(&mut Command::new("/nowhere/genga-no-such-program")));
    }
}
