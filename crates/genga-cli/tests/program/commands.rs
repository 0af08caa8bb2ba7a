//! The commands that draw nothing.

use std::io::Read as _;
use std::process::Stdio;

use crate::models::{self, tetrahedron};
use crate::{Run, folder, genga, program};

#[test]
fn usage_errors_have_status_2() {
    let here = folder(&[]);
    genga(here.path(), &["frobnicate"]).fails(2, &["frobnicate", "--help"]);
    genga(here.path(), &["render"]).fails(2, &["MODEL|SCENE"]);
    genga(here.path(), &["render", "a.glb", "--size", "20000x5"]).fails(2, &["1 to 16384"]);
    genga(here.path(), &["render", "a.glb", "--supersample", "9"]).fails(2, &["--supersample"]);
    genga(here.path(), &["render", "a.glb", "--camera-zoom", "nan"]).fails(2, &["it must be"]);
    genga(here.path(), &["render", "a.glb", "--frames", "5..2"]).fails(2, &["before the first"]);
    genga(here.path(), &["render", "a.glb", "--layers", "colour"]).fails(2, &["color"]);
    assert_eq!(genga::<&str>(here.path(), &[]).status, Some(2));
    genga(here.path(), &["--help"]).ok();
    genga(here.path(), &["render", "--help"]).ok();
}

#[test]
fn info_tells_what_is_in_a_model() {
    let here = folder(&[("a.glb", &tetrahedron()), ("m.glb", &models::moving())]);
    let run = genga(here.path(), &["info", "a.glb"]).ok();
    for word in ["triangles  4", "2 × 2 × 2 m", "closed", "red"] {
        assert!(run.text().contains(word), "{word}: {}", run.text());
    }
    let json = genga(here.path(), &["info", "--json", "m.glb"]).ok().text();
    let info: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(info["triangles"], 4);
    assert_eq!(info["meshes"][0]["closed"], true);
    assert_eq!(info["clips"][0]["name"], "Slide");
    assert_eq!(info["clips"][0]["seconds"], 1.0);
}

#[test]
fn hostile_names_do_not_reach_the_terminal() {
    let extra = r#","materials":[{"name":"\u001b[2J\n"}]"#;
    let bytes = models::model(&models::CORNERS, &models::TRIANGLES, "", extra);
    let here = folder(&[("a.glb", &bytes)]);
    let text = genga(here.path(), &["info", "a.glb"]).ok().text();
    assert!(!text.contains('\u{1b}') && text.contains("\\u{1b}[2J\\n"), "{text:?}");
}

#[test]
fn check_finds_all_broken_files() {
    let style = "version = 1\nextends = \"anime\"\n[backgruond]\n";
    let scene = "version = 1\n[[model]]\nfile = \"none.glb\"\n";
    let here = folder(&[
        ("good.style.toml", b"version = 1\nextends = \"anime\"\n"),
        ("bad.style.toml", style.as_bytes()),
        ("bad.scene.toml", scene.as_bytes()),
        ("a.glb", &tetrahedron()),
        ("cut.glb", &tetrahedron()[..100]),
        ("texture.glb", &models::textured("none.png")),
    ]);
    genga(here.path(), &["check", "good.style.toml", "a.glb"]).ok();
    let all = ["good.style.toml", "bad.style.toml", "bad.scene.toml", "cut.glb", "texture.glb"];
    let run = genga(here.path(), &[&["check"], &all[..]].concat());
    assert_eq!(run.status, Some(1));
    assert_eq!(run.stderr.matches("error:").count(), 5, "{}", run.stderr);
    for word in ["did you mean 'background'?", "bad.style.toml:3:", "^^^^", "none.glb", "none.png"]
    {
        assert!(run.stderr.contains(word), "{word}: {}", run.stderr);
    }
    assert_eq!(run.text(), "good.style.toml: ok\n");
}

#[test]
fn styles_can_be_listed_printed_and_used_again() {
    let here = folder(&[]);
    let list = genga(here.path(), &["styles"]).ok().text();
    for line in list.lines() {
        let name = line.split_whitespace().next().expect("a name");
        let text = genga(here.path(), &["styles", name]).ok().stdout;
        std::fs::write(here.path().join("mine.style.toml"), text).expect("a file");
        genga(here.path(), &["check", "mine.style.toml"]).ok();
    }
    assert!(list.contains("american-comic"));
    genga(here.path(), &["styles", "animee"]).fails(1, &["did you mean 'anime'?", "blueprint"]);
}

#[test]
fn schemas_are_json() {
    let here = folder(&[]);
    for kind in ["style", "scene"] {
        let text = genga(here.path(), &["schema", kind]).ok().text();
        let schema: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert!(schema["properties"]["version"].is_object());
    }
}

#[test]
fn without_any_driver_it_says_what_to_install() {
    let here = folder(&[("a.glb", &tetrahedron())]);
    for args in [&["adapters"][..], &["render", "a.glb"]] {
        let mut command = program(here.path());
        command.args(args).env("VK_ICD_FILENAMES", "/none").env("VK_DRIVER_FILES", "/none");
        let run = Run::of(command.output().expect("the program starts"));
        if cfg!(target_os = "linux") {
            run.fails(1, &["mesa-vulkan-drivers"]);
        }
    }
    assert!(!here.path().join("a.png").exists());
}

#[test]
fn a_reader_that_has_had_enough_is_no_error() {
    let here = folder(&[]);
    let mut command = program(here.path());
    command.args(["schema", "style"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    // The pipe closes here, mostly before anything is written.
    drop(child.stdout.take());
    let mut stderr = String::new();
    let pipe = child.stderr.as_mut().expect("standard error");
    pipe.read_to_string(&mut stderr).expect("text");
    child.wait().expect("an end");
    assert_eq!(stderr, "");
}
