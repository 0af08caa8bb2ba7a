//! Several models as one scene: indices are moved behind those that are there already.

use std::mem::take;

use crate::scene::{Node, Pose, Scene, Transform};

/// A scene that grows, with its pose.
pub(super) struct Merged {
    pub(super) scene: Scene,
    pub(super) pose: Pose,
}

/// Where a file's shared parts begin in the merged scene.
#[derive(Clone, Copy)]
pub(super) struct Offsets {
    pub(super) meshes: usize,
    cameras: usize,
    lights: usize,
}

impl Merged {
    pub(super) fn new(name: String) -> Self {
        let pose =
            Pose { world_from_node: Vec::new(), morph_weights: Vec::new(), visible: Vec::new() };
        Self { scene: Scene { name, ..Scene::default() }, pose }
    }

    /// Takes what all instances of a file share: meshes, materials, pictures, cameras, lights.
    pub(super) fn add_shared(&mut self, model: &mut Scene) -> Offsets {
        let scene = &mut self.scene;
        let offsets = Offsets {
            meshes: scene.meshes.len(),
            cameras: scene.cameras.len(),
            lights: scene.lights.len(),
        };
        let (materials, textures, images) =
            (scene.materials.len(), scene.textures.len(), scene.images.len());
        for mut mesh in take(&mut model.meshes) {
            for primitive in &mut mesh.primitives {
                move_by(&mut primitive.material, materials);
            }
            scene.meshes.push(mesh);
        }
        for mut material in take(&mut model.materials) {
            let refs = [&mut material.base_color_texture, &mut material.emissive_texture];
            for texture in refs.into_iter().flatten() {
                texture.texture += textures;
            }
            scene.materials.push(material);
        }
        for mut texture in take(&mut model.textures) {
            move_by(&mut texture.image, images);
            scene.textures.push(texture);
        }
        scene.images.append(&mut model.images);
        scene.cameras.append(&mut model.cameras);
        scene.lights.append(&mut model.lights);
        offsets
    }

    /// Puts a model under a node of its own, whose index it returns. `pose` is the model's, by itself; `hidden` says
    /// which of its nodes are not drawn.
    pub(super) fn add_instance(
        &mut self,
        model: &Scene,
        offsets: Offsets,
        pose: Pose,
        hidden: &[bool],
        name: String,
        transform: Transform,
    ) -> usize {
        let world_from_model = transform.parent_from_node();
        let top = self.add_node(Node { name, transform, ..Node::default() });
        let first = top + 1;
        if let Some(node) = self.scene.nodes.get_mut(top) {
            node.children = model.roots.iter().map(|root| root + first).collect();
        }
        let first_skin = self.scene.skins.len();
        for (i, node) in model.nodes.iter().enumerate() {
            let mut node = node.clone();
            move_by(&mut node.parent, first);
            if model.roots.contains(&i) {
                node.parent = Some(top);
            }
            node.children.iter_mut().for_each(|child| *child += first);
            move_by(&mut node.mesh, offsets.meshes);
            move_by(&mut node.skin, first_skin);
            move_by(&mut node.camera, offsets.cameras);
            move_by(&mut node.light, offsets.lights);
            // A hidden node keeps its place: it may be a joint of what is still drawn.
            if hidden.get(i).copied().unwrap_or(false) {
                (node.mesh, node.skin, node.light) = (None, None, None);
                node.morph_weights.clear();
            }
            self.scene.nodes.push(node);
        }
        for mut skin in model.skins.iter().cloned() {
            skin.joints.iter_mut().for_each(|joint| *joint += first);
            self.scene.skins.push(skin);
        }
        for mut clip in model.clips.iter().cloned() {
            clip.channels.iter_mut().for_each(|channel| channel.node += first);
            self.scene.clips.push(clip);
        }
        let nodes = pose.world_from_node.into_iter().zip(pose.morph_weights).zip(pose.visible);
        for (i, ((model_from_node, mut weights), visible)) in nodes.enumerate() {
            if hidden.get(i).copied().unwrap_or(false) {
                weights.clear();
            }
            // What hangs nowhere stays where `Pose` puts it.
            let world_from_node =
                if visible { world_from_model * model_from_node } else { model_from_node };
            self.pose.world_from_node.push(world_from_node);
            self.pose.morph_weights.push(weights);
            self.pose.visible.push(visible);
        }
        top
    }

    /// Adds a root node; returns its index.
    pub(super) fn add_node(&mut self, node: Node) -> usize {
        let index = self.scene.nodes.len();
        self.pose.world_from_node.push(node.transform.parent_from_node());
        self.pose.morph_weights.push(Vec::new());
        self.pose.visible.push(true);
        self.scene.nodes.push(node);
        self.scene.roots.push(index);
        index
    }

    /// Adds a node below another one, at its place in the present pose.
    pub(super) fn add_child(&mut self, parent: usize, node: Node) {
        let index = self.scene.nodes.len();
        let (world, visible) = match self.pose.world_from_node.get(parent) {
            Some(world) => (*world, self.pose.visible.get(parent).copied().unwrap_or(true)),
            None => (glam::Affine3A::IDENTITY, true),
        };
        self.pose.world_from_node.push(world * node.transform.parent_from_node());
        self.pose.morph_weights.push(Vec::new());
        self.pose.visible.push(visible);
        self.scene.nodes.push(node);
        if let Some(parent) = self.scene.nodes.get_mut(parent) {
            parent.children.push(index);
        }
    }
}

fn move_by(index: &mut Option<usize>, offset: usize) {
    if let Some(index) = index {
        *index += offset;
    }
}
