//! The sheets that compare line methods, buffers and detection scales.

use std::path::Path;
use std::process::Command;

use crate::{Result, process};

/// Draws them into `folder`. Which there are, and what they show, is in `tests/src/bin/sheets`,
/// since they read the library's layers.
pub(super) fn draw(root: &Path, folder: &Path) -> Result<()> {
    let sheets = process::build(root, &["--release", "--package", "genga-tests"], "sheets")?;
    process::run(Command::new(sheets).current_dir(root).arg(folder))
}
