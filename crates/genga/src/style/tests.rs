//! Tests of style files as a whole.

use super::*;
use crate::FileError;

fn error(text: &str) -> FileError {
    Style::from_toml_str(text).err().unwrap_or_else(|| panic!("accepted: {text}"))
}

#[test]
fn presets_are_read_and_differ() {
    let styles: Vec<Style> = Style::presets()
        .map(|(name, text)| Style::from_toml_str(text).unwrap_or_else(|e| panic!("{name}: {e}")))
        .collect();
    for (i, style) in styles.iter().enumerate() {
        assert!(!style.name.is_empty() && !style.description.is_empty());
        assert!(styles[..i].iter().all(|other| other != style));
    }
    let comic = Style::preset("american-comic").expect("it is a preset");
    assert_eq!(comic.paint.hatch.pattern, HatchPattern::Strokes);
    assert_eq!(comic.lines.sets[1].types[0], LineType::Silhouette);
    assert_eq!(Style::preset("blueprint").expect("it is a preset").paint.base, BaseColor::None);
    assert_eq!(Style::preset("no-such"), None);
}

#[test]
fn a_short_file_has_the_defaults() {
    assert_eq!(Style::from_toml_str("version = 1").expect("it is valid"), Style::default());
}

#[test]
fn every_key_is_read() {
    let style = Style::from_toml_str(
        r##"
        version = 1
        name = "All"
        description = "Everything"
        [background]
        color = "#123"
        bottom = "#12345678"
        [light]
        azimuth_deg = 10
        elevation_deg = -20.5
        pinned_to = "world"
        replace_model_lights = true
        [paint]
        base = "#f00"
        blend_space = "linear"
        shade_bias = -0.5
        [paint.ramp]
        stops = [{ at = 0, color = "#000", softness = 0.1, blend = "replace" },
                 { at = 0.5, color = "#fff" }]
        smooth = true
        gain = 2
        [lines]
        method = "hull"
        reference_height = 720
        [lines.detect]
        depth = 1
        crease_deg = 2
        objects = false
        materials = false
        user = false
        [lines.hull]
        width_m = 0.01
        [lines.rim]
        threshold = 0.2
        softness = 0.1
        [[lines.sets]]
        name = "one"
        types = ["silhouette", "crease", "object", "material", "border", "user"]
        objects = ["Head*"]
        materials = ["skin"]
        color = "#0f0"
        opacity = 0.5
        width = 7
        [[override]]
        select = { objects = ["a"], materials = ["b"], base_color = { hue = [350, 20] } }
        paint = { base = "none", shade_bias = 0.25, ramp = { smooth = true } }
        lines = { visible = false, width = 2, line_id = 3 }
        [[override]]
        select = { vertex_color = { red = [0.5, 1] } }
        "##,
    )
    .expect("it is valid");
    assert_eq!((style.name.as_str(), style.description.as_str()), ("All", "Everything"));
    assert_eq!(style.background.color.to_string(), "#112233");
    assert_eq!(style.background.bottom.map(|c| c.to_string()).as_deref(), Some("#12345678"));
    let light = StyleLight {
        azimuth_deg: 10.0,
        elevation_deg: -20.5,
        pinned_to: PinnedTo::World,
        replace_model_lights: true,
    };
    assert_eq!(style.light, light);
    let red = Color { r: 1.0, g: 0.0, b: 0.0, a: 1.0 };
    assert_eq!(style.paint.base, BaseColor::Fixed(red));
    assert_eq!(style.paint.blend_space, BlendSpace::Linear);
    assert_eq!(style.paint.shade_bias, -0.5);
    let ramp = Ramp {
        stops: vec![
            RampStop { at: 0.0, color: Color::BLACK, softness: 0.1, blend: ToneBlend::Replace },
            RampStop { at: 0.5, color: Color::WHITE, softness: 0.0, blend: ToneBlend::Multiply },
        ],
        smooth: true,
        image: None,
        gain: 2.0,
    };
    assert_eq!(style.paint.ramp, ramp);
    assert_eq!((style.lines.method, style.lines.reference_height), (LineMethod::Hull, 720.0));
    let detect = Detect {
        depth: 1.0,
        crease_deg: 2.0,
        objects: false,
        materials: false,
        user: false,
        ..Detect::default()
    };
    assert_eq!(style.lines.detect, detect);
    assert_eq!(style.lines.hull, Hull { width_m: Some(0.01) });
    assert_eq!(style.lines.rim, Rim { threshold: 0.2, softness: 0.1 });
    let [set] = style.lines.sets.as_slice() else { panic!("one set") };
    assert_eq!((set.name.as_str(), set.types.len()), ("one", 6));
    assert_eq!((set.opacity, set.width, set.color.g), (0.5, 7.0, 1.0));
    assert!(set.matches("head.L", "Skin") && !set.matches("Arm", "skin"));
    let [first, second] = style.overrides.as_slice() else { panic!("two overrides") };
    assert_eq!(first.select.objects.patterns(), ["a"]);
    assert_eq!(first.select.materials.patterns(), ["b"]);
    let range = first.select.base_color.expect("it is given");
    assert_eq!((range.hue, range.saturation), ([350.0, 20.0], [0.0, 1.0]));
    assert_eq!((first.paint.base, first.paint.shade_bias), (Some(BaseColor::None), Some(0.25)));
    assert!(first.paint.ramp.as_ref().is_some_and(|ramp| ramp.smooth));
    assert_eq!((first.lines.visible, first.lines.width), (Some(false), Some(2.0)));
    assert_eq!(first.lines.line_id, Some(3));
    let range = second.select.vertex_color.expect("it is given");
    assert_eq!((range.red, range.alpha), ([0.5, 1.0], [0.0, 1.0]));
    assert!(first.select.is_per_pixel() && second.select.is_per_pixel());
}

