//! What a line's width depends on beside the line set's own width.

use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// Most points of a curve.
const MAX_CURVE_POINTS: usize = 16;

/// A factor as straight pieces between points `[x, factor]`, x rising; it stays as it is before
/// the first and after the last point.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Curve(
    #[serde(deserialize_with = "points")]
    #[schemars(length(min = 1, max = 16))]
    Vec<[f32; 2]>,
);

impl Curve {
    /// A curve through points `[x, factor]`.
    ///
    /// # Errors
    /// A sentence if there are no or more than 16 points, x does not rise, a factor is negative,
    /// or a number is not finite.
    pub fn new(points: Vec<[f32; 2]>) -> Result<Self, String> {
        if points.is_empty() || points.len() > MAX_CURVE_POINTS {
            return Err(format!("must have 1 to {MAX_CURVE_POINTS} points, not {}", points.len()));
        }
        if points.iter().flatten().any(|n| !n.is_finite()) {
            return Err("must have finite numbers only".to_owned());
        }
        if let Some([_, factor]) = points.iter().find(|[_, factor]| *factor < 0.0) {
            return Err(format!("must have factors of 0 or more, not {factor}"));
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
            return Err(format!(
                "must have points with rising x, not {} after {}",
                pair[1][0], pair[0][0]
            ));
        }
        Ok(Self(points))
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[[f32; 2]] {
        &self.0
    }

    /// The factor at `x`.
    #[must_use]
    pub fn at(&self, x: f32) -> f32 {
        let after = self.0.partition_point(|p| p[0] < x);
        match (after.checked_sub(1).map(|i| self.0[i]), self.0.get(after)) {
            (Some([x0, y0]), Some(&[x1, y1])) => y0 + (y1 - y0) * ((x - x0) / (x1 - x0)),
            (Some([_, y]), None) | (None, Some(&[_, y])) => y,
            (None, None) => 1.0,
        }
    }

    /// Largest factor.
    #[must_use]
    pub fn largest(&self) -> f32 {
        self.0.iter().map(|p| p[1]).fold(0.0, f32::max)
    }
}

fn points<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<[f32; 2]>, D::Error> {
    let points = Vec::<[f32; 2]>::deserialize(deserializer)?;
    Curve::new(points).map(|curve| curve.0).map_err(D::Error::custom)
}

/// Curves whose factors are multiplied with a line's width, beside the vertices' own
/// (`_LINE_WIDTH`) and the overrides'. What is left out changes nothing.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WidthBy {
    /// Over the distance along the camera's axis in metres.
    pub depth: Option<Curve>,
    /// Name of the object (node) from whose distance `depth` counts, positive behind it, instead
    /// of from the camera.
    pub depth_from: Option<String>,
    /// Over the mean curvature of the rest mesh in 1/m (Okuya et al. 2015, section 4.3); convex
    /// places have positive ones.
    pub curvature: Option<Curve>,
    /// Over the line's own curvature on the picture, as hundred pixels (at `reference_height`)
    /// over its radius: 0 on straight lines.
    pub screen_curvature: Option<Curve>,
    /// Over the ramp coordinate T: 0 is turned away from the light, 1 faces it.
    pub light: Option<Curve>,
    /// Over the distance from the nearer end of the stroke in pixels at `reference_height`.
    /// Closed strokes have no end.
    pub taper: Option<Curve>,
}

/// An unsteady hand. Sticks to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Wobble {
    /// Largest way off the line in pixels at `reference_height`.
    #[schemars(range(min = 0, max = 64))]
    pub amplitude: f32,
    /// Typical distance between two bends in pixels at `reference_height`.
    #[schemars(range(min = 4))]
    pub wavelength: f32,
    /// Another number is another hand.
    pub seed: u32,
    /// Frames after which the line is drawn anew ("line boil"); 0 is never.
    pub redraw_every: u32,
}

impl Default for Wobble {
    fn default() -> Self {
        Self { amplitude: 1.5, wavelength: 60.0, seed: 0, redraw_every: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_straight_between_its_points_and_level_outside() {
        let curve = Curve::new(vec![[1.0, 2.0], [3.0, 0.0]]).expect("a curve");
        for (x, y) in [(0.0, 2.0), (1.0, 2.0), (2.0, 1.0), (2.5, 0.5), (3.0, 0.0), (9.0, 0.0)] {
            assert!((curve.at(x) - y).abs() < 1e-6, "{x}");
        }
        assert!((curve.largest() - 2.0).abs() < 1e-6);
    }

    #[test]
    fn impossible_curves_are_refused_with_a_sentence() {
        let error = |points: &[[f32; 2]]| Curve::new(points.to_vec()).expect_err("no curve");
        assert_eq!(error(&[]), "must have 1 to 16 points, not 0");
        assert_eq!(
            error(&[[1.0, 1.0], [1.0, 2.0]]),
            "must have points with rising x, not 1 after 1"
        );
        assert_eq!(error(&[[0.0, -1.0]]), "must have factors of 0 or more, not -1");
        assert_eq!(error(&[[0.0, f32::NAN]]), "must have finite numbers only");
    }
}
