//! Highlights on surfaces: bumps, skins and morphs, masks, layers, tiles, and bad input.

use std::sync::Arc;

use genga::render::{LayerKind, Orbit, Picture, View};
use genga::scene::{
    BuiltInDrawing, Drawing, FreeKey, FreePlacement, Highlight, HighlightBlend, HighlightTone,
    Moment, MorphTarget, Node, Placement, Pose, Primitive, Proxy, ProxyMesh, Scene, Skin,
};
use genga::shapes;
use genga::style::{Color, Style};
use genga_tests::highlights::{bare_style, bumpy_ball, covered, lit_scene, overlap};
use genga_tests::scenes::{image, light, model};
use genga_tests::{
    Builder, Pixels, Tolerance, difference, draw_layers, draw_posed, orbit_view, perspective_view,
    shared, style,
};
use glam::{Affine3A, Quat, Vec2, Vec3};

const FROM: Vec3 = Vec3::new(0.4, 0.5, 1.0);

fn view() -> View {
    perspective_view([192, 192], 30.0, 4.6)
}

fn of(drawing: BuiltInDrawing) -> Highlight {
    Highlight { drawing: Drawing::BuiltIn(drawing), size: Vec2::splat(1.3), ..Highlight::default() }
}

fn drawn(scene: &Scene, pose: &Pose, view: &View) -> Picture {
    draw_posed(scene, pose, &bare_style(), view, &[LayerKind::Highlight])
}

fn shape_on(primitive: Primitive, highlight: Highlight) -> Vec<bool> {
    let scene = lit_scene(primitive, FROM, vec![highlight]);
    covered(&drawn(&scene, &Pose::rest(&scene), &view()))
}

#[test]
fn a_drawing_keeps_its_shape_on_bumps_by_its_proxy_and_not_by_the_surface() {
    for drawing in [BuiltInDrawing::Star, BuiltInDrawing::Window, BuiltInDrawing::AngelRing] {
        let ball = || shapes::uv_sphere(256, 128, 1.0);
        let smooth = shape_on(ball(), of(drawing));
        assert!(smooth.iter().filter(|&&c| c).count() > 300, "{drawing:?} is too small to compare");
        let with = |gamma| {
            overlap(&smooth, &shape_on(bumpy_ball(0.03), Highlight { gamma, ..of(drawing) }))
        };
        let (by_proxy, by_surface) = (with(1.0), with(0.0));
        assert!(by_proxy >= 0.9, "{drawing:?}: {by_proxy}");
        assert!(by_surface < 0.6, "{drawing:?}: {by_surface}");
        // In between the shape gets nearer to it step by step.
        assert!(with(0.9) > with(0.3), "{drawing:?}");
    }
}

#[test]
fn a_mesh_stands_in_for_bumps_as_well() {
    let ball = shapes::uv_sphere(96, 48, 1.3);
    let indices = ball.indices.as_chunks::<3>().0.to_vec();
    let mesh = ProxyMesh { positions: ball.positions, normals: ball.normals, indices };
    let proxy = Proxy::Mesh { center: Vec3::ZERO, mesh: Arc::new(mesh) };
    let by_sphere = shape_on(bumpy_ball(0.03), of(BuiltInDrawing::Heart));
    let highlight = Highlight { proxy, ..of(BuiltInDrawing::Heart) };
    let by_mesh = shape_on(bumpy_ball(0.03), highlight);
    let same = overlap(&by_sphere, &by_mesh);
    assert!(same > 0.95, "{same}");
}

