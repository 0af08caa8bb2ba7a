//! The hero: a comic figure in mask, cape and boots, eight heads tall.

mod body;
mod cape;
mod clips;
#[cfg(test)]
mod collisions;
mod face;
mod hand;
mod limb;
mod limbs;
mod pose;
mod poses;
mod shield;
mod skeleton;
mod torso;
mod unwrap;
mod weights;

use std::collections::BTreeMap;

use glam::{DVec3, Mat4, Vec3};

use super::glb::{MaterialId, Model, NodeId, Surface};
use super::sculpt::{Imprinted, Part, Region, imprint, polygonise, relax, remesh, smooth_step};
use body::{Body, Wardrobe, edge_length};
use weights::Weights;

/// Materials by region, first region first.
const MATERIALS: [(&str, u32); 13] = [
    ("hair", 0x4A2F27),
    ("eye", 0xFFFFFF),
    ("mask", 0x2B2A3A),
    ("mouth", 0x7A2E2A),
    ("skin", 0xEDB48C),
    ("metal", 0xC9CED6),
    ("belt", 0xF0B429),
    // Cuffs, soles, and the boots and gloves themselves.
    ("boots", 0xF0B429),
    ("boots", 0xF0B429),
    ("boots", 0xF0B429),
    ("trunks", 0xD63A2F),
    ("emblem", 0xF0B429),
    ("suit", 0x3B6FD4),
];

/// A part with the bones that hold each vertex.
struct Held {
    part: Part,
    weights: Vec<Weights>,
}

/// The parts of the figure itself, one for each of [`MATERIALS`], in the bind pose.
fn figure(body: &Body, bones: usize) -> Vec<Held> {
    let w = Wardrobe(body);
    let whole = |p: DVec3| body.whole(p);
    let mesh = polygonise(&whole, DVec3::new(-0.9, -0.03, -0.25), DVec3::new(0.9, 2.0, 0.3), 0.006);
    let mesh = remesh(mesh, &whole, &edge_length, 6);
    let skin = |p: DVec3| body.body(p);
    let hair_surface = |p: DVec3| body.hair(p);
    let mask_surface = |p: DVec3| w.mask_surface(p);
    let belt_surface = |p: DVec3| w.belt_surface(p);
    let buckle_surface = |p: DVec3| w.belt_surface(p) - 0.0055;
    let trunks_surface = |p: DVec3| body.body(p) - 0.0025;
    let (hair, eye, mask) = (|p| w.hair(p), |p| w.eye(p), |p| w.mask(p));
    let (mouth, skin_in, buckle) = (|p| w.mouth(p), |p| w.skin(p), |p| w.buckle(p));
    let (belt, boots, trunks) =
        (|p| w.belt(p), |p: DVec3| w.boot(p).min(w.glove(p)), |p| w.trunks(p));
    let boots_surface = |p: DVec3| if p.y < 0.75 { w.boot_surface(p) } else { w.glove_surface(p) };
    let cuffs = |p: DVec3| boots(p).max(-boots(p) - 0.024);
    let cuff_surface = |p: DVec3| boots_surface(p) - 0.0055;
    // The rest begins under the cuffs, not at their edge, where two borders would coincide.
    let below_cuffs = |p: DVec3| boots(p) + 0.012;
    let soles = |p: DVec3| p.y - 0.019;
    let sole_surface = |p: DVec3| body.body(p) - 0.0085;
    let emblem = |p| w.emblem(p);
    let rest = |_: DVec3| -1.0;
    let regions = [
        Region { inside: &hair, surface: &hair_surface, raised: false },
        Region { inside: &eye, surface: &skin, raised: false },
        Region { inside: &mask, surface: &mask_surface, raised: true },
        Region { inside: &mouth, surface: &skin, raised: false },
        Region { inside: &skin_in, surface: &skin, raised: false },
        Region { inside: &buckle, surface: &buckle_surface, raised: true },
        Region { inside: &belt, surface: &belt_surface, raised: true },
        Region { inside: &cuffs, surface: &cuff_surface, raised: true },
        Region { inside: &soles, surface: &sole_surface, raised: true },
        Region { inside: &below_cuffs, surface: &boots_surface, raised: true },
        Region { inside: &trunks, surface: &trunks_surface, raised: true },
        Region { inside: &emblem, surface: &skin, raised: false },
        Region { inside: &rest, surface: &skin, raised: false },
    ];
    let mut imprinted = imprint(mesh, &whole, &regions, &edge_length);
    relax(&mut imprinted, &whole, &regions, 4);
    let weights = held(body, &imprinted, bones);
    let hold = |part: Part| Held {
        weights: part.sources.iter().map(|&v| weights[v as usize].clone()).collect(),
        part,
    };
    imprinted.parts(&regions).into_iter().map(hold).collect()
}

