//! A keyed face shadow for `assets/models/head.glb`, and its sheet: light goes round a face.

use std::path::Path;

use super::sheet::{Cell, Sheet, changed, read};
use crate::{Error, Result};

const SIDE: u32 = 256;

/// Writes the picture into the folder of its scene, and gives the sheet of it.
pub(super) fn sheet(scenes: &Path) -> Result<Sheet> {
    let file = scenes.join("face-shadow.png");
    let wrong = |e: image::ImageError| Error::new(format!("{}: {e}", file.display()));
    picture().save(&file).map_err(wrong)?;
    let keyed = read(scenes, "face.scene.toml")?;
    let shading = keyed.split("[[shading]]").nth(1).and_then(|rest| rest.split("[camera]").next());
    let own = changed(&keyed, &format!("[[shading]]{}", shading.unwrap_or("\0")), "")?;
    let style = "version = 1\nextends = \"anime\"\n[paint.shadow]\nenabled = true\n\
                 [[override]]\nselect = { materials = [\"skin\", \"eye*\"] }\n\
                 paint.shadow = { receive = false }\n";
    let mut cells = Vec::new();
    for scene in [&own, &keyed] {
        for azimuth in [-95, -75, -60, -30, 0, 60] {
            let light = format!("azimuth_deg = {azimuth}");
            let scene = changed(scene, "azimuth_deg = -75", &light)?;
            cells.push(Cell { scene, style: Some(style.to_owned()), options: Vec::new() });
        }
    }
    Ok(Sheet { name: "light-face-shadow", cell: [220, 240], columns: 6, cells })
}

fn picture() -> image::GrayImage {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
    image::GrayImage::from_fn(SIDE, SIDE, |x, y| {
        image::Luma([(255.0 * lit_up_to(at(x), at(y))).round() as u8])
    })
}

/// Up to which angle of light from the right a place of the face is lit, in half turns. The head's
/// texture coordinates go round it, with the face at u = 0.5, and down, 2.5 to the metre.
fn lit_up_to(u: f64, v: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    let (turn, y) = ((u - 0.5) * TAU, 0.40 - v / 2.5);
    let spot = |dx: f64, wx: f64, dy: f64, wy: f64| {
        libm::exp(-((turn - dx) / wx).powi(2) - ((y - dy) / wy).powi(2))
    };
    // A round face, which turns away faster towards the chin.
    let low = ((0.205 - y) / 0.06).clamp(0.0, 1.0);
    let mut angle = PI / 2.0 + turn * (1.0 + 0.7 * low);
    // The triangle of light on the far cheek, under the eye.
    let inside = ((0.204 - y) / 0.02).min((0.26 * (y - 0.164) / 0.04 - (turn + 0.40).abs()) / 0.2);
    angle += inside.clamp(0.0, 1.0);
    // Beside the nose, in the corner of the far eye, and on the ridge of the nose.
    angle -= 0.40 * spot(-0.085, 0.06, 0.186, 0.009);
    angle -= 0.22 * spot(-0.17, 0.10, 0.238, 0.018);
    angle += 0.25 * spot(0.02, 0.05, 0.205, 0.03);
    // The neck lies in the chin's shadow.
    let neck = ((0.139 - y) / 0.006).clamp(0.0, 1.0);
    angle += neck * (0.75 + 1.1 * turn - angle);
    (angle / PI).clamp(0.02, 0.98)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_of_the_light_stays_lit_longest() {
        let (far, middle, near) =
            (lit_up_to(0.4, 0.35), lit_up_to(0.5, 0.35), lit_up_to(0.6, 0.35));
        assert!(far < middle && middle < near);
        assert!((middle - 0.5).abs() < 0.05, "from beside, light ends in the middle: {middle}");
    }
}
