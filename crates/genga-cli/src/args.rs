//! The command line.

mod picture;
mod values;

use std::path::PathBuf;

use clap::{Parser, Subcommand, ValueEnum};

pub(crate) use picture::{OrbitArgs, PictureArgs, RenderArgs, TurntableArgs};
pub(crate) use values::FrameRange;

/// Draws 3-D models as anime and American comics.
#[derive(Debug, Parser)]
#[command(name = "genga", bin_name = "genga", version, propagate_version = true, after_help = EXAMPLES)]
#[command(arg_required_else_help = true)]
pub(crate) struct Args {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,

    /// Print errors only: no warnings, notes or progress
    #[arg(short, long, global = true, conflicts_with = "verbose", display_order = 900)]
    pub(crate) quiet: bool,

    /// Log what happens; twice or three times for more
    #[arg(short, long, global = true, action = clap::ArgAction::Count, display_order = 901)]
    pub(crate) verbose: u8,
}

const EXAMPLES: &str = "\
Examples:
  genga render Knight.glb --style american-comic -o knight.png
  genga turntable Knight.glb --count 48 -o 'turn/{frame:04}.png'
  genga info Knight.glb
  genga styles

'genga COMMAND --help' has more.";

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Draw models and scenes as PNG pictures
    Render(RenderArgs),
    /// Draw a model from all sides, as the frames of a full turn
    Turntable(TurntableArgs),
    /// Show what is in a model, and what is wrong with its geometry
    Info(InfoArgs),
    /// List the styles that come with the program, or print one to start from
    Styles(StylesArgs),
    /// Read styles, scenes and models strictly, and print what is wrong with them
    Check(CheckArgs),
    /// Print the JSON Schema of a kind of file, for editors
    Schema(SchemaArgs),
    /// List the graphics adapters of this machine
    Adapters(AdaptersArgs),
    /// Measure how long frames take, against a plain picture of the same geometry
    Bench(BenchArgs),
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Workloads:
  suzuki  11,098 vertices at 1024x768 (Suzuki 2004, 5.2)
  lines   what lines cost by the method of Okuya et al. 2015 and by ours: their tables 3 and 4,
          and 300,000 triangles
  waves   energy waves, the exact method and Abe's (2024, tables 4.4 and 4.5)
  import  a file of a million triangles, read and prepared

Each frame is drawn by turns with a plain one: the same geometry, one pass, Lambert and texture,
no lines; in 'lines', by turns with the other method. The ratio of medians is what compares across
machines.

Examples:
  genga bench
  genga bench suzuki --runs 200 --json > suzuki.json
  genga bench Knight.glb --size 1280x720 --style anime")]
pub(crate) struct BenchArgs {
    /// Workloads by name, and models; all named ones if none is given
    #[arg(value_name = "WORKLOAD|MODEL")]
    pub(crate) workloads: Vec<String>,

    /// Frames of each kind that are measured
    #[arg(long, default_value_t = 50, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) runs: u32,

    /// Style: the name of one that comes with the program, or a file [default: american-comic]
    #[arg(short, long, value_name = "NAME|FILE")]
    pub(crate) style: Option<String>,

    /// Width and height in pixels, instead of the workload's own
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub(crate) size: Option<[u32; 2]>,

    /// Of the workload waves only this curve
    #[arg(long, value_parser = ["helix", "trig", "bezier", "b-spline"])]
    pub(crate) curve: Option<String>,

    /// Samples per pixel along each axis, 1 to 4
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=4))]
    pub(crate) supersample: u32,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,

    /// Draw with the graphics adapter that has this in its name
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  genga adapters
  genga adapters --json
  genga render Knight.glb --adapter llvmpipe")]
pub(crate) struct AdaptersArgs {
    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  genga info Knight.glb
  genga info --json Knight.glb > knight.json")]
pub(crate) struct InfoArgs {
    /// Model (.gltf, .glb, .obj)
    pub(crate) model: PathBuf,

    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  genga styles
  genga styles american-comic > mine.style.toml")]
pub(crate) struct StylesArgs {
    /// Print this style's file
    pub(crate) name: Option<String>,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Exit status 0 means that nothing is wrong with any of the files.

Examples:
  genga check mine.style.toml
  genga check shot.scene.toml Knight.glb")]
pub(crate) struct CheckArgs {
    /// Styles (.style.toml), scenes (.scene.toml) and models (.gltf, .glb, .obj)
    #[arg(required = true)]
    pub(crate) files: Vec<PathBuf>,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  genga schema style > style.schema.json
  genga schema scene > scene.schema.json")]
pub(crate) struct SchemaArgs {
    /// Kind of file
    pub(crate) kind: SchemaKind,
}

/// Kinds of files that have a schema.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SchemaKind {
    /// *.style.toml
    Style,
    /// *.scene.toml
    Scene,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    /// The example lines of a command's help and of all its subcommands.
    fn examples(command: &clap::Command) -> Vec<String> {
        let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        let lines = help.lines().filter(|line| line.starts_with("  genga ")).map(str::to_owned);
        lines.chain(command.get_subcommands().flat_map(examples)).collect()
    }

    #[test]
    fn the_command_line_is_sound() {
        Args::command().debug_assert();
    }

    #[test]
    fn every_command_has_examples_that_parse() {
        for command in Args::command().get_subcommands() {
            assert!(!examples(command).is_empty(), "{} has no example", command.get_name());
        }
        for line in examples(&Args::command()) {
            // What the shell does with the rest of the line is its own matter.
            let words = line.split_whitespace().take_while(|word| !["|", ">"].contains(word));
            let words = words.map(|word| word.trim_matches('\''));
            if let Err(error) = Args::try_parse_from(words) {
                panic!("'{line}' does not parse: {error}");
            }
        }
    }
}
