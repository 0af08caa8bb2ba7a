//! Wavefront OBJ with its MTL materials.
//!
//! Each object or group becomes a node with one primitive per material. Errors name the line.
//! The reader is our own: a face may lack normals or texture coordinates that its neighbours
//! have, any index may be hostile, and messages need line numbers.

mod material;
mod polygon;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::io;

use glam::{Vec2, Vec3, Vec4};

use super::warnings::{Warnings, quoted};
use super::{FARTHEST, Problem, files, normals, picture};
use crate::scene::{Mesh, Node, Primitive, Scene};
use material::Materials;

/// One corner of a face: indices of its position, texture coordinates and normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Corner {
    position: u32,
    uv: Option<u32>,
    normal: Option<u32>,
}

/// The faces of one material in one node.
struct Part {
    node: usize,
    material: Option<usize>,
    corners: Vec<Corner>,
    vertex_of: HashMap<Corner, u32>,
    indices: Vec<u32>,
}

/// What the file has said so far.
struct Reader<'a> {
    warnings: &'a mut Warnings,
    materials: Materials<'a>,
    positions: Vec<Vec3>,
    /// Linear; as long as `positions` once one vertex has a colour, else empty.
    colors: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// Names of the nodes in order of appearance.
    nodes: Vec<String>,
    node_of_name: HashMap<String, usize>,
    node: Option<usize>,
    material: Option<usize>,
    parts: Vec<Part>,
    /// The part of a node and material.
    part_of: HashMap<(usize, Option<usize>), usize>,
}

/// Reads an OBJ file.
pub(super) fn read(
    bytes: &[u8],
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    warnings: &mut Warnings,
) -> Result<Scene, Problem> {
    let mut reader = Reader {
        warnings,
        materials: Materials::new(files),
        positions: Vec::new(),
        colors: Vec::new(),
        uvs: Vec::new(),
        normals: Vec::new(),
        nodes: Vec::new(),
        node_of_name: HashMap::new(),
        node: None,
        material: None,
        parts: Vec::new(),
        part_of: HashMap::new(),
    };
    for_each_line(bytes, |number, line| {
        reader.statement(line).map_err(|why| Problem::invalid(format!("line {number}"), why))
    })?;
    reader.finish()
}

/// Calls `each` with the number and content of every line, without comments; a `\` at the end
/// of a line continues it.
fn for_each_line<E>(
    bytes: &[u8],
    mut each: impl FnMut(usize, &str) -> Result<(), E>,
) -> Result<(), E> {
    let mut continued = String::new();
    for (index, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        let text = String::from_utf8_lossy(line);
        if let Some(start) = text.strip_suffix('\\') {
            continued.push_str(start);
            continued.push(' ');
            continue;
        }
        let text = if continued.is_empty() {
            text
        } else {
            continued.push_str(&text);
            std::mem::take(&mut continued).into()
        };
        let text = text.split('#').next().unwrap_or("").trim();
        if !text.is_empty() {
            each(index + 1, text)?;
        }
    }
    Ok(())
}

/// The keyword of a statement and the rest.
fn split_keyword(line: &str) -> (&str, &str) {
    let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    (keyword, rest.trim())
}

/// Parses a coordinate.
fn number(word: &str) -> Result<f32, String> {
    match word.parse::<f32>() {
        Ok(number) if number.abs() <= FARTHEST => Ok(number),
        Ok(_) => Err(format!("{} is not finite or far too large", quoted(word))),
        Err(_) => Err(format!("{} is not a number", quoted(word))),
    }
}

/// Parses up to `N` numbers; those that are missing are 0.
///
/// # Errors
/// If there are fewer than `least` or one is no usable number.
fn numbers<const N: usize>(rest: &str, least: usize) -> Result<([f32; N], usize), String> {
    let mut result = [0.0; N];
    let mut count = 0;
    for (slot, word) in result.iter_mut().zip(rest.split_whitespace()) {
        *slot = number(word)?;
        count += 1;
    }
    if count < least {
        return Err(format!("there are {count} numbers where {least} are needed"));
    }
    Ok((result, count))
}

