//! `cargo xtask demo` and `cargo xtask gallery`: every preset on every model and scene.

mod beams;
mod face;
mod hatching;
mod highlights;
mod light;
mod lines;
mod sheet;
mod waves;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Error, Result, adapter, models, process};

/// Pictures for people who try the program, in `out/gallery`, with a page that shows them all.
pub(crate) fn demo(root: &Path) -> Result<()> {
    let folder = root.join("out/gallery");
    let pictures = draw(root, &folder, "960x540")?;
    let page = folder.join("index.html");
    fs::write(&page, contact_sheet(&pictures)).map_err(Error::io("cannot write", &page))?;
    println!("\n{} pictures are in {}", pictures.len(), folder.display());
    println!("All on one page: {}", page.display());
    Ok(())
}

/// What of the gallery is drawn anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Part {
    /// Every preset on every model and scene
    Presets,
    /// The sheets of lines
    Lines,
    /// The sheets of highlights
    Highlights,
    /// The sheets and showpieces of energy waves
    Waves,
    /// The sheets of hatching
    Hatching,
    /// The sheets of lights, ramps, comic highlights and print
    Light,
    /// The sheets and showpieces of beams and motion
    Beams,
}

/// The small pictures of README and gallery, in `assets/gallery`, which are committed: the named
/// parts of it, or all.
pub(crate) fn gallery(root: &Path, parts: &[Part]) -> Result<()> {
    let folder = root.join("assets/gallery");
    let wanted = |part| parts.is_empty() || parts.contains(&part);
    if wanted(Part::Presets) {
        draw(root, &folder, "480x270")?;
    }
    if wanted(Part::Lines) {
        lines::draw(root, &folder)?;
    }
    let genga = process::build(root, &["--release", "--package", "genga-cli"], "genga")?;
    adapter::ensure(&genga)?;
    if wanted(Part::Highlights) {
        highlights::draw(root, &genga, &folder)?;
    }
    if wanted(Part::Waves) {
        waves::draw(root, &genga, &folder)?;
    }
    if wanted(Part::Hatching) {
        hatching::draw(root, &genga, &folder)?;
    }
    if wanted(Part::Light) {
        light::draw(root, &genga, &folder)?;
    }
    if wanted(Part::Beams) {
        beams::draw(root, &genga, &folder)?;
    }
    println!("\nthe pictures are in {}", folder.display());
    Ok(())
}

/// A drawn picture.
struct Picture {
    subject: String,
    style: String,
    file: String,
}

/// The scene files in a folder, sorted by name; none if there is no such folder.
fn scenes(folder: &Path) -> Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut scenes = crate::files_with_extension(folder, "toml")?;
    scenes.retain(|file| name_of(file).ends_with(".scene.toml"));
    Ok(scenes)
}

/// Builds genga, finds something to draw with, and draws each subject in each preset.
fn draw(root: &Path, folder: &Path, size: &str) -> Result<Vec<Picture>> {
    let genga = process::build(root, &["--release", "--package", "genga-cli"], "genga")?;
    adapter::ensure(&genga)?;
    fs::create_dir_all(folder).map_err(Error::io("cannot make the folder", folder))?;
    let models = models::files(root)?;
    // Sheets show one model many times, turned or in motion, and have sizes of their own.
    let folders = [root.join("assets/scenes"), root.join("assets/scenes/sheets")];
    let [scenes, sheets] = [scenes(&folders[0])?, scenes(&folders[1])?];
    let styles = process::output(Command::new(&genga).arg("styles"))?;
    let mut pictures = Vec::new();
    for style in preset_names(&styles) {
        let template = folder.join(format!("{{model}}-{style}.png"));
        // Paths below the root, which are shorter to read.
        let short = |path: &Path| path.strip_prefix(root).unwrap_or(path).to_owned();
        let render = |subjects: &[PathBuf], more: &[&str]| {
            let mut render = Command::new(&genga);
            render.current_dir(root).args(["render", "--style", style]).args(more);
            render.arg("--output").arg(short(&template));
            process::run(render.args(subjects.iter().map(|path| short(path))))
        };
        // Each of our models has a camera of that name, which shows it as it is meant.
        render(&models, &["--camera", "camera", "--size", size])?;
        for (subjects, more) in [(&scenes, ["--size", size].as_slice()), (&sheets, &[])] {
            if !subjects.is_empty() {
                render(subjects, more)?;
            }
        }
        for subject in models.iter().chain(&scenes).chain(&sheets) {
            let subject = stem(subject);
            let file = format!("{subject}-{style}.png");
            if !folder.join(&file).is_file() {
                return Err(Error::new(format!("genga drew no {file} in {}", folder.display())));
            }
            pictures.push(Picture { subject, style: style.to_owned(), file });
        }
    }
    if pictures.is_empty() {
        return Err(Error::new("genga lists no styles, so there is nothing to draw"));
    }
    Ok(pictures)
}

