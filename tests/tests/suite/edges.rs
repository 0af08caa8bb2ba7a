//! Lines lie on the edges of the project's own models, and every edge has its line.

use genga_tests::edges::{Figures, cameras, measure};
use genga_tests::scenes::model;

fn round(name: &str, method: &str) -> Figures {
    let scene = model(name);
    let views = cameras(&scene, 8, [192, 144]);
    let figures = views.iter().map(|view| measure(&scene, method, 3.0, view));
    let all = figures.fold(Figures::default(), Figures::and);
    println!("{name}, {method}: {all:?}, coverage {:.4}", all.coverage());
    assert!(all.inked > 9000, "there are hardly any lines");
    all
}

#[test]
fn contours_lie_on_visible_edges_and_cover_them() {
    for name in ["cube-before-plane", "teapot-on-box"] {
        let all = round(name, "contour");
        assert_eq!(all.astray, 0, "{name}: ink off all edges");
        // Where the teapot's parts run into each other, no edge of a mesh marks the seam.
        assert!(200 * all.hidden < all.inked, "{name}: ink where no edge is visible");
        assert!(all.coverage() > 0.995, "{name}: edges without a line");
    }
}

#[test]
fn reference_lines_cover_edges_and_stray_little() {
    let cube = round("cube-before-plane", "reference");
    assert_eq!((cube.astray, cube.hidden), (0, 0));
    assert!(cube.coverage() > 0.99);
    // The paper's own fault: an edge that is no line is drawn where it crosses the mask of one
    // that is.
    let teapot = round("teapot-on-box", "reference");
    assert!(50 * teapot.astray < teapot.inked && teapot.farthest_px < 6.0);
    assert!(teapot.coverage() > 0.995);
}
