//! The whole figure as one field, and the regions of its surface.

use glam::DVec3;

use super::hand::hand;
use super::limbs::{arm, foot, leg, lower_arm, lower_leg};
use super::{face, torso};
use crate::models::sculpt::{Field, Solid, smooth_step};

/// The sculpted solids; all but the hair are for the half where x ≥ 0.
pub(super) struct Body {
    body: Solid,
    torso: Solid,
    arm: Solid,
    leg: Solid,
    head: Solid,
    hair: Solid,
}

/// The head is sculpted at an eighth of the height, and a little larger here.
const HEAD_PIVOT: DVec3 = DVec3::new(0.0, 1.69, -0.005);
const HEAD_SCALE: f64 = 1.07;

/// The place of a point of the sculpted head.
pub(super) fn from_head(p: DVec3) -> DVec3 {
    HEAD_PIVOT + (p - HEAD_PIVOT) * HEAD_SCALE
}

/// The place in the space that the head is sculpted in.
fn in_head(p: DVec3) -> DVec3 {
    HEAD_PIVOT + (p - HEAD_PIVOT) / HEAD_SCALE
}

/// Folds a point into the half where x ≥ 0, rounded by 4 mm on the head and 9 mm below, so that the
/// halves meet without a crease.
fn folded(p: DVec3) -> DVec3 {
    let round = 0.004 + 0.005 * smooth_step(1.15, 1.0, p.y);
    DVec3::new((p.x * p.x + round * round).sqrt(), p.y, p.z)
}

impl Body {
    pub(super) fn new() -> Self {
        let mut arm_and_hand = arm();
        arm_and_hand.solid(hand(), 0.010);
        let mut leg_and_foot = leg();
        leg_and_foot.solid(foot(), 0.02);
        let mut neck_and_head = torso::neck();
        neck_and_head.scaled(face::head(), HEAD_PIVOT, HEAD_SCALE, 0.012);
        let mut hair = Solid::new();
        hair.scaled(face::hair_cap(), HEAD_PIVOT, HEAD_SCALE, 0.0);
        let mut body = torso::torso();
        body.solid(neck_and_head.clone(), 0.015);
        body.solid(leg_and_foot.clone(), 0.022);
        body.solid(arm_and_hand.clone(), 0.018);
        Self {
            body,
            torso: torso::torso(),
            arm: arm_and_hand,
            leg: leg_and_foot,
            head: neck_and_head,
            hair,
        }
    }

    /// Skin and clothes without what stands off them.
    pub(super) fn body(&self, p: DVec3) -> f64 {
        self.body.at(folded(p))
    }

    pub(super) fn hair(&self, p: DVec3) -> f64 {
        self.hair.at(p)
    }

    /// Body and hair.
    pub(super) fn whole(&self, p: DVec3) -> f64 {
        // Hair that is only a film on the skin is none.
        self.body(p).min(self.hair(p))
    }

    /// Distances to trunk, arm, leg and head alone, for weights.
    pub(super) fn parts(&self, p: DVec3) -> [f64; 4] {
        let q = folded(p);
        [self.torso.at(q), self.arm.at(q), self.leg.at(q), self.head.at(q)]
    }
}

/// The longest edges, on legs and arms.
const COARSE: f64 = 0.0160;

/// The length of edges in metres that a place deserves.
pub(super) fn edge_length(p: DVec3) -> f64 {
    let q = folded(p);
    let h = in_head(q);
    let near = |center: DVec3, radius: f64| smooth_step(radius * 1.6, radius, q.distance(center));
    let on_head =
        |center: DVec3, radius: f64| smooth_step(radius * 1.6, radius, h.distance(center));
    let mut length: f64 = COARSE;
    let mut finer = |to: f64, how: f64| length = length.min(COARSE + (to - COARSE) * how);
    finer(0.0085, on_head(DVec3::new(0.0, 1.82, 0.0), 0.13));
    finer(0.0050, on_head(DVec3::new(0.0, 1.775, 0.085), 0.06));
    finer(0.0035, on_head(DVec3::new(0.031, 1.80, 0.09), 0.026));
    finer(0.0024, on_head(DVec3::new(0.0, 1.738, 0.10), 0.022));
    finer(0.0045, on_head(DVec3::new(0.078, 1.786, -0.012), 0.03));
    finer(0.0058, near(DVec3::new(0.713, 1.11, 0.07), 0.085));
    finer(0.0120, near(DVec3::new(0.165, 0.03, 0.04), 0.14));
    finer(0.0098, near(DVec3::new(0.0, 1.29, 0.09), 0.17));
    finer(0.0060, near(DVec3::new(0.0, 1.05, 0.12), 0.045));
    finer(0.0060, near(DVec3::new(0.0, 1.462, 0.10), 0.075));
    finer(0.0125, near(DVec3::new(0.23, 1.50, -0.01), 0.12));
    length
}

/// Where the surface of each material is, and where it stands off the body.
pub(super) struct Wardrobe<'a>(pub(super) &'a Body);

