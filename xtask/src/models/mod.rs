//! `cargo xtask models`: the project's own models, made by code.
//!
//! They are the same bytes on every run and every machine, are committed under
//! `assets/models/`, and are in the public domain (CC0).

mod glb;
mod head;
mod hero;
mod scenes;
mod sculpt;
mod teapot;

use std::fs;
use std::path::{Path, PathBuf};

use genga_shapes::smooth_object;

use crate::{Error, Result};

/// Where the models are, from the repository's root.
pub(crate) const FOLDER: &str = "assets/models";

/// A file's name and how it is made.
type Recipe = (&'static str, fn() -> glb::Model);

/// Every committed model. Each has a camera called `camera`, from which the gallery draws it.
const MODELS: [Recipe; 5] = [
    ("cube-before-plane.glb", scenes::cube_before_plane),
    ("head.glb", head::head),
    ("hero.glb", hero::hero),
    ("spheres-near-far.glb", scenes::spheres_near_far),
    ("teapot-on-box.glb", scenes::teapot_on_box),
];

/// Writes all models.
pub(crate) fn write(root: &Path) -> Result<()> {
    let folder = root.join(FOLDER);
    fs::create_dir_all(&folder).map_err(Error::io("cannot make the folder", &folder))?;
    for (name, make) in MODELS {
        let path = folder.join(name);
        let bytes = make().to_glb()?;
        fs::write(&path, &bytes).map_err(Error::io("cannot write", &path))?;
        println!("{} ({} KiB)", path.display(), bytes.len().div_ceil(1024));
    }
    Ok(())
}

/// Fails unless the committed models are what [`write()`] would write.
pub(crate) fn check(root: &Path) -> Result<()> {
    let mut stale = Vec::new();
    for (name, make) in MODELS {
        let path = root.join(FOLDER).join(name);
        if fs::read(&path).map_err(Error::io("cannot read", &path))? != make().to_glb()? {
            stale.push(name);
        }
    }
    if stale.is_empty() {
        println!("{FOLDER}: {} models are what the code makes", MODELS.len());
        return Ok(());
    }
    Err(Error::new(format!(
        "{} in {FOLDER} differ from what the code makes: run `cargo xtask models` and commit",
        stale.join(", ")
    )))
}

/// Writes a smooth object with exactly that many triangles.
pub(crate) fn write_bench_mesh(triangles: usize, path: &Path) -> Result<()> {
    let shape = smooth_object(triangles).map_err(|error| Error::new(error.to_string()))?;
    let mut model = glb::Model::new("smooth-object");
    let material = model.material("clay", 0xD9A46C, false);
    model.shape("object", &shape, material, glam::Vec3::ZERO);
    model.camera(glam::Vec3::new(1.6, 1.2, 4.2), glam::Vec3::ZERO, 30.0);
    model.sun(scenes::SUN);
    fs::write(path, model.to_glb()?).map_err(Error::io("cannot write", path))?;
    println!("{}: {} triangles, {} vertices", path.display(), triangles, shape.positions.len());
    Ok(())
}

/// The committed model files, sorted by name.
pub(crate) fn files(root: &Path) -> Result<Vec<PathBuf>> {
    crate::files_with_extension(&root.join(FOLDER), "glb")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn committed_models_are_fresh() {
        check(&crate::root()).unwrap();
        assert_eq!(files(&crate::root()).unwrap().len(), MODELS.len());
    }

    #[test]
    fn a_model_is_the_same_every_time() {
        for (name, make) in MODELS {
            assert_eq!(make().to_glb().unwrap(), make().to_glb().unwrap(), "{name}");
        }
    }

    /// Reads a GLB back as far as its accessors: every one must lie within the binary chunk, be
    /// aligned, and bound what it holds.
    #[test]
    fn accessors_are_aligned_bounded_and_in_range() {
        for (name, make) in MODELS {
            let glb = make().to_glb().unwrap();
            let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap());
            assert_eq!((word(0), word(4), word(8)), (0x4654_6C67, 2, glb.len() as u32), "{name}");
            let json_length = word(12) as usize;
            let binary = &glb[20 + json_length + 8..];
            assert_eq!(word(20 + json_length) as usize, binary.len());
            let document: serde_json::Value =
                serde_json::from_slice(&glb[20..20 + json_length]).unwrap();
            let number = |value: &serde_json::Value| value.as_u64().unwrap() as usize;
            for accessor in document["accessors"].as_array().unwrap() {
                let view = &document["bufferViews"][number(&accessor["bufferView"])];
                let (offset, length) = (number(&view["byteOffset"]), number(&view["byteLength"]));
                assert_eq!(offset % 4, 0);
                let bytes = &binary[offset..offset + length];
                let components = match accessor["type"].as_str().unwrap() {
                    "SCALAR" => 1,
                    "VEC2" => 2,
                    "VEC3" => 3,
                    "VEC4" => 4,
                    _ => 16,
                };
                let width = match number(&accessor["componentType"]) {
                    5121 => 1,
                    5123 => 2,
                    _ => 4,
                };
                assert_eq!(number(&accessor["count"]) * components * width, length);
                if let Some(min) = accessor["min"].as_array() {
                    let max = accessor["max"].as_array().unwrap();
                    for (i, float) in bytes.chunks_exact(4).enumerate() {
                        let value = f64::from(f32::from_le_bytes(float.try_into().unwrap()));
                        let bound =
                            |of: &[serde_json::Value]| of[i % components].as_f64().unwrap() as f32;
                        assert!(f64::from(bound(min)) <= value && value <= f64::from(bound(max)));
                    }
                }
            }
            for mesh in document["meshes"].as_array().unwrap() {
                for primitive in mesh["primitives"].as_array().unwrap() {
                    let at = |of: &serde_json::Value| &document["accessors"][number(of)];
                    let vertices = number(&at(&primitive["attributes"]["POSITION"])["count"]);
                    for attribute in primitive["attributes"].as_object().unwrap().values() {
                        assert_eq!(number(&at(attribute)["count"]), vertices);
                    }
                    let view =
                        &document["bufferViews"][number(&at(&primitive["indices"])["bufferView"])];
                    let offset = number(&view["byteOffset"]);
                    let length = number(&view["byteLength"]);
                    for index in binary[offset..offset + length].chunks_exact(2) {
                        assert!(usize::from(u16::from_le_bytes([index[0], index[1]])) < vertices);
                    }
                }
            }
        }
    }

    #[test]
    fn a_bench_mesh_has_its_triangles_and_odd_counts_are_refused() {
        let path =
            std::env::temp_dir().join(format!("genga-bench-mesh-{}.glb", std::process::id()));
        write_bench_mesh(9_566, &path).unwrap();
        let glb = fs::read(&path).unwrap();
        fs::remove_file(&path).unwrap();
        assert!(String::from_utf8_lossy(&glb).contains("\"count\":28698"));
        let error = write_bench_mesh(9_567, &path).unwrap_err();
        assert!(error.to_string().contains("9567"), "{error}");
    }
}
