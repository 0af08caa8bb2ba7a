use thiserror::Error;

use super::{Beam, HighlightError, Interpolation, MAX_BEAMS, MAX_WAVES, Scene, Wave, WaveMethod};

/// Why a scene cannot be drawn.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum SceneError {
    /// An index points past the end of what it refers to.
    #[error("{what} refers to {target} {index}, but there are only {count}")]
    OutOfRange {
        /// What refers, such as `node 3 'Arm'`.
        what: String,
        /// What it refers to, such as `mesh`.
        target: &'static str,
        /// The index.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A node is its own ancestor or has two parents.
    #[error(
        "node {index} '{name}' is reached twice from the scene's roots: the nodes must form a tree"
    )]
    NotATree {
        /// The node.
        index: usize,
        /// Its name.
        name: String,
    },
    /// A vertex attribute has not one element per vertex.
    #[error(
        "mesh '{mesh}' has {count} {attribute} for {vertices} vertices: there must be one each"
    )]
    AttributeLength {
        /// Name of the mesh.
        mesh: String,
        /// Name of the attribute.
        attribute: &'static str,
        /// Its length.
        count: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// The indices are not whole triangles.
    #[error("mesh '{mesh}' has {count} indices, which is not a multiple of three")]
    IncompleteTriangle {
        /// Name of the mesh.
        mesh: String,
        /// Number of indices.
        count: usize,
    },
    /// A picture's pixels do not fit its size.
    #[error(
        "image {index} '{name}' has {bytes} bytes for {width}×{height} pixels: there must be four each"
    )]
    ImageSize {
        /// The image.
        index: usize,
        /// Its name.
        name: String,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// Its length.
        bytes: usize,
    },
    /// The keys of a clip's channel cannot be played.
    #[error(
        "clip {index} '{name}' has a channel for node {node} whose times fall or are not finite, or that has not {width} values per key"
    )]
    Keys {
        /// The clip.
        index: usize,
        /// Its name.
        name: String,
        /// The channel's node.
        node: usize,
        /// Values per key.
        width: usize,
    },
    /// A shading cannot be used.
    #[error("shading {index} {problem}")]
    Shading {
        /// Index into [`Scene::shadings`].
        index: usize,
        /// What is wrong, as the end of a sentence.
        problem: String,
    },
    /// A highlight cannot be drawn.
    #[error(transparent)]
    Highlight(#[from] HighlightError),
    /// A coordinate is not a finite number.
    #[error("mesh '{mesh}' has a position that is not a finite number at vertex {vertex}")]
    NotFinite {
        /// Name of the mesh.
        mesh: String,
        /// The vertex.
        vertex: usize,
    },
    /// A wave cannot be drawn.
    #[error("wave {index} '{name}' {reason}")]
    Wave {
        /// The wave.
        index: usize,
        /// Its name.
        name: String,
        /// The rest of the sentence.
        reason: String,
    },
    /// More waves than can be drawn.
    #[error("there are {count} waves: at most {most} can be drawn, so join or remove some")]
    TooManyWaves {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A beam cannot be drawn.
    #[error("beam {index} '{name}' {reason}")]
    Beam {
        /// The beam.
        index: usize,
        /// Its name.
        name: String,
        /// The rest of the sentence.
        reason: String,
    },
    /// More beams than can be drawn.
    #[error("there are {count} beams: at most {most} can be drawn, so join or remove some")]
    TooManyBeams {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// The numbers of the waves' reference method.
    #[error(
        "the waves' reference method has {points} points and the thinning {thinning}: they must be 2 to 4000 and 1 to 64"
    )]
    WaveMethod {
        /// m.
        points: u32,
        /// n.
        thinning: u32,
    },
}

/// Checks an index, if there is one; `what` names who refers.
fn check(
    what: &dyn Fn() -> String,
    target: &'static str,
    index: Option<usize>,
    count: usize,
) -> Result<(), SceneError> {
    match index {
        Some(index) if index >= count => {
            Err(SceneError::OutOfRange { what: what(), target, index, count })
        }
        _ => Ok(()),
    }
}

