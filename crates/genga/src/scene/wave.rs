use glam::{Vec3, Vec4};

/// Most waves of a scene.
pub const MAX_WAVES: usize = 240;

/// A glow along a curve: an energy wave (Abe 2024).
///
/// A point at distance r from the place of the curve that it is paired with has the density
/// `α (1/√(r² + ε²) − 1/√(R² + ε²))` within the radius R, and none beyond. A view ray collects
/// `∫ density · (1 − distance/reach)^j` over its length in metres, up to the scene's surface; that
/// energy times the colour is added to the picture.
///
/// A point is paired with the place of the curve that has the same coordinate along the curve's
/// main direction; before the beginning and beyond the end, with the end itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Wave {
    /// Name for messages; may be empty.
    pub name: String,
    /// The curve.
    pub shape: WaveShape,
    /// Where it is.
    pub placement: WavePlacement,
    /// α: brightness, ≥ 0.
    pub alpha: f32,
    /// Factors on α along the curve: (s from 0 to 1, factor ≥ 0), s rising, linear in between.
    /// Empty for 1 everywhere.
    pub profile: Vec<[f32; 2]>,
    /// ε: half width of the soft core in metres, ≥ 0. It is at least half a pixel, before the near
    /// plane half a pixel of that.
    pub core: f32,
    /// R: the glow ends there, in metres, > 0; `None` for a glow without an end.
    pub radius: Option<f32>,
    /// Largest relative error of the energy, 1e-4 to 0.1. What is less than 1/255 of the brightest
    /// place is exact only to that part of it.
    pub tolerance: f32,
    /// Length of view rays in metres, > 0.
    pub reach: f32,
    /// j ≥ 0: how fast the energy fades along view rays; 0 for not at all.
    pub attenuation: f32,
    /// Colour of the energy 1, straight alpha, as displayed (sRGB-encoded); alpha is a factor.
    pub color: Vec4,
    /// Colours over the energy instead of `color`, by rising energies > 0. Linear in between, from
    /// black at 0; in proportion to the energy beyond the last one.
    pub ramp: Vec<WaveTone>,
    /// The part of the curve that is there: its tail and its head, 0 ≤ tail ≤ head ≤ 1.
    pub growth: [f32; 2],
    /// α of additional spheres at tail and head, ≥ 0: swelling ends.
    pub swell: [f32; 2],
    /// Whether surfaces hide what is behind them.
    pub occluded: bool,
    /// How it lies over surfaces and lines.
    pub order: WaveOrder,
    /// Whether it is added, or covers what is behind it.
    pub blend: WaveBlend,
    /// Displacement along the curve.
    pub noise: WaveNoise,
}

impl Default for Wave {
    fn default() -> Self {
        Self {
            name: String::new(),
            shape: WaveShape::Sphere,
            placement: WavePlacement::default(),
            alpha: 0.2,
            profile: Vec::new(),
            core: 0.02,
            radius: Some(0.5),
            tolerance: 0.01,
            reach: 1000.0,
            attenuation: 0.0,
            color: Vec4::new(0.5, 0.5, 1.0, 1.0),
            ramp: Vec::new(),
            growth: [0.0, 1.0],
            swell: [0.0; 2],
            occluded: true,
            order: WaveOrder::LinesThrough,
            blend: WaveBlend::Display,
            noise: WaveNoise::default(),
        }
    }
}

/// What curve a wave follows, in metres in the wave's own frame.
///
/// The curves with a `length` go from the origin along x. Those with points have the direction from
/// the first point to the last one as their main direction, and must rise along it: a curve that
/// folds back has no single place per coordinate.
#[derive(Clone, Debug, PartialEq)]
pub enum WaveShape {
    /// A ball round the origin.
    Sphere,
    /// A straight rod with flat ends.
    Cylinder {
        /// `None` for one without ends.
        length: Option<f32>,
    },
    /// A straight rod with round ends.
    Capsule {
        /// Length without the round ends.
        length: f32,
    },
    /// `(length s, r sin θ, r cos θ)`, θ = phase + 2π turns s (Abe 3.25).
    Helix {
        /// Length along x, > 0.
        length: f32,
        /// r ≥ 0.
        radius: f32,
        /// Turns over the whole length; negative for the other hand.
        turns: f32,
        /// Angle at the beginning, in radians.
        phase: f32,
    },
    /// `(length s, Σ aₙ sin nθ + bₙ cos nθ, Σ cₙ sin nθ + dₙ cos nθ)`, θ = 2π turns s
    /// (Abe 3.30).
    Trig {
        /// Length along x, > 0.
        length: f32,
        /// Periods of the first term over the whole length.
        turns: f32,
        /// `[aₙ, bₙ]` for n = 1, 2, …
        y: Vec<[f32; 2]>,
        /// `[cₙ, dₙ]` for n = 1, 2, …
        z: Vec<[f32; 2]>,
    },
    /// `Σ Bᵢⁿ(s) Pᵢ` (Abe 3.32).
    Bezier {
        /// 2 to 101 control points.
        points: Vec<Vec3>,
    },
    /// `Σ Nᵢᵏ(s) Pᵢ` (Abe 3.33), s scaled to [0, 1] over the knots from k − 1 to n + 1.
    BSpline {
        /// At least `order` control points.
        points: Vec<Vec3>,
        /// k: degree plus one, 2 to 16.
        order: usize,
        /// As many as points and order together, not falling; empty for even ones that begin and
        /// end in the first and last point.
        knots: Vec<f32>,
    },
    /// Straight pieces; each has the same share of s.
    Polyline {
        /// At least 2.
        points: Vec<Vec3>,
    },
}

