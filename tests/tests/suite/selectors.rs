//! Overrides that look at pixels find exactly theirs.

use std::sync::Arc;

use genga::render::Picture;
use genga::scene::{Image, Material, Primitive, Scene, Transform};
use genga::shapes;
use genga::style::{BaseColor, BaseColorRange, Color, IdTexture, Override, Selector, Style};
use genga_tests::scenes::{Builder, image, moved, nearest, ortho_view, style};
use genga_tests::{Pixels, draw};
use glam::{Vec2, Vec4};

const UNLINED: &str = "[lines]\nmethod = \"none\"\n";
const MAGENTA: [u8; 4] = [255, 0, 255, 255];

/// Colours of all hues and greys, 32×32.
fn atlas() -> Image {
    image(32, 32, |x, y| {
        let mix = (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(0x9e37_79b1)).rotate_left(9);
        let [r, g, b, _] = mix.wrapping_mul(0x85eb_ca6b).to_le_bytes();
        if (x + y) % 7 == 0 { [r, r, r, 255] } else { [r, g, b, 255] }
    })
}

fn texel(image: &Image, x: u32, y: u32) -> [u8; 4] {
    image.rgba.as_chunks::<4>().0[(y * image.width + x) as usize]
}

fn color([r, g, b, _]: [u8; 4]) -> Color {
    let [r, g, b] = [r, g, b].map(|c| f32::from(c) / 255.0);
    Color { r, g, b, a: 1.0 }
}

/// The atlas on a square that fills the picture.
fn poster() -> Scene {
    let mut scene = Builder::new();
    let base_color_texture = Some(scene.texture(atlas(), nearest()));
    let material = scene.material(Material { base_color_texture, ..Material::default() });
    scene.object("poster", shapes::plane(Vec2::ONE), Some(material), Transform::default());
    scene.build()
}

fn shown(style: &Style) -> Picture {
    draw(&poster(), style, &ortho_view([64, 64], 1.0))
}

#[test]
fn a_range_of_base_colors_finds_exactly_its_texels() {
    let atlas = atlas();
    let ranges = [
        BaseColorRange { hue: [20.5, 80.5], ..BaseColorRange::default() },
        BaseColorRange { hue: [329.5, 30.5], saturation: [0.3, 1.0], ..BaseColorRange::default() },
        BaseColorRange { saturation: [0.0, 0.2], ..BaseColorRange::default() },
        BaseColorRange { value: [0.25, 0.6], hue: [179.5, 270.5], ..BaseColorRange::default() },
    ];
    for range in ranges {
        let mut style = style(UNLINED);
        let select = Selector { base_color: Some(range), ..Selector::default() };
        let mut magenta = Override { select, ..Override::default() };
        magenta.paint.base = Some(BaseColor::Fixed(color(MAGENTA)));
        style.overrides.push(magenta);
        let picture = shown(&style);
        // Bounds have a slack of half an 8-bit step, so that a picked colour is inside.
        let slack = |bounds: [f32; 2], by: f32| [bounds[0] - by, bounds[1] + by];
        let changed = |by: f32| BaseColorRange {
            hue: range.hue,
            saturation: slack(range.saturation, by),
            value: slack(range.value, by),
        };
        let (mut inside, mut outside) = (0, 0);
        for (x, y) in picture.places() {
            let texel = texel(&atlas, x / 2, y / 2);
            let [tight, loose] = [0.0, 0.6 / 255.0].map(|by| changed(by).contains(color(texel)));
            if tight {
                inside += 1;
                assert_eq!(picture.at(x, y), MAGENTA, "{texel:?} is in {range:?}");
            } else if !loose {
                outside += 1;
                assert_eq!(picture.at(x, y), texel, "{texel:?} is not in {range:?}");
            }
        }
        assert!(inside > 150 && outside > 150, "{range:?}: {inside} in, {outside} out");
    }
}

#[test]
fn a_range_of_vertex_colors_finds_its_faces() {
    let mut scene = Builder::new();
    for i in 0..4 {
        let vertex_color = Vec4::new(i as f32 / 3.0, 0.5, 1.0, 1.0);
        let square = Primitive { colors: vec![vertex_color; 4], ..shapes::plane(Vec2::ONE) };
        scene.object("square", square, None, moved(i as f32 - 1.5, 0.0, 0.0));
    }
    let style = style(&format!(
        "{UNLINED}[[override]]\nselect.vertex_color = {{ red = [0.3, 0.7] }}\n\
         paint.base = \"#ff00ff\""
    ));
    let picture = draw(&scene.build(), &style, &ortho_view([64, 16], 1.0));
    let found = [8, 24, 40, 56].map(|x| picture.at(x, 8) == MAGENTA);
    assert_eq!(found, [false, true, true, false]);
}