/// `genga styles` prints a line per preset that starts with its name; descriptions may go on in
/// indented lines.
fn preset_names(listing: &str) -> impl Iterator<Item = &str> {
    listing
        .lines()
        .filter(|line| !line.starts_with(char::is_whitespace))
        .filter_map(|line| line.split_whitespace().next())
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The file's name up to its first dot, as `{model}` has it: `shot` for `shot.scene.toml`.
fn stem(path: &Path) -> String {
    let name = name_of(path);
    name.split('.').next().unwrap_or(&name).to_owned()
}

/// A page with a row for each subject and a column for each style.
fn contact_sheet(pictures: &[Picture]) -> String {
    let mut rows: Vec<&str> = pictures.iter().map(|picture| picture.subject.as_str()).collect();
    rows.sort_unstable();
    rows.dedup();
    let mut page = String::from(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Genga</title>\n\
         <style>\nbody { font: 16px sans-serif; margin: 2em; background: #f4f1ea }\n\
         section { display: flex; flex-wrap: wrap; gap: 1em }\nfigure { margin: 0 }\n\
         img { width: 480px; background: #fff }\n</style>\n<h1>Genga</h1>\n",
    );
    for row in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(page, "<h2>{row}</h2>\n<section>");
        for Picture { style, file, .. } in pictures.iter().filter(|p| p.subject == row) {
            let _ = writeln!(
                page,
                "<figure><a href=\"{file}\"><img src=\"{file}\" alt=\"{row} in {style}\"></a>\
                 <figcaption>{style}</figcaption></figure>"
            );
        }
        page.push_str("</section>\n");
    }
    page.push_str("</html>\n");
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_the_first_words_of_lines_that_are_not_indented() {
        let listing = "anime           Two tones\n                and more\n\nblueprint  Lines\n";
        assert_eq!(preset_names(listing).collect::<Vec<_>>(), ["anime", "blueprint"]);
    }

    #[test]
    fn a_subject_is_named_up_to_the_first_dot() {
        assert_eq!(stem(Path::new("assets/scenes/shot.scene.toml")), "shot");
        assert_eq!(stem(Path::new("assets/models/cube-before-plane.glb")), "cube-before-plane");
    }

    #[test]
    fn the_page_shows_every_picture_once() {
        let picture = |subject: &str, style: &str| Picture {
            subject: subject.to_owned(),
            style: style.to_owned(),
            file: format!("{subject}-{style}.png"),
        };
        let page = contact_sheet(&[
            picture("cube", "anime"),
            picture("teapot", "anime"),
            picture("cube", "blueprint"),
        ]);
        for file in ["cube-anime.png", "cube-blueprint.png", "teapot-anime.png"] {
            assert_eq!(page.matches(&format!("<img src=\"{file}\"")).count(), 1);
        }
        assert_eq!(page.matches("<h2>").count(), 2);
    }
}
