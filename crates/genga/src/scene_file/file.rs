use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer};
use thiserror::Error;

use super::{
    BeamEntry, CameraEntry, HighlightEntry, LightEntry, Located, ModelEntry, ShadingEntry,
    WaveEntry, WaveReference, beam, camera, highlight, light, wave,
};
use crate::FileError;
use crate::style::{Style, StyleError, is_style_path};
use crate::toml_file::{Document, list_with, read_text, schema_of, show_path};

/// Why a scene file cannot be used.
#[derive(Debug, Error)]
pub enum SceneFileError {
    /// Something in the file is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file cannot be read at all.
    #[error("cannot read the scene '{}': {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

/// A scene file that has been read and checked, without what it refers to.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// The style that it asks for: a preset's name or a path, as written. See
    /// [`Self::load_style`].
    pub style: Option<Located<String>>,
    /// The models.
    pub models: Vec<ModelEntry>,
    /// How it is seen.
    pub camera: Option<CameraEntry>,
    /// Lights besides those of the models.
    pub lights: Vec<LightEntry>,
    /// Anime highlights.
    pub highlights: Vec<HighlightEntry>,
    /// Surfaces that are shaded by other normals.
    pub shadings: Vec<ShadingEntry>,
    /// Energy waves.
    pub waves: Vec<WaveEntry>,
    /// How they are integrated, if not exactly.
    pub wave_reference: Option<WaveReference>,
    /// Beams.
    pub beams: Vec<BeamEntry>,
    /// The picture to make.
    pub picture: Picture,
    /// Where relative paths start.
    directory: PathBuf,
    path: Option<PathBuf>,
    text: Arc<str>,
}

/// The picture that a scene file asks for; what is `None` is left to the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Picture {
    /// Width and height in pixels.
    #[schemars(inner(range(min = 1, max = 16384)))]
    pub size: Option<[u32; 2]>,
    /// Whether the style's background is drawn; without it the picture is transparent there.
    pub background: Option<bool>,
    /// Samples per pixel along each axis.
    #[schemars(range(min = 1, max = 4))]
    pub supersample: Option<u32>,
}

/// Which models stand where, and how they are seen, lit and drawn.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Written {
    /// Version of the file format; 1.
    #[schemars(range(min = 1, max = 1))]
    #[expect(dead_code, reason = "the reader checks it before the data is read")]
    version: u32,
    /// How it is drawn: the name of a preset, or the path of a style file, relative to this file.
    #[serde(default)]
    style: Option<Located<String>>,
    /// The models.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    model: Vec<ModelEntry>,
    /// How it is seen.
    #[serde(default)]
    #[schemars(with = "Option<camera::Written>")]
    camera: Option<CameraEntry>,
    /// Lights besides those of the models.
    #[serde(default, deserialize_with = "lights")]
    #[schemars(with = "Vec<light::Written>", length(max = 1000))]
    light: Vec<LightEntry>,
    /// Anime highlights.
    #[serde(default, deserialize_with = "highlight::highlights")]
    #[schemars(with = "Vec<HighlightEntry>", length(max = 1000))]
    highlight: Vec<HighlightEntry>,
    /// Surfaces that are shaded by the normals of a smooth shape, or by a keyed face shadow; the last
    /// one that fits counts.
    #[serde(default, deserialize_with = "shadings")]
    #[schemars(length(max = 16))]
    shading: Vec<ShadingEntry>,
    /// Energy waves.
    #[serde(default, deserialize_with = "waves")]
    #[schemars(with = "Vec<wave::Written>", length(max = 240))]
    wave: Vec<WaveEntry>,
    /// Abe's own method for the waves instead of the exact one, for comparison.
    #[serde(default)]
    wave_reference: Option<WaveReference>,
    /// Beams: bodies of light.
    #[serde(default, deserialize_with = "beams")]
    #[schemars(with = "Vec<beam::Written>", length(max = 256))]
    beam: Vec<BeamEntry>,
    /// The picture to make.
    #[serde(default)]
    picture: Picture,
}

fn shadings<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<ShadingEntry>, D::Error> {
    list_with(deserializer, |_, entry: &ShadingEntry| entry.check())
}

fn lights<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<LightEntry>, D::Error> {
    // For the place of each light's own errors.
    list_with(deserializer, |_, _| Ok(()))
}

fn waves<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<WaveEntry>, D::Error> {
    list_with(deserializer, |_, _| Ok(()))
}

fn beams<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<BeamEntry>, D::Error> {
    list_with(deserializer, |_, _| Ok(()))
}

/// The JSON Schema of scene files, for editors.
#[must_use]
pub fn json_schema() -> serde_json::Value {
    schema_of::<Written>("Genga scene")
}

static SCHEMA: LazyLock<serde_json::Value> = LazyLock::new(json_schema);

impl SceneFile {
    /// Reads a scene from TOML text. Relative paths in it start at the current directory.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn from_toml_str(text: &str) -> Result<Self, FileError> {
        Self::read(None, text.into())
    }

    /// Reads a scene file. Relative paths in it start at its own directory. The models and the
    /// style are not opened yet.
    ///
    /// # Errors
    /// The file cannot be read, or the first thing in it that is wrong.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneFileError> {
        let path = path.as_ref();
        let text = read_text(path)
            .map_err(|source| SceneFileError::Read { path: path.to_owned(), source })?;
        Ok(Self::read(Some(path), text)?)
    }

    fn read(path: Option<&Path>, text: Arc<str>) -> Result<Self, FileError> {
        let written: Written = Document::parse(path, &text, &SCHEMA)?.read()?;
        let directory = path.and_then(Path::parent).unwrap_or(Path::new("")).to_owned();
        Ok(Self {
            style: written.style,
            models: written.model,
            camera: written.camera,
            lights: written.light,
            highlights: written.highlight,
            shadings: written.shading,
            waves: written.wave,
            wave_reference: written.wave_reference,
            beams: written.beam,
            picture: written.picture,
            directory,
            path: path.map(Path::to_owned),
            text,
        })
    }

    /// The style that the file asks for; `None` if it asks for none.
    ///
    /// # Errors
    /// The style does not exist (shown at its place in this file), or something in the style is
    /// wrong (shown there).
    pub fn load_style(&self) -> Result<Option<Style>, FileError> {
        let Some(name) = &self.style else { return Ok(None) };
        let style =
            if is_style_path(name) { Style::load(self.resolve(name)) } else { Style::find(name) };
        style.map(Some).map_err(|error| match error {
            StyleError::File(error) => error,
            other => self.error(name, other.to_string()),
        })
    }

    /// A path in this file, from the current directory.
    pub(super) fn resolve(&self, path: &str) -> PathBuf {
        show_path(&self.directory.join(path))
    }

    /// The file's name without its endings.
    pub(super) fn name(&self) -> String {
        let file = self.path.as_deref().and_then(Path::file_name).unwrap_or_default();
        let file = file.to_string_lossy();
        file.trim_end_matches(".toml").trim_end_matches(".scene").to_owned()
    }

    /// A warning with the place of a value.
    pub(super) fn warning<T>(&self, at: &Located<T>, message: &str) -> String {
        self.error(at, message.to_owned()).to_string()
    }

    /// An error at the place of a value.
    pub(super) fn error<T>(&self, at: &Located<T>, message: String) -> FileError {
        FileError::new(self.path.as_deref(), Arc::clone(&self.text), at.span(), message, None)
    }
}
