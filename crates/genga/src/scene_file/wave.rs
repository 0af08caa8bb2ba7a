use glam::{Vec3, Vec4};
use schemars::JsonSchema;
use serde::Deserialize;

use super::Located;
use crate::scene::{
    Wave, WaveAnchor, WaveBlend, WaveMethod, WaveMotion, WaveNoise, WaveOrder, WavePlacement,
    WaveShape, WaveTone,
};
use crate::style::{BlendSpace, Color};

/// An energy wave of a scene file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub struct WaveEntry {
    /// The wave at the beginning of its motion, without the nodes that it holds on to.
    pub wave: Wave,
    /// The nodes where it begins.
    pub from_nodes: Option<Located<NodeNames>>,
    /// The nodes where it ends.
    pub to_nodes: Option<Located<NodeNames>>,
    /// How it moves.
    pub motion: WaveMotion,
    /// The moment of the motion in seconds.
    pub time: f32,
}

/// What curve a wave follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "WaveShape")]
enum Kind {
    /// A ball.
    Sphere,
    /// A straight rod with flat ends; without a 'length' one without ends.
    Cylinder,
    /// A straight rod with round ends.
    Capsule,
    /// A helix.
    Helix,
    /// Sums of sines and cosines.
    Trig,
    /// A Bézier curve.
    Bezier,
    /// A B-spline.
    BSpline,
    /// Straight pieces.
    Polyline,
}

/// How a wave lies over surfaces and lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "WaveOrder")]
enum Order {
    /// Behind every surface.
    Under,
    /// Over surfaces, under lines.
    LinesThrough,
    /// Over surfaces and lines.
    Over,
}

/// How a wave is laid over what is behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "WaveBlend")]
enum Blend {
    /// It is added, so it shows best before what is dark.
    #[default]
    Add,
    /// It covers what is behind it by its brightness, so it keeps its colour before a bright sky.
    Normal,
}

/// Names of one or several nodes; the places of several are averaged.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NodeNames {
    /// One node.
    One(String),
    /// Several.
    Several(#[schemars(length(min = 1, max = 64))] Vec<String>),
}

impl NodeNames {
    /// All the names.
    #[must_use]
    pub fn names(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::Several(names) => names,
        }
    }
}

/// A colour at an energy.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "WaveTone")]
struct Tone {
    /// The energy.
    #[schemars(extend("exclusiveMinimum" = 0))]
    energy: f32,
    /// What is added there.
    color: Color,
}

/// Displacement along the curve, the same in every run; zero at its ends.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "WaveNoise")]
struct Noise {
    /// Largest displacement of the first octave in metres.
    #[schemars(range(min = 0, max = 1e6))]
    amplitude: f32,
    /// Bends of the first octave over the whole curve.
    #[schemars(range(min = 0, max = 4000))]
    frequency: f32,
    /// Octaves, each with twice the frequency and half the amplitude of the one before.
    #[serde(default = "one_octave")]
    #[schemars(range(min = 1, max = 8))]
    octaves: u32,
    /// Which of the many.
    #[serde(default)]
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    seed: u32,
    /// Moves the noise along the curve, in bends.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    phase: f32,
}

fn one_octave() -> u32 {
    1
}

/// How a wave moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "WaveMotion")]
struct Motion {
    /// Parts of the curve per second that the head goes forward, from the first to the second
    /// number of 'growth'. Before the time 0 nothing is there.
    #[schemars(range(min = 0, max = 1e6))]
    head_speed: f32,
    /// Seconds after which the tail follows, and the wave fades as it comes near the head; 0 for
    /// never.
    #[schemars(range(min = 0, max = 1e6))]
    duration: f32,
    /// Metres per second along the scene's axes.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    velocity: [f32; 3],
    /// Degrees per second about the wave's axis.
    #[schemars(range(min = -1e6, max = 1e6))]
    spin_deg: f32,
    /// Bends per second that the noise moves.
    #[schemars(range(min = -1e6, max = 1e6))]
    noise_speed: f32,
}

