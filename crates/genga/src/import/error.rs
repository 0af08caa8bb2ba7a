use std::io;

use thiserror::Error;

use crate::scene::SceneError;

/// A model that could not be read: which one, and why.
#[derive(Debug, Error)]
#[error("{file}: {problem}")]
pub struct ImportError {
    /// The file's path or name as it was given.
    pub file: String,
    /// What is wrong with it.
    pub problem: Problem,
}

/// Why a model could not be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file itself could not be read.
    #[error("the file cannot be read ({0})")]
    Read(io::Error),
    /// Neither the name's ending nor the content tells a format.
    #[error("this is not a model that Genga can read; give it a .gltf, .glb or .obj file")]
    UnknownFormat,
    /// The file ends too early or its container is wrong.
    #[error("the file is cut off or damaged: {0}; export or download it again")]
    Damaged(String),
    /// The JSON cannot be parsed.
    #[error("the JSON is wrong at line {line}, column {column}: {what}")]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        what: String,
    },
    /// The file is of another glTF version.
    #[error("this is glTF {0}, but Genga reads glTF 2.0; export or convert it again as 2.0")]
    Version(String),
    /// The file cannot be understood without an extension that Genga does not know.
    #[error("it requires the glTF extension '{extension}', which Genga cannot read; {advice}")]
    Extension {
        /// Name of the extension.
        extension: String,
        /// What to do about it.
        advice: &'static str,
    },
    /// A part of the file contradicts another one.
    #[error("{part}: {why}")]
    Invalid {
        /// Which part, such as `accessor 3`.
        part: String,
        /// What is wrong with it and what to do.
        why: String,
    },
    /// The geometry would take far more memory than the file is large.
    #[error(
        "it describes over {0} MiB of geometry, far more than its own size can hold; the file is damaged or was made to exhaust memory"
    )]
    TooLarge(u64),
    /// The scene does not hold together.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl Problem {
    /// A part that contradicts another one.
    pub(super) fn invalid(part: impl Into<String>, why: impl Into<String>) -> Self {
        Self::Invalid { part: part.into(), why: why.into() }
    }
}