#[test]
fn an_id_texture_finds_its_color() {
    let atlas = atlas();
    let ids =
        image(8, 8, |x, y| if (x * y) % 3 == 1 { [250, 10, 10, 255] } else { [240, 10, 10, 0] });
    let (wanted, ids) = (color([250, 10, 10, 255]), Arc::new(ids));
    for (tolerance, finds_the_other) in [(0.0, false), (0.03, false), (0.05, true)] {
        let mut style = style(UNLINED);
        let id_texture = Some(IdTexture { image: Arc::clone(&ids), color: wanted, tolerance });
        let select = Selector { id_texture, ..Selector::default() };
        let mut magenta = Override { select, ..Override::default() };
        magenta.paint.base = Some(BaseColor::Fixed(color(MAGENTA)));
        style.overrides.push(magenta);
        let picture = shown(&style);
        for (x, y) in picture.places() {
            let found = finds_the_other || texel(&ids, x / 8, y / 8)[0] == 250;
            let expected = if found { MAGENTA } else { texel(&atlas, x / 2, y / 2) };
            assert_eq!(picture.at(x, y), expected, "at ({x}, {y}), tolerance {tolerance}");
        }
    }
}

#[test]
fn selectors_combine_property_by_property() {
    // Left half: red below 0.5; upper half: green below 0.5. Both pin the base, the first one
    // also the ramp.
    let mut scene = Builder::new();
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let vertex_color = Vec4::new(x as f32, y as f32, 1.0, 1.0);
        let square = Primitive { colors: vec![vertex_color; 4], ..shapes::plane(Vec2::ONE) };
        scene.object("square", square, None, moved(x as f32 - 0.5, 0.5 - y as f32, 0.0));
    }
    let style = style(&format!(
        "{UNLINED}[[override]]\nselect.vertex_color = {{ red = [0, 0.5] }}\n\
         paint = {{ base = \"#ff0000\", ramp.stops = [{{ at = 0, color = \"#808080\" }}] }}\n\
         [[override]]\nselect.vertex_color = {{ green = [0, 0.5] }}\npaint.base = \"#00ff00\"\n\
         [[override]]\nselect.objects = [\"nothing\"]\npaint.base = \"#0000ff\""
    ));
    let picture = draw(&scene.build(), &style, &ortho_view([32, 32], 2.0));
    // Both: the later base, the earlier ramp.
    assert_eq!(picture.at(8, 8), [0, 128, 0, 255]);
    assert_eq!(picture.at(24, 8), [0, 255, 0, 255]);
    assert_eq!(picture.at(8, 24), [128, 0, 0, 255]);
    assert_eq!(picture.at(24, 24), [255, 255, 255, 255]);
}

#[test]
fn globs_select_objects_and_materials() {
    let mut scene = Builder::new();
    let [iron, wood] = ["Iron", "wood"].map(|name| scene.colored(name, [1.0; 3]));
    for (x, (object, material)) in
        [("Arm_L", iron), ("Arm_R", wood), ("head", iron), ("leg", wood)].into_iter().enumerate()
    {
        let at = moved(x as f32 - 1.5, 0.0, 0.0);
        scene.object(object, shapes::plane(Vec2::ONE), Some(material), at);
    }
    let style = style(&format!(
        "{UNLINED}[[override]]\nselect.objects = [\"arm_?\", \"H*\"]\npaint.base = \"#ff0000\"\n\
         [[override]]\nselect = {{ objects = [\"arm*\"], materials = [\"*ood\"] }}\n\
         paint.base = \"#0000ff\""
    ));
    let picture = draw(&scene.build(), &style, &ortho_view([64, 16], 1.0));
    let colors = [8, 24, 40, 56].map(|x| picture.at(x, 8));
    let (red, blue, white) = ([255, 0, 0, 255], [0, 0, 255, 255], [255; 4]);
    assert_eq!(colors, [red, blue, red, white]);
}
