//! Lines measured with a ruler: how wide, what colour, whose.

use genga::render::{LayerKind, Picture, View};
use genga::scene::{Primitive, Scene, Transform};
use genga::shapes;
use genga::style::Style;
use genga_tests::scenes::{Builder, moved, ortho_view, parts, perspective_view, style};
use genga_tests::{Pixels, draw, draw_layers};
use glam::{Quat, Vec2, Vec3};

/// A wall whose left side runs through the middle of the picture, turned by `degrees` from
/// upright; its other sides are far out of view.
fn wall(degrees: f32) -> Scene {
    let mut scene = Builder::new();
    let turn = Quat::from_rotation_z(degrees.to_radians());
    let at = parts(turn * Vec3::new(10.0, 0.0, 0.0), turn, Vec3::ONE);
    scene.object("wall", shapes::plane(Vec2::splat(20.0)), None, at);
    scene.build()
}

/// Lines of that method and width in a picture of 128 pixels.
fn ruled(method: &str, width: f32, rest: &str) -> Style {
    style(&format!(
        "[lines]\nmethod = \"{method}\"\nreference_height = 128\n\
         [[lines.sets]]\nname = \"lines\"\nwidth = {width}\n{rest}"
    ))
}

/// Mean width of the ink across a line that is tilted by `degrees` from upright, over the rows in
/// the middle half of the picture, and the largest difference of a row from it.
fn measured(picture: &Picture, degrees: f32) -> (f64, f64) {
    let rows = picture.height / 4..3 * picture.height / 4;
    let widths: Vec<f64> = rows
        .map(|y| {
            let ink: f64 = (0..picture.width).map(|x| f64::from(picture.ink(x, y))).sum();
            ink / 255.0 * f64::from(degrees.to_radians().cos())
        })
        .collect();
    let mean = widths.iter().sum::<f64>() / widths.len() as f64;
    (mean, widths.iter().map(|w| (w - mean).abs()).fold(0.0, f64::max))
}

fn lines_of(scene: &Scene, style: &Style, view: &View) -> Picture {
    draw_layers(scene, style, view, &[LayerKind::Lines])
}

#[test]
fn lines_are_as_wide_as_the_style_says_at_every_size_and_angle() {
    for method in ["contour", "reference"] {
        for height in [64, 128, 256] {
            for width in [0.5, 1.0, 2.0, 4.0, 8.0] {
                for degrees in [0.0, 3.0, 17.0, 43.0] {
                    let view = View { supersample: 1, ..ortho_view([height, height], 2.0) };
                    let picture = lines_of(&wall(degrees), &ruled(method, width, ""), &view);
                    let (mean, spread) = measured(&picture, degrees);
                    let expected = f64::from(width) * f64::from(height) / 128.0;
                    let what = format!("{method}, {height} px high, {degrees}°");
                    assert!((mean - expected).abs() < 0.1, "{what}: {mean} px, not {expected}");
                    // Rows of a tilted line differ by how its pixels fall.
                    assert!(spread < 0.25, "{what}, {expected} px: rows differ by {spread}");
                }
            }
        }
    }
}

#[test]
fn perspective_changes_no_width() {
    let view = perspective_view([128, 128], 40.0, 3.0);
    for method in ["contour", "reference"] {
        let picture = lines_of(&wall(10.0), &ruled(method, 3.0, ""), &view);
        let (mean, _) = measured(&picture, 10.0);
        assert!((mean - 3.0).abs() < 0.1, "{method}: {mean} px");
    }
}

