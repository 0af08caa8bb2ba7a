use genga::render::{Orbit, ViewCamera};
use genga::scene::Aabb;
use glam::Affine3A;

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
    let bounds = source.drawn(source.scene.bounds(&pose))?;
    let aspect = view::aspect(view::size(picture, &source));
    let cameras = turn(&bounds, &source.orbit(&picture.orbit), aspect, args.count);

    let graphics = Graphics::open(picture.adapter.as_deref(), false, console)?;
    let mut prepared = graphics.prepare(&source.scene, &style.style, console)?;
    let posed = graphics.renderer.set_pose(&mut prepared, &source.scene, &pose);
    graphics.check(&source.name, posed)?;
    let layers = picture.layer_kinds();
    let inputs = [&source.files[..], style.file.as_slice()].concat();
    let mut saver = Saver::default();
    let mut progress = console.progress(count);
    for (frame, camera) in cameras.into_iter().enumerate() {
        let target = names.target(&source.name, &style.name, frame as i64, frame);
        saver.check(&target, &layers, &inputs)?;
        let view = view::view(picture, &source, camera);
        let drawn = pollster::block_on(graphics.renderer.picture(
            &prepared,
            &view,
            &layers,
            &mut |done, tiles| progress.set(frame, done, tiles),
        ));
        saver.save(&graphics.check(&source.name, drawn)?, &target)?;
        progress.set(frame + 1, 0, 1);
    }
    drop(progress);
    saver.report(console);
    Ok(())
}

/// Cameras of a full turn to the right round `bounds`, all at the distance from which it fits
/// every frame, so that the model does not breathe.
fn turn(bounds: &Aabb, orbit: &Orbit, aspect: f32, count: u32) -> Vec<ViewCamera> {
    let angle = |frame: u32| 360.0 * frame as f32 / count as f32;
    let fitted: Vec<ViewCamera> = (0..count)
        .map(|frame| {
            let azimuth_deg = orbit.azimuth_deg + angle(frame);
            ViewCamera::orbit(bounds, &Orbit { azimuth_deg, ..*orbit }, aspect)
        })
        .collect();
    let center = bounds.center();
    let distance =
        |camera: &ViewCamera| camera.world_from_camera.translation.distance(center.into());
    let height = |camera: &ViewCamera| match camera.projection {
        genga::scene::Projection::Orthographic { height } => height,
        genga::scene::Projection::Perspective { .. } => 0.0,
    };
    let near = fitted.iter().map(|camera| camera.near).fold(f32::INFINITY, f32::min);
    let farthest = fitted.iter().enumerate().max_by(|(_, a), (_, b)| {
        distance(a).total_cmp(&distance(b)).then(height(a).total_cmp(&height(b)))
    });
    let Some((farthest, camera)) = farthest else { return Vec::new() };
    (0..count)
        .map(|frame| {
            let turn = (angle(frame) - angle(farthest as u32)).to_radians();
            let around = Affine3A::from_translation(center)
                * Affine3A::from_rotation_y(turn)
                * Affine3A::from_translation(-center);
            ViewCamera { world_from_camera: around * camera.world_from_camera, near, ..*camera }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use genga::scene::Projection;
    use glam::Vec3;

    use super::*;

    /// Largest coordinate of the corners in the picture, where 1 is its edge.
    fn reach(camera: &ViewCamera, bounds: &Aabb, aspect: f32) -> f32 {
        let camera_from_world = camera.world_from_camera.inverse();
        let corner = |i: usize| {
            let pick = |bit: usize, low, high| if i & bit == 0 { low } else { high };
            let (a, b) = (bounds.min, bounds.max);
            let p = Vec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z));
            let p = camera_from_world.transform_point3(p);
            let half = match camera.projection {
                Projection::Perspective { fov_y } => -p.z * (0.5 * fov_y).tan(),
                Projection::Orthographic { height } => 0.5 * height,
            };
            assert!(-p.z > camera.near);
            (p.x.abs() / (half * aspect)).max(p.y.abs() / half)
        };
        (0..8).map(corner).fold(0.0, f32::max)
    }

    #[test]
    fn the_model_fits_every_frame_at_one_distance() {
        let bounds = Aabb { min: Vec3::new(-3.0, 0.0, 1.0), max: Vec3::new(5.0, 2.0, 2.0) };
        for orthographic in [false, true] {
            let orbit = Orbit { orthographic, ..Orbit::default() };
            let cameras = turn(&bounds, &orbit, 1.5, 24);
            assert_eq!(cameras.len(), 24);
            let reaches: Vec<f32> = cameras.iter().map(|c| reach(c, &bounds, 1.5)).collect();
            assert!(reaches.iter().all(|&r| r < 0.98), "{reaches:?}");
            // One of them is the tight one.
            assert!(reaches.iter().any(|&r| r > 0.8), "{reaches:?}");
            let distance =
                |c: &ViewCamera| c.world_from_camera.translation.distance(bounds.center().into());
            let first = distance(&cameras[0]);
            assert!(cameras.iter().all(|c| (distance(c) - first).abs() < 1e-3 * first));
            // The first frame is where the orbit says, and the turn goes to the right.
            let back = |i: usize| Vec3::from(cameras[i].world_from_camera.matrix3.z_axis);
            let expected = ViewCamera::orbit(&bounds, &orbit, 1.5);
            let expected = Vec3::from(expected.world_from_camera.matrix3.z_axis);
            assert!(back(0).distance(expected) < 1e-4);
            assert!(back(0).cross(back(1)).y > 0.0);
        }
    }
}
