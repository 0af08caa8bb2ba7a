use std::io::Read as _;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{FileError, check};

/// Larger files are refused: nobody wrote them by hand.
const MAX_BYTES: u64 = 4 << 20;
/// Longest `a.b.c` key. Nested tables are dropped recursively, so their depth must be bounded;
/// the TOML reader itself bounds only brackets.
const MAX_KEY_PARTS: usize = 32;

/// A parsed file with what is needed to point at its parts.
pub(crate) struct Document<'a> {
    /// The file, for messages.
    pub(crate) path: Option<&'a Path>,
    /// Its text.
    pub(crate) text: &'a Arc<str>,
    /// Its keys and values with their places.
    pub(crate) table: Spanned<DeTable<'a>>,
}

impl<'a> Document<'a> {
    /// Parses the text and compares it with the schema.
    pub(crate) fn parse(
        path: Option<&'a Path>,
        text: &'a Arc<str>,
        schema: &serde_json::Value,
    ) -> Result<Self, FileError> {
        let error =
            |span, message, help| FileError::new(path, Arc::clone(text), span, message, help);
        if let Some(span) = overlong_key(text) {
            let message = format!("this key has more than {MAX_KEY_PARTS} parts");
            return Err(error(span, message, None));
        }
        let table = DeTable::parse(text).map_err(|e| {
            error(e.span().unwrap_or(0..0), format!("not valid TOML: {}", e.message()), None)
        })?;
        check::version(table.get_ref())
            .and_then(|()| check::table(&table, schema))
            .map_err(|problem| error(problem.span, problem.message, problem.help))?;
        Ok(Self { path, text, table })
    }

    /// The data itself.
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Result<T, FileError> {
        T::deserialize(toml::de::Deserializer::from(self.table.clone())).map_err(|e| {
            let span = e.span().unwrap_or(0..0);
            let message = match key_of(self.table.get_ref(), &span) {
                Some(key) => format!("'{key}' {}", e.message()),
                None => e.message().to_owned(),
            };
            self.error(span, message)
        })
    }

    /// Compares a table that was changed with the schema again.
    pub(crate) fn recheck(&self, schema: &serde_json::Value) -> Result<(), String> {
        check::table(&self.table, schema).map_err(|problem| problem.message)
    }

    /// An error at a place of this file.
    pub(crate) fn error(&self, span: Range<usize>, message: String) -> FileError {
        FileError::new(self.path, Arc::clone(self.text), span, message, None)
    }

    /// The place of a value at the top level; the file's start if it is not there.
    pub(crate) fn span_of(&self, key: &str) -> Range<usize> {
        self.table.get_ref().get(key).map_or(0..0, Spanned::span)
    }

    /// Puts `directory` before every relative path that stands under one of `keys`, at any depth.
    pub(crate) fn resolve_paths(&mut self, directory: &Path, keys: &[&str]) {
        let mut tables = vec![self.table.get_mut()];
        while let Some(table) = tables.pop() {
            for (key, value) in table.iter_mut() {
                match value.get_mut() {
                    DeValue::String(text) if keys.contains(&key.get_ref().as_ref()) => {
                        let path = directory.join(text.as_ref());
                        *text = path.to_string_lossy().into_owned().into();
                    }
                    DeValue::Table(table) => tables.push(table),
                    DeValue::Array(array) => {
                        tables.extend(array.iter_mut().filter_map(|v| match v.get_mut() {
                            DeValue::Table(table) => Some(table),
                            _ => None,
                        }));
                    }
                    _ => {}
                }
            }
        }
    }
}

/// The innermost key whose value (or value's element) stands exactly at `span`.
fn key_of(table: &DeTable<'_>, span: &Range<usize>) -> Option<String> {
    let mut found = None;
    let mut todo: Vec<(&str, &Spanned<DeValue<'_>>)> = entries(table).collect();
    while let Some((key, value)) = todo.pop() {
        if value.span() == *span {
            found = Some(key.to_owned());
        }
        match value.get_ref() {
            DeValue::Table(table) => todo.extend(entries(table)),
            DeValue::Array(array) => todo.extend(array.iter().map(|element| (key, element))),
            _ => {}
        }
    }
    found
}

fn entries<'a>(
    table: &'a DeTable<'_>,
) -> impl Iterator<Item = (&'a str, &'a Spanned<DeValue<'a>>)> {
    table.iter().map(|(key, value)| (key.get_ref().as_ref(), value))
}

/// The place of a key with too many parts, found without parsing: a run of single dots that no
/// character interrupts which ends a key.
fn overlong_key(text: &str) -> Option<Range<usize>> {
    let mut dots = 0;
    let mut previous = 0;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'.' if previous == b'.' => dots = 0,
            b'.' => dots += 1,
            b'=' | b',' | b'[' | b']' | b'{' | b'}' | b'\n' => dots = 0,
            _ => {}
        }
        if dots >= MAX_KEY_PARTS {
            return Some(at..at + 1);
        }
        previous = byte;
    }
    None
}

/// The text of a file.
pub(crate) fn read_text(path: &Path) -> Result<Arc<str>, std::io::Error> {
    use std::io::{Error, ErrorKind};
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES {
        let message = format!("it is larger than {} MiB", MAX_BYTES >> 20);
        return Err(Error::new(ErrorKind::FileTooLarge, message));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(text.into()),
        Err(_) => Err(Error::new(ErrorKind::InvalidData, "it is not UTF-8 text")),
    }
}

/// A path without `.` steps, which make messages hard to read.
pub(crate) fn show_path(path: &Path) -> PathBuf {
    path.components().filter(|step| *step != Component::CurDir).collect()
}
