//! Tests of the glTF reader on small files made in code.

mod bad_input;
mod geometry;
mod look;
mod mutation;
mod scene;

use serde_json::{Value, json};

use crate::import::{Imported, Problem, from_bytes, no_files};
use crate::scene::Primitive;

const F32: u32 = 5126;
const U32: u32 = 5125;
const U16: u32 = 5123;
const I16: u32 = 5122;
const U8: u32 = 5121;
const I8: u32 = 5120;

/// Makes GLB files.
struct Glb {
    json: Value,
    binary: Vec<u8>,
}

impl Glb {
    fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "buffers": [], "bufferViews": [], "accessors": [], "meshes": [], "nodes": [],
        });
        Self { json, binary: Vec::new() }
    }

    /// One triangle in the plane z = 0 on one node.
    fn triangle() -> Self {
        let mut glb = Self::new();
        let positions = glb.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        glb.mesh(json!({ "attributes": { "POSITION": positions } }));
        glb
    }

    /// Appends to a list of the document and gives the index.
    fn push(&mut self, list: &str, item: Value) -> usize {
        let root = self.json.as_object_mut().unwrap();
        let list = root.entry(list).or_insert(json!([])).as_array_mut().unwrap();
        list.push(item);
        list.len() - 1
    }

    /// A buffer view with these bytes.
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let offset = self.binary.len();
        self.binary.extend(bytes);
        let length = bytes.len();
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": length }))
    }

    /// An accessor of its own buffer view.
    fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor = json!({
            "bufferView": view, "componentType": component, "type": shape, "count": count,
        });
        self.push("accessors", accessor)
    }

    fn floats(&mut self, shape: &str, numbers: &[f32]) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor(&bytes, F32, shape, numbers.len() / width)
    }

    fn shorts(&mut self, shape: &str, width: usize, numbers: &[u16]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.accessor(&bytes, U16, shape, numbers.len() / width)
    }

    /// A mesh of one primitive with a node that shows it.
    fn mesh(&mut self, primitive: Value) {
        let mesh = self.push("meshes", json!({ "primitives": [primitive] }));
        self.push("nodes", json!({ "mesh": mesh }));
    }

    fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"].as_array().is_some_and(Vec::is_empty) && !self.binary.is_empty() {
            json["buffers"] = json!([{ "byteLength": self.binary.len() }]);
        }
        glb(&serde_json::to_vec(&json).unwrap(), &self.binary)
    }

    fn read(&self) -> Result<Imported, Problem> {
        read(&self.bytes())
    }

    /// The file as it must be: readable and without warnings.
    fn imported(&self) -> Imported {
        let imported = self.read().unwrap();
        assert_eq!(imported.warnings, [""; 0]);
        imported
    }

    /// The only primitive of a file without warnings.
    fn primitive(&self) -> Primitive {
        self.imported().scene.meshes.remove(0).primitives.remove(0)
    }

    /// The only warning of a file that can be read.
    fn warning(&self) -> String {
        let imported = self.read().unwrap();
        let [warning] = imported.warnings.as_slice() else { panic!("{:?}", imported.warnings) };
        warning.clone()
    }

    /// The message about a file that cannot be read.
    fn error(&self) -> String {
        self.read().unwrap_err().to_string()
    }
}

/// A GLB file of these chunks.
fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let mut chunks = Vec::new();
    for (kind, chunk, padding) in [(b"JSON", json, b' '), (b"BIN\0", binary, 0)] {
        let length = chunk.len().next_multiple_of(4);
        chunks.extend((length as u32).to_le_bytes());
        chunks.extend(kind);
        chunks.extend(chunk);
        chunks.resize(chunks.len() + length - chunk.len(), padding);
    }
    let mut bytes = b"glTF".to_vec();
    bytes.extend(2_u32.to_le_bytes());
    bytes.extend((chunks.len() as u32 + 12).to_le_bytes());
    bytes.extend(chunks);
    bytes
}

fn read(bytes: &[u8]) -> Result<Imported, Problem> {
    from_bytes("test.glb", bytes, None, &no_files).map_err(|error| error.problem)
}