#[test]
fn errors_name_the_place_and_the_remedy() {
    for (text, expected) in [
        ("", "1:1: missing key 'version'"),
        ("version = 2", "1:11: 'version' must be 1, not 2"),
        ("version = 1\nname = \"x", "2:10: "),
        ("version = 1\nnme = 1", "2:1: unknown key 'nme', did you mean 'name'?"),
        ("version = 1\nzzzzz = 1", "2:1: unknown key 'zzzzz'"),
        (
            "version = 1\n[background]\n  colr = \"#fff\"",
            "3:3: unknown key 'colr', did you mean 'color'?",
        ),
        ("version = 1\nname = 3", "2:8: 'name' must be a text in quotes, not 3"),
        ("version = 1\nbackground = []", "2:14: 'background' must be a table, not a list of 0"),
        ("version = 1\nlines = \"x\"", "2:9: 'lines' must be a table, not \"x\""),
        (
            "version = 1\n[background]\ncolor = \"red\"",
            "3:9: 'color' must be a colour such as \"#f80\" or \"#ff8800\", with two more digits for alpha",
        ),
        (
            "version = 1\npaint.base = \"modl\"",
            "2:14: 'base' must be \"model\", \"none\", \"paper\" or a colour such as \"#ff8800\"",
        ),
        (
            "version = 1\npaint.shade_bias = nan",
            "2:20: 'shade_bias' must be a number from -1 to 1, not nan",
        ),
        (
            "version = 1\npaint.hatch.pattern = \"strocks\"",
            "2:23: 'pattern' must be \"none\", \"strokes\", \"cross\", \"solid\", \"stipple\", \"pencil\", \"dots\" or \"image\", not \"strocks\"",
        ),
        (
            "version = 1\npaint.hatch.spacing = 0",
            "2:23: 'spacing' must be a number from 1 to 1000, not 0",
        ),
        (
            "version = 1\npaint.hatch.spaceing = 4",
            "2:13: unknown key 'spaceing', did you mean 'spacing'?",
        ),
        (
            "version = 1\npaint.hatch.tones = [{ at = 0.5, lum = 0 }, { at = 0.5, lum = 1 }]",
            "2:45: 'tones' must be in rising order, but one at 0.5 follows one at 0.5",
        ),
        (
            "version = 1\npaint.hatch.axis = [0, 0, 0]",
            "2:20: 'axis' must be a direction: three numbers that are not all 0",
        ),
        (
            "version = 1\n[[lines.sets]]\nwidth = -1",
            "3:9: 'width' must be a number of at least 0, not -1",
        ),
        (
            "version = 1\n[[lines.sets]]\nwidth = 1e39",
            "3:9: 'width' must be a number of at least 0, not 1e39",
        ),
        (
            "version = 1\nlines.reference_height = 0",
            "2:26: 'reference_height' must be a number over 0, not 0",
        ),
        (
            "version = 1\nlines.method = \"countour\"",
            "2:16: 'method' must be \"none\", \"contour\", \"reference\", \"hull\", \"rim\" or \"image\", not \"countour\"",
        ),
        (
            "version = 1\nlines.sets = [{}, {name=\"b\"}, {name=\"c\"}, {name=\"d\"}, {name=\"e\"}]",
            "2:14: 'sets' must be a list of at most 4, each a table, not a list of 5",
        ),
        (
            "version = 1\nlines.sets = [{name=\"a\"}, {name=\"a\"}]",
            "2:27: 'sets' must have different names, but there are two 'a'",
        ),
        (
            "version = 1\nlines.sets = [{objects=[\"ok\", \"[z\"]}]",
            "2:31: 'objects' must be a glob, which \"[z\" is not: invalid range pattern",
        ),
        (
            "version = 1\npaint.ramp.stops = []",
            "2:20: 'stops' must be a list of 1 to 8, each a table, not a list of 0",
        ),
        ("version = 1\npaint.ramp.stops = [{at = 0}]", "2:21: missing key 'color'"),
        (
            "version = 1\npaint.ramp.stops = [{at = 0.5, color = \"#000\"}]",
            "2:21: 'stops' must begin with a stop at 0, not at 0.5",
        ),
        (
            "version = 1\npaint.ramp.stops = [{at = 0, color = \"#000\"},\n {at = 0, color = \"#fff\"}]",
            "3:2: 'stops' must be in rising order, but one at 0 follows one at 0",
        ),
        (
            "version = 1\n[[override]]\nselect = { base_color = { hue = [0, 361] } }",
            "3:37: 'hue' must be a number from 0 to 360, not 361",
        ),
        (
            "version = 1\n[[override]]\nselect = { base_color = { value = [1] } }",
            "3:35: 'value' must be a list of 2, each a number from 0 to 1, not a list of 1",
        ),
        (
            "version = 1\n[[override]]\nselect = { base_color = { value = [0.5, 0.4] } }",
            "3:35: 'value' must go from a smaller to a larger number, not from 0.5 to 0.4",
        ),
        (
            "version = 1\n[[override]]\nlines.line_id = 65536",
            "3:17: 'line_id' must be a whole number from 0 to 65535, not 65536",
        ),
        (
            "version = 1\n[[override]]\nlines.visible = 1",
            "3:17: 'visible' must be true or false, not 1",
        ),
        (
            &format!("version = 1\n{}", "[[override]]\n".repeat(257)),
            "2:1: 'override' must be a list of at most 256, each a table, not a list of 257",
        ),
        (
            "version = 1\nextends = \"american-comics\"",
            "2:11: unknown style 'american-comics', did you mean 'american-comic'?",
        ),
        ("version = 1\nextends = \"./no/base.style.toml\"", "2:11: cannot read the style "),
        ("version = 1\npaint.ramp.image = \"no.png\"", "2:20: 'image' must be a picture, but "),
    ] {
        let error = error(text);
        let shown = error.to_string();
        assert!(shown.starts_with(expected), "expected: {expected}\n     got: {shown}");
        assert!(!shown.contains('\n'), "{shown}");
        assert_eq!(error.line_text(), text.lines().nth(error.line - 1).unwrap_or(""));
        assert!(text.get(error.span.clone()).is_some());
        assert_eq!(error.path, None);
    }
}

