use super::SceneFile;
use crate::scene::{
    BeamOrder, BeamShape, Channel, ChannelTarget, Clip, Interpolation, Node, Scene, WavePlacement,
};

/// A hand that goes along x by 2 m a second from 0 to 1 s, and a foot that stands still.
fn model() -> Scene {
    let named = |name: &str| Node { name: name.to_owned(), ..Node::default() };
    let channel = Channel {
        node: 0,
        target: ChannelTarget::Translation,
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0],
        values: vec![0.0, 0.0, 0.0, 2.0, 0.0, 0.0],
    };
    Scene {
        nodes: vec![named("hand"), named("foot")],
        roots: vec![0, 1],
        clips: vec![Clip { name: "go".to_owned(), channels: vec![channel] }],
        ..Scene::default()
    }
}

const TEXT: &str = r##"
version = 1
[[model]]
file = "a.glb"
name = "figure"
translation = [0, 3, 0]
clip = "go"
time = 0.75
[[beam]]
shape = "light-trail"
from_node = "hand"
radius = 0.1
seconds = 0.25
[[beam]]
shape = "light-trail"
from_node = "foot"
[[beam]]
shape = "line"
from_node = "hand"
to_node = "foot"
radius = [0.1, 0.2]
order = "hide"
motion = { start = 1, duration = 2, grow = 0.5, shrink = 0.5 }
time = 1.25
[[beam]]
shape = "surface"
model = "figure"
"##;

#[test]
fn beams_are_read_and_follow_their_nodes() {
    let file = SceneFile::from_toml_str(TEXT).expect("the file is right");
    let assembled = file.assemble(|_| Ok::<_, String>(model())).expect("the nodes are there");
    let scene = assembled.scene;
    scene.validate().expect("all beams can be drawn, also of what stands still");
    let path = |beam: usize| match &scene.beams[beam].shape {
        BeamShape::Path { points, radius, .. } => (points.clone(), *radius),
        other => panic!("{other:?}"),
    };
    let (points, radius) = path(0);
    let [first, last] = [points[0], points[points.len() - 1]];
    assert!((first.x - 1.0).abs() < 1e-5 && (last.x - 1.5).abs() < 1e-5, "{first} to {last}");
    assert!(points.iter().all(|p| p.y == 3.0), "where the model stands");
    assert_eq!(radius, [0.0, 0.1]);
    assert!(path(1).1[1] < 1e-6, "what stands still has no trail");
    let line = &scene.beams[2];
    let WavePlacement::Between { from, to, .. } = &line.placement else { panic!("{line:?}") };
    assert_eq!((&from.nodes[..], &to.nodes[..]), (&[1][..], &[2][..]));
    assert_eq!(line.order, BeamOrder::Hide);
    assert!((line.size - 0.75).abs() < 1e-5, "it grows: {}", line.size);
    let BeamShape::Surfaces { under, .. } = &scene.beams[3].shape else { panic!("no surfaces") };
    assert_eq!(*under, Some(0));
}

#[test]
fn a_beam_without_its_node_is_an_error_at_its_place() {
    for wrong in ["from_node = \"hond\"", "model = \"figur\""] {
        let right = wrong.replace("hond", "hand").replace("figur", "figure");
        let text = TEXT.replace(&right, wrong);
        let file = SceneFile::from_toml_str(&text).expect("names are looked up later");
        let error = file.assemble(|_| Ok::<_, String>(model())).expect_err("no such node");
        assert!(error.to_string().contains("did you mean"), "{error}");
    }
}

#[test]
fn a_beam_whose_points_are_one_place_is_an_error() {
    let text = "version = 1\n[[beam]]\nshape = \"polyline\"\npoints = [[1, 2, 3], [1, 2, 3]]\n";
    let error = SceneFile::from_toml_str(text).expect_err("nothing could be seen of it");
    assert!(error.to_string().contains("at more than one place"), "{error}");
}
