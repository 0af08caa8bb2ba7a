use genga::render::{Orbit, ViewCamera};
use glam::Vec3;

use crate::args::TurntableArgs;
use crate::console::Console;
use crate::failure::Outcome;
use crate::gpu::Graphics;
use crate::names::Names;
use crate::save::Saver;
use crate::source;
use crate::style_choice;
use crate::view;

/// Draws the frames of a full turn of the camera.
pub(crate) fn run(args: &TurntableArgs, console: &Console) -> Outcome {
    let picture = &args.picture;
    let style = picture.style.as_deref().map(style_choice::find).transpose()?;
    let count = args.count as usize;
    let names = Names::new(picture, 1, count)?;
    let style_name = style.as_ref().map_or(style_choice::DEFAULT, |style| &style.name);
    names.check(std::slice::from_ref(&args.input), style_name, style.as_ref(), 0)?;

    let moves = picture.time.is_some();
    let (source, own_style) = source::load(&args.input, picture.clip.as_deref(), moves, console)?;
    let style = style_choice::choose(style.as_ref(), own_style)?;
    let pose = source.pose(picture.time)?;
    let points = source.drawn(source.scene.extremes(&pose))?;
    let aspect = view::aspect(view::size(picture, &source));
    let cameras = turn(&points, &source.orbit(&picture.orbit), aspect, args.count);

    let graphics = Graphics::open(picture.adapter.as_deref(), false, console)?;
    let mut prepared = graphics.prepare(&source.scene, &style.style, console)?;
    graphics.set_moment(&mut prepared, &source, picture.time, &style.style)?;
    let layers = picture.layer_kinds();
    let inputs = [&source.files[..], style.file.as_slice()].concat();
    let mut saver = Saver::default();
    let mut progress = console.progress(count);
    for (frame, camera) in cameras.into_iter().enumerate() {
        let target = names.target(&source.name, &style.name, frame as i64, frame);
        saver.check(&target, &layers, &inputs)?;
        let view = view::view(picture, &source, camera, frame as i64);
        let step = &mut |done, tiles| progress.set(frame, done, tiles);
        let drawn = graphics.picture(&source.name, &prepared, &view, &layers, step)?;
        saver.save(&drawn, &target)?;
        progress.set(frame + 1, 0, 1);
    }
    drop(progress);
    saver.report(console);
    Ok(())
}

/// Cameras of a full turn to the right, all at the distance from which every frame fits, so that
/// the model does not breathe.
fn turn(points: &[Vec3], orbit: &Orbit, aspect: f32, count: u32) -> Vec<ViewCamera> {
    (0..count)
        .map(|frame| {
            let azimuth_deg = orbit.azimuth_deg + 360.0 * frame as f32 / count as f32;
            ViewCamera::turntable(points, &Orbit { azimuth_deg, ..*orbit }, aspect)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_turn_begins_at_the_orbit_and_goes_to_the_right() {
        let points = [Vec3::new(-3.0, 0.0, 1.0), Vec3::new(5.0, 2.0, 2.0)];
        let orbit = Orbit::default();
        let cameras = turn(&points, &orbit, 1.5, 24);
        assert_eq!(cameras.len(), 24);
        let back = |camera: &ViewCamera| Vec3::from(camera.world_from_camera.matrix3.z_axis);
        let expected = ViewCamera::orbit_points(&points, &orbit, 1.5);
        assert!(back(&cameras[0]).distance(back(&expected)) < 1e-4);
        assert!(back(&cameras[0]).cross(back(&cameras[1])).y > 0.0);
        assert!(back(&cameras[23]).cross(back(&cameras[0])).y > 0.0);
    }
}