#[test]
fn errors_may_say_what_to_do() {
    for (text, expected) in [
        ("", Some("write 'version = 1' in the first line")),
        ("version = 2", Some("a newer Genga may know this version")),
        ("version = '1'", None),
        ("version = 1\nbackground = { colour = '#fff' }", Some("known here: 'color', 'bottom'")),
        ("version = 1\nlines.method = 'countour'", Some("did you mean \"contour\"?")),
        ("version = 1\n[override]\nselect = {}", Some("begin each with two brackets: '[[…]]'")),
        ("version = 1\n[[override]]\nselect.objects = {}", None),
    ] {
        assert_eq!(error(text).help.as_deref(), expected, "{text}");
    }
}

#[test]
fn globs_ignore_case_and_compile_whole_names() {
    let globs = Globs::new(["Head*", "Face_?", "[xy]", "É目?"]).expect("they are globs");
    for name in ["head", "HEAD.001", "Face_1", "face_é", "X", "é目玉"] {
        assert!(globs.matches(name), "{name}");
    }
    for name in ["", "Forehead", "face_", "face_12", "xy", "é目"] {
        assert!(!globs.matches(name), "{name}");
    }
    assert!(Globs::default().matches("") && Globs::default().matches("anything"));
    let star = Globs::new(["*"]).expect("it is a glob");
    assert!(star.matches("") && star.matches("a/b\\c..") && star.matches(".."));
    assert!(Globs::new(["[a"]).is_err() && Globs::new(["a".repeat(300)]).is_err());
}

