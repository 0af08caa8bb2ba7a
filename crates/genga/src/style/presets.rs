use super::Style;

/// Name and text of the styles that are part of the program.
const PRESETS: [(&str, &str); 6] = [
    ("american-comic", include_str!("../../../../assets/styles/american-comic.style.toml")),
    (
        "american-comic-modern",
        include_str!("../../../../assets/styles/american-comic-modern.style.toml"),
    ),
    ("anime", include_str!("../../../../assets/styles/anime.style.toml")),
    ("blueprint", include_str!("../../../../assets/styles/blueprint.style.toml")),
    ("manga", include_str!("../../../../assets/styles/manga.style.toml")),
    ("pencil", include_str!("../../../../assets/styles/pencil.style.toml")),
];

impl Style {
    /// Name and TOML text of every preset, by name.
    pub fn presets() -> impl ExactSizeIterator<Item = (&'static str, &'static str)> {
        PRESETS.into_iter()
    }

    /// The preset of that name.
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        // A test reads all presets, so that `ok` hides nothing.
        Self::from_toml_str(preset_text(name)?).ok()
    }
}

/// The TOML text of a preset.
pub(super) fn preset_text(name: &str) -> Option<&'static str> {
    PRESETS.into_iter().find(|(known, _)| *known == name).map(|(_, text)| text)
}
