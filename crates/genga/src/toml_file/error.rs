use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use thiserror::Error;

/// What is wrong with a file that people write, and where.
///
/// Shown as one sentence such as
/// `hero.style.toml:12:7: unknown key 'colr', did you mean 'color'?`. The text and the span let
/// a program show the offending line as well.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{}{line}:{column}: {message}", Prefix(path.as_deref()))]
pub struct FileError {
    /// The file, if the text came from one (`preset:NAME` for a preset).
    pub path: Option<PathBuf>,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The same place as a range of bytes in `text`.
    pub span: Range<usize>,
    /// The file's whole text.
    pub text: Arc<str>,
    /// What is wrong, without the place.
    pub message: String,
    /// What can be done about it, where there is more to say than the message does.
    pub help: Option<String>,
}

struct Prefix<'a>(Option<&'a Path>);

impl fmt::Display for Prefix<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(path) => write!(f, "{}:", path.display()),
            None => Ok(()),
        }
    }
}

impl FileError {
    /// The offending line, without its line break.
    #[must_use]
    pub fn line_text(&self) -> &str {
        self.text.lines().nth(self.line.saturating_sub(1)).unwrap_or("")
    }

    /// An error at a place, which is moved to the nearest character that exists.
    pub(crate) fn new(
        path: Option<&Path>,
        text: Arc<str>,
        span: Range<usize>,
        message: String,
        help: Option<String>,
    ) -> Self {
        let start = text.floor_char_boundary(span.start);
        let end = text.floor_char_boundary(span.end).max(start);
        let before = text.get(..start).unwrap_or("");
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Self { path: path.map(Path::to_owned), line, column, span: start..end, text, message, help }
    }
}

/// The known name that `name` was probably meant to be.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Comparing takes time with the product of the lengths; no known name is this long.
    if name.len() > 64 {
        return None;
    }
    let lower = name.to_lowercase();
    known
        .into_iter()
        .map(|known| (strsim::damerau_levenshtein(&lower, &known.to_lowercase()), known))
        .filter(|&(distance, known)| distance <= 1 + known.len() / 4)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, known)| known)
}