#[test]
fn colours_go_through_text() {
    for text in ["#000000", "#ff8800", "#12345678", "#ffffff00"] {
        assert_eq!(text.parse::<Color>().map(|c| c.to_string()).as_deref(), Ok(text));
    }
    let short: Color = "#f80".parse().expect("it is a colour");
    assert_eq!(Ok(short), "#FF8800".parse());
    assert_eq!("#f808".parse::<Color>().map(|c| c.to_string()).as_deref(), Ok("#ff880088"));
    for text in ["", "#", "fff", "#ff", "#fffff", "#fffffff", "#ggg", "#fffffffff", "#é00", "#-12"]
    {
        assert_eq!(text.parse::<Color>(), Err(ColorError), "{text}");
    }
}

#[test]
fn the_committed_schema_is_fresh() {
    crate::toml_file::assert_schema_is_fresh("style.schema.json", &json_schema());
}

#[test]
fn hue_ranges_may_go_over_red() {
    let reds = BaseColorRange { hue: [350.0, 20.0], ..BaseColorRange::default() };
    let range = BaseColorRange { hue: [100.0, 250.0], ..BaseColorRange::default() };
    for (color, is_red, is_in_range) in [
        ("#ff0000", true, false),
        ("#ff0010", true, false),
        ("#ff1000", true, false),
        ("#ffff00", false, false),
        ("#00ff00", false, true),
        ("#0000ff", false, true),
        ("#ff00ff", false, false),
        ("#808080", true, false),
        ("#000000", true, false),
    ] {
        let color: Color = color.parse().expect("it is a colour");
        assert_eq!((reds.contains(color), range.contains(color)), (is_red, is_in_range), "{color}");
    }
}

#[test]
fn hatching_begins_with_its_preset() {
    let text = "version = 1\n[paint.hatch]\npreset = \"cloth\"\nspacing = 4.5\n\
                [[override]]\npaint.hatch = { preset = \"metal\" }";
    let style = Style::from_toml_str(text).expect("it is valid");
    let cloth = Hatch::preset(HatchPreset::Cloth);
    assert_eq!(style.paint.hatch, Hatch { spacing: 4.5, ..cloth });
    assert_eq!(style.overrides[0].paint.hatch, Some(Hatch::preset(HatchPreset::Metal)));
    assert_eq!(Style::default().paint.hatch.pattern, HatchPattern::None);
}