impl Wardrobe<'_> {
    /// Along the forearm from elbow to wrist: negative towards the hand.
    pub(super) fn glove(&self, p: DVec3) -> f64 {
        let (q, l) = (folded(p), lower_arm());
        (l.at(0.42, 0.0, 0.0) - q).dot(l.along).max(0.40 - q.x)
    }

    pub(super) fn glove_surface(&self, p: DVec3) -> f64 {
        let (q, l) = (folded(p), lower_arm());
        let below = (q - l.at(0.42, 0.0, 0.0)).dot(l.along);
        self.0.body(p) - 0.0150 * smooth_step(0.080, 0.0, below)
    }

    pub(super) fn boot(&self, p: DVec3) -> f64 {
        let (q, l) = (folded(p), lower_leg());
        let top = l.at(0.22, 0.0, 0.0);
        // A point in front.
        let peak = 0.035
            * smooth_step(0.055, 0.0, (q.x - top.x).abs())
            * smooth_step(-0.02, 0.05, q.z - top.z);
        ((top - q).dot(l.along) - peak).max(q.y - 0.6)
    }

    pub(super) fn boot_surface(&self, p: DVec3) -> f64 {
        self.0.body(p)
            - 0.0035
            - 0.013 * smooth_step(0.08, 0.0, -self.boot(p)) * smooth_step(0.1, 0.2, p.y)
    }

    pub(super) fn trunks(&self, p: DVec3) -> f64 {
        let q = folded(p);
        let low = DVec3::new(0.035, 0.895 - 0.25 * (-q.z).clamp(0.0, 0.1), q.z);
        let leg = (q - low).dot(DVec3::new(0.60, -0.80, 0.0));
        leg.max(q.y - 1.05).max(q.x - 0.3)
    }

    pub(super) fn belt(&self, p: DVec3) -> f64 {
        let middle = 1.055 - 0.06 * p.z;
        ((p.y - middle).abs() - 0.021).max(p.x.abs() - 0.25)
    }

    /// Leather does not follow muscles: it lies where they are on the mean over some centimetres.
    pub(super) fn belt_surface(&self, p: DVec3) -> f64 {
        let along = DVec3::new(p.z, 0.0, -p.x).normalize_or_zero();
        let ways = [along * 0.036, along * 0.018, DVec3::Y * 0.016];
        let sum: f64 = ways.iter().map(|&way| self.0.body(p + way) + self.0.body(p - way)).sum();
        let own = self.0.body(p);
        ((sum + own) / 7.0 - 0.0085).min(own - 0.004)
    }

    pub(super) fn buckle(&self, p: DVec3) -> f64 {
        let q = DVec3::new(p.x.abs() - 0.030, (p.y - 1.050).abs() - 0.028, 0.0);
        let d = q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - 0.006;
        d.max(-p.z)
    }

    /// Skin of head and neck down to the collar.
    pub(super) fn skin(&self, p: DVec3) -> f64 {
        // A collar that is higher behind and falls to the breastbone.
        let low = 1.586 + 8.5 * p.x * p.x - 0.22 * p.z;
        ((low - p.y) * 0.85).max(p.x.abs() - 0.15)
    }

    pub(super) fn hair(&self, p: DVec3) -> f64 {
        (self.0.hair(p) - self.0.body(p)).max(1.70 - p.y)
    }

    /// Arc length round the head's axis, and height.
    fn on_face(p: DVec3) -> (f64, f64) {
        (0.085 * libm::atan2(p.x.abs(), p.z.max(-0.05) + 0.02), p.y)
    }

    pub(super) fn mask(&self, p: DVec3) -> f64 {
        let p = in_head(p);
        let (u, y) = Self::on_face(p);
        if y < 1.70 || p.z < -0.05 {
            return 1.0;
        }
        // It ends under the sideburns.
        let behind = 0.029 - p.z;
        let upper = 1.828 + 0.010 * smooth_step(0.0, 0.075, u) + 0.004 * smooth_step(0.02, 0.0, u);
        let lower =
            1.772 + 0.008 * smooth_step(0.016, 0.0, u) + 0.022 * smooth_step(0.045, 0.11, u);
        (y - upper).max(lower - y).max(behind) * 0.9
    }

    /// It lies flatter on the nose, whose sides are steep, and on the skin where hair covers it.
    pub(super) fn mask_surface(&self, p: DVec3) -> f64 {
        let (u, _) = Self::on_face(in_head(p));
        let free = smooth_step(0.0, 0.008, self.0.hair(p) - self.0.body(p));
        self.0.body(p) - (0.0005 + 0.0018 * smooth_step(0.010, 0.026, u)) * free
    }

    pub(super) fn eye(&self, p: DVec3) -> f64 {
        let p = in_head(p);
        let (u, y) = Self::on_face(p);
        if p.z < 0.02 || y < 1.75 {
            return 1.0;
        }
        // An almond that rises outwards: between two circles.
        let t = (u - 0.0345) / 0.0225;
        let slope = 1.7985 + 0.0040 * t;
        let upper = slope + 0.0098 * (1.0 - t * t) + 0.0012 * t;
        let lower = slope - 0.0066 * (1.0 - t * t);
        (y - upper).max(lower - y).max(u - 0.057).max(0.012 - u) * 0.9
    }

    pub(super) fn mouth(&self, p: DVec3) -> f64 {
        let p = in_head(p);
        let t = p.x / 0.0255;
        if p.z < 0.05 {
            return 1.0;
        }
        let middle = 1.7390 - 0.0015 * (1.0 - t * t) + 0.0012 * smooth_step(-0.02, 0.02, p.x);
        ((p.y - middle).abs() - 0.0024 * (1.0 - t * t).max(-1.0)).max(p.x.abs() - 0.0245)
    }

    /// A star of four points on the breast.
    pub(super) fn emblem(&self, p: DVec3) -> f64 {
        if p.z < 0.0 {
            return 1.0;
        }
        let [x, y] = [p.x.abs() / 0.068, (p.y - 1.462).abs() / 0.088];
        // A superellipse with hollow sides; its slope is kept finite on the axes.
        let root = |t: f64| libm::pow(t * t + 4e-4, 0.35);
        (root(x) + root(y) - 1.06) * 0.05
    }
}