/// A ball bound to two bones, half to each in between, with a bulge as morph target.
fn skinned(highlights: Vec<Highlight>) -> Scene {
    let mut ball = shapes::uv_sphere(96, 48, 1.0);
    ball.joints = vec![[0, 1, 0, 0]; ball.positions.len()];
    let upper = |p: &Vec3| (0.5 + 4.0 * p.y).clamp(0.0, 1.0);
    ball.weights = ball.positions.iter().map(|p| [1.0 - upper(p), upper(p), 0.0, 0.0]).collect();
    let bulge = |p: &Vec3| 0.04 * (6.0 * p.x).sin() * *p;
    let positions = ball.positions.iter().map(bulge).collect();
    ball.morph_targets = vec![MorphTarget { positions, normals: Vec::new() }];
    let mut scene = lit_scene(ball, FROM, highlights);
    scene.nodes.push(Node { name: "lower".to_owned(), children: vec![3], ..Node::default() });
    scene.nodes.push(Node { name: "upper".to_owned(), parent: Some(2), ..Node::default() });
    scene.roots.push(2);
    let joint_from_mesh = vec![Affine3A::IDENTITY; 2];
    scene.skins.push(Skin { name: String::new(), joints: vec![2, 3], joint_from_mesh });
    scene.nodes[0].skin = Some(0);
    scene
}

#[test]
fn a_highlight_follows_its_bone_without_swimming() {
    let highlight = Highlight { node: Some(3), ..of(BuiltInDrawing::Star) };
    let scene = skinned(vec![highlight]);
    let rest = drawn(&scene, &Pose::rest(&scene), &view());
    let shape = covered(&rest);
    assert!(shape.iter().filter(|&&c| c).count() > 300);
    // Everything turned alike: bones, camera and light. The picture must not change.
    let turn = Affine3A::from_axis_angle(Vec3::new(0.3, 1.0, 0.2).normalize(), 0.9)
        * Affine3A::from_translation(Vec3::new(0.4, -0.2, 0.1));
    let mut pose = Pose::rest(&scene);
    pose.world_from_node.iter_mut().for_each(|m| *m = turn * *m);
    let mut turned = view();
    turned.camera.world_from_camera = turn * turned.camera.world_from_camera;
    let moved = drawn(&scene, &pose, &turned);
    let same = overlap(&shape, &covered(&moved));
    assert!(same > 0.98, "{same}");
    // Only the upper bone turns: the drawing's upper half turns with it in its own frame, so from
    // the bone's own point of view nothing changes where the skin is bound to it alone.
    let mut pose = Pose::rest(&scene);
    pose.world_from_node[3] = turn;
    pose.world_from_node[1] = turn * pose.world_from_node[1];
    let bent = drawn(&scene, &pose, &turned);
    let upper = |mask: &[bool]| -> Vec<bool> { mask[..192 * 80].to_vec() };
    let same = overlap(&upper(&shape), &upper(&covered(&bent)));
    assert!(same > 0.98, "{same}");
}

#[test]
fn a_morph_target_does_not_tear_the_drawing() {
    let highlight = Highlight { node: Some(3), ..of(BuiltInDrawing::Star) };
    let scene = skinned(vec![highlight]);
    let rest = covered(&drawn(&scene, &Pose::rest(&scene), &view()));
    let mut pose = Pose::rest(&scene);
    pose.morph_weights[0] = vec![1.0];
    let morphed = covered(&drawn(&scene, &pose, &view()));
    let same = overlap(&rest, &morphed);
    assert!(same > 0.85, "{same}");
}

#[test]
fn the_drawing_can_be_split_and_squared() {
    let at = Moment { light: FROM.normalize(), view: Vec3::Z };
    let with = |key: FreeKey| {
        let mut free = FreePlacement::default();
        free.set_key(key);
        let placement = Placement::Free(free);
        shape_on(
            shapes::uv_sphere(128, 64, 1.0),
            Highlight { size: Vec2::splat(0.5), placement, ..of(BuiltInDrawing::Disc) },
        )
    };
    let area = |mask: &[bool]| mask.iter().filter(|&&c| c).count() as f64;
    let disc = with(FreeKey::at(&at));
    let square = with(FreeKey { square: 1.0, ..FreeKey::at(&at) });
    // A square round a circle has 4/π of its area.
    let ratio = area(&square) / area(&disc);
    assert!((1.24..1.3).contains(&ratio), "{ratio}");
    let split = with(FreeKey { split: Vec2::new(1.4, 0.0), ..FreeKey::at(&at) });
    // Two discs: the middle is empty and the area is twice as large.
    let ratio = area(&split) / area(&disc);
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
}

