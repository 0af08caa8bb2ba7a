use glam::{Vec2, Vec3};

use super::tests::{assemble, model, near, read};
use crate::scene::{
    BuiltInDrawing, Drawing, FreePlacement, HighlightBlend, HighlightTone, KeyInterpolation,
    Placement, Proxy,
};
use crate::toml_file::mutate;

const TWO: &str = r##"
    version = 1
    [[model]]
    file = "hero.glb"
    [[model]]
    file = "other.glb"
    translation = [5, 0, 0]
    [[light]]
    name = "key"
    type = "directional"
    [[highlight]]
    name = "ring"
    drawing = "angel-ring"
    model = "other"
    node = "bone"
    objects = ["Hat"]
    materials = ["*"]
    proxy = { type = "capsule", from = [0, 1, 0], to_node = "Hat" }
    gamma = 0.75
    size_deg = [120, 40]
    angle_deg = 10
    color = "#ff000080"
    blend = "replace"
    tone = "shadow"
    light = "key"
    front = [1, 0, 0]
    [[highlight.key]]
    light_deg = [90, 0]
    view_deg = [0, 90]
    offset_deg = [10, -20]
    rotation_deg = 30
    scale = [2, 0.5]
    split = [0.1, 0.2]
    square = 0.3
    interpolation = "hold"
    light_range_deg = 40
    view_range_deg = 50
    [[highlight]]
    drawing = "star"
    model = "hero"
    proxy = { type = "mesh", mesh = "Hat", center = [0, -1, 0] }
    [highlight.panorama]
    limits_deg = [-30, 40]
    yaw_key = [{ at_deg = 0, place_deg = 20 }, { at_deg = -90, place_deg = 5, interpolation = "linear" }]
    pitch_key = [{ at_deg = 10, place_deg = 15 }]
"##;

/// The highlight alone, on one model.
fn one(highlight: &str) -> String {
    format!("version = 1\n[[model]]\nfile = \"hero.glb\"\n[[highlight]]\n{highlight}")
}

/// What is wrong with it.
fn wrong(highlight: &str) -> String {
    let text = one(highlight);
    let file = match super::SceneFile::from_toml_str(&text) {
        Ok(file) => file,
        Err(error) => return error.to_string(),
    };
    let assembled = file.assemble(|_| Ok::<_, String>(model()));
    assembled.err().unwrap_or_else(|| panic!("nothing is wrong with {highlight}")).to_string()
}

#[test]
fn every_key_of_a_highlight_is_read() {
    let scene = assemble(TWO).scene;
    let [ring, star] = &scene.highlights[..] else { panic!("two highlights") };
    assert_eq!(ring.drawing, Drawing::BuiltIn(BuiltInDrawing::AngelRing));
    assert_eq!((ring.blend, ring.tone), (HighlightBlend::Replace, HighlightTone::Shadow));
    assert_eq!((ring.gamma, ring.name.as_str()), (0.75, "ring"));
    assert!((ring.size - Vec2::new(120_f32, 40.0).map(f32::to_radians)).length() < 1e-6);
    let node = ring.node.expect("a bone");
    assert_eq!(scene.nodes[node].name, "bone");
    assert_eq!(scene.nodes[ring.under.expect("its model")].name, "other");
    assert!(node > ring.under.expect("its model"), "the bone of the second model");
    assert_eq!(scene.nodes[ring.light.expect("a light")].name, "key");
    assert!(ring.objects.matches("hat") && !ring.objects.matches("body"));
    assert_eq!(ring.proxy, Proxy::Capsule { from: Vec3::Y, to: Vec3::ZERO });
    let Placement::Free(FreePlacement { front, keys, level: false }) = &ring.placement else {
        panic!("{:?}", ring.placement);
    };
    let key = keys[0];
    assert!(near(*front, Vec3::X) && near(key.light, Vec3::X) && near(key.view, Vec3::Y));
    assert!((key.offset - Vec2::new(10_f32, -20.0).map(f32::to_radians)).length() < 1e-6);
    assert_eq!((key.scale, key.split, key.square), (Vec2::new(2.0, 0.5), Vec2::new(0.1, 0.2), 0.3));
    assert_eq!(key.interpolation, KeyInterpolation::Hold);
    assert_eq!(key.light_range.map(f32::to_degrees).map(f32::round), Some(40.0));
    assert_eq!(key.view_range.map(f32::to_degrees).map(f32::round), Some(50.0));
    assert_eq!(scene.nodes[star.node.expect("the model")].name, "hero");
    let Proxy::Mesh { mesh, .. } = &star.proxy else { panic!("{:?}", star.proxy) };
    assert_eq!(mesh.indices.len(), 1);
    let Placement::Panorama(panorama) = &star.placement else { panic!("a panorama") };
    let ats: Vec<f32> = panorama.yaw_keys().iter().map(|key| key.at.to_degrees()).collect();
    assert!((ats[0] + 90.0).abs() < 1e-3 && ats[1].abs() < 1e-3, "{ats:?}");
    assert_eq!(panorama.pitch_keys().len(), 1);
}

#[test]
fn a_hidden_node_can_be_a_proxy() {
    let text = "version = 1\n[[model]]\nfile = \"hero.glb\"\nhide = [\"Hat\"]\n[[highlight]]\n\
                drawing = \"disc\"\nproxy = { type = \"mesh\", mesh = \"Hat\" }";
    assert!(matches!(assemble(text).scene.highlights[0].proxy, Proxy::Mesh { .. }));
}

