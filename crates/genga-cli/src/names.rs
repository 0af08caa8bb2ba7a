//! What the pictures of one run are called.

use std::path::PathBuf;

use crate::args::PictureArgs;
use crate::failure::{Failure, Outcome};
use crate::model;
use crate::output::{self, Output};
use crate::save::Target;
use crate::style_choice::StyleChoice;
use crate::template::{Fields, Template};

/// Names for all pictures of one run.
#[derive(Debug)]
pub(crate) struct Names {
    output: Output,
    frames: usize,
}

impl Names {
    /// Reads `--output` for so many inputs with so many frames each.
    pub(crate) fn new(args: &PictureArgs, inputs: usize, frames: usize) -> Outcome<Self> {
        let output = match &args.output {
            Some(Output::Stdout) => {
                if inputs * frames > 1 || !args.layers.is_empty() {
                    return Err(Failure::Usage(
                        "standard output takes one picture without layers: give '--output' a name"
                            .to_owned(),
                    ));
                }
                output::check_stdout()?;
                Output::Stdout
            }
            Some(Output::Files(template)) => {
                if frames > 1 && !template.tells_frames_apart() {
                    return Err(Failure::Usage(
                        "all frames would be written to the same file: put {frame:04} into '--output'"
                            .to_owned(),
                    ));
                }
                Output::Files(template.clone())
            }
            None => {
                let default = if frames > 1 { "{model}_{frame:04}.png" } else { "{model}.png" };
                Output::Files(Template::parse(default).map_err(Failure::Message)?)
            }
        };
        Ok(Self { output, frames })
    }

    /// Finds, before anything is drawn, names that cannot work.
    pub(crate) fn check(
        &self,
        inputs: &[PathBuf],
        style_name: &str,
        style: Option<&StyleChoice>,
        first_frame: i64,
    ) -> Outcome {
        let outputs = inputs.iter().enumerate().filter_map(|(index, input)| {
            let name = model::display_name(input);
            match self.target(&name, style_name, first_frame, index * self.frames) {
                Target::Stdout => None,
                Target::File(path) => Some(path),
            }
        });
        let read: Vec<PathBuf> =
            inputs.iter().cloned().chain(style.and_then(|style| style.file.clone())).collect();
        output::check_files(&outputs.collect::<Vec<_>>(), &read)
    }

    /// Where a picture goes. `index` counts all pictures of the run.
    pub(crate) fn target(&self, model: &str, style: &str, frame: i64, index: usize) -> Target {
        match &self.output {
            Output::Stdout => Target::Stdout,
            Output::Files(template) => {
                Target::File(template.fill(&Fields { model, style, frame, index }).into())
            }
        }
    }
}
