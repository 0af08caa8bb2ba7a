//! The head: an anime bust with large eyes, bold hair and a collar, that blinks and smiles.

mod eyes;
mod form;
mod hair;

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3, Vec3};

use super::glb::{MaterialId, Model, Surface, Track};
use super::sculpt::{
    Field, Part, Region, Unwrap, imprint, polygonise, relax, remesh, sheet, smooth_step,
};
use eyes::Warp;
use form::{Form, edge_length};

/// The morph targets.
const TARGETS: [(&str, Warp); 2] = [("blink", eyes::blink), ("smile", eyes::smile)];

/// Skin, white of the eyes, mouth, and clothes.
fn bust(form: &Form) -> [Part; 4] {
    let mesh =
        polygonise(form, DVec3::new(-0.2, -0.03, -0.14), DVec3::new(0.2, 0.42, 0.14), 0.0035);
    let mesh = remesh(mesh, form, &edge_length, 6);
    let white_surface = |p: DVec3| form.at(p) + 0.0012;
    let cloth_surface = |p: DVec3| form.at(p) - 0.002;
    let rest = |_: DVec3| -1.0;
    let regions = [
        Region { inside: &eyes::opening, surface: &white_surface, raised: true },
        Region { inside: &eyes::mouth, surface: form, raised: false },
        Region { inside: &form::cloth, surface: &cloth_surface, raised: true },
        Region { inside: &rest, surface: form, raised: false },
    ];
    let mut imprinted = imprint(mesh, form, &regions, &edge_length);
    relax(&mut imprinted, form, &regions, 4);
    let mut parts = imprinted.parts(&regions);
    let loose = open_edges(&parts[2]);
    // Head and clothes are two things, each closed by a lid where they meet in the neck.
    let other_way: Vec<_> = loose.iter().map(|&[a, b]| [b, a]).collect();
    close(&mut parts[2], &loose);
    close(&mut parts[3], &other_way);
    let parts: Vec<Part> = parts.iter().map(round_the_head).collect();
    parts.try_into().unwrap_or_default()
}

fn bits(p: DVec3) -> [u64; 3] {
    p.to_array().map(f64::to_bits)
}

/// The edges with one triangle only, as that runs along them.
fn open_edges(part: &Part) -> Vec<[DVec3; 2]> {
    let mut edges = BTreeMap::new();
    for t in part.indices.chunks_exact(3) {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [t[i], t[j]].map(|v| part.positions[v as usize]);
            if edges.remove(&(bits(b), bits(a))).is_none() {
                edges.insert((bits(a), bits(b)), [a, b]);
            }
        }
    }
    edges.into_values().collect()
}

/// Closes a ring of open edges with a fan.
fn close(part: &mut Part, ring: &[[DVec3; 2]]) {
    let middle = ring.iter().map(|[a, _]| *a).sum::<DVec3>() / ring.len().max(1) as f64;
    let normal: DVec3 = ring.iter().map(|&[a, b]| (a - middle).cross(middle - b)).sum();
    let normal = normal.normalize_or_zero();
    for &[a, b] in ring {
        let corners = [b, a, middle].map(|p| part.push(p, normal));
        part.indices.extend(corners);
    }
}

/// Gives texture coordinates: u goes once round the head, its seam behind; v runs down, 2.5 to
/// the metre.
fn round_the_head(part: &Part) -> Part {
    let place = |_: usize, p: DVec3| {
        let turn = libm::atan2(p.x, p.z - form::SKULL.z) / std::f64::consts::TAU;
        DVec2::new(turn + 0.5, (0.40 - p.y) * 2.5)
    };
    Unwrap { chart: &|_| 0, place: &place, turn: &|_| 1.0 }.unwrap(part).0
}

/// Positions and normals of a part of the face when `warp` is on.
fn warped(form: &Form, part: &Part, warp: Warp) -> (Vec<DVec3>, Vec<DVec3>) {
    let moved = |(&p, &n): (&DVec3, &DVec3)| {
        let from = DVec2::new(p.x, p.y);
        if p.z < 0.02 || from.distance(warp(from)) < 1e-9 {
            return (p, n);
        }
        let (a, na) = form.on_face(from.x, from.y);
        // What the face hides, such as the neck below the chin, stays; what turns away fades.
        let seen = smooth_step(0.10, 0.40, na.z) * smooth_step(0.012, 0.006, a.distance(p));
        let to = from.lerp(warp(from), seen);
        let (b, nb) = form.on_face(to.x, to.y);
        (p + (b - a), (n + nb - na).normalize_or_zero())
    };
    let (mut positions, normals): (Vec<_>, Vec<_>) =
        part.positions.iter().zip(&part.normals).map(moved).unzip();
    unfold(part, &mut positions, &normals);
    (positions, normals)
}

