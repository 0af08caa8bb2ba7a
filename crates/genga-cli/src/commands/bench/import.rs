use std::path::Path;
use std::time::Instant;

use genga::import;
use genga::scene::Primitive;
use genga::shapes;
use genga::style::Style;
use serde::Serialize;
use serde_json::json;

use super::milliseconds;
use super::sample::{Samples, Summary};
use crate::failure::{Failure, Outcome};
use crate::gpu::Graphics;
use crate::style_choice;

/// Reading a large file.
#[derive(Debug, Serialize)]
pub(super) struct ImportReport {
    pub(super) triangles: usize,
    pub(super) vertices: usize,
    pub(super) file_bytes: usize,
    pub(super) runs: usize,
    pub(super) steps: Vec<StepReport>,
}

#[derive(Debug, Serialize)]
pub(super) struct StepReport {
    pub(super) name: &'static str,
    #[serde(flatten)]
    pub(super) time: Summary,
}

/// A step with its times.
struct Step {
    name: &'static str,
    samples: Samples,
}

/// Writes a GLB of so many triangles to a temporary file, and times what happens to it.
pub(super) fn measure(
    triangles: usize,
    runs: usize,
    graphics: &Graphics,
    step: &mut dyn FnMut(usize),
) -> Outcome<ImportReport> {
    let primitive = shapes::smooth_object(triangles).map_err(Failure::message)?;
    let bytes = glb(&primitive)?;
    let vertices = primitive.positions.len();
    drop(primitive);
    let folder = tempfile::tempdir().map_err(|error| cannot_write(&error))?;
    let path = folder.path().join("smooth-object.glb");
    std::fs::write(&path, &bytes).map_err(|error| cannot_write(&error))?;
    let style = style_choice::find(style_choice::DEFAULT)?.style;

    let mut steps = Vec::new();
    // Large files take long; their times vary less.
    let runs = runs.div_ceil(5);
    for run in 0..runs {
        let mut next = 0;
        let mut add = |name, milliseconds| {
            if next == steps.len() {
                steps.push(Step { name, samples: Samples::default() });
            }
            if let Some(step) = steps.get_mut(next) {
                step.samples.push(milliseconds);
            }
            next += 1;
        };
        genga_steps(&path, &style, graphics, &mut add)?;
        #[cfg(feature = "bench-gltf")]
        gltf_steps(&path, &mut add)?;
        step((run + 1) * 5);
    }
    Ok(ImportReport {
        triangles,
        vertices,
        file_bytes: bytes.len(),
        runs,
        steps: steps
            .into_iter()
            .map(|step| StepReport { name: step.name, time: step.samples.summary() })
            .collect(),
    })
}

fn cannot_write(error: &std::io::Error) -> Failure {
    Failure::Message(format!(
        "cannot write the file to measure with: {}",
        crate::failure::reason(error)
    ))
}

fn genga_steps(
    path: &Path,
    style: &Style,
    graphics: &Graphics,
    add: &mut dyn FnMut(&'static str, f64),
) -> Outcome {
    let begin = Instant::now();
    let imported = import::load(path).map_err(Failure::message)?;
    add("load", milliseconds(begin.elapsed()));
    let begin = Instant::now();
    let prepared = graphics.renderer.prepare(&imported.scene, style);
    let prepared = graphics.check("the file to measure with", prepared)?;
    let waited = graphics.gpu.device.poll(wgpu::PollType::wait_indefinitely());
    waited.map_err(Failure::message)?;
    add("prepare", milliseconds(begin.elapsed()));
    drop(prepared);
    Ok(())
}

/// What the gltf crate needs for the same file: its parse alone, and with the attributes read into
/// vectors as an importer does.
#[cfg(feature = "bench-gltf")]
fn gltf_steps(path: &Path, add: &mut dyn FnMut(&'static str, f64)) -> Outcome {
    let begin = Instant::now();
    let bytes = std::fs::read(path).map_err(Failure::message)?;
    let gltf = gltf::Gltf::from_slice(&bytes).map_err(Failure::message)?;
    add("gltf crate: parse", milliseconds(begin.elapsed()));
    let blob = gltf.blob.as_deref();
    let mut numbers = 0;
    for primitive in gltf.meshes().flat_map(|mesh| mesh.primitives()) {
        let reader = primitive.reader(|_| blob);
        let positions: Vec<_> = reader.read_positions().into_iter().flatten().collect();
        let normals: Vec<_> = reader.read_normals().into_iter().flatten().collect();
        let indices: Vec<u32> =
            reader.read_indices().into_iter().flat_map(|indices| indices.into_u32()).collect();
        numbers += positions.len() + normals.len() + indices.len();
    }
    std::hint::black_box(numbers);
    add("gltf crate: parse and read", milliseconds(begin.elapsed()));
    Ok(())
}

/// The primitive as a binary glTF file.
fn glb(primitive: &Primitive) -> Outcome<Vec<u8>> {
    let mut binary: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    let mut view = |binary: &mut Vec<u8>, bytes: &mut dyn Iterator<Item = [u8; 4]>| {
        let start = binary.len();
        binary.extend(bytes.flatten());
        views.push(json!({
            "buffer": 0, "byteOffset": start, "byteLength": binary.len() - start
        }));
    };
    let floats = |vectors: &[glam::Vec3]| -> Vec<f32> {
        vectors.iter().flat_map(|vector| vector.to_array()).collect()
    };
    view(&mut binary, &mut floats(&primitive.positions).into_iter().map(f32::to_le_bytes));
    view(&mut binary, &mut floats(&primitive.normals).into_iter().map(f32::to_le_bytes));
    view(&mut binary, &mut primitive.indices.iter().map(|index| index.to_le_bytes()));
    let bounds = |pick: fn(glam::Vec3, glam::Vec3) -> glam::Vec3| {
        let bounds = primitive.positions.iter().copied().reduce(pick).unwrap_or_default();
        bounds.to_array()
    };
    let (vertices, indices) = (primitive.positions.len(), primitive.indices.len());
    let document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 0, "NORMAL": 1 }, "indices": 2
        }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
              "min": bounds(glam::Vec3::min), "max": bounds(glam::Vec3::max) },
            { "bufferView": 1, "componentType": 5126, "count": vertices, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5125, "count": indices, "type": "SCALAR" },
        ],
        "bufferViews": views,
        "buffers": [{ "byteLength": binary.len() }],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let size = |length: usize| {
        let length = u32::try_from(length);
        length.map_err(|_| Failure::Message("the file to measure with is too large".to_owned()))
    };
    let mut glb = Vec::with_capacity(28 + text.len() + binary.len());
    glb.extend(b"glTF");
    glb.extend(2_u32.to_le_bytes());
    glb.extend(size(28 + text.len() + binary.len())?.to_le_bytes());
    glb.extend(size(text.len())?.to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(text);
    glb.extend(size(binary.len())?.to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(binary);
    Ok(glb)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_holds_the_object() {
        let primitive = shapes::smooth_object(960).expect("an object");
        let bytes = glb(&primitive).expect("a file");
        let imported =
            import::from_bytes("a.glb", &bytes, None, &import::no_files).expect("a model");
        assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
        let read = &imported.scene.meshes[0].primitives[0];
        assert_eq!(read.positions, primitive.positions);
        assert_eq!(read.indices, primitive.indices);
    }
}
