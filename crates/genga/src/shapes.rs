//! Meshes made by formula, for benchmarks, tests and previews without files.

use crate::scene::{Mesh, Node, Primitive, Scene};
use genga_shapes::Shape;
use glam::{Vec2, Vec3};

pub use genga_shapes::CountError;

/// A box round the origin with flat faces; `size` is the full length along each axis in metres.
#[must_use]
pub fn cuboid(size: Vec3) -> Primitive {
    primitive(genga_shapes::cuboid(size))
}

/// A standing rectangle facing +Z round the origin; `size` is its width and height in metres.
#[must_use]
pub fn plane(size: Vec2) -> Primitive {
    primitive(genga_shapes::plane(size))
}

/// A ball round the origin: `segments` round the Y axis (3 to 4096), `rings` from pole to pole
/// (2 to 4096), `radius` in metres. It has `2 · segments · (rings − 1)` triangles.
#[must_use]
pub fn uv_sphere(segments: u32, rings: u32, radius: f32) -> Primitive {
    primitive(genga_shapes::uv_sphere(segments, rings, radius))
}

/// A bar round the Y axis with flat ends and sharp rims, its middle at the origin: `segments`
/// round the axis (3 to 4096), `radius` and `height` in metres.
#[must_use]
pub fn cylinder(segments: u32, radius: f32, height: f32) -> Primitive {
    primitive(genga_shapes::cylinder(segments, radius, height))
}

/// A smooth, closed, bumpy object about 2 m across with exactly that many triangles, which
/// share all of their `triangles / 2 + 2` vertices. Without texture coordinates.
///
/// # Errors
/// An odd number (no closed surface has one), fewer than 6 or more than 2³¹.
pub fn smooth_object(triangles: usize) -> Result<Primitive, CountError> {
    genga_shapes::smooth_object(triangles).map(primitive)
}

/// As [`smooth_object`], with exactly that many vertices and `2 · vertices − 4` triangles.
///
/// # Errors
/// Fewer than 5 vertices or more than 2³⁰ + 2.
pub fn smooth_object_with_vertices(vertices: usize) -> Result<Primitive, CountError> {
    genga_shapes::smooth_object_with_vertices(vertices).map(primitive)
}

/// A scene of one node with that primitive, both called `name`.
#[must_use]
pub fn scene_of(name: &str, primitive: Primitive) -> Scene {
    let name = name.to_owned();
    let node = Node { name: name.clone(), mesh: Some(0), ..Node::default() };
    let mesh = Mesh { name: name.clone(), primitives: vec![primitive], ..Mesh::default() };
    Scene { name, nodes: vec![node], roots: vec![0], meshes: vec![mesh], ..Scene::default() }
}

fn primitive(shape: Shape) -> Primitive {
    let Shape { positions, normals, uvs, indices } = shape;
    let uvs = if uvs.is_empty() { Vec::new() } else { vec![uvs] };
    Primitive { positions, normals, uvs, indices, ..Primitive::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_valid_scenes() {
        let shapes = [
            ("box", cuboid(Vec3::ONE)),
            ("plane", plane(Vec2::ONE)),
            ("ball", uv_sphere(12, 6, 1.0)),
            ("bar", cylinder(12, 1.0, 1.0)),
            ("object", smooth_object(960).unwrap()),
        ];
        for (name, primitive) in shapes {
            let scene = scene_of(name, primitive);
            assert_eq!(scene.validate(), Ok(()));
            assert!(scene.triangle_count() > 0);
        }
    }

    #[test]
    fn suzukis_workload_has_11098_vertices() {
        let scene = scene_of("object", smooth_object_with_vertices(11_098).unwrap());
        assert_eq!(scene.vertex_count(), 11_098);
    }
}
