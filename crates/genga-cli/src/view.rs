//! Sizes and views from the options, the scene file and the defaults, in this order.

use genga::render::{View, ViewCamera};

use crate::args::PictureArgs;
use crate::source::Source;

/// Size of the picture in pixels.
pub(crate) fn size(args: &PictureArgs, source: &Source) -> [u32; 2] {
    args.size.or(source.picture.size).unwrap_or([1920, 1080])
}

/// Width over height.
pub(crate) fn aspect(size: [u32; 2]) -> f32 {
    size[0] as f32 / size[1] as f32
}

/// What the camera sees in a frame of an animation.
pub(crate) fn view(args: &PictureArgs, source: &Source, camera: ViewCamera, frame: i64) -> View {
    View {
        camera,
        size: size(args, source),
        supersample: args.supersample.or(source.picture.supersample).unwrap_or(2),
        background: !args.no_background && source.picture.background.unwrap_or(true),
        frame: u32::try_from(frame).unwrap_or(0),
    }
}
