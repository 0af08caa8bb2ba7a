use std::fmt::Display;
use std::path::{Path, PathBuf};

use super::beam_place::Moving;
use super::highlight_place::Instance;
use super::merge::Merged;
use super::{
    CameraEntry, ClipEntry, Located, ModelEntry, NodeNames, SceneCamera, SceneFile, WaveEntry,
};
use crate::FileError;
use crate::scene::{Node, Pose, Scene, Wave, WaveMethod, WavePlacement};
use crate::toml_file::nearest;

/// A scene file with all its models, as one posed scene.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The models, each under a node of its own, the lights and the waves.
    pub scene: Scene,
    /// Where everything stands, each model posed by its own clip and time.
    pub pose: Pose,
    /// The camera that the file asks for.
    pub camera: Option<SceneCamera>,
    /// One sentence each for what is probably a mistake.
    pub warnings: Vec<String>,
}

impl SceneFile {
    /// Opens the models with `load` (each file once) and puts everything together. The errors of
    /// `load` should name the file.
    ///
    /// # Errors
    /// A model cannot be loaded or is not valid, or has no such clip or camera; shown at its
    /// place in the file.
    pub fn assemble<E: Display>(
        &self,
        mut load: impl FnMut(&Path) -> Result<Scene, E>,
    ) -> Result<Assembled, FileError> {
        let mut files: Vec<(PathBuf, Scene)> = Vec::new();
        let mut instances = Vec::new();
        let mut warnings = Vec::new();
        for model in &self.models {
            let path = self.resolve(&model.file);
            let file = match files.iter().position(|(known, _)| *known == path) {
                Some(file) => file,
                None => {
                    let scene = self.load_model(model, &path, &mut load)?;
                    files.push((path, scene));
                    files.len() - 1
                }
            };
            let Some((_, scene)) = files.get(file) else { continue };
            let pose = self.pose(model, scene)?;
            let (hidden, matched) = hidden_nodes(model, scene);
            if !matched {
                warnings.push(self.warning(&model.hide, "'hide' fits no node of the model"));
            }
            instances.push((model, file, pose, hidden));
        }
        let mut merged = Merged::new(self.name());
        let offsets: Vec<_> = files.iter_mut().map(|(_, scene)| merged.add_shared(scene)).collect();
        let mut placed = Vec::new();
        let mut moving = Vec::new();
        for (model, file, pose, hidden) in instances {
            let (Some((_, scene)), Some(offsets)) = (files.get(file), offsets.get(file)) else {
                continue;
            };
            let (name, transform) = (model.node_name(), model.transform());
            let meshes = scene.nodes.iter().map(|node| node.mesh.map(|m| m + offsets.meshes));
            let (meshes, known_as) = (meshes.collect(), name.clone());
            let top = merged.add_instance(scene, *offsets, pose, &hidden, name, transform);
            moving.push(Moving { model, scene, top });
            placed.push(Instance { name: known_as, top, meshes });
        }
        for entry in &self.lights {
            let light = Some(merged.scene.lights.len());
            merged.scene.lights.push(entry.light.clone());
            let name = entry.light.name.clone();
            let node = Node { name, transform: entry.transform, light, ..Node::default() };
            match &entry.node {
                None => drop(merged.add_node(node)),
                Some(at) => {
                    let parent = self.node_named(at, at, &merged.scene)?;
                    merged.add_child(parent, node);
                }
            }
        }
        for entry in &self.waves {
            let wave = self.placed_wave(entry, &merged.scene)?;
            merged.scene.waves.push(wave);
        }
        for entry in &self.beams {
            let beam = self.placed_beam(entry, &merged.scene, &moving)?;
            merged.scene.beams.push(beam);
        }
        merged.scene.wave_method = self.wave_reference.map_or(WaveMethod::Exact, WaveMethod::from);
        let camera = match &self.camera {
            None => None,
            Some(CameraEntry::Orbit(orbit)) => Some(SceneCamera::Orbit(*orbit)),
            Some(CameraEntry::Placed(placed)) => Some(SceneCamera::Placed(*placed)),
            Some(CameraEntry::Node(name)) => Some(self.camera_node(name, &merged.scene)?),
        };
        merged.scene.shadings = self.place_shadings(&merged.scene, &placed)?;
        merged.scene.highlights = self.place_highlights(&merged.scene, &placed)?;
        Ok(Assembled { scene: merged.scene, pose: merged.pose, camera, warnings })
    }

    fn load_model<E: Display>(
        &self,
        model: &ModelEntry,
        path: &Path,
        load: &mut impl FnMut(&Path) -> Result<Scene, E>,
    ) -> Result<Scene, FileError> {
        // What `load` says names the file.
        let wrong = |e: String| self.error(&model.file, format!("cannot use this model: {e}"));
        let scene = load(path).map_err(|e| wrong(e.to_string()))?;
        scene.validate().map_err(|e| wrong(format!("{}: {e}", path.display())))?;
        Ok(scene)
    }

