use genga_tests::draw_posed;
use genga_tests::hatching::{hatching, subjects, surface::Frame};
fn save(p: &genga::render::Picture, n: &str) {
    image::RgbaImage::from_raw(p.width, p.height, p.rgba.clone()).unwrap().save(n).unwrap();
}
fn main() {
    let hand = "pattern = \"strokes\"\nspacing = 12\nlength = 60\nirregularity = 0.5\ntones = [{ at = 0.0, lum = 0.6 }]\nangle_deg = 40";
    let s = subjects::standing("cylinder");
    let st = hatching(hand, 400);
    for d in [0.0, 4.0, 8.0, 24.0] {
        save(
            &draw_posed(&s, &subjects::turned(&s, d), &st, &subjects::front(400), &[]),
            &format!("/tmp/hatch/t_{d}.png"),
        );
    }
    let f = |d| Frame::draw(&s, &subjects::turned(&s, d), &st, &subjects::front(400));
    let z = f(0.0);
    for d in [0.0, 1.0, 4.0, 8.0, 16.0, 24.0] {
        println!("{d} {} changed {}", f(d).drift_since(&z), f(d).changed_since(&z));
    }
}
