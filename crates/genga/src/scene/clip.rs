/// An animation: values of nodes over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// Name in the file; may be empty.
    pub name: String,
    /// What moves, and how.
    pub channels: Vec<Channel>,
}

impl Clip {
    /// Time of the last key in seconds; 0 without keys.
    #[must_use]
    pub fn duration(&self) -> f32 {
        self.channels.iter().filter_map(|c| c.times.last().copied()).fold(0.0, f32::max)
    }
}

/// The keys of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index of the node.
    pub node: usize,
    /// Which property.
    pub target: ChannelTarget,
    /// How values between keys are found.
    pub interpolation: Interpolation,
    /// Key times in seconds, finite and never falling.
    pub times: Vec<f32>,
    /// [`ChannelTarget::width`] numbers per key; three times as many for
    /// [`Interpolation::CubicSpline`] (in-tangent, value, out-tangent).
    pub values: Vec<f32>,
}

/// The property that a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelTarget {
    /// Three numbers, in metres.
    Translation,
    /// A quaternion x, y, z, w.
    Rotation,
    /// Three factors.
    Scale,
    /// One weight per morph target of the node's mesh.
    MorphWeights {
        /// Number of targets.
        count: usize,
    },
}

impl ChannelTarget {
    /// Numbers per value.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Self::Translation | Self::Scale => 3,
            Self::Rotation => 4,
            Self::MorphWeights { count } => count,
        }
    }
}

/// How values between keys are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The last key's value.
    Step,
    /// On a straight line (on the great circle for rotations).
    Linear,
    /// Hermite spline with the file's tangents.
    CubicSpline,
}
