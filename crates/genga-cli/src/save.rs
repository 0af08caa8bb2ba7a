//! Writes finished pictures with their layers.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use genga::export::{Samples, write_exr, write_png};
use genga::render::{Layer, LayerData, LayerKind, Picture};

use crate::console::Console;
use crate::failure::{Failure, Outcome};
use crate::output::{self, layer_path, write_file, write_stdout};
use crate::text::count;

/// Where one picture goes.
#[derive(Clone, Debug)]
pub(crate) enum Target {
    /// Standard output.
    Stdout,
    /// A PNG file.
    File(PathBuf),
}

/// Writes pictures, each to a file of its own, and never over what was read.
#[derive(Default)]
pub(crate) struct Saver {
    written: HashSet<PathBuf>,
    /// The first and the last picture.
    ends: Option<(PathBuf, PathBuf)>,
    pictures: usize,
}

impl Saver {
    /// Checks that a picture and its layers may be written there, before it is drawn.
    pub(crate) fn check(
        &self,
        target: &Target,
        layers: &[LayerKind],
        inputs: &[PathBuf],
    ) -> Outcome {
        let Target::File(path) = target else { return Ok(()) };
        let mut files = vec![path.clone()];
        files.extend(layers.iter().map(|&kind| layer_path(path, kind.name(), ending(kind))));
        if let Some(twice) = files.iter().find(|file| self.written.contains(*file)) {
            return Err(Failure::Usage(format!(
                "'{}' was written a moment ago: put {{model}}, {{frame:04}} or {{index}} into '--output' to tell pictures apart",
                twice.display()
            )));
        }
        output::refuse_inputs(&files, inputs)
    }

    /// Says what was written.
    pub(crate) fn report(&self, console: &Console) {
        if let Some((first, last)) = &self.ends {
            let (first, last) = (first.display(), last.display());
            console.done(&match self.pictures {
                1 => format!("wrote {first}"),
                2 => format!("wrote {first} and {last}"),
                n => format!("wrote {}, {first} to {last}", count(n, "picture", "pictures")),
            });
        }
    }

    /// Writes a picture and its layers.
    pub(crate) fn save(&mut self, picture: &Picture, target: &Target) -> Outcome {
        let begin = Instant::now();
        self.write(picture, target)?;
        log::info!("written in {:.0} ms", begin.elapsed().as_secs_f64() * 1e3);
        Ok(())
    }

    fn write(&mut self, picture: &Picture, target: &Target) -> Outcome {
        let (width, height) = (picture.width, picture.height);
        match target {
            Target::Stdout => write_stdout(|out| write_png(out, width, height, &picture.rgba)),
            Target::File(path) => {
                write_file(path, |file| write_png(file, width, height, &picture.rgba))?;
                self.written.insert(path.clone());
                self.pictures += 1;
                let first = self.ends.take().map_or_else(|| path.clone(), |(first, _)| first);
                self.ends = Some((first, path.clone()));
                for layer in &picture.layers {
                    let path = layer_path(path, layer.kind.name(), ending(layer.kind));
                    write_layer(&path, width, height, layer)?;
                    self.written.insert(path);
                }
                Ok(())
            }
        }
    }
}

/// What numbers are written as: colours as PNG, other quantities as OpenEXR.
fn ending(kind: LayerKind) -> &'static str {
    match kind {
        LayerKind::Color
        | LayerKind::Lines
        | LayerKind::Highlight
        | LayerKind::Base
        | LayerKind::Tone
        | LayerKind::Shadow
        | LayerKind::Ink
        | LayerKind::Beam => "png",
        LayerKind::Depth
        | LayerKind::Normal
        | LayerKind::Ids
        | LayerKind::LineMask
        | LayerKind::LineType
        | LayerKind::HighlightUv
        | LayerKind::Energy => "exr",
    }
}

fn write_layer(path: &Path, width: u32, height: u32, layer: &Layer) -> Outcome {
    let names: &[&str] = match layer.kind {
        LayerKind::Color
        | LayerKind::Lines
        | LayerKind::Highlight
        | LayerKind::Base
        | LayerKind::Tone
        | LayerKind::Shadow
        | LayerKind::Ink
        | LayerKind::Beam => &["R", "G", "B", "A"],
        LayerKind::HighlightUv => &["drawing.X", "drawing.Y", "drawing.Z"],
        LayerKind::LineMask => &["set.1", "set.2", "set.3", "set.4"],
        LayerKind::LineType => &["line.type"],
        LayerKind::Depth => &["Z"],
        LayerKind::Energy => &["Y"],
        LayerKind::Normal => &["N.X", "N.Y", "N.Z"],
        LayerKind::Ids => &["id.object", "id.material", "id.line"],
    };
    match &layer.data {
        LayerData::Rgba8(rgba) => write_file(path, |file| write_png(file, width, height, rgba)),
        LayerData::F32 { values, .. } => {
            write_file(path, |file| write_exr(file, width, height, names, Samples::F32(values)))
        }
        LayerData::U32 { values, .. } => {
            write_file(path, |file| write_exr(file, width, height, names, Samples::U32(values)))
        }
    }
}
