//! Ramp, comic highlights and print against their formulas in f64.

use genga::render::{LayerKind, Picture, View};
use genga::scene::{LightKind, Scene, Transform};
use genga::shapes;
use genga_tests::scenes::{Builder, light, ortho_view, parts, style};
use genga_tests::{Eye, Pixels, draw, draw_layers};
use glam::{DQuat, DVec2, DVec3, Quat, Vec2, Vec3};

const SIDE: u32 = 8;
const PICTURE: u32 = 160;
/// Towards the light.
const FROM: Vec3 = Vec3::new(-0.5, 0.6, 1.0);

/// How the tile in a column and row is turned: all directions up to 60° from the view.
fn turned(i: u32, j: u32) -> DQuat {
    let angle = |k: u32| (f64::from(k) - 3.5) / 3.5 * 1.0;
    DQuat::from_rotation_y(angle(i)) * DQuat::from_rotation_x(angle(j) * 0.9)
}

/// A board of small black tiles, each turned another way.
fn tiles(rgb: [f32; 3]) -> Scene {
    let mut scene = Builder::new();
    let material = scene.colored("tile", rgb);
    for j in 0..SIDE {
        for i in 0..SIDE {
            let place = Vec3::new(i as f32 - 3.5, j as f32 - 3.5, 0.0);
            let transform = parts(place, turned(i, j).as_quat(), Vec3::ONE);
            scene.object("tile", shapes::plane(Vec2::splat(0.8)), Some(material), transform);
        }
    }
    scene.light(light(LightKind::Directional, 1.0), FROM);
    scene.build()
}

fn view() -> View {
    View { supersample: 1, ..ortho_view([PICTURE; 2], SIDE as f32) }
}

/// Compares the middle of each tile with a formula of its normal, in [0, 1], within 1/255.
fn compare(picture: &Picture, wanted: impl Fn(DVec3) -> f64) -> f64 {
    let mut highest = 0.0_f64;
    for j in 0..SIDE {
        for i in 0..SIDE {
            let step = PICTURE / SIDE;
            let (x, y) = (i * step + step / 2, PICTURE - 1 - j * step - step / 2);
            let value = wanted(turned(i, j) * DVec3::Z);
            let found = f64::from(picture.at(x, y)[0]) / 255.0;
            assert!((found - value).abs() <= 1.0 / 255.0, "tile {i}, {j}: {found}, not {value}");
            highest = highest.max(value);
        }
    }
    highest
}

const BARE: &str = "[lines]\nmethod = \"none\"\n[background]\ncolor = \"#000\"\n";

#[test]
fn a_gradient_ramp_is_t() {
    let l = FROM.as_dvec3().normalize();
    for (gain, bias) in [(1.0, 0.0), (1.6, 0.0), (0.7, 0.2), (1.0, -0.3)] {
        let style = style(&format!(
            "{BARE}[paint]\nshade_bias = {bias}\n[paint.ramp]\nsmooth = true\ngain = {gain}\n\
             stops = [{{ at = 0, color = \"#000\" }}, {{ at = 1, color = \"#fff\" }}]"
        ));
        let picture = draw(&tiles([1.0; 3]), &style, &view());
        compare(&picture, |n| {
            (0.5 + 0.5 * (gain * n.dot(l)).clamp(-1.0, 1.0) + bias).clamp(0.0, 1.0)
        });
    }
}

/// N·H after the operators, each followed by a normalisation.
struct Operators {
    translate: DVec2,
    scale: DVec2,
    rotate: f64,
    split: DVec2,
    square: f64,
}

const NONE: Operators = Operators {
    translate: DVec2::ZERO,
    scale: DVec2::ZERO,
    rotate: 0.0,
    split: DVec2::ZERO,
    square: 0.0,
};

