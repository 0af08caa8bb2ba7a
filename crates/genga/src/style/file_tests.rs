//! Tests of styles on disk, of `extends`, and of hostile files.

use std::fs;
use std::path::Path;

use super::*;
use crate::toml_file::mutate;

fn write(directory: &Path, name: &str, text: &str) {
    fs::write(directory.join(name), text).expect("the temporary directory can be written");
}

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let directory = tempfile::tempdir().expect("a temporary directory can be made");
    for (name, text) in files {
        write(directory.path(), name, text);
    }
    directory
}

/// The error of loading `a.style.toml`, without the directory's name.
fn load_error(directory: &Path) -> String {
    let error = Style::load(directory.join("a.style.toml")).expect_err("it is wrong");
    error.to_string().replace(&format!("{}/", directory.display()), "")
}

#[test]
fn a_style_changes_the_one_it_extends() {
    let directory = folder(&[
        (
            "a.style.toml",
            r##"
            version = 1
            extends = "./b.style.toml"
            [background]
            bottom = "#111"
            [[lines.sets]]
            name = "inner"
            width = 1
            [[lines.sets]]
            name = "extra"
            types = ["user"]
            [[override]]
            select = { objects = ["late"] }
            "##,
        ),
        (
            "b.style.toml",
            r##"
            version = 1
            name = "B"
            extends = "american-comic"
            paint.shade_bias = 0.1
            [[lines.sets]]
            name = "inner"
            color = "#f00"
            [[override]]
            select = { objects = ["early"] }
            "##,
        ),
    ]);
    let comic = Style::preset("american-comic").expect("it is a preset");
    let style = Style::load(directory.path().join("a.style.toml")).expect("it is valid");
    assert_eq!(style.name, "a");
    assert_eq!(style.description, "");
    assert_eq!(style.background.color, comic.background.color);
    assert!(style.background.bottom.is_some());
    assert_eq!(style.paint.shade_bias, 0.1);
    assert_eq!(style.paint.ramp, comic.paint.ramp);
    let names: Vec<&str> = style.lines.sets.iter().map(|set| set.name.as_str()).collect();
    assert_eq!(names, ["inner", "outline", "extra"]);
    assert_eq!(style.lines.sets[0].types, comic.lines.sets[0].types);
    assert_eq!((style.lines.sets[0].width, style.lines.sets[0].color.g), (1.0, 0.0));
    assert_eq!(style.lines.sets[1], comic.lines.sets[1]);
    let own = &style.overrides[comic.overrides.len()..];
    let objects: Vec<&str> = own.iter().map(|o| o.select.objects.patterns()[0].as_str()).collect();
    assert_eq!(objects, ["early", "late"]);
}

#[test]
fn stops_replace_the_image_of_the_style_below() {
    let directory = folder(&[
        (
            "a.style.toml",
            "version = 1\nextends = './b.style.toml'\npaint.ramp.stops = [{at = 0, color = '#123'}]",
        ),
        ("b.style.toml", "version = 1\npaint.ramp = { image = 'ramp.png', gain = 3 }"),
    ]);
    let picture = image::RgbaImage::from_pixel(2, 1, image::Rgba([1, 2, 3, 255]));
    picture.save(directory.path().join("ramp.png")).expect("a PNG can be written");
    let below = Style::load(directory.path().join("b.style.toml")).expect("it is valid");
    let image = below.paint.ramp.image.expect("it is loaded");
    assert_eq!((image.width, image.height, &image.rgba[..4]), (2, 1, &[1, 2, 3, 255][..]));
    let style = Style::load(directory.path().join("a.style.toml")).expect("it is valid");
    assert_eq!(style.paint.ramp.image, None);
    assert_eq!((style.paint.ramp.gain, style.paint.ramp.stops.len()), (3.0, 1));
}

