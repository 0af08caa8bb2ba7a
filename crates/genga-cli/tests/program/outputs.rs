//! Names of outputs that cannot work are found before anything is drawn.

use crate::models::{moving, tetrahedron, textured};
use crate::{folder, genga, names};

#[test]
fn names_that_cannot_work_are_usage_errors() {
    let here = folder(&[("a.glb", &moving()), ("b.glb", &tetrahedron())]);
    let render = |args: &[&str]| genga(here.path(), &[&["render", "a.glb"], args].concat());
    render(&["-o", "{modle}.png"]).fails(2, &["did you mean '{model}'?"]);
    render(&["-o", "a.jpg"]).fails(2, &["PNG", "'a.png'"]);
    render(&["-o", "a"]).fails(2, &["'a.png'"]);
    render(&["-o", ""]).fails(2, &["empty"]);
    render(&["b.glb", "-o", "out.png"]).fails(2, &["out.png", "{model}"]);
    render(&["--frames", "0..3", "-o", "{model}.png"]).fails(2, &["{frame:04}"]);
    render(&["b.glb", "-o", "-"]).fails(2, &["one picture"]);
    render(&["--layers", "depth", "-o", "-"]).fails(2, &["without layers"]);
    assert_eq!(names(here.path()), ["a.glb", "b.glb"]);
}

#[test]
fn inputs_are_never_overwritten() {
    // The texture has the name that the picture would have.
    let here = folder(&[("a.glb", &textured("a.png")), ("a.png", b"not even a picture")]);
    genga(here.path(), &["render", "a.glb", "-q", "--size", "8x8"])
        .fails(2, &["a.png", "not be overwritten"]);
    assert_eq!(std::fs::read(here.path().join("a.png")).expect("a file"), b"not even a picture");
    std::fs::create_dir(here.path().join("b.png")).expect("a folder");
    genga(here.path(), &["render", "a.glb", "-o", "b.png"]).fails(2, &["is a folder"]);
}
