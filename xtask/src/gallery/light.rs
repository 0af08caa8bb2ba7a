//! Sheets of light: kinds of lights with their shadows, ramps, comic highlights, ways of printing, and
//! clean faces (Suzuki 2004, figures 3.3–3.4 and 4.5–4.8).

use std::path::Path;

use super::face;
use super::sheet::{self, Cell, Sheet, changed, read};
use crate::Result;

/// A style without the preset that it extends.
const COMIC: &str = "version = 1\nextends = \"american-comic\"\n[paint.shadow]\nenabled = true\n";

/// Draws all sheets into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let scenes = root.join("assets/scenes/light");
    let stage = read(&scenes, "stage.scene.toml")?;
    let [head, teapot] = [read(&scenes, "head.scene.toml")?, read(&scenes, "teapot.scene.toml")?];
    let all = [
        lights(&stage),
        colors(&stage),
        ramps(&stage)?,
        shines(&teapot),
        shine_steps(&teapot),
        prints(&teapot),
        faces(&head)?,
        face::sheet(&scenes)?,
    ];
    sheet::draw(genga, &all, &scenes, folder)
}

/// A cell in a style of its own.
fn cell(scene: String, style: &str) -> Cell {
    Cell { scene, style: Some(style.to_owned()), options: Vec::new() }
}

/// The stage with other lights than its own.
fn lights(stage: &str) -> Sheet {
    let bare = stage.split("[[light]]").next().unwrap_or(stage);
    let kinds = [
        "[[light]]\ntype = \"directional\"\nazimuth_deg = -50\nelevation_deg = 38\n",
        "[[light]]\ntype = \"point\"\nposition = [-1.6, 1.7, 1.9]\n",
        "[[light]]\ntype = \"spot\"\nposition = [-3, 3.2, 3.2]\ndirection = [3.2, -2.4, -3.6]\n\
         inner_angle_deg = 15\nouter_angle_deg = 16\n",
        "[[light]]\ntype = \"directional\"\nazimuth_deg = 30\nelevation_deg = 30\n\
         [[light]]\ntype = \"sky\"\nintensity = 0.7\n",
        "[[light]]\ntype = \"directional\"\nazimuth_deg = -60\nelevation_deg = 35\n\
         [[light]]\ntype = \"directional\"\nazimuth_deg = 10\nelevation_deg = 20\nintensity = 0.8\n",
        "[[light]]\ntype = \"point\"\nnode = \"leftLowerArm\"\nposition = [0.0, 0.2, 0.7]\n",
    ];
    let cells = kinds.iter().map(|kind| cell(format!("{bare}{kind}"), COMIC));
    Sheet { name: "light-lights", cell: [360, 300], columns: 3, cells: cells.collect() }
}

/// Two coloured lights in flat tones, with shadows and in a gradient; a sun and a red lamp with its colour
/// and without.
fn colors(stage: &str) -> Sheet {
    let bare = stage.split("[[light]]").next().unwrap_or(stage);
    let two = "[[light]]\ntype = \"directional\"\nazimuth_deg = -60\nelevation_deg = 30\n\
               color = \"#ff5030\"\n[[light]]\ntype = \"directional\"\nazimuth_deg = 60\n\
               elevation_deg = 25\ncolor = \"#4f7dff\"\n";
    let lamp = "[[light]]\ntype = \"directional\"\nazimuth_deg = -50\nelevation_deg = 38\n\
                [[light]]\ntype = \"point\"\nposition = [1.5, 0.7, 0.7]\n\
                color = \"#ff3a20\"\nintensity = 0.9\n";
    let modern =
        "version = 1\nextends = \"american-comic-modern\"\n[paint.shadow]\nenabled = true\n";
    let cells = [
        (two, COMIC.to_owned()),
        (two, modern.to_owned()),
        (lamp, COMIC.to_owned()),
        (lamp, format!("{COMIC}[paint]\nlight_color = 0\n")),
    ];
    let cells = cells.iter().map(|(lights, style)| cell(format!("{bare}{lights}"), style));
    Sheet { name: "light-colors", cell: [400, 333], columns: 2, cells: cells.collect() }
}

/// Two and three tones, five tones, a gradient, soft edges, shade in a colour of its own.
fn ramps(stage: &str) -> Result<Sheet> {
    let stop = |at: &str, color: &str| format!("{{ at = {at}, color = \"{color}\" }}");
    let hard = |stops: &[(&str, &str)], rest: &str| {
        let stops: Vec<String> = stops.iter().map(|(at, color)| stop(at, color)).collect();
        format!("{COMIC}[paint.ramp]\n{rest}stops = [{}]\n", stops.join(", "))
    };
    let all = [
        hard(&[("0.0", "#857ca6"), ("0.55", "#fff")], ""),
        hard(&[("0.0", "#4a4470"), ("0.35", "#9a92b8"), ("0.58", "#fff")], ""),
        hard(
            &[
                ("0.0", "#2c2a4c"),
                ("0.25", "#5b5684"),
                ("0.45", "#8d87b0"),
                ("0.6", "#c6c0d8"),
                ("0.8", "#fff"),
            ],
            "",
        ),
        hard(&[("0.0", "#3a3560"), ("0.45", "#9088b4"), ("0.9", "#fff")], "smooth = true\n"),
        format!(
            "{COMIC}[paint.ramp]\nstops = [{{ at = 0.0, color = \"#857ca6\" }}, \
             {{ at = 0.55, color = \"#fff\", softness = 0.12 }}]\n"
        ),
        format!(
            "{COMIC}[paint.ramp]\nstops = [{{ at = 0.0, color = \"#1c2350\", blend = \"replace\" }}, \
             {{ at = 0.55, color = \"#fff\" }}]\n"
        ),
    ];
    let near = changed(stage, "fov_deg = 28", "fov_deg = 17")?;
    let cells = all.iter().map(|style| cell(near.clone(), style));
    Ok(Sheet { name: "light-ramps", cell: [300, 300], columns: 3, cells: cells.collect() })
}

