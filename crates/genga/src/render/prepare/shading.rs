//! Surfaces that are shaded by a proxy's normals or a keyed face shadow.

use std::sync::Arc;

use glam::{Affine3A, Mat3, Vec3, Vec4};

use super::highlights::{layer_of, normal_maps};
use crate::render::{
    generated::{self as gpu, LIGHT_DIRECTIONAL, LIGHT_SKY, Light},
    gpu::bindings,
};
use crate::scene::{Image, MAX_SHADINGS, Pose, Proxy, ProxyShape, Scene, Shading};

/// The shadings of a prepared scene.
pub(crate) struct Shadings {
    items: Vec<Shading>,
    world_from_node: Vec<Affine3A>,
    pub(crate) values: wgpu::Buffer,
    /// Normals of the meshes among the proxies, and which layer each shading has.
    pub(crate) normal_maps: wgpu::TextureView,
    layers: Vec<i32>,
}

/// The last shading that fits a surface, numbered from 0.
pub(crate) fn shading_of(
    scene: &Scene,
    node: usize,
    object: &str,
    material: &str,
) -> Option<usize> {
    let is_below = |top: usize| {
        let mut stack = vec![top];
        while let Some(index) = stack.pop() {
            if index == node {
                return true;
            }
            stack.extend(scene.nodes.get(index).into_iter().flat_map(|node| &node.children));
        }
        false
    };
    scene.shadings.iter().take(MAX_SHADINGS).rposition(|shading| {
        shading.objects.matches(object)
            && shading.materials.matches(material)
            && shading.under.is_none_or(is_below)
    })
}

impl Shadings {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Self {
        let none: gpu::Shading = bytemuck::Zeroable::zeroed();
        let usage = wgpu::BufferUsages::UNIFORM;
        let items: Vec<Shading> = scene.shadings.iter().take(MAX_SHADINGS).cloned().collect();
        let mut maps = Vec::new();
        let layer = |item| match item {
            &Shading { proxy: Some(ref proxy @ Proxy::Mesh { .. }), .. } => {
                layer_of(&mut maps, proxy) as i32
            }
            _ => -1,
        };
        let layers = items.iter().map(layer).collect();
        Self {
            normal_maps: normal_maps(device, queue, &maps),
            layers,
            items,
            world_from_node: vec![Affine3A::IDENTITY; scene.shadings.len().min(MAX_SHADINGS)],
            values: bindings::buffer(device, queue, "shadings", usage, &[none; MAX_SHADINGS]),
        }
    }

    /// Whether there are any.
    pub(crate) fn any(&self) -> bool {
        !self.items.is_empty()
    }

    /// Whether meshes are among the proxies.
    pub(crate) fn has_meshes(&self) -> bool {
        self.layers.iter().any(|&layer| layer >= 0)
    }

    /// The face shadow's picture of a shading.
    pub(crate) fn picture(scene: &Scene, shading: Option<usize>) -> Option<&Arc<Image>> {
        Some(&scene.shadings.get(shading?)?.face_shadow.as_ref()?.image)
    }

    /// Takes the places of the nodes from a pose.
    pub(crate) fn set_pose(&mut self, pose: &Pose) {
        for (slot, item) in self.world_from_node.iter_mut().zip(&self.items) {
            let node = item.node.and_then(|node| pose.world_from_node.get(node));
            *slot = node.copied().unwrap_or(Affine3A::IDENTITY);
        }
    }

    /// Writes them for the lights of a view.
    pub(crate) fn write(&self, queue: &wgpu::Queue, lights: &[Light]) {
        let values: Vec<gpu::Shading> = self
            .items
            .iter()
            .zip(&self.world_from_node)
            .zip(&self.layers)
            .map(|((item, world_from_node), &normal_map)| gpu::Shading {
                normal_map,
                ..values_of(item, world_from_node, lights.first())
            })
            .collect();
        queue.write_buffer(&self.values, 0, bytemuck::cast_slice(&values));
    }
}

fn values_of(item: &Shading, world_from_node: &Affine3A, light: Option<&Light>) -> gpu::Shading {
    let mut values: gpu::Shading = bytemuck::Zeroable::zeroed();
    if let Some(proxy) = &item.proxy {
        let shape = ProxyShape::new(proxy, world_from_node);
        let rows = shape.normals.transpose();
        values.center = shape.origin;
        values.amount = item.amount;
        values.axis = shape.axis;
        values.axis_length = shape.axis_length;
        values.normals_x = rows.x_axis.extend(shape.offset.x);
        values.normals_y = rows.y_axis.extend(shape.offset.y);
        values.normals_z = rows.z_axis.extend(shape.offset.z);
    }
    if let (Some(face), Some(light)) = (&item.face_shadow, light) {
        let to_light = match light.kind {
            LIGHT_DIRECTIONAL | LIGHT_SKY => light.direction.truncate(),
            _ => light.position.truncate() - Vec3::from(world_from_node.translation),
        };
        let (angle, is_right) = light_angle(world_from_node, to_light);
        let mirror = face.mirror_u.unwrap_or(-1.0);
        values.face = Vec4::new(angle, mirror, f32::from(u8::from(!is_right)), 1.0);
    }
    values
}

/// How far round a node's Y axis a light stands from the node's +Z, 0 in front to 1 behind, and whether
/// it is on the side of +X.
fn light_angle(world_from_node: &Affine3A, to_light: Vec3) -> (f32, bool) {
    let axes = Mat3::from(world_from_node.matrix3);
    let along = |axis: Vec3| axis.normalize_or_zero().dot(to_light);
    let yaw = along(axes.x_axis).atan2(along(axes.z_axis));
    (yaw.abs() / std::f32::consts::PI, yaw >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_of_a_light_turns_with_the_node() {
        let close = |(a, right): (f32, bool), (b, side): (f32, bool)| {
            assert!((a - b).abs() < 1e-6 && right == side, "{a}, {right}, not {b}, {side}");
        };
        let still = Affine3A::IDENTITY;
        close(light_angle(&still, Vec3::new(0.0, 0.7, 3.0)), (0.0, true));
        close(light_angle(&still, Vec3::new(2.0, -1.0, 0.0)), (0.5, true));
        close(light_angle(&still, Vec3::new(-2.0, 0.0, 2.0)), (0.25, false));
        let turned = Affine3A::from_rotation_y(std::f32::consts::FRAC_PI_2);
        close(light_angle(&turned, Vec3::Z), (0.5, false));
    }

    #[test]
    fn the_last_shading_that_fits_counts() {
        let globs = |glob: &str| crate::style::Globs::new([glob]).unwrap_or_default();
        let shading = |material: &str, under| Shading {
            materials: globs(material),
            under,
            ..Shading::default()
        };
        let scene = Scene {
            nodes: vec![Default::default(), Default::default()],
            shadings: vec![
                shading("skin*", None),
                shading("*", Some(1)),
                shading("skin-face", None),
            ],
            ..Scene::default()
        };
        assert_eq!(shading_of(&scene, 0, "", "skin-arm"), Some(0));
        assert_eq!(shading_of(&scene, 0, "", "skin-face"), Some(2));
        assert_eq!(shading_of(&scene, 0, "", "cloth"), None);
        assert_eq!(shading_of(&scene, 1, "", "cloth"), Some(1));
    }
}
