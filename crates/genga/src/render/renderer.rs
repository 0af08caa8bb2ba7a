//! The frame, as one list of passes.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use super::{
    RenderError,
    frame::{
        Aim, Output, Tile, frame_values, gbuffer_scale, has_line_colors, needs_line_depths,
        viewport,
    },
    generated::Light,
    gpu::{scope, timing::Timer},
    layouts::Layouts,
    passes::{
        beams::BeamPass,
        candidates::CandidatePass,
        composite::CompositePass,
        deform::DeformPass,
        depth::DepthPass,
        detect::DetectPass,
        gbuffer::GBufferPass,
        link::{LinkPass, SizePass},
        paint::{PaintOutput, PaintPass},
        plain::{PlainPass, PlainTargets},
        reference::ReferencePass,
        seams::SeamPass,
        shadow::ShadowPass,
        speed_lines::SpeedLinePass,
        strokes::StrokePass,
        walk::{WalkPass, lines_group},
        waves::WavePass,
    },
    picture::MAX_PICTURE_SIDE,
    prepare::{
        Prepared,
        lights::{MAX_LIGHTS, lights_in_view},
        waves,
    },
    targets::{TargetSize, Targets},
    view::{Projected, View},
    wave_targets::WaveTargets,
};
use crate::scene::{Beam, Pose, Scene, Wave, WaveMethod};
use crate::style::{LineMethod, Style};

/// Draws prepared scenes. Make one per device; it holds pipelines and targets, never a scene.
pub struct Renderer {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    layouts: Layouts,
    deform: DeformPass,
    gbuffer: GBufferPass,
    pub(crate) detect: DetectPass,
    depth: DepthPass,
    candidates: CandidatePass,
    walk: WalkPass,
    seams: SeamPass,
    link: LinkPass,
    sizes: SizePass,
    strokes: StrokePass,
    reference: ReferencePass,
    pub(crate) paint: PaintPass,
    composite: CompositePass,
    plain: PlainPass,
    /// Made when the first shadow is cast.
    shadow: OnceLock<ShadowPass>,
    /// Made when the first wave is drawn.
    waves: OnceLock<WavePass>,
    /// Made when the first beam is drawn.
    beams: OnceLock<BeamPass>,
    /// Made when something is fast.
    speed_lines: OnceLock<SpeedLinePass>,
    /// The targets of the last size drawn.
    targets: Mutex<Option<Arc<Targets>>>,
    /// Held while a picture is recorded and submitted: pictures share targets and uniforms.
    turn: Mutex<()>,
}

/// What [`Renderer::time_frame`] measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workload {
    /// The frame that the style asks for.
    Styled,
    /// The same geometry in one pass: texture and Lambert, no lines. The baseline.
    Plain,
    /// The passes of the energy waves alone, over the depths that the frame before has left: only
    /// [`FrameTimes::wall_ms`] and the waves' own passes mean something.
    Waves,
}

/// GPU time of one pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// Name of the pass.
    pub name: &'static str,
    /// Milliseconds.
    pub milliseconds: f64,
}

/// How long a frame took.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTimes {
    /// Each pass in its order; empty on devices without timestamp queries.
    pub passes: Vec<PassTime>,
    /// Milliseconds on the GPU from the first pass's beginning to the last one's end; `None` on
    /// devices without timestamp queries.
    pub gpu_ms: Option<f64>,
    /// Milliseconds from submission until the GPU was done, as the CPU sees it.
    pub wall_ms: f64,
}