#[test]
fn an_edge_in_many_pieces_is_drawn_as_one() {
    // The same wall with its left side cut into 300 pieces, fractions of a pixel up to several.
    let whole = shapes::plane(Vec2::splat(1.2));
    let mut cut = Primitive::default();
    let steps = 300;
    let corner = |p: &mut Primitive, x: f32, y: f32| {
        p.positions.push(Vec3::new(x, y, 0.0));
        p.normals.push(Vec3::Z);
        p.positions.len() as u32 - 1
    };
    let right = corner(&mut cut, 0.6, -0.6);
    let top = corner(&mut cut, 0.6, 0.6);
    let mut below = corner(&mut cut, -0.6, -0.6);
    for i in 1..=steps {
        // Uneven pieces.
        let t = (i as f32 / steps as f32).powi(2);
        let above = corner(&mut cut, -0.6, -0.6 + 1.2 * t);
        cut.indices.extend([right, above, below]);
        below = above;
    }
    cut.indices.extend([right, top, below]);
    let turned = parts(Vec3::ZERO, Quat::from_rotation_z(0.2), Vec3::ONE);
    let view = ortho_view([128, 128], 2.0);
    for width in [1.0, 3.0, 6.0] {
        let [whole, cut] = [&whole, &cut].map(|primitive| {
            let mut scene = Builder::new();
            scene.object("wall", primitive.clone(), None, turned);
            lines_of(&scene.build(), &ruled("contour", width, ""), &view)
        });
        for (x, y) in whole.places() {
            let (a, b) = (whole.ink(x, y), cut.ink(x, y));
            assert!(a.abs_diff(b) <= 3, "width {width}, ({x}, {y}): {a} whole, {b} cut");
        }
    }
}

#[test]
fn later_sets_lie_on_top() {
    let red = "[[lines.sets]]\nname = \"red\"\ncolor = \"#ff0000\"\nwidth = 9\n";
    let blue = "[[lines.sets]]\nname = \"blue\"\ncolor = \"#0000ff\"\nwidth = 3\n";
    let head = "[lines]\nmethod = \"contour\"\nreference_height = 64\n";
    let view = ortho_view([64, 64], 2.0);
    let (red_pixel, blue_pixel) = ([255, 0, 0, 255], [0, 0, 255, 255]);
    let picture = draw(&wall(0.0), &style(&format!("{head}{red}{blue}")), &view);
    assert_eq!(
        [29, 31, 32, 34].map(|x| picture.at(x, 30)),
        [red_pixel, blue_pixel, blue_pixel, red_pixel]
    );
    let picture = draw(&wall(0.0), &style(&format!("{head}{blue}{red}")), &view);
    assert_eq!([29, 31, 32, 34].map(|x| picture.at(x, 30)), [red_pixel; 4]);
    // Half-opaque ink shows what lies below.
    let clear = "[[lines.sets]]\nname = \"clear\"\ncolor = \"#0000ff\"\nwidth = 3\nopacity = 0.5\n";
    let picture = draw(&wall(0.0), &style(&format!("{head}{red}{clear}")), &view);
    let [r, _, b, _] = picture.at(31, 30);
    assert!(r.abs_diff(128) <= 1 && b.abs_diff(128) <= 1, "{:?}", picture.at(31, 30));
}

/// A cube seen on an edge: its front edge runs down the middle.
fn cube_on_edge() -> Scene {
    let mut scene = Builder::new();
    let turn = parts(Vec3::ZERO, Quat::from_rotation_y(std::f32::consts::FRAC_PI_4), Vec3::ONE);
    scene.object("cube", shapes::cuboid(Vec3::ONE), None, turn);
    scene.build()
}

/// Whether there is ink at the middle edge and at the left outline of [`cube_on_edge`].
fn middle_and_outline(picture: &Picture) -> (bool, bool) {
    // Half the cube's diagonal is 0.7071 m of 2 m in 64 pixels.
    let is_inked = |x: u32| (x - 1..=x + 1).map(|x| picture.ink(x, 32)).max() > Some(100);
    (is_inked(32), is_inked(32 - 23))
}

#[test]
fn sets_take_the_types_that_they_name() {
    let view = ortho_view([64, 64], 2.0);
    for method in ["contour", "reference", "image"] {
        for (types, expected) in [
            ("\"silhouette\", \"crease\"", (true, true)),
            ("\"silhouette\"", (false, true)),
            ("\"crease\"", (true, false)),
            ("\"object\"", (false, true)),
            ("\"user\"", (false, false)),
        ] {
            let rest = format!("types = [{types}]");
            let picture = lines_of(&cube_on_edge(), &ruled(method, 6.0, &rest), &view);
            assert_eq!(middle_and_outline(&picture), expected, "{method}, {types}");
        }
    }
}

/// Two walls side by side that leave the middle column empty, of two materials.
fn two_walls() -> Scene {
    let mut scene = Builder::new();
    for (x, object, material) in [(-0.6, "wall.left", "brick"), (0.6, "Wall.right", "plaster")] {
        let material = scene.colored(material, [1.0; 3]);
        scene.object(object, shapes::plane(Vec2::splat(0.8)), Some(material), moved(x, 0.0, 0.0));
    }
    scene.build()
}

