//! How things are drawn: plain data, read from `*.style.toml` files. No GPU here.
//!
//! A style is complete and resolved: what a file left out has its default, what it extends is
//! merged in. Pictures that it refers to are loaded with it.
//!
//! ```
//! use genga::style::Style;
//!
//! let style = Style::from_toml_str(
//!     r##"
//!     version = 1
//!     extends = "american-comic"
//!     [background]
//!     color = "#fff4d8"
//!     "##,
//! )?;
//! assert_eq!(style.background.color.to_string(), "#fff4d8");
//! # Ok::<(), genga::FileError>(())
//! ```

mod color;
mod file;
#[cfg(test)]
mod file_tests;
mod globs;
mod hatch;
mod lines;
mod merge;
mod motion;
mod overrides;
mod paint;
pub(crate) mod picture;
mod presets;
mod shade_map;
mod shadow;
mod shine;
#[cfg(test)]
mod tests;
mod widths;

pub use color::{Color, ColorError};
pub(crate) use file::is_style_path;
pub use file::{StyleError, json_schema};
pub use globs::{GlobError, Globs};
pub use hatch::{Hatch, HatchDirection, HatchMapping, HatchPattern, HatchPreset, HatchTone};
pub use lines::{
    Detect, DetectScale, Hull, LineColorBy, LineMethod, LineParts, LineSet, LineType, Lines, Rim,
    Strokes,
};
pub use motion::{Motion, Shutter, Smear, SpeedLines};
pub use overrides::{
    BaseColorRange, IdTexture, LineOverride, Override, PaintOverride, Selector, VertexColorRange,
};
pub use paint::{
    Background, BaseColor, BlendSpace, Paint, PinnedTo, Ramp, RampStop, StyleLight, ToneBlend,
};
pub use shade_map::{ShadeMap, ShadeSource};
pub use shadow::{Shadow, ShadowOverride};
pub use shine::{Dots, RimLight, Sheen, ShineBlend, Specular, SpecularForm};
pub use widths::{Curve, WidthBy, Wobble};

/// A whole look.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Version of the file format; 1.
    pub version: u32,
    /// Name for people.
    pub name: String,
    /// One sentence on what it is for.
    pub description: String,
    /// What stands behind everything.
    pub background: Background,
    /// Light for scenes that have none.
    pub light: StyleLight,
    /// How surfaces are filled.
    pub paint: Paint,
    /// How lines are found and drawn.
    pub lines: Lines,
    /// How motion is drawn.
    pub motion: Motion,
    /// What differs for some objects, materials or colours. Later ones win, property by
    /// property.
    pub overrides: Vec<Override>,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            version: 1,
            name: String::new(),
            description: String::new(),
            background: Background::default(),
            light: StyleLight::default(),
            paint: Paint::default(),
            lines: Lines::default(),
            motion: Motion::default(),
            overrides: Vec::new(),
        }
    }
}
