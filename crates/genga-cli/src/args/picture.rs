//! What to draw, from where, and how.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use genga::render::LayerKind;

use super::values::{self, FrameRange};
use crate::output::Output;

/// `genga render`.
#[derive(Debug, Args)]
#[command(after_help = "\
Names of files may hold {model}, {style}, {frame} and {index}; {frame:04} gives four digits.
Frame N shows the clip at N / fps seconds.

Examples:
  genga render Knight.glb
  genga render Knight.glb Fox.glb --style anime -o 'out/{model}.png'
  genga render Knight.glb --camera-azimuth-angle -40 --camera-zoom 2 --no-background
  genga render Fox.glb --clip Run --frames 0..23 -o 'run/{frame:04}.png'
  genga render Fox.glb --layers color,lines,depth --size 3840x2160
  genga render Fox.glb -o - | magick - fox.jpg
  genga render shot.scene.toml --dump-keys")]
pub(crate) struct RenderArgs {
    /// Models (.gltf, .glb, .obj) and scenes (.scene.toml); each gives a picture of its own
    #[arg(required = true, value_name = "MODEL|SCENE")]
    pub(crate) inputs: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    /// Print where each highlight stands in each picture, as TOML, to standard output
    #[arg(long)]
    pub(crate) dump_keys: bool,

    /// Draw this frame of the clip
    #[arg(long, value_name = "N", value_parser = values::frame, allow_negative_numbers = true)]
    #[arg(conflicts_with_all = ["frames", "time"], help_heading = ANIMATION)]
    pub(crate) frame: Option<i64>,

    /// Draw these frames of the clip, the last one included
    #[arg(long, value_name = "A..B", value_parser = FrameRange::parse, allow_hyphen_values = true)]
    #[arg(conflicts_with = "time", help_heading = ANIMATION)]
    pub(crate) frames: Option<FrameRange>,

    /// Frames per second
    #[arg(long, default_value = "24", value_parser = values::fps, help_heading = ANIMATION)]
    pub(crate) fps: f32,

    /// Use this camera of the model, by its name or number
    #[arg(long, value_name = "NAME", conflicts_with = "orbit", help_heading = CAMERA)]
    pub(crate) camera: Option<String>,
}

/// `genga turntable`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  genga turntable Knight.glb
  genga turntable Knight.glb --count 72 --style anime -o 'turn/{model}_{frame:04}.png'
  genga turntable Fox.glb --clip Walk --time 0.3 --size 512x512")]
pub(crate) struct TurntableArgs {
    /// Model (.gltf, .glb, .obj) or scene (.scene.toml)
    #[arg(value_name = "MODEL|SCENE")]
    pub(crate) input: PathBuf,

    /// Number of frames in the full turn
    #[arg(long, visible_alias = "frames", default_value_t = 36, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) count: u32,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

const CAMERA: &str = "Camera";
const ANIMATION: &str = "Animation";

/// What all commands share that draw pictures.
#[derive(Debug, Args)]
pub(crate) struct PictureArgs {
    /// Style: the name of one that comes with the program, or a file [default: what the scene
    /// asks for, or american-comic]
    #[arg(short, long, value_name = "NAME|FILE")]
    pub(crate) style: Option<String>,

    /// Name of the PNG file, or - for standard output [default: {model}.png, or
    /// {model}_{frame:04}.png for several frames]
    #[arg(short, long, value_name = "FILE|-", value_parser = Output::parse)]
    pub(crate) output: Option<Output>,

    /// Width and height in pixels [default: what the scene asks for, or 1920x1080]
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<[u32; 2]>,

    /// Leave the background transparent
    #[arg(long)]
    pub(crate) no_background: bool,

    /// Samples per pixel along each axis, 1 to 4 [default: what the scene asks for, or 2]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4))]
    pub(crate) supersample: Option<u32>,

    /// Also write these parts of the picture beside it: PICTURE.depth.exr and so on
    #[arg(long, value_delimiter = ',', value_name = "LAYER,…")]
    pub(crate) layers: Vec<LayerName>,

