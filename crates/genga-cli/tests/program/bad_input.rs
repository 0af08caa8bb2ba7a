//! Files that cannot be drawn: one sentence, status 1, nothing written, what was there stays.

use crate::models::{CORNERS, TRIANGLES, glb, model, tetrahedron};
use crate::{folder, genga, names};

/// Tries to draw a file over an existing picture.
#[track_caller]
fn refuses(name: &str, bytes: &[u8], words: &[&str]) {
    let here = folder(&[(name, bytes), ("out.png", b"precious")]);
    genga(here.path(), &["render", name, "-o", "out.png"]).fails(1, words);
    assert_eq!(std::fs::read(here.path().join("out.png")).expect("the old file"), b"precious");
    assert_eq!(names(here.path()).len(), 2);
}

#[test]
fn a_file_that_is_not_there() {
    let here = folder(&[]);
    genga(here.path(), &["render", "none.glb"]).fails(1, &["none.glb", "No such file"]);
    genga(here.path(), &["render", "."]).fails(1, &["folder"]);
    assert!(names(here.path()).is_empty());
}

#[test]
fn truncated_files() {
    let whole = tetrahedron();
    for length in [0, 3, 11, 12, 19, 20, 200, whole.len() - 60, whole.len() - 1] {
        refuses("a.glb", &whole[..length], &["a.glb"]);
    }
}

#[test]
fn files_of_another_kind() {
    refuses("a.glb", b"\x89PNG\r\n\x1a\n and more", &["a.glb"]);
    refuses("a.xyz", b"what is this", &[".gltf, .glb or .obj"]);
    refuses("a.gltf", b"{ \"asset\": ", &["line 1"]);
}

#[test]
fn contradictions_in_the_file() {
    refuses("a.glb", &model(&CORNERS, &[0, 1, 9], "", r#","materials":[{}]"#), &["a.glb"]);
    let unknown = r#","materials":[{}],"extensionsRequired":["KHR_telepathy"]"#;
    refuses("a.glb", &model(&CORNERS, &TRIANGLES, "", unknown), &["KHR_telepathy"]);
    let cyclic = model(&CORNERS, &TRIANGLES, r#","children":[0]"#, r#","materials":[{}]"#);
    refuses("a.glb", &cyclic, &["a.glb", "node"]);
    let buffer = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"none.bin","byteLength":48}],
        "bufferViews":[{"buffer":0,"byteLength":48}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
        "scenes":[{"nodes":[0]}],"scene":0}"#;
    refuses("a.gltf", buffer.as_bytes(), &["none.bin"]);
}

#[test]
fn models_without_triangles() {
    let empty = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[]}],"scene":0}"#;
    refuses("a.glb", &glb(empty, &[]), &["neither triangles"]);
}

#[test]
fn styles_that_cannot_be_used() {
    let here = folder(&[("a.glb", &tetrahedron()), ("bad.style.toml", b"version = 1\nname = 3\n")]);
    let style = |style| genga(here.path(), &["render", "a.glb", "--style", style]);
    style("american-comc").fails(1, &["did you mean 'american-comic'?", "blueprint"]);
    style("none.style.toml").fails(1, &["none.style.toml", "No such file"]);
    style("bad.style.toml").fails(1, &["bad.style.toml:2:8", "name = 3"]);
    assert_eq!(names(here.path()).len(), 2);
}

#[test]
fn scenes_that_cannot_be_used() {
    let missing = b"version = 1\n[[model]]\nfile = \"none.glb\"\n";
    refuses("a.scene.toml", missing, &["a.scene.toml:3:", "none.glb"]);
    refuses("a.scene.toml", b"version = 1\nmodels = []\n", &["did you mean 'model'?"]);
    refuses("a.scene.toml", b"version = 1\nstyle = \"animee\"\n", &["did you mean 'anime'?"]);
}

#[test]
fn clips_and_cameras_that_are_not_there() {
    let moving = crate::models::moving();
    let here = folder(&[("a.glb", &moving)]);
    genga(here.path(), &["render", "a.glb", "--clip", "Slid"]).fails(1, &["did you mean 'Slide'?"]);
    genga(here.path(), &["render", "a.glb", "--clip", "1"]).fails(1, &["known: Slide"]);
    assert_eq!(names(here.path()).len(), 1);
}
