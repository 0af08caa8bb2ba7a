//! Sheets: rows of pictures of one scene, each with a change or an option of `genga render`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Error, Result, process};

/// One picture of a sheet: a scene file's text, that of a style if it is not the scene's own, and
/// options of `genga render`.
pub(super) struct Cell {
    pub(super) scene: String,
    pub(super) style: Option<String>,
    pub(super) options: Vec<String>,
}

/// Rows of equal cells.
pub(super) struct Sheet {
    /// Of the picture, without its extension.
    pub(super) name: &'static str,
    /// Width and height of a cell in pixels.
    pub(super) cell: [u32; 2],
    pub(super) columns: usize,
    pub(super) cells: Vec<Cell>,
}

/// Draws sheets whose scenes' paths begin in the folder `beside`.
pub(super) fn draw(genga: &Path, sheets: &[Sheet], beside: &Path, folder: &Path) -> Result<()> {
    let parts = [".sheet.scene.toml", ".sheet.style.toml"].map(|name| beside.join(name));
    let drawn = sheets.iter().try_for_each(|sheet| draw_one(genga, sheet, &parts, folder));
    let written = parts.iter().filter(|part| part.is_file());
    let removed = written
        .map(|part| fs::remove_file(part).map_err(Error::io("cannot remove", part)))
        .collect::<Result<Vec<()>>>();
    drawn.and(removed.map(drop))
}

fn draw_one(genga: &Path, sheet: &Sheet, parts: &[PathBuf; 2], folder: &Path) -> Result<()> {
    let [part, style] = parts;
    let [width, height] = sheet.cell;
    let rows = sheet.cells.len().div_ceil(sheet.columns);
    let mut whole = image::RgbaImage::new(width * sheet.columns as u32, height * rows as u32);
    let file = folder.join(format!("{}.png", sheet.name));
    for (i, cell) in sheet.cells.iter().enumerate() {
        fs::write(part, &cell.scene).map_err(Error::io("cannot write", part))?;
        let mut render = Command::new(genga);
        render.args(["render", "--quiet"]).arg(part).args(["--size", &format!("{width}x{height}")]);
        if let Some(text) = &cell.style {
            fs::write(style, text).map_err(Error::io("cannot write", style))?;
            render.arg("--style").arg(style);
        }
        process::run(render.args(&cell.options).arg("--output").arg(&file))?;
        let wrong = |e: image::ImageError| Error::new(format!("{}: {e}", file.display()));
        let picture = image::open(&file).map_err(wrong)?.into_rgba8();
        let (column, row) = (i % sheet.columns, i / sheet.columns);
        let at = |index: usize, side: u32| i64::from(index as u32 * side);
        image::imageops::replace(&mut whole, &picture, at(column, width), at(row, height));
    }
    let wrong = |e: image::ImageError| Error::new(format!("{}: {e}", file.display()));
    let is_grey = whole.pixels().all(|p| p[0] == p[1] && p[1] == p[2]);
    let whole = image::DynamicImage::from(whole);
    if is_grey {
        return whole.into_luma8().save(&file).map_err(wrong);
    }
    whole.into_rgb8().save(&file).map_err(wrong)
}

/// The text of a scene file.
pub(super) fn read(folder: &Path, name: &str) -> Result<String> {
    let path = folder.join(name);
    fs::read_to_string(&path).map_err(Error::io("cannot read", &path))
}

/// A scene with other words at every place of some; it must have them.
pub(super) fn changed(scene: &str, from: &str, to: &str) -> Result<String> {
    if scene.contains(from) {
        Ok(scene.replace(from, to))
    } else {
        Err(Error::new(format!("the scene of the sheets has no '{from}' any more")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_must_find_its_words() {
        assert_eq!(changed("a b a", "a", "c").ok().as_deref(), Some("c b c"));
        assert!(changed("a b", "d", "c").is_err());
    }
}
