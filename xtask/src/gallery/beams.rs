//! Sheets and showpieces of beams and of motion: `assets/scenes/beams` (Suzuki 2004, figures 4.1, 4.2,
//! 5.1 and 5.2).

use std::path::Path;
use std::process::Command;

use super::sheet::{self, Cell, Sheet, changed, read};
use crate::{Result, process};

/// Draws them into the folder.
pub(super) fn draw(root: &Path, genga: &Path, folder: &Path) -> Result<()> {
    let scenes = root.join("assets/scenes/beams");
    // Showpieces have their own sizes; the other scenes are made into sheets.
    let mut shown = super::scenes(&scenes)?;
    shown.retain(|file| super::name_of(file).starts_with("beams-"));
    let mut render = Command::new(genga);
    render.args(["render", "--output"]).arg(folder.join("{model}.png"));
    process::run(render.args(&shown))?;
    let of = |name: &str| read(&scenes, &format!("{name}.scene.toml"));
    let sheets = [
        ramps(&of("curve")?)?,
        orders(&of("orders")?)?,
        steps(&of("orders")?)?,
        light(&of("light")?)?,
        motion(&of("punch")?),
        final_pictures(&of("final")?),
    ];
    sheet::draw(genga, &sheets, &scenes, folder)
}

fn cell(scene: String) -> Cell {
    Cell { scene, style: None, options: Vec::new() }
}

/// One colour; a light core; a dark one; three tones that run into nothing.
fn ramps(curve: &str) -> Result<Sheet> {
    let own = "ramp = [{ at = 0, color = \"#f2552c\" }]";
    let all = [
        own.to_owned(),
        "ramp = [{ at = 0, color = \"#f2552c\" }, { at = 0.45, color = \"#ffd24a\" }, \
         { at = 0.75, color = \"#fffbe6\" }]"
            .to_owned(),
        "ramp = [{ at = 0, color = \"#fff3b0\" }, { at = 0.45, color = \"#ffb43a\" }, \
         { at = 0.75, color = \"#c8261c\" }]"
            .to_owned(),
        "smooth = true\nramp = [{ at = 0, color = \"#3fa7ff00\" }, { at = 0.6, color = \"#3fa7ffc0\" }, \
         { at = 1, color = \"#ffffff\" }]"
            .to_owned(),
    ];
    let cells: Result<_> = all.iter().map(|ramp| Ok(cell(changed(curve, own, ramp)?))).collect();
    Ok(Sheet { name: "beams-ramps", cell: [280, 220], columns: 4, cells: cells? })
}

/// The four ways that objects and lines meet a beam.
fn orders(scene: &str) -> Result<Sheet> {
    let ways = ["under", "lines-through", "over", "hide"];
    let own = "order = \"over\"";
    let cells: Result<_> = ways
        .map(|way| Ok(cell(changed(scene, own, &format!("order = \"{way}\""))?)))
        .into_iter()
        .collect();
    Ok(Sheet { name: "beams-orders", cell: [280, 330], columns: 4, cells: cells? })
}

/// After figure 4.2: the object alone, the beam alone, the beam over the object, the object's lines, and
/// those multiplied on the beam.
fn steps(scene: &str) -> Result<Sheet> {
    let (head, rest) = scene.split_once("[[beam]]").unwrap_or((scene, ""));
    let (_, camera) = rest.split_once("[camera]").unwrap_or(("", rest));
    let object = format!("{head}[camera]{camera}");
    let all_hidden = changed(scene, "hide = [\"sun\", \"shield\"]", "hide = [\"*\"]")?;
    let before = changed(scene, "order = \"over\"", "order = \"over\"\noccluded = false")?;
    let through = changed(&before, "order = \"over\"", "order = \"lines-through\"")?;
    let lines = "version = 1\nextends = \"american-comic\"\n[paint]\nbase = \"none\"\n";
    let cells = vec![
        cell(object.clone()),
        cell(all_hidden),
        cell(before),
        Cell { scene: object, style: Some(lines.to_owned()), options: Vec::new() },
        cell(through),
    ];
    Ok(Sheet { name: "beams-steps", cell: [240, 280], columns: 5, cells })
}