impl Reader<'_> {
    fn statement(&mut self, line: &str) -> Result<(), String> {
        let (keyword, rest) = split_keyword(line);
        match keyword {
            "v" => self.vertex(rest)?,
            "vt" => {
                let ([u, v], _) = numbers(rest, 1)?;
                // OBJ counts from the bottom of the picture.
                self.uvs.push(Vec2::new(u, 1.0 - v));
            }
            "vn" => {
                let (normal, _) = numbers::<3>(rest, 3)?;
                self.normals.push(Vec3::from(normal));
            }
            "f" => self.face(rest)?,
            "o" | "g" => {
                self.begin_node(rest);
            }
            "usemtl" => self.material = Some(self.materials.find_or_add(rest)),
            "mtllib" => self.materials.load_library(rest, self.warnings),
            "p" | "l" => {
                self.warnings.add("Points and lines cannot be drawn and are skipped.".to_owned());
            }
            "curv" | "curv2" | "surf" => {
                self.warnings.add("Free-form curves and surfaces are skipped.".to_owned());
            }
            // Smoothing groups, display attributes and unknown statements.
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        let ([x, y, z, r, g, b], count) = numbers::<6>(rest, 3)?;
        if count == 6 {
            self.colors.resize(self.positions.len(), Vec3::ONE);
            self.colors.push(material::linear_color(Vec3::new(r, g, b)));
        } else if !self.colors.is_empty() {
            self.colors.push(Vec3::ONE);
        }
        self.positions.push(Vec3::new(x, y, z));
        Ok(())
    }

    /// The node of that name, which the following faces belong to.
    fn begin_node(&mut self, name: &str) -> usize {
        let next = self.nodes.len();
        let node = *self.node_of_name.entry(name.to_owned()).or_insert(next);
        if node == next {
            self.nodes.push(if name.is_empty() { format!("node-{next}") } else { name.to_owned() });
        }
        self.node = Some(node);
        node
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let mut polygon = Vec::new();
        for word in rest.split_whitespace() {
            polygon.push(self.corner(word)?);
        }
        if polygon.len() < 3 {
            self.warnings.add("Faces with fewer than three corners are skipped.".to_owned());
            return Ok(());
        }
        let node = match self.node {
            Some(node) => node,
            None => self.begin_node(""),
        };
        let points: Vec<Vec3> = polygon
            .iter()
            .filter_map(|corner| self.positions.get(corner.position as usize).copied())
            .collect();
        let material = self.material;
        let next = self.parts.len();
        let index = *self.part_of.entry((node, material)).or_insert(next);
        if index == next {
            let (corners, vertex_of, indices) = (Vec::new(), HashMap::new(), Vec::new());
            self.parts.push(Part { node, material, corners, vertex_of, indices });
        }
        let Some(part) = self.parts.get_mut(index) else { return Ok(()) };
        for triangle in polygon::triangulate(&points) {
            let [a, b, c] = triangle.map(|at| polygon.get(at).map(|corner| part.vertex(*corner)));
            if let (Some(a), Some(b), Some(c)) = (a, b, c)
                && a != b
                && b != c
                && c != a
            {
                part.indices.extend([a, b, c]);
            }
        }
        Ok(())
    }

    /// Parses `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut words = word.split('/');
        let mut index = |count: usize, what: &str| match words.next() {
            None | Some("") => Ok(None),
            Some(text) => index(text, count, what).map(Some),
        };
        let position = index(self.positions.len(), "positions")?;
        Ok(Corner {
            position: position.ok_or_else(|| format!("{} has no position", quoted(word)))?,
            uv: index(self.uvs.len(), "texture coordinates")?,
            normal: index(self.normals.len(), "normals")?,
        })
    }

    fn finish(mut self) -> Result<Scene, Problem> {
        let mut scene = Scene::default();
        let mut primitives_of_node: Vec<Vec<Primitive>> = Vec::new();
        primitives_of_node.resize_with(self.nodes.len(), Vec::new);
        for part in std::mem::take(&mut self.parts) {
            if let Some(primitives) = primitives_of_node.get_mut(part.node)
                && !part.indices.is_empty()
            {
                primitives.push(self.primitive(part));
            }
        }
        let names = std::mem::take(&mut self.nodes);
        for (name, mut primitives) in names.into_iter().zip(primitives_of_node) {
            if primitives.is_empty() {
                continue;
            }
            normals::complete(&mut primitives);
            scene.roots.push(scene.nodes.len());
            let mesh = Some(scene.meshes.len());
            scene.nodes.push(Node { name: name.clone(), mesh, ..Node::default() });
            scene.meshes.push(Mesh { name, primitives, ..Mesh::default() });
        }
        if scene.meshes.is_empty() {
            self.warnings.add("The file has no faces; there is nothing to draw.".to_owned());
        }
        self.materials.finish(&mut scene, self.warnings);
        Ok(scene)
    }

    fn primitive(&self, part: Part) -> Primitive {
        let corners = &part.corners;
        let position = |corner: &Corner| self.positions.get(corner.position as usize);
        let uv = |corner: &Corner| self.uvs.get(corner.uv? as usize).copied();
        let normal = |corner: &Corner| self.normals.get(corner.normal? as usize).copied();
        let color = |corner: &Corner| self.colors.get(corner.position as usize);
        let has_uvs = corners.iter().any(|corner| corner.uv.is_some());
        let has_normals = corners.iter().any(|corner| corner.normal.is_some());
        Primitive {
            positions: corners.iter().map(|c| position(c).copied().unwrap_or_default()).collect(),
            // Zero normals are made smooth later.
            normals: if has_normals {
                corners.iter().map(|corner| normal(corner).unwrap_or_default()).collect()
            } else {
                Vec::new()
            },
            uvs: if has_uvs {
                vec![corners.iter().map(|corner| uv(corner).unwrap_or_default()).collect()]
            } else {
                Vec::new()
            },
            colors: if self.colors.is_empty() {
                Vec::new()
            } else {
                let color = |corner| color(corner).copied().unwrap_or(Vec3::ONE).extend(1.0);
                corners.iter().map(color).collect::<Vec<Vec4>>()
            },
            indices: part.indices,
            material: part.material,
            ..Primitive::default()
        }
    }
}

impl Part {
    /// The vertex for a corner; equal corners share one.
    fn vertex(&mut self, corner: Corner) -> u32 {
        let next = self.corners.len() as u32;
        let vertex = *self.vertex_of.entry(corner).or_insert(next);
        if vertex == next {
            self.corners.push(corner);
        }
        vertex
    }
}

/// An index of the file, which counts from 1 or, if negative, back from the newest, as ours.
fn index(text: &str, count: usize, what: &str) -> Result<u32, String> {
    let number: i64 =
        text.parse().map_err(|_| format!("{} is not a whole number", quoted(text)))?;
    let index =
        if number < 0 { number.checked_add_unsigned(count as u64) } else { Some(number - 1) };
    index
        .and_then(|index| usize::try_from(index).ok())
        .filter(|&index| index < count)
        .and_then(|index| u32::try_from(index).ok())
        .ok_or_else(|| {
            format!("index {number} is out of range, as there are {count} {what} so far")
        })
}
