use glam::{Vec3, Vec4};

use super::{WaveAnchor, WavePlacement};
use crate::style::Globs;

/// Most beams of a scene.
pub const MAX_BEAMS: usize = 256;
/// Most tones of a beam.
pub const MAX_BEAM_TONES: usize = 8;
/// Most points of a beam's path.
const MAX_POINTS: usize = 10_000;
/// Most control points of a Bézier curve: its binomials must stay in the range of f32.
const MAX_BEZIER_POINTS: usize = 101;
/// Largest coordinate or length in metres.
const LARGEST: f32 = 1e6;

/// A body of light as comics draw it (Suzuki 2004, section 4.1): a shape shaded by a ramp over
/// E·N, where E is the unit vector to the eye and N the surface's unit normal: 1 where it faces the
/// eye, 0 at its rim. No light falls on it, and of lines it has only its own outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Name for messages; may be empty.
    pub name: String,
    /// Its shape.
    pub shape: BeamShape,
    /// Where it is; [`BeamShape::Surfaces`] are where their nodes are.
    pub placement: WavePlacement,
    /// Tones by rising E·N, 1 to [`MAX_BEAM_TONES`]; the first one goes down to the rim.
    pub ramp: Vec<BeamTone>,
    /// Whether tones run into each other instead of having edges.
    pub smooth: bool,
    /// Factor on the alpha of all tones, 0 to 1.
    pub opacity: f32,
    /// How objects and their lines meet it.
    pub order: BeamOrder,
    /// Whether nearer surfaces hide it.
    pub occluded: bool,
    /// Factor on radii, ≥ 0; 0 draws nothing.
    pub size: f32,
    /// The part of a path that is there: its tail and its head, 0 ≤ tail ≤ head ≤ 1, by length.
    pub growth: [f32; 2],
    /// Light on what is near; `None` for none.
    pub light: Option<BeamLight>,
    /// A line round it; `None` for none.
    pub outline: Option<BeamOutline>,
}

impl Default for Beam {
    fn default() -> Self {
        let tone = |at: f32, [r, g, b]: [f32; 3]| BeamTone {
            at,
            color: Vec4::new(r, g, b, 1.0),
            softness: 0.0,
        };
        Self {
            name: String::new(),
            shape: BeamShape::Path {
                points: vec![Vec3::ZERO, Vec3::X],
                is_bezier: false,
                radius: [0.1; 2],
            },
            placement: WavePlacement::default(),
            ramp: vec![
                tone(0.0, [1.0, 0.42, 0.1]),
                tone(0.4, [1.0, 0.85, 0.3]),
                tone(0.7, [1.0; 3]),
            ],
            smooth: false,
            opacity: 1.0,
            order: BeamOrder::LinesThrough,
            occluded: true,
            size: 1.0,
            growth: [0.0, 1.0],
            light: None,
            outline: None,
        }
    }
}

/// A line round a beam, and round those of its parts that lie before others. It is as see-through as
/// the beam's opacity makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamOutline {
    /// Straight alpha, as displayed (sRGB-encoded).
    pub color: Vec4,
    /// Pixels at the style's reference height, 0 to 1000. It lies outside of the beam.
    pub width: f32,
}

/// A tone of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamTone {
    /// E·N from which it shows, 0 to 1.
    pub at: f32,
    /// Straight alpha, as displayed (sRGB-encoded).
    pub color: Vec4,
    /// Width of its edge in E·N, ≥ 0; at least a pixel.
    pub softness: f32,
}

