//! Sheets of hatching, after figures of Suzuki 2004: patterns by tone, mappings in motion, near and
//! far, and the materials that have presets.

use std::path::Path;

use super::sheet::{self, Cell, Sheet};
use crate::Result;

/// Draws all sheets into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let all = [tones(), mappings(), distances(), materials()];
    sheet::draw(genga, &all, &root.join("assets/models"), folder)
}

/// A model under a hatching, in a picture of a height.
fn cell(model: &str, hatch: &str, height: u32, options: Vec<String>) -> Cell {
    let scene = format!("version = 1\n[[model]]\nfile = \"{model}\"\n");
    Cell { scene, style: Some(style_of(hatch, 2 * height)), options }
}

/// Black on white; widths are half pixels of the picture.
fn style_of(hatch: &str, height: u32) -> String {
    format!(
        "version = 1\n[background]\ncolor = \"#ffffff\"\n[light]\nazimuth_deg = -60\n\
         elevation_deg = 35\nreplace_model_lights = true\n[paint]\nbase = \"#ffffff\"\n\
         [paint.hatch]\n{hatch}\n[lines]\nreference_height = {height}\n[[lines.sets]]\n\
         name = \"outline\"\ntypes = [\"silhouette\", \"object\", \"border\"]\nwidth = 3.4\n\
         [[lines.sets]]\nname = \"inner\"\ntypes = [\"crease\", \"material\"]\nwidth = 2.0\n"
    )
}

fn camera(azimuth: f32, elevation: f32, zoom: f32) -> Vec<String> {
    let options = ["--camera-azimuth-angle", "--camera-elevation-angle", "--camera-zoom"];
    let values = [azimuth, elevation, zoom];
    options.iter().zip(values).flat_map(|(o, v)| [(*o).to_owned(), v.to_string()]).collect()
}

/// After figure 3.10: patterns in steps of tone from light to dark.
fn tones() -> Sheet {
    let patterns = [
        "pattern = \"strokes\"",
        "pattern = \"cross\"",
        "pattern = \"stipple\"\nspacing = 6",
        "pattern = \"pencil\"\nspacing = 6",
        "pattern = \"dots\"\nangle_deg = 45\nlines_per_inch = 30\npage_height_in = 1.2",
    ];
    let mut cells = Vec::new();
    for pattern in patterns {
        for lum in [0.7, 0.62, 0.54, 0.46, 0.38] {
            let hatch = format!("{pattern}\ntones = [{{ at = 0.0, lum = {lum} }}]");
            let options = camera(25.0, 6.0, 1.7);
            cells.push(cell("head.glb", &hatch, 170, options));
        }
    }
    Sheet { name: "hatching-tones", cell: [200, 170], columns: 5, cells }
}

/// After figures 3.11 and 3.12: the mappings `uv`, `screen` and `surface` while the body turns.
fn mappings() -> Sheet {
    let mut cells = Vec::new();
    for mapping in ["uv", "screen", "surface"] {
        for i in 0..5 {
            let hatch = format!(
                "pattern = \"strokes\"\nmapping = \"{mapping}\"\nspacing = 8\nangle_deg = 25\n\
                 tones = [{{ at = 0.1, lum = 0.3 }}, {{ at = 0.65, lum = 0.76 }}]"
            );
            let options = camera(10.0 + 8.0 * i as f32, 8.0, 1.2);
            cells.push(cell("head.glb", &hatch, 240, options));
        }
    }
    Sheet { name: "hatching-mappings", cell: [240, 240], columns: 5, cells }
}

/// After figure 3.14: strokes keep their width and distance from far to near.
fn distances() -> Sheet {
    let hatch = "pattern = \"strokes\"\nspacing = 9\n\
                 tones = [{ at = 0.1, lum = 0.24 }, { at = 0.6, lum = 0.76 }]";
    let cell = |zoom| cell("head.glb", hatch, 300, camera(25.0, 6.0, zoom));
    let cells = [0.4, 1.0, 2.5, 6.0].map(cell).into();
    Sheet { name: "hatching-near-far", cell: [300, 300], columns: 4, cells }
}

/// The presets `skin`, `cloth`, `metal`, `hair` and `glass`.
fn materials() -> Sheet {
    let cell = |preset| {
        let hatch = format!("preset = \"{preset}\"");
        cell("teapot-on-box.glb", &hatch, 220, camera(30.0, 20.0, 1.6))
    };
    let cells = ["skin", "cloth", "metal", "hair", "glass"].map(cell).into();
    Sheet { name: "hatching-materials", cell: [260, 220], columns: 5, cells }
}