#[test]
fn pictures_lie_beside_the_file_that_names_them() {
    let directory = folder(&[("a.style.toml", "version = 1\nextends = 'sub/b.style.toml'")]);
    fs::create_dir(directory.path().join("sub")).expect("a folder can be made");
    write(
        directory.path(),
        "sub/b.style.toml",
        "version = 1\n[[override]]\nselect.id_texture = { image = 'ids.png', color = '#f00' }",
    );
    let missing = load_error(directory.path());
    assert!(
        missing.starts_with(
            "sub/b.style.toml:3:31: 'image' must be a picture, but 'sub/ids.png' cannot be read: "
        ),
        "{missing}"
    );
    write(directory.path(), "sub/ids.png", "no picture");
    let broken = load_error(directory.path());
    assert!(broken.contains("'sub/ids.png' cannot be decoded: "), "{broken}");
    let picture = image::RgbaImage::from_pixel(1, 1, image::Rgba([255, 0, 0, 255]));
    picture.save(directory.path().join("sub/ids.png")).expect("a PNG can be written");
    let style = Style::load(directory.path().join("a.style.toml")).expect("it is valid");
    let ids = style.overrides[0].select.id_texture.as_ref().expect("it is given");
    assert_eq!((ids.image.rgba.as_slice(), ids.tolerance), (&[255, 0, 0, 255][..], 0.0));
}

#[test]
fn errors_point_into_the_file_that_is_wrong() {
    let a = ("a.style.toml", "version = 1\nextends = './b.style.toml'");
    for (files, expected) in [
        (&[a][..], "a.style.toml:2:11: cannot read the style 'b.style.toml': "),
        (
            &[a, ("b.style.toml", "version = 1\nlihgt = {}")],
            "b.style.toml:2:1: unknown key 'lihgt', did you mean 'light'?",
        ),
        // Wrong, even though what extends it replaces it.
        (
            &[
                ("a.style.toml", "version = 1\nname = 'x'\nextends = './b.style.toml'"),
                ("b.style.toml", "version = 1\nname = 1"),
            ],
            "b.style.toml:2:8: 'name' must be a text in quotes, not 1",
        ),
        (
            &[a, ("b.style.toml", "version = 1\nextends = 'a.style.toml'")],
            "b.style.toml:2:11: it extends itself",
        ),
        (
            &[("a.style.toml", "version = 1\nextends = './../a.style.toml'")],
            "a.style.toml:2:11: cannot read",
        ),
        (
            &[("a.style.toml", "version = 1\nextends = './a.style.toml'")],
            "a.style.toml:2:11: it extends itself",
        ),
        (
            &[(
                "a.style.toml",
                "version = 1\nextends = 'anime'\nlines.sets = [{name='1'}, {name='2'}, {name='3'}]",
            )],
            "a.style.toml:2:11: together with what it extends: 'sets' must be a list of at most 4, each a table, not a list of 5",
        ),
        (
            &[("a.style.toml", "version = 1\nextends = 'anim'")],
            "a.style.toml:2:11: unknown style 'anim', did you mean 'anime'? (presets: american-comic, american-comic-modern, anime, blueprint, manga, pencil; ",
        ),
    ] {
        let directory = folder(files);
        let shown = load_error(directory.path());
        assert!(shown.starts_with(expected), "expected: {expected}\n     got: {shown}");
    }
}

#[test]
fn a_long_chain_ends_in_an_error() {
    let directory = folder(&[]);
    for i in 0..40 {
        let text = format!("version = 1\nextends = './{}.style.toml'", i + 1);
        write(directory.path(), &format!("{i}.style.toml"), &text);
    }
    write(directory.path(), "a.style.toml", "version = 1\nextends = './0.style.toml'");
    assert_eq!(
        load_error(directory.path()),
        "14.style.toml:2:11: more than 16 styles extend one another"
    );
}

#[test]
fn find_takes_presets_and_paths() {
    let directory = folder(&[("a.style.toml", "version = 1\nname = 'A'")]);
    let path = directory.path().join("a.style.toml");
    assert_eq!(Style::find(&path.to_string_lossy()).expect("it is there").name, "A");
    assert_eq!(Style::find("anime").expect("it is a preset").name, "Anime");
    let unknown = Style::find("Amine").expect_err("there is none").to_string();
    assert!(
        unknown.starts_with("unknown style 'Amine', did you mean 'anime'? (presets: "),
        "{unknown}"
    );
    let missing = Style::find("./no.style.toml").expect_err("there is none").to_string();
    assert!(missing.starts_with("cannot read the style './no.style.toml': "), "{missing}");
}

