//! Sheets of hatching, after figures of Suzuki 2004: patterns by tone, mappings in motion, near and
//! far, and the materials that have presets.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::{Error, Result, process};

/// One picture of a sheet: a model, what its style says of hatching, options of `genga render`.
struct Cell {
    model: &'static str,
    hatch: String,
    options: Vec<String>,
}

/// Rows of equal cells.
struct Sheet {
    name: &'static str,
    /// Width and height of a cell in pixels.
    cell: [u32; 2],
    columns: usize,
    cells: Vec<Cell>,
}

/// Draws all sheets into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let style = folder.join(".sheet.style.toml");
    let all = [tones(), mappings(), distances(), materials()];
    let drawn = all.iter().try_for_each(|sheet| draw_one(root, genga, sheet, &style, folder));
    let removed = fs::remove_file(&style).map_err(Error::io("cannot remove", &style));
    drawn.and(removed)
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

fn draw_one(root: &Path, genga: &Path, sheet: &Sheet, style: &Path, folder: &Path) -> Result<()> {
    let [width, height] = sheet.cell;
    let rows = sheet.cells.len().div_ceil(sheet.columns);
    let mut whole = image::RgbaImage::new(width * sheet.columns as u32, height * rows as u32);
    let file = folder.join(format!("hatching-{}.png", sheet.name));
    for (i, cell) in sheet.cells.iter().enumerate() {
        let text = style_of(&cell.hatch, 2 * height);
        fs::write(style, text).map_err(Error::io("cannot write", style))?;
        let mut render = Command::new(genga);
        render.args(["render", "--quiet"]).arg(root.join("assets/models").join(cell.model));
        render.arg("--style").arg(style).args(["--size", &format!("{width}x{height}")]);
        process::run(render.args(&cell.options).arg("--output").arg(&file))?;
        let wrong = |e: image::ImageError| Error::new(format!("{}: {e}", file.display()));
        let picture = image::open(&file).map_err(wrong)?.into_rgba8();
        let at = |index: usize, side: u32| i64::from(index as u32 * side);
        let (column, row) = (i % sheet.columns, i / sheet.columns);
        image::imageops::replace(&mut whole, &picture, at(column, width), at(row, height));
    }
    let wrong = |e: image::ImageError| Error::new(format!("{}: {e}", file.display()));
    image::DynamicImage::from(whole).into_luma8().save(&file).map_err(wrong)
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
            cells.push(Cell { model: "head.glb", hatch, options });
        }
    }
    Sheet { name: "tones", cell: [200, 170], columns: 5, cells }
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
            cells.push(Cell { model: "head.glb", hatch, options });
        }
    }
    Sheet { name: "mappings", cell: [240, 240], columns: 5, cells }
}

/// After figure 3.14: strokes keep their width and distance from far to near.
fn distances() -> Sheet {
    let hatch = "pattern = \"strokes\"\nspacing = 9\n\
                 tones = [{ at = 0.1, lum = 0.24 }, { at = 0.6, lum = 0.76 }]";
    let cell = |zoom| Cell {
        model: "head.glb",
        hatch: hatch.to_owned(),
        options: camera(25.0, 6.0, zoom),
    };
    let cells = [0.4, 1.0, 2.5, 6.0].map(cell).into();
    Sheet { name: "near-far", cell: [300, 300], columns: 4, cells }
}

/// The presets `skin`, `cloth`, `metal`, `hair` and `glass`.
fn materials() -> Sheet {
    let cell = |preset| Cell {
        model: "teapot-on-box.glb",
        hatch: format!("preset = \"{preset}\""),
        options: camera(30.0, 20.0, 1.6),
    };
    let cells = ["skin", "cloth", "metal", "hair", "glass"].map(cell).into();
    Sheet { name: "materials", cell: [260, 220], columns: 5, cells }
}