/// Weights of the figure's vertices. Diffusion along the surface smooths what the rules leave.
fn held(body: &Body, imprinted: &Imprinted, bones: usize) -> Vec<Weights> {
    let weights =
        imprinted.points().iter().map(|&p| weights::body_weights(body, p, bones)).collect();
    let weights = imprinted.diffused(weights, 8, &|_| 0.5);
    // Shoulders, crotch and groins fold far.
    let folds = |p: DVec3| {
        let near = |at: DVec3, radius: f64| {
            let p = DVec3::new(p.x.abs(), p.y, p.z);
            smooth_step(2.0 * radius, radius, p.distance(at))
        };
        let shoulder = near(DVec3::new(0.23, 1.47, 0.01), 0.085);
        let crotch = near(DVec3::new(0.0, 0.89, 0.03), 0.06);
        let groin = near(DVec3::new(0.09, 0.94, 0.08), 0.045);
        0.5 * shoulder.max(0.2 * crotch).max(0.6 * groin)
    };
    imprinted.diffused(weights, 28, &folds)
}

impl Held {
    fn surface(&self) -> Surface {
        let (joints, weights) = self.weights.iter().map(|w| weights::quantised(w)).unzip();
        let line_widths = self.weights.iter().map(|w| line_width(w) as f32).collect();
        Surface { joints, weights, line_widths, ..surface(&self.part) }
    }
}

/// Lines are finer on the head and the hands.
fn line_width(weights: &[f64]) -> f64 {
    use skeleton::{FINGER_TIPS, FINGERS, HAND, HEAD, RIGHT, THUMB};
    let hands = [HAND, FINGERS, FINGER_TIPS, THUMB];
    let on_hands: f64 = hands.iter().map(|&bone| weights[bone] + weights[bone + RIGHT]).sum();
    1.0 - 0.5 * weights[HEAD] - 0.35 * on_hands
}

/// The surface's normals; where those of a tiny triangle all point inwards, which happens in narrow
/// folds, the means of the triangles at its corners instead.
fn outward_normals(part: &Part) -> Vec<DVec3> {
    let (triangles, _) = part.indices.as_chunks::<3>();
    let face = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| part.positions[v as usize]);
        (b - a).cross(c - a)
    };
    let mut means = vec![DVec3::ZERO; part.positions.len()];
    for triangle in triangles {
        triangle.iter().for_each(|&v| means[v as usize] += face(triangle));
    }
    let mut normals = part.normals.clone();
    for triangle in triangles {
        if triangle.iter().all(|&v| part.normals[v as usize].dot(face(triangle)) < 0.0) {
            triangle.iter().for_each(|&v| normals[v as usize] = means[v as usize]);
            if triangle.iter().all(|&v| means[v as usize].dot(face(triangle)) < 0.0) {
                normals[triangle[0] as usize] = face(triangle);
            }
        }
    }
    normals
}

fn surface(part: &Part) -> Surface {
    Surface {
        positions: part.positions.iter().map(|p| p.as_vec3()).collect(),
        normals: outward_normals(part).iter().map(|n| n.as_vec3().normalize_or_zero()).collect(),
        uvs: part.uvs.iter().map(|uv| uv.as_vec2()).collect(),
        indices: part.indices.clone(),
        ..Surface::default()
    }
}

/// Everything that is drawn, in the bind pose.
struct Cast {
    /// One for each of [`MATERIALS`].
    figure: Vec<Held>,
    locks: Held,
    cape: Held,
    clasps: Held,
    /// Metal, ring, boss, strap, relative to the elbow.
    shield: [Part; 4],
}

fn cast(bones: usize) -> Cast {
    let body = Body::new();
    let mut locks = face::locks();
    for p in &mut locks.positions {
        *p = body::from_head(*p);
    }
    let mut on_head = vec![0.0; bones];
    on_head[skeleton::HEAD] = 1.0;
    let hold = |part: Part, weights: &dyn Fn(DVec3) -> Weights| Held {
        weights: part.positions.iter().map(|&p| weights(p)).collect(),
        part,
    };
    let mut figure = figure(&body, bones);
    figure.iter_mut().for_each(unwrap::unwrap);
    Cast {
        figure,
        locks: hold(locks, &|_| on_head.clone()),
        cape: hold(cape::cape(&body), &|p| cape::cape_weights(&body, p, bones)),
        clasps: hold(cape::clasps(&body), &|p| weights::body_weights(&body, p, bones)),
        shield: shield::shield(),
    }
}

