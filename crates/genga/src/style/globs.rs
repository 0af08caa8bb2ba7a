use std::borrow::Cow;

use glob::Pattern;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};
use thiserror::Error;

use crate::toml_file::list_with;

/// Globs over names, compiled once. Without patterns it matches every name.
///
/// `*` is any text (also none), `?` any one character, `[a-z]` one of them, `[!a]` any other.
/// Case does not matter.
#[derive(Clone, Debug, Default)]
pub struct Globs {
    patterns: Vec<String>,
    compiled: Vec<Pattern>,
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
        let compiled = patterns.iter().map(|pattern| compile(pattern)).collect::<Result<_, _>>()?;
        Ok(Self { patterns, compiled })
    }

    /// The patterns as they were written.
    #[must_use]
    pub fn patterns(&self) -> &[String] {
        &self.patterns
    }

    /// Whether one of the patterns fits the whole name, or there are no patterns.
    #[must_use]
    pub fn matches(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        self.compiled.is_empty() || self.compiled.iter().any(|pattern| pattern.matches(&name))
    }
}

fn compile(pattern: &str) -> Result<Pattern, GlobError> {
    let error = |reason: &str| GlobError { pattern: pattern.to_owned(), reason: reason.to_owned() };
    // Matching takes time with the product of the lengths; a name is never this long.
    if pattern.len() > 256 {
        return Err(error("it is longer than 256 bytes"));
    }
    Pattern::new(&pattern.to_lowercase()).map_err(|e| error(e.msg))
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
