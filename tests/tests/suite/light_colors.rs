//! The colours of lights on the tones that they give, compared with f64.

use std::f64::consts::FRAC_PI_8;

use genga::render::{Picture, View};
use genga::scene::{LightKind, Scene, Transform};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{Builder, light, ortho_view, parts, style};
use genga_tests::{Eye, Pixels, draw};
use glam::{DVec2, DVec3, Quat, Vec2, Vec3};

const RED: Vec3 = Vec3::new(1.0, 0.1, 0.05);
const BLUE: Vec3 = Vec3::new(0.1, 0.2, 1.0);
const LEFT: Vec3 = Vec3::new(-1.0, 0.4, 0.5);
const RIGHT: Vec3 = Vec3::new(0.9, -0.2, 0.6);

fn view() -> View {
    View { supersample: 1, ..ortho_view([128, 128], 2.0) }
}

/// A white ball under lights of those colours and intensities.
fn ball(lights: &[(Vec3, Vec3, f32)]) -> Scene {
    let mut scene = Builder::new();
    scene.object("ball", shapes::uv_sphere(96, 48, 0.9), None, Transform::default());
    for &(from, color, intensity) in lights {
        let mut light = light(LightKind::Directional, intensity);
        light.color = color;
        scene.light(light, 5.0 * from);
    }
    scene.build()
}

const DARK: f64 = 64.0 / 255.0;
const MIDDLE: f64 = 0.6;

/// Three tones of grey: dark, from 0.5 on in the middle, from 0.7 on white.
fn tones(rest: &str) -> Style {
    style(&format!(
        "[lines]\nmethod = \"none\"\n[paint]\n{rest}\n[paint.ramp]\nstops = [{{ at = 0, color = \
         \"#404040\" }}, {{ at = 0.5, color = \"#999999\" }}, {{ at = 0.7, color = \"#ffffff\" }}]"
    ))
}

fn displayed(linear: f32) -> f64 {
    let c = f64::from(linear);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// A tone in a light of that colour.
fn toned(t: f64, color: Vec3) -> [u8; 3] {
    let brightest = color.max_element();
    color.to_array().map(|c| {
        let c = displayed(c / brightest);
        let (tone, part) = if t < 0.5 {
            return (255.0 * DARK).round() as u8;
        } else if t < 0.7 {
            (MIDDLE, 0.5)
        } else {
            (1.0, 1.0)
        };
        let step = DARK + (tone - DARK) * c;
        (255.0 * step * (1.0 + 0.5 * part * (c - 1.0))).round() as u8
    })
}

/// What is wanted where a normal looks, under those lights.
fn wanted(n: DVec3, lights: &[(Vec3, Vec3, f32)]) -> [u8; 3] {
    let strength = |&(_, color, intensity): &(Vec3, Vec3, f32)| {
        f64::from(intensity) * f64::from(color.max_element())
    };
    let total: f64 = lights.iter().map(strength).sum();
    let part = |light: &(Vec3, Vec3, f32)| {
        strength(light) / total * (0.5 + 0.5 * n.dot(light.0.as_dvec3().normalize()))
    };
    let best = lights.iter().max_by(|a, b| part(a).total_cmp(&part(b))).expect("a light");
    toned(lights.iter().map(part).sum(), best.1)
}

/// Asserts that each pixel is as wanted, unless an edge passes within a pixel and a half of it.
/// Returns how many colours there were.
fn assert_as_wanted(picture: &Picture, lights: &[(Vec3, Vec3, f32)]) -> usize {
    let eye = Eye::new(&view());
    let normal = |p: DVec2| {
        let ray = eye.ray(p);
        ray.meets_sphere(DVec3::ZERO, 0.9).map(|t| ray.point(t) / 0.9)
    };
    let mut colors: Vec<[u8; 3]> = Vec::new();
    for (x, y) in picture.places() {
        let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let around = (0..16).map(|i| middle + 1.5 * DVec2::from_angle(f64::from(i) * FRAC_PI_8));
        let seen: Option<Vec<[u8; 3]>> =
            around.chain([middle]).map(|p| normal(p).map(|n| wanted(n, lights))).collect();
        let Some(seen) = seen else { continue };
        if seen.iter().any(|color| *color != seen[0]) {
            continue;
        }
        let [r, g, b, _] = picture.at(x, y);
        let off = [r, g, b].iter().zip(seen[0]).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off <= Some(1), "({x}, {y}): {:?}, not {:?}", [r, g, b], seen[0]);
        if !colors.contains(&seen[0]) {
            colors.push(seen[0]);
        }
    }
    colors.len()
}

#[test]
fn what_a_red_lamp_lights_is_red_and_its_shade_stays() {
    let lights = [(LEFT, RED, 2.0)];
    let picture = draw(&ball(&lights), &tones(""), &view());
    assert_eq!(assert_as_wanted(&picture, &lights), 3);
}

