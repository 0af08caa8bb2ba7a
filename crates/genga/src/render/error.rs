use thiserror::Error;

/// Why a picture could not be drawn.
#[derive(Clone, Debug, Error)]
pub enum RenderError {
    /// The scene is inconsistent.
    #[error("the scene cannot be drawn: {0}")]
    Scene(#[from] crate::scene::SceneError),
    /// A size of zero, or over what the adapter or Genga can do.
    #[error("a picture of {width}×{height} pixels cannot be drawn: each side must be 1 to {limit}")]
    Size {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// Largest side.
        limit: u32,
    },
    /// A camera or view with impossible numbers.
    #[error("the view cannot be drawn: {reason}")]
    View {
        /// What is wrong with it.
        reason: String,
    },
    /// The graphics memory is full.
    #[error(
        "the graphics memory is full: draw a smaller picture, a lower supersampling or a smaller model"
    )]
    OutOfMemory,
    /// The device is gone.
    #[error("the graphics device was lost ({message}): try again, or choose another adapter")]
    DeviceLost {
        /// What the driver said.
        message: String,
    },
    /// The driver refused something.
    #[error("the graphics driver reports an error: {message}")]
    Driver {
        /// What it said.
        message: String,
    },
}