/// A ball with texture coordinates and a highlight, in the style's two tones.
fn toned(change: impl Fn(&mut Highlight), style: &Style) -> Picture {
    let mut highlight = Highlight { size: Vec2::splat(3.0), ..of(BuiltInDrawing::Disc) };
    change(&mut highlight);
    let from = Vec3::new(1.0, 0.3, 0.2);
    let key = FreeKey { offset: Vec2::new(-1.2, 0.0), ..FreeKey::at(&moment(from)) };
    highlight.placement =
        Placement::Free(FreePlacement { keys: vec![key], ..FreePlacement::default() });
    let scene = lit_scene(shapes::uv_sphere(96, 48, 1.0), from, vec![highlight]);
    let layers = [LayerKind::Highlight, LayerKind::Color];
    draw_layers(&scene, style, &view(), &layers)
}

fn moment(from: Vec3) -> Moment {
    Moment { light: from.normalize(), view: Vec3::Z }
}

#[test]
fn a_highlight_shows_only_in_its_tones() {
    let two_tones = style(
        "[lines]\nmethod = \"none\"\n[paint.ramp]\nstops = [{ at = 0.0, color = \"#808080\" }, { at = 0.5, color = \"#ffffff\" }]",
    );
    let all = toned(|_| {}, &two_tones);
    let lit = toned(|h| h.tone = HighlightTone::Light, &two_tones);
    let shaded = toned(|h| h.tone = HighlightTone::Shadow, &two_tones);
    let [all_mask, lit_mask, shaded_mask] = [&all, &lit, &shaded].map(covered);
    let (mut in_light, mut in_shadow) = (0, 0);
    for (i, (x, y)) in all.places().enumerate() {
        // Without a highlight: the tone of the paint alone, whose base colour is one.
        let tone = all.paint(x, y);
        if !all_mask[i] || tone[3] < 255 {
            assert!(!lit_mask[i] && !shaded_mask[i] || tone[3] < 255);
            continue;
        }
        assert!(lit_mask[i] != shaded_mask[i] || all.ids_edge(x, y), "({x}, {y})");
        in_light += usize::from(lit_mask[i]);
        in_shadow += usize::from(shaded_mask[i]);
    }
    assert!(in_light > 500 && in_shadow > 500, "{in_light} and {in_shadow}");
}

/// Whether a pixel lies on the edge between two tones.
trait ToneEdge {
    fn ids_edge(&self, x: u32, y: u32) -> bool;
}

impl ToneEdge for Picture {
    fn ids_edge(&self, x: u32, y: u32) -> bool {
        let here = self.paint(x, y);
        let near = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        near.into_iter().any(|(x, y)| self.paint(x, y) != here)
    }
}

#[test]
fn a_picture_masks_a_highlight_by_texture_coordinates() {
    let half = image(8, 8, |_, y| if y < 4 { [255; 4] } else { [0, 0, 0, 255] });
    let masked = toned(|h| h.mask = Some(Arc::new(half.clone())), &bare_style());
    let all = covered(&toned(|_| {}, &bare_style()));
    let mask = covered(&masked);
    let (upper, lower) = (192 * 90, 192 * 102);
    let count = |mask: &[bool]| mask.iter().filter(|&&c| c).count();
    assert_eq!(count(&mask[..upper]), count(&all[..upper]));
    assert_eq!(count(&mask[lower..]), 0);
    assert!(count(&all[lower..]) > 100);
}

