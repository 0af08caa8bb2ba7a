//! In no frame of any clip, nor in the file's own pose, two triangles cut each other.
//!
//! All pairs that share no corner are tested: body, hair, cape, clasps and shield, also within each
//! and where joints fold. Left out are only locks against the head and each other, clasps against
//! the cape and the suit, and the strap against the shield: each is a closed form of its own that is
//! rooted in the other and moves with it, so that what lies inside is never seen.

use std::collections::{BTreeMap, HashMap};

use glam::DVec3;

use super::clips::{CLIPS, FPS};
use super::pose::Pose;
use super::skeleton::{
    self, Bone, CAPE, FINGER_TIPS, FINGERS, FOOT, HAND, HEAD, LOWER_ARM, LOWER_ARM_AT, LOWER_LEG,
    NECK, RIGHT, SHOULDER, THUMB, TOES, UPPER_ARM, UPPER_LEG,
};
use super::weights::Weights;
use super::{Cast, Held, poses, shared_cast};

const NAMES: [&str; 19] = [
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
    "shield",
    "locks",
    "clasps",
    "strap",
];
const CAPE_PART: usize = 14;
const SHIELD_PART: usize = 15;
const LOCKS_PART: usize = 16;
const CLASPS_PART: usize = 17;
const STRAP_PART: usize = 18;

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

/// Whether one part is rooted in the other for good: locks in the hair that they grow from, clasps
/// in the cape and the suit that they hold together, the strap in the shield.
fn rooted(pair: (usize, usize)) -> bool {
    matches!(
        pair,
        (1 | LOCKS_PART, LOCKS_PART)
            | (0 | CAPE_PART | CLASPS_PART, CLASPS_PART)
            | (SHIELD_PART, STRAP_PART)
    )
}

struct Triangles {
    points: Vec<DVec3>,
    weights: Vec<Vec<(usize, f64)>>,
    /// The first vertex at the same place of the bind pose, itself if there is none.
    same: Vec<u32>,
    /// Corners and part.
    triangles: Vec<([u32; 3], usize)>,
}

fn sparse(weights: &Weights) -> Vec<(usize, f64)> {
    weights.iter().copied().enumerate().filter(|(_, w)| *w > 1e-4).collect()
}

impl Triangles {
    /// Adds a mesh; its triangles belong to the part of their strongest bone, or to `fixed`.
    fn add(
        &mut self,
        points: &[DVec3],
        weights: &[Weights],
        indices: &[u32],
        fixed: Option<usize>,
    ) {
        let first = self.points.len() as u32;
        for t in indices.chunks_exact(3) {
            let strongest = || {
                let shares = weights[t[0] as usize].iter().enumerate();
                shares.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(bone, _)| part_of(bone))
            };
            let corners = [0, 1, 2].map(|i| t[i] + first);
            self.triangles.push((corners, fixed.unwrap_or_else(strongest)));
        }
        self.points.extend(points);
        self.weights.extend(weights.iter().map(sparse));
    }
}

