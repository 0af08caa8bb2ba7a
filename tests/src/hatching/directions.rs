//! Which way strokes run, from the picture alone: by the structure tensor of the ink.

use glam::{DVec2, DVec3};

use super::surface::{Frame, Hit};

/// Pixels to each side over which directions are averaged.
const RADIUS: i64 = 5;

/// Part of the inked pixels whose strokes run within 30° of the wanted direction, and how many there
/// are. `wanted` gives the direction in the world at a point of the surface, if any is wanted there.
///
/// Pixels in solid black or on its border, where nothing runs any way, and those next to the
/// outline do not count.
#[must_use]
pub fn within_30_degrees(
    frame: &Frame,
    wanted: impl Fn(Hit, DVec3) -> Option<DVec3>,
) -> (f64, usize) {
    let [width, height] = frame.size().map(i64::from);
    let ink = |x: i64, y: i64| frame.ink[(y * width + x) as usize];
    let (mut within, mut all) = (0, 0);
    for y in RADIUS + 1..height - RADIUS - 1 {
        for x in RADIUS + 1..width - RADIUS - 1 {
            if ink(x, y) < 0.5 {
                continue;
            }
            let Some((hit, p)) = frame.seen(x as u32, y as u32) else { continue };
            let Some(way) = wanted(hit, p) else { continue };
            let around =
                (-RADIUS..=RADIUS).flat_map(|dy| (-RADIUS..=RADIUS).map(move |dx| (dx, dy)));
            let (mut xx, mut xy, mut yy, mut sum, mut inside) = (0.0, 0.0, 0.0, 0.0, true);
            for (dx, dy) in around {
                let (u, v) = (x + dx, y + dy);
                inside &= frame.seen(u as u32, v as u32).is_some();
                let weight = (-((dx * dx + dy * dy) as f64) / 12.0).exp();
                let gx = ink(u + 1, v) - ink(u - 1, v);
                let gy = ink(u, v + 1) - ink(u, v - 1);
                xx += weight * gx * gx;
                xy += weight * gx * gy;
                yy += weight * gy * gy;
                sum += ink(u, v);
            }
            let mean = sum / ((2 * RADIUS + 1) * (2 * RADIUS + 1)) as f64;
            if !inside || mean > 0.85 || xx + yy < 1e-3 {
                continue;
            }
            // Strokes run across the strongest change.
            let angle = 0.5 * (2.0 * xy).atan2(xx - yy) + std::f64::consts::FRAC_PI_2;
            let step = 1e-4;
            let on_picture = frame.project(p + way * step) - frame.project(p - way * step);
            let cosine = on_picture.normalize_or_zero().dot(DVec2::from_angle(angle)).abs();
            all += 1;
            within += usize::from(cosine >= 30_f64.to_radians().cos());
        }
    }
    (within as f64 / all.max(1) as f64, all)
}
