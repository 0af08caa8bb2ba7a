//! Signed distance fields: negative inside, metres, blended by smooth unions.
//!
//! The shapes are those of Quilez, "Distance functions". Ellipsoids are near-exact close to
//! their surface only, which is all that polygonising and blending ask for.

use glam::{DMat3, DVec3};

/// Anything with a signed distance.
pub(in crate::models) trait Field {
    /// Signed distance in metres, negative inside.
    fn at(&self, p: DVec3) -> f64;
}

impl<F: Fn(DVec3) -> f64> Field for F {
    fn at(&self, p: DVec3) -> f64 {
        self(p)
    }
}

#[derive(Clone)]
enum Shape {
    /// Two spheres and the cone that touches both.
    RoundCone { a: DVec3, b: DVec3, ra: f64, rb: f64 },
    /// `local_from_world` turns into the axes.
    Ellipsoid { center: DVec3, local_from_world: DMat3, radii: DVec3 },
    /// A box with rounded edges; `half` includes the rounding.
    Block { center: DVec3, local_from_world: DMat3, half: DVec3, round: f64 },
    /// Everything on the side of a plane that the normal points away from.
    HalfSpace { point: DVec3, normal: DVec3 },
    /// Several shapes blended among themselves first, then scaled about a point.
    Solid { solid: Solid, pivot: DVec3, scale: f64 },
}

impl Shape {
    fn at(&self, p: DVec3) -> f64 {
        match self {
            Self::RoundCone { a, b, ra, rb } => round_cone(p, *a, *b, *ra, *rb),
            Self::Ellipsoid { center, local_from_world, radii } => {
                let q = *local_from_world * (p - *center) / *radii;
                let (k0, k1) = (q.length(), (q / *radii).length());
                if k1 < 1e-9 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 }
            }
            Self::Block { center, local_from_world, half, round } => {
                let q = (*local_from_world * (p - *center)).abs() - *half + DVec3::splat(*round);
                q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - round
            }
            Self::HalfSpace { point, normal } => (p - *point).dot(*normal),
            Self::Solid { solid, pivot, scale } => {
                solid.at(*pivot + (p - *pivot) / *scale) * *scale
            }
        }
    }

    /// A sphere round it: centre and radius.
    fn bound(&self) -> (DVec3, f64) {
        match self {
            Self::RoundCone { a, b, ra, rb } => {
                ((*a + *b) / 2.0, a.distance(*b) / 2.0 + ra.max(*rb))
            }
            Self::Ellipsoid { center, radii, .. } => (*center, radii.max_element()),
            Self::Block { center, half, .. } => (*center, half.length()),
            Self::HalfSpace { .. } => (DVec3::ZERO, f64::INFINITY),
            Self::Solid { solid, pivot, scale } => {
                let add = solid.items.iter().filter(|item| !item.carve);
                let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                for item in add {
                    least = least.min(item.center - DVec3::splat(item.reach));
                    most = most.max(item.center + DVec3::splat(item.reach));
                }
                let center = *pivot + ((least + most) / 2.0 - *pivot) * *scale;
                (center, (most - least).length() / 2.0 * *scale)
            }
        }
    }
}

#[derive(Clone)]
struct Item {
    shape: Shape,
    blend: f64,
    carve: bool,
    center: DVec3,
    reach: f64,
}

/// Shapes added to or carved from each other in order, each with its own radius of blending.
#[derive(Clone, Default)]
pub(in crate::models) struct Solid {
    items: Vec<Item>,
}

impl Field for Solid {
    fn at(&self, p: DVec3) -> f64 {
        let mut d = 1e9;
        for item in &self.items {
            // What is too far off to change anything is skipped.
            let least = p.distance(item.center) - item.reach;
            if item.carve {
                if least <= item.blend - d + 0.01 {
                    d = -smooth_min(-d, item.shape.at(p), item.blend);
                }
            } else if least <= d.max(0.0) + 2.0 * item.blend + 0.01 {
                d = smooth_min(d, item.shape.at(p), item.blend);
            }
        }
        d
    }
}

impl Solid {
    /// Nothing yet.
    pub(in crate::models) fn new() -> Self {
        Self::default()
    }

    fn push(&mut self, shape: Shape, blend: f64, carve: bool) -> &mut Self {
        let (center, reach) = shape.bound();
        self.items.push(Item { shape, blend, carve, center, reach });
        self
    }

    /// Adds two spheres and the cone between them.
    pub(in crate::models) fn cone(
        &mut self,
        a: DVec3,
        ra: f64,
        b: DVec3,
        rb: f64,
        blend: f64,
    ) -> &mut Self {
        self.push(Shape::RoundCone { a, b, ra, rb }, blend, false)
    }