/// What a beam looks like, in metres in its own frame, where it goes along x.
#[derive(Clone, Debug, PartialEq)]
pub enum BeamShape {
    /// Surfaces of the scene's own models: they are drawn as the beam and not as surfaces, have no
    /// lines and cast no shadow. A surface of several beams is the last one's. Which surfaces these
    /// are is fixed when the scene is prepared.
    Surfaces {
        /// Only objects below this node; `None` for all.
        under: Option<usize>,
        /// Globs of object names; empty for all.
        objects: Globs,
        /// Globs of material names; empty for all.
        materials: Globs,
    },
    /// A tube along a path, with round ends; pointed where its radius is 0.
    Path {
        /// 2 to 10,000 places, or 2 to 101 control points of a Bézier curve.
        points: Vec<Vec3>,
        /// Whether they are control points.
        is_bezier: bool,
        /// Radius at the beginning and at the end, ≥ 0, one of them > 0; even in between.
        radius: [f32; 2],
    },
    /// A spiky star: the flash of a muzzle or of a hit.
    Flash {
        /// Length of the longest spikes, > 0.
        radius: f32,
        /// 1 to 64.
        spikes: u32,
        /// Half angle in radians about x within which spikes are, 0 to π: π for all round.
        spread: f32,
        /// Which of the many.
        seed: u32,
    },
    /// A cloud of balls: an explosion.
    Burst {
        /// Radius of the whole, > 0.
        radius: f32,
        /// Balls round the one in the middle, 1 to 64.
        lobes: u32,
        /// Which of the many.
        seed: u32,
    },
}

/// How objects and their lines meet a beam. [`Self::Under`] lies under the paint, then
/// [`Self::LinesThrough`], then [`Self::Over`] and [`Self::Hide`]; beams of the same rank lie over
/// each other by their depth. Waves of a rank are added to its beams.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BeamOrder {
    /// Behind every surface: it shows where the background does.
    Under,
    /// Over the surfaces; all lines go over it, multiplied.
    LinesThrough,
    /// Over surfaces and lines that are farther away.
    Over,
    /// As [`Self::Over`]; what is farther away is not drawn, even where the beam is transparent.
    Hide,
}

/// What a beam lights: it adds to the ramp coordinate of surfaces that face the beam's middle line
/// (or middle) nearby, through the same ramp as all lights, and takes nothing from others. What the
/// ramp shows more because of it has its colour: of the step from the tone without it to the tone with
/// it, each of red, green and blue takes the colour's part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamLight {
    /// Strength, ≥ 0; 1 is that of all other lights together. It grows and shrinks with the beam's
    /// size and opacity.
    pub intensity: f32,
    /// Metres at which it ends, > 0.
    pub range: f32,
    /// As displayed (sRGB-encoded), 0 to 1; `None` for the mean of the ramp's tones, weighted by their
    /// alpha and made as bright as it can be.
    pub color: Option<Vec3>,
    /// Whether surfaces cast its shadows, as from a lamp in its middle, if the style has shadows: what
    /// that is inside of hides all of its light.
    pub casts_shadow: bool,
}

impl Beam {
    /// The displayed colour of its light.
    pub(crate) fn light_color(&self) -> Vec3 {
        if let Some(color) = self.light.and_then(|light| light.color) {
            return color;
        }
        let sum: Vec3 = self.ramp.iter().map(|tone| tone.color.truncate() * tone.color.w).sum();
        if sum.max_element() > 0.0 { sum / sum.max_element() } else { Vec3::ONE }
    }