/// The model.
pub(super) fn hero() -> Model {
    let mut model = Model::new("hero");
    let bones = skeleton::bones();
    let cast = cast(bones.len());

    let locals = poses::charge().place(&bones).locals(&bones);
    let mut joints: Vec<NodeId> = Vec::new();
    for (bone, (translation, rotation)) in bones.iter().zip(locals) {
        let parent = bone.parent.map(|parent| joints[parent]);
        joints.push(model.joint(bone.name, parent, translation, rotation));
    }
    let inverse: Vec<Mat4> =
        bones.iter().map(|bone| Mat4::from_translation(-bone.at.as_vec3())).collect();
    let skin = model.skin("skeleton", &joints, &inverse);

    let mut named: BTreeMap<&str, MaterialId> = BTreeMap::new();
    let materials = MATERIALS.map(|(name, color)| {
        *named.entry(name).or_insert_with(|| match name {
            "metal" => model.metal(name, color, 0.35),
            _ => model.material(name, color, false),
        })
    });
    let cloth = model.material("cape", 0xC92F3A, false);
    let of = |name: &str| named[name];
    let figure = cast.figure.iter().zip(materials);
    let figure: Vec<_> = figure.map(|(held, material)| (held.surface(), material)).collect();
    let hair = [(cast.locks.surface(), of("hair"))];
    let cape = [(cast.cape.surface(), cloth), (cast.clasps.surface(), of("belt"))];
    for (name, surfaces) in [("body", figure.as_slice()), ("hair", &hair), ("cape", &cape)] {
        let mesh = model.surfaces(name, surfaces, &[]);
        model.skinned(name, mesh, skin);
    }
    let shield = cast.shield.iter().zip(["metal", "suit", "belt", "mask"]);
    let shield: Vec<_> = shield.map(|(part, name)| (surface(part), of(name))).collect();
    let mesh = model.surfaces("shield", &shield, &[]);
    model.attach("shield", joints[skeleton::LOWER_ARM], mesh);
    clips::add(&mut model, &bones, &joints);
    model.camera(Vec3::new(-2.55, 1.05, 4.3), Vec3::new(0.05, 0.86, -0.05), 24.0);
    model.sun(Vec3::new(0.85, -0.58, -0.05));
    model
}

/// What the tests look at, made once.
#[cfg(test)]
fn shared_cast() -> &'static Cast {
    static CAST: std::sync::OnceLock<Cast> = std::sync::OnceLock::new();
    CAST.get_or_init(|| cast(skeleton::bones().len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over all materials, every edge has exactly two triangles, wound alike.
    #[test]
    fn the_figure_is_closed() {
        let mut edges: BTreeMap<_, (i32, i32)> = BTreeMap::new();
        for Held { part, .. } in &shared_cast().figure {
            let key = |i: u32| part.positions[i as usize].as_vec3().to_array().map(f32::to_bits);
            for t in part.indices.chunks_exact(3) {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    let (a, b) = (key(a), key(b));
                    if a < b {
                        edges.entry((a, b)).or_default().0 += 1;
                    } else {
                        edges.entry((b, a)).or_default().1 += 1;
                    }
                }
            }
        }
        let faults: Vec<_> = edges.iter().filter(|(_, uses)| **uses != (1, 1)).collect();
        assert!(edges.len() > 30_000 && faults.is_empty(), "{faults:?}");
    }

    /// 1 for an equilateral triangle, 0 for a sliver.
    fn quality([a, b, c]: [DVec3; 3]) -> f64 {
        let sides = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
        2.0 * 3f64.sqrt() * (b - a).cross(c - a).length() / sides
    }

    #[test]
    fn triangles_are_even() {
        let mut qualities = Vec::new();
        for Held { part, .. } in &shared_cast().figure {
            for t in part.indices.chunks_exact(3) {
                qualities.push(quality([0, 1, 2].map(|i| part.positions[t[i] as usize])));
            }
        }
        let mean = qualities.iter().sum::<f64>() / qualities.len() as f64;
        let worst = qualities.iter().copied().fold(1.0, f64::min);
        println!("{} triangles: mean {mean:.3}, worst {worst:.4}", qualities.len());
        assert!((20_000..60_000).contains(&qualities.len()));
        assert!(mean > 0.9 && worst > 0.02, "mean {mean}, worst {worst}");
    }

    /// Weights change smoothly: neighbours across an edge share most of their bones.
    #[test]
    fn weights_add_up_and_are_smooth() {
        for Held { part, weights } in &shared_cast().figure {
            for w in weights {
                assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-9);
                let (_, shares) = weights::quantised(w);
                assert_eq!(shares.iter().map(|&s| u32::from(s)).sum::<u32>(), 65535);
            }
            for t in part.indices.chunks_exact(3) {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let [a, b] = [t[i], t[j]].map(|i| i as usize);
                    let change: f64 =
                        weights[a].iter().zip(&weights[b]).map(|(a, b)| (a - b).abs()).sum();
                    let length = part.positions[a].distance(part.positions[b]);
                    let p = part.positions[a];
                    // Fingers bend within a shorter way.
                    let steepest = if p.x.abs() > 0.6 { 130.0 } else { 60.0 };
                    assert!(change < 0.05 + steepest * length, "{change} over {length} m at {p}");
                }
            }
        }
    }
}