/// Checks waves that may hold on to `nodes` nodes.
///
/// # Errors
/// The first thing that is wrong.
pub(crate) fn validate_waves(
    waves: &[Wave],
    method: WaveMethod,
    nodes: usize,
) -> Result<(), SceneError> {
    let (count, most) = (waves.len(), MAX_WAVES);
    if count > most {
        return Err(SceneError::TooManyWaves { count, most });
    }
    for (index, wave) in waves.iter().enumerate() {
        let wrong = |reason| SceneError::Wave { index, name: wave.name.clone(), reason };
        wave.check(nodes).map_err(wrong)?;
    }
    if let WaveMethod::Simpson { points, thinning, .. } = method
        && !((2..=4000).contains(&points) && (1..=64).contains(&thinning))
    {
        return Err(SceneError::WaveMethod { points, thinning });
    }
    Ok(())
}

/// Checks beams that may refer to `nodes` nodes.
///
/// # Errors
/// The first one that cannot be drawn.
pub(crate) fn validate_beams(beams: &[Beam], nodes: usize) -> Result<(), SceneError> {
    let (count, most) = (beams.len(), MAX_BEAMS);
    if count > most {
        return Err(SceneError::TooManyBeams { count, most });
    }
    for (index, beam) in beams.iter().enumerate() {
        let wrong = |reason| SceneError::Beam { index, name: beam.name.clone(), reason };
        beam.check(nodes).map_err(wrong)?;
    }
    Ok(())
}