/// Highlights by Blinn and Phong, their gradient, split and squared ones, bare paper, a rim from behind,
/// straight streaks.
fn shines(teapot: &str) -> Sheet {
    let all = [
        "specular = { exponent = 60 }",
        "specular = { form = \"gradient\", exponent = 10, gradient = 3 }",
        "specular = { exponent = 60, split = [0.12, 0.08], square = 1, rotate_deg = 15 }",
        "specular = { exponent = 40, scale = [-0.6, 0.75], blend = \"paper\" }",
        "rim_light = { color = \"#ffe9a8\", azimuth_deg = 60, elevation_deg = 5, \
         threshold = 0.62, blend = \"replace\" }",
        "sheen = { spacing_m = 0.17, width = 0.2, strength = 0.75 }",
    ];
    let cells = all.iter().map(|rest| {
        let glaze =
            "[[override]]\nselect = { materials = [\"glaze\", \"lid\", \"spout\", \"handle\"] }";
        let style = format!("{COMIC}{glaze}\npaint.{rest}\n");
        cell(teapot.to_owned(), &style)
    });
    let cells = cells.collect();
    Sheet { name: "light-highlights", cell: [360, 300], columns: 3, cells }
}

/// After figures 4.5 to 4.8: exponents of 200, 100 and 50; highlights alone and where they belong.
fn shine_steps(teapot: &str) -> Sheet {
    let glaze =
        "[[override]]\nselect = { materials = [\"glaze\", \"lid\", \"spout\", \"handle\"] }";
    let alone = "version = 1\n[background]\ncolor = \"#000000\"\n[lines]\nmethod = \"none\"\n\
                 [paint]\nbase = \"#000000\"\n";
    let specular = |exponent: u32| format!("specular = {{ exponent = {exponent} }}");
    let two_tones = specular(60);
    let gradient = "specular = { form = \"gradient\", exponent = 10, gradient = 3 }";
    let rim = "rim_light = { color = \"#ffffff\", azimuth_deg = 60, elevation_deg = 5, \
               threshold = 0.62 }";
    let mut cells = vec![cell(teapot.to_owned(), COMIC)];
    let add = |style: &str, rest: &str| {
        cell(teapot.to_owned(), &format!("{style}{glaze}\npaint.{rest}\n"))
    };
    cells.extend([200, 100, 50].map(|exponent| add(COMIC, &specular(exponent))));
    for rest in [&two_tones, gradient, rim] {
        cells.push(add(alone, rest));
        cells.push(add(COMIC, rest));
    }
    Sheet { name: "light-highlight-steps", cell: [220, 190], columns: 5, cells }
}

/// Flat colours, a palette of nine, the dots of the old print, bare paper.
fn prints(teapot: &str) -> Sheet {
    let all = [
        "",
        "[paint]\npalette = [\"#101018\", \"#fff6e0\", \"#c8342b\", \"#23479a\", \"#3a86c0\", \"#f0b73a\", \
         \"#e2a878\", \"#3f8f5a\", \"#6c5a86\"]\n",
        "[paint]\ndots = { spacing = 11 }\n",
        "[paint]\nbase = \"paper\"\n",
    ];
    let cells = all.iter().map(|rest| cell(teapot.to_owned(), &format!("{COMIC}{rest}")));
    let cells = cells.collect();
    Sheet { name: "light-print", cell: [420, 340], columns: 2, cells }
}

/// A face by its own normals and by an ellipsoid's, and without the hair's shadow; the light goes round.
fn faces(head: &str) -> Result<Sheet> {
    let own = head.split("[[shading]]").next().unwrap_or(head).to_owned();
    let clean = "[[override]]\nselect = { materials = [\"skin\", \"eye*\"] }\n\
                 paint.shadow = { receive = false }\n";
    let rows = [(own, ""), (head.to_owned(), ""), (head.to_owned(), clean)];
    let mut cells = Vec::new();
    for (scene, rest) in &rows {
        for azimuth in ["-75", "-40", "0", "50"] {
            let light = format!("azimuth_deg = {azimuth}");
            let scene = changed(scene, "azimuth_deg = -60", &light)?;
            let style =
                format!("version = 1\nextends = \"anime\"\n[paint.shadow]\nenabled = true\n{rest}");
            cells.push(cell(scene, &style));
        }
    }
    Ok(Sheet { name: "light-faces", cell: [280, 280], columns: 4, cells })
}
