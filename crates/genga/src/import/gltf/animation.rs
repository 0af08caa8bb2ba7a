//! Animation clips.

use glam::Quat;

use super::super::Problem;
use super::accessor::{Accessor, Shape};
use super::document::{Animation, AnimationChannel};
use super::{GltfFile, label, usable};
use crate::scene::{Channel, ChannelTarget, Clip, Interpolation, Scene};

/// Reads all clips. Channels that cannot be played are left out with a warning.
pub(super) fn read(file: &GltfFile, scene: &Scene) -> Result<Vec<Clip>, Problem> {
    let items = file.document.animations.iter().enumerate();
    items.map(|(index, item)| read_clip(file, scene, index, item)).collect()
}

fn read_clip(
    file: &GltfFile,
    scene: &Scene,
    index: usize,
    item: &Animation,
) -> Result<Clip, Problem> {
    let what = label("animation", index, item.name.as_deref());
    let mut channels = Vec::with_capacity(item.channels.len());
    for channel in &item.channels {
        match read_channel(file, scene, item, channel)? {
            Ok(channel) => channels.push(channel),
            Err(why) => file.warn(format!("A channel of {what} is left out: {why}.")),
        }
    }
    let name = match &item.name {
        Some(name) if !name.is_empty() => name.clone(),
        _ => format!("clip-{index}"),
    };
    Ok(Clip { name, channels })
}

/// A channel, or why it cannot be played.
fn read_channel(
    file: &GltfFile,
    scene: &Scene,
    animation: &Animation,
    item: &AnimationChannel,
) -> Result<Result<Channel, &'static str>, Problem> {
    let Some(node) = item.target.node.map(|node| node.0) else {
        return Ok(Err("it moves no node"));
    };
    let Some(scene_node) = scene.nodes.get(node) else {
        return Ok(Err("its node does not exist"));
    };
    let target = match item.target.path.as_str() {
        "translation" => ChannelTarget::Translation,
        "rotation" => ChannelTarget::Rotation,
        "scale" => ChannelTarget::Scale,
        "weights" => {
            let mesh = scene_node.mesh.and_then(|mesh| scene.meshes.get(mesh));
            let count = mesh.map_or(0, |mesh| mesh.morph_weights.len());
            if count == 0 {
                return Ok(Err("it moves morph targets that its node does not have"));
            }
            ChannelTarget::MorphWeights { count }
        }
        _ => return Ok(Err("what it moves is not supported")),
    };
    let Some(sampler) = animation.samplers.get(item.sampler.0) else {
        return Ok(Err("its sampler does not exist"));
    };
    let interpolation = match sampler.interpolation.as_deref() {
        None | Some("LINEAR") => Interpolation::Linear,
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::CubicSpline,
        Some(_) => return Ok(Err("its interpolation is unknown")),
    };
    let shape = match target {
        ChannelTarget::Rotation => Shape::Vec4,
        ChannelTarget::MorphWeights { .. } => Shape::Scalar,
        ChannelTarget::Translation | ChannelTarget::Scale => Shape::Vec3,
    };
    let times = Accessor::of_shape(file, sampler.input.0, &[Shape::Scalar])?.floats::<f32>();
    let output = Accessor::of_shape(file, sampler.output.0, &[shape])?;
    let numbers = output.count.saturating_mul(shape.width());
    let values_per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let wanted = times.len().saturating_mul(target.width()).saturating_mul(values_per_key);
    if times.is_empty() {
        return Ok(Err("it has no keys"));
    }
    if numbers < wanted {
        return Ok(Err("it has fewer values than its keys need"));
    }
    if !usable(&times) || !times.is_sorted() {
        return Ok(Err("its key times do not rise or are not finite"));
    }
    let mut values = output.floats::<f32>();
    values.truncate(wanted);
    if !usable(&values) {
        return Ok(Err("some of its values are not finite"));
    }
    if target == ChannelTarget::Rotation && interpolation != Interpolation::CubicSpline {
        for value in values.as_chunks_mut::<4>().0 {
            let rotation = Quat::from_array(*value);
            // Exact ones stay as they are; quantised ones are a little off.
            if (rotation.length_squared() - 1.0).abs() > 1e-6 {
                let is_zero = rotation.length_squared() < 1e-12;
                let unit = if is_zero { Quat::IDENTITY } else { rotation.normalize() };
                *value = unit.to_array();
            }
        }
    }
    Ok(Ok(Channel { node, target, interpolation, times, values }))
}
