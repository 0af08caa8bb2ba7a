//! Reading `*.style.toml`.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use schemars::JsonSchema;
use serde::Deserialize;
use thiserror::Error;
use toml::Spanned;
use toml::de::DeTable;

use super::presets::preset_text;
use super::{Background, Lines, Motion, Override, Paint, Style, StyleLight, merge};
use crate::FileError;
use crate::toml_file::{Document, nearest, read_text, schema_of, show_path};

/// Why a style cannot be used.
#[derive(Debug, Error)]
pub enum StyleError {
    /// Something in the file is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file cannot be read at all.
    #[error("cannot read the style '{}': {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// There is no preset of that name.
    #[error("{}", unknown_preset(name))]
    UnknownPreset {
        /// What was asked for.
        name: String,
    },
}

/// How things are drawn.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StyleFile {
    /// Version of the file format; 1.
    #[schemars(range(min = 1, max = 1))]
    version: u32,
    /// The style that this one changes: the name of a preset, or the path of a style file,
    /// relative to this one.
    #[serde(default)]
    #[expect(dead_code, reason = "followed before the data is read")]
    extends: Option<String>,
    /// Name for people.
    #[serde(default)]
    name: String,
    /// One sentence on what it is for.
    #[serde(default)]
    description: String,
    /// What stands behind everything.
    #[serde(default)]
    background: Background,
    /// Light for scenes that have none.
    #[serde(default)]
    light: StyleLight,
    /// How surfaces are filled.
    #[serde(default)]
    paint: Paint,
    /// How lines are found and drawn.
    #[serde(default)]
    lines: Lines,
    /// How motion is drawn.
    #[serde(default)]
    motion: Motion,
    /// What differs for some objects, materials or colours. Later ones win, property by
    /// property.
    #[serde(default)]
    #[schemars(length(max = 256))]
    r#override: Vec<Override>,
}

impl From<StyleFile> for Style {
    fn from(file: StyleFile) -> Self {
        Self {
            version: file.version,
            name: file.name,
            description: file.description,
            background: file.background,
            light: file.light,
            paint: file.paint,
            lines: file.lines,
            motion: file.motion,
            overrides: file.r#override,
        }
    }
}

/// The JSON Schema of style files, for editors.
#[must_use]
pub fn json_schema() -> serde_json::Value {
    schema_of::<StyleFile>("Genga style")
}

static SCHEMA: LazyLock<serde_json::Value> = LazyLock::new(json_schema);

impl Style {
    /// Reads a style from TOML text. Relative paths in it start at the current directory.
    ///
    /// # Errors
    /// The first thing in the text, or in a file that it extends, that is wrong.
    pub fn from_toml_str(text: &str) -> Result<Self, FileError> {
        let source = Source { path: None, directory: PathBuf::new(), text: text.into() };
        source.read()
    }

    /// Reads a style file. Relative paths in it start at its own directory. A style without a
    /// name gets the file's.
    ///
    /// # Errors
    /// The file cannot be read, or the first thing in it, or in a file that it extends, that is
    /// wrong.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, StyleError> {
        let path = path.as_ref();
        let source = Source::file(path)
            .map_err(|source| StyleError::Read { path: path.to_owned(), source })?;
        let mut style = source.read()?;
        if style.name.is_empty() {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            style.name = file.trim_end_matches(".toml").trim_end_matches(".style").to_owned();
        }
        Ok(style)
    }

    /// A preset by its name, or else a style file by its path (which has a `/` or ends in
    /// `.toml`).
    ///
    /// # Errors
    /// There is no such preset, or what [`Self::load`] says.
    pub fn find(name_or_path: &str) -> Result<Self, StyleError> {
        match preset_text(name_or_path) {
            Some(text) => Ok(Self::from_toml_str(text)?),
            None if is_style_path(name_or_path) => Self::load(name_or_path),
            None => Err(StyleError::UnknownPreset { name: name_or_path.to_owned() }),
        }
    }
}

/// Whether a text names a style file and not a preset.
pub(crate) fn is_style_path(text: &str) -> bool {
    text.ends_with(".toml") || text.contains(['/', '\\'])
}