/// Sum of the ink on the left and on the right half.
fn halves(picture: &Picture) -> [u32; 2] {
    let mut sums = [0; 2];
    for (x, y) in picture.places() {
        sums[usize::from(2 * x >= picture.width)] += u32::from(picture.ink(x, y));
    }
    sums
}

#[test]
fn sets_take_the_objects_and_materials_that_they_name() {
    let view = ortho_view([128, 64], 1.2);
    for method in ["contour", "reference", "image"] {
        for (rest, [left, right]) in [
            ("", [true, true]),
            ("objects = [\"*.left\"]", [true, false]),
            ("objects = [\"wall.r*\"]", [false, true]),
            ("materials = [\"brick\"]", [true, false]),
            ("materials = [\"brick\"]\nobjects = [\"*right\"]", [false, false]),
        ] {
            let sums = halves(&lines_of(&two_walls(), &ruled(method, 4.0, rest), &view));
            if method == "image" && !rest.is_empty() {
                // A mask has no owner: the plain detected mask draws every object's lines.
                continue;
            }
            assert_eq!(sums.map(|sum| sum > 5000), [left, right], "{method}, {rest}: {sums:?}");
            assert!(left || sums[0] == 0, "{method}, {rest}: {sums:?}");
            assert!(right || sums[1] == 0, "{method}, {rest}: {sums:?}");
        }
    }
}

#[test]
fn overrides_hide_lines_and_change_their_width() {
    let view = ortho_view([128, 64], 1.2);
    for method in ["contour", "reference", "image", "hull", "rim"] {
        let rest = "[[override]]\nselect.objects = [\"wall.right\"]\nlines.visible = false";
        let picture =
            draw_layers(&two_walls(), &ruled(method, 4.0, rest), &view, &[LayerKind::Lines]);
        let right_of_the_middle = (64..128).flat_map(|x| (0..64).map(move |y| (x, y)));
        assert!(
            right_of_the_middle.clone().all(|(x, y)| picture.at(x, y) == [255; 4]),
            "{method}: hidden lines are drawn"
        );
    }
    for (method, factor) in [("contour", 2.0), ("contour", 0.5), ("contour", 1.0)] {
        let rest = format!("[[override]]\nselect.materials = [\"brick\"]\nlines.width = {factor}");
        let [left, right] = halves(&lines_of(&two_walls(), &ruled(method, 2.0, &rest), &view));
        let ratio = f64::from(left) / f64::from(right);
        // Corners make it a little more than proportional.
        assert!((ratio / factor - 1.0).abs() < 0.05, "{method}: {ratio}, not {factor}");
    }
}

#[test]
fn widths_of_vertices_taper_a_line() {
    // Half the width at the bottom of the picture, one and a half times at its top.
    let mut wall = shapes::plane(Vec2::new(20.0, 2.0));
    wall.line_widths = wall.positions.iter().map(|p| 1.0 + 0.5 * p.y).collect();
    let mut scene = Builder::new();
    scene.object("wall", wall.clone(), None, moved(10.0, 0.0, 0.0));
    let scene = scene.build();
    let view = ortho_view([128, 128], 2.0);
    // Strokes change their width in pieces of 16 pixels.
    for (method, allowed) in [("contour", 0.35), ("reference", 0.05)] {
        let picture = lines_of(&scene, &ruled(method, 4.0, ""), &view);
        for y in 8..120 {
            let ink: f64 = (0..100).map(|x| f64::from(picture.ink(x, y)) / 255.0).sum();
            let expected = 4.0 * (1.0 + 0.5 * (1.0 - (f64::from(y) + 0.5) / 64.0));
            assert!((ink - expected).abs() < allowed, "{method}, row {y}: {ink}, not {expected}");
        }
    }
    wall.line_widths = vec![0.0; wall.positions.len()];
    let mut scene = Builder::new();
    scene.object("wall", wall, None, moved(10.0, 0.0, 0.0));
    let scene = scene.build();
    for method in ["contour", "reference"] {
        assert_eq!(halves(&lines_of(&scene, &ruled(method, 4.0, ""), &view)), [0, 0], "{method}");
    }
}

