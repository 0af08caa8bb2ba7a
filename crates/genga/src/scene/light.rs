use glam::Vec3;

/// What a light shines like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel rays along the node's −Z.
    Directional,
    /// From the node's origin in all directions.
    Point {
        /// Distance in metres beyond which it gives no light; `None` for no limit. There is shade, or
        /// what a directional light of the scene gives.
        range: Option<f32>,
    },
    /// A cone along the node's −Z.
    Spot {
        /// Distance in metres beyond which it gives no light; `None` for no limit.
        range: Option<f32>,
        /// Half angle in radians within which it is at full strength.
        inner_angle: f32,
        /// Half angle in radians outside which it gives no light, > `inner_angle`, ≤ π/2.
        outer_angle: f32,
    },
    /// A hemisphere: surfaces that look along the node's +Y are fully lit, those that look the
    /// other way are not. It casts no shadows.
    Sky,
}

/// A light of the file (KHR_lights_punctual) or of a scene file, placed by its node.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name in the file; may be empty.
    pub name: String,
    /// Directional, point, spot or sky.
    pub kind: LightKind,
    /// Linear RGB, each ≥ 0.
    pub color: Vec3,
    /// Lux for directional lights and skies, candela for the others, ≥ 0.
    pub intensity: f32,
    /// Whether its node's place is meant in the camera's space and not in the world's: then it
    /// turns with the camera.
    pub pinned_to_camera: bool,
    /// Whether it casts shadows in styles that have them.
    pub casts_shadow: bool,
}