impl Operators {
    fn half(&self, n: DVec3) -> f64 {
        let l = FROM.as_dvec3().normalize();
        let mut h = (l + DVec3::Z).normalize();
        let u = DVec3::Y.cross(n).normalize();
        let v = n.cross(u);
        let (sin, cos) = self.rotate.to_radians().sin_cos();
        let (du, dv) = (cos * u + sin * v, cos * v - sin * u);
        h = (h - self.scale.x * h.dot(du) * du - self.scale.y * h.dot(dv) * dv).normalize();
        h = (h + self.translate.x * u + self.translate.y * v).normalize();
        let sign = |x: f64| if x >= 0.0 { 1.0 } else { -1.0 };
        let [a, b] = [sign(h.dot(du)), sign(h.dot(dv))];
        h = (h - self.split.x * a * du - self.split.y * b * dv).normalize();
        // Squaring: the tangential part's length becomes its larger component.
        let q = DVec2::new(h.dot(du), h.dot(dv));
        let corner = q.x.abs().max(q.y.abs()) / q.length().max(1e-6);
        let q = q * (1.0 + (corner - 1.0) * self.square);
        let h = (q.x * du + q.y * dv + h.dot(n) * n).normalize();
        h.dot(n).max(0.0)
    }

    fn toml(&self) -> String {
        format!(
            "translate = [{}, {}], scale = [{}, {}], rotate_deg = {}, split = [{}, {}], square = {}",
            self.translate.x,
            self.translate.y,
            self.scale.x,
            self.scale.y,
            self.rotate,
            self.split.x,
            self.split.y,
            self.square
        )
    }
}

#[test]
fn gradient_highlights_follow_the_formula() {
    let all = [
        NONE,
        Operators { translate: DVec2::new(0.2, -0.1), ..NONE },
        Operators { scale: DVec2::new(0.5, -0.4), rotate: 25.0, ..NONE },
        Operators { split: DVec2::new(0.15, 0.1), rotate: -40.0, ..NONE },
        Operators { square: 0.8, ..NONE },
        Operators {
            translate: DVec2::new(-0.1, 0.1),
            scale: DVec2::new(0.3, 0.0),
            rotate: 10.0,
            split: DVec2::new(0.05, 0.0),
            square: 0.5,
        },
    ];
    for operators in all {
        for (n, b, m) in [(4.0, 0.5, 5.0), (12.0, 0.3, 1.0), (8.0, 0.1, 0.0)] {
            let style = style(&format!(
                "{BARE}[paint.specular]\nform = \"gradient\"\nexponent = {n}\nthreshold = {b}\n\
                 gradient = {m}\n{}\n",
                operators.toml().replace(", s", "\ns").replace(", r", "\nr")
            ));
            let picture = draw(&tiles([0.0; 3]), &style, &view());
            let l = FROM.as_dvec3().normalize();
            let highest = compare(&picture, |normal| {
                let i = operators.half(normal).powf(n);
                let shown = (0.5 * (i - b) * (2.5 * b + i).powf(m)).clamp(0.0, 1.0);
                let front = (normal.dot(l) / 0.05).clamp(0.0, 1.0);
                if i > b { shown * front * front * (3.0 - 2.0 * front) } else { 0.0 }
            });
            assert!(highest > 0.05, "something shines: {highest}");
        }
    }
}

#[test]
fn the_rim_is_a_ramp_over_the_light_from_behind() {
    for (azimuth, elevation, threshold) in [(40.0, 30.0, 0.6), (-100.0, 10.0, 0.5)] {
        let style = style(&format!(
            "{BARE}[paint.rim_light]\nazimuth_deg = {azimuth}\nelevation_deg = {elevation}\n\
             threshold = {threshold}\nsoftness = 1.0\n"
        ));
        let picture = draw(&tiles([0.0; 3]), &style, &view());
        let (a, e) = (f64::to_radians(azimuth), f64::to_radians(elevation));
        let l = DVec3::new(a.sin() * e.cos(), e.sin(), -a.cos() * e.cos());
        let highest =
            compare(&picture, |n| (0.5 + 0.5 * l.dot(n) - threshold + 0.5).clamp(0.0, 1.0));
        assert!(highest > 0.3, "something shines: {highest}");
    }
}

fn ball() -> Scene {
    let mut scene = Builder::new();
    let black = scene.colored("ball", [0.0; 3]);
    scene.object("ball", shapes::uv_sphere(256, 128, 0.9), Some(black), Transform::default());
    scene.light(light(LightKind::Directional, 1.0), FROM);
    scene.build()
}

