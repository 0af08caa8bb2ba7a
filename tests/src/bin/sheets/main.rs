//! The gallery's sheets that compare lines, after figures of Okuya et al. 2015:
//! `cargo xtask gallery`.
//!
//! Takes the folder to write them into.

mod panels;
mod sheet;

use std::path::Path;
use std::process::ExitCode;

use genga::render::{Orbit, View};
use genga::scene::Scene;
use genga_tests::scenes::{model, orbit_view};
use image::RgbImage;

use panels::{depths, drawing, enlarged, lines_only, normals, painted};
use sheet::{save, sheet};

/// File name and what draws it.
type Sheet = (&'static str, fn() -> RgbImage);

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1) else {
        eprintln!("name the folder to write the sheets into");
        return ExitCode::FAILURE;
    };
    let folder = Path::new(&folder);
    let sheets: [Sheet; 4] = [
        ("lines-by-resolution.png", by_resolution),
        ("lines-by-buffer.png", by_buffer),
        ("lines-by-method.png", by_method),
        ("lines-by-detection-scale.png", by_detection_scale),
    ];
    for (name, make) in sheets {
        let path = folder.join(name);
        match save(&make(), &path) {
            Ok(bytes) => println!("{} ({} KiB)", path.display(), bytes.div_ceil(1024)),
            Err(error) => {
                eprintln!("cannot write {}: {error}", path.display());
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}

/// The model's own camera, which shows it as it is meant.
fn view_of(scene: &Scene, size: [u32; 2]) -> View {
    let pose = genga::scene::Pose::rest(scene);
    let camera = (0..scene.nodes.len())
        .find_map(|node| genga::render::ViewCamera::from_node(scene, &pose, node));
    match camera {
        Some(camera) => View::new(camera, size),
        None => orbit_view(scene, &Orbit::default(), size),
    }
}

/// Figure 1: lines of the detected mask are as wide as its pixels; contours keep their width.
/// Above `image`, below `contour`; drawn 90, 180 and 360 pixels high.
fn by_resolution() -> RgbImage {
    let scene = model("teapot-on-box");
    let mut panels = Vec::new();
    for method in ["image", "contour"] {
        for height in [90, 180, 360] {
            let view = View { supersample: 1, ..view_of(&scene, [height * 10 / 9, height]) };
            let style = format!(
                "method = \"{method}\"\nreference_height = 360\n[[lines.sets]]\nwidth = 3.5"
            );
            panels.push(enlarged(&lines_only(&scene, &style, &view), 360 / height));
        }
    }
    sheet(&panels, 3)
}

/// Figures 4 and 5: what each buffer detects. Depth, normals and objects above; the lines that
/// each finds below them, and all lines in the last column, drawn by `image` and by `contour`.
fn by_buffer() -> RgbImage {
    let scene = model("cube-before-plane");
    let view = view_of(&scene, [320, 280]);
    let nothing = "depth = 0\nlaplacian = 0\ncrease_deg = 0\nobjects = false\nmaterials = false\n\
                   user = false\nborders = false\n";
    let detected = |method: &str, sources: &str| {
        let quiet = nothing.lines().filter(|line| {
            let key = line.split(' ').next().unwrap_or_default();
            !sources.lines().any(|source| source.starts_with(key))
        });
        let quiet = quiet.collect::<Vec<_>>().join("\n");
        let style = format!(
            "method = \"{method}\"\nreference_height = 280\n[lines.detect]\n{quiet}\n{sources}\n\
             [[lines.sets]]\nwidth = 2.5"
        );
        lines_only(&scene, &style, &view)
    };
    let all = "laplacian = 4\ncrease_deg = 40\nobjects = true\nmaterials = true\nborders = true";
    sheet(
        &[
            depths(&scene, &view),
            normals(&scene, &view),
            painted(&scene, &view),
            detected("image", all),
            detected("image", "laplacian = 4"),
            detected("image", "crease_deg = 40"),
            detected("image", "objects = true"),
            detected("contour", all),
        ],
        4,
    )
}

/// Figure 11: all methods side by side. Above `image`, `hull` and `rim`; below `reference`,
/// `contour`, and `contour` with lines that get thinner with distance.
fn by_method() -> RgbImage {
    let scene = model("teapot-on-box");
    let view = view_of(&scene, [440, 400]);
    let head = "reference_height = 400\n";
    let curves = "width_by.depth = [[1.9, 1.7], [2.9, 0.4]]";
    let panel = |method: &str, set: &str| {
        drawing(
            &scene,
            &format!("method = \"{method}\"\n{head}[[lines.sets]]\nwidth = 3\n{set}"),
            &view,
        )
    };
    sheet(
        &[
            panel("image", ""),
            panel("hull", ""),
            panel("rim", ""),
            panel("reference", ""),
            panel("contour", ""),
            panel("contour", curves),
        ],
        3,
    )
}

/// Figures 15 and 16: detection at 1, 2/3, 1/3 and 1/6 of the drawn size, whole and enlarged.
/// Above by `reference`, below by `contour`.
fn by_detection_scale() -> RgbImage {
    let scene = model("teapot-on-box");
    let size = [720, 600];
    let view = View { supersample: 1, ..view_of(&scene, size) };
    let mut panels = Vec::new();
    for method in ["reference", "contour"] {
        let whole: Vec<RgbImage> = ["1", "2/3", "1/3", "1/6"]
            .iter()
            .map(|scale| {
                let style = format!(
                    "method = \"{method}\"\nreference_height = 600\n\
                     [lines.detect]\nscale = \"{scale}\"\n[[lines.sets]]\nwidth = 4"
                );
                lines_only(&scene, &style, &view)
            })
            .collect();
        for picture in &whole {
            panels.push(image::imageops::resize(
                picture,
                size[0] / 3,
                size[1] / 3,
                image::imageops::FilterType::Triangle,
            ));
        }
        for picture in &whole {
            let crop = image::imageops::crop_imm(picture, 462, 222, 80, 67).to_image();
            let crop = enlarged(&crop, 3);
            panels
                .push(image::imageops::crop_imm(&crop, 0, 0, size[0] / 3, size[1] / 3).to_image());
        }
    }
    sheet(&panels, 4)
}
