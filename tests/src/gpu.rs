//! The device and renderer that all tests of a program share.

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use genga::render::{Gpu, GpuOptions, LayerKind, Picture, Renderer, View};
use genga::scene::{Pose, Scene};
use genga::style::Style;

/// One device with its renderer.
pub struct Shared {
    /// The device.
    pub gpu: Gpu,
    /// The renderer, whose pipelines compile once for all tests.
    pub renderer: Renderer,
    turn: Mutex<()>,
}

impl Shared {
    /// Waits for the device. Tests draw one after the other: the driver has all processors
    /// anyway, and memory stays bounded.
    pub fn turn(&self) -> MutexGuard<'_, ()> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

static SHARED: LazyLock<Result<Shared, String>> = LazyLock::new(|| {
    let gpu = pollster::block_on(Gpu::headless(&GpuOptions::default()))
        .map_err(|error| format!("the picture tests need a graphics adapter: {error}"))?;
    let renderer = Renderer::new(&gpu.device, &gpu.queue)
        .map_err(|error| format!("the renderer cannot be made: {error}"))?;
    Ok(Shared { gpu, renderer, turn: Mutex::new(()) })
});

/// The shared device and renderer.
///
/// # Panics
/// Without an adapter, with the sentence that says what to install: a test that draws nothing
/// proves nothing.
pub fn shared() -> &'static Shared {
    match &*SHARED {
        Ok(shared) => shared,
        Err(reason) => panic!("{reason}"),
    }
}

/// Draws a scene in its rest pose.
///
/// # Panics
/// If the renderer reports an error.
pub fn draw(scene: &Scene, style: &Style, view: &View) -> Picture {
    draw_layers(scene, style, view, &[])
}

/// Draws a scene in its rest pose, with layers.
///
/// # Panics
/// If the renderer reports an error.
pub fn draw_layers(scene: &Scene, style: &Style, view: &View, layers: &[LayerKind]) -> Picture {
    draw_posed(scene, &Pose::rest(scene), style, view, layers)
}

/// Draws a scene in a pose, with layers.
///
/// # Panics
/// If the renderer reports an error, or the driver one that the renderer did not.
pub fn draw_posed(
    scene: &Scene,
    pose: &Pose,
    style: &Style,
    view: &View,
    layers: &[LayerKind],
) -> Picture {
    let shared = shared();
    let _turn = shared.turn();
    let renderer = &shared.renderer;
    let mut prepared = renderer.prepare(scene, style).expect("the scene can be prepared");
    renderer.set_pose(&mut prepared, scene, pose).expect("the pose fits the scene");
    let picture = pollster::block_on(renderer.picture(&prepared, view, layers, &mut |_, _| {}))
        .expect("the picture can be drawn");
    assert_eq!(shared.gpu.take_fault(), None, "the driver complained");
    picture
}
