//! Sheets of highlights, as the figures of the paper on anime highlights show them: with keys and
//! without, between keys, by the proxy's part in the normal, with all drawings, and on a body.

use std::path::Path;

use super::sheet::{self, Cell, Sheet, changed, read};
use crate::Result;

/// Draws all sheets into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let scenes = root.join("assets/scenes/highlights");
    let [head, hero] = [read(&scenes, "head.scene.toml")?, read(&scenes, "hero.scene.toml")?];
    let all = [views(&head)?, between(&head)?, proxies(&head)?, drawings(&head)?, body(&hero)];
    sheet::draw(genga, &all, &scenes, folder)
}

/// From where the head is seen in a row.
const AROUND: [f32; 6] = [-22.0, 45.0, 110.0, 180.0, -125.0, -65.0];

fn camera(azimuth: f32, zoom: f32) -> Vec<String> {
    let options = ["--camera-azimuth-angle", "--camera-elevation-angle", "--camera-zoom"];
    let values = [azimuth, 6.0, zoom];
    options.iter().zip(values).flat_map(|(o, v)| [(*o).to_owned(), v.to_string()]).collect()
}

/// The head from all sides: above with keys, below at the light's mirror image.
fn views(head: &str) -> Result<Sheet> {
    let scenes = [head.to_owned(), without_keys(head)];
    let cell = |scene: &String, azimuth| Cell {
        scene: scene.clone(),
        style: None,
        options: camera(azimuth, 1.0),
    };
    let cells =
        scenes.iter().flat_map(|scene| AROUND.map(|azimuth| cell(scene, azimuth))).collect();
    Ok(Sheet { name: "highlights-views", cell: [240, 240], columns: AROUND.len(), cells })
}

/// From the front to the side: keys that hold, that go evenly, and smoothly.
fn between(head: &str) -> Result<Sheet> {
    let mut cells = Vec::new();
    for kind in ["hold", "linear", "smooth"] {
        let interpolation = format!("[[highlight.key]]\ninterpolation = \"{kind}\"");
        let scene = changed(head, "[[highlight.key]]", &interpolation)?;
        for i in 0..5 {
            let options = camera(15.0 * i as f32, 1.0);
            cells.push(Cell { scene: scene.clone(), style: None, options });
        }
    }
    Ok(Sheet { name: "highlights-between", cell: [200, 200], columns: 5, cells })
}

/// γ = 0, 0.9 and 1 on the ball that is fitted to the hair; last, γ = 1 by normals from the centre.
fn proxies(head: &str) -> Result<Sheet> {
    let mut cells = Vec::new();
    for drawing in ["angel-ring", "star"] {
        let mut scene =
            changed(head, "drawing = \"angel-ring\"", &format!("drawing = \"{drawing}\""))?;
        if drawing == "star" {
            scene = changed(&scene, "size_deg = [200, 84]", "size_deg = [80, 80]")?;
        }
        for gamma in ["0.0", "0.9", "1.0"] {
            let scene = changed(&scene, "level = true", &format!("level = true\ngamma = {gamma}"))?;
            cells.push(Cell { scene, style: None, options: camera(-22.0, 1.15) });
        }
        let center = "center = [0, 0.26, -0.02]";
        let scene = changed(&scene, center, &format!("{center}, radius = 0"))?;
        cells.push(Cell { scene, style: None, options: camera(-22.0, 1.15) });
    }
    Ok(Sheet { name: "highlights-proxy", cell: [300, 300], columns: 4, cells })
}

/// All drawings that come with the library.
fn drawings(head: &str) -> Result<Sheet> {
    let sizes = [
        ("disc", 44, 44),
        ("band", 170, 44),
        ("angel-ring", 200, 84),
        ("window", 56, 56),
        ("star", 72, 72),
        ("heart", 60, 60),
        ("double-dot", 66, 66),
        ("streak", 190, 110),
    ];
    let mut cells = Vec::new();
    for (drawing, width, height) in sizes {
        let scene = changed(head, "drawing = \"angel-ring\"", &format!("drawing = \"{drawing}\""))?;
        let size = format!("size_deg = [{width}, {height}]");
        let scene = changed(&scene, "size_deg = [200, 84]", &size)?;
        cells.push(Cell { scene, style: None, options: camera(-10.0, 1.1) });
    }
    Ok(Sheet { name: "highlights-drawings", cell: [240, 240], columns: 4, cells })
}

/// A walking body from two sides.
fn body(hero: &str) -> Sheet {
    let moments = [(0.0, 30.0), (0.27, 30.0), (0.54, 30.0), (0.54, -20.0)];
    let cell = |(time, azimuth): (f32, f32)| {
        let mut options = camera(azimuth, 1.0);
        options.extend(["--time".to_owned(), time.to_string()]);
        Cell { scene: hero.to_owned(), style: None, options }
    };
    Sheet { name: "highlights-body", cell: [300, 400], columns: 4, cells: moments.map(cell).into() }
}

/// A scene without its `[[highlight.key]]` tables.
fn without_keys(scene: &str) -> String {
    let mut in_key = false;
    let kept = scene.lines().filter(|line| {
        if line.starts_with('[') {
            in_key = *line == "[[highlight.key]]";
        }
        !in_key
    });
    kept.flat_map(|line| [line, "\n"]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_left_out_with_their_lines() {
        let scene = "[[highlight]]\na = 1\n[[highlight.key]]\nb = 2\n\n[picture]\nc = 3\n";
        assert_eq!(without_keys(scene), "[[highlight]]\na = 1\n[picture]\nc = 3\n");
    }
}