#[test]
fn files_that_are_no_text_or_too_large_are_refused() {
    let directory = folder(&[]);
    fs::write(directory.path().join("a.style.toml"), [0xff, 0xfe]).expect("it can be written");
    assert!(load_error(directory.path()).ends_with("it is not UTF-8 text"));
    write(directory.path(), "a.style.toml", &"#".repeat((4 << 20) + 1));
    assert!(load_error(directory.path()).ends_with("it is larger than 4 MiB"));
}

#[test]
fn deep_files_do_not_overflow_the_stack() {
    let deep_key = vec!["a"; 200_000].join(".");
    let spaced_key = vec!["'a'"; 200_000].join(" . ");
    // As deep as the limits allow: keys of 32 parts in tables in tables.
    let part = vec!["a"; 32].join(".");
    let tables = format!("x = {}1{}", format!("{{ {part} = ").repeat(70), "}".repeat(70));
    for text in [
        format!("{deep_key} = 1"),
        format!("{spaced_key} = 1"),
        format!("[{deep_key}]"),
        format!("[[{deep_key}]]"),
        format!("x = {{ {deep_key} = 1 }}"),
        tables,
        format!("x = {}", "[".repeat(1_000_000)),
        format!("x = {}", "{a = ".repeat(500_000)),
        format!("x = {}{}", "[".repeat(100_000), "]".repeat(100_000)),
        "[a]\n".repeat(100_000),
        format!("lines.sets = [{}]", "{},".repeat(100_000)),
        format!("name = '{}'", "x".repeat(1 << 20)),
        format!("{} = 1", "k".repeat(1 << 20)),
    ] {
        let text = format!("version = 1\n{text}");
        if let Err(error) = Style::from_toml_str(&text) {
            assert!(error.to_string().len() < 500, "{error}");
        }
    }
}

#[test]
fn mutated_files_never_panic() {
    for (name, text) in Style::presets() {
        let accepted = mutate(text, 600, |text| {
            let style = Style::from_toml_str(text)?;
            assert!(style.lines.sets.len() <= 4, "{name}");
            assert!((1..=8).contains(&style.paint.ramp.stops.len()), "{name}");
            Ok(())
        });
        assert!(accepted > 50, "the changes are too rough: {accepted} accepted");
    }
}

#[test]
fn examples_are_valid() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/styles/examples");
    let mut count = 0;
    for entry in fs::read_dir(examples).expect("the examples are in the source tree") {
        let path = entry.expect("the folder can be read").path();
        let style = Style::load(&path).unwrap_or_else(|e| panic!("{e}"));
        assert!(!style.name.is_empty() && !style.description.is_empty());
        count += 1;
    }
    assert!(count > 0);
}

/// What selects the steel of an atlas must not select skin, leather or black.
#[test]
fn the_metal_example_is_about_bluish_greys() {
    let example = include_str!("../../../../assets/styles/examples/metal-in-an-atlas.style.toml");
    let style = Style::from_toml_str(example).expect("it is valid");
    let [.., metal] = style.overrides.as_slice() else { panic!("an override") };
    assert!(metal.select.is_per_pixel() && metal.select.matches("any", "name"));
    let range = metal.select.base_color.expect("it is given");
    for (color, expected) in [
        ("#a9b6bd", true),
        ("#6d7380", true),
        ("#566062", true),
        ("#3d4245", true),
        ("#f6c5a2", false),
        ("#a5543a", false),
        ("#0a1012", false),
        ("#d42027", false),
        ("#ffffff", false),
    ] {
        let color: Color = color.parse().expect("it is a colour");
        assert_eq!(range.contains(color), expected, "{color}");
    }
}