/// Two squares that meet in the middle of the picture, of one material.
fn seam() -> Scene {
    let mut scene = Builder::new();
    for (x, name) in [(-2.0, "a"), (2.0, "b")] {
        scene.object(name, shapes::plane(Vec2::splat(4.0)), None, moved(x, 0.0, 0.0));
    }
    scene.build()
}

#[test]
fn user_lines_run_where_two_ids_meet() {
    let view = ortho_view([64, 64], 2.0);
    let quiet = "[lines.detect]\nobjects = false\nmaterials = false\n";
    let with_id = "[[override]]\nselect.objects = [\"b\"]\nlines.line_id = 7\n";
    for method in ["contour", "reference"] {
        let style = |rest: &str| {
            genga_tests::style(&format!(
                "[lines]\nmethod = \"{method}\"\nreference_height = 64\n{quiet}\
                 [[lines.sets]]\ntypes = [\"user\"]\nwidth = 4\n{rest}"
            ))
        };
        let picture = lines_of(&seam(), &style(""), &view);
        assert_eq!(halves(&picture), [0, 0], "{method}: a seam without ids");
        let picture =
            draw_layers(&seam(), &style(with_id), &view, &[LayerKind::Lines, LayerKind::Ids]);
        let (mean, spread) = measured(&picture, 0.0);
        assert!((mean - 4.0).abs() < 0.1 && spread < 0.1, "{method}: {mean} ± {spread}");
        assert_eq!([picture.ids(5, 5)[2], picture.ids(60, 5)[2]], [0, 7]);
    }
}

#[test]
fn seams_of_objects_and_materials_can_be_switched_off() {
    let view = ortho_view([64, 64], 2.0);
    for (objects, expected) in [(true, 4.0), (false, 0.0)] {
        let detect = format!("[lines.detect]\nobjects = {objects}\n");
        let style = ruled("contour", 4.0, "");
        let mut switched = style.clone();
        switched.lines.detect.objects = objects;
        let picture = lines_of(&seam(), &switched, &view);
        // 128 is the reference height, the picture is half as high.
        let (mean, _) = measured(&picture, 0.0);
        assert!((mean - expected / 2.0).abs() < 0.1, "{detect}: {mean}");
    }
    let mut scene = Builder::new();
    let [red, green] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|rgb| scene.colored("m", rgb));
    let squares = [(-2.0, red), (2.0, green)].map(|(x, material)| {
        let mut square = shapes::plane(Vec2::splat(4.0));
        square.positions.iter_mut().for_each(|p| p.x += x);
        square.material = Some(material);
        square
    });
    scene.object("both", squares[0].clone(), None, Transform::default());
    scene.raw().meshes[0].primitives.push(squares[1].clone());
    let scene = scene.build();
    for (materials, expected) in [(true, 2.0), (false, 0.0)] {
        let mut style = ruled("contour", 4.0, "");
        style.lines.detect.materials = materials;
        let (mean, _) = measured(&lines_of(&scene, &style, &view), 0.0);
        assert!((mean - expected).abs() < 0.1, "materials = {materials}: {mean}");
    }
}

#[test]
fn lines_are_drawn_where_objects_run_into_each_other() {
    // A ball that sticks half out of a wall: their seam is a circle without an edge.
    let mut scene = Builder::new();
    scene.object("wall", shapes::plane(Vec2::splat(4.0)), None, moved(0.0, 0.0, 0.0));
    scene.object("ball", shapes::uv_sphere(48, 24, 0.6), None, moved(0.0, 0.0, 0.2));
    let turn = glam::Affine3A::from_rotation_x(-0.9);
    let mut view = ortho_view([128, 128], 2.0);
    view.camera.world_from_camera = turn * view.camera.world_from_camera;
    let scene = scene.build();
    for method in ["image", "reference", "contour"] {
        let picture = lines_of(&scene, &ruled(method, 3.0, ""), &view);
        // The highest point of the seam, on the picture seen from above.
        let radius = (0.6_f32.powi(2) - 0.2_f32.powi(2)).sqrt();
        let p_px =
            genga_tests::Eye::new(&view).project(glam::DVec3::new(0.0, f64::from(radius), 0.0));
        let (x, y) = (p_px.x as u32, p_px.y as u32);
        let ink = (y - 1..=y + 1).map(|y| picture.ink(x, y)).max();
        assert!(ink > Some(100), "{method}: no line at {p_px}");
    }
}
