//! Highlights of a scene file, put into the assembled scene.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};

use super::assemble::not_there;
use super::highlight::{HighlightEntry, ProxyEntry, ProxyKind};
use super::{Located, SceneFile, ShadingEntry};
use crate::FileError;
use crate::scene::{Drawing, FaceShadow, Highlight, Image, Pose, Proxy, ProxyMesh, Scene, Shading};
use crate::style::picture;

/// A model in the assembled scene.
pub(super) struct Instance {
    /// Its node's name.
    pub(super) name: String,
    /// The node that it hangs under; its own nodes follow that one.
    pub(super) top: usize,
    /// For each of its nodes the mesh in the assembled scene, also where it is hidden.
    pub(super) meshes: Vec<Option<usize>>,
}

impl SceneFile {
    /// The highlights with everything that they refer to.
    pub(super) fn place_highlights(
        &self,
        scene: &Scene,
        instances: &[Instance],
    ) -> Result<Vec<Highlight>, FileError> {
        let rest = Pose::rest(scene);
        let place = Places { file: self, scene, rest: &rest, instances };
        self.highlights.iter().map(|entry| place.highlight(entry)).collect()
    }

    /// The shadings with everything that they refer to.
    pub(super) fn place_shadings(
        &self,
        scene: &Scene,
        instances: &[Instance],
    ) -> Result<Vec<Shading>, FileError> {
        let rest = Pose::rest(scene);
        let place = Places { file: self, scene, rest: &rest, instances };
        self.shadings.iter().map(|entry| place.shading(entry)).collect()
    }
}

struct Places<'a> {
    file: &'a SceneFile,
    scene: &'a Scene,
    rest: &'a Pose,
    instances: &'a [Instance],
}

