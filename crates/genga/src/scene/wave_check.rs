//! Whether a wave can be drawn.

use glam::Vec3;

use super::{Wave, WaveAnchor, WavePlacement, WaveShape, wave_curve::WaveCurve};

/// Most control points of a Bézier curve: its binomials must stay in the range of f32.
const MAX_BEZIER_POINTS: usize = 101;
/// Largest order of a B-spline.
const MAX_ORDER: usize = 16;
/// Most points of the other curves.
const MAX_POINTS: usize = 10_000;
/// Largest coordinate or length in metres.
const LARGEST: f32 = 1e6;

impl Wave {
    /// What is wrong with it, as the rest of a sentence that begins with the wave.
    ///
    /// `nodes` is the number of nodes that anchors may refer to.
    ///
    /// # Errors
    /// A part of a sentence such as "must have …".
    pub fn check(&self, nodes: usize) -> Result<(), String> {
        let numbers = [
            ("alpha", self.alpha, 0.0),
            ("core", self.core, 0.0),
            ("radius", self.radius.unwrap_or(1.0), 1e-6),
            ("attenuation", self.attenuation, 0.0),
            ("swell at the tail", self.swell[0], 0.0),
            ("swell at the head", self.swell[1], 0.0),
            ("noise amplitude", self.noise.amplitude, 0.0),
            ("noise frequency", self.noise.frequency, 0.0),
        ];
        if !(1e-4..=0.1).contains(&self.tolerance) {
            return Err(format!("has the tolerance {}: it must be 0.0001 to 0.1", self.tolerance));
        }
        for (name, value, least) in numbers {
            if !(value >= least && value <= LARGEST) {
                return Err(format!("has the {name} {value}: it must be {least} to {LARGEST}"));
            }
        }
        if !(self.reach >= 1e-6 && self.reach <= 1e12) {
            return Err(format!("has the reach {}: it must be over 0 and up to 1e12", self.reach));
        }
        let colors = self.ramp.iter().map(|tone| tone.color).chain([self.color]);
        if colors.into_iter().any(|color| !color.is_finite() || color.min_element() < 0.0) {
            return Err("has a colour that is negative or not a number".to_owned());
        }
        let [tail, head] = self.growth;
        if !(0.0 <= tail && tail <= head && head <= 1.0) {
            return Err(format!(
                "grows from {tail} to {head}: both must be 0 to 1, the first one not larger"
            ));
        }
        if self
            .profile
            .iter()
            .any(|[s, factor]| !((0.0..=1.0).contains(s) && *factor >= 0.0 && *factor <= LARGEST))
            || self.profile.windows(2).any(|pair| pair[0][0] >= pair[1][0])
        {
            return Err(
                "has a profile whose places do not rise from 0 to 1, or whose factors are \
                        not 0 or more"
                    .to_owned(),
            );
        }
        let energies = || self.ramp.iter().map(|tone| tone.energy);
        if energies().any(|e| !(e > 0.0 && e <= LARGEST))
            || self.ramp.windows(2).any(|pair| pair[0].energy >= pair[1].energy)
            || self.ramp.len() > 16
        {
            return Err(
                "has a ramp that is not at most 16 colours at rising energies over 0".into()
            );
        }
        if !self.noise.phase.is_finite() || self.noise.frequency > 4000.0 {
            return Err("has noise with a phase that is no number, or over 4000 bends".to_owned());
        }
        self.check_placement(nodes)?;
        self.check_shape()
    }

    fn check_placement(&self, nodes: usize) -> Result<(), String> {
        let anchor = |anchor: &WaveAnchor| {
            if let Some(node) = anchor.nodes.iter().find(|&&node| node >= nodes) {
                return Err(format!("holds on to node {node}, but there are only {nodes} nodes"));
            }
            in_range("offset", &[anchor.offset])
        };
        match &self.placement {
            WavePlacement::At { anchor: at, direction, roll, .. } => {
                anchor(at)?;
                let is_usable = direction.is_finite() && direction.length() > 1e-6;
                if !(is_usable && roll.is_finite()) {
                    return Err(format!("has the direction {direction}: it must not be zero"));
                }
            }
            WavePlacement::Between { from, to, roll } => {
                anchor(from)?;
                anchor(to)?;
                let has_length = match self.shape {
                    WaveShape::Sphere => false,
                    WaveShape::Cylinder { length } => length.is_some(),
                    _ => true,
                };
                if !has_length || !roll.is_finite() {
                    return Err("is stretched between two places, but has no length".to_owned());
                }
            }
        }
        Ok(())
    }