#[test]
fn a_comic_highlight_ends_at_its_threshold() {
    let split = Operators { split: DVec2::new(0.12, 0.0), square: 1.0, ..NONE };
    for operators in [NONE, split] {
        let (n, b) = (40.0, 0.5);
        let style = style(&format!(
            "{BARE}[paint]\nspecular = {{ exponent = {n}, threshold = {b}, {} }}",
            operators.toml()
        ));
        let view = View { supersample: 1, ..ortho_view([200; 2], 2.0) };
        let picture = draw(&ball(), &style, &view);
        let eye = Eye::new(&view);
        let shines = |p: DVec2| {
            let ray = eye.ray(p);
            let t = ray.meets_sphere(DVec3::ZERO, 0.9)?;
            Some(operators.half(ray.point(t) / 0.9).powf(n) > b)
        };
        let mut counts = [0; 2];
        for (x, y) in picture.places() {
            let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let round = |i: u8| DVec2::from_angle(f64::from(i) * 0.785);
            let Some(here) = shines(middle) else { continue };
            if (0..8).all(|i| shines(middle + round(i)) == Some(here)) {
                let found = picture.at(x, y)[0];
                assert_eq!(found, if here { 255 } else { 0 }, "pixel {x}, {y}");
                counts[usize::from(here)] += 1;
            }
        }
        assert!(counts[0] > 1000 && counts[1] > 150, "{counts:?}");
    }
}

#[test]
fn highlights_can_be_paper_and_have_their_layer() {
    let style = style(
        "[lines]\nmethod = \"none\"\n[background]\ncolor = \"#fff0d0\"\n\
         [paint]\nspecular = { blend = \"paper\" }\n",
    );
    let view = View { supersample: 1, ..ortho_view([120; 2], 2.0) };
    let kinds = [LayerKind::Color, LayerKind::Highlight];
    let picture = draw_layers(&ball(), &style, &view, &kinds);
    let paper = picture.places().filter(|&(x, y)| {
        picture.at(x, y)[..3] == [0xff, 0xf0, 0xd0] && picture.paint(x, y) == [0, 0, 0, 255]
    });
    assert!(paper.count() > 50, "the highlight shows the paper, the layer of colour does not");
    let highlight = picture.bytes(LayerKind::Highlight);
    let shown = highlight.chunks_exact(4).filter(|p| **p == [0xff, 0xf0, 0xd0, 0xff]);
    assert!(shown.count() > 50, "it is in the layer of highlights");
}

#[test]
fn a_cast_shadow_hides_the_highlight() {
    let bright = |enabled: bool| {
        let style = style(&format!(
            "{BARE}[paint]\nspecular = {{ exponent = 20 }}\n[paint.shadow]\nenabled = {enabled}\n"
        ));
        let mut scene = Builder::new();
        let black = scene.colored("wall", [0.0; 3]);
        let wall = shapes::plane(Vec2::splat(4.0));
        let half = (FROM.normalize() + Vec3::Z).normalize();
        let turn = parts(Vec3::ZERO, Quat::from_rotation_arc(Vec3::Z, half), Vec3::ONE);
        scene.object("wall", wall, Some(black), turn);
        let at = Transform::Parts {
            translation: 0.8 * FROM.normalize(),
            rotation: Quat::IDENTITY,
            scale: Vec3::ONE,
        };
        scene.object("ball", shapes::uv_sphere(48, 24, 0.3), Some(black), at);
        scene.light(light(LightKind::Directional, 1.0), FROM);
        let view = View { supersample: 1, ..ortho_view([120; 2], 2.0) };
        let picture = draw(&scene.build(), &style, &view);
        picture.places().filter(|&(x, y)| picture.at(x, y)[0] > 128).count()
    };
    let [with, without] = [bright(true), bright(false)];
    assert!(without > with + 300, "{with} of {without} pixels shine");
}

