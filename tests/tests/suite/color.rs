//! Base colours arrive exactly as the file has them.

use genga::render::{Picture, View};
use genga::scene::{Image, Material, Primitive, Scene, Transform};
use genga::shapes;
use genga_tests::scenes::{Builder, image, nearest, ortho_view, perspective_view, style};
use genga_tests::{Pixels, draw};
use glam::{Vec2, Vec4};

const UNLINED: &str = "[lines]\nmethod = \"none\"\n";

/// The sRGB transfer function (IEC 61966-2-1).
fn encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Whole numbers that look random, the same in every run (a linear congruential generator).
fn noise(seed: u32) -> impl Iterator<Item = u8> {
    let mut state = seed;
    std::iter::repeat_with(move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    })
}

/// A picture that fills the square metre in front of the camera.
fn poster(picture: Image) -> Scene {
    let mut scene = Builder::new();
    let base_color_texture = Some(scene.texture(picture, nearest()));
    let material = scene.material(Material { base_color_texture, ..Material::default() });
    scene.object("poster", shapes::plane(Vec2::ONE), Some(material), Transform::default());
    scene.build()
}

/// Every texel of a 16×16 picture, from the middle of its 4×4 pixels and from all of them.
fn assert_shows_exactly(picture: &Picture, expected: impl Fn(u32, u32) -> [u8; 4]) {
    assert_eq!((picture.width, picture.height), (64, 64));
    for (x, y) in picture.places() {
        assert_eq!(picture.at(x, y), expected(x / 4, y / 4), "at ({x}, {y})");
    }
}

#[test]
fn every_grey_and_random_colours_leave_as_they_came() {
    let bytes: Vec<u8> = noise(7).take(3 * 256).collect();
    let grey = |x: u32, y: u32| [[(16 * y + x) as u8; 3].as_slice(), &[255]].concat();
    let grey = |x, y| <[u8; 4]>::try_from(grey(x, y)).expect("four channels");
    let colors = |x: u32, y: u32| {
        let i = 3 * (16 * y + x) as usize;
        [bytes[i], bytes[i + 1], bytes[i + 2], 255]
    };
    for blend_space in ["display", "linear"] {
        let style = style(&format!("[paint]\nblend_space = \"{blend_space}\"\n{UNLINED}"));
        for supersample in [1, 2, 3] {
            let view = View { supersample, ..ortho_view([64, 64], 1.0) };
            assert_shows_exactly(&draw(&poster(image(16, 16, grey)), &style, &view), grey);
            assert_shows_exactly(&draw(&poster(image(16, 16, colors)), &style, &view), colors);
        }
    }
}

#[test]
fn perspective_changes_no_color() {
    let bytes: Vec<u8> = noise(11).take(3 * 256).collect();
    let colors = |x: u32, y: u32| {
        let i = 3 * (16 * y + x) as usize;
        [bytes[i], bytes[i + 1], bytes[i + 2], 255]
    };
    // From 1/(2 tan 20°) metres a square metre fills 40°.
    let distance = 0.5 / 20_f32.to_radians().tan();
    let view = perspective_view([64, 64], 40.0, distance);
    let picture = draw(&poster(image(16, 16, colors)), &style(UNLINED), &view);
    for (x, y) in picture.places().filter(|(x, y)| x % 4 == 2 && y % 4 == 2) {
        assert_eq!(picture.at(x, y), colors(x / 4, y / 4), "at ({x}, {y})");
    }
}

/// One quad in 8×8 pixels of its own for each colour.
fn swatches(make: impl Fn(usize) -> (Material, Primitive)) -> Picture {
    let mut scene = Builder::new();
    for i in 0..64 {
        let (material, primitive) = make(i);
        let material = scene.material(material);
        let (x, y) = ((i % 8) as f32, (i / 8) as f32);
        let at = genga_tests::scenes::moved(x - 3.5, 3.5 - y, 0.0);
        scene.object(&format!("swatch {i}"), primitive, Some(material), at);
    }
    draw(&scene.build(), &style(UNLINED), &ortho_view([64, 64], 8.0))
}

fn assert_near(picture: &Picture, i: usize, expected: [f64; 3]) {
    let at = picture.at(8 * (i as u32 % 8) + 4, 8 * (i as u32 / 8) + 4);
    for (channel, expected) in at.into_iter().zip(expected) {
        let error = f64::from(channel) - 255.0 * expected;
        assert!(error.abs() <= 1.0, "swatch {i}: {at:?}, not {expected}");
    }
    assert_eq!(at[3], 255);
}

#[test]
fn linear_factors_are_encoded() {
    let bytes: Vec<u8> = noise(3).take(3 * 64).collect();
    let linear = |i: usize| [0, 1, 2].map(|c| f32::from(bytes[3 * i + c]) / 255.0);
    let expected = |i: usize| linear(i).map(|v| encoded(f64::from(v)));
    let color = |i: usize| {
        let [r, g, b] = linear(i);
        Vec4::new(r, g, b, 1.0)
    };
    let square = || shapes::plane(Vec2::ONE);
    let by_factor =
        swatches(|i| (Material { base_color: color(i), ..Material::default() }, square()));
    let by_vertex =
        swatches(|i| (Material::default(), Primitive { colors: vec![color(i); 4], ..square() }));
    for i in 0..64 {
        assert_near(&by_factor, i, expected(i));
        assert_near(&by_vertex, i, expected(i));
    }
}

#[test]
fn unlit_materials_have_no_shade() {
    let mut scene = Builder::new();
    let picture = image(1, 1, |_, _| [200, 100, 50, 255]);
    let base_color_texture = Some(scene.texture(picture, nearest()));
    for (unlit, x) in [(true, -0.5), (false, 0.5)] {
        let material = Material { base_color_texture, unlit, ..Material::default() };
        let material = scene.material(material);
        let at = genga_tests::scenes::moved(x, 0.0, 0.0);
        scene.object("square", shapes::plane(Vec2::ONE), Some(material), at);
    }
    // The light comes from behind.
    let style = style(&format!(
        "[light]\nazimuth_deg = 180\nelevation_deg = 0\n[paint.ramp]\n\
         stops = [{{ at = 0, color = \"#000\" }}, {{ at = 0.5, color = \"#fff\" }}]\n{UNLINED}"
    ));
    let picture = draw(&scene.build(), &style, &ortho_view([32, 16], 1.0));
    assert_eq!(picture.at(8, 8), [200, 100, 50, 255]);
    assert_eq!(picture.at(24, 8), [0, 0, 0, 255]);
}
