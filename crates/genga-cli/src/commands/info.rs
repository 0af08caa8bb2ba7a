use std::path::Path;

use genga::scene::{AlphaMode, LightKind, Pose, Projection, Scene};
use serde::Serialize;

use crate::args::InfoArgs;
use crate::console::{self, Console};
use crate::failure::{Failure, Outcome};
use crate::inspect::{Geometry, inspect};
use crate::model::{self, Model};
use crate::text::{count, name_or, one_line, table, thousands};

/// Prints what is in a model.
pub(crate) fn run(args: &InfoArgs, console: &Console) -> Outcome {
    let model = model::load(&args.model).map_err(Failure::message)?;
    let info = Info::of(&args.model, &model);
    if args.json {
        let text = serde_json::to_string_pretty(&info).map_err(Failure::message)?;
        return console::print(&format!("{text}\n"));
    }
    console::print(&info.text())?;
    for warning in &model.warnings {
        console.warning(&one_line(warning));
    }
    Ok(())
}

#[derive(Serialize)]
struct Info {
    file: String,
    triangles: usize,
    vertices: usize,
    nodes: usize,
    /// Nodes with a mesh.
    objects: usize,
    skins: usize,
    bounds: Option<Bounds>,
    meshes: Vec<MeshInfo>,
    materials: Vec<MaterialInfo>,
    images: Vec<ImageInfo>,
    clips: Vec<ClipInfo>,
    cameras: Vec<CameraInfo>,
    lights: Vec<LightInfo>,
    warnings: Vec<String>,
}

/// In metres, in the rest pose.
#[derive(Serialize)]
struct Bounds {
    min: [f32; 3],
    max: [f32; 3],
}

#[derive(Serialize)]
struct MeshInfo {
    name: String,
    morph_targets: usize,
    #[serde(flatten)]
    geometry: Geometry,
}

#[derive(Serialize)]
struct MaterialInfo {
    name: String,
    base_color: [f32; 4],
    /// Index into `images`.
    base_color_image: Option<usize>,
    alpha: &'static str,
    double_sided: bool,
    unlit: bool,
    /// Whether a mesh uses it.
    used: bool,
}

#[derive(Serialize)]
struct ImageInfo {
    name: String,
    width: u32,
    height: u32,
}

#[derive(Serialize)]
struct ClipInfo {
    name: String,
    seconds: f32,
}

#[derive(Serialize)]
struct CameraInfo {
    name: String,
    projection: &'static str,
}

#[derive(Serialize)]
struct LightInfo {
    name: String,
    kind: &'static str,
    intensity: f32,
}

impl Info {
    fn of(path: &Path, model: &Model) -> Self {
        let scene = &model.scene;
        let bounds = scene.bounds(&Pose::rest(scene));
        Self {
            file: path.display().to_string(),
            triangles: scene.triangle_count(),
            vertices: scene.vertex_count(),
            nodes: scene.nodes.len(),
            objects: scene.nodes.iter().filter(|node| node.mesh.is_some()).count(),
            skins: scene.skins.len(),
            bounds: bounds.map(|b| Bounds { min: b.min.to_array(), max: b.max.to_array() }),
            meshes: meshes(scene),
            materials: materials(scene),
            images: scene
                .images
                .iter()
                .map(|i| ImageInfo { name: i.name.clone(), width: i.width, height: i.height })
                .collect(),
            clips: scene
                .clips
                .iter()
                .map(|c| ClipInfo { name: c.name.clone(), seconds: c.duration() })
                .collect(),
            cameras: scene
                .cameras
                .iter()
                .map(|c| CameraInfo {
                    name: c.name.clone(),
                    projection: match c.projection {
                        Projection::Perspective { .. } => "perspective",
                        Projection::Orthographic { .. } => "orthographic",
                    },
                })
                .collect(),
            lights: scene
                .lights
                .iter()
                .map(|l| LightInfo {
                    name: l.name.clone(),
                    kind: match l.kind {
                        LightKind::Directional => "directional",
                        LightKind::Point { .. } => "point",
                        LightKind::Spot { .. } => "spot",
                        LightKind::Sky => "sky",
                    },
                    intensity: l.intensity,
                })
                .collect(),
            warnings: model.warnings.clone(),
        }
    }