impl Places<'_> {
    fn highlight(&self, entry: &HighlightEntry) -> Result<Highlight, FileError> {
        let instance = match &entry.model {
            Some(name) => Some(self.instance(name)?),
            None => self.instances.first().filter(|_| self.instances.len() == 1),
        };
        let node = match &entry.node {
            Some(name) => Some(self.node(name, instance)?),
            None => instance.map(|instance| instance.top),
        };
        let drawing = match entry.built_in() {
            Some(drawing) => Drawing::BuiltIn(drawing),
            None => Drawing::Image(self.drawn(&entry.drawing)?),
        };
        let mask = entry.mask.as_ref().map(|mask| self.picture(mask)).transpose()?;
        let light = match &entry.light {
            Some(name) => Some(self.light(name)?),
            None => None,
        };
        let mut highlight = Highlight {
            name: entry.name.clone(),
            drawing,
            node,
            under: instance.map(|instance| instance.top),
            objects: entry.objects.clone(),
            materials: entry.materials.clone(),
            proxy: self.proxy(&entry.proxy, node, instance)?,
            gamma: entry.gamma,
            light,
            size: Vec2::from(entry.size_deg.map(f32::to_radians)),
            angle: entry.angle_deg.to_radians(),
            color: entry.color,
            blend: entry.blend,
            tone: entry.tone,
            mask,
            placement: entry.placement(),
        };
        let proxy = &entry.proxy;
        if proxy.r#type == ProxyKind::Sphere && proxy.radius.is_none() {
            let ball = self.scene.fitted_ball(&highlight, proxy.center.map(Vec3::from));
            highlight.proxy = ball.unwrap_or(highlight.proxy);
        }
        highlight.validate(self.scene.nodes.len()).map_err(|problem| {
            self.file.error(&entry.drawing, format!("this highlight {problem}"))
        })?;
        Ok(highlight)
    }

    fn shading(&self, entry: &ShadingEntry) -> Result<Shading, FileError> {
        let instance = match &entry.model {
            Some(name) => Some(self.instance(name)?),
            None => self.instances.first().filter(|_| self.instances.len() == 1),
        };
        let node = match &entry.node {
            Some(name) => Some(self.node(name, instance)?),
            None => instance.map(|instance| instance.top),
        };
        let proxy = match &entry.proxy {
            Some(proxy) => Some(self.proxy(proxy, node, instance)?),
            None => None,
        };
        let face_shadow = match &entry.face_shadow {
            Some(path) => Some(FaceShadow { image: self.picture(path)?, mirror_u: entry.mirror_u }),
            None => None,
        };
        Ok(Shading {
            node,
            under: instance.map(|instance| instance.top),
            objects: entry.objects.clone(),
            materials: entry.materials.clone(),
            proxy,
            amount: entry.amount,
            face_shadow,
        })
    }

    fn instance(&self, name: &Located<String>) -> Result<&Instance, FileError> {
        self.instances.iter().find(|instance| instance.name == **name).ok_or_else(|| {
            let names: Vec<&str> = self.instances.iter().map(|i| i.name.as_str()).collect();
            self.file.error(name, not_there("model", name, &names))
        })
    }

    /// The one node of that name, of an instance or of all.
    fn node(
        &self,
        name: &Located<String>,
        instance: Option<&Instance>,
    ) -> Result<usize, FileError> {
        let range = match instance {
            Some(instance) => instance.top..instance.top + 1 + instance.meshes.len(),
            None => 0..self.scene.nodes.len(),
        };
        let nodes = &self.scene.nodes[range.clone()];
        let mut found = range.zip(nodes).filter(|(_, node)| node.name == **name).map(|(i, _)| i);
        match (found.next(), found.next()) {
            (Some(node), None) => Ok(node),
            (Some(_), Some(_)) => {
                let message = if instance.is_some() {
                    format!("there are several nodes '{}' in this model", **name)
                } else {
                    format!("there are several nodes '{}': say which by 'model'", **name)
                };
                Err(self.file.error(name, message))
            }
            (None, _) => {
                let names: Vec<&str> = nodes.iter().map(|node| node.name.as_str()).collect();
                Err(self.file.error(name, not_there("node", name, &names)))
            }
        }
    }

    fn light(&self, name: &Located<String>) -> Result<usize, FileError> {
        let lights = || {
            let nodes = self.scene.nodes.iter().enumerate();
            nodes.filter(|(_, node)| node.light.is_some())
        };
        lights().find(|(_, node)| node.name == **name).map(|(i, _)| i).ok_or_else(|| {
            let names: Vec<&str> = lights().map(|(_, node)| node.name.as_str()).collect();
            self.file.error(name, not_there("light", name, &names))
        })
    }

    fn drawn(&self, name: &Located<String>) -> Result<Arc<Image>, FileError> {
        if std::path::Path::new(name.as_str()).extension().is_none() {
            let names = crate::scene::BuiltInDrawing::ALL.map(|drawing| drawing.name());
            let message = not_there("drawing", name, &names);
            return Err(self
                .file
                .error(name, format!("{message}; a picture's path has an ending")));
        }
        self.picture(name)
    }

    fn picture(&self, path: &Located<String>) -> Result<Arc<Image>, FileError> {
        let opened = picture::open(&self.file.resolve(path));
        opened.map(Arc::new).map_err(|problem| self.file.error(path, format!("this {problem}")))
    }

    fn proxy(
        &self,
        proxy: &Located<ProxyEntry>,
        node: Option<usize>,
        instance: Option<&Instance>,
    ) -> Result<Proxy, FileError> {
        let point = |p: Option<[f32; 3]>| p.map_or(Vec3::ZERO, Vec3::from);
        let center = point(proxy.center);
        Ok(match proxy.r#type {
            ProxyKind::Sphere => match proxy.radius {
                Some(radius) if radius > 0.0 => Proxy::Ball { center, radius },
                _ => Proxy::Sphere { center },
            },
            ProxyKind::Ellipsoid => Proxy::Ellipsoid {
                center,
                radii: proxy.radii.map_or(Vec3::ONE, Vec3::from),
                rotation: proxy.rotation(),
            },
            ProxyKind::Capsule => {
                let to = match &proxy.to_node {
                    Some(name) => {
                        let end = self.node(name, instance)?;
                        Vec3::from(self.node_from(node, end).translation)
                    }
                    None => point(proxy.to),
                };
                Proxy::Capsule { from: point(proxy.from), to }
            }
            ProxyKind::Plane => {
                Proxy::Plane { center, normal: proxy.normal.map_or(Vec3::Z, Vec3::from) }
            }
            ProxyKind::Mesh => {
                let Some(name) = &proxy.mesh else {
                    return Err(self.file.error(proxy, "a mesh needs the node 'mesh'".to_owned()));
                };
                // It may be a hidden model of its own.
                let owner = self.node(name, instance).or_else(|_| self.node(name, None))?;
                let of = self.instances.iter().find_map(|instance| {
                    let index = owner.checked_sub(instance.top + 1)?;
                    *instance.meshes.get(index)?
                });
                let mesh = of.and_then(|mesh| self.scene.meshes.get(mesh)).ok_or_else(|| {
                    self.file.error(name, format!("the node '{}' has no mesh", **name))
                })?;
                let mesh = ProxyMesh::from_mesh(mesh, &self.node_from(node, owner));
                Proxy::Mesh { center, mesh: Arc::new(mesh) }
            }
        })
    }

    /// From a node's space to that of another (the world for `None`), at rest.
    fn node_from(&self, node: Option<usize>, other: usize) -> Affine3A {
        let at = |index: usize| self.rest.world_from_node.get(index).copied().unwrap_or_default();
        let world_from_node = node.map_or(Affine3A::IDENTITY, at);
        world_from_node.inverse() * at(other)
    }
}