/// A beam without its light, with it, and with its shadows, too; a shield that is marked as a beam.
fn light(scene: &str) -> Result<Sheet> {
    let light = "light = { intensity = 2.5, range = 1.6 }\n";
    let marked = "[[beam]]\nshape = \"surface\"\nmodel = \"hero\"\nobjects = [\"shield\"]\n\
         ramp = [{ at = 0, color = \"#2a5bd7\" }, { at = 0.5, color = \"#5cc8f5\" }, \
         { at = 0.9, color = \"#f4fdff\" }]\n";
    let beam = scene.split("[[beam]]").nth(1).and_then(|rest| rest.split("[camera]").next());
    let shown = changed(scene, "\"sun\", \"shield\"", "\"sun\"")?;
    let shield = changed(&shown, &format!("[[beam]]{}", beam.unwrap_or("\0")), marked)?;
    let with_shadows = Cell {
        scene: changed(scene, "range = 1.6", "range = 1.6, casts_shadow = true")?,
        style: Some(
            "version = 1\nextends = \"night.style.toml\"\npaint.shadow = { enabled = true }\n"
                .to_owned(),
        ),
        options: Vec::new(),
    };
    let cells =
        vec![cell(changed(scene, light, "")?), cell(scene.to_owned()), with_shadows, cell(shield)];
    Ok(Sheet { name: "beams-light", cell: [270, 342], columns: 4, cells })
}

/// Frames of a punch without motion, with speed lines, and with smears, too.
fn motion(punch: &str) -> Sheet {
    let base = "version = 1\nextends = \"american-comic\"\n";
    let lines = format!(
        "{base}[motion]\nshutter = {{ angle_deg = 900, fps = 24 }}\n[motion.speed_lines]\n\
         threshold = 1.5\ndensity = 180\nwidth = 1.2\nmaterials = [\"suit\", \"boots\"]\n"
    );
    let smear = format!(
        "{lines}[motion.smear]\nthreshold = 2\namount = 0.3\nobjects = [\"body\", \"hair\"]\n"
    );
    let cells = [base, &lines, &smear].into_iter().flat_map(|style| {
        [7, 9, 10, 11].map(|frame| Cell {
            scene: punch.to_owned(),
            style: Some(style.to_owned()),
            options: vec!["--frame".to_owned(), frame.to_string()],
        })
    });
    Sheet { name: "speed-lines", cell: [260, 235], columns: 4, cells: cells.collect() }
}

/// Strokes and blacks alone; other marks for some materials; pencil; flat colours; gradients.
fn final_pictures(scene: &str) -> Sheet {
    let ink = "[paint]\nbase = \"paper\"\n[paint.ramp]\nstops = [{ at = 0, color = \"#fff\" }]\n";
    let marks = "[[override]]\nselect = { materials = [\"mask\", \"metal\"] }\n\
         paint.hatch = { pattern = \"solid\" }\n[[override]]\nselect = { materials = [\"suit\"] }\n\
         paint.hatch = { pattern = \"stipple\", spacing = 7 }\n";
    let style = |preset: &str, more: &str| {
        let paper = "[background]\ncolor = \"#ffffff\"\nbottom = \"#ffffff\"\n";
        format!("version = 1\nextends = \"{preset}\"\n{paper}{more}")
    };
    let styles = [
        style("american-comic", ink),
        style("american-comic", &format!("{ink}{marks}")),
        style("pencil", ""),
        style("american-comic", ""),
        style("american-comic-modern", ""),
    ];
    let cells = styles.map(|style| Cell {
        scene: scene.to_owned(),
        style: Some(style),
        options: Vec::new(),
    });
    Sheet { name: "comic-final", cell: [220, 270], columns: 5, cells: cells.into() }
}
