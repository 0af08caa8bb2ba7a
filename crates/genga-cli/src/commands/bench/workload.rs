use std::path::Path;

use genga::render::{Orbit, View, ViewCamera};
use genga::scene::{Pose, Scene};
use genga::shapes;
use genga::style::{LineMethod, Style};

use super::lines;
use crate::args::BenchArgs;
use crate::console::Console;
use crate::failure::{Failure, Outcome};
use crate::text::{nearest, one_line};
use crate::{model, style_choice};

/// Workloads with names; `--help` describes them.
const NAMED: [&str; 4] = ["suzuki", "lines", "waves", "import"];

/// Triangles of the `import` workload.
const IMPORT_TRIANGLES: usize = 1_000_000;

/// Something to measure.
pub(super) enum Job {
    /// One frame, over and over.
    Frames(Box<Case>),
    /// One place in the tables of what lines cost.
    Lines(lines::Cell),
    /// Energy waves, in their own pictures.
    Waves,
    /// Reading a file of so many triangles.
    Import { triangles: usize },
}

/// One frame.
pub(super) struct Case {
    pub(super) workload: String,
    pub(super) scene: Scene,
    pub(super) style_name: String,
    pub(super) style: Style,
    pub(super) view: View,
}

/// What the command line asks for; all named workloads if it names none.
pub(super) fn jobs(args: &BenchArgs, console: &Console) -> Outcome<Vec<Job>> {
    let all = NAMED.map(str::to_owned);
    let names = if args.workloads.is_empty() { &all[..] } else { &args.workloads };
    let mut jobs = Vec::new();
    for name in names {
        match name.as_str() {
            "suzuki" => {
                let primitive =
                    shapes::smooth_object_with_vertices(11_098).map_err(Failure::message)?;
                let scene = shapes::scene_of("smooth object", primitive);
                jobs.push(case(args, "suzuki", scene, [1024, 768])?);
            }
            "lines" => jobs.extend(lines::cells(args).into_iter().map(Job::Lines)),
            "waves" => jobs.push(Job::Waves),
            "import" => jobs.push(Job::Import { triangles: IMPORT_TRIANGLES }),
            file => jobs.push(model_case(args, file, console)?),
        }
    }
    Ok(jobs)
}

fn model_case(args: &BenchArgs, file: &str, console: &Console) -> Outcome<Job> {
    let path = Path::new(file);
    if !path.exists() && !file.contains(['.', '/', '\\']) {
        let meant = match nearest(file, NAMED) {
            Some(meant) => format!(", did you mean '{meant}'?"),
            None => String::new(),
        };
        return Err(Failure::Usage(format!(
            "'{file}' is neither a workload nor a model{meant} (workloads: {})",
            NAMED.join(", ")
        )));
    }
    let model = model::load(path).map_err(Failure::message)?;
    for warning in &model.warnings {
        console.warning(&one_line(&format!("{file}: {warning}")));
    }
    case(args, &model::display_name(path), model.scene, [1920, 1080])
}

fn case(args: &BenchArgs, workload: &str, scene: Scene, size: [u32; 2]) -> Outcome<Job> {
    let chosen = style_choice::find(args.style.as_deref().unwrap_or(style_choice::DEFAULT))?;
    let style = chosen.style;
    let size = args.size.unwrap_or(size);
    let bounds = scene.bounds(&Pose::rest(&scene)).ok_or_else(|| {
        Failure::Message(format!("{workload}: there is nothing to draw: it has no triangles"))
    })?;
    let aspect = size[0] as f32 / size[1] as f32;
    let view = View {
        camera: ViewCamera::orbit(&bounds, &Orbit::default(), aspect),
        size,
        supersample: args.supersample,
        background: true,
        frame: 0,
    };
    let (workload, style_name) = (workload.to_owned(), chosen.name);
    Ok(Job::Frames(Box::new(Case { workload, scene, style_name, style, view })))
}

/// A line method's name in style files.
pub(super) fn method_name(method: LineMethod) -> &'static str {
    match method {
        LineMethod::None => "none",
        LineMethod::Contour => "contour",
        LineMethod::Reference => "reference",
        LineMethod::Hull => "hull",
        LineMethod::Rim => "rim",
        LineMethod::Image => "image",
    }
}
