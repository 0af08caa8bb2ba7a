use std::io::{self, IsTerminal as _, Write as _};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

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

    /// Something worth knowing, said once.
    pub(crate) fn note(&self, text: &str) {
        if !self.quiet {
            self.print("note", "1;36", text);
        }
    }

    /// What was done.
    pub(crate) fn done(&self, text: &str) {
        if !self.quiet {
            self.write(&format!("{text}\n"));
        }
    }

    /// A bar for `total` pieces of work. It shows itself after a second, on terminals.
    pub(crate) fn progress(&self, total: usize) -> Progress<'_> {
        let style = ProgressStyle::with_template("{bar:30} {percent:>3}%  {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        self.bar.reset();
        self.bar.set_style(style);
        self.bar.set_length(total as u64 * PARTS);
        Progress { console: self, begin: Instant::now(), shown: self.quiet }
    }

    fn print(&self, label: &str, color: &str, text: &str) {
        let line = if self.color {
            format!("\x1b[{color}m{label}:\x1b[0m {text}\n")
        } else {
            format!("{label}: {text}\n")
        };
        self.write(&line);
    }

    fn write(&self, line: &str) {
        self.bar.suspend(|| {
            // There is nobody to tell if this fails.
            let _ = io::stderr().write_all(line.as_bytes());
        });
    }
}

/// Parts of a piece of work that the bar tells apart.
const PARTS: u64 = 1000;

/// How far a long piece of work is. The bar goes when this does.
pub(crate) struct Progress<'a> {
    console: &'a Console,
    begin: Instant,
    shown: bool,
}

impl Progress<'_> {
    /// `done` whole pieces and `part` of `parts` of the next one are finished.
    pub(crate) fn set(&mut self, done: usize, part: u32, parts: u32) {
        let bar = &self.console.bar;
        bar.set_position(done as u64 * PARTS + u64::from(part) * PARTS / u64::from(parts.max(1)));
        if !self.shown && self.begin.elapsed() > Duration::from_secs(1) {
            self.shown = true;
            // Draws nothing where standard error is no terminal.
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl Drop for Progress<'_> {
    fn drop(&mut self) {
        self.console.bar.finish_and_clear();
        self.console.bar.set_draw_target(ProgressDrawTarget::hidden());
    }
}

/// Writes the result of a command to standard output.
pub(crate) fn print(text: &str) -> Outcome {
    let mut stdout = io::stdout().lock();
    let result = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush());
    result.map_err(|error| Failure::standard_output(&error))
}