#[test]
fn streaks_are_straight_and_have_their_widths() {
    let style = style(&format!(
        "{BARE}[paint]\nsheen = {{ strength = 1, lean_deg = 25, spacing_m = 0.4, width = 0.2, \
         second = 0.1, gap = 0.1 }}\n"
    ));
    let mut scene = Builder::new();
    let black = scene.colored("wall", [0.0; 3]);
    scene.object("wall", shapes::plane(Vec2::splat(4.0)), Some(black), Transform::default());
    let view = View { supersample: 1, ..ortho_view([300; 2], 2.0) };
    let picture = draw(&scene.build(), &style, &view);
    let eye = Eye::new(&view);
    let (sin, cos) = 25_f64.to_radians().sin_cos();
    let mut sum = 0.0;
    for (x, y) in picture.places() {
        let p = eye.ray_at(x, y).origin;
        let s = ((p.x * cos - p.y * sin) / 0.4).rem_euclid(1.0);
        let found = f64::from(picture.at(x, y)[0]) / 255.0;
        sum += found;
        // A pixel is 1/60 of the spacing.
        let edges = [0.0, 0.2, 0.3, 0.4, 1.0];
        if edges.iter().all(|edge| (s - edge).abs() > 0.02) {
            let inside = s < 0.2 || (s > 0.3 && s < 0.4);
            assert_eq!(found, f64::from(u8::from(inside)), "pixel {x}, {y} at {s}");
        }
    }
    let mean = sum / f64::from(300 * 300);
    assert!((mean - 0.3).abs() < 0.01, "{mean}");
}

#[test]
fn a_palette_leaves_no_other_colours() {
    let palette =
        [[0x10_u8, 0x10, 0x20], [0xe0, 0xd0, 0xb0], [0xb0, 0x30, 0x28], [0x30, 0x58, 0xa8]];
    let list: Vec<String> =
        palette.iter().map(|[r, g, b]| format!("\"#{r:02x}{g:02x}{b:02x}\"")).collect();
    let style = style(&format!(
        "[lines]\nmethod = \"none\"\n[paint]\npalette = [{}]\n[paint.ramp]\n\
         stops = [{{ at = 0, color = \"#504080\" }}, {{ at = 0.5, color = \"#fff\" }}]",
        list.join(", ")
    ));
    let mut scene = Builder::new();
    for (i, rgb) in [[0.6, 0.05, 0.02], [0.8, 0.7, 0.5], [0.1, 0.2, 0.6]].into_iter().enumerate() {
        let material = scene.colored("m", rgb);
        let at = genga_tests::scenes::moved(i as f32 - 1.0, 0.0, 0.0);
        scene.object("ball", shapes::uv_sphere(48, 24, 0.45), Some(material), at);
    }
    scene.light(light(LightKind::Directional, 1.0), FROM);
    let view = View { supersample: 1, ..ortho_view([150, 60], 1.2) };
    let picture = draw_layers(&scene.build(), &style, &view, &[LayerKind::Ids]);
    let (mut known, mut other) = ([0; 4], 0);
    for (x, y) in picture.places().filter(|&(x, y)| picture.ids(x, y)[0] > 0) {
        let [r, g, b, _] = picture.at(x, y);
        match palette.iter().position(|color| *color == [r, g, b]) {
            Some(i) => known[i] += 1,
            None => other += 1,
        }
    }
    // Outlines and the edges of tones are antialiased.
    assert!(known.iter().all(|count| *count > 100), "{known:?}");
    assert!(other * 4 < known.iter().sum(), "{other} beside {known:?}");
}

#[test]
fn dots_have_the_area_that_the_colour_asks_for() {
    let style = style(
        "[lines]\nmethod = \"none\"\n[paint]\nbase = \"#d89a40\"\n[paint.dots]\nspacing = 40\n",
    );
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(Vec2::splat(4.0)), None, Transform::default());
    for supersample in [1, 2] {
        let view = View { supersample, ..ortho_view([320; 2], 2.0) };
        let picture = draw(&scene.clone().build(), &style, &view);
        let mut sums = [0.0; 3];
        for (x, y) in picture.places() {
            let pixel = picture.at(x, y);
            (0..3).for_each(|c| sums[c] += f64::from(pixel[c]));
        }
        for (c, wanted) in [0xd8, 0x9a, 0x40].into_iter().enumerate() {
            let mean = sums[c] / f64::from(320 * 320);
            assert!((mean - f64::from(wanted)).abs() < 5.0, "channel {c}: {mean}, not {wanted}");
        }
    }
}
