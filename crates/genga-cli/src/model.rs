use std::cell::RefCell;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use genga::import::{self, ImportError, Problem};
use genga::scene::Scene;

/// A model from a file.
pub(crate) struct Model {
    /// Everything in it.
    pub(crate) scene: Scene,
    /// What was left out or repaired.
    pub(crate) warnings: Vec<String>,
    /// The file and those that it refers to: none of them may be overwritten.
    pub(crate) files: Vec<PathBuf>,
}

/// Reads a model and remembers which files it came from.
pub(crate) fn load(path: &Path) -> Result<Model, ImportError> {
    let begin = Instant::now();
    let name = path.display().to_string();
    let bytes = read(path)
        .map_err(|error| ImportError { file: name.clone(), problem: Problem::Read(error) })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let files = RefCell::new(vec![path.to_owned()]);
    let mut imported = import::from_bytes(&name, &bytes, None, &|relative| {
        let path = folder.join(relative);
        let bytes = read(&path)?;
        files.borrow_mut().push(path);
        Ok(bytes)
    })?;
    imported.scene.name = display_name(path);
    log::info!(
        "read {name} in {:.0} ms: {} triangles, {} vertices",
        begin.elapsed().as_secs_f64() * 1e3,
        imported.scene.triangle_count(),
        imported.scene.vertex_count(),
    );
    Ok(Model { scene: imported.scene, warnings: imported.warnings, files: files.into_inner() })
}

/// The bytes of a regular file; devices and pipes need not end.
fn read(path: &Path) -> io::Result<Vec<u8>> {
    let meta = fs::metadata(path)?;
    if meta.is_dir() {
        return Err(io::Error::other("it is a folder"));
    }
    if !meta.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    fs::read(path)
}

/// A file's name without folder and endings: `shot.scene.toml` is `shot`.
pub(crate) fn display_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = match name.strip_suffix(".toml") {
        Some(stem) => stem.strip_suffix(".style").or(stem.strip_suffix(".scene")).unwrap_or(stem),
        None => name.rsplit_once('.').map_or(&*name, |(stem, _)| stem),
    };
    if stem.is_empty() { name.into_owned() } else { stem.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_folder_and_ending() {
        let name = |path: &str| display_name(Path::new(path));
        assert_eq!(name("a/b/Knight.glb"), "Knight");
        assert_eq!(name("shot.scene.toml"), "shot");
        assert_eq!(name("./ink.style.toml"), "ink");
        assert_eq!(name("v1.2.gltf"), "v1.2");
        assert_eq!(name("plain"), "plain");
        assert_eq!(name(".hidden"), ".hidden");
        assert_eq!(name(".style.toml"), ".style.toml");
    }
}