#[test]
fn where_lights_meet_flat_tones_have_the_colour_of_the_stronger_one() {
    let lights = [(LEFT, RED, 1.5), (RIGHT, BLUE, 1.2)];
    let picture = draw(&ball(&lights), &tones(""), &view());
    assert!(assert_as_wanted(&picture, &lights) >= 4);
}

#[test]
fn a_light_counts_as_a_white_one_where_its_colour_does_not() {
    let of = |color: Vec3, rest: &str| {
        let lights = [(LEFT, color, 1.0), (RIGHT, Vec3::ONE, 0.5)];
        draw(&ball(&lights), &tones(rest), &view()).rgba
    };
    assert!(of(RED, "light_color = 0") == of(Vec3::ONE, ""));
    assert!(of(RED, "") != of(Vec3::ONE, ""));
}

#[test]
fn on_a_smooth_ramp_colours_of_lights_blend() {
    let style = style(
        "[lines]\nmethod = \"none\"\n[paint.ramp]\nsmooth = true\nstops = [{ at = 0, color = \
         \"#000000\" }, { at = 1, color = \"#ffffff\" }]",
    );
    let lights = [(LEFT, RED, 1.0), (RIGHT, BLUE, 1.0)];
    let picture = draw(&ball(&lights), &style, &view());
    let eye = Eye::new(&view());
    let mut counted = 0;
    for (x, y) in picture.places() {
        let ray = eye.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        let Some(t) = ray.meets_sphere(DVec3::ZERO, 0.9) else { continue };
        let n = ray.point(t) / 0.9;
        // Beside the rim, where triangles are flat.
        if n.z < 0.3 {
            continue;
        }
        let parts = lights.map(|(from, ..)| 0.25 + 0.25 * n.dot(from.as_dvec3().normalize()));
        let sum = parts[0] + parts[1];
        let rgb: [u8; 3] = std::array::from_fn(|i| {
            let c = (parts[0] * displayed(RED[i]) + parts[1] * displayed(BLUE[i])) / sum;
            (255.0 * sum * c * (1.0 + 0.5 * (c - 1.0))).round() as u8
        });
        let [r, g, b, _] = picture.at(x, y);
        let off = [r, g, b].iter().zip(rgb).map(|(a, b)| a.abs_diff(b)).max();
        assert!(off <= Some(2), "({x}, {y}): {:?}, not {rgb:?}", [r, g, b]);
        counted += 1;
    }
    assert!(counted > 5000, "{counted} pixels");
}

#[test]
fn a_cast_shadow_has_no_colour_of_the_light_that_it_keeps_off() {
    let mut scene = Builder::new();
    let wall = shapes::plane(Vec2::splat(2.0));
    scene.object("wall", wall.clone(), None, Transform::default());
    scene.object("screen", wall, None, parts(Vec3::Z * 0.5, Quat::IDENTITY, Vec3::splat(0.3)));
    let mut red = light(LightKind::Directional, 1.0);
    red.color = RED;
    scene.light(red, Vec3::new(-1.0, 0.0, 1.5));
    let style = style(
        "[lines]\nmethod = \"none\"\n[paint.shadow]\nenabled = true\ntone = 0.3\n[paint.ramp]\n\
         stops = [{ at = 0, color = \"#404040\" }, { at = 0.5, color = \"#ffffff\" }]",
    );
    let picture = draw(&scene.build(), &style, &view());
    let counts = [[64, 64, 64], toned(0.9, RED)].map(|wanted| {
        picture
            .places()
            .filter(|&(x, y)| {
                let [r, g, b, _] = picture.at(x, y);
                [r, g, b].iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 1)
            })
            .count()
    });
    assert!(counts.iter().all(|&count| count > 100), "in shadow and lit: {counts:?}");
}

/// A lamp dims nothing that it does not reach, but without a sun that is in the shade.
#[test]
fn what_a_lamp_does_not_reach_is_as_without_it() {
    let style = style(
        "[lines]\nmethod = \"none\"\n[paint.ramp]\nstops = [{ at = 0, color = \"#404040\" }, \
         { at = 0.5, color = \"#ffffff\" }]",
    );
    let lit = |sun: bool, lamp: bool| {
        let mut scene = Builder::new();
        scene.object("ball", shapes::uv_sphere(96, 48, 0.9), None, Transform::default());
        if sun {
            scene.light(light(LightKind::Directional, 1.0), 5.0 * LEFT);
        }
        if lamp {
            scene.light(light(LightKind::Point { range: Some(0.5) }, 1.0), 5.0 * RIGHT);
        }
        draw(&scene.build(), &style, &view())
    };
    let [sun, both, lamp] = [lit(true, false), lit(true, true), lit(false, true)];
    let off = |(x, y)| sun.at(x, y).iter().zip(both.at(x, y)).map(|(a, b)| a.abs_diff(b)).max();
    let largest = sun.places().filter_map(off).max();
    assert!(largest <= Some(1), "the lamp changes what the sun gives by {largest:?}");
    let middle = |picture: &Picture| picture.at(64, 64)[0];
    assert_eq!((middle(&sun), middle(&lamp)), (255, 64));
}
