//! Meshes: triangles from every mode, compacted, with normals.

use glam::Vec3;

use super::super::{FARTHEST, Problem};
use super::accessor::{Accessor, Shape};
use super::attributes::Attributes;
use super::document::{Int, Mesh as MeshItem, Primitive as Item};
use super::{GltfFile, capitalised, label, normals};
use crate::scene::{Mesh, MorphTarget, Primitive};

/// Reads all meshes.
pub(super) fn read(file: &GltfFile) -> Result<Vec<Mesh>, Problem> {
    let items = file.document.meshes.iter().enumerate();
    items.map(|(index, item)| read_mesh(file, index, item)).collect()
}

fn read_mesh(file: &GltfFile, index: usize, item: &MeshItem) -> Result<Mesh, Problem> {
    let mesh_label = label("mesh", index, item.name.as_deref());
    let mut primitives = Vec::new();
    for (i, primitive) in item.primitives.iter().enumerate() {
        let what = format!("{mesh_label}, primitive {i}");
        primitives.extend(read_primitive(file, &what, primitive)?);
    }
    normals::complete(&mut primitives);

    let count = primitives.iter().map(|p: &Primitive| p.morph_targets.len()).max().unwrap_or(0);
    if primitives.iter().any(|p| p.morph_targets.len() != count) {
        file.warn(format!(
            "The primitives of {mesh_label} have different numbers of morph targets."
        ));
    }
    file.charge(primitives.len().saturating_mul(count).saturating_mul(size_of::<MorphTarget>()))?;
    for primitive in &mut primitives {
        primitive.morph_targets.resize_with(count, MorphTarget::default);
    }
    let mut morph_weights = item.weights.clone();
    morph_weights.resize(count, 0.0);
    for weight in morph_weights.iter_mut().filter(|weight| !super::usable(&[**weight])) {
        *weight = 0.0;
    }
    let names = item.extras.get("targetNames").and_then(|names| names.as_array());
    let mut morph_names: Vec<String> = names
        .into_iter()
        .flatten()
        .take(count)
        .map(|name| name.as_str().unwrap_or_default().to_owned())
        .collect();
    if !morph_names.is_empty() {
        morph_names.resize(count, String::new());
    }
    Ok(Mesh { name: item.name.clone().unwrap_or_default(), primitives, morph_weights, morph_names })
}

/// Reads a primitive; `None`, with a warning, if nothing of it can be drawn.
fn read_primitive(file: &GltfFile, what: &str, item: &Item) -> Result<Option<Primitive>, Problem> {
    let mode = item.mode.map_or(4, |mode| mode.0);
    let skip = |why: &str| {
        file.warn(format!("{} is skipped: {why}.", capitalised(what)));
        Ok(None)
    };
    match mode {
        0 => return skip("points cannot be drawn"),
        1..=3 => return skip("lines cannot be drawn"),
        4..=6 => {}
        _ => return skip("its mode is unknown"),
    }
    let Some(&Int(position_accessor)) = item.attributes.get("POSITION") else {
        return skip("it has no positions");
    };
    let accessor = Accessor::of_shape(file, position_accessor, &[Shape::Vec3])?;
    let mut positions: Vec<Vec3> = accessor.floats();
    let vertices = positions.len();
    let corners = read_indices(file, what, item, vertices)?;
    if mode == 4 && corners.len() % 3 != 0 {
        file.warn(format!("The last triangle of {what} is incomplete and left out."));
    }
    let mut indices = triangles(mode, corners);

    // Triangles at impossible places go, the rest is drawn.
    let mut broken: Vec<bool> = Vec::new();
    if !positions.iter().all(|p| super::usable(&p.to_array())) {
        broken = positions.iter().map(|p| !super::usable(&p.to_array())).collect();
        for (position, _) in positions.iter_mut().zip(&broken).filter(|(_, broken)| **broken) {
            *position = Vec3::ZERO;
        }
    }
    keep_triangles(&mut indices, |[a, b, c]| a != b && b != c && c != a);
    let whole = indices.len();
    if !broken.is_empty() {
        let is_broken = |i: u32| broken.get(i as usize).copied().unwrap_or(true);
        keep_triangles(&mut indices, |t| !t.into_iter().any(is_broken));
    }
    let lost = (whole - indices.len()) / 3;
    if lost > 0 {
        file.warn(format!(
            "In {what}, {lost} triangles are left out: positions in accessor {position_accessor} are not finite or farther than {FARTHEST:e} m."
        ));
    }
    if indices.is_empty() {
        return skip("no triangle of it can be drawn");
    }

    let attributes = Attributes { file, what, accessors: &item.attributes, vertices };
    let (joints, weights) = attributes.influences()?;
    let mut primitive = Primitive {
        normals: attributes.normals()?,
        uvs: attributes.uvs()?,
        colors: attributes.colors()?,
        line_widths: attributes.line_widths()?,
        line_ids: attributes.line_ids()?,
        hatch_directions: attributes.hatch_directions()?,
        shade_biases: attributes.shade_biases()?,
        joints,
        weights,
        positions,
        indices,
        material: item.material.map(|material| material.0),
        morph_targets: Vec::new(),
    };
    for target in &item.targets {
        let attributes = Attributes { accessors: target, ..attributes };
        primitive.morph_targets.push(attributes.morph_target()?);
    }
    let materials = file.document.materials.len();
    if let Some(material) = primitive.material.filter(|&material| material >= materials) {
        file.warn(format!(
            "In {what}, material {material} does not exist; the default one is used."
        ));
        primitive.material = None;
    }
    remove_unused_vertices(&mut primitive);
    Ok(Some(primitive))
}

