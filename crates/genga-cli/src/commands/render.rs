use genga::render::ViewCamera;
use genga::scene::Pose;
use glam::Vec3;

use crate::args::{FrameRange, RenderArgs};
use crate::console::{Console, Progress};
use crate::failure::{Failure, Outcome};
use crate::gpu::Graphics;
use crate::keys;
use crate::names::Names;
use crate::output::Output;
use crate::save::Saver;
use crate::source::{self, Source};
use crate::style_choice::{self, StyleChoice};
use crate::view;

/// Poses at which a moving model is measured, so that the camera can stand still.
const MEASURED_POSES: usize = 24;

/// Draws each input. What cannot be drawn does not keep the others from it.
pub(crate) fn run(args: &RenderArgs, console: &Console) -> Outcome {
    let style = args.picture.style.as_deref().map(style_choice::find).transpose()?;
    let moments = Moments::of(args);
    if args.dump_keys && args.picture.output == Some(Output::Stdout) {
        return Err(Failure::Usage(
            "standard output cannot take both the picture and the keys: give '--output' a name"
                .to_owned(),
        ));
    }
    let names = Names::new(&args.picture, args.inputs.len(), moments.range.count())?;
    let style_name = style.as_ref().map_or(style_choice::DEFAULT, |style| &style.name);
    names.check(&args.inputs, style_name, style.as_ref(), moments.range.first)?;

    let mut graphics = None;
    let mut saver = Saver::default();
    let mut progress = console.progress(args.inputs.len() * moments.range.count());
    let mut failed = false;
    // One input gives its own exit status; of several, the others are still drawn.
    let mut go_on = |failure: Failure| {
        if args.inputs.len() == 1 {
            return Err(failure);
        }
        failed = true;
        failure.print(console);
        Ok(())
    };
    for (index, path) in args.inputs.iter().enumerate() {
        let clip = args.picture.clip.as_deref();
        let (source, own_style) = match source::load(path, clip, moments.moves(), console) {
            Ok(loaded) => loaded,
            Err(failure) => {
                go_on(failure)?;
                continue;
            }
        };
        let graphics = match &mut graphics {
            Some(graphics) => graphics,
            none => none.insert(Graphics::open(args.picture.adapter.as_deref(), false, console)?),
        };
        let style = style_choice::choose(style.as_ref(), own_style)?;
        let shoot =
            Shoot { args, source: &source, style: &style, moments, names: &names, index, console };
        if let Err(failure) = shoot.draw(graphics, &mut saver, &mut progress) {
            go_on(failure)?;
        }
    }
    drop(progress);
    saver.report(console);
    if failed { Err(Failure::Reported) } else { Ok(()) }
}

/// The moments that are drawn.
#[derive(Clone, Copy, Debug)]
struct Moments {
    /// Numbers of the frames.
    range: FrameRange,
    /// The one moment in seconds that was asked for by `--time`.
    time: Option<f32>,
    /// Frames per second, if frames were asked for.
    fps: Option<f32>,
}

impl Moments {
    fn of(args: &RenderArgs) -> Self {
        let one = |frame| FrameRange { first: frame, last: frame };
        let range = args.frames.or(args.frame.map(one));
        Self {
            range: range.unwrap_or(one(0)),
            time: args.picture.time,
            fps: range.map(|_| args.fps),
        }
    }

    /// Whether a moment was asked for at all.
    fn moves(self) -> bool {
        self.time.is_some() || self.fps.is_some()
    }

    fn seconds(self, frame: i64) -> Option<f32> {
        match self.fps {
            Some(fps) => Some(frame as f32 / fps),
            None => self.time,
        }
    }
}

/// All pictures of one input.
struct Shoot<'a> {
    args: &'a RenderArgs,
    source: &'a Source,
    style: &'a StyleChoice,
    moments: Moments,
    names: &'a Names,
    /// Number of the input.
    index: usize,
    console: &'a Console,
}

impl Shoot<'_> {
    fn draw(&self, graphics: &Graphics, saver: &mut Saver, progress: &mut Progress<'_>) -> Outcome {
        let Self { args, source, style, console, .. } = self;
        let points = self.points()?;
        let mut prepared = graphics.prepare(&source.scene, &style.style, console)?;
        let layers = args.picture.layer_kinds();
        let inputs = [&args.inputs[..], &source.files, style.file.as_slice()].concat();
        let count = self.moments.range.count();
        for (i, frame) in self.moments.range.frames().enumerate() {
            let number = self.index * count + i;
            let target = self.names.target(&source.name, &style.name, frame, number);
            saver.check(&target, &layers, &inputs)?;
            let seconds = self.moments.seconds(frame);
            let pose = graphics.set_moment(&mut prepared, source, seconds, &style.style)?;
            let camera = self.camera(&pose, &points)?;
            if i == 0 {
                source.warn_of_reach(&camera, &pose, console);
            }
            let view = view::view(&args.picture, source, camera, frame);
            if args.dump_keys {
                keys::print(&source.name, frame, &prepared, &view)?;
            }
            let step = &mut |done, tiles| progress.set(number, done, tiles);
            let picture = graphics.picture(&source.name, &prepared, &view, &layers, step)?;
            saver.save(&picture, &target)?;
            progress.set(number + 1, 0, 1);
        }
        Ok(())
    }

    fn camera(&self, pose: &Pose, points: &[Vec3]) -> Outcome<ViewCamera> {
        match &self.args.camera {
            Some(name) => self.source.named_camera(name, pose),
            None => {
                let aspect = view::aspect(view::size(&self.args.picture, self.source));
                Ok(self.source.camera(&self.args.picture.orbit, pose, points, aspect))
            }
        }
    }

    /// The points that stick out in all frames, or in some of very many.
    fn points(&self) -> Outcome<Vec<Vec3>> {
        let range = self.moments.range;
        let step = range.count().div_ceil(MEASURED_POSES).max(1);
        let mut points = Vec::new();
        for frame in range.frames().step_by(step) {
            let pose = self.source.pose(self.moments.seconds(frame))?;
            points.extend(self.source.scene.extremes(&pose));
        }
        self.source.drawn(points)
    }
}
