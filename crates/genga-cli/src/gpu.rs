use std::time::Instant;

use genga::render::{Gpu, GpuOptions, LayerKind, Picture, Prepared, RenderError, Renderer, View};
use genga::scene::{Pose, Scene};
use genga::style::Style;

use crate::console::Console;
use crate::failure::{Failure, Outcome};
use crate::source::{Moment, Source};
use crate::text::one_line;

/// A device with its renderer.
pub(crate) struct Graphics {
    /// The device.
    pub(crate) gpu: Gpu,
    /// What draws on it.
    pub(crate) renderer: Renderer,
}

impl Graphics {
    /// The adapter of that name, or the fastest one. Says so if the processor has to draw.
    pub(crate) fn open(
        adapter: Option<&str>,
        timestamps: bool,
        console: &Console,
    ) -> Outcome<Self> {
        let options = GpuOptions { adapter: adapter.map(str::to_owned), timestamps };
        let gpu = pollster::block_on(Gpu::headless(&options)).map_err(Failure::message)?;
        if gpu.is_software() && adapter.is_none() {
            console.note(&format!(
                "no GPU found; drawing with {} (software)",
                one_line(&gpu.info().name)
            ));
        }
        let info = gpu.info();
        log::info!(
            "adapter: {} ({}, {} {})",
            info.name,
            info.backend,
            info.driver,
            info.driver_info
        );
        let renderer = Renderer::new(&gpu.device, &gpu.queue).map_err(Failure::message)?;
        Ok(Self { gpu, renderer })
    }

    /// Uploads a scene and prints what is odd about it.
    pub(crate) fn prepare(
        &self,
        scene: &Scene,
        style: &Style,
        console: &Console,
    ) -> Outcome<Prepared> {
        let prepared = self.check(&scene.name, self.renderer.prepare(scene, style))?;
        for warning in prepared.warnings() {
            console.warning(&one_line(&format!("{}: {warning}", scene.name)));
        }
        Ok(prepared)
    }

    /// Brings a prepared source to a moment: its pose, what moves, waves and beams. Returns the pose.
    pub(crate) fn set_moment(
        &self,
        prepared: &mut Prepared,
        source: &Source,
        seconds: Option<f32>,
        style: &Style,
    ) -> Outcome<Pose> {
        let Moment { pose, waves, beams } = source.moment(seconds)?;
        let past = source.past(seconds, &style.motion)?;
        let (renderer, name, scene) = (&self.renderer, &source.name, &source.scene);
        self.check(name, renderer.set_motion(prepared, scene, &pose, &past))?;
        if !waves.is_empty() {
            let method = scene.wave_method;
            self.check(name, renderer.set_waves(prepared, &waves, method, &pose))?;
        }
        if !beams.is_empty() {
            self.check(name, renderer.set_beams(prepared, &beams, &pose))?;
        }
        Ok(pose)
    }

    /// Draws a picture.
    pub(crate) fn picture(
        &self,
        name: &str,
        prepared: &Prepared,
        view: &View,
        layers: &[LayerKind],
        progress: &mut dyn FnMut(u32, u32),
    ) -> Outcome<Picture> {
        let begin = Instant::now();
        let picture = self.renderer.picture(prepared, view, layers, progress);
        let picture = self.check(name, pollster::block_on(picture))?;
        let [width, height] = view.size;
        let milliseconds = begin.elapsed().as_secs_f64() * 1e3;
        log::info!("drew {name} at {width}x{height} in {milliseconds:.0} ms");
        Ok(picture)
    }

    /// Names what could not be drawn, and adds what the driver said meanwhile.
    pub(crate) fn check<T>(&self, name: &str, result: Result<T, RenderError>) -> Outcome<T> {
        let fault = self.gpu.take_fault();
        match (result, fault) {
            (Ok(value), None) => Ok(value),
            (Ok(_), Some(fault)) => Err(Failure::Message(one_line(&format!(
                "{name}: the graphics driver reports an error: {fault}"
            )))),
            (Err(error), _) => Err(Failure::Message(one_line(&format!("{name}: {error}")))),
        }
    }
}
