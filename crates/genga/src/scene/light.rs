use glam::Vec3;

/// What a light shines like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel rays along the node's −Z.
    Directional,
    /// From the node's origin in all directions.
    Point {
        /// Distance in metres beyond which it gives no light; `None` for no limit.
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
}

/// A light of the file (KHR_lights_punctual), placed by its node.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Name in the file; may be empty.
    pub name: String,
    /// Directional, point or spot.
    pub kind: LightKind,
    /// Linear RGB, each ≥ 0.
    pub color: Vec3,
    /// Lux for directional lights, candela for the others, ≥ 0.
    pub intensity: f32,
    /// Whether its node's place is meant in the camera's space and not in the world's: then it
    /// turns with the camera.
    pub pinned_to_camera: bool,
}
