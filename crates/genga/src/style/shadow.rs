use schemars::JsonSchema;
use serde::Deserialize;

/// Shadows that things cast on each other and on themselves. They pass through the ramp: where a
/// light does not reach, its part of the ramp coordinate is at most `tone`, so a cast shadow has
/// the tones and edges of a form shadow.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Shadow {
    /// Whether lights cast shadows. Without them they cost nothing.
    pub enabled: bool,
    /// The ramp coordinate in a cast shadow: `T = min(T, tone)`, in [0, 1].
    #[schemars(range(min = 0, max = 1))]
    pub tone: f32,
    /// Whether shadows fall on surfaces.
    pub receive: bool,
    /// Most texels along a side of a light's shadow map. Small pictures need fewer, and take fewer;
    /// parallel light onto deep scenes has several maps, from near to far.
    #[schemars(range(min = 256, max = 8192))]
    pub resolution: u32,
}

impl Default for Shadow {
    fn default() -> Self {
        Self { enabled: false, tone: 0.4, receive: true, resolution: 2048 }
    }
}

/// Changes to [`Shadow`] for a part of the scene; what is `None` stays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ShadowOverride {
    /// The ramp coordinate in a cast shadow, in [0, 1].
    #[schemars(range(min = 0, max = 1))]
    pub tone: Option<f32>,
    /// Whether shadows fall on it: a face without them stays clean.
    pub receive: Option<bool>,
    /// Whether it casts shadows. Without effect where the selector looks at colours.
    pub cast: Option<bool>,
}