#[test]
fn colour_and_highlight_layers_add_up_to_the_picture() {
    let no_background = View { background: false, ..view() };
    for blend in [HighlightBlend::Add, HighlightBlend::Replace] {
        let color = Color { r: 0.9, g: 0.4, b: 0.5, a: 0.7 };
        let highlight = Highlight { blend, color, ..of(BuiltInDrawing::Star) };
        let scene = lit_scene(shapes::uv_sphere(96, 48, 1.0), FROM, vec![highlight]);
        let layers = [LayerKind::Color, LayerKind::Highlight, LayerKind::Lines];
        let picture = draw_layers(&scene, &bare_style(), &no_background, &layers);
        let mut seen = 0;
        for (i, (x, y)) in picture.places().enumerate() {
            let (whole, below) = (picture.at(x, y), picture.paint(x, y));
            let top = picture.bytes(LayerKind::Highlight)[4 * i..4 * i + 4].to_vec();
            if below[3] < 255 {
                continue;
            }
            let alpha = f32::from(top[3]) / 255.0;
            // What is added stops at white in every sample: only whole pixels add up exactly.
            if alpha > 0.01 && alpha < 0.69 {
                continue;
            }
            seen += usize::from(alpha > 0.5);
            for c in 0..3 {
                let (b, t) = (f32::from(below[c]), f32::from(top[c]));
                let expected = match blend {
                    HighlightBlend::Add => (b + t * alpha).min(255.0),
                    HighlightBlend::Replace => b * (1.0 - alpha) + t * alpha,
                };
                let off = (f32::from(whole[c]) - expected).abs();
                assert!(off <= 2.5, "({x}, {y}) {blend:?}: {whole:?}, {below:?}, {top:?}");
            }
        }
        assert!(seen > 300, "{seen}");
    }
}

#[test]
fn what_stands_in_front_hides_a_highlight_in_its_layer() {
    let mut scene = lit_scene(shapes::uv_sphere(96, 48, 1.0), FROM, vec![of(BuiltInDrawing::Disc)]);
    let whole = covered(&drawn(&scene, &Pose::rest(&scene), &view()));
    let names = genga::style::Globs::new(["ball"]).expect("a glob");
    scene.highlights[0].objects = names;
    let mut builder = Builder::new();
    *builder.raw() = scene;
    let front = genga_tests::scenes::moved(0.0, 0.0, 1.5);
    builder.object("card", shapes::plane(Vec2::new(4.0, 0.4)), None, front);
    let scene = builder.build();
    let hidden = covered(&drawn(&scene, &Pose::rest(&scene), &view()));
    let count = |mask: &[bool]| mask.iter().filter(|&&c| c).count();
    assert!(count(&hidden) < count(&whole) * 9 / 10 && count(&hidden) > 100);
    assert!(hidden.iter().zip(&whole).all(|(h, w)| !h || *w));
}

#[test]
fn tiles_have_the_highlights_of_the_whole_picture() {
    let mut highlights = vec![of(BuiltInDrawing::Star), of(BuiltInDrawing::AngelRing)];
    highlights[1].placement = Placement::Panorama(genga::scene::PanoramaPlacement::default());
    highlights[1].gamma = 0.8;
    let scene = lit_scene(bumpy_ball(0.03), FROM, highlights);
    let style = bare_style();
    let renderer = &shared().renderer;
    let _turn = shared().turn();
    let prepared = renderer.prepare(&scene, &style).expect("a scene");
    for supersample in [1, 2] {
        let view = View { supersample, ..view() };
        let layers = [LayerKind::Highlight, LayerKind::HighlightUv];
        let draw = |texels| {
            let mut quiet = |_, _| {};
            let picture = renderer.picture_in_tiles(&prepared, &view, &layers, texels, &mut quiet);
            pollster::block_on(picture).expect("a picture")
        };
        let (whole, tiled) = (draw(4096), draw(130));
        let difference = difference(&whole, &tiled, Tolerance::same_picture());
        assert!(!difference.is_too_much, "{difference:?}");
        let [a, b] = [&whole, &tiled].map(|p| p.floats(LayerKind::HighlightUv));
        // Far round the back coordinates grow beyond all bounds, and rounding with them.
        let near = a.iter().zip(b).filter(|(a, _)| a.abs() < 10.0);
        let worst = near.map(|(a, b)| (a - b).abs() / (1.0 + a.abs())).fold(0.0, f32::max);
        assert!(worst < 5e-3, "{worst}");
    }
}

