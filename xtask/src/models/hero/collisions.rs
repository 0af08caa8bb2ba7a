//! No frame of any clip, nor the file's own pose, has parts that cut through each other.
//!
//! Parts that a joint connects may fold at the joint; all others are tested triangle against
//! triangle.

use std::collections::{BTreeMap, HashMap};

use glam::{DVec3, IVec3};

use super::clips::{CLIPS, FPS};
use super::pose::Pose;
use super::skeleton::{
    self, Bone, CAPE, FINGER_TIPS, FINGERS, FOOT, HAND, HEAD, LOWER_ARM, LOWER_ARM_AT, LOWER_LEG,
    NECK, RIGHT, SHOULDER, THUMB, TOES, UPPER_ARM, UPPER_LEG,
};
use super::weights::Weights;
use super::{Cast, poses, shared_cast};

const NAMES: [&str; 15] = [
    "trunk",
    "head",
    "left upper arm",
    "left forearm",
    "left hand",
    "left thigh",
    "left shin",
    "left foot",
    "right upper arm",
    "right forearm",
    "right hand",
    "right thigh",
    "right shin",
    "right foot",
    "cape",
];
const CAPE_PART: usize = 14;
const SHIELD_PART: usize = 15;

/// The part that a bone moves.
fn part_of(bone: usize) -> usize {
    if bone >= CAPE {
        return CAPE_PART;
    }
    let (left, side) = if bone >= SHOULDER + RIGHT { (bone - RIGHT, 6) } else { (bone, 0) };
    match left {
        NECK | HEAD => 1,
        UPPER_ARM => 2 + side,
        LOWER_ARM => 3 + side,
        HAND | FINGERS | FINGER_TIPS | THUMB => 4 + side,
        UPPER_LEG => 5 + side,
        LOWER_LEG => 6 + side,
        FOOT | TOES => 7 + side,
        _ => 0,
    }
}

/// Whether a joint or a strap connects two parts.
fn connected(a: usize, b: usize) -> bool {
    let (a, b) = (a.min(b), a.max(b));
    matches!(
        (a, b),
        (0, 1 | 2 | 5 | 8 | 11)
            | (2, 3)
            | (3, 4)
            | (5, 6)
            | (6, 7)
            | (8, 9)
            | (9, 10)
            | (11, 12)
            | (12, 13)
            | (3 | 4, SHIELD_PART)
    ) || a == b
}

struct Triangles {
    points: Vec<DVec3>,
    weights: Vec<Vec<(usize, f64)>>,
    /// Corners and part.
    triangles: Vec<([u32; 3], usize)>,
}

fn sparse(weights: &Weights) -> Vec<(usize, f64)> {
    weights.iter().copied().enumerate().filter(|(_, w)| *w > 1e-4).collect()
}

fn triangles(cast: &Cast) -> Triangles {
    let mut all = Triangles { points: Vec::new(), weights: Vec::new(), triangles: Vec::new() };
    let mut add = |points: &[DVec3],
                   weights: Vec<Vec<(usize, f64)>>,
                   indices: &[u32],
                   fixed: Option<usize>| {
        let first = all.points.len() as u32;
        for t in indices.chunks_exact(3) {
            let strongest = || {
                let w = weights[t[0] as usize].iter().max_by(|a, b| a.1.total_cmp(&b.1));
                w.map_or(0, |w| part_of(w.0))
            };
            let corners = [0, 1, 2].map(|i| t[i] + first);
            all.triangles.push((corners, fixed.unwrap_or_else(strongest)));
        }
        all.points.extend(points);
        all.weights.extend(weights);
    };
    for held in &cast.figure {
        let weights = held.weights.iter().map(sparse).collect();
        add(&held.part.positions, weights, &held.part.indices, None);
    }
    let weights = cast.cape.weights.iter().map(sparse).collect();
    add(&cast.cape.part.positions, weights, &cast.cape.part.indices, Some(CAPE_PART));
    for part in &cast.shield {
        let points: Vec<DVec3> = part.positions.iter().map(|&p| p + LOWER_ARM_AT).collect();
        let weights = vec![vec![(LOWER_ARM, 1.0)]; points.len()];
        add(&points, weights, &part.indices, Some(SHIELD_PART));
    }
    all
}

/// Whether the segment goes through the triangle.
fn pierces(a: DVec3, b: DVec3, [p, q, r]: [DVec3; 3]) -> bool {
    let (e1, e2, d) = (q - p, r - p, b - a);
    let h = d.cross(e2);
    let det = e1.dot(h);
    if det.abs() < 1e-16 {
        return false;
    }
    let s = a - p;
    let u = s.dot(h) / det;
    let k = s.cross(e1);
    let v = d.dot(k) / det;
    let t = e2.dot(k) / det;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}

/// How often triangles of each pair of unconnected parts cut each other.
fn cuts(all: &Triangles, bones: &[Bone], pose: &Pose) -> BTreeMap<(usize, usize), usize> {
    const CELL: f64 = 0.03;
    let placed = pose.place(bones);
    let moved: Vec<DVec3> =
        all.points.iter().zip(&all.weights).map(|(&p, w)| placed.skinned(bones, p, w)).collect();
    let corners = |t: usize| all.triangles[t].0.map(|i| moved[i as usize]);
    let mut cells: HashMap<IVec3, Vec<usize>> = HashMap::new();
    for t in 0..all.triangles.len() {
        let [a, b, c] = corners(t);
        let least = (a.min(b).min(c) / CELL).floor().as_ivec3();
        let most = (a.max(b).max(c) / CELL).floor().as_ivec3();
        for x in least.x..=most.x {
            for y in least.y..=most.y {
                for z in least.z..=most.z {
                    cells.entry(IVec3::new(x, y, z)).or_default().push(t);
                }
            }
        }
    }
    let mut found = BTreeMap::new();
    for inside in cells.values() {
        for (i, &t) in inside.iter().enumerate() {
            for &u in &inside[..i] {
                let (pt, pu) = (all.triangles[t].1, all.triangles[u].1);
                if connected(pt, pu) {
                    continue;
                }
                let (a, b) = (corners(t), corners(u));
                let hit = (0..3)
                    .any(|k| pierces(a[k], a[(k + 1) % 3], b) || pierces(b[k], b[(k + 1) % 3], a));
                if hit {
                    *found.entry((pt.min(pu), pt.max(pu))).or_insert(0) += 1;
                }
            }
        }
    }
    found
}

#[test]
fn no_frame_cuts_through_itself() {
    let bones = skeleton::bones();
    let all = triangles(shared_cast());
    let name = |part: usize| NAMES.get(part).copied().unwrap_or("shield");
    let mut faults = Vec::new();
    let mut look = |what: String, pose: &Pose| {
        for ((a, b), count) in cuts(&all, &bones, pose) {
            faults.push(format!("{what}: {} and {} ({count})", name(a), name(b)));
        }
    };
    look("the file's pose".to_owned(), &poses::charge());
    for clip in &CLIPS {
        for frame in 0..=clip.last_frame {
            look(format!("{} {frame}", clip.name), &(clip.pose)(frame as f64 / FPS));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The test above can fail: an arm through the trunk is found.
#[test]
fn an_arm_through_the_trunk_is_found() {
    let bones = skeleton::bones();
    let all = triangles(shared_cast());
    let mut pose = poses::charge();
    pose.arms[1].wrist = DVec3::new(0.0, 1.2, -0.05);
    assert!(cuts(&all, &bones, &pose).contains_key(&(0, 9)));
}