    fn pose(&self, model: &ModelEntry, scene: &Scene) -> Result<Pose, FileError> {
        self.pose_before(model, scene, 0.0)
    }

    /// A model's pose some seconds before its moment.
    pub(super) fn pose_before(
        &self,
        model: &ModelEntry,
        scene: &Scene,
        seconds: f32,
    ) -> Result<Pose, FileError> {
        let Some(clip) = &model.clip else { return Ok(Pose::rest(scene)) };
        let index = match &**clip {
            ClipEntry::Name(name) => scene.find_clip(name),
            ClipEntry::Index(index) => {
                usize::try_from(*index).ok().filter(|index| *index < scene.clips.len())
            }
        };
        index.map(|index| Pose::at(scene, index, model.time - seconds)).ok_or_else(|| {
            let names: Vec<&str> = scene.clips.iter().map(|clip| clip.name.as_str()).collect();
            let message = match &**clip {
                ClipEntry::Name(name) => not_there("clip", name, &names),
                ClipEntry::Index(index) => {
                    format!("there is no clip {index}: the model has {}", names.len())
                }
            };
            self.error(clip, message)
        })
    }

    /// A wave at its moment, with the nodes that it holds on to.
    fn placed_wave(&self, entry: &WaveEntry, scene: &Scene) -> Result<Wave, FileError> {
        let nodes = |names: &Option<Located<NodeNames>>| match names {
            None => Ok(Vec::new()),
            Some(at) => at.names().iter().map(|name| self.node(at, name, scene)).collect(),
        };
        let mut wave = entry.wave.clone();
        let (from_nodes, to_nodes): (Vec<usize>, Vec<usize>) =
            (nodes(&entry.from_nodes)?, nodes(&entry.to_nodes)?);
        match &mut wave.placement {
            WavePlacement::At { anchor, .. } => anchor.nodes = from_nodes,
            WavePlacement::Between { from, to, .. } => {
                from.nodes = from_nodes;
                to.nodes = to_nodes;
            }
        }
        Ok(entry.motion.at(&wave, entry.time))
    }

    pub(super) fn node(
        &self,
        at: &Located<NodeNames>,
        name: &str,
        scene: &Scene,
    ) -> Result<usize, FileError> {
        self.node_named(at, name, scene)
    }

    pub(super) fn node_named<T>(
        &self,
        at: &Located<T>,
        name: &str,
        scene: &Scene,
    ) -> Result<usize, FileError> {
        let found = scene.nodes.iter().position(|node| node.name == name);
        found.ok_or_else(|| {
            let names = scene.nodes.iter().map(|node| node.name.as_str());
            let names: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
            self.error(at, not_there("node", name, &names))
        })
    }

    fn camera_node(&self, name: &Located<String>, scene: &Scene) -> Result<SceneCamera, FileError> {
        let cameras = || {
            scene.nodes.iter().enumerate().filter_map(|(i, node)| {
                let camera = scene.cameras.get(node.camera?)?;
                Some((i, node.name.as_str(), camera.name.as_str()))
            })
        };
        let found = cameras().find(|(_, node, camera)| *node == **name || *camera == **name);
        found.map(|(node, _, _)| SceneCamera::Node(node)).ok_or_else(|| {
            let names: Vec<&str> = cameras().map(|(_, node, _)| node).collect();
            self.error(name, not_there("camera", name, &names))
        })
    }
}

/// Which nodes a model entry hides, and whether each that it wants to hide is there.
fn hidden_nodes(model: &ModelEntry, scene: &Scene) -> (Vec<bool>, bool) {
    let mut hidden = vec![false; scene.nodes.len()];
    if model.hide.patterns().is_empty() {
        return (hidden, true);
    }
    let nodes = scene.nodes.iter().enumerate();
    let mut todo: Vec<usize> =
        nodes.filter(|(_, node)| model.hide.matches(&node.name)).map(|(i, _)| i).collect();
    let matched = !todo.is_empty();
    while let Some(node) = todo.pop() {
        let (Some(flag), Some(node)) = (hidden.get_mut(node), scene.nodes.get(node)) else {
            continue;
        };
        if !std::mem::replace(flag, true) {
            todo.extend(&node.children);
        }
    }
    (hidden, matched)
}

pub(super) fn not_there(what: &str, name: &str, known: &[&str]) -> String {
    const SHOWN: usize = 20;
    if known.is_empty() {
        return format!("there is no {what} '{name}': there are no {what}s at all");
    }
    let meant = match nearest(name, known.iter().copied()) {
        Some(meant) => format!(", did you mean '{meant}'?"),
        None => String::new(),
    };
    let list = known.iter().take(SHOWN).copied().collect::<Vec<_>>().join(", ");
    let more = if known.len() > SHOWN { ", …" } else { "" };
    format!("there is no {what} '{name}'{meant} (known: {list}{more})")
}
