//! Reading the TOML files that people write: strictly, and with errors that show the place.
//!
//! A file is read in two steps. First its text is compared with the JSON Schema that editors use
//! (unknown keys, types, ranges, numbers of elements), so the reader and the editor never
//! disagree. Then serde makes the data, and the types' own rules (colours, globs, order of ramp
//! stops, pictures) are checked there.

mod check;
mod error;
mod located;
mod parse;
mod schema;
#[cfg(test)]
mod testing;

pub use error::FileError;
pub use located::Located;

pub(crate) use check::list_with;
pub(crate) use error::nearest;
pub(crate) use parse::{Document, read_text, show_path};
#[cfg(test)]
pub(crate) use schema::assert_schema_is_fresh;
pub(crate) use schema::schema_of;
#[cfg(test)]
pub(crate) use testing::mutate;
