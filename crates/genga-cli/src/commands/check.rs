use std::path::Path;

use genga::style::Style;

use crate::args::CheckArgs;
use crate::console::{self, Console};
use crate::failure::{Failure, Outcome};
use crate::{model, text};

/// Reads each file strictly and prints what is wrong. Fails if anything is.
pub(crate) fn run(args: &CheckArgs, console: &Console) -> Outcome {
    let mut sound = true;
    for path in &args.files {
        match check(path) {
            Ok(problems) if problems.is_empty() => {
                console::print(&format!("{}: ok\n", path.display()))?;
            }
            Ok(problems) => {
                sound = false;
                for problem in problems {
                    console.error(&format!("{}: {}", path.display(), text::one_line(&problem)));
                }
            }
            Err(failure) => {
                sound = false;
                if let Some(report) = failure.report() {
                    console.error(&report);
                }
            }
        }
    }
    if sound { Ok(()) } else { Err(Failure::Reported) }
}

/// What is wrong with a file that can be read.
fn check(path: &Path) -> Outcome<Vec<String>> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if name.ends_with(".toml") {
        Style::load(path)?;
        return Ok(Vec::new());
    }
    Ok(model::load(path).map_err(Failure::message)?.warnings)
}