fn triangles(cast: &Cast) -> Triangles {
    let mut all = Triangles {
        points: Vec::new(),
        weights: Vec::new(),
        same: Vec::new(),
        triangles: Vec::new(),
    };
    for Held { part, weights } in &cast.figure {
        all.add(&part.positions, weights, &part.indices, None);
    }
    for (held, part) in
        [(&cast.locks, LOCKS_PART), (&cast.cape, CAPE_PART), (&cast.clasps, CLASPS_PART)]
    {
        all.add(&held.part.positions, &held.weights, &held.part.indices, Some(part));
    }
    let mut on_arm = vec![0.0; CAPE + skeleton::CAPE_JOINTS];
    on_arm[LOWER_ARM] = 1.0;
    for (i, part) in cast.shield.iter().enumerate() {
        let points: Vec<DVec3> = part.positions.iter().map(|&p| p + LOWER_ARM_AT).collect();
        let weights = vec![on_arm.clone(); points.len()];
        let which = if i < 3 { SHIELD_PART } else { STRAP_PART };
        all.add(&points, &weights, &part.indices, Some(which));
    }
    let mut first: HashMap<[u64; 3], u32> = HashMap::new();
    let points = all.points.iter().enumerate();
    let key = |p: &DVec3| p.to_array().map(f64::to_bits);
    all.same = points.map(|(i, p)| *first.entry(key(p)).or_insert(i as u32)).collect();
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

/// Pairs of triangles that cut each other in a pose, by parts: how many, and where in the bind pose
/// the first one is.
fn cuts(all: &Triangles, bones: &[Bone], pose: &Pose) -> BTreeMap<(usize, usize), (usize, DVec3)> {
    const CELL: f64 = 0.02;
    let placed = pose.place(bones);
    let moved: Vec<DVec3> =
        all.points.iter().zip(&all.weights).map(|(&p, w)| placed.skinned(bones, p, w)).collect();
    let corners = |t: usize| all.triangles[t].0.map(|i| moved[i as usize]);
    let same = |t: usize| all.triangles[t].0.map(|i| all.same[i as usize]);
    let bound = |t: usize| {
        let [a, b, c] = corners(t);
        let cell = |p: DVec3| (p / CELL).floor().as_ivec3();
        (cell(a.min(b).min(c)), cell(a.max(b).max(c)))
    };
    let bounds: Vec<_> = (0..all.triangles.len()).map(bound).collect();
    let mut cells: BTreeMap<[i32; 3], Vec<usize>> = BTreeMap::new();
    for (t, &(least, most)) in bounds.iter().enumerate() {
        for x in least.x..=most.x {
            for y in least.y..=most.y {
                for z in least.z..=most.z {
                    cells.entry([x, y, z]).or_default().push(t);
                }
            }
        }
    }
    let mut found = BTreeMap::new();
    for (&cell, inside) in &cells {
        for (i, &t) in inside.iter().enumerate() {
            for &u in &inside[..i] {
                let (pt, pu) = (all.triangles[t].1, all.triangles[u].1);
                let pair = (pt.min(pu), pt.max(pu));
                // Each pair is looked at in the first cell that both reach into.
                let first = bounds[t].0.max(bounds[u].0).to_array() == cell;
                let ours = same(t);
                if rooted(pair) || !first || same(u).iter().any(|v| ours.contains(v)) {
                    continue;
                }
                let (a, b) = (corners(t), corners(u));
                let hit = (0..3)
                    .any(|k| pierces(a[k], a[(k + 1) % 3], b) || pierces(b[k], b[(k + 1) % 3], a));
                if hit {
                    let at = all.points[all.triangles[t].0[0] as usize];
                    found.entry(pair).or_insert((0, at)).0 += 1;
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
    let mut poses = vec![("the file's pose".to_owned(), poses::charge())];
    for clip in &CLIPS {
        for frame in 0..=clip.last_frame {
            poses.push((format!("{} {frame}", clip.name), (clip.pose)(frame as f64 / FPS)));
        }
    }
    let look = |(what, pose): &(String, Pose)| -> Vec<String> {
        let found = cuts(&all, &bones, pose).into_iter();
        let say = |((a, b), (count, at)): ((usize, usize), (usize, DVec3))| {
            format!("{what}: {} and {} ({count}, {at:.3})", NAMES[a], NAMES[b])
        };
        found.map(say).collect()
    };
    let faults: Vec<String> = std::thread::scope(|scope| {
        let halves = poses.chunks(poses.len().div_ceil(2));
        let threads: Vec<_> =
            halves.map(|half| scope.spawn(|| half.iter().flat_map(look).collect())).collect();
        let found = |thread: std::thread::ScopedJoinHandle<'_, Vec<String>>| thread.join().unwrap();
        threads.into_iter().flat_map(found).collect()
    });
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
