//! Reading models: glTF 2.0 (`.gltf`, `.glb`) and Wavefront OBJ into a [`Scene`].
//!
//! Importing is strict about what it cannot understand and forgiving about the rest: a broken
//! file is one [`ImportError`], while everything that can still be drawn without its missing
//! parts is drawn, with a sentence in [`Imported::warnings`].
//!
//! Every size that a file claims is checked against the bytes that are really there before
//! memory is taken, and all geometry together may not grow over 64 MiB plus 64 times the
//! file's own size.

mod error;
mod files;
mod gltf;
mod normals;
mod obj;
mod picture;
mod warnings;

use std::io;
use std::path::Path;

pub use error::{ImportError, Problem};
pub use files::no_files;

use crate::scene::{Material, Scene};
use warnings::Warnings;

/// Coordinates farther out, in metres, are taken for damage. Their squares still fit into 32-bit
/// floats.
const FARTHEST: f32 = 1e15;

/// A model that was read, and what was wrong with it.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model. It passes [`Scene::validate`].
    pub scene: Scene,
    /// One sentence each for what was left out or repaired, at most a few dozen.
    pub warnings: Vec<String>,
}

/// A kind of model file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// glTF 2.0, as text (`.gltf`) or binary (`.glb`).
    Gltf,
    /// Wavefront OBJ with MTL materials.
    Obj,
}

impl Format {
    /// The format that a file name's ending stands for.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let (_, ending) = name.rsplit_once('.')?;
        match ending.to_ascii_lowercase().as_str() {
            "gltf" | "glb" | "vrm" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            _ => None,
        }
    }

    /// The format that a file's first bytes look like.
    #[must_use]
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        if bytes.starts_with(b"glTF") || text.starts_with(b"{") {
            return Some(Self::Gltf);
        }
        let is_obj_line = |line: &[u8]| {
            [&b"v "[..], b"mtllib ", b"o ", b"g "].iter().any(|start| line.starts_with(start))
        };
        let mut lines = bytes.split(|&byte| byte == b'\n').take(100);
        lines.any(is_obj_line).then_some(Self::Obj)
    }
}

/// Reads a model file and the files that it refers to.
///
/// References are relative to the file's folder; `..` in them is followed, since game assets
/// share their textures that way, while absolute paths and URLs are refused.
///
/// # Errors
/// If the file or a needed part of it cannot be read or is broken.
pub fn load(path: &Path) -> Result<Imported, ImportError> {
    let file = path.display().to_string();
    let bytes = match files::read_file(path) {
        Ok(bytes) => bytes,
        Err(error) => return Err(ImportError { file, problem: Problem::Read(error) }),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    from_bytes(&file, &bytes, None, &|relative| files::read_file(&folder.join(relative)))
}

/// Reads a model from memory.
///
/// `name` is used in messages and for the scene's name and, by its ending, for the format if
/// `format` is `None`; an unknown ending is decided by the content. `files` gives the bytes of a
/// file that the model refers to by a relative path (see [`no_files`]).
///
/// # Errors
/// If the model or a needed part of it cannot be read or is broken.
pub fn from_bytes(
    name: &str,
    bytes: &[u8],
    format: Option<Format>,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Imported, ImportError> {
    let read = || {
        let format = format
            .or_else(|| Format::from_name(name))
            .or_else(|| Format::from_content(bytes))
            .ok_or(Problem::UnknownFormat)?;
        let mut warnings = Warnings::default();
        let mut scene = match format {
            Format::Gltf => gltf::read(bytes, files, &mut warnings)?,
            Format::Obj => obj::read(bytes, files, &mut warnings)?,
        };
        let stem = Path::new(name).file_stem();
        scene.name = stem.map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        warn_of_missing_uvs(&scene, &mut warnings);
        scene.validate()?;
        Ok(Imported { scene, warnings: warnings.into_sentences() })
    };
    read().map_err(|problem| ImportError { file: name.to_owned(), problem })
}

/// Warns of textures that cannot be placed, since the mesh lacks their coordinates.
fn warn_of_missing_uvs(scene: &Scene, warnings: &mut Warnings) {
    let uv_sets = |material: &Material| {
        let textures = [material.base_color_texture, material.emissive_texture];
        textures.into_iter().flatten().map(|texture| texture.uv_set)
    };
    for (index, mesh) in scene.meshes.iter().enumerate() {
        for primitive in &mesh.primitives {
            let material = primitive.material.and_then(|index| scene.materials.get(index));
            for set in material.into_iter().flat_map(uv_sets) {
                if primitive.uvs.get(set).is_none_or(Vec::is_empty) {
                    warnings.add(format!(
                        "Mesh {index} {} has no texture coordinates {set}, which its material uses.",
                        warnings::quoted(&mesh.name)
                    ));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLTF: &str = r#"{
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": 36, "uri": "parts/the%20data.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "nodes": [{ "mesh": 0 }]
    }"#;

    #[test]
    fn a_model_with_its_files_is_loaded_from_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("Figure.GLTF");
        std::fs::write(&path, GLTF).unwrap();
        let error = load(&path).unwrap_err().to_string();
        assert!(error.contains("Figure.GLTF: buffer 0: the file 'parts/the data.bin'"), "{error}");

        std::fs::create_dir(folder.path().join("parts")).unwrap();
        let positions: Vec<u8> = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        std::fs::write(folder.path().join("parts/the data.bin"), positions).unwrap();
        let imported = load(&path).unwrap();
        assert_eq!(imported.scene.name, "Figure");
        assert_eq!(imported.scene.triangle_count(), 1);
        assert_eq!(imported.warnings, [""; 0]);
    }

    #[test]
    fn missing_files_and_folders_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        assert!(load(folder.path()).unwrap_err().to_string().contains("cannot be read"));
        let missing = load(&folder.path().join("gone.glb")).unwrap_err();
        assert!(missing.to_string().contains("gone.glb: the file cannot be read"), "{missing}");
    }

    #[test]
    fn the_format_follows_the_ending_then_the_content() {
        assert_eq!(Format::from_name("a.b/C.GLB"), Some(Format::Gltf));
        assert_eq!(Format::from_name("a.obj"), Some(Format::Obj));
        assert_eq!(Format::from_name("a.fbx"), None);
        assert_eq!(Format::from_content(b"glTF\x02\0\0\0"), Some(Format::Gltf));
        assert_eq!(Format::from_content(b"\xef\xbb\xbf \n{"), Some(Format::Gltf));
        assert_eq!(Format::from_content(b"# by hand\nv 0 0 0\n"), Some(Format::Obj));
        assert_eq!(Format::from_content(b"Kaydara FBX Binary"), None);
        let error = from_bytes("empty", b"", None, &no_files).unwrap_err();
        assert!(matches!(error.problem, Problem::UnknownFormat), "{error}");
        // Text in a file that is called binary is read all the same.
        let json = br#"{ "asset": { "version": "2.0" } }"#;
        assert!(from_bytes("a.glb", json, None, &no_files).is_ok());
    }
}
