use std::io::{self, IsTerminal as _, Write as _};

use indicatif::ProgressBar;

use crate::failure::{Failure, Outcome};

/// What the program says to people, on standard error.
pub(crate) struct Console {
    quiet: bool,
    color: bool,
    /// Hidden unless something takes long; messages go above it.
    bar: ProgressBar,
}

impl Console {
    /// With `quiet`, only errors are printed.
    pub(crate) fn new(quiet: bool) -> Self {
        let color = io::stderr().is_terminal()
            && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        Self { quiet, color, bar: ProgressBar::hidden() }
    }

    /// Why something failed.
    pub(crate) fn error(&self, text: &str) {
        self.print("error", "1;31", text);
    }

    /// Something that is probably not as the person wants it.
    pub(crate) fn warning(&self, text: &str) {
        if !self.quiet {
            self.print("warning", "1;33", text);
        }
    }

    fn print(&self, label: &str, color: &str, text: &str) {
        let line = if self.color {
            format!("\x1b[{color}m{label}:\x1b[0m {text}\n")
        } else {
            format!("{label}: {text}\n")
        };
        self.bar.suspend(|| {
            // There is nobody to tell if this fails.
            let _ = io::stderr().write_all(line.as_bytes());
        });
    }
}

/// Writes the result of a command to standard output.
pub(crate) fn print(text: &str) -> Outcome {
    let mut stdout = io::stdout().lock();
    let result = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush());
    result.map_err(|error| Failure::standard_output(&error))
}