/// An energy wave: a glow along a curve.
#[derive(Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Wave")]
pub(super) struct Written {
    /// Name for messages.
    #[serde(default)]
    name: String,
    /// What curve it follows.
    shape: Kind,
    /// Cylinder, capsule, helix and trig: length in metres; not needed where it has an end, to which
    /// it is stretched.
    length: Option<f32>,
    /// Helix: its radius in metres.
    helix_radius: Option<f32>,
    /// Helix and trig: turns or periods over the whole length.
    turns: Option<f32>,
    /// Helix: angle at its beginning in degrees.
    phase_deg: Option<f32>,
    /// Trig: factors of sine and cosine of the first, second, … harmonic, up.
    y: Option<Vec<[f32; 2]>>,
    /// Trig: as 'y', sideways.
    z: Option<Vec<[f32; 2]>>,
    /// Bézier, B-spline and polyline: control points in metres. They must rise along the way from
    /// the first to the last one.
    #[schemars(length(max = 10_001))]
    points: Option<Vec<[f32; 3]>>,
    /// B-spline: its order, degree plus one; 4 by default.
    #[schemars(range(min = 2, max = 16))]
    spline_order: Option<u32>,
    /// B-spline: as many knots as points and order together; even ones by default.
    #[schemars(length(max = 10_100))]
    knots: Option<Vec<f32>>,
    /// Where it begins, in metres, or the distance from there to 'from_node'.
    #[serde(default)]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    from: [f32; 3],
    /// The node or nodes where it begins.
    from_node: Option<Located<NodeNames>>,
    /// Where it ends: the curve is turned and stretched to end there.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    to: Option<[f32; 3]>,
    /// The node or nodes where it ends.
    to_node: Option<Located<NodeNames>>,
    /// Without 'to': where its x axis points; the scene's x by default.
    direction: Option<[f32; 3]>,
    /// Whether the direction turns with the first node of 'from_node'.
    #[serde(default)]
    follow_node: bool,
    /// Turn about its axis in degrees.
    #[serde(default)]
    #[schemars(range(min = -36000, max = 36000))]
    roll_deg: f32,
    /// Brightness.
    alpha: Option<f32>,
    /// Factors on the brightness along the curve: [place from 0 to 1, factor].
    #[serde(default)]
    #[schemars(length(max = 256))]
    profile: Vec<[f32; 2]>,
    /// Half width of the soft core in metres.
    core: Option<f32>,
    /// Where the glow ends, in metres from the curve.
    radius: Option<f32>,
    /// Whether the glow has no end; then 'radius' must not be given.
    #[serde(default)]
    unlimited: bool,
    /// Largest relative error.
    tolerance: Option<f32>,
    /// Length of view rays in metres.
    reach: Option<f32>,
    /// How fast the energy fades along view rays: the exponent j.
    attenuation: Option<f32>,
    /// Colour of the energy 1.
    color: Option<Color>,
    /// Colours over the energy, instead of 'color'.
    #[serde(default)]
    #[schemars(length(max = 16))]
    ramp: Vec<Tone>,
    /// The part of the curve that is there: tail and head, from 0 to 1.
    growth: Option<[f32; 2]>,
    /// Brightness of additional spheres at tail and head.
    swell: Option<[f32; 2]>,
    /// Whether surfaces hide what is behind them; true by default.
    occluded: Option<bool>,
    /// How it lies over surfaces and lines; lines-through by default.
    order: Option<Order>,
    /// How it is laid over what is behind it; add by default.
    #[serde(default)]
    blend: Blend,
    /// Which values are added; display by default.
    blend_space: Option<BlendSpace>,
    /// Displacement along the curve.
    noise: Option<Noise>,
    /// How it moves.
    #[serde(default)]
    motion: Motion,
    /// The moment of the motion in seconds, to which that of a frame is added: below 0 it begins so
    /// much later.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    time: f32,
}

/// Abe's own method instead of the exact one, for comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "WaveReference")]
pub struct WaveReference {
    /// m: intervals of Simpson's rule on each ray.
    #[schemars(range(min = 2, max = 4000))]
    pub points: u32,
    /// n: how many times fewer outside a cylinder round the curve.
    #[serde(default = "one_octave")]
    #[schemars(range(min = 1, max = 64))]
    pub thinning: u32,
    /// B-splines by de Boor's algorithm instead of the sum of their basis functions.
    #[serde(default)]
    pub de_boor: bool,
}

impl From<WaveReference> for WaveMethod {
    fn from(reference: WaveReference) -> Self {
        Self::Simpson {
            points: reference.points,
            thinning: reference.thinning,
            de_boor: reference.de_boor,
        }
    }
}

impl TryFrom<Written> for WaveEntry {
    type Error = String;