    fn text(&self) -> String {
        let mut text = format!("{}\n", one_line(&self.file));
        let size = match &self.bounds {
            Some(Bounds { min, max }) => {
                let [x, y, z] = [0, 1, 2].map(|i| short(max[i] - min[i]));
                let corner = |p: &[f32; 3]| p.map(short).join(", ");
                format!("{x} × {y} × {z} m, from ({}) to ({})", corner(min), corner(max))
            }
            None => "nothing is drawn".to_owned(),
        };
        let row = |label: &str, value: String| vec![format!("  {label}"), value];
        text.push_str(&table(&[
            row("size", size),
            row("triangles", thousands(self.triangles)),
            row("vertices", thousands(self.vertices)),
            row(
                "objects",
                format!("{} in {}", thousands(self.objects), count(self.nodes, "node", "nodes")),
            ),
            row("skins", thousands(self.skins)),
        ]));
        let mut section = |title: &str, rows: Vec<Vec<String>>| {
            if !rows.is_empty() {
                text.push_str(&format!("{title} ({})\n{}", thousands(rows.len()), table(&rows)));
            }
        };
        let named = |name: &str, kind: &str, index: usize| {
            format!("  {}", name_or(name, || format!("{kind} {index}")))
        };
        section(
            "meshes",
            self.meshes
                .iter()
                .enumerate()
                .map(|(i, m)| m.row(&named(&m.name, "mesh", i)))
                .collect(),
        );
        section(
            "materials",
            self.materials
                .iter()
                .enumerate()
                .map(|(i, m)| m.row(&named(&m.name, "material", i), &self.images))
                .collect(),
        );
        section(
            "clips",
            self.clips
                .iter()
                .enumerate()
                .map(|(i, c)| vec![named(&c.name, "clip", i), format!("{} s", short(c.seconds))])
                .collect(),
        );
        section(
            "cameras",
            self.cameras
                .iter()
                .enumerate()
                .map(|(i, c)| vec![named(&c.name, "camera", i), c.projection.to_owned()])
                .collect(),
        );
        section(
            "lights",
            self.lights
                .iter()
                .enumerate()
                .map(|(i, l)| {
                    vec![named(&l.name, "light", i), l.kind.to_owned(), short(l.intensity)]
                })
                .collect(),
        );
        text
    }
}

impl MeshInfo {
    fn row(&self, name: &str) -> Vec<String> {
        let mut about = vec![if self.geometry.closed {
            "closed".to_owned()
        } else {
            count(self.geometry.open_edges, "open edge", "open edges")
        }];
        if self.morph_targets > 0 {
            about.push(count(self.morph_targets, "morph target", "morph targets"));
        }
        about.extend(self.geometry.problems());
        let triangles = count(self.geometry.triangles, "triangle", "triangles");
        vec![name.to_owned(), triangles, about.join(", ")]
    }
}

impl MaterialInfo {
    fn row(&self, name: &str, images: &[ImageInfo]) -> Vec<String> {
        let mut about = vec![self.alpha.to_owned()];
        if let Some((index, image)) = self.base_color_image.and_then(|i| Some((i, images.get(i)?)))
        {
            let name = name_or(&image.name, || format!("image {index}"));
            about.push(format!("{name} ({} × {})", image.width, image.height));
        }
        about.extend(self.double_sided.then(|| "double-sided".to_owned()));
        about.extend(self.unlit.then(|| "unlit".to_owned()));
        about.extend((!self.used).then(|| "not used".to_owned()));
        vec![name.to_owned(), about.join(", ")]
    }
}

fn meshes(scene: &Scene) -> Vec<MeshInfo> {
    let uv_sets = |material: Option<usize>| {
        let material = material.and_then(|index| scene.materials.get(index));
        let textures = material.map(|m| [m.base_color_texture, m.emissive_texture]);
        textures.into_iter().flatten().flatten().map(|texture| texture.uv_set).collect()
    };
    let info = |mesh: &genga::scene::Mesh| MeshInfo {
        name: mesh.name.clone(),
        morph_targets: mesh.primitives.iter().map(|p| p.morph_targets.len()).max().unwrap_or(0),
        geometry: inspect(mesh, uv_sets),
    };
    scene.meshes.iter().map(info).collect()
}

fn materials(scene: &Scene) -> Vec<MaterialInfo> {
    let mut used = vec![false; scene.materials.len()];
    for index in scene.meshes.iter().flat_map(|m| &m.primitives).filter_map(|p| p.material) {
        if let Some(used) = used.get_mut(index) {
            *used = true;
        }
    }
    let info = |(material, used): (&genga::scene::Material, bool)| MaterialInfo {
        name: material.name.clone(),
        base_color: material.base_color.to_array(),
        base_color_image: material
            .base_color_texture
            .and_then(|reference| scene.textures.get(reference.texture)?.image),
        alpha: match material.alpha {
            AlphaMode::Opaque => "opaque",
            AlphaMode::Mask { .. } => "mask",
            AlphaMode::Blend => "blend",
        },
        double_sided: material.double_sided,
        unlit: material.unlit,
        used,
    };
    scene.materials.iter().zip(used).map(info).collect()
}

/// Three significant digits or so, without trailing zeros.
fn short(number: f32) -> String {
    let magnitude = number.abs();
    if magnitude >= 1e6 || (magnitude > 0.0 && magnitude < 1e-4) {
        return format!("{number:.2e}");
    }
    let digits = if magnitude >= 100.0 {
        1
    } else if magnitude >= 1.0 {
        2
    } else {
        4
    };
    let text = format!("{number:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