/// No pixel may come from NaN: it would be black or transparent in the middle of the surface.
fn assert_sensible(highlight: Highlight, what: &str) {
    let scene = lit_scene(shapes::uv_sphere(64, 32, 1.0), FROM, vec![highlight]);
    let layers = [LayerKind::Color, LayerKind::HighlightUv, LayerKind::Highlight];
    let picture = draw_layers(&scene, &bare_style(), &view(), &layers);
    assert!(picture.floats(LayerKind::HighlightUv).iter().all(|v| v.is_finite()), "{what}");
    for (x, y) in picture.places() {
        let (whole, below) = (picture.at(x, y), picture.paint(x, y));
        if below[3] == 255 {
            let darker = (0..3).any(|c| whole[c] < below[c].saturating_sub(2));
            assert!(whole[3] == 255 && !darker, "{what} at ({x}, {y}): {whole:?} over {below:?}");
        }
    }
}

#[test]
fn odd_numbers_give_a_sensible_picture() {
    let base = || of(BuiltInDrawing::Disc);
    let at = moment(FROM);
    let keyed =
        |keys: Vec<FreeKey>| Placement::Free(FreePlacement { keys, ..FreePlacement::default() });
    let key = FreeKey::at(&at);
    let cases = [
        ("no keys", base()),
        ("one key", Highlight { placement: keyed(vec![key]), ..base() }),
        ("equal keys", Highlight { placement: keyed(vec![key, key]), ..base() }),
        (
            "a centre on the surface",
            Highlight { proxy: Proxy::Sphere { center: Vec3::Z }, ..base() },
        ),
        (
            "a centre at a vertex",
            Highlight { proxy: Proxy::Sphere { center: Vec3::Y }, gamma: 0.5, ..base() },
        ),
        (
            "a centre far away",
            Highlight { proxy: Proxy::Sphere { center: Vec3::X * 1e6 }, ..base() },
        ),
        ("a tiny drawing", Highlight { size: Vec2::splat(1e-5), ..base() }),
        ("a huge drawing", Highlight { size: Vec2::splat(50.0), ..base() }),
        (
            "huge splits",
            Highlight {
                placement: keyed(vec![FreeKey {
                    split: Vec2::splat(1e6),
                    square: 1.0,
                    scale: Vec2::new(1e-6, 1e6),
                    ..key
                }]),
                ..base()
            },
        ),
        (
            "a point for a capsule",
            Highlight { proxy: Proxy::Capsule { from: Vec3::X, to: Vec3::X }, ..base() },
        ),
        (
            "a drawing opposite to its light",
            Highlight {
                placement: keyed(vec![FreeKey {
                    offset: Vec2::new(std::f32::consts::PI, 0.0),
                    ..key
                }]),
                ..base()
            },
        ),
    ];
    for (what, highlight) in cases {
        assert_sensible(highlight, what);
    }
}

#[test]
fn a_flattened_node_gives_a_sensible_picture() {
    let mut scene = lit_scene(shapes::uv_sphere(64, 32, 1.0), FROM, vec![of(BuiltInDrawing::Disc)]);
    scene.highlights[0].node = Some(0);
    let flat = genga_tests::scenes::parts(Vec3::ZERO, Quat::IDENTITY, Vec3::new(1.0, 1.0, 0.0));
    scene.nodes[0].transform = flat;
    let picture =
        draw_layers(&scene, &bare_style(), &view(), &[LayerKind::HighlightUv, LayerKind::Color]);
    assert!(picture.floats(LayerKind::HighlightUv).iter().all(|v| v.is_finite()));
}

#[test]
fn the_light_that_a_highlight_belongs_to_can_be_chosen() {
    let mut builder = Builder::new();
    let skin = builder.colored("skin", [0.6, 0.3, 0.2]);
    let ball = shapes::uv_sphere(96, 48, 1.0);
    builder.object("ball", ball, Some(skin), genga::scene::Transform::default());
    let kind = genga::scene::LightKind::Directional;
    builder.light(light(kind, 3.0), Vec3::new(1.0, 0.3, 1.0));
    builder.light(light(kind, 1.0), Vec3::new(-1.0, 0.3, 1.0));
    let mut scene = builder.build();
    scene.highlights = vec![Highlight { size: Vec2::splat(0.6), ..of(BuiltInDrawing::Disc) }];
    let side = |scene: &Scene| {
        let mask = covered(&drawn(scene, &Pose::rest(scene), &view()));
        let right = mask.iter().enumerate().filter(|(i, c)| **c && i % 192 >= 96).count();
        2 * right > mask.iter().filter(|&&c| c).count()
    };
    assert!(side(&scene), "the strongest light is on the right");
    scene.highlights[0].light = Some(2);
    assert!(!side(&scene), "the other one is on the left");
}