impl Renderer {
    /// Makes the pipelines on a device of the caller's.
    ///
    /// WebGPU's default limits and no optional features are enough.
    ///
    /// # Errors
    /// What the driver refuses.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RenderError> {
        scope::checked(device, || {
            let layouts = Layouts::new(device);
            Ok(Self {
                device: device.clone(),
                queue: queue.clone(),
                deform: DeformPass::new(device, &layouts),
                gbuffer: GBufferPass::new(device, &layouts),
                detect: DetectPass::new(device),
                depth: DepthPass::new(device),
                candidates: CandidatePass::new(device, &layouts),
                walk: WalkPass::new(device, &layouts),
                seams: SeamPass::new(device, &layouts),
                link: LinkPass::new(device),
                sizes: SizePass::new(device),
                strokes: StrokePass::new(device, &layouts),
                reference: ReferencePass::new(device, &layouts),
                paint: PaintPass::new(device, &layouts),
                composite: CompositePass::new(device),
                plain: PlainPass::new(device, &layouts),
                shadow: OnceLock::new(),
                waves: OnceLock::new(),
                beams: OnceLock::new(),
                speed_lines: OnceLock::new(),
                layouts,
                targets: Mutex::new(None),
                turn: Mutex::new(()),
            })
        })
    }

    /// Uploads a scene under a style, in its rest pose.
    ///
    /// # Errors
    /// An inconsistent scene, or what the driver refuses.
    pub fn prepare(&self, scene: &Scene, style: &Style) -> Result<Prepared, RenderError> {
        let mut prepared = Prepared::new(&self.device, &self.queue, &self.layouts, scene, style)?;
        self.set_pose(&mut prepared, scene, &Pose::rest(scene))?;
        Ok(prepared)
    }

    /// Brings a prepared scene to a pose. `scene` must be the one that it was prepared from.
    ///
    /// # Errors
    /// A pose of another scene, or what the driver refuses.
    pub fn set_pose(
        &self,
        prepared: &mut Prepared,
        scene: &Scene,
        pose: &Pose,
    ) -> Result<(), RenderError> {
        self.set_motion(prepared, scene, pose, &[])
    }

    /// As [`Self::set_pose`], with the poses before it, for speed lines and smears: at even steps,
    /// the last one at the shutter's opening (see [`crate::style::Motion::moments`]). Without any
    /// nothing moves.
    ///
    /// # Errors
    /// A pose of another scene, or what the driver refuses.
    pub fn set_motion(
        &self,
        prepared: &mut Prepared,
        scene: &Scene,
        pose: &Pose,
        past: &[Pose],
    ) -> Result<(), RenderError> {
        if !std::iter::once(pose).chain(past).all(|pose| prepared.fits(scene, pose)) {
            let reason = "the pose or scene is not the one that was prepared".to_owned();
            return Err(RenderError::View { reason });
        }
        crate::scene::validate_waves(&scene.waves, scene.wave_method, scene.nodes.len())?;
        crate::scene::validate_beams(&scene.beams, scene.nodes.len())?;
        scope::checked(&self.device, || {
            prepared.write_pose(&self.device, &self.queue, scene, (pose, past));
            let mut encoder = self.encoder("deform");
            self.deform.run(&self.device, &mut encoder, prepared, &mut Timer::off());
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// Takes over waves, which may all have changed, and places them at a pose: as
    /// [`Self::set_pose`] without the geometry.
    ///
    /// # Errors
    /// A wave that cannot be drawn, or what the driver refuses.
    pub fn set_waves(
        &self,
        prepared: &mut Prepared,
        waves: &[Wave],
        method: WaveMethod,
        pose: &Pose,
    ) -> Result<(), RenderError> {
        crate::scene::validate_waves(waves, method, pose.world_from_node.len())?;
        scope::checked(&self.device, || {
            prepared.waves.write(&self.device, &self.queue, waves, method, pose);
            Ok(())
        })
    }

    /// Takes over beams, which may all have changed, and places them at a pose: as
    /// [`Self::set_pose`] without the geometry. Which surfaces are marked stays as it was prepared.
    ///
    /// # Errors
    /// A beam that cannot be drawn, or what the driver refuses.
    pub fn set_beams(
        &self,
        prepared: &mut Prepared,
        beams: &[Beam],
        pose: &Pose,
    ) -> Result<(), RenderError> {
        crate::scene::validate_beams(beams, pose.world_from_node.len())?;
        scope::checked(&self.device, || {
            let blend = prepared.style.paint.blend_space;
            prepared.beams.write(&self.device, &self.queue, beams, pose, blend);
            Ok(())
        })
    }

    /// Draws a view into `target`, which has the view's size and the given format.
    ///
    /// Values are premultiplied; sRGB and float formats get linear light, others sRGB-encoded
    /// values.
    ///
    /// # Errors
    /// A size over the device's limit (see [`Self::picture`] for larger ones), impossible camera
    /// numbers, or what the driver refuses.
    pub fn render(
        &self,
        prepared: &Prepared,
        view: &View,
        target: &wgpu::TextureView,
        format: wgpu::TextureFormat,
    ) -> Result<(), RenderError> {
        let limit = self.device.limits().max_texture_dimension_2d / view.supersample.clamp(1, 4);
        check_view(view, limit)?;
        let output = Output {
            background: view.background,
            paint: true,
            lines: true,
            glow: true,
            beams: true,
            energy: false,
            dithered: is_8_bit(format) && !format.is_srgb(),
            straight: false,
        };
        let _turn = self.turn();
        scope::checked(&self.device, || {
            let tile = Tile { origin: [0, 0], size: view.size };
            let mut encoder = self.encoder("frame");
            let mut timer = Timer::off();
            let targets = self.draw_tile(&mut encoder, prepared, view, tile, output, &mut timer);
            let output = (target, format);
            self.composite.run(&self.device, &mut encoder, prepared, &targets, output, &mut timer);
            self.queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// The frame without its last step: every pass up to the composite.
    pub(crate) fn draw_tile(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        view: &View,
        tile: Tile,
        output: Output,
        timer: &mut Timer,
    ) -> Arc<Targets> {
        let device = &self.device;
        let projected = Projected::new(&view.camera, view.size, prepared.bounds);
        let maps = self.write_frame(prepared, view, &projected, tile, output);
        if !maps.is_empty() {
            let pass = self.shadow.get_or_init(|| ShadowPass::new(device, &self.layouts));
            pass.run(encoder, prepared, &maps, timer);
        }
        let targets = self.targets_of(prepared, view, tile);
        let aim = Aim { eye: projected.eye, tile, viewport: viewport(device, view, tile) };

        self.gbuffer.run(device, encoder, prepared, &targets, &aim, timer);
        match prepared.style.lines.method {
            LineMethod::Contour => self.detect.seams(device, encoder, prepared, &targets, timer),
            LineMethod::Reference | LineMethod::Image => {
                self.detect.mask(device, encoder, prepared, &targets, timer);
            }
            LineMethod::None | LineMethod::Hull | LineMethod::Rim => {}
        }
        self.paint.run(device, encoder, prepared, &targets, (&aim, PaintOutput::All), timer);
        if let Some(depth) = &targets.picture_depth {
            self.depth.run(device, encoder, &prepared.frame, &targets, depth, timer);
        }
        if targets.size.beams {
            let pass = self.beams.get_or_init(|| BeamPass::new(device));
            pass.run(device, encoder, prepared, (&targets, &targets.beams), &aim, timer);
        }
        match prepared.style.lines.method {
            LineMethod::Contour => self.draw_contours(encoder, prepared, &targets, timer),
            LineMethod::Reference => {
                self.reference.run(device, encoder, &self.layouts, prepared, &targets, timer);
            }
            LineMethod::None | LineMethod::Hull | LineMethod::Rim | LineMethod::Image => {}
        }
        if prepared.speed_lines.count > 0 {
            let pass = self.speed_lines.get_or_init(|| SpeedLinePass::new(device));
            pass.run(device, encoder, prepared, &targets, timer);
        }
        self.draw_waves(encoder, prepared, view, (tile, output), (&projected, &targets), timer);
        targets
    }

    /// Lines of the mesh and of the picture → pieces → strokes.
    fn draw_contours(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        timer: &mut Timer,
    ) {
        let device = &self.device;
        self.candidates.run(device, encoder, &self.layouts, prepared, timer);
        let lines = lines_group(device, &self.layouts, prepared, targets);
        let with = (&self.sizes, &lines);
        self.walk.run(device, encoder, with, prepared, targets, timer);
        self.seams.run(device, encoder, with, prepared, targets, timer);
        self.link.run(device, encoder, &self.sizes, prepared, targets, timer);
        self.strokes.run(device, encoder, &self.layouts, prepared, targets, timer);
    }

    fn targets_of(&self, prepared: &Prepared, view: &View, tile: Tile) -> Arc<Targets> {
        self.targets_for(TargetSize {
            pixels: tile.size,
            paint_scale: view.supersample,
            gbuffer_scale: gbuffer_scale(prepared, view),
            line_colors: has_line_colors(&prepared.style) || needs_line_depths(prepared),
            glow_layers: prepared.waves.layers.len() as u32,
            beams: !prepared.beams.items.is_empty(),
        })
    }

    /// The energy waves, if there are any.
    fn draw_waves(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        view: &View,
        (tile, output): (Tile, Output),
        (projected, targets): (&Projected, &Targets),
        timer: &mut Timer,
    ) {
        let Some(waves) = &targets.waves else { return };
        let pass = self.waves.get_or_init(|| WavePass::new(&self.device));
        self.write_wave_view(prepared, view, tile, waves);
        let is_wanted = (!prepared.draws.is_empty(), output.energy);
        let kind = prepared.waves.exact_kind(view, projected, is_wanted);
        pass.run(&self.device, encoder, (prepared, kind), (targets, waves), timer);
    }

    /// Writes the frame's uniform and the lights as this camera sees them. Returns the texels along
    /// a side of each of their shadow maps.
    pub(crate) fn write_frame(
        &self,
        prepared: &Prepared,
        view: &View,
        projected: &Projected,
        tile: Tile,
        output: Output,
    ) -> Vec<u32> {
        let world_from_camera = &view.camera.world_from_camera;
        let mut lights: Vec<Light> =
            lights_in_view(&prepared.lights, &prepared.style.light, world_from_camera);
        let tiles = [tile, viewport(&self.device, view, tile)];
        let frame = frame_values(prepared, view, projected, tiles, output);
        prepared.highlights.write(&self.queue, prepared, view, &lights);
        prepared.shadings.write(&self.queue, &lights);
        lights.extend(prepared.beams.lights());
        lights.truncate(MAX_LIGHTS);
        let maps = prepared.shadows.write(&self.queue, prepared, view, projected, &mut lights);
        // Loops over them end at the first one without weight.
        lights.resize(MAX_LIGHTS, bytemuck::Zeroable::zeroed());
        self.queue.write_buffer(&prepared.light_data, 0, bytemuck::cast_slice(&lights));
        self.queue.write_buffer(&prepared.frame, 0, bytemuck::bytes_of(&frame));
        let glow = prepared.waves.glow_values(output);
        self.queue.write_buffer(&prepared.waves.glow, 0, bytemuck::bytes_of(&glow));
        maps
    }

    fn write_wave_view(&self, prepared: &Prepared, view: &View, tile: Tile, targets: &WaveTargets) {
        let projected = Projected::new(&view.camera, view.size, prepared.bounds);
        // A smaller detection has the picture's depth beside it.
        let scale = gbuffer_scale(prepared, view);
        let scale = if scale.is_small() { 1 } else { scale.texels };
        let has_surfaces = !prepared.draws.is_empty();
        let data = &prepared.waves;
        let values = waves::view_values(data, view, &projected, tile, scale, has_surfaces);
        self.queue.write_buffer(&data.view, 0, bytemuck::bytes_of(&values));
        let levels = targets.grid.levels(tile.origin, tile.size);
        for (buffer, values) in targets.levels.iter().zip(&levels) {
            self.queue.write_buffer(buffer, 0, bytemuck::bytes_of(values));
        }
    }

    /// Runs the last step alone, with other contents than the frame's.
    pub(crate) fn composite(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        output: (&wgpu::TextureView, wgpu::TextureFormat),
        timer: &mut Timer,
    ) {
        self.composite.run(&self.device, encoder, prepared, targets, output, timer);
    }

    /// Draws one frame off-screen and measures it. The deformation is part of it.
    ///
    /// # Errors
    /// As [`Self::render`], or a lost device.
    pub async fn time_frame(
        &self,
        prepared: &Prepared,
        view: &View,
        workload: Workload,
    ) -> Result<FrameTimes, RenderError> {
        let limit = self.device.limits().max_texture_dimension_2d / view.supersample.clamp(1, 4);
        check_view(view, limit)?;
        let device = &self.device;
        let mut timer = Timer::new(device);
        let (timestamps, wall_ms) = {
            let _turn = self.turn();
            let commands = self.timed_commands(prepared, view, workload, &mut timer)?;
            let start = std::time::Instant::now();
            self.queue.submit([commands.0]);
            device
                .poll(wgpu::PollType::wait_indefinitely())
                .map_err(|e| RenderError::DeviceLost { message: e.to_string() })?;
            (commands.1, start.elapsed().as_secs_f64() * 1e3)
        };
        let (passes, gpu_ms) = match timestamps {
            Some(buffer) => {
                let (passes, total) = timer.read(device, &self.queue, &buffer).await?;
                (passes, Some(total))
            }
            None => (Vec::new(), None),
        };
        let passes = passes
            .into_iter()
            .map(|(name, milliseconds)| PassTime { name, milliseconds })
            .collect();
        Ok(FrameTimes { passes, gpu_ms, wall_ms })
    }

    /// The commands of a measured frame, and the buffer that its timestamps end in.
    fn timed_commands(
        &self,
        prepared: &Prepared,
        view: &View,
        workload: Workload,
        timer: &mut Timer,
    ) -> Result<(wgpu::CommandBuffer, Option<wgpu::Buffer>), RenderError> {
        let device = &self.device;
        let output = Output {
            background: view.background,
            paint: true,
            lines: true,
            glow: true,
            beams: true,
            energy: false,
            dithered: true,
            straight: false,
        };
        let tile = Tile { origin: [0, 0], size: view.size };
        let mut encoder = self.encoder("timed frame");
        scope::checked(device, || {
            if workload != Workload::Waves {
                self.deform.run(device, &mut encoder, prepared, timer);
            }
            match workload {
                Workload::Styled => {
                    let targets = self.draw_tile(&mut encoder, prepared, view, tile, output, timer);
                    let shown = super::picture::color_target(device, view.size);
                    let format = shown.texture.format();
                    self.composite(&mut encoder, prepared, &targets, (&shown.view, format), timer);
                }
                Workload::Waves => {
                    let projected = Projected::new(&view.camera, view.size, prepared.bounds);
                    let targets = self.targets_of(prepared, view, tile);
                    self.draw_waves(
                        &mut encoder,
                        prepared,
                        view,
                        (tile, output),
                        (&projected, &targets),
                        timer,
                    );
                }
                Workload::Plain => {
                    let projected = Projected::new(&view.camera, view.size, prepared.bounds);
                    self.write_frame(prepared, view, &projected, tile, output);
                    let targets = PlainTargets::new(device, view.size, view.supersample);
                    let eye = projected.eye;
                    self.plain.run(device, &mut encoder, prepared, &targets, eye, timer);
                }
            }
            let timestamps = timer.resolve(device, &mut encoder);
            Ok((encoder.finish(), timestamps))
        })
    }

    /// Waits until no other thread records a picture.
    pub(crate) fn turn(&self) -> MutexGuard<'_, ()> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn targets_for(&self, size: TargetSize) -> Arc<Targets> {
        let mut slot = self.targets.lock().unwrap_or_else(PoisonError::into_inner);
        match &*slot {
            Some(targets) if targets.size == size => Arc::clone(targets),
            _ => {
                // The old ones go first: two sets may not fit the memory.
                *slot = None;
                let targets = Arc::new(Targets::new(&self.device, size));
                *slot = Some(Arc::clone(&targets));
                targets
            }
        }
    }

    pub(crate) fn encoder(&self, label: &str) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) })
    }
}

