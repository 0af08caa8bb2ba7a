use std::fmt::Display;
use std::io;
use std::process::ExitCode;

use genga::FileError;
use genga::scene_file::SceneFileError;
use genga::style::StyleError;

use crate::console::Console;
use crate::snippet;

/// Why the program could not do what it was asked.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The command line itself asks for something impossible: exit status 2.
    Usage(String),
    /// Something went wrong while doing it.
    Message(String),
    /// A place in a file that people write, shown with its line.
    File(Box<FileError>),
    /// Everything has been said already.
    Reported,
}

/// What the commands return.
pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// One sentence for anything that has one.
    pub(crate) fn message(error: impl Display) -> Self {
        Self::Message(error.to_string())
    }

    /// Standard output does not take what is written to it. A reader that has had enough
    /// (`genga info … | head`) is no reason to complain.
    pub(crate) fn standard_output(error: &io::Error) -> Self {
        if error.kind() == io::ErrorKind::BrokenPipe {
            Self::Reported
        } else {
            Self::Message(format!("cannot write to standard output: {}", reason(error)))
        }
    }

    /// What to print after `error: `, if anything.
    fn report(&self) -> Option<String> {
        match self {
            Self::Usage(text) => Some(format!("{text}\n\nFor more information, try '--help'.")),
            Self::Message(text) => Some(text.clone()),
            Self::File(error) => Some(snippet::file_error(error)),
            Self::Reported => None,
        }
    }

    /// Prints it on standard error.
    pub(crate) fn print(&self, console: &Console) {
        if let Some(text) = self.report() {
            console.error(&text);
        }
    }

    /// 2 for a wrong command line, as clap has it, and 1 for the rest.
    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Usage(_) => ExitCode::from(2),
            _ => ExitCode::FAILURE,
        }
    }
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self::File(Box::new(error))
    }
}

impl From<StyleError> for Failure {
    fn from(error: StyleError) -> Self {
        match error {
            StyleError::File(error) => error.into(),
            other => Self::message(other),
        }
    }
}

impl From<SceneFileError> for Failure {
    fn from(error: SceneFileError) -> Self {
        match error {
            SceneFileError::File(error) => error.into(),
            other => Self::message(other),
        }
    }
}

/// An I/O error in plain words, with what to do where the system's own text does not say it.
pub(crate) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::StorageFull => "the disk is full; free some space".to_owned(),
        io::ErrorKind::QuotaExceeded => "your disk quota is used up; free some space".to_owned(),
        io::ErrorKind::FileTooLarge => "the file would be larger than allowed".to_owned(),
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        _ => error.to_string(),
    }
}
