use glam::{Vec3, Vec4};

use super::*;
use crate::render::ViewCamera;
use crate::scene::Projection;

fn sun(direction: Vec3) -> Light {
    let mut light: Light = bytemuck::Zeroable::zeroed();
    light.direction = direction.normalize_or(Vec3::Y).extend(0.0);
    light.kind = LIGHT_DIRECTIONAL;
    light
}

fn seen_from(x: f32, bounds: &Aabb) -> Projected {
    let camera = ViewCamera {
        world_from_camera: Affine3A::from_translation(Vec3::new(x, 0.5, 6.0)),
        projection: Projection::Perspective { fov_y: 0.4 },
        near: 0.1,
    };
    Projected::new(&camera, [200, 100], Some(*bounds))
}

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const BOUNDS: Aabb = Aabb { min: Vec3::new(-9.0, 0.0, -9.0), max: Vec3::new(9.0, 2.0, 3.0) };

#[test]
fn what_is_in_view_lies_in_the_map() {
    for direction in [Vec3::new(0.3, 1.0, 0.2), Vec3::Y, Vec3::new(-1.0, 0.1, 0.0)] {
        let projected = seen_from(0.3, &BOUNDS);
        let map = parallel(&sun(direction), &BOUNDS, &projected, ALL, 512);
        let mut inside = 0;
        for i in 0..20_u8 {
            for j in 0..20_u8 {
                let (x, z) = (0.9 * f32::from(i) - 8.55, 0.6 * f32::from(j) - 8.7);
                let p = Vec3::new(x, 0.0, z);
                let clip = projected.clip_from_world * p.extend(1.0);
                if clip.x.abs() > clip.w || clip.y.abs() > clip.w || clip.z > clip.w {
                    continue;
                }
                inside += 1;
                let ndc = (map.clip_from_world * p.extend(1.0)).truncate();
                assert!(ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0, "{p} is at {ndc}");
                assert!(ndc.z > 0.0 && ndc.z < 1.0, "{p} is at {ndc}");
            }
        }
        assert!(inside > 10, "the view shows something: {inside}");
    }
}

#[test]
fn the_grid_of_texels_stands_still_when_the_camera_moves() {
    let light = sun(Vec3::new(0.3, 1.0, 0.2));
    let texel_of = |x: f32| {
        let map = parallel(&light, &BOUNDS, &seen_from(x, &BOUNDS), ALL, 512);
        let ndc = map.clip_from_world.as_dmat4() * DVec4::new(0.1, 0.2, 0.3, 1.0);
        let place = (ndc.truncate().truncate() * 0.5 + 0.5) * 512.0;
        (map.texel_m, place - place.floor())
    };
    let (size, first) = texel_of(0.0);
    for i in 1..30_u8 {
        let (now, place) = texel_of(0.004 * f32::from(i));
        if now == size {
            let off = (place - first).abs();
            let off = off.min(1.0 - off);
            assert!(off.max_element() < 0.01, "step {i}: {place} and {first}");
        }
    }
}

#[test]
fn planes_keep_their_points_in_every_map() {
    let mut lamp: Light = bytemuck::Zeroable::zeroed();
    lamp.position = Vec4::new(1.0, 4.0, 2.0, 1.0);
    lamp.direction = Vec3::new(-0.2, -1.0, -0.3).normalize_or(Vec3::Y).extend(0.0);
    lamp.factors = Vec4::new(1.0, 0.0, 0.9, 0.7);
    let all = [
        parallel(&sun(Vec3::ONE), &BOUNDS, &seen_from(0.0, &BOUNDS), ALL, 512),
        cone(&lamp, &BOUNDS, 512),
    ];
    for map in all.into_iter().chain(cube(&lamp, &BOUNDS, 512)) {
        let normal = Vec3::new(0.2, 0.9, -0.3).normalize_or(Vec3::Y);
        let p = Vec3::new(0.4, 0.1, -0.7);
        let other = p + normal.any_orthonormal_vector() * 0.3;
        let plane = map.clip_from_plane * normal.extend(-normal.dot(p));
        for point in [p, other] {
            let clip = map.clip_from_world * point.extend(1.0);
            let off = plane.dot(clip) / (plane.length() * clip.length());
            assert!(off.abs() < 1e-4, "{off}");
        }
    }
}

#[test]
fn a_view_from_inside_sees_its_near_corners() {
    let bounds = Aabb { min: Vec3::splat(-50.0), max: Vec3::splat(50.0) };
    let projected = seen_from(0.0, &bounds);
    let seen = in_view(&corners(&bounds), projected.clip_from_world.as_dmat4(), ALL);
    let nearest = seen.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    assert!((nearest - 5.9).abs() < 1e-3, "{nearest}");
}

#[test]
fn cascades_hold_what_is_in_view_and_are_finer_near_the_eye() {
    let bounds = Aabb { min: Vec3::new(-300.0, -1.0, -300.0), max: Vec3::new(300.0, 2.0, 300.0) };
    let projected = seen_from(0.3, &bounds);
    let slices = super::slices(&bounds, &projected, MAX_CASCADES);
    assert_eq!(slices.len(), MAX_CASCADES);
    let light = sun(Vec3::new(0.3, 1.0, 0.2));
    let maps: Vec<ShadowMap> =
        slices.iter().map(|&s| parallel(&light, &bounds, &projected, s, 512)).collect();
    assert!(maps.windows(2).all(|pair| pair[0].texel_m < pair[1].texel_m));
    assert!(
        maps[0].texel_m < 0.05 * maps[3].texel_m,
        "{} and {}",
        maps[0].texel_m,
        maps[3].texel_m
    );
    for i in 0..60_u8 {
        for x in [-1.0, -0.4, 0.0, 0.7, 1.0] {
            // On the floor, in view, from near to far.
            let depth = 4.0 * 1.07_f64.powf(f64::from(i));
            let z = 6.0 - depth as f32;
            let p = Vec3::new(0.3 + x * 0.39 * depth as f32, -1.0, z);
            let clip = projected.clip_from_world * p.extend(1.0);
            if clip.x.abs() > clip.w || clip.y.abs() > clip.w || p.abs().max_element() > 300.0 {
                continue;
            }
            let slice = slices.iter().position(|s| depth >= s[0] && depth <= s[1]);
            let map = &maps[slice.expect("slices leave no gap")];
            let ndc = (map.clip_from_world * p.extend(1.0)).truncate();
            assert!(ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0, "{p} is at {ndc}");
        }
    }
    // What is about as near everywhere has one map.
    let small = Aabb { min: Vec3::splat(-0.5), max: Vec3::splat(0.5) };
    assert_eq!(super::slices(&small, &seen_from(0.0, &small), MAX_CASCADES).len(), 1);
}
