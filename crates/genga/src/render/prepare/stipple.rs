//! Points of the pen: one set of places that looks set by hand at every density.
//!
//! The places lie on a torus, in orbits of x → 2x, so the set at half the size contains the set
//! itself: as the eye comes nearer, points appear between those that stay, for ever. They are
//! chosen, and come in an order, by the largest void (void and cluster, Ulichney 1993).

/// Places of the coarse set, in fractions of the torus: multiples of 1/255, where doubling eight times
/// is the identity.
const SIDE: usize = 255;
const ORBIT: usize = 8;
const ORBITS: usize = 72;
/// The fine set is the coarse one at half the size, four times. Its places are multiples of
/// 1/(2 · SIDE).
const FINE: usize = 2 * SIDE;
/// Squares of the torus along a side, each a texel; as in `hatch_stipple.wesl`.
const CELLS: usize = 30;
/// Most points in a square.
const IN_CELL: usize = 4;
/// Steps of improvement: more than it takes.
const ROUNDS: usize = 64;

/// A place on the torus, in steps of its grid.
type Place = [usize; 2];

/// A texel a square, row by row, a number for each of up to four points, 0 for none: bit 31, and from
/// the lowest up five bits for each of x and y in the square in 1/17 of its side, eight bits for
/// when it comes (0 for the coarse set, then 1 to 255), and eight bits for its size.
fn texels() -> Vec<u32> {
    let (coarse, sizes) = coarse();
    let mut cells = vec![[0; IN_CELL]; CELLS * CELLS];
    let in_cell = FINE / CELLS;
    for (place, when) in fine(&coarse) {
        // The place at twice the size belongs to the coarse set: points keep their size.
        let own = [0, 1].map(|i| place[i] % SIDE);
        let size = sizes[own[1] * SIDE + own[0]];
        let [x, y] = place.map(|v| (v % in_cell) as u32);
        let point = 1 << 31 | u32::from(size) << 18 | u32::from(when) << 10 | y << 5 | x;
        let cell = &mut cells[place[1] / in_cell * CELLS + place[0] / in_cell];
        // A test holds that there is room for all.
        if let Some(free) = cell.iter_mut().find(|slot| **slot == 0) {
            *free = point;
        }
    }
    cells.into_iter().flatten().collect()
}

