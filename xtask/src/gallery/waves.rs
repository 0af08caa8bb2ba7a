//! The sheets and showpieces of energy waves: `assets/scenes/waves`, each in its own style and size.

use std::path::Path;
use std::process::Command;

use crate::{Result, process};

/// Draws them with a built genga into `assets/gallery`.
pub(super) fn draw(root: &Path, genga: &Path) -> Result<()> {
    let mut scenes = crate::files_with_extension(&root.join("assets/scenes/waves"), "toml")?;
    scenes.retain(|file| super::name_of(file).ends_with(".scene.toml"));
    let mut render = Command::new(genga);
    render.current_dir(root).args(["render", "--output", "assets/gallery/{model}.png"]);
    render.args(scenes.iter().map(|path| path.strip_prefix(root).unwrap_or(path)));
    process::run(&mut render)
}
