use std::path::{Path, PathBuf};

use genga::style::Style;

use crate::failure::Outcome;

/// The style when none is asked for.
pub(crate) const DEFAULT: &str = "american-comic";

/// The style that the command line asks for, else the scene's own, else the default.
pub(crate) fn choose(
    asked: Option<&StyleChoice>,
    own: Option<StyleChoice>,
) -> Outcome<StyleChoice> {
    match asked.cloned().or(own) {
        Some(style) => Ok(style),
        None => find(DEFAULT),
    }
}

/// A style with the name that output files get.
#[derive(Clone, Debug)]
pub(crate) struct StyleChoice {
    /// A preset's name, or the file's without folder and ending.
    pub(crate) name: String,
    /// The file, if it is not a preset.
    pub(crate) file: Option<PathBuf>,
    /// The style itself.
    pub(crate) style: Style,
}

/// The preset of that name, or the style in that file.
pub(crate) fn find(name_or_file: &str) -> Outcome<StyleChoice> {
    let style = Style::find(name_or_file)?;
    if is_preset(name_or_file) {
        return Ok(StyleChoice { name: name_or_file.to_owned(), file: None, style });
    }
    let path = Path::new(name_or_file);
    let name = crate::model::display_name(path);
    Ok(StyleChoice { name, file: Some(path.to_owned()), style })
}

/// Whether a style of that name comes with the program.
pub(crate) fn is_preset(name: &str) -> bool {
    Style::presets().any(|(preset, _)| preset == name)
}
