//! Small pictures in git that are drawn again and compared.
//!
//! A case is a folder `tests/suite/<area>/<case>` with `case.scene.toml` (whose style may lie
//! beside it) and `expected.png`. Where the picture differs, `expected.png`, `actual.png` and
//! `difference.png` are written to `out/snapshots/<area>/<case>`, and `cargo xtask snapshots`
//! reviews them.

use std::fs;
use std::path::{Path, PathBuf};

use genga::render::{Orbit, Picture, View, ViewCamera};
use genga::scene_file::{SceneCamera, SceneFile};

use crate::compare::{Tolerance, byte_difference};
use crate::scenes::root;

/// All cases as `<area>/<case>`, in order.
///
/// # Panics
/// If the folder cannot be listed.
#[must_use]
pub fn cases() -> Vec<String> {
    let suite = root().join("tests/suite");
    let mut cases = Vec::new();
    for area in folders(&suite) {
        for case in folders(&suite.join(&area)) {
            cases.push(format!("{area}/{case}"));
        }
    }
    cases.sort();
    cases
}

fn folders(path: &Path) -> Vec<String> {
    let entries = fs::read_dir(path).expect("the snapshots' folder can be listed");
    entries
        .map(|entry| entry.expect("the snapshots' folder can be listed"))
        .filter(|entry| entry.path().is_dir())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect()
}

/// Draws a case and compares it.
///
/// # Errors
/// A sentence that says what differs and where to look.
///
/// # Panics
/// If the case cannot be read or drawn.
pub fn check(case: &str) -> Result<(), String> {
    let folder = root().join("tests/suite").join(case);
    let actual = draw(&folder.join("case.scene.toml"));
    let results = root().join("out/snapshots").join(case);
    let expected = image::open(folder.join("expected.png")).ok().map(|p| p.into_rgba8());
    let Some(expected) = expected else {
        write(&results, &[("actual.png", &actual.rgba)], &actual);
        return Err(format!("{case} has no readable expected.png; {}", look_at(&results)));
    };
    if expected.dimensions() != (actual.width, actual.height) {
        write(&results, &[("actual.png", &actual.rgba)], &actual);
        return Err(format!(
            "{case} is {}×{} pixels, expected are {:?}; {}",
            actual.width,
            actual.height,
            expected.dimensions(),
            look_at(&results)
        ));
    }
    let found =
        byte_difference(actual.width, expected.as_raw(), &actual.rgba, Tolerance::snapshot());
    if !found.is_too_much {
        // What an earlier run left there is out of date.
        fs::remove_dir_all(&results).ok();
        return Ok(());
    }
    let differing: Vec<u8> = expected
        .as_raw()
        .as_chunks::<4>()
        .0
        .iter()
        .zip(actual.rgba.as_chunks::<4>().0)
        .flat_map(|(a, b)| {
            // Four times as strong, opaque, so that it can be seen.
            let [r, g, b, a] = [0, 1, 2, 3].map(|c| a[c].abs_diff(b[c]).saturating_mul(4));
            [r.max(a), g.max(a), b.max(a), 255]
        })
        .collect();
    let pictures = [
        ("expected.png", expected.as_raw()),
        ("actual.png", &actual.rgba),
        ("difference.png", &differing),
    ];
    write(&results, &pictures, &actual);
    Err(format!(
        "{case} differs in {} pixels, by up to {} at {:?}; {}",
        found.outliers,
        found.worst,
        found.at,
        look_at(&results)
    ))
}

fn look_at(results: &Path) -> String {
    format!("look at {} and run `cargo xtask snapshots`", results.display())
}

fn write(folder: &PathBuf, pictures: &[(&str, &Vec<u8>)], size: &Picture) {
    fs::create_dir_all(folder).expect("out/snapshots can be written");
    for (name, rgba) in pictures {
        let (width, height) = (size.width, size.height);
        image::save_buffer(folder.join(name), rgba, width, height, image::ColorType::Rgba8)
            .expect("out/snapshots can be written");
    }
}

/// Draws a scene file as it says.
fn draw(path: &Path) -> Picture {
    let file = SceneFile::load(path).unwrap_or_else(|e| panic!("{e}"));
    let style = file.load_style().unwrap_or_else(|e| panic!("{e}"));
    let load = |path: &Path| genga::import::load(path).map(|imported| imported.scene);
    let assembled = file.assemble(load).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(assembled.warnings, Vec::<String>::new(), "{}", path.display());
    let (scene, pose) = (&assembled.scene, &assembled.pose);
    let size = file.picture.size.expect("a snapshot says its size");
    let Some(SceneCamera::Orbit(orbit)) = assembled.camera else {
        panic!("{}: a snapshot has a camera on an orbit", path.display());
    };
    let orbit = Orbit {
        azimuth_deg: orbit.azimuth_deg,
        elevation_deg: orbit.elevation_deg,
        zoom: orbit.zoom,
        fov_deg: orbit.fov_deg,
        orthographic: orbit.orthographic,
    };
    let bounds = scene.bounds(pose).expect("a snapshot shows something");
    let camera = ViewCamera::orbit(&bounds, &orbit, size[0] as f32 / size[1] as f32);
    let view = View {
        supersample: file.picture.supersample.unwrap_or(2),
        background: file.picture.background.unwrap_or(true),
        ..View::new(camera, size)
    };
    crate::draw_posed(scene, pose, &style.unwrap_or_default(), &view, &[])
}
