use genga::style::{Style, StyleError};

use crate::args::StylesArgs;
use crate::console;
use crate::failure::Outcome;
use crate::text::table;

/// Lists the presets, or prints the text of one.
pub(crate) fn run(args: &StylesArgs) -> Outcome {
    if let Some(name) = &args.name {
        if let Some((_, text)) = Style::presets().find(|(preset, _)| preset == name) {
            return console::print(text);
        }
        return Err(StyleError::UnknownPreset { name: name.clone() }.into());
    }
    let mut rows = Vec::new();
    for (name, text) in Style::presets() {
        let style = Style::from_toml_str(text)?;
        rows.push(vec![name.to_owned(), style.description]);
    }
    console::print(&table(&rows))
}
