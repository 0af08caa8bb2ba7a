//! Sheets of hatching, after figures of Suzuki 2004: patterns by tone, mappings in motion, near and
//! far, the materials that have presets, and a picture of the user's.

use std::fs;
use std::path::Path;

use super::sheet::{self, Cell, Sheet};
use crate::{Error, Result};

/// Draws all sheets into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let all = [tones(), mappings(), distances(), materials(), pictures()];
    let beside = root.join("assets/models");
    let picture = beside.join(PICTURE);
    let wrong = |e: image::ImageError| Error::new(format!("{}: {e}", picture.display()));
    hand_drawn().save(&picture).map_err(wrong)?;
    let drawn = sheet::draw(genga, &all, &beside, folder);
    let removed = fs::remove_file(&picture).map_err(Error::io("cannot remove", &picture));
    drawn.and(removed)
}

/// The pattern of [`pictures`], beside the scenes while they are drawn.
const PICTURE: &str = ".sheet.strokes.png";

/// Brush strokes as somebody may have drawn them, tiled: thick in the middle, no two alike.
fn hand_drawn() -> image::GrayImage {
    const SIDE: u32 = 256;
    const STROKES: u32 = 22;
    let side = f64::from(SIDE);
    // Evenly spread numbers in [0, 1).
    let spread = |i: u32, step: f64| (f64::from(i) * step).fract();
    image::GrayImage::from_fn(SIDE, SIDE, |x, y| {
        let [x, y] = [x, y].map(|v| f64::from(v) + 0.5);
        let mut dark = 0.0_f64;
        for i in 0..STROKES {
            let middle = side * (f64::from(i) + 0.5 * spread(i, 0.618_034)) / f64::from(STROKES);
            let length = side * (0.4 + 0.35 * spread(i, 0.754_878));
            let part = (x - side * spread(i, 0.569_84)).rem_euclid(side) / length;
            if part < 1.0 {
                let half = (1.5 + 2.0 * spread(i, 0.414_214)) * (6.0 * part * (1.0 - part)).sqrt();
                let line = middle + (spread(i, 0.302_776) - 0.5) * 9.0 * (part - 0.5);
                let away = (y - line + 0.5 * side).rem_euclid(side) - 0.5 * side;
                dark = dark.max((half - away.abs() + 0.5).clamp(0.0, 1.0));
            }
        }
        image::Luma([(255.0 * (1.0 - dark)).round() as u8])
    })
}

/// A picture of the user's in the three mappings, and from near and far.
fn pictures() -> Sheet {
    let cell = |mapping: &str, azimuth: f32, zoom: f32| {
        let hatch = format!(
            "pattern = \"image\"\nimage = \"{PICTURE}\"\nmapping = \"{mapping}\"\nspacing = 90\n\
             tones = [{{ at = 0.1, lum = 0.24 }}, {{ at = 0.66, lum = 0.76 }}]"
        );
        cell("head.glb", &hatch, 320, camera(azimuth, 8.0, zoom))
    };
    let mut cells: Vec<Cell> = ["uv", "screen", "surface"].map(|m| cell(m, 25.0, 1.2)).into();
    cells.extend([0.5, 1.8, 4.5].map(|zoom| cell("surface", 40.0, zoom)));
    Sheet { name: "hatching-pictures", cell: [320, 320], columns: 3, cells }
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