/// The indices of a primitive, known to be in range.
fn read_indices(
    file: &GltfFile,
    what: &str,
    item: &Item,
    vertices: usize,
) -> Result<Vec<u32>, Problem> {
    let Some(index) = item.indices else {
        file.charge(vertices.saturating_mul(4))?;
        let count = u32::try_from(vertices)
            .map_err(|_| Problem::invalid(what, "it has more than 2³² vertices"))?;
        return Ok((0..count).collect());
    };
    let accessor = Accessor::of_shape(file, index.0, &[Shape::Scalar])?;
    let invalid = |why: String| Problem::invalid(format!("{what}, accessor {}", index.0), why);
    let indices = accessor
        .integers()
        .ok_or_else(|| invalid("its indices must be unsigned whole numbers".to_owned()))?;
    match indices.iter().max() {
        Some(&max) if max as usize >= vertices => {
            Err(invalid(format!("it has index {max}, but there are only {vertices} vertices")))
        }
        _ => Ok(indices),
    }
}

/// The triangle list of a list (4), strip (5) or fan (6), wound as glTF 2.0, 3.7.2.1 says.
fn triangles(mode: usize, mut corners: Vec<u32>) -> Vec<u32> {
    match mode {
        5 => corners
            .windows(3)
            .enumerate()
            .flat_map(|(i, window)| match *window {
                [a, b, c] if i % 2 == 0 => [a, b, c],
                [a, b, c] => [a, c, b],
                _ => [0, 0, 0],
            })
            .collect(),
        6 => {
            let Some((&centre, rim)) = corners.split_first() else { return Vec::new() };
            let pairs = rim.windows(2);
            pairs.flat_map(|pair| pair.iter().copied().chain([centre])).collect()
        }
        _ => {
            corners.truncate(corners.len() / 3 * 3);
            corners
        }
    }
}

/// Keeps the triangles for which `keep` is true, in order.
fn keep_triangles(indices: &mut Vec<u32>, keep: impl Fn([u32; 3]) -> bool) {
    let (triangles, _) = indices.as_chunks::<3>();
    if triangles.iter().all(|&triangle| keep(triangle)) {
        return;
    }
    let kept: Vec<u32> = triangles.iter().filter(|t| keep(**t)).flatten().copied().collect();
    *indices = kept;
}

/// Removes vertices that no triangle uses. Many exporters share one large vertex buffer among
/// primitives, each of which would otherwise carry all of it.
fn remove_unused_vertices(primitive: &mut Primitive) {
    let mut used = vec![false; primitive.positions.len()];
    for &index in &primitive.indices {
        if let Some(used) = used.get_mut(index as usize) {
            *used = true;
        }
    }
    if used.iter().all(|&used| used) {
        return;
    }
    let mut next = 0;
    let new_index: Vec<u32> = used
        .iter()
        .map(|&used| {
            let this = next;
            next += u32::from(used);
            this
        })
        .collect();
    for index in &mut primitive.indices {
        *index = new_index.get(*index as usize).copied().unwrap_or(0);
    }
    retain(&mut primitive.positions, &used);
    retain(&mut primitive.normals, &used);
    primitive.uvs.iter_mut().for_each(|uvs| retain(uvs, &used));
    retain(&mut primitive.colors, &used);
    retain(&mut primitive.joints, &used);
    retain(&mut primitive.weights, &used);
    retain(&mut primitive.line_widths, &used);
    retain(&mut primitive.line_ids, &used);
    retain(&mut primitive.hatch_directions, &used);
    retain(&mut primitive.shade_biases, &used);
    for target in &mut primitive.morph_targets {
        retain(&mut target.positions, &used);
        retain(&mut target.normals, &used);
    }
}

fn retain<T>(elements: &mut Vec<T>, used: &[bool]) {
    let mut used = used.iter();
    elements.retain(|_| used.next().copied().unwrap_or(false));
    elements.shrink_to_fit();
}
