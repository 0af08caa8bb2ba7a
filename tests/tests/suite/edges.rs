//! Lines of the paper's method lie on the edges of the project's own models, and every edge has its
//! line.

use genga_tests::edges::{Figures, cameras, measure};
use genga_tests::scenes::model;

fn round(name: &str) -> Figures {
    let scene = model(name);
    let views = cameras(&scene, 8, [192, 144]);
    let figures = views.iter().map(|view| measure(&scene, "reference", 3.0, view));
    let all = figures.fold(Figures::default(), Figures::and);
    println!("{name}: {all:?}, coverage {:.4}", all.coverage());
    assert!(all.inked > 9000, "there are hardly any lines");
    all
}

#[test]
fn reference_lines_cover_edges_and_stray_little() {
    let cube = round("cube-before-plane");
    assert_eq!((cube.astray, cube.hidden), (0, 0));
    assert!(cube.coverage() > 0.99);
    // The paper's own fault: an edge that is no line is drawn where it crosses the mask of one
    // that is.
    let teapot = round("teapot-on-box");
    assert!(50 * teapot.astray < teapot.inked && teapot.farthest_px < 6.0);
    assert!(teapot.coverage() > 0.995);
}