    /// Draw with the graphics adapter that has this in its name
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,

    #[command(flatten)]
    pub(crate) orbit: OrbitArgs,

    /// Pose the model by this animation clip, by its name or number
    #[arg(long, value_name = "NAME|INDEX", help_heading = ANIMATION)]
    pub(crate) clip: Option<String>,

    /// Moment of the clip in seconds
    #[arg(long, value_name = "S", value_parser = values::seconds, allow_negative_numbers = true)]
    #[arg(help_heading = ANIMATION)]
    pub(crate) time: Option<f32>,
}

/// A camera on a sphere round what it shows. What is not given is the scene's, or the library's.
#[derive(Clone, Copy, Debug, Args)]
#[group(id = "orbit", multiple = true)]
pub(crate) struct OrbitArgs {
    /// Degrees to the right of the front
    #[arg(long, value_name = "DEG", value_parser = values::azimuth, allow_negative_numbers = true)]
    #[arg(help_heading = CAMERA)]
    pub(crate) camera_azimuth_angle: Option<f32>,

    /// Degrees above the horizon
    #[arg(long, value_name = "DEG", value_parser = values::elevation, allow_negative_numbers = true)]
    #[arg(help_heading = CAMERA)]
    pub(crate) camera_elevation_angle: Option<f32>,

    /// Magnification; 1 shows everything
    #[arg(long, value_name = "FACTOR", value_parser = values::zoom, help_heading = CAMERA)]
    pub(crate) camera_zoom: Option<f32>,

    /// Vertical angle of view in degrees
    #[arg(long, value_name = "DEG", value_parser = values::fov, help_heading = CAMERA)]
    #[arg(conflicts_with = "orthographic")]
    pub(crate) camera_fov_angle: Option<f32>,

    /// Parallel projection
    #[arg(long, help_heading = CAMERA)]
    pub(crate) orthographic: bool,
}

/// Parts of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LayerName {
    /// Painted surfaces without highlights, lines and background (PNG)
    Color,
    /// Distance from the camera in metres (EXR)
    Depth,
    /// World-space normals (EXR)
    Normal,
    /// Numbers of objects, materials and lines (EXR)
    Ids,
    /// Lines alone (PNG)
    Lines,
    /// Coverage of each line set (OpenEXR)
    LineMask,
    /// Types of the detected lines (OpenEXR)
    LineType,
    /// Highlights alone (PNG)
    Highlight,
    /// Where pixels lie on the drawing of a highlight (EXR)
    HighlightUv,
    /// Energy of the waves, 32-bit float (EXR)
    Energy,
    /// Surfaces before the ramp (PNG)
    Base,
    /// What the ramp, with cast shadows, makes of white (PNG)
    Tone,
    /// Cast shadows alone, black on white (PNG)
    Shadow,
    /// Hatching alone (PNG)
    Ink,
    /// Beams alone (PNG)
    Beam,
}

impl LayerName {
    /// The renderer's own name for it.
    pub(crate) fn kind(self) -> LayerKind {
        match self {
            Self::Color => LayerKind::Color,
            Self::Depth => LayerKind::Depth,
            Self::Normal => LayerKind::Normal,
            Self::Ids => LayerKind::Ids,
            Self::Lines => LayerKind::Lines,
            Self::LineMask => LayerKind::LineMask,
            Self::LineType => LayerKind::LineType,
            Self::Highlight => LayerKind::Highlight,
            Self::HighlightUv => LayerKind::HighlightUv,
            Self::Energy => LayerKind::Energy,
            Self::Base => LayerKind::Base,
            Self::Tone => LayerKind::Tone,
            Self::Shadow => LayerKind::Shadow,
            Self::Ink => LayerKind::Ink,
            Self::Beam => LayerKind::Beam,
        }
    }
}

impl PictureArgs {
    /// The layers that were asked for, each once.
    pub(crate) fn layer_kinds(&self) -> Vec<LayerKind> {
        let mut kinds: Vec<LayerKind> = Vec::new();
        for kind in self.layers.iter().map(|layer| layer.kind()) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }
}