/// Spreads a motion that folds triangles over the ones round them; the part's borders stay.
fn unfold(part: &Part, moved: &mut [DVec3], normals: &[DVec3]) {
    const ROUNDS: usize = 100;
    let (triangles, _) = part.indices.as_chunks::<3>();
    let mut neighbors = vec![BTreeSet::new(); moved.len()];
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)] {
            neighbors[from as usize].insert(to as usize);
        }
    }
    let border: BTreeSet<[u64; 3]> = open_edges(part).iter().map(|[a, _]| bits(*a)).collect();
    for _ in 0..ROUNDS {
        let folded = triangles.iter().filter(|t| is_folded(t, moved, normals));
        let corners: BTreeSet<usize> = folded.flatten().map(|&v| v as usize).collect();
        if corners.is_empty() {
            return;
        }
        for v in corners {
            let at = part.positions[v];
            if !border.contains(&bits(at)) {
                let motion = |n: &usize| moved[*n] - part.positions[*n];
                let mean = neighbors[v].iter().map(motion).sum::<DVec3>();
                moved[v] = moved[v].midpoint(at + mean / neighbors[v].len() as f64);
            }
        }
    }
}

/// Whether a triangle faces away from its corners' normals.
fn is_folded(triangle: &[u32; 3], moved: &[DVec3], normals: &[DVec3]) -> bool {
    let [a, b, c] = triangle.map(|v| moved[v as usize]);
    let face = (b - a).cross(c - a).normalize_or_zero();
    triangle.iter().map(|&v| normals[v as usize].dot(face)).sum::<f64>() < 0.15
}

fn surface(part: &Part) -> Surface {
    Surface {
        positions: part.positions.iter().map(|p| p.as_vec3()).collect(),
        normals: part.normals.iter().map(|n| n.as_vec3().normalize_or_zero()).collect(),
        uvs: part.uvs.iter().map(|uv| uv.as_vec2()).collect(),
        indices: part.indices.clone(),
        ..Surface::default()
    }
}

/// A surface with its morph targets, given as moved positions and normals.
fn morphing(part: &Part, targets: Vec<(Vec<DVec3>, Vec<DVec3>)>) -> Surface {
    let mut result = surface(part);
    for (positions, normals) in targets {
        let offset = |a: &[DVec3], b: &[DVec3]| -> Vec<Vec3> {
            a.iter().zip(b).map(|(a, b)| (*a - *b).as_vec3()).collect()
        };
        result.targets.push((offset(&positions, &part.positions), offset(&normals, &part.normals)));
    }
    result
}

/// A collar that stands round the neck and falls open in front.
fn collar() -> Part {
    const ROWS: usize = 8;
    const COLUMNS: usize = 48;
    let rows: Vec<Vec<DVec3>> = (0..=ROWS)
        .map(|r| {
            let v = r as f64 / ROWS as f64;
            (0..=COLUMNS)
                .map(|c| {
                    let u = 1.0 - 2.0 * c as f64 / COLUMNS as f64;
                    // 0 behind, ±1 in front.
                    let angle = u * (3.02 - 0.16 * v);
                    let point = smooth_step(0.72, 1.0, u.abs());
                    let radius = 0.0465 + 0.030 * v + 0.012 * v * point;
                    let top = 0.112 - 0.022 * smooth_step(0.2, 1.0, u.abs());
                    DVec3::new(
                        radius * libm::sin(angle),
                        top - 0.042 * v - 0.020 * v * point + 0.010 * libm::sin(v * 3.1),
                        -0.030 - radius * 1.02 * libm::cos(angle),
                    )
                })
                .collect()
        })
        .collect();
    sheet(&rows, 0.005)
}

