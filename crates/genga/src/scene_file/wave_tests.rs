use super::SceneFile;
use crate::scene::{Node, Scene, WaveMethod, WavePlacement};

#[test]
fn waves_are_read_and_hold_on_to_nodes() {
    let text = r##"
version = 1
[[model]]
file = "a.glb"
[[wave]]
shape = "helix"
length = 2
helix_radius = 0.3
turns = 4
from_node = ["left", "right"]
to_node = "goal"
radius = 0.2
ramp = [{ energy = 0.5, color = "#f00" }]
order = "over"
motion = { head_speed = 0.5 }
time = 1
[wave_reference]
points = 100
"##;
    let file = SceneFile::from_toml_str(text).expect("the file is right");
    let named = |name: &str| Node { name: name.to_owned(), ..Node::default() };
    let model = || Scene {
        nodes: vec![named("left"), named("right"), named("goal")],
        roots: vec![0, 1, 2],
        ..Scene::default()
    };
    let assembled = file.assemble(|_| Ok::<_, String>(model())).expect("the nodes are there");
    let wave = &assembled.scene.waves[0];
    let WavePlacement::Between { from, to, .. } = &wave.placement else { panic!("{wave:?}") };
    assert_eq!((&from.nodes[..], &to.nodes[..]), (&[1, 2][..], &[3][..]));
    assert_eq!(wave.growth, [0.0, 0.5]);
    let reference = WaveMethod::Simpson { points: 100, thinning: 1, de_boor: false };
    assert_eq!(assembled.scene.wave_method, reference);
    let wrong = text.replace("\"goal\"", "\"gaol\"");
    let file = SceneFile::from_toml_str(&wrong).expect("names are looked up later");
    let error = file.assemble(|_| Ok::<_, String>(model())).expect_err("there is no such node");
    assert!(error.to_string().contains("did you mean 'goal'"), "{error}");
}

#[test]
fn what_is_stretched_needs_no_length() {
    for shape in ["cylinder", "capsule", "helix\"\nhelix_radius = 0.1 #", "trig"] {
        let text = format!("version = 1\n[[wave]]\nshape = \"{shape}\"\nto = [0, 3, 0]\n");
        let file = SceneFile::from_toml_str(&text).expect("the end is given");
        let assembled = file.assemble(|_| Ok::<_, String>(Scene::default())).expect("no names");
        let places = assembled.scene.waves[0].places(&assembled.pose, 3);
        let gap = (places[2] - places[0]).y;
        assert!((gap - 3.0).abs() < 1e-5, "{shape}: {gap}");
    }
}

#[test]
fn wrong_waves_are_shown_at_their_place() {
    for (keys, part) in [
        ("shape = \"sphere\"\nlength = 1", "a sphere has none"),
        ("shape = \"capsule\"", "must have a 'length'"),
        ("shape = \"bezier\"\npoints = [[0, 0, 0], [2, 0, 0], [1, 0, 0]]\nradius = nan", "number"),
        (
            "shape = \"polyline\"\npoints = [[0, 0, 0], [3, 0, 0], [2, 1, 0], [4, 0, 0]]",
            "folds back",
        ),
        ("shape = \"sphere\"\nto = [1, 0, 0]", "no length"),
        ("shape = \"sphere\"\nglow = 1", "unknown key"),
    ] {
        let error = SceneFile::from_toml_str(&format!("version = 1\n[[wave]]\n{keys}\n"))
            .expect_err("this wave is wrong")
            .to_string();
        assert!(error.contains(part), "{keys}: {error}");
    }
}
