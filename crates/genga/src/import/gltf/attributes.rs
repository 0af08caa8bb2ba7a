//! Vertex attributes of one primitive, read and repaired.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3, Vec4};

use super::super::Problem;
use super::GltfFile;
use super::accessor::{Accessor, Shape};
use super::document::Int;
use crate::scene::MorphTarget;

/// Most sets of texture coordinates or influences that are read.
const MAX_SETS: usize = 16;

/// Joints and weights of each vertex.
pub(super) type Influences = (Vec<[u16; 4]>, Vec<[f32; 4]>);

/// The attributes of one primitive, with what is needed to speak about them.
pub(super) struct Attributes<'a, 'f> {
    pub(super) file: &'a GltfFile<'f>,
    /// Such as `mesh 2 'Arm', primitive 0`.
    pub(super) what: &'a str,
    pub(super) accessors: &'a BTreeMap<String, Int>,
    pub(super) vertices: usize,
}

impl<'a> Attributes<'a, '_> {
    /// An accessor, or `None` if the primitive lacks it or it has another number of elements.
    fn accessor(&self, name: &str, shapes: &[Shape]) -> Result<Option<Accessor<'a>>, Problem> {
        let Some(index) = self.accessors.get(name) else { return Ok(None) };
        let accessor = Accessor::of_shape(self.file, index.0, shapes)?;
        if accessor.count == self.vertices {
            return Ok(Some(accessor));
        }
        self.file.warn(format!(
            "In {}, {} has {} elements for {} vertices and is ignored.",
            self.what,
            super::quoted(name),
            accessor.count,
            self.vertices
        ));
        Ok(None)
    }

    fn warn_of_repair(&self, what: &str, count: usize, repair: &str) {
        if count > 0 {
            self.file.warn(format!("In {}, {count} {what} {repair}.", self.what));
        }
    }

    /// Normals as the file has them, or none. Some may still be zero or not finite.
    pub(super) fn normals(&self) -> Result<Vec<Vec3>, Problem> {
        let accessor = self.accessor("NORMAL", &[Shape::Vec3])?;
        Ok(accessor.map_or_else(Vec::new, |accessor| accessor.floats()))
    }

    /// All sets of texture coordinates.
    pub(super) fn uvs(&self) -> Result<Vec<Vec<Vec2>>, Problem> {
        let mut sets = Vec::new();
        for set in 0..MAX_SETS {
            let Some(accessor) = self.accessor(&format!("TEXCOORD_{set}"), &[Shape::Vec2])? else {
                continue;
            };
            let mut uvs: Vec<Vec2> = accessor.floats();
            let mut repaired = 0;
            for uv in uvs.iter_mut().filter(|uv| !uv.is_finite()) {
                *uv = Vec2::ZERO;
                repaired += 1;
            }
            self.warn_of_repair("texture coordinates", repaired, "are not finite and become 0");
            sets.resize(set, Vec::new());
            sets.push(uvs);
        }
        Ok(sets)
    }

    /// COLOR_0 in [0, 1].
    pub(super) fn colors(&self) -> Result<Vec<Vec4>, Problem> {
        let Some(accessor) = self.accessor("COLOR_0", &[Shape::Vec3, Shape::Vec4])? else {
            return Ok(Vec::new());
        };
        // Colours of whole numbers are always normalised, which some exporters forget to say.
        let accessor = accessor.normalized();
        let mut colors: Vec<Vec4> = if accessor.shape == Shape::Vec3 {
            accessor.floats::<Vec3>().into_iter().map(|color| color.extend(1.0)).collect()
        } else {
            accessor.floats()
        };
        for color in &mut colors {
            if color.is_nan() {
                *color = Vec4::ONE;
            }
            *color = color.clamp(Vec4::ZERO, Vec4::ONE);
        }
        Ok(colors)
    }

    /// `_LINE_WIDTH`, ≥ 0.
    pub(super) fn line_widths(&self) -> Result<Vec<f32>, Problem> {
        let Some(accessor) = self.accessor("_LINE_WIDTH", &[Shape::Scalar])? else {
            return Ok(Vec::new());
        };
        let mut widths: Vec<f32> = accessor.floats();
        for width in &mut widths {
            *width = if width.is_finite() { width.max(0.0) } else { 1.0 };
        }
        Ok(widths)
    }

    /// `_HATCH`: directions of strokes.
    pub(super) fn hatch_directions(&self) -> Result<Vec<Vec3>, Problem> {
        let Some(accessor) = self.accessor("_HATCH", &[Shape::Vec3])? else {
            return Ok(Vec::new());
        };
        let mut directions: Vec<Vec3> = accessor.floats();
        for direction in &mut directions {
            if !direction.is_finite() {
                *direction = Vec3::ZERO;
            }
        }
        Ok(directions)
    }

    /// `_LINE_ID`: whole numbers from 0 to 65535.
    pub(super) fn line_ids(&self) -> Result<Vec<u32>, Problem> {
        let Some(accessor) = self.accessor("_LINE_ID", &[Shape::Scalar])? else {
            return Ok(Vec::new());
        };
        // A float becomes an integer by saturation; NaN becomes 0.
        Ok(accessor.floats::<f32>().into_iter().map(|id| u32::from(id.round() as u16)).collect())
    }

    /// `_SHADE_BIAS` in [−1, 1], and `_SHADE_THRESHOLD` in [0, 1], which counts as 0.5 less it.
    pub(super) fn shade_biases(&self) -> Result<Vec<f32>, Problem> {
        let floats = |name: &str, neutral: f32| -> Result<Vec<f32>, Problem> {
            let Some(accessor) = self.accessor(name, &[Shape::Scalar])? else {
                return Ok(Vec::new());
            };
            let values: Vec<f32> = accessor.floats();
            let finite = |value: f32| if value.is_finite() { value } else { neutral };
            Ok(values.into_iter().map(finite).collect())
        };
        let mut biases = floats("_SHADE_BIAS", 0.0)?;
        let thresholds = floats("_SHADE_THRESHOLD", 0.5)?;
        biases.resize(biases.len().max(thresholds.len()), 0.0);
        for (bias, threshold) in biases.iter_mut().zip(thresholds) {
            *bias += 0.5 - threshold.clamp(0.0, 1.0);
        }
        biases.iter_mut().for_each(|bias| *bias = bias.clamp(-1.0, 1.0));
        Ok(biases)
    }

    /// The four strongest influences of each vertex over all sets; their weights add up to 1.
    pub(super) fn influences(&self) -> Result<Influences, Problem> {
        let mut sets: Vec<(Vec<u32>, Vec<[f32; 4]>)> = Vec::new();
        for set in 0..MAX_SETS {
            let joints = self.accessor(&format!("JOINTS_{set}"), &[Shape::Vec4])?;
            let weights = self.accessor(&format!("WEIGHTS_{set}"), &[Shape::Vec4])?;
            let (Some(joints), Some(weights)) = (joints, weights) else { continue };
            let Some(joints) = joints.integers() else {
                self.file.warn(format!(
                    "In {}, the joints are not whole numbers and are ignored.",
                    self.what
                ));
                continue;
            };
            sets.push((joints, weights.floats()));
        }
        let Some((_, first_weights)) = sets.first() else { return Ok(Default::default()) };

        let mut all_joints = Vec::with_capacity(first_weights.len());
        let mut all_weights = Vec::with_capacity(first_weights.len());
        let mut lost = 0;
        let mut influences: Vec<(u16, f32)> = Vec::new();
        for vertex in 0..self.vertices {
            influences.clear();
            for (joints, weights) in &sets {
                let joints = joints.iter().skip(vertex * 4).take(4);
                let weights = weights.get(vertex).into_iter().flatten();
                // Unused influences often name joints that do not exist.
                influences.extend(
                    joints
                        .zip(weights)
                        .filter(|(_, weight)| weight.is_finite() && **weight > 0.0)
                        .map(|(&joint, &weight)| {
                            (u16::try_from(joint).unwrap_or(u16::MAX), weight)
                        }),
                );
            }
            if influences.len() > 4 {
                // Stable, so that equal weights keep the file's order.
                influences.sort_by(|a, b| b.1.total_cmp(&a.1));
                influences.truncate(4);
                lost += 1;
            }
            let mut joints = [0; 4];
            let mut weights = [0.0; 4];
            for (slot, &(joint, weight)) in influences.iter().enumerate().take(4) {
                joints[slot] = joint;
                weights[slot] = weight;
            }
            let sum: f32 = weights.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                // A vertex that nothing holds would fall to the origin.
                joints = [joint_at(&sets, vertex), 0, 0, 0];
                weights = [1.0, 0.0, 0.0, 0.0];
            } else if (sum - 1.0).abs() > 1e-6 {
                weights = weights.map(|weight| weight / sum);
            }
            all_joints.push(joints);
            all_weights.push(weights);
        }
        self.warn_of_repair(
            "vertices",
            lost,
            "are held by more than four joints; the four strongest are kept",
        );
        Ok((all_joints, all_weights))
    }

    /// One morph target; what it lacks stays empty.
    pub(super) fn morph_target(&self) -> Result<MorphTarget, Problem> {
        let read = |name: &str| -> Result<Vec<Vec3>, Problem> {
            let Some(accessor) = self.accessor(name, &[Shape::Vec3])? else {
                return Ok(Vec::new());
            };
            let mut offsets: Vec<Vec3> = accessor.floats();
            let mut repaired = 0;
            for offset in offsets.iter_mut().filter(|o| !super::usable(&o.to_array())) {
                *offset = Vec3::ZERO;
                repaired += 1;
            }
            self.warn_of_repair("morph offsets", repaired, "are not usable and become 0");
            Ok(offsets)
        };
        Ok(MorphTarget { positions: read("POSITION")?, normals: read("NORMAL")? })
    }
}

/// The first joint that the file names for a vertex.
fn joint_at(sets: &[(Vec<u32>, Vec<[f32; 4]>)], vertex: usize) -> u16 {
    let joint = sets.first().and_then(|(joints, _)| joints.get(vertex * 4));
    joint.and_then(|&joint| u16::try_from(joint).ok()).unwrap_or(0)
}
