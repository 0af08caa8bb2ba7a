use std::borrow::Cow;

use globset::{Glob, GlobBuilder, GlobSet};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};
use thiserror::Error;

use crate::toml_file::list_with;

/// Globs over names, compiled once. Without patterns it matches every name.
///
/// `*` is any text, `?` any one character, `[ab]` one of them, `{skin,face}` either text. Case
/// does not matter.
#[derive(Clone, Debug, Default)]
pub struct Globs {
    patterns: Vec<String>,
    set: GlobSet,
}

/// A glob cannot be understood.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("must be a glob, which \"{pattern}\" is not: {reason}")]
pub struct GlobError {
    /// The glob.
    pub pattern: String,
    /// What is wrong with it.
    pub reason: String,
}

impl Globs {
    /// Compiles the patterns.
    ///
    /// # Errors
    /// The first pattern that is not a glob.
    pub fn new<S: Into<String>>(patterns: impl IntoIterator<Item = S>) -> Result<Self, GlobError> {
        let patterns: Vec<String> = patterns.into_iter().map(Into::into).collect();
        let mut set = GlobSet::builder();
        for pattern in &patterns {
            set.add(compile(pattern)?);
        }
        let set = set.build().map_err(|e| GlobError {
            pattern: e.glob().unwrap_or_default().to_owned(),
            reason: e.kind().to_string(),
        })?;
        Ok(Self { patterns, set })
    }

    /// The patterns as they were written.
    #[must_use]
    pub fn patterns(&self) -> &[String] {
        &self.patterns
    }

    /// Whether one of the patterns fits the whole name, or there are no patterns.
    #[must_use]
    pub fn matches(&self, name: &str) -> bool {
        self.patterns.is_empty() || self.set.is_match(name)
    }
}

fn compile(pattern: &str) -> Result<Glob, GlobError> {
    let error = |reason: &str| GlobError { pattern: pattern.to_owned(), reason: reason.to_owned() };
    // Compiled globs grow with their text; a name is never this long.
    if pattern.len() > 256 {
        return Err(error("it is longer than 256 bytes"));
    }
    let glob = GlobBuilder::new(pattern).case_insensitive(true).backslash_escape(true).build();
    glob.map_err(|e| error(&e.kind().to_string()))
}

impl PartialEq for Globs {
    fn eq(&self, other: &Self) -> bool {
        self.patterns == other.patterns
    }
}

impl<'de> Deserialize<'de> for Globs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // One by one, so that an error shows the pattern's own place.
        let patterns = list_with(deserializer, |_, pattern: &String| {
            compile(pattern).map(|_| ()).map_err(|e| e.to_string())
        })?;
        Self::new(patterns).map_err(serde::de::Error::custom)
    }
}

impl JsonSchema for Globs {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Globs".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Vec::<String>::json_schema(generator)
    }
}