/// The texture of [`texels`]; one empty texel for styles that need none.
pub(super) fn texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    is_needed: bool,
) -> wgpu::TextureView {
    use wgpu::util::DeviceExt as _;
    let texels = if is_needed { texels() } else { vec![0; IN_CELL] };
    let side = if is_needed { CELLS as u32 } else { 1 };
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some("stipple"),
            size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// The squared distance on a torus.
fn squared(a: Place, b: Place, side: usize) -> f32 {
    let along = |i: usize| {
        let d = a[i].abs_diff(b[i]);
        let d = d.min(side - d) as f32;
        d * d
    };
    along(0) + along(1)
}

/// The places of the coarse set, and the size of each, row by row on its grid.
fn coarse() -> (Vec<Place>, Vec<u8>) {
    let orbit =
        |p: Place| -> [Place; ORBIT] { std::array::from_fn(|i| p.map(|v| (v << i) % SIDE)) };
    let places = (1..SIDE * SIDE).map(|i| [i % SIDE, i / SIDE]);
    // Each of full length once, by its least place.
    let all: Vec<[Place; ORBIT]> =
        places.map(orbit).filter(|o| o[1..].iter().all(|p| *p > o[0])).collect();

    let spread = 0.5 * SIDE as f32 / ((ORBITS * ORBIT) as f32).sqrt();
    let kernel: Vec<f32> = (0..SIDE * SIDE)
        .map(|i| (-squared([i % SIDE, i / SIDE], [0, 0], SIDE) / (2.0 * spread * spread)).exp())
        .collect();
    let between = |a: Place, b: Place| {
        let [x, y] = [0, 1].map(|i| (a[i] + SIDE - b[i]) % SIDE);
        kernel[y * SIDE + x]
    };
    let own: Vec<f32> = all
        .iter()
        .map(|o| (0..ORBIT).flat_map(|i| (0..i).map(move |j| 2.0 * between(o[i], o[j]))).sum())
        .collect();
    let mut field = vec![0.0_f32; SIDE * SIDE];
    let mut chosen = vec![false; all.len()];
    let add = |field: &mut [f32], orbit: &[Place; ORBIT], weight: f32| {
        for p in orbit {
            for (i, value) in field.iter_mut().enumerate() {
                *value += weight * between([i % SIDE, i / SIDE], *p);
            }
        }
    };
    let crowding = |field: &[f32], i: usize| -> f32 {
        all[i].iter().map(|p| 2.0 * field[p[1] * SIDE + p[0]]).sum()
    };
    let emptiest = |field: &[f32], chosen: &[bool]| {
        let cost = |i: usize| own[i] + crowding(field, i);
        (0..all.len()).filter(|&i| !chosen[i]).min_by(|&a, &b| cost(a).total_cmp(&cost(b)))
    };
    for round in 0..ORBITS + ROUNDS {
        let mut worst = None;
        if round >= ORBITS {
            // A chosen one's own places are in the field, and itself twice.
            let cost = |i: usize| crowding(&field, i) - own[i];
            worst =
                (0..all.len()).filter(|&i| chosen[i]).max_by(|&a, &b| cost(a).total_cmp(&cost(b)));
            if let Some(worst) = worst {
                add(&mut field, &all[worst], -1.0);
                chosen[worst] = false;
            }
        }
        let Some(best) = emptiest(&field, &chosen) else { break };
        add(&mut field, &all[best], 1.0);
        chosen[best] = true;
        if worst == Some(best) {
            break;
        }
    }
    let mut sizes = vec![0; SIDE * SIDE];
    let chosen: Vec<&[Place; ORBIT]> =
        all.iter().zip(chosen).filter(|c| c.1).map(|c| c.0).collect();
    for (number, orbit) in chosen.iter().enumerate() {
        // The golden ratio spreads sizes over orbits that lie beside each other in the list.
        let size = (number as u32 * 158 % 256) as u8;
        orbit.iter().for_each(|p| sizes[p[1] * SIDE + p[0]] = size);
    }
    (chosen.into_iter().flatten().copied().collect(), sizes)
}

/// The places of the fine set and when each comes: those of the coarse set first, at 0, then 1 to 255.
fn fine(coarse: &[Place]) -> Vec<(Place, u8)> {
    let halves = |p: &Place| {
        [[0, 0], [SIDE, 0], [0, SIDE], [SIDE, SIDE]].map(|o| [p[0] + o[0], p[1] + o[1]])
    };
    // One of the four halves of a place is in the coarse set, since that is closed under doubling.
    let (mut placed, mut rest): (Vec<Place>, Vec<Place>) =
        coarse.iter().flat_map(halves).partition(|p| p[0] % 2 == 0 && p[1] % 2 == 0);
    let mut ordered: Vec<(Place, u8)> = placed.iter().map(|&p| (p, 0)).collect();
    let count = rest.len();
    let mut sharpness = 0.0;
    let mut crowding: Vec<f32> = Vec::new();
    for step in 0..count {
        let wanted = 2.0 * placed.len() as f32 / (FINE * FINE) as f32;
        if wanted > 1.1 * sharpness {
            sharpness = wanted;
            let of =
                |a: &Place| placed.iter().map(|&b| (-sharpness * squared(*a, b, FINE)).exp()).sum();
            crowding = rest.iter().map(of).collect();
        }
        let Some(next) = (0..rest.len()).min_by(|&a, &b| crowding[a].total_cmp(&crowding[b]))
        else {
            break;
        };
        let place = rest.swap_remove(next);
        crowding.swap_remove(next);
        for (sum, &other) in crowding.iter_mut().zip(&rest) {
            *sum += (-sharpness * squared(place, other, FINE)).exp();
        }
        placed.push(place);
        ordered.push((place, (1 + step * 255 / count) as u8));
    }
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_points_have_room_and_halves_of_the_set_contain_it() {
        let (coarse, _) = coarse();
        assert_eq!(coarse.len(), ORBITS * ORBIT);
        let fine = fine(&coarse);
        assert_eq!(fine.len(), 4 * coarse.len());
        assert_eq!(texels().iter().filter(|&&texel| texel != 0).count(), fine.len());
        for p in &coarse {
            let doubled = p.map(|v| 2 * v % SIDE);
            assert!(coarse.contains(&doubled), "{p:?} twice as large is {doubled:?}");
            assert!(fine.iter().any(|(q, when)| *q == p.map(|v| 2 * v) && *when == 0), "{p:?}");
        }
    }

    #[test]
    fn no_two_points_are_next_to_each_other() {
        let fine = fine(&coarse().0);
        for last in [0, 64, 128, 255] {
            let places: Vec<Place> = fine.iter().filter(|p| p.1 <= last).map(|p| p.0).collect();
            let mean = FINE as f32 / (places.len() as f32).sqrt();
            let mut nearest: Vec<f32> = places
                .iter()
                .map(|&a| {
                    let others = places.iter().filter(|&&b| b != a);
                    others.map(|&b| squared(a, b, FINE)).fold(f32::INFINITY, f32::min).sqrt() / mean
                })
                .collect();
            nearest.sort_by(f32::total_cmp);
            // Of places without any order a twentieth is nearer than 0.13, half nearer than 0.47.
            let [few, half] = [nearest[nearest.len() / 20], nearest[nearest.len() / 2]];
            assert!(few > 0.4 && half > 0.6, "{last}: {few:.2}, {half:.2}");
        }
    }
}