    fn check_shape(&self) -> Result<(), String> {
        let length = |length: f32| {
            let is_right = length > 1e-6 && length <= LARGEST;
            let wrong =
                || format!("has the length {length}: it must be over 0 and up to {LARGEST}");
            if is_right { Ok(()) } else { Err(wrong()) }
        };
        let turning = |turns: f32| {
            let wrong = || format!("has {turns} turns: they must be −1000 to 1000");
            if turns.abs() <= 1000.0 { Ok(()) } else { Err(wrong()) }
        };
        match &self.shape {
            WaveShape::Sphere | WaveShape::Cylinder { length: None } => Ok(()),
            WaveShape::Cylinder { length: Some(l) } | WaveShape::Capsule { length: l } => {
                length(*l)
            }
            WaveShape::Helix { length: l, radius, turns, phase } => {
                length(*l)?;
                turning(*turns)?;
                if !((0.0..=LARGEST).contains(radius) && phase.is_finite()) {
                    return Err(format!("has the radius {radius}: it must be 0 to {LARGEST}"));
                }
                Ok(())
            }
            WaveShape::Trig { length: l, turns, y, z } => {
                length(*l)?;
                turning(*turns)?;
                let count = y.len().max(z.len());
                if count > MAX_POINTS {
                    return Err(format!(
                        "has {count} terms on an axis: it can have up to {MAX_POINTS}"
                    ));
                }
                let mut terms = y.iter().chain(z).flatten();
                if let Some(term) = terms.find(|t| t.is_nan() || t.abs() > LARGEST) {
                    return Err(format!(
                        "has the term {term}: its numbers must be −{LARGEST} to {LARGEST}"
                    ));
                }
                Ok(())
            }
            WaveShape::Bezier { points } => self.check_points(points, MAX_BEZIER_POINTS),
            WaveShape::BSpline { points, order, knots } => {
                check_knots(points.len(), *order, knots)?;
                self.check_points(points, MAX_POINTS)
            }
            WaveShape::Polyline { points } => self.check_points(points, MAX_POINTS + 1),
        }
    }

    fn check_points(&self, points: &[Vec3], most: usize) -> Result<(), String> {
        if points.len() < 2 || points.len() > most {
            let count = points.len();
            return Err(format!("has {count} control points: it must have 2 to {most}"));
        }
        in_range("control point", points)?;
        let extent = points.iter().fold(0.0_f32, |m, p| m.max((*p - points[0]).length()));
        if points[0].distance(points[points.len() - 1]) <= 1e-6 * extent.max(1e-3) {
            return Err("begins and ends in the same place, so it has no direction".to_owned());
        }
        let curve = WaveCurve::new(self);
        // A rising control polygon makes a rising curve.
        if curve.points.windows(2).all(|pair| pair[0].x < pair[1].x) {
            return Ok(());
        }
        let steps = (32 * points.len()).clamp(256, 8192);
        let mut before = curve.at(0.0).x;
        for i in 1..=steps {
            let s = i as f64 / steps as f64;
            let x = curve.at(s).x;
            if x <= before {
                return Err(format!(
                    "folds back along its direction at s = {s:.3}, where a place would have two \
                     glows: move its points, or make two waves of it"
                ));
            }
            before = x;
        }
        Ok(())
    }
}

fn in_range(what: &str, points: &[Vec3]) -> Result<(), String> {
    match points.iter().find(|p| p.is_nan() || p.abs().max_element() > LARGEST) {
        Some(point) => {
            Err(format!("has the {what} {point}: its numbers must be −{LARGEST} to {LARGEST}"))
        }
        None => Ok(()),
    }
}

fn check_knots(points: usize, order: usize, knots: &[f32]) -> Result<(), String> {
    if order < 2 || order > points.min(MAX_ORDER) {
        let most = points.min(MAX_ORDER);
        return Err(format!("has the order {order}: with {points} points it must be 2 to {most}"));
    }
    if knots.is_empty() {
        return Ok(());
    }
    let wanted = points + order;
    if knots.len() != wanted {
        return Err(format!(
            "has {} knots: {points} points of order {order} need {wanted}",
            knots.len()
        ));
    }
    if let Some(i) =
        knots.windows(2).position(|pair| pair[0].is_nan() || pair[1].is_nan() || pair[0] > pair[1])
    {
        let (a, b) = (knots[i], knots[i + 1]);
        return Err(format!("has the knots {a} and {b} one after the other: they must not fall"));
    }
    if !knots.iter().all(|k| k.abs() <= LARGEST) || knots[order - 1] >= knots[points] {
        return Err("has knots without any span between them".to_owned());
    }
    // As many equal knots as the order tear the curve apart.
    let inner = &knots[1..knots.len() - 1];
    if let Some(run) = inner.windows(order).find(|run| run[0] == run[order - 1])
        && run[0] > knots[order - 1]
        && run[0] < knots[points]
    {
        return Err(format!(
            "has the knot {} {order} times: at order {order} that tears the curve apart",
            run[0]
        ));
    }
    Ok(())
}