/// The model.
pub(super) fn head() -> Model {
    let form = Form::new();
    let mut model = Model::new("head");
    let skin = model.material("skin", 0xFFDCC4, false);
    let white = model.material("eye_white", 0xFFFFFF, false);
    let mouth = model.material("mouth", 0xB2484A, false);
    let cloth = model.material("cloth", 0x34406E, false);
    let hair = model.material("hair", 0x7A86E0, false);
    let collar_material = model.material("collar", 0xF4F2EC, false);
    let named: Vec<(&str, MaterialId)> = [
        ("iris", 0xF0A030),
        ("iris_shade", 0xB4561E),
        ("pupil", 0x47202A),
        ("shine", 0xFFFFFF),
        ("lash", 0x2A2038),
        ("brow", 0x4A4C9A),
    ]
    .into_iter()
    .map(|(name, color)| (name, model.material(name, color, false)))
    .collect();

    let [whites, mouths, clothes, skins] = bust(&form);
    let mut surfaces = Vec::new();
    for (part, material) in [(skins, skin), (whites, white), (mouths, mouth)] {
        let targets = TARGETS.map(|(_, warp)| warped(&form, &part, warp)).to_vec();
        surfaces.push((morphing(&part, targets), material));
    }
    for &(name, material) in &named {
        let mut rest = Part::default();
        let mut targets = vec![(Vec::new(), Vec::new()); TARGETS.len()];
        for (_, patch) in eyes::patches().iter().filter(|(n, _)| *n == name) {
            for right in [false, true] {
                rest.append(&patch.placed(&form, eyes::rest, right));
                for (target, (what, warp)) in targets.iter_mut().zip(TARGETS) {
                    // The skin slides under the brows.
                    let stays = name == "brow" && what == "blink";
                    let warp = if stays { eyes::rest } else { warp };
                    let moved = patch.placed(&form, warp, right);
                    target.0.extend(moved.positions);
                    target.1.extend(moved.normals);
                }
            }
        }
        let mut surface = morphing(&rest, targets);
        // They are strokes already.
        surface.line_widths = vec![0.0; surface.positions.len()];
        surfaces.push((surface, material));
    }
    let face = model.surfaces("face", &surfaces, &TARGETS.map(|(name, _)| name));
    let face = model.object("face", face, Vec3::ZERO);
    // A blink shuts the eyes for a moment; a smile comes and stays.
    let blink = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0].to_vec();
    model.clip("blink", &[0.0, 0.1, 0.15, 0.3], &[Track::Weights(face, blink)]);
    let smile = [0.0, 0.0, 0.0, 1.0].to_vec();
    model.clip("smile", &[0.0, 0.4], &[Track::Weights(face, smile)]);

    let mesh = model.surfaces("bust", &[(surface(&clothes), cloth)], &[]);
    model.object("bust", mesh, Vec3::ZERO);
    let mesh = model.surfaces("collar", &[(surface(&collar()), collar_material)], &[]);
    model.object("collar", mesh, Vec3::ZERO);

    let cap = hair::cap();
    let length = |_: DVec3| 0.0100;
    let mesh = polygonise(&cap, DVec3::new(-0.15, 0.1, -0.16), DVec3::new(0.15, 0.42, 0.15), 0.006);
    let mesh = remesh(mesh, &cap, &length, 5);
    let rest = |_: DVec3| -1.0;
    let whole = [Region { inside: &rest, surface: &cap, raised: false }];
    let part = imprint(mesh, &cap, &whole, &length).parts(&whole).remove(0);
    let part = round_the_head(&part);
    let mesh = model.surfaces("hair_cap", &[(surface(&part), hair)], &[]);
    model.object("hair_cap", mesh, Vec3::ZERO);
    let mesh = model.surfaces("hair_locks", &[(surface(&hair::locks()), hair)], &[]);
    model.object("hair_locks", mesh, Vec3::ZERO);
    model.camera(Vec3::new(-0.42, 0.27, 1.02), Vec3::new(0.0, 0.205, 0.0), 24.0);
    model.sun(Vec3::new(0.62, -0.55, -0.60));
    model
}
#[cfg(test)]
mod tests {
    use super::*;

    /// Lids and lips move without folding the skin over.
    #[test]
    fn skin_does_not_turn_over_when_the_face_moves() {
        let form = Form::new();
        let [_, _, _, skin] = bust(&form);
        for (name, warp) in TARGETS {
            let (moved, normals) = warped(&form, &skin, warp);
            let (mut travel, mut folded): (f64, usize) = (0.0, 0);
            for t in skin.indices.as_chunks::<3>().0 {
                let v = t[0] as usize;
                folded += usize::from(is_folded(t, &moved, &normals));
                travel = travel.max(skin.positions[v].distance(moved[v]));
            }
            assert!(travel > 0.004, "{name} moves {travel} m");
            assert_eq!(folded, 0, "{name}");
        }
    }
}
