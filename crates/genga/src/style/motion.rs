use schemars::JsonSchema;
use serde::Deserialize;

use super::Globs;

/// How motion is drawn: as comics do, by speed lines behind what is fast, and by smears.
///
/// Both come from where surfaces are and where they were while the shutter was open, which ends at the
/// moment drawn. What stands still has neither, and where both are off they cost nothing.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Motion {
    /// For how long the shutter is open.
    pub shutter: Shutter,
    /// Trailing strokes; none by default. The methods `contour` and `reference` draw them.
    pub speed_lines: Option<SpeedLines>,
    /// Surfaces drawn out backwards; not by default.
    pub smear: Option<Smear>,
}

/// A shutter as cameras have it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Shutter {
    /// Part of a frame in degrees; 360 is a whole one, and more is longer than cameras can.
    #[schemars(range(min = 0, max = 36000))]
    pub angle_deg: f32,
    /// Frames per second that the angle is part of; the speed of an animation is its own.
    #[schemars(range(min = 1, max = 1000))]
    pub fps: f32,
}

impl Default for Shutter {
    fn default() -> Self {
        Self { angle_deg: 360.0, fps: 24.0 }
    }
}

/// Strokes that trail behind fast surfaces along the way that these have come, drawn as a part of a
/// line set: in its colour, at its width.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpeedLines {
    /// Name of the line set; the last one by default.
    pub set: Option<String>,
    /// Globs of objects that have them, of those that the set draws; all by default.
    pub objects: Globs,
    /// Globs of materials, likewise.
    pub materials: Globs,
    /// Strokes per square metre of surface, of which those on the trailing side are drawn.
    #[schemars(range(min = 0, max = 1e6))]
    pub density: f32,
    /// Metres per second from which surfaces have them; they reach their width at half as much again.
    #[schemars(range(min = 0, max = 1e6))]
    pub threshold: f32,
    /// Factor on the set's width.
    #[schemars(range(min = 0, max = 100))]
    pub width: f32,
    /// Factor on the way that a surface has come: 1 is speed times shutter.
    #[schemars(range(min = 0, max = 100))]
    pub length: f32,
    /// How much shorter some are: 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub irregularity: f32,
    /// Which of the many places.
    pub seed: u32,
}

impl SpeedLines {
    /// Whether an object and material have them, as far as their names go.
    #[must_use]
    pub fn matches(&self, object: &str, material: &str) -> bool {
        self.objects.matches(object) && self.materials.matches(material)
    }
}

impl Default for SpeedLines {
    fn default() -> Self {
        Self {
            set: None,
            objects: Globs::default(),
            materials: Globs::default(),
            density: 80.0,
            threshold: 1.0,
            width: 1.0,
            length: 1.0,
            irregularity: 0.5,
            seed: 0,
        }
    }
}

/// Surfaces whose trailing side is drawn out backwards in streaks.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Smear {
    /// Globs of objects that smear; all by default.
    pub objects: Globs,
    /// Globs of materials that do; all by default.
    pub materials: Globs,
    /// Part of the way that the trailing side is left behind.
    #[schemars(range(min = 0, max = 10))]
    pub amount: f32,
    /// Metres per second from which surfaces smear; fully at half as much again.
    #[schemars(range(min = 0, max = 1e6))]
    pub threshold: f32,
    /// How uneven the streaks are: 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub noise: f32,
    /// Metres from streak to streak.
    #[schemars(range(min = 1e-4, max = 1e4))]
    pub spacing: f32,
    /// Which of the many.
    pub seed: u32,
}

impl Default for Smear {
    fn default() -> Self {
        let (objects, materials) = (Globs::default(), Globs::default());
        Self { objects, materials, amount: 0.7, threshold: 1.0, noise: 0.7, spacing: 0.05, seed: 0 }
    }
}

/// Moments of the past that ways are made of.
const STEPS: u16 = 8;

impl Motion {
    /// Whether anything of it is drawn.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        self.shutter_s() > 0.0 && (self.speed_lines.is_some() || self.smear.is_some())
    }

    /// Seconds for which the shutter is open.
    #[must_use]
    pub fn shutter_s(&self) -> f32 {
        let Shutter { angle_deg, fps } = self.shutter;
        if angle_deg > 0.0 && fps > 0.0 { angle_deg / 360.0 / fps } else { 0.0 }
    }

    /// The moments at which poses are wanted for `Renderer::set_motion`, in seconds before the one
    /// drawn, rising, at even steps; the last one is the shutter's opening. Empty if nothing of it
    /// is drawn.
    #[must_use]
    pub fn moments(&self) -> Vec<f32> {
        let steps = if self.is_drawn() { STEPS } else { 0 };
        let step = self.shutter_s() / f32::from(STEPS);
        (1..=steps).map(|i| step * f32::from(i)).collect()
    }
}