/// Whether a target of that format has so few steps that a smooth glow shows bands.
fn is_8_bit(format: wgpu::TextureFormat) -> bool {
    use wgpu::TextureFormat as F;
    matches!(
        format,
        F::Rgba8Unorm | F::Rgba8UnormSrgb | F::Bgra8Unorm | F::Bgra8UnormSrgb | F::Rgb10a2Unorm
    )
}

/// Refuses impossible views before they reach the driver.
pub(crate) fn check_view(view: &View, limit: u32) -> Result<(), RenderError> {
    let [width, height] = view.size;
    let limit = limit.min(MAX_PICTURE_SIDE);
    if width == 0 || height == 0 || width > limit || height > limit {
        return Err(RenderError::Size { width, height, limit });
    }
    if !(1..=4).contains(&view.supersample) {
        let reason = format!("supersampling must be 1 to 4, not {}", view.supersample);
        return Err(RenderError::View { reason });
    }
    let camera = &view.camera;
    let size_ok = match camera.projection {
        crate::scene::Projection::Perspective { fov_y } => fov_y > 0.0 && fov_y < 3.2,
        crate::scene::Projection::Orthographic { height } => height > 0.0 && height.is_finite(),
    };
    let near_ok = camera.near > 0.0 && camera.near.is_finite();
    if !(size_ok && near_ok && camera.world_from_camera.is_finite()) {
        let reason = "the camera's place, angle or near distance is not a usable number".to_owned();
        return Err(RenderError::View { reason });
    }
    Ok(())
}
