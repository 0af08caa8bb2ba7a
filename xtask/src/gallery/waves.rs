//! The sheets and showpieces of energy waves: `assets/scenes/waves`, each in its own style and size.

use std::path::Path;
use std::process::Command;

use super::sheet::{self, Cell, Sheet, changed, read};
use crate::{Result, process};

/// Draws them into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let scenes = root.join("assets/scenes/waves");
    let files = super::scenes(&scenes)?;
    let mut render = Command::new(genga);
    render.args(["render", "--output"]).arg(folder.join("{model}.png"));
    process::run(render.args(&files))?;
    let sheets = [cameras(&read(&scenes, "waves-cameras.scene.toml")?)?, blends(&scenes)?];
    sheet::draw(genga, &sheets, &scenes, folder)
}

/// Beam and volley before a bright sky: added, and covering it.
fn blends(scenes: &Path) -> Result<Sheet> {
    let day = "version = 1\nextends = \"anime\"\n[background]\ncolor = \"#6fb4ea\"\n\
               bottom = \"#e6f3fb\"\n";
    let mut cells = Vec::new();
    for (name, radius) in [("beam", "radius = 0.5\n"), ("volley", "radius = 0.2\n")] {
        let added = read(scenes, &format!("waves-hero-{name}.scene.toml"))?;
        let covering = changed(&added, radius, &format!("{radius}blend = \"normal\"\n"))?;
        for scene in [added, covering] {
            cells.push(Cell { scene, style: Some(day.to_owned()), options: Vec::new() });
        }
    }
    Ok(Sheet { name: "waves-blends", cell: [480, 270], columns: 2, cells })
}

/// One helix from the side, from before and behind its head, along its axis, and from inside (Abe
/// 2024, figures 4.3).
fn cameras(scene: &str) -> Result<Sheet> {
    let places = [
        ([1.0, 0.0, 4.2], [1.0, 0.0, 0.0], 29),
        ([4.4, 1.2, 2.2], [1.0, 0.0, 0.0], 22),
        ([-2.2, 0.8, 1.4], [1.0, 0.0, 0.0], 24),
        ([4.6, 0.001, 0.0], [0.0, 0.0, 0.0], 26),
        ([-1.2, 0.0, 0.001], [2.0, 0.0, 0.0], 40),
        ([0.3, 0.0, 0.0], [2.0, 0.05, 0.0], 40),
    ];
    let cell = |(eye, at, fov): ([f64; 3], [f64; 3], u32)| {
        let scene = changed(scene, "position = [1, 0, 4.2]", &format!("position = {eye:?}"))?;
        let scene = changed(&scene, "target = [1, 0, 0]", &format!("target = {at:?}"))?;
        let scene = changed(&scene, "fov_deg = 40", &format!("fov_deg = {fov}"))?;
        Ok(Cell { scene, style: None, options: Vec::new() })
    };
    let cells: Result<_> = places.into_iter().map(cell).collect();
    Ok(Sheet { name: "waves-cameras", cell: [280, 210], columns: 3, cells: cells? })
}
