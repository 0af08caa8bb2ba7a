//! Alpha: of the picture, of backgrounds, of materials.

use genga::render::{LayerKind, View};
use genga::scene::{AlphaMode, Material, Scene, Transform};
use genga::shapes;
use genga_tests::scenes::{Builder, image, moved, nearest, ortho_view, parts, style};
use genga_tests::{Pixels, draw, draw_layers};
use glam::{Quat, Vec2, Vec3, Vec4};

const UNLINED: &str = "[lines]\nmethod = \"none\"\n";

/// An unshaded square metre in a colour, at a distance.
fn square(scene: &mut Builder, rgba: [u8; 4], alpha: AlphaMode, at: Transform) {
    let texture = scene.texture(image(1, 1, |_, _| rgba), nearest());
    let material = scene.material(Material {
        base_color_texture: Some(texture),
        alpha,
        double_sided: true,
        ..Material::default()
    });
    scene.object("square", shapes::plane(Vec2::ONE), Some(material), at);
}

fn assert_near(at: [u8; 4], expected: [f64; 4], what: &str) {
    for (channel, expected_channel) in at.into_iter().zip(expected) {
        let error = (f64::from(channel) - expected_channel).abs();
        assert!(error <= 1.0, "{what}: {at:?}, not {expected:?}");
    }
}

#[test]
fn half_covered_pixels_keep_their_color() {
    let mut scene = Builder::new();
    // The picture is 2 m in 32 pixels; the square's sides lie in the middle of pixels.
    let half = parts(Vec3::ZERO, Quat::IDENTITY, Vec3::new(17.0 / 16.0, 17.0 / 16.0, 1.0));
    square(&mut scene, [200, 100, 50, 255], AlphaMode::Opaque, half);
    let scene = scene.build();
    for supersample in [1, 2, 4] {
        let view = View { supersample, background: false, ..ortho_view([32, 32], 2.0) };
        let picture = draw(&scene, &style(UNLINED), &view);
        assert_eq!(picture.at(2, 2), [0; 4]);
        assert_eq!(picture.at(16, 16), [200, 100, 50, 255]);
        for (x, y) in [(7, 16), (24, 16), (16, 7), (16, 24)] {
            let at = picture.at(x, y);
            assert_near(at, [200.0, 100.0, 50.0, f64::from(at[3])], "colour of a half pixel");
            assert!((127..=128).contains(&at[3]), "alpha {} of a half pixel", at[3]);
        }
        assert!((63..=64).contains(&picture.at(7, 7)[3]), "a quarter: {:?}", picture.at(7, 7));
    }
}

#[test]
fn lines_on_nothing_have_their_color_and_no_dark_fringe() {
    let mut scene = Builder::new();
    square(&mut scene, [255; 4], AlphaMode::Opaque, moved(0.0, 0.0, 0.0));
    let lined = style(
        "[background]\ncolor = \"#00ff00\"\n[lines]\nreference_height = 64\n\
         [[lines.sets]]\ncolor = \"#ff8000\"\nwidth = 5",
    );
    let view = View { background: false, ..ortho_view([64, 64], 2.0) };
    let picture = draw(&scene.build(), &lined, &view);
    let mut partly = 0;
    for (x, y) in picture.places() {
        let at = picture.at(x, y);
        let outside = !(16..48).contains(&x) || !(16..48).contains(&y);
        if outside && at[3] > 0 {
            partly += usize::from(at[3] < 255);
            // 8-bit alpha cannot divide better than this.
            let step = 1.0 + 255.0 / f64::from(at[3]);
            for (channel, ink) in at.into_iter().zip([255.0, 128.0, 0.0]) {
                assert!((f64::from(channel) - ink).abs() <= step, "{at:?} at ({x}, {y})");
            }
        }
    }
    assert!(partly > 10, "no antialiased pixel was looked at");
}

#[test]
fn backgrounds_go_from_top_to_bottom() {
    let mut scene = Builder::new();
    square(&mut scene, [9; 4], AlphaMode::Opaque, moved(50.0, 0.0, 0.0));
    let scene = scene.build();
    let gradient =
        style(&format!("{UNLINED}[background]\ncolor = \"#ff0000\"\nbottom = \"#0080ff\""));
    let picture = draw(&scene, &gradient, &ortho_view([8, 64], 2.0));
    for (x, y) in picture.places() {
        let t = (f64::from(y) + 0.5) / 64.0;
        let expected = [255.0 * (1.0 - t), 128.0 * t, 255.0 * t, 255.0];
        assert_near(picture.at(x, y), expected, "the gradient");
    }
    let plain = style(&format!("{UNLINED}[background]\ncolor = \"#123456\""));
    let picture = draw(&scene, &plain, &ortho_view([8, 64], 2.0));
    assert!(picture.places().all(|(x, y)| picture.at(x, y) == [0x12, 0x34, 0x56, 255]));
}

