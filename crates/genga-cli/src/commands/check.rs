use std::path::Path;

use genga::import::ImportError;
use genga::scene_file::SceneFile;
use genga::style::Style;

use crate::args::CheckArgs;
use crate::console::{self, Console};
use crate::failure::{Failure, Outcome};
use crate::{model, text};

/// Reads each file strictly and prints what is wrong. Fails if anything is.
pub(crate) fn run(args: &CheckArgs, console: &Console) -> Outcome {
    let mut sound = true;
    for path in &args.files {
        match check(path, console) {
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
                failure.print(console);
            }
        }
    }
    if sound { Ok(()) } else { Err(Failure::Reported) }
}

/// What is wrong with a file that can be read.
fn check(path: &Path, console: &Console) -> Outcome<Vec<String>> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    if name.ends_with(".scene.toml") {
        return check_scene(path);
    }
    if name.ends_with(".style.toml") {
        Style::load(path)?;
        return Ok(Vec::new());
    }
    if name.ends_with(".toml") {
        console.note(&format!(
            "{}: read as a style, since its name does not end in .scene.toml",
            path.display()
        ));
        Style::load(path)?;
        return Ok(Vec::new());
    }
    Ok(model::load(path).map_err(Failure::message)?.warnings)
}

/// A scene with its style and all its models.
fn check_scene(path: &Path) -> Outcome<Vec<String>> {
    let file = SceneFile::load(path)?;
    file.load_style()?;
    let mut problems = Vec::new();
    let assembled = file.assemble(|path| {
        let model = model::load(path)?;
        let shown = path.display();
        problems.extend(model.warnings.iter().map(|warning| format!("{shown}: {warning}")));
        Ok::<_, ImportError>(model.scene)
    })?;
    problems.extend(assembled.warnings);
    Ok(problems)
}
