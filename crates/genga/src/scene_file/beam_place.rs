//! Beams of a scene file with the nodes that they hold on to.

use glam::Vec3;

use super::{BeamEntry, Located, ModelEntry, NodeNames, SceneFile};
use crate::FileError;
use crate::scene::{Beam, BeamShape, Scene, WavePlacement};

/// A model in the scene that is put together, and how it moves.
pub(super) struct Moving<'a> {
    pub(super) model: &'a ModelEntry,
    /// The model by itself; its nodes follow `top` in their order.
    pub(super) scene: &'a Scene,
    pub(super) top: usize,
}

/// Straight pieces of a light-trail.
const TRAIL_PIECES: u16 = 64;

impl SceneFile {
    /// A beam at its moment.
    pub(super) fn placed_beam(
        &self,
        entry: &BeamEntry,
        scene: &Scene,
        models: &[Moving<'_>],
    ) -> Result<Beam, FileError> {
        let nodes = |names: &Option<Located<NodeNames>>| match names {
            None => Ok(Vec::new()),
            Some(at) => at.names().iter().map(|name| self.node(at, name, scene)).collect(),
        };
        let mut beam = entry.beam.clone();
        let (from_nodes, to_nodes): (Vec<usize>, Vec<usize>) =
            (nodes(&entry.from_nodes)?, nodes(&entry.to_nodes)?);
        if let (Some(seconds), BeamShape::Path { points, radius, .. }) =
            (entry.trail, &mut beam.shape)
        {
            // In the world already; only what is added to the nodes is left.
            *points = self.trail(&from_nodes, seconds, scene, models)?;
            // What hardly moves has a thin trail, not a ball.
            let length: f32 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let widest = radius[0].max(radius[1]).max(1e-6);
            *radius = radius.map(|radius| radius * (0.3 * length / widest).clamp(1e-6, 1.0));
        } else {
            match &mut beam.placement {
                WavePlacement::At { anchor, .. } => anchor.nodes = from_nodes,
                WavePlacement::Between { from, to, .. } => {
                    from.nodes = from_nodes;
                    to.nodes = to_nodes;
                }
            }
        }
        if let (Some(name), BeamShape::Surfaces { under, .. }) = (&entry.model, &mut beam.shape) {
            *under = Some(self.node_named(name, name, scene)?);
        }
        Ok(entry.motion.at(&beam, entry.time))
    }

    /// The way of the mean of some nodes in the last seconds, the oldest place first.
    fn trail(
        &self,
        nodes: &[usize],
        seconds: f32,
        scene: &Scene,
        models: &[Moving<'_>],
    ) -> Result<Vec<Vec3>, FileError> {
        let mut way = vec![Vec3::ZERO; usize::from(TRAIL_PIECES) + 1];
        for &node in nodes {
            // The last model that begins before the node has it.
            let moving = models.iter().rfind(|moving| node > moving.top);
            let inside = moving.filter(|moving| node - moving.top <= moving.scene.nodes.len());
            for (i, place) in way.iter_mut().enumerate() {
                let before = seconds * (1.0 - i as f32 / f32::from(TRAIL_PIECES));
                *place += match inside {
                    Some(moving) => {
                        let pose = self.pose_before(moving.model, moving.scene, before)?;
                        let model = pose.world_from_node[node - moving.top - 1].translation;
                        let world = moving.model.transform().parent_from_node();
                        world.transform_point3(model.into())
                    }
                    // What is in no model stands still.
                    None => scene.nodes[node].transform.parent_from_node().translation.into(),
                };
            }
        }
        let count = nodes.len().max(1) as f32;
        way.iter_mut().for_each(|place| *place /= count);
        Ok(way)
    }
}