/// A place that a wave holds on to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WaveAnchor {
    /// Nodes whose origins are averaged; empty for the world's origin.
    pub nodes: Vec<usize>,
    /// Added to it, in metres along the world's axes.
    pub offset: Vec3,
}

/// Where a wave is.
#[derive(Clone, Debug, PartialEq)]
pub enum WavePlacement {
    /// The wave's origin and axes.
    At {
        /// Its origin.
        anchor: WaveAnchor,
        /// World direction of its x axis; not zero.
        direction: Vec3,
        /// Whether `direction` turns with the anchor's first node.
        follow: bool,
        /// Turn about its x axis in radians; its y axis is as far up as it can be without one.
        roll: f32,
    },
    /// From one place to another: the curve is stretched along its main direction to end there.
    Between {
        /// Where it begins.
        from: WaveAnchor,
        /// Where it ends.
        to: WaveAnchor,
        /// Turn about its axis in radians.
        roll: f32,
    },
}

impl Default for WavePlacement {
    fn default() -> Self {
        Self::At { anchor: WaveAnchor::default(), direction: Vec3::X, follow: false, roll: 0.0 }
    }
}

/// A colour at an energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveTone {
    /// The energy, > 0.
    pub energy: f32,
    /// What is added there, straight alpha, as displayed (sRGB-encoded).
    pub color: Vec4,
}

/// How a wave lies over surfaces and lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum WaveOrder {
    /// Behind every surface: it shows where the background does.
    Under,
    /// Over the surfaces, under the lines.
    LinesThrough,
    /// Over surfaces and lines.
    Over,
}

/// What a wave's colour does to what is behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum WaveBlend {
    /// It is added to displayed (sRGB-encoded) values.
    Display,
    /// It is added in linear light.
    Linear,
    /// It is laid over, as displayed, with the alpha of its brightest channel: a glow before a bright
    /// sky keeps its colour. On black it looks as if it were added.
    Normal,
}

/// Displacement across the curve, the same in every run. It is zero at the ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveNoise {
    /// Largest displacement of the first octave in metres, ≥ 0; 0 for none.
    pub amplitude: f32,
    /// Bends of the first octave over the whole curve, ≥ 0.
    pub frequency: f32,
    /// 0 to 8; each has twice the frequency and half the amplitude of the one before. 0 counts as 1.
    pub octaves: u32,
    /// Which of the many.
    pub seed: u32,
    /// Moves the noise along the curve, in bends of the first octave.
    pub phase: f32,
}

/// How the waves of a scene are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WaveMethod {
    /// In closed form, by pieces of the curve that are as long as each wave's tolerance allows.
    #[default]
    Exact,
    /// As Abe 2024 does, for comparison: composite Simpson over the part of the ray that is near the
    /// wave.
    Simpson {
        /// m: intervals on the ray, 2 to 4000.
        points: u32,
        /// n: how many times fewer outside the cylinder round the curve, 1 to 64.
        thinning: u32,
        /// B-splines by de Boor's algorithm, which takes a third of the time, instead of as the
        /// paper prints them: the sum of all basis functions times the control points.
        de_boor: bool,
    },
}

/// How a wave moves. `Wave` itself is one moment; [`WaveMotion::at`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaveMotion {
    /// Parts of the curve per second that the head goes forward from `growth[0]`, and nothing is
    /// there before the time 0; 0 keeps `growth`.
    pub head_speed: f32,
    /// Seconds after which the tail follows at the same speed; 0 for never. Once the head has
    /// arrived, the wave fades in proportion to what is left of it.
    pub duration: f32,
    /// Metres per second along the world's axes.
    pub velocity: Vec3,
    /// Turns about the wave's axis, in radians per second.
    pub spin: f32,
    /// Bends per second that the noise moves along the curve.
    pub noise_speed: f32,
}

impl WaveMotion {
    /// The wave at a time in seconds.
    #[must_use]
    pub fn at(&self, wave: &Wave, time: f32) -> Wave {
        let mut wave = wave.clone();
        let [tail, head] = wave.growth;
        if self.head_speed > 0.0 {
            let gone = |t: f32| (tail + self.head_speed * t.max(0.0)).clamp(tail, head.max(tail));
            wave.growth[1] = gone(time);
            let mut left = if time < 0.0 { 0.0 } else { 1.0 };
            if self.duration > 0.0 {
                wave.growth[0] = gone(time - self.duration);
                let shot = (self.head_speed * self.duration).min(head - tail);
                if wave.growth[1] >= head && shot > 0.0 {
                    left = ((head - wave.growth[0]) / shot).min(1.0);
                }
            }
            wave.alpha *= left;
            wave.swell = wave.swell.map(|alpha| alpha * left);
        }
        let (moved, turned) = (self.velocity * time, self.spin * time);
        match &mut wave.placement {
            WavePlacement::At { anchor, roll, .. } => {
                anchor.offset += moved;
                *roll += turned;
            }
            WavePlacement::Between { from, to, roll } => {
                from.offset += moved;
                to.offset += moved;
                *roll += turned;
            }
        }
        wave.noise.phase += self.noise_speed * time;
        wave
    }
}
