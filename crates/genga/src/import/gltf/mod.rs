//! glTF 2.0.

mod accessor;
mod animation;
mod attributes;
mod buffers;
mod container;
mod document;
mod extensions;
mod material;
mod mesh;
mod node;
#[cfg(test)]
mod tests;

use std::cell::{Cell, RefCell};
use std::io;

use super::warnings::{Warnings, quoted};
use super::{Problem, normals, picture};
use crate::scene::Scene;
use buffers::Buffers;
use document::Document;

/// Geometry that any file may hold, and how much more per byte of the file.
const FREE_BYTES: u64 = 64 << 20;
const BYTES_PER_BYTE: u64 = 64;

/// A glTF file while it is being read.
struct GltfFile<'a> {
    document: Document,
    buffers: Buffers<'a>,
    warnings: RefCell<&'a mut Warnings>,
    /// Bytes of geometry that may still be made.
    budget: Cell<u64>,
    max_bytes: u64,
    files: &'a dyn Fn(&str) -> io::Result<Vec<u8>>,
}

impl GltfFile<'_> {
    fn warn(&self, sentence: String) {
        self.warnings.borrow_mut().add(sentence);
    }

    /// Takes memory from the budget before it is allocated.
    fn charge(&self, bytes: usize) -> Result<(), Problem> {
        let left = self.budget.get().checked_sub(bytes as u64);
        self.budget.set(left.ok_or(Problem::TooLarge(self.max_bytes >> 20))?);
        Ok(())
    }

    fn view(&self, index: usize) -> Result<&[u8], Problem> {
        self.buffers.view(&self.document, index)
    }
}

/// Reads a `.gltf` or `.glb` file.
pub(super) fn read(
    bytes: &[u8],
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    warnings: &mut Warnings,
) -> Result<Scene, Problem> {
    let (json, binary) = container::split(bytes)?;
    let document = document::parse(json)?;
    extensions::check(&document, warnings)?;
    let buffers = Buffers::read(&document, binary, files);
    let input = json.len() as u64 + buffers.total_bytes;
    let max_bytes = input.saturating_mul(BYTES_PER_BYTE).saturating_add(FREE_BYTES);
    let file = GltfFile {
        document,
        buffers,
        warnings: RefCell::new(warnings),
        budget: Cell::new(max_bytes),
        max_bytes,
        files,
    };
    let materials = material::read(&file);
    let mut scene = Scene {
        meshes: mesh::read(&file)?,
        materials: materials.materials,
        textures: materials.textures,
        images: materials.images,
        skins: node::read_skins(&file)?,
        cameras: node::read_cameras(&file),
        lights: node::read_lights(&file),
        ..Scene::default()
    };
    (scene.nodes, scene.roots) = node::read_nodes(&file, &scene)?;
    scene.clips = animation::read(&file, &scene)?;
    Ok(scene)
}

/// A thing of the file in messages: its kind, number and name.
fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} {}", quoted(name)),
        _ => format!("{kind} {index}"),
    }
}

/// The text with its first letter large, to begin a sentence.
fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map(|first| first.to_ascii_uppercase()).into_iter().chain(chars).collect()
}

/// Whether all numbers are finite and small enough to square without overflow.
fn usable(numbers: &[f32]) -> bool {
    numbers.iter().all(|number| number.abs() <= super::FARTHEST)
}
