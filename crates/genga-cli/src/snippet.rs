//! Shows the place in a file that an error is about.

use genga::FileError;
use unicode_width::UnicodeWidthStr as _;

use crate::text::one_line;

/// Longest part of a line that is shown, in characters.
const WIDEST: usize = 100;

/// The error's sentence, the line that it is about and a mark under the place.
pub(crate) fn file_error(error: &FileError) -> String {
    let place = match &error.path {
        Some(path) => format!("{}:{}:{}", path.display(), error.line, error.column),
        None => format!("line {}, column {}", error.line, error.column),
    };
    let line: Vec<char> = error.line_text().trim_end_matches('\r').chars().collect();
    let column = error.column.saturating_sub(1).min(line.len());
    let spanned = error.text.get(error.span.clone()).unwrap_or("");
    let length = spanned.lines().next().unwrap_or("").chars().count().min(line.len() - column);
    // Of a very long line, the part that begins a little before the place.
    let start = if line.len() <= WIDEST { 0 } else { column.saturating_sub(WIDEST / 3) };
    let end = line.len().min(start + WIDEST);
    let shown = |range: std::ops::Range<usize>| -> String {
        let part: String = line.get(range).unwrap_or(&[]).iter().collect();
        one_line(&part.replace('\t', "    "))
    };
    let ellipsis = |cut: bool| if cut { "…" } else { "" };
    let before = format!("{}{}", ellipsis(start > 0), shown(start..column));
    let marked = shown(column..(column + length).min(end));
    let after = format!("{}{}", shown((column + length).min(end)..end), ellipsis(end < line.len()));

    let number = error.line.to_string();
    let margin = " ".repeat(number.len());
    let message = &error.message;
    let indent = " ".repeat(before.width());
    let marks = "^".repeat(marked.width().max(1));
    let mut text = format!(
        "{message}\n{margin}--> {place}\n{margin} |\n{number} | {before}{marked}{after}\n{margin} | {indent}{marks}"
    );
    if let Some(help) = &error.help {
        text.push_str(&format!("\n{margin} = help: {help}"));
    }
    text
}

#[cfg(test)]
mod tests {
    use genga::style::Style;

    use super::*;

    fn report(text: &str) -> String {
        file_error(&Style::from_toml_str(text).expect_err("a mistake"))
    }

    #[test]
    fn the_mark_stands_under_the_mistake() {
        let text = report("version = 1\n\t[backgruond]\n");
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].contains("did you mean 'background'"), "{text}");
        assert_eq!(lines[1], " --> line 2, column 3");
        assert_eq!(lines[3], "2 |     [backgruond]");
        assert_eq!(lines[4], "  |      ^^^^^^^^^^");
    }

    #[test]
    fn a_long_line_is_cut_around_the_mistake() {
        let text = report(&format!("version = 1\nname = \"{}\"\nx = 1", "é".repeat(5_000)));
        assert!(text.lines().all(|line| line.width() < 200), "{text}");
        let text = report(&format!("version = 1\n{} x = \n", "\"深\".".repeat(2_000)));
        assert!(text.lines().all(|line| line.width() < 300), "{text}");
    }

    #[test]
    fn a_mistake_at_the_end_is_shown() {
        for text in ["", "version", "version = 1\n[", "version = 1\r\nname = '", "\u{1b}[31m"] {
            let report = report(text);
            assert!(report.contains("-->") && !report.contains('\u{1b}'), "{report:?}");
        }
    }
}
