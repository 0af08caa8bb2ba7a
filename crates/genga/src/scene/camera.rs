/// How a camera maps depth to the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective with the vertical field of view in radians, in (0, π).
    Perspective {
        /// Vertical angle of view in radians.
        fov_y: f32,
    },
    /// Orthographic with the visible height in metres, > 0.
    Orthographic {
        /// Height of the picture in metres.
        height: f32,
    },
}

/// A camera of the file. It stands at its node's origin and looks down that node's −Z.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file; may be empty.
    pub name: String,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// Width over height that the file asks for, if it does.
    pub aspect: Option<f32>,
    /// Distance in metres nearer than which nothing is drawn, > 0.
    pub near: f32,
}