fn unknown_preset(name: &str) -> String {
    let names: Vec<&str> = Style::presets().map(|(name, _)| name).collect();
    let meant = match nearest(name, names.iter().copied()) {
        Some(meant) => format!(", did you mean '{meant}'?"),
        None => String::new(),
    };
    let known = names.join(", ");
    format!(
        "unknown style '{name}'{meant} (presets: {known}; a file is named by its path, such as './{name}.style.toml')"
    )
}

/// A text with the place that it comes from.
struct Source {
    path: Option<PathBuf>,
    directory: PathBuf,
    text: Arc<str>,
}

impl Source {
    fn file(path: &Path) -> Result<Self, std::io::Error> {
        let text = read_text(path)?;
        let directory = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Self { path: Some(path.to_owned()), directory, text })
    }

    fn document(&self) -> Result<Document<'_>, FileError> {
        let mut document = Document::parse(self.path.as_deref(), &self.text, &SCHEMA)?;
        document.resolve_paths(&self.directory, &["image"]);
        Ok(document)
    }

    /// The style with all that it extends.
    fn read(self) -> Result<Style, FileError> {
        let chain = self.chain()?;
        let documents: Vec<Document<'_>> =
            chain.iter().map(Source::document).collect::<Result<_, _>>()?;
        let mut merged: Option<DeTable<'_>> = None;
        for document in documents.iter().rev() {
            // Each file by itself, so that an error shows the right file.
            let alone = document.read::<StyleFile>()?;
            let table = document.table.get_ref().clone();
            let Some(base) = &mut merged else {
                if documents.len() == 1 {
                    return Ok(alone.into());
                }
                merged = Some(table);
                continue;
            };
            merge::merge(base, table);
        }
        let (Some(child), Some(merged)) = (documents.into_iter().next(), merged) else {
            return Ok(Style::default());
        };
        let span = child.span_of("extends");
        let table = Spanned::new(child.table.span(), merged);
        let merged = Document { table, ..child };
        let wrong = |message: String| {
            merged.error(span.clone(), format!("together with what it extends: {message}"))
        };
        merged.recheck(&SCHEMA).map_err(&wrong)?;
        merged.read::<StyleFile>().map(Style::from).map_err(|e| wrong(e.message))
    }

    /// This text, what it extends, what that extends, …
    fn chain(self) -> Result<Vec<Self>, FileError> {
        const MAX_LENGTH: usize = 16;
        let mut chain = vec![self];
        while let Some(next) = chain.last().map_or(Ok(None), Self::base)? {
            let (base, error) = next;
            let seen = |source: &Self| match (&source.path, &base.path) {
                (Some(a), Some(b)) => same_file(a, b),
                _ => false,
            };
            if chain.iter().any(seen) {
                return Err(error("it extends itself".to_owned()));
            }
            if chain.len() >= MAX_LENGTH {
                return Err(error(format!("more than {MAX_LENGTH} styles extend one another")));
            }
            chain.push(base);
        }
        Ok(chain)
    }

    /// What this text extends, with a way to complain about it.
    fn base(&self) -> Result<Option<(Self, impl Fn(String) -> FileError + use<>)>, FileError> {
        let document = self.document()?;
        let Some(extends) = document.table.get_ref().get("extends") else { return Ok(None) };
        let Some(name) = extends.get_ref().as_str() else { return Ok(None) };
        let (path, text, span) = (self.path.clone(), Arc::clone(&self.text), extends.span());
        let error = move |message| {
            FileError::new(path.as_deref(), Arc::clone(&text), span.clone(), message, None)
        };
        if let Some(text) = preset_text(name) {
            let path = Some(PathBuf::from(format!("preset:{name}")));
            return Ok(Some((Self { path, directory: PathBuf::new(), text: text.into() }, error)));
        }
        if !is_style_path(name) {
            return Err(error(unknown_preset(name)));
        }
        let path = show_path(&self.directory.join(name));
        let base = Self::file(&path)
            .map_err(|e| error(format!("cannot read the style '{}': {e}", path.display())))?;
        Ok(Some((base, error)))
    }
}

fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}