impl Scene {
    /// Checks that every index is in range, every attribute complete and the nodes a forest.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn validate(&self) -> Result<(), SceneError> {
        validate_waves(&self.waves, self.wave_method, self.nodes.len())?;
        validate_beams(&self.beams, self.nodes.len())?;
        for (i, node) in self.nodes.iter().enumerate() {
            let what = || format!("node {i} '{}'", node.name);
            check(&what, "mesh", node.mesh, self.meshes.len())?;
            check(&what, "skin", node.skin, self.skins.len())?;
            check(&what, "camera", node.camera, self.cameras.len())?;
            check(&what, "light", node.light, self.lights.len())?;
            check(&what, "node", node.parent, self.nodes.len())?;
            for &child in &node.children {
                check(&what, "node", Some(child), self.nodes.len())?;
            }
        }
        self.validate_tree()?;
        for (i, skin) in self.skins.iter().enumerate() {
            let what = || format!("skin {i} '{}'", skin.name);
            for &joint in &skin.joints {
                check(&what, "node", Some(joint), self.nodes.len())?;
            }
            let count = skin.joint_from_mesh.len();
            check(&what, "inverse bind matrix", skin.joints.len().checked_sub(1), count)?;
        }
        for (index, image) in self.images.iter().enumerate() {
            let (width, height, bytes) = (image.width, image.height, image.rgba.len());
            if u64::from(width) * u64::from(height) * 4 != bytes as u64 || bytes == 0 {
                let name = image.name.clone();
                return Err(SceneError::ImageSize { index, name, width, height, bytes });
            }
        }
        for (i, texture) in self.textures.iter().enumerate() {
            check(&|| format!("texture {i}"), "image", texture.image, self.images.len())?;
        }
        for (i, material) in self.materials.iter().enumerate() {
            for texture in [&material.base_color_texture, &material.emissive_texture] {
                let index = texture.map(|t| t.texture);
                let what = || format!("material {i} '{}'", material.name);
                check(&what, "texture", index, self.textures.len())?;
            }
        }
        self.validate_meshes()?;
        for (i, clip) in self.clips.iter().enumerate() {
            for channel in &clip.channels {
                let what = || format!("clip {i} '{}'", clip.name);
                check(&what, "node", Some(channel.node), self.nodes.len())?;
                let cubic = channel.interpolation == Interpolation::CubicSpline;
                let width = channel.target.width() * if cubic { 3 } else { 1 };
                if !channel.times.is_sorted()
                    || !channel.times.iter().all(|time| time.is_finite())
                    || channel.values.len() != channel.times.len() * width
                {
                    let (name, node) = (clip.name.clone(), channel.node);
                    return Err(SceneError::Keys { index: i, name, node, width });
                }
            }
        }
        for (index, shading) in self.shadings.iter().enumerate() {
            let what = || format!("shading {index}");
            check(&what, "node", shading.node, self.nodes.len())?;
            check(&what, "node", shading.under, self.nodes.len())?;
            shading.validate().map_err(|problem| SceneError::Shading { index, problem })?;
        }
        for (index, highlight) in self.highlights.iter().enumerate() {
            highlight.validate(self.nodes.len()).map_err(|problem| {
                let name = highlight.name.clone();
                HighlightError { index, name, problem }
            })?;
        }
        Ok(())
    }

    fn validate_tree(&self) -> Result<(), SceneError> {
        let mut seen = vec![false; self.nodes.len()];
        let mut stack = self.roots.clone();
        while let Some(index) = stack.pop() {
            let count = self.nodes.len();
            let Some(node) = self.nodes.get(index) else {
                let what = "the scene".to_owned();
                return Err(SceneError::OutOfRange { what, target: "node", index, count });
            };
            if std::mem::replace(&mut seen[index], true) {
                return Err(SceneError::NotATree { index, name: node.name.clone() });
            }
            stack.extend(&node.children);
        }
        Ok(())
    }

    fn validate_meshes(&self) -> Result<(), SceneError> {
        let mut joint_counts = vec![usize::MAX; self.meshes.len()];
        for node in &self.nodes {
            if let (Some(mesh), Some(skin)) = (node.mesh, node.skin) {
                joint_counts[mesh] = joint_counts[mesh].min(self.skins[skin].joints.len());
            }
        }
        for (mesh, &joint_count) in self.meshes.iter().zip(&joint_counts) {
            for primitive in &mesh.primitives {
                let vertices = primitive.positions.len();
                let what = || format!("mesh '{}'", mesh.name);
                check(&what, "material", primitive.material, self.materials.len())?;
                check(
                    &what,
                    "vertex",
                    primitive.indices.iter().max().map(|&i| i as usize),
                    vertices,
                )?;
                if primitive.indices.len() % 3 != 0 {
                    let (mesh, count) = (mesh.name.clone(), primitive.indices.len());
                    return Err(SceneError::IncompleteTriangle { mesh, count });
                }
                let length = |attribute, count: usize, may_be_empty: bool| {
                    if count == vertices || (may_be_empty && count == 0) {
                        Ok(())
                    } else {
                        let mesh = mesh.name.clone();
                        Err(SceneError::AttributeLength { mesh, attribute, count, vertices })
                    }
                };
                length("normals", primitive.normals.len(), false)?;
                for uvs in &primitive.uvs {
                    length("texture coordinates", uvs.len(), true)?;
                }
                length("vertex colours", primitive.colors.len(), true)?;
                length("joints", primitive.joints.len(), true)?;
                length("joint weights", primitive.weights.len(), true)?;
                length("line widths", primitive.line_widths.len(), true)?;
                length("line ids", primitive.line_ids.len(), true)?;
                length("hatching directions", primitive.hatch_directions.len(), true)?;
                length("shade biases", primitive.shade_biases.len(), true)?;
                if primitive.joints.len() != primitive.weights.len() {
                    length("joint weights", primitive.weights.len(), false)?;
                }
                for target in &primitive.morph_targets {
                    length("morph positions", target.positions.len(), true)?;
                    length("morph normals", target.normals.len(), true)?;
                }
                if let Some(vertex) = primitive.positions.iter().position(|p| !p.is_finite()) {
                    return Err(SceneError::NotFinite { mesh: mesh.name.clone(), vertex });
                }
                if joint_count != usize::MAX {
                    let joint = primitive.joints.iter().flatten().max().map(|&j| j as usize);
                    check(&what, "joint", joint, joint_count)?;
                }
            }
        }
        Ok(())
    }
}