    fn try_from(w: Written) -> Result<Self, String> {
        let shape = w.shape()?;
        let base = Wave::default();
        let turn = w.roll_deg.to_radians();
        let anchor = |offset: [f32; 3]| WaveAnchor { nodes: Vec::new(), offset: offset.into() };
        let is_between = w.to.is_some() || w.to_node.is_some();
        if is_between && (w.direction.is_some() || w.follow_node) {
            return Err("must have either a 'direction' or an end, not both".to_owned());
        }
        if w.follow_node && w.from_node.is_none() {
            return Err("must have a 'from_node' to follow".to_owned());
        }
        if w.unlimited && w.radius.is_some() {
            return Err("must have either a 'radius' or 'unlimited', not both".to_owned());
        }
        if w.blend == Blend::Normal && w.blend_space.is_some() {
            return Err(
                "must have no 'blend_space' with the blend 'normal': nothing is added".to_owned()
            );
        }
        let placement = if is_between {
            let to = anchor(w.to.unwrap_or_default());
            WavePlacement::Between { from: anchor(w.from), to, roll: turn }
        } else {
            let direction = w.direction.map_or(Vec3::X, Vec3::from);
            let at = anchor(w.from);
            WavePlacement::At { anchor: at, direction, follow: w.follow_node, roll: turn }
        };
        let color = |c: Color| Vec4::from(c.to_array());
        let noise = w.noise.map_or(WaveNoise::default(), |n| WaveNoise {
            amplitude: n.amplitude,
            frequency: n.frequency,
            octaves: n.octaves,
            seed: n.seed,
            phase: n.phase,
        });
        let wave = Wave {
            name: w.name,
            shape,
            placement,
            alpha: w.alpha.unwrap_or(base.alpha),
            profile: w.profile,
            core: w.core.unwrap_or(base.core),
            radius: if w.unlimited { None } else { w.radius.or(base.radius) },
            tolerance: w.tolerance.unwrap_or(base.tolerance),
            reach: w.reach.unwrap_or(base.reach),
            attenuation: w.attenuation.unwrap_or(base.attenuation),
            color: w.color.map_or(base.color, color),
            ramp: (w.ramp.iter())
                .map(|tone| WaveTone { energy: tone.energy, color: color(tone.color) })
                .collect(),
            growth: w.growth.unwrap_or(base.growth),
            swell: w.swell.unwrap_or(base.swell),
            occluded: w.occluded.unwrap_or(true),
            order: match w.order {
                Some(Order::Under) => WaveOrder::Under,
                Some(Order::LinesThrough) | None => WaveOrder::LinesThrough,
                Some(Order::Over) => WaveOrder::Over,
            },
            blend: match (w.blend, w.blend_space.unwrap_or_default()) {
                (Blend::Normal, _) => WaveBlend::Normal,
                (Blend::Add, BlendSpace::Display) => WaveBlend::Display,
                (Blend::Add, BlendSpace::Linear) => WaveBlend::Linear,
            },
            noise,
        };
        wave.check(usize::MAX)?;
        let m = w.motion;
        Ok(Self {
            wave,
            from_nodes: w.from_node,
            to_nodes: w.to_node,
            motion: WaveMotion {
                head_speed: m.head_speed,
                duration: m.duration,
                velocity: m.velocity.into(),
                spin: m.spin_deg.to_radians(),
                noise_speed: m.noise_speed,
            },
            time: w.time,
        })
    }
}

impl Written {
    fn shape(&self) -> Result<WaveShape, String> {
        let given = [
            ("length", self.length.is_some()),
            ("turns", self.turns.is_some()),
            ("helix_radius", self.helix_radius.is_some()),
            ("phase_deg", self.phase_deg.is_some()),
            ("y", self.y.is_some()),
            ("z", self.z.is_some()),
            ("points", self.points.is_some()),
            ("spline_order", self.spline_order.is_some()),
            ("knots", self.knots.is_some()),
        ];
        let (name, allowed): (_, &[&str]) = match self.shape {
            Kind::Sphere => ("sphere", &[]),
            Kind::Cylinder => ("cylinder", &["length"]),
            Kind::Capsule => ("capsule", &["length"]),
            Kind::Helix => ("helix", &["length", "turns", "helix_radius", "phase_deg"]),
            Kind::Trig => ("trig", &["length", "turns", "y", "z"]),
            Kind::Bezier => ("bezier", &["points"]),
            Kind::BSpline => ("b-spline", &["points", "spline_order", "knots"]),
            Kind::Polyline => ("polyline", &["points"]),
        };
        if let Some((key, _)) = given.iter().find(|(key, is)| *is && !allowed.contains(key)) {
            return Err(format!("must not have '{key}': a {name} has none"));
        }
        // Stretching makes any length the right one.
        let is_between = self.to.is_some() || self.to_node.is_some();
        let given_length = self.length.or(is_between.then_some(1.0));
        let length =
            || given_length.ok_or_else(|| format!("must have a 'length' or an end, as a {name}"));
        let points = || match &self.points {
            Some(points) => Ok(points.iter().map(|&p| Vec3::from(p)).collect::<Vec<_>>()),
            None => Err(format!("must have 'points', as a {name}")),
        };
        Ok(match self.shape {
            Kind::Sphere => WaveShape::Sphere,
            Kind::Cylinder => WaveShape::Cylinder { length: given_length },
            Kind::Capsule => WaveShape::Capsule { length: length()? },
            Kind::Helix => WaveShape::Helix {
                length: length()?,
                radius: self.helix_radius.ok_or("must have a 'helix_radius', as a helix")?,
                turns: self.turns.unwrap_or(1.0),
                phase: self.phase_deg.unwrap_or(0.0).to_radians(),
            },
            Kind::Trig => WaveShape::Trig {
                length: length()?,
                turns: self.turns.unwrap_or(1.0),
                y: self.y.clone().unwrap_or_default(),
                z: self.z.clone().unwrap_or_default(),
            },
            Kind::Bezier => WaveShape::Bezier { points: points()? },
            Kind::Polyline => WaveShape::Polyline { points: points()? },
            Kind::BSpline => WaveShape::BSpline {
                points: points()?,
                order: self.spline_order.unwrap_or(4) as usize,
                knots: self.knots.clone().unwrap_or_default(),
            },
        })
    }
}