#[test]
fn emitted_light_adds_and_never_wraps() {
    let mut scene = Builder::new();
    for (x, emissive) in
        [(-1.0, Vec3::ZERO), (0.0, Vec3::new(0.0, 0.2, 0.0)), (1.0, Vec3::splat(40.0))]
    {
        let base_color = Vec4::new(0.2, 0.1, 0.4, 1.0);
        let material = scene.material(Material { base_color, emissive, ..Material::default() });
        scene.object("lamp", shapes::plane(Vec2::ONE), Some(material), moved(x, 0.0, 0.0));
    }
    let view = View { background: false, ..ortho_view([48, 32], 2.0) };
    let picture = draw(&scene.build(), &style(UNLINED), &view);
    let [dark, green, white] = [8, 24, 40].map(|x| picture.at(x, 16));
    assert_eq!([dark[0], dark[2], dark[3]], [green[0], green[2], green[3]]);
    assert!(green[1] > dark[1] + 60, "{green:?} against {dark:?}");
    assert_eq!(white, [255; 4]);
    assert_eq!(picture.at(24, 1), [0; 4], "light does not make the air opaque");
}

/// Three half-transparent squares in a row of depths, given in the wrong order.
fn panes() -> (Scene, [[u8; 4]; 3]) {
    let colors = [[255, 0, 0, 128], [0, 255, 0, 153], [0, 0, 255, 102]];
    let mut scene = Builder::new();
    for i in [1, 0, 2] {
        square(&mut scene, colors[i], AlphaMode::Blend, moved(0.0, 0.0, i as f32 * 0.5));
    }
    (scene.build(), colors)
}

/// Layers from back to front over white.
fn composite(layers: &[[u8; 4]]) -> [f64; 4] {
    let mut result = [255.0; 4];
    for layer in layers {
        let alpha = f64::from(layer[3]) / 255.0;
        for c in 0..3 {
            result[c] = alpha * f64::from(layer[c]) + (1.0 - alpha) * result[c];
        }
    }
    result
}

#[test]
fn blended_surfaces_are_sorted_from_back_to_front() {
    let (scene, [back, middle, front]) = panes();
    let style = style(UNLINED);
    let view = ortho_view([16, 16], 2.0);
    let at = draw(&scene, &style, &view).at(8, 8);
    assert_near(at, composite(&[back, middle, front]), "from the front");
    let mut behind = view;
    behind.camera.world_from_camera =
        glam::Affine3A::from_rotation_y(std::f32::consts::PI) * view.camera.world_from_camera;
    let at = draw(&scene, &style, &behind).at(8, 8);
    assert_near(at, composite(&[front, middle, back]), "from behind");
    let near = genga_tests::scenes::perspective_view([16, 16], 30.0, 5.0);
    assert_near(draw(&scene, &style, &near).at(8, 8), composite(&[back, middle, front]), "near");
}

#[test]
fn what_lies_before_a_pane_hides_it_and_what_lies_behind_shows() {
    let mut scene = Builder::new();
    square(&mut scene, [255, 0, 0, 128], AlphaMode::Blend, moved(0.0, 0.0, 0.5));
    square(&mut scene, [0, 0, 0, 255], AlphaMode::Opaque, moved(0.5, 0.0, 0.0));
    square(&mut scene, [0, 0, 90, 255], AlphaMode::Opaque, moved(-0.5, 0.0, 1.0));
    let picture = draw(&scene.build(), &style(UNLINED), &ortho_view([32, 16], 2.0));
    assert_near(picture.at(18, 8), composite(&[[0, 0, 0, 255], [255, 0, 0, 128]]), "behind");
    assert_eq!(picture.at(14, 8), [0, 0, 90, 255]);
}

#[test]
fn half_opaque_surfaces_enter_the_ids() {
    let mut scene = Builder::new();
    for (x, alpha) in [(-1.0, 126), (0.0, 129), (1.0, 255)] {
        square(&mut scene, [9, 9, 9, alpha], AlphaMode::Blend, moved(x, 0.0, 0.0));
    }
    let layers = [LayerKind::Ids, LayerKind::Depth];
    let picture = draw_layers(&scene.build(), &style(UNLINED), &ortho_view([48, 32], 2.0), &layers);
    assert_eq!([8, 24, 40].map(|x| picture.ids(x, 16)[0]), [0, 2, 3]);
    assert!((picture.depth(24, 16) - 10.0).abs() < 1e-5);
}

#[test]
fn masks_cut_holes_into_everything() {
    let mut scene = Builder::new();
    let rgba = |x: u32, y: u32| [10, 200, 30, if (x + y).is_multiple_of(2) { 200 } else { 120 }];
    let base_color_texture = Some(scene.texture(image(4, 4, rgba), nearest()));
    let material = scene.material(Material {
        base_color_texture,
        alpha: AlphaMode::Mask { cutoff: 0.5 },
        ..Material::default()
    });
    scene.object("grid", shapes::plane(Vec2::ONE), Some(material), moved(0.0, 0.0, 1.0));
    square(&mut scene, [70, 70, 70, 255], AlphaMode::Opaque, moved(0.0, 0.0, 0.0));
    let layers = [LayerKind::Ids];
    let picture = draw_layers(&scene.build(), &style(UNLINED), &ortho_view([32, 32], 1.0), &layers);
    for (x, y) in picture.places() {
        let kept = (x / 8 + y / 8) % 2 == 0;
        let (id, color) = if kept { (1, [10, 200, 30, 255]) } else { (2, [70, 70, 70, 255]) };
        assert_eq!(picture.ids(x, y)[0], id, "({x}, {y})");
        assert_eq!(picture.at(x, y), color, "({x}, {y})");
    }
}