    /// What is wrong with it, as the rest of a sentence that begins with the beam.
    ///
    /// `nodes` is the number of nodes that it may refer to.
    ///
    /// # Errors
    /// A part of a sentence such as "must have …".
    pub fn check(&self, nodes: usize) -> Result<(), String> {
        if self.ramp.is_empty() || self.ramp.len() > MAX_BEAM_TONES {
            return Err(format!("has {} tones: it must have 1 to 8", self.ramp.len()));
        }
        let is_tone = |tone: &BeamTone| {
            (0.0..=1.0).contains(&tone.at)
                && (0.0..=1.0).contains(&tone.softness)
                && tone.color.is_finite()
                && tone.color.min_element() >= 0.0
                && tone.color.w <= 1.0
        };
        if !self.ramp.iter().all(is_tone)
            || self.ramp.windows(2).any(|pair| pair[0].at >= pair[1].at)
        {
            return Err("has tones whose places do not rise from 0 to 1, or whose colours are no \
                        colours"
                .to_owned());
        }
        let number = |name: &str, value: f32, low: f32, high: f32| {
            let wrong = || format!("has the {name} {value}: it must be {low} to {high}");
            if value >= low && value <= high { Ok(()) } else { Err(wrong()) }
        };
        number("opacity", self.opacity, 0.0, 1.0)?;
        number("size", self.size, 0.0, LARGEST)?;
        if let Some(light) = &self.light {
            number("light's intensity", light.intensity, 0.0, LARGEST)?;
            number("light's range", light.range, 1e-6, LARGEST)?;
            let color = light.color.unwrap_or(Vec3::ONE).to_array();
            color.iter().try_for_each(|&part| number("light's colour", part, 0.0, 1.0))?;
        }
        if let Some(outline) = &self.outline {
            number("outline's width", outline.width, 0.0, 1000.0)?;
            let color = outline.color.to_array();
            color.iter().try_for_each(|&part| number("outline's colour", part, 0.0, 1.0))?;
        }
        let [tail, head] = self.growth;
        if !(0.0 <= tail && tail <= head && head <= 1.0) {
            return Err(format!(
                "grows from {tail} to {head}: both must be 0 to 1, the first one not larger"
            ));
        }
        self.check_placement(nodes)?;
        match &self.shape {
            BeamShape::Surfaces { under, .. } => match under {
                Some(node) if *node >= nodes => Err(format!(
                    "marks what is below node {node}, but there are only {nodes} nodes"
                )),
                _ => Ok(()),
            },
            BeamShape::Path { points, is_bezier, radius } => {
                let most = if *is_bezier { MAX_BEZIER_POINTS } else { MAX_POINTS };
                if points.len() < 2 || points.len() > most {
                    let count = points.len();
                    return Err(format!("has {count} points: it must have 2 to {most}"));
                }
                in_range("point", points)?;
                number("radius at its beginning", radius[0], 0.0, LARGEST)?;
                number("radius at its end", radius[1], 0.0, LARGEST)?;
                if radius.iter().all(|&r| r <= 0.0) {
                    return Err("has no radius at either end".to_owned());
                }
                Ok(())
            }
            BeamShape::Flash { radius, spikes, spread, .. } => {
                number("radius", *radius, 1e-6, LARGEST)?;
                number("number of spikes", *spikes as f32, 1.0, 64.0)?;
                number("spread", *spread, 0.0, std::f32::consts::PI + 1e-4)
            }
            BeamShape::Burst { radius, lobes, .. } => {
                number("radius", *radius, 1e-6, LARGEST)?;
                number("number of lobes", *lobes as f32, 1.0, 64.0)
            }
        }
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
                if !roll.is_finite() {
                    return Err("is turned by an angle that is no number".to_owned());
                }
            }
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

/// How a beam lives. [`Beam`] itself is one moment; [`BeamMotion::at`] makes it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BeamMotion {
    /// Seconds at which it appears.
    pub start: f32,
    /// Seconds until it is gone; 0 for never.
    pub duration: f32,
    /// Seconds from its beginning in which its size grows from 0; 0 for at once.
    pub grow: f32,
    /// Seconds before its end in which its size shrinks to 0; 0 for at once.
    pub shrink: f32,
    /// Parts of the path per second that the head goes forward from `growth[0]`; 0 keeps `growth`.
    pub head_speed: f32,
}

impl BeamMotion {
    /// The beam at a time in seconds; its size is 0 before its beginning and after its end.
    #[must_use]
    pub fn at(&self, beam: &Beam, time: f32) -> Beam {
        let mut beam = beam.clone();
        if *self == Self::default() {
            return beam;
        }
        let age = time - self.start;
        let left = if self.duration > 0.0 { self.duration - age } else { f32::INFINITY };
        // Fast at first, as what bursts is.
        let part = |seconds: f32, whole: f32| {
            let u = if whole > 0.0 { (seconds / whole).clamp(0.0, 1.0) } else { 1.0 };
            1.0 - (1.0 - u) * (1.0 - u)
        };
        let is_there = age >= 0.0 && left > 0.0;
        let factor = part(age, self.grow) * part(left, self.shrink);
        beam.size *= if is_there { factor } else { 0.0 };
        if self.head_speed > 0.0 {
            let [tail, head] = beam.growth;
            beam.growth[1] = (tail + self.head_speed * age.max(0.0)).clamp(tail, head.max(tail));
        }
        beam
    }
}