#[test]
fn a_sphere_with_a_radius_is_a_ball_to_be_seen_on() {
    let text = one("drawing = \"disc\"\nproxy = { center = [0, 1, 0], radius = 0.5 }");
    let proxy = &assemble(&text).scene.highlights[0].proxy;
    assert_eq!(*proxy, Proxy::Ball { center: Vec3::Y, radius: 0.5 });
    // The paper's own.
    let text = one("drawing = \"disc\"\nproxy = { center = [0, 1, 0], radius = 0 }");
    let proxy = &assemble(&text).scene.highlights[0].proxy;
    assert_eq!(*proxy, Proxy::Sphere { center: Vec3::Y });
}

#[test]
fn a_sphere_without_a_radius_is_fitted_to_what_carries_it() {
    for proxy in ["", "proxy = { center = [0, 1, 0] }", "proxy = { type = \"sphere\" }"] {
        let text = one(&format!("drawing = \"disc\"\nobjects = [\"Body\"]\n{proxy}"));
        let scene = assemble(&text).scene;
        let Proxy::Ball { radius, .. } = scene.highlights[0].proxy else { panic!("{proxy}") };
        assert!(radius.is_finite() && radius > 0.0, "{proxy}: {radius}");
    }
    // Nothing carries it: the renderer warns.
    let text = one("drawing = \"disc\"\nobjects = [\"nothing\"]");
    assert!(matches!(assemble(&text).scene.highlights[0].proxy, Proxy::Sphere { .. }));
}

#[test]
fn what_is_wrong_with_a_highlight_is_said_at_its_place() {
    let disc = "drawing = \"disc\"\n";
    let cases = [
        ("", "missing key 'drawing'"),
        ("drawing = \"star\"\nnode = \"bonne\"", "did you mean 'bone'?"),
        ("drawing = \"stars\"", "did you mean 'star'?"),
        ("drawing = \"none.png\"", "cannot be read"),
        ("drawing = \"star\"\nmodel = \"heroo\"", "did you mean 'hero'?"),
        ("drawing = \"star\"\nlight = \"lampp\"", "did you mean 'lamp'?"),
        ("drawing = \"star\"\nmask = \"none.png\"", "cannot be read"),
        ("drawing = \"star\"\nproxy = { type = \"cube\" }", "\"sphere\""),
        ("drawing = \"star\"\nproxy = { radii = [1, 1, 1] }", "no 'radii'"),
        ("drawing = \"star\"\nproxy = { radius = -1 }", "radius"),
        (
            "drawing = \"star\"\nproxy = { type = \"capsule\", to = [0, 1, 0], radius = 1 }",
            "no 'radius'",
        ),
        ("drawing = \"star\"\nproxy = { type = \"ellipsoid\" }", "needs 'radii'"),
        ("drawing = \"star\"\nproxy = { type = \"capsule\" }", "either 'to' or 'to_node'"),
        ("drawing = \"star\"\nproxy = { type = \"plane\", normal = [0, 0, 0] }", "not zero"),
        ("drawing = \"star\"\nproxy = { type = \"mesh\", mesh = \"bone\" }", "has no mesh"),
        ("drawing = \"star\"\nfront = [0, 0, 0]", "'front'"),
        ("drawing = \"star\"\ngamma = nan", "gamma"),
        ("drawing = \"star\"\ngamma = 1.5", "gamma"),
        ("drawing = \"star\"\nlevel = true\npanorama = {}", "together"),
        ("drawing = \"star\"\npanorama = { limits_deg = [10, -10] }", "lower"),
    ];
    for (text, part) in cases {
        let error = wrong(text);
        assert!(error.contains(part), "'{text}': {error}");
    }
    let key = "[[highlight.key]]\nlight_deg = [0, 0]\nview_deg = [0, 10]\n";
    let turned = "[[highlight.key]]\nlight_deg = [360, 0]\nview_deg = [0, 10]\n";
    assert!(wrong(&[disc, key, turned].concat()).contains("key 1"));
    let keys = "panorama = { yaw_key = [{ at_deg = -180, place_deg = 1 }, { at_deg = 180, place_deg = 2 }] }";
    assert!(wrong(&[disc, keys].concat()).contains("key 1"));
    let nan = "[[highlight.key]]\nlight_deg = [nan, 0]\nview_deg = [0, 10]\n";
    assert!(wrong(&[disc, nan].concat()).contains("light_deg"));
    // Two models have bones of one name.
    let twice = TWO.replace("    model = \"other\"\n", "");
    let error = read(&twice).assemble(|_| Ok::<_, String>(model())).expect_err("which bone?");
    assert!(error.to_string().contains("say which by 'model'"), "{error}");
}

#[test]
fn an_empty_picture_is_no_drawing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("empty.png");
    let picture = image::RgbaImage::from_pixel(4, 4, image::Rgba([255, 255, 255, 20]));
    picture.save(&path).expect("a PNG can be written");
    let error = wrong(&format!("drawing = {:?}", path.display().to_string()));
    assert!(error.contains("empty drawing"), "{error}");
}

#[test]
fn mutated_highlights_never_panic() {
    let accepted = mutate(TWO, 1500, |text| {
        let file = super::SceneFile::from_toml_str(text)?;
        let assembled = file.assemble(|_| Ok::<_, String>(model()))?;
        assert_eq!(assembled.scene.validate(), Ok(()));
        Ok(())
    });
    assert!(accepted > 10, "the changes are too rough: {accepted} accepted");
}