    /// Adds an ellipsoid; the columns of `axes` are its unit axes.
    pub(in crate::models) fn ellipsoid(
        &mut self,
        center: DVec3,
        radii: DVec3,
        axes: DMat3,
        blend: f64,
    ) -> &mut Self {
        let local_from_world = axes.transpose();
        self.push(Shape::Ellipsoid { center, local_from_world, radii }, blend, false)
    }

    /// Adds a box with rounded edges.
    pub(in crate::models) fn block(
        &mut self,
        center: DVec3,
        half: DVec3,
        axes: DMat3,
        round: f64,
        blend: f64,
    ) -> &mut Self {
        let local_from_world = axes.transpose();
        self.push(Shape::Block { center, local_from_world, half, round }, blend, false)
    }

    /// Carves an ellipsoid out.
    pub(in crate::models) fn carve_ellipsoid(
        &mut self,
        center: DVec3,
        radii: DVec3,
        axes: DMat3,
        blend: f64,
    ) -> &mut Self {
        let local_from_world = axes.transpose();
        self.push(Shape::Ellipsoid { center, local_from_world, radii }, blend, true)
    }

    /// Carves a groove along a line.
    pub(in crate::models) fn carve_cone(
        &mut self,
        a: DVec3,
        ra: f64,
        b: DVec3,
        rb: f64,
        blend: f64,
    ) -> &mut Self {
        self.push(Shape::RoundCone { a, b, ra, rb }, blend, true)
    }

    /// Cuts away everything on the side of the plane that `normal` points to.
    pub(in crate::models) fn cut(&mut self, point: DVec3, normal: DVec3, blend: f64) -> &mut Self {
        self.push(Shape::HalfSpace { point, normal: -normal.normalize() }, blend, true)
    }

    /// Adds shapes that were blended among themselves.
    pub(in crate::models) fn solid(&mut self, solid: Solid, blend: f64) -> &mut Self {
        self.scaled(solid, DVec3::ZERO, 1.0, blend)
    }

    /// Adds shapes that were blended among themselves, scaled about a point.
    pub(in crate::models) fn scaled(
        &mut self,
        solid: Solid,
        pivot: DVec3,
        scale: f64,
        blend: f64,
    ) -> &mut Self {
        self.push(Shape::Solid { solid, pivot, scale }, blend, false)
    }
}

/// Quilez's quadratic smooth minimum; equals the minimum where the two differ by `k` or more.
fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    if k <= 0.0 {
        return a.min(b);
    }
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k / 4.0
}

fn round_cone(p: DVec3, a: DVec3, b: DVec3, ra: f64, rb: f64) -> f64 {
    let ba = b - a;
    let l2 = ba.length_squared();
    let rr = ra - rb;
    let a2 = l2 - rr * rr;
    if a2 <= 0.0 {
        // One sphere holds the other.
        return if ra > rb { p.distance(a) - ra } else { p.distance(b) - rb };
    }
    let il2 = 1.0 / l2;
    let pa = p - a;
    let y = pa.dot(ba);
    let z = y - l2;
    let x2 = (pa * l2 - ba * y).length_squared();
    let (y2, z2) = (y * y * l2, z * z * l2);
    let k = rr.signum() * rr * rr * x2;
    if z.signum() * a2 * z2 > k {
        return (x2 + z2).sqrt() * il2 - rb;
    }
    if y.signum() * a2 * y2 < k {
        return (x2 + y2).sqrt() * il2 - ra;
    }
    ((x2 * a2 * il2).sqrt() + y * rr) * il2 - ra
}

/// The gradient by central differences.
pub(in crate::models) fn gradient(field: &dyn Field, p: DVec3) -> DVec3 {
    const H: f64 = 2e-4;
    let slope = |axis: DVec3| field.at(p + axis * H) - field.at(p - axis * H);
    DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)) / (2.0 * H)
}

/// The point nearby where the field is zero, by a few Newton steps, none longer than 1 cm.
pub(in crate::models) fn project(field: &dyn Field, mut p: DVec3) -> DVec3 {
    for _ in 0..4 {
        let d = field.at(p);
        if d.abs() < 1e-6 {
            break;
        }
        let g = gradient(field, p);
        p -= (g * (d / g.length_squared().max(0.05))).clamp_length_max(0.01);
    }
    p
}

/// 0 below `from`, 1 above `to`, the cubic between.
pub(in crate::models) fn smooth_step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
