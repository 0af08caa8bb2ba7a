//! Runs that draw.

use std::path::Path;

use image::RgbaImage;

use crate::models::{self, CORNERS, TRIANGLES, model, moving, tetrahedron, textured};
use crate::{Run, folder, genga, names, program};

fn picture(path: &Path) -> RgbaImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).into_rgba8()
}

/// How many pixels are red.
fn red(picture: &RgbaImage) -> usize {
    picture.pixels().filter(|p| p[0] > 100 && p[1] < 60 && p[2] < 60).count()
}

#[test]
fn several_models_with_layers_and_oddities() {
    let nan = f32::NAN;
    let white = r#","materials":[{}]"#;
    let mut huge = CORNERS;
    huge.iter_mut().flatten().for_each(|x| *x *= 1e10);
    let here = folder(&[
        ("good.glb", &tetrahedron()),
        ("cut.glb", &tetrahedron()[..300]),
        ("missing-texture.glb", &textured("none.png")),
        ("flat.glb", &model(&[[0.0; 3]; 3], &[0, 1, 2], "", white)),
        ("huge.glb", &model(&huge, &TRIANGLES, "", white)),
        ("nan.glb", &model(&[[nan; 3], CORNERS[1], CORNERS[2]], &[0, 1, 2], "", white)),
    ]);
    let inputs = ["good.glb", "cut.glb", "missing-texture.glb", "flat.glb", "huge.glb", "nan.glb"];
    let options = ["--size", "64x48", "--no-background", "-s", "anime"];
    let layers = ["-o", "out/{model}_{style}.png", "--layers", "color,depth,normal,ids,lines"];
    let run = genga(here.path(), &[&["render"], &inputs[..], &options, &layers].concat());
    // One is broken; the others are drawn all the same.
    assert_eq!(run.status, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("error: cut.glb"), "{}", run.stderr);
    assert!(run.stderr.contains("warning: missing-texture.glb"), "{}", run.stderr);
    assert!(run.stderr.matches("no GPU found").count() <= 1, "{}", run.stderr);
    assert!(run.stdout.is_empty());

    let out = here.path().join("out");
    let drawn = names(&out);
    for suffix in ["png", "color.png", "lines.png", "depth.exr", "normal.exr", "ids.exr"] {
        assert!(drawn.contains(&format!("good_anime.{suffix}")), "{suffix}: {drawn:?}");
    }
    assert!(!drawn.iter().any(|name| name.starts_with("cut") || name.starts_with('.')));
    let good = picture(&out.join("good_anime.png"));
    assert_eq!(good.dimensions(), (64, 48));
    assert!(red(&good) > 200, "{}", red(&good));
    assert_eq!(good.get_pixel(0, 0)[3], 0, "the background is transparent");
    let depth = std::fs::read(out.join("good_anime.depth.exr")).expect("a layer");
    assert!(depth.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    let shown = |name: &str| picture(&out.join(name)).pixels().filter(|p| p[3] > 0).count();
    assert!(shown("missing-texture_anime.png") > 200, "drawn in a flat colour");
    assert!(shown("huge_anime.png") > 200, "drawn though it is huge");
}

#[test]
fn a_dash_writes_to_standard_output() {
    let here = folder(&[("a.glb", &tetrahedron())]);
    let run = genga(here.path(), &["render", "a.glb", "--size", "40x30", "-o", "-", "-q"]).ok();
    let picture = image::load_from_memory(&run.stdout).expect("a picture").into_rgba8();
    assert_eq!(picture.dimensions(), (40, 30));
    assert_eq!(run.stderr, "", "quiet");
    assert_eq!(names(here.path()), ["a.glb"]);
}

#[test]
fn frames_show_the_clip() {
    let here = folder(&[("a.glb", &moving())]);
    let args = ["--size", "96x32", "--frames", "0..2", "--fps", "2", "--camera-azimuth-angle", "0"];
    genga(here.path(), &[&["render", "a.glb"], &args[..]].concat()).ok();
    let expected = ["a.glb", "a_0000.png", "a_0001.png", "a_0002.png"];
    assert_eq!(names(here.path()), expected);
    let center = |name: &str| {
        let picture = picture(&here.path().join(name));
        let xs: Vec<f64> = picture
            .enumerate_pixels()
            .filter(|(_, _, p)| p[0] > 100 && p[1] < 60 && p[2] < 60)
            .map(|(x, _, _)| f64::from(x))
            .collect();
        xs.iter().sum::<f64>() / xs.len() as f64
    };
    // It moves to the right, evenly, before a camera that stands still.
    let [a, b, c] = ["a_0000.png", "a_0001.png", "a_0002.png"].map(center);
    assert!(b - a > 8.0 && c - b > 8.0, "{a} {b} {c}");
}

#[test]
fn a_turntable_shows_all_sides() {
    let here = folder(&[("a.glb", &tetrahedron())]);
    let args = ["--count", "3", "--size", "32x32", "-o", "t/{index}.png", "-s", "american-comic"];
    genga(here.path(), &[&["turntable", "a.glb"], &args[..]].concat()).ok();
    assert_eq!(names(&here.path().join("t")), ["0.png", "1.png", "2.png"]);
    let [a, b] = ["t/0.png", "t/1.png"].map(|name| picture(&here.path().join(name)));
    assert!(red(&a) > 50 && red(&b) > 50 && a != b);
}

#[test]
fn a_scene_file_is_drawn_as_it_says() {
    let scene = "version = 1\nstyle = \"anime\"\n[[model]]\nfile = \"a.glb\"\nclip = \"Slide\"\ntime = 0.5\n[picture]\nsize = [48, 32]\nbackground = false\n";
    let here = folder(&[("a.glb", &moving()), ("shot.scene.toml", scene.as_bytes())]);
    let options = ["-o", "{model}-{style}.png"];
    genga(here.path(), &[&["render", "shot.scene.toml"], &options[..]].concat()).ok();
    let picture = picture(&here.path().join("shot-anime.png"));
    assert_eq!(picture.dimensions(), (48, 32));
    assert!(red(&picture) > 50 && picture.get_pixel(0, 0)[3] == 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_old_picture() {
    let here = folder(&[("a.glb", &tetrahedron()), ("out.png", b"precious")]);
    // No file may grow over half a KiB, which stands for a disk without room.
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"";
    let args = ["render", "a.glb", "--size", "400x400", "-o", "out.png"];
    let exe = env!("CARGO_BIN_EXE_genga");
    let mut command = std::process::Command::new("sh");
    command.current_dir(here.path()).args(["-c", script, exe]).args(args);
    Run::of(command.output().expect("sh starts")).fails(1, &["out.png", "larger than allowed"]);
    assert_eq!(std::fs::read(here.path().join("out.png")).expect("the old file"), b"precious");
    assert_eq!(names(here.path()), ["a.glb", "out.png"]);

    let full = std::fs::File::options().write(true).open("/dev/full").expect("/dev/full");
    let mut command = program(here.path());
    command.args(["render", "a.glb", "--size", "400x400", "-o", "-"]).stdout(full);
    Run::of(command.output().expect("the program starts")).fails(1, &["disk is full"]);
}

#[test]
fn an_adapter_that_is_not_there_is_named() {
    let here = folder(&[("a.glb", &tetrahedron())]);
    let run = genga(here.path(), &["render", "a.glb", "--adapter", "voodoo 2"]);
    run.fails(1, &["voodoo 2", "there are:"]);
}

#[test]
fn bench_reports_the_ratio() {
    let here = folder(&[("a.glb", &models::tetrahedron())]);
    let args = ["bench", "a.glb", "--runs", "2", "--size", "64x64", "--json", "-q"];
    let text = genga(here.path(), &args).ok().text();
    let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let frame = &report["frames"][0];
    assert_eq!(frame["triangles"], 4);
    assert_eq!(frame["line_method"], "contour");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let median = |kind: &str| number(&frame[kind]["total"]["median_ms"]);
    assert!(median("plain") > 0.0 && median("styled") > 0.0);
    assert!((number(&frame["ratio"]) - median("styled") / median("plain")).abs() < 1e-9);
    assert!(report["adapter"]["name"].is_string());
}

#[test]
fn highlights_are_drawn_and_their_keys_printed() {
    let scene = br##"
        version = 1
        style = "anime"
        [[model]]
        file = "good.glb"
        [camera]
        azimuth_deg = 35
        [[highlight]]
        name = "a \"spot\""
        drawing = "disc"
        size_deg = [300, 300]
        proxy = { type = "plane", normal = [1, 1, 1] }
        [[highlight.key]]
        light_deg = [0, 90]
        view_deg = [0, 0]
    "##;
    let here = folder(&[("good.glb", &tetrahedron()), ("shot.scene.toml", scene)]);
    let options = ["--size", "64x48", "-o", "shot.png", "--layers", "highlight,highlight-uv"];
    let args = [&["render", "shot.scene.toml", "--dump-keys"], &options[..]].concat();
    let run = genga(here.path(), &args).ok();
    let text = run.text();
    assert!(text.contains("name = \"a \\\"spot\\\"\"") && text.contains("light_deg = ["), "{text}");
    assert!(text.contains("view_deg = [") && text.contains("middle_deg = ["), "{text}");
    let drawn = names(here.path());
    for name in ["shot.highlight.png", "shot.highlight-uv.exr", "shot.png"] {
        assert!(drawn.contains(&name.to_owned()), "{drawn:?}");
    }
    let layer = picture(&here.path().join("shot.highlight.png"));
    assert!(layer.pixels().filter(|p| p[3] > 200 && p[0] > 200).count() > 50);
    let both = ["render", "shot.scene.toml", "--dump-keys", "-o", "-"];
    genga(here.path(), &both).fails(2, &["standard output"]);
}

#[test]
fn a_wave_that_is_too_far_away_to_shine_is_named() {
    let shot = |reach: &str| {
        let scene = format!(
            "version = 1\n[[wave]]\nname = \"far\"\nshape = \"sphere\"\nradius = 1e6\n{reach}"
        );
        let here = folder(&[("far.scene.toml", scene.as_bytes())]);
        let args = ["render", "far.scene.toml", "-o", "far.png", "--size", "32x32"];
        genga(here.path(), &args).ok().stderr
    };
    let said = shot("");
    assert!(
        said.contains("warning: far: wave 'far'") && said.contains("reach of 1000 m"),
        "{said}"
    );
    let said = shot("reach = 1e9");
    assert!(!said.contains("warning"), "{said}");
}
