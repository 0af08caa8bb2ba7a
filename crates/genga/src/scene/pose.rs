use glam::{Affine3A, Quat, Vec3};

use super::{Channel, ChannelTarget, Interpolation, Scene, Transform};

/// Where every node stands at one moment, and how far its morph targets are applied.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// For each node of the scene, the matrix from its space to the world's.
    pub world_from_node: Vec<Affine3A>,
    /// For each node, the weights of its mesh's morph targets; empty without any.
    pub morph_weights: Vec<Vec<f32>>,
    /// For each node, whether it hangs under one of [`Scene::roots`] and so is drawn.
    pub visible: Vec<bool>,
}

impl Pose {
    /// The pose of the file itself, without a clip.
    #[must_use]
    pub fn rest(scene: &Scene) -> Self {
        Self::from_locals(scene, scene.nodes.iter().map(|node| node.transform).collect(), None)
    }

    /// The pose of a clip at a time in seconds. Before the first key and after the last one,
    /// that key holds. A clip index out of range gives the rest pose.
    #[must_use]
    pub fn at(scene: &Scene, clip: usize, time: f32) -> Self {
        let Some(clip) = scene.clips.get(clip) else { return Self::rest(scene) };
        let mut locals: Vec<Transform> = scene.nodes.iter().map(|node| node.transform).collect();
        let mut weights = vec![None; scene.nodes.len()];
        for channel in &clip.channels {
            let Some(value) = sample(channel, time) else { continue };
            if channel.node >= locals.len() {
                continue;
            }
            if let ChannelTarget::MorphWeights { .. } = channel.target {
                weights[channel.node] = Some(value);
                continue;
            }
            // A node given by a matrix is not animated (glTF 2.0, 5.25).
            let Transform::Parts { translation, rotation, scale } = &mut locals[channel.node]
            else {
                continue;
            };
            match channel.target {
                ChannelTarget::Translation => *translation = Vec3::from_slice(&value),
                ChannelTarget::Scale => *scale = Vec3::from_slice(&value),
                ChannelTarget::Rotation => {
                    let q = Quat::from_slice(&value);
                    if q.length_squared() > 1e-12 {
                        *rotation = q.normalize();
                    }
                }
                ChannelTarget::MorphWeights { .. } => {}
            }
        }
        Self::from_locals(scene, locals, Some(weights))
    }

    fn from_locals(
        scene: &Scene,
        locals: Vec<Transform>,
        weights: Option<Vec<Option<Vec<f32>>>>,
    ) -> Self {
        let n = scene.nodes.len();
        let mut world_from_node = vec![Affine3A::IDENTITY; n];
        let mut visible = vec![false; n];
        // Depth first; `placed` also stops a cycle that validation missed.
        let mut place = |roots: &mut dyn Iterator<Item = usize>, placed: &mut Vec<bool>| {
            let mut stack: Vec<_> = roots.map(|root| (root, Affine3A::IDENTITY)).collect();
            while let Some((index, world_from_parent)) = stack.pop() {
                let Some(placed) = placed.get_mut(index).filter(|placed| !**placed) else {
                    continue;
                };
                *placed = true;
                world_from_node[index] = world_from_parent * locals[index].parent_from_node();
                for &child in &scene.nodes[index].children {
                    stack.push((child, world_from_node[index]));
                }
            }
        };
        place(&mut scene.roots.iter().copied(), &mut visible);
        // Joints may stand outside of what is drawn.
        let parentless = |&index: &usize| scene.nodes[index].parent.is_none();
        place(&mut (0..n).filter(parentless), &mut visible.clone());
        let mut overrides = weights.unwrap_or_else(|| vec![None; n]);
        let morph_weights = (0..n)
            .map(|index| {
                let node = &scene.nodes[index];
                let Some(mesh) = node.mesh.and_then(|mesh| scene.meshes.get(mesh)) else {
                    return Vec::new();
                };
                let count = mesh.primitives.iter().map(|p| p.morph_targets.len()).max();
                let mut result = match overrides[index].take() {
                    Some(weights) => weights,
                    None if !node.morph_weights.is_empty() => node.morph_weights.clone(),
                    None => mesh.morph_weights.clone(),
                };
                result.resize(count.unwrap_or(0), 0.0);
                result
            })
            .collect();
        Self { world_from_node, morph_weights, visible }
    }

    /// For a node with a skin, the matrix of each joint that takes rest positions of the mesh
    /// to the world; `None` without a skin.
    ///
    /// A skinned mesh ignores its own node's transform (glTF 2.0, 3.7.3.3).
    #[must_use]
    pub fn world_from_rest(&self, scene: &Scene, node: usize) -> Option<Vec<Affine3A>> {
        let skin = scene.skins.get(scene.nodes.get(node)?.skin?)?;
        Some(
            skin.joints
                .iter()
                .zip(&skin.joint_from_mesh)
                .map(|(&joint, joint_from_mesh)| {
                    self.world_from_node.get(joint).copied().unwrap_or_default() * *joint_from_mesh
                })
                .collect(),
        )
    }
}

/// The value of a channel at `time`, or `None` if it has no usable keys.
fn sample(channel: &Channel, time: f32) -> Option<Vec<f32>> {
    let width = channel.target.width();
    let cubic = channel.interpolation == Interpolation::CubicSpline;
    let stride = if cubic { 3 * width } else { width };
    let keys = channel.times.len();
    if keys == 0 || width == 0 || channel.values.len() < keys * stride {
        return None;
    }
    let value_at = |key: usize| {
        let start = key * stride + if cubic { width } else { 0 };
        &channel.values[start..start + width]
    };
    let next = channel.times.partition_point(|&t| t <= time);
    if next == 0 {
        return Some(value_at(0).to_vec());
    }
    if next == keys {
        return Some(value_at(keys - 1).to_vec());
    }
    let (t0, t1) = (channel.times[next - 1], channel.times[next]);
    let dt = t1 - t0;
    let u = if dt > 0.0 { (time - t0) / dt } else { 0.0 };
    let (a, b) = (value_at(next - 1), value_at(next));
    Some(match channel.interpolation {
        Interpolation::Step => a.to_vec(),
        Interpolation::Linear if channel.target == ChannelTarget::Rotation => {
            // glTF asks for the shorter way; glam's slerp takes it.
            Quat::from_slice(a).slerp(Quat::from_slice(b), u).to_array().to_vec()
        }
        Interpolation::Linear => a.iter().zip(b).map(|(a, b)| a + (b - a) * u).collect(),
        Interpolation::CubicSpline => {
            let out_tangent = &channel.values[(next - 1) * stride + 2 * width..next * stride];
            let in_tangent = &channel.values[next * stride..next * stride + width];
            let (u2, u3) = (u * u, u * u * u);
            (0..width)
                .map(|i| {
                    (2.0 * u3 - 3.0 * u2 + 1.0) * a[i]
                        + dt * (u3 - 2.0 * u2 + u) * out_tangent[i]
                        + (3.0 * u2 - 2.0 * u3) * b[i]
                        + dt * (u3 - u2) * in_tangent[i]
                })
                .collect()
        }
    })
}
