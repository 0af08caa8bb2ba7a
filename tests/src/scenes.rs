//! Scenes, styles and views made in code.

use std::path::{Path, PathBuf};

use genga::render::{Orbit, View, ViewCamera};
use genga::scene::{
    Filter, Image, Light, LightKind, Material, Mesh, MipFilter, Node, Pose, Primitive, Projection,
    Sampler, Scene, Texture, TextureRef, Transform, UvTransform, Wrap,
};
use genga::style::Style;
use glam::{Affine3A, Quat, Vec3};

/// The workspace's root.
#[must_use]
pub fn root() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    tests.parent().unwrap_or(tests).to_owned()
}

/// A style from TOML without its version line.
///
/// # Panics
/// If the text is not a style.
#[must_use]
pub fn style(toml: &str) -> Style {
    match Style::from_toml_str(&format!("version = 1\n{toml}")) {
        Ok(style) => style,
        Err(error) => panic!("the style of a test is wrong: {error}"),
    }
}

/// One of the project's own models.
///
/// # Panics
/// If it cannot be read.
#[must_use]
pub fn model(name: &str) -> Scene {
    let path = root().join("assets/models").join(format!("{name}.glb"));
    genga::import::load(&path).expect("the project's own models can be read").scene
}

/// A parallel view along −Z onto the plane z = 0, `metres` high; the camera stands at z = 10.
#[must_use]
pub fn ortho_view(size: [u32; 2], metres: f32) -> View {
    let camera = ViewCamera {
        world_from_camera: Affine3A::from_translation(Vec3::Z * 10.0),
        projection: Projection::Orthographic { height: metres },
        near: 0.1,
    };
    View::new(camera, size)
}

/// A view along −Z from `distance` metres in front of the origin.
#[must_use]
pub fn perspective_view(size: [u32; 2], fov_deg: f32, distance: f32) -> View {
    let camera = ViewCamera {
        world_from_camera: Affine3A::from_translation(Vec3::Z * distance),
        projection: Projection::Perspective { fov_y: fov_deg.to_radians() },
        near: 0.1,
    };
    View::new(camera, size)
}

/// A view that shows the whole scene.
///
/// # Panics
/// If the scene is empty.
#[must_use]
pub fn orbit_view(scene: &Scene, orbit: &Orbit, size: [u32; 2]) -> View {
    let bounds = scene.bounds(&Pose::rest(scene)).expect("the scene has vertices");
    View::new(ViewCamera::orbit(&bounds, orbit, size[0] as f32 / size[1] as f32), size)
}

/// A transform of a translation alone.
#[must_use]
pub fn moved(x: f32, y: f32, z: f32) -> Transform {
    parts(Vec3::new(x, y, z), Quat::IDENTITY, Vec3::ONE)
}

/// A transform by its parts.
#[must_use]
pub fn parts(translation: Vec3, rotation: Quat, scale: Vec3) -> Transform {
    Transform::Parts { translation, rotation, scale }
}

/// A sampler that shows texels as they are.
#[must_use]
pub fn nearest() -> Sampler {
    Sampler {
        mag: Filter::Nearest,
        min: Filter::Nearest,
        mip: MipFilter::None,
        wrap_u: Wrap::Clamp,
        wrap_v: Wrap::Clamp,
    }
}

/// A picture of RGBA pixels by formula.
pub fn image(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let rgba = places.flat_map(|(x, y)| pixel(x, y)).collect();
    Image { name: "made in code".to_owned(), width, height, rgba }
}

/// The direct light of a place in the scene.
#[must_use]
pub fn light(kind: LightKind, intensity: f32) -> Light {
    Light {
        name: String::new(),
        kind,
        color: Vec3::ONE,
        intensity,
        pinned_to_camera: false,
        casts_shadow: true,
    }
}

/// Puts a scene together.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    scene: Scene,
}

impl Builder {
    /// An empty scene.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a material.
    pub fn material(&mut self, material: Material) -> usize {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    /// Adds a material of that name in one colour.
    pub fn colored(&mut self, name: &str, rgb: [f32; 3]) -> usize {
        let base_color = Vec3::from(rgb).extend(1.0);
        self.material(Material { name: name.to_owned(), base_color, ..Material::default() })
    }

    /// Adds a texture.
    pub fn texture(&mut self, image: Image, sampler: Sampler) -> TextureRef {
        self.scene.images.push(image);
        let image = Some(self.scene.images.len() - 1);
        self.scene.textures.push(Texture { name: String::new(), image, sampler });
        let texture = self.scene.textures.len() - 1;
        TextureRef { texture, uv_set: 0, transform: UvTransform::default() }
    }

    /// Adds a mesh of one primitive.
    pub fn mesh(&mut self, primitive: Primitive) -> usize {
        let primitives = vec![primitive];
        self.scene.meshes.push(Mesh { primitives, ..Mesh::default() });
        self.scene.meshes.len() - 1
    }

    /// Adds an object with a mesh of its own.
    pub fn object(
        &mut self,
        name: &str,
        mut primitive: Primitive,
        material: Option<usize>,
        transform: Transform,
    ) -> usize {
        primitive.material = material.or(primitive.material);
        let mesh = Some(self.mesh(primitive));
        self.node(Node { name: name.to_owned(), mesh, transform, ..Node::default() })
    }

    /// Adds a root node.
    pub fn node(&mut self, node: Node) -> usize {
        self.scene.nodes.push(node);
        let index = self.scene.nodes.len() - 1;
        self.scene.roots.push(index);
        index
    }

    /// Adds a light that stands at `from` and shines at the origin.
    pub fn light(&mut self, light: Light, from: Vec3) {
        self.scene.lights.push(light);
        let back = from.normalize_or(Vec3::Z);
        let rotation = Quat::from_rotation_arc(Vec3::Z, back);
        self.node(Node {
            name: "light".to_owned(),
            light: Some(self.scene.lights.len() - 1),
            transform: parts(from, rotation, Vec3::ONE),
            ..Node::default()
        });
    }

    /// Everything, for what the other methods do not cover.
    pub fn raw(&mut self) -> &mut Scene {
        &mut self.scene
    }

    /// The scene.
    #[must_use]
    pub fn build(self) -> Scene {
        self.scene
    }
}