#[test]
fn more_than_four_highlights_on_a_surface_are_left_out_with_a_warning() {
    let scene = lit_scene(shapes::uv_sphere(32, 16, 1.0), FROM, vec![of(BuiltInDrawing::Disc); 5]);
    let _turn = shared().turn();
    let prepared = shared().renderer.prepare(&scene, &bare_style()).expect("a scene");
    let text = prepared.warnings().join("\n");
    assert!(text.contains("more than 4 highlights"), "{text}");
}

#[test]
fn other_styles_and_lines_go_with_highlights() {
    let mut scene = model("teapot-on-box");
    scene.highlights = vec![Highlight {
        proxy: Proxy::Sphere { center: Vec3::new(0.0, 0.3, 0.0) },
        ..of(BuiltInDrawing::Window)
    }];
    let view = orbit_view(&scene, &Orbit::default(), [160, 120]);
    for method in ["none", "contour", "reference", "hull", "rim", "image"] {
        for blend in ["display", "linear"] {
            let toml =
                format!("[lines]\nmethod = \"{method}\"\n[paint]\nblend_space = \"{blend}\"");
            let picture = draw_layers(&scene, &style(&toml), &view, &[LayerKind::Highlight]);
            let count = covered(&picture).into_iter().filter(|&c| c).count();
            assert!(count > 20, "{method}, {blend}: {count}");
        }
    }
}

#[test]
fn a_drawing_on_a_ball_can_be_put_at_any_pixel_of_a_head() {
    let mut scene = genga_tests::highlight_proofs::head_with(of(BuiltInDrawing::Star));
    scene.highlights[0].proxy = Proxy::Ball { center: Vec3::new(0.0, 0.26, -0.02), radius: 0.14 };
    let view = orbit_view(&scene, &Orbit::default(), [120, 120]);
    let puts = genga_tests::highlights::put_everywhere(&scene, &view, 20, 7);
    assert!(puts.tried >= 10 && puts.worst_px <= 1.0, "{puts:?}");
}

#[test]
fn a_drawing_ends_at_the_rim_of_its_ball() {
    // The light behind: the drawing reaches round the rim, beyond which sight misses the ball.
    let proxy = Proxy::Ball { center: Vec3::ZERO, radius: 0.6 };
    let highlight = Highlight { proxy, size: Vec2::splat(5.0), ..of(BuiltInDrawing::Disc) };
    let from = Vec3::new(0.6, 0.2, -1.0);
    let scene = lit_scene(shapes::uv_sphere(96, 48, 1.0), from, vec![highlight]);
    let covered = covered(&drawn(&scene, &Pose::rest(&scene), &view()));
    let (mut inside, mut outside) = (0, 0);
    for (i, _) in covered.iter().enumerate().filter(|(_, is)| **is) {
        let [origin, direction] =
            view().ray(Vec2::new((i % 192) as f32 + 0.5, (i / 192) as f32 + 0.5));
        let away = (origin - direction * origin.dot(direction)).length();
        if away < 0.61 { inside += 1 } else { outside += 1 }
    }
    assert!(inside > 500 && outside == 0, "{inside} pixels inside of the rim, {outside} outside");
}

#[test]
fn a_star_keeps_its_shape_on_the_locks_of_a_head() {
    let overlap = genga_tests::highlight_proofs::overlap_on_head;
    let (own, round, paper) = (overlap(0.0, true), overlap(1.0, true), overlap(1.0, false));
    assert!(round >= 0.9, "γ = 1 keeps {round:.3} of it");
    assert!(own < 0.5, "γ = 0 keeps {own:.3}, so this proves nothing");
    // Normals from the centre keep less of it: locks stand off the ball.
    assert!(own < paper && paper < round, "without a ball γ = 1 keeps {paper:.3}");
}
