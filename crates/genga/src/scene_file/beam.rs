use glam::{Vec3, Vec4};
use schemars::JsonSchema;
use serde::Deserialize;

use super::{Located, NodeNames};
use crate::scene::{
    Beam, BeamLight, BeamMotion, BeamOrder, BeamOutline, BeamShape, BeamTone, WaveAnchor,
    WavePlacement,
};
use crate::style::{Color, Globs};

/// A beam of a scene file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Written")]
pub struct BeamEntry {
    /// The beam at the beginning of its motion, without the nodes that it holds on to.
    pub beam: Beam,
    /// The nodes where it begins.
    pub from_nodes: Option<Located<NodeNames>>,
    /// The nodes where it ends.
    pub to_nodes: Option<Located<NodeNames>>,
    /// The model whose surfaces are marked; `None` for all.
    pub model: Option<Located<String>>,
    /// Seconds of the past that a light-trail shows; `None` for other shapes.
    pub trail: Option<f32>,
    /// How it lives.
    pub motion: BeamMotion,
    /// The moment of the motion in seconds.
    pub time: f32,
}

/// What a beam looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "BeamShape")]
enum Kind {
    /// A straight tube or cone.
    Line,
    /// A tube along a Bézier curve.
    Bezier,
    /// A tube through places.
    Polyline,
    /// A spiky star: the flash of a muzzle or of a hit.
    Flash,
    /// A cloud of balls: an explosion.
    Burst,
    /// A tube along the way that 'from_node' has come in its model's clip, pointed in the past.
    LightTrail,
    /// Surfaces of the models, by the names of objects and materials.
    Surface,
}

/// How objects and their lines meet a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "BeamOrder")]
enum Order {
    /// Behind every surface.
    Under,
    /// Over surfaces; all lines go over it, multiplied.
    LinesThrough,
    /// Over surfaces and lines that are farther away.
    Over,
    /// As over; what is farther away is not drawn at all.
    Hide,
}

/// A tone of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BeamTone")]
struct Tone {
    /// From where on it shows: 0 is the rim, 1 what faces the eye.
    #[schemars(range(min = 0, max = 1))]
    at: f32,
    /// Its colour; it may be see-through.
    color: Color,
    /// Width of its edge in the same unit.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    softness: f32,
}

/// A radius, or one at the beginning and one at the end.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
enum Radius {
    /// The same everywhere.
    Even(#[schemars(range(min = 0, max = 1e6))] f32),
    /// At the beginning and at the end.
    Ends(#[schemars(inner(range(min = 0, max = 1e6)))] [f32; 2]),
}

/// What a beam lights.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BeamLight")]
struct Light {
    /// Strength; 1 is that of all other lights together.
    #[serde(default = "one")]
    #[schemars(range(min = 0, max = 1e6))]
    intensity: f32,
    /// Metres at which it ends.
    #[schemars(range(min = 1e-6, max = 1e6))]
    range: f32,
    /// Its colour; the mean of the ramp's by default.
    color: Option<Color>,
    /// Whether surfaces cast its shadows, as from a lamp in the beam's middle, which must be free.
    #[serde(default)]
    casts_shadow: bool,
}

/// A line round a beam.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BeamOutline")]
struct Outline {
    /// Its colour; black by default.
    #[serde(default = "black")]
    color: Color,
    /// Pixels in a picture of the style's reference height.
    #[schemars(range(min = 0, max = 1000))]
    width: f32,
}

fn black() -> Color {
    Color::BLACK
}

fn one() -> f32 {
    1.0
}

/// How a beam lives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "BeamMotion")]
struct Motion {
    /// Seconds at which it appears.
    #[schemars(range(min = -1e6, max = 1e6))]
    start: f32,
    /// Seconds until it is gone; 0 for never.
    #[schemars(range(min = 0, max = 1e6))]
    duration: f32,
    /// Seconds from its beginning in which it grows from nothing.
    #[schemars(range(min = 0, max = 1e6))]
    grow: f32,
    /// Seconds before its end in which it shrinks to nothing.
    #[schemars(range(min = 0, max = 1e6))]
    shrink: f32,
    /// Parts of the path per second that the head goes forward, from the first to the second
    /// number of 'growth'.
    #[schemars(range(min = 0, max = 1e6))]
    head_speed: f32,
}

/// A body of light: a shape under a ramp over how far it faces the eye.
#[derive(Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Beam")]
pub(super) struct Written {
    /// Name for messages.
    #[serde(default)]
    name: String,
    /// What it looks like.
    shape: Kind,
    /// Line: its length in metres, without an end.
    #[schemars(range(min = 1e-6, max = 1e6))]
    length: Option<f32>,
    /// Bézier and polyline: points in metres.
    #[schemars(length(min = 2, max = 10_000))]
    points: Option<Vec<[f32; 3]>>,
    /// Its radius in metres, or those at the beginning and at the end.
    radius: Option<Radius>,
    /// Flash: how many spikes; 18 by default.
    #[schemars(range(min = 1, max = 64))]
    spikes: Option<u32>,
    /// Flash: the half angle about its direction that spikes fill; 180 by default, all round.
    #[schemars(range(min = 0, max = 180))]
    spread_deg: Option<f32>,
    /// Burst: how many balls lie round the middle; 14 by default.
    #[schemars(range(min = 1, max = 64))]
    lobes: Option<u32>,
    /// Flash and burst: which of the many.
    #[schemars(range(min = 0, max = 4_294_967_295_u32))]
    seed: Option<u32>,
    /// Light-trail: seconds of the past that it shows; 0.25 by default.
    #[schemars(range(min = 0.001, max = 1e4))]
    seconds: Option<f32>,
    /// Surface: the model, by the name of its node; all by default.
    model: Option<Located<String>>,
    /// Surface: globs of object names; all by default.
    objects: Option<Globs>,
    /// Surface: globs of material names; all by default.
    materials: Option<Globs>,
    /// Where it begins, in metres, or the distance from there to 'from_node'.
    #[serde(default)]
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    from: [f32; 3],
    /// The node or nodes where it begins.
    from_node: Option<Located<NodeNames>>,
    /// Where it ends: its path is turned and scaled to end there.
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
    /// Tones from the rim to the core.
    #[serde(default)]
    #[schemars(length(max = 8))]
    ramp: Vec<Tone>,
    /// Whether tones run into each other.
    #[serde(default)]
    smooth: bool,
    /// Factor on the alpha of all tones.
    #[schemars(range(min = 0, max = 1))]
    opacity: Option<f32>,
    /// How objects and their lines meet it; lines-through by default.
    order: Option<Order>,
    /// Whether nearer surfaces hide it; true by default.
    occluded: Option<bool>,
    /// The part of the path that is there: tail and head, from 0 to 1.
    growth: Option<[f32; 2]>,
    /// Light on what is near.
    light: Option<Light>,
    /// A line round it; none by default.
    outline: Option<Outline>,
    /// How it lives.
    #[serde(default)]
    motion: Motion,
    /// The moment of the motion in seconds.
    #[serde(default)]
    #[schemars(range(min = -1e6, max = 1e6))]
    time: f32,
}

impl TryFrom<Written> for BeamEntry {
    type Error = String;

    fn try_from(w: Written) -> Result<Self, String> {
        w.check_keys()?;
        let shape = w.shape()?;
        let base = Beam::default();
        let anchor = |offset: [f32; 3]| WaveAnchor { nodes: Vec::new(), offset: offset.into() };
        let is_between = w.to.is_some() || w.to_node.is_some();
        if is_between && (w.direction.is_some() || w.follow_node) {
            return Err("must have either a 'direction' or an end, not both".to_owned());
        }
        if w.follow_node && w.from_node.is_none() {
            return Err("must have a 'from_node' to follow".to_owned());
        }
        let roll = w.roll_deg.to_radians();
        let placement = if is_between {
            let to = anchor(w.to.unwrap_or_default());
            WavePlacement::Between { from: anchor(w.from), to, roll }
        } else {
            let direction = w.direction.map_or(Vec3::X, Vec3::from);
            let (anchor, follow) = (anchor(w.from), w.follow_node);
            WavePlacement::At { anchor, direction, follow, roll }
        };
        let tone = |tone: &Tone| BeamTone {
            at: tone.at,
            color: Vec4::from(tone.color.to_array()),
            softness: tone.softness,
        };
        let beam = Beam {
            name: w.name,
            shape,
            placement,
            ramp: if w.ramp.is_empty() { base.ramp } else { w.ramp.iter().map(tone).collect() },
            smooth: w.smooth,
            opacity: w.opacity.unwrap_or(1.0),
            order: match w.order {
                Some(Order::Under) => BeamOrder::Under,
                Some(Order::LinesThrough) | None => BeamOrder::LinesThrough,
                Some(Order::Over) => BeamOrder::Over,
                Some(Order::Hide) => BeamOrder::Hide,
            },
            occluded: w.occluded.unwrap_or(true),
            size: 1.0,
            growth: w.growth.unwrap_or(base.growth),
            light: w.light.map(|l| BeamLight {
                intensity: l.intensity,
                range: l.range,
                color: l.color.map(|color| Vec4::from(color.to_array()).truncate()),
                casts_shadow: l.casts_shadow,
            }),
            outline: w.outline.map(|outline| BeamOutline {
                color: Vec4::from(outline.color.to_array()),
                width: outline.width,
            }),
        };
        beam.check(usize::MAX)?;
        let is_trail = w.shape == Kind::LightTrail;
        let m = w.motion;
        Ok(Self {
            beam,
            from_nodes: w.from_node,
            to_nodes: w.to_node,
            model: w.model,
            trail: is_trail.then_some(w.seconds.unwrap_or(0.25)),
            motion: BeamMotion {
                start: m.start,
                duration: m.duration,
                grow: m.grow,
                shrink: m.shrink,
                head_speed: m.head_speed,
            },
            time: w.time,
        })
    }
}

impl Written {
    /// Keys that belong to other shapes are mistakes.
    fn check_keys(&self) -> Result<(), String> {
        let given = [
            ("length", self.length.is_some()),
            ("points", self.points.is_some()),
            ("radius", self.radius.is_some()),
            ("spikes", self.spikes.is_some()),
            ("spread_deg", self.spread_deg.is_some()),
            ("lobes", self.lobes.is_some()),
            ("seed", self.seed.is_some()),
            ("seconds", self.seconds.is_some()),
            ("model", self.model.is_some()),
            ("objects", self.objects.is_some()),
            ("materials", self.materials.is_some()),
            ("growth", self.growth.is_some()),
            ("from_node", self.from_node.is_some()),
            ("to_node", self.to_node.is_some()),
            ("to", self.to.is_some()),
            ("direction", self.direction.is_some()),
        ];
        let placed = ["from_node", "to_node", "to", "direction"];
        let (name, allowed): (_, &[&str]) = match self.shape {
            Kind::Line => ("line", &["length", "radius", "growth"]),
            Kind::Bezier => ("bezier", &["points", "radius", "growth"]),
            Kind::Polyline => ("polyline", &["points", "radius", "growth"]),
            Kind::Flash => ("flash", &["radius", "spikes", "spread_deg", "seed"]),
            Kind::Burst => ("burst", &["radius", "lobes", "seed"]),
            Kind::LightTrail => ("light-trail", &["radius", "seconds", "growth", "from_node"]),
            Kind::Surface => ("surface", &["model", "objects", "materials"]),
        };
        let is_free = !matches!(self.shape, Kind::LightTrail | Kind::Surface);
        let wrong = |key: &str| !(allowed.contains(&key) || (is_free && placed.contains(&key)));
        match given.iter().find(|(key, is)| *is && wrong(key)) {
            Some((key, _)) => Err(format!("must not have '{key}': a {name} has none")),
            None => Ok(()),
        }
    }

    fn shape(&self) -> Result<BeamShape, String> {
        let ends = |default: f32| match self.radius {
            None => [default; 2],
            Some(Radius::Even(radius)) => [radius; 2],
            Some(Radius::Ends(ends)) => ends,
        };
        let one_radius = || match self.radius {
            None => Err("must have a 'radius'".to_owned()),
            Some(Radius::Even(radius)) => Ok(radius),
            Some(Radius::Ends(_)) => Err("must have one radius, not two".to_owned()),
        };
        let path =
            |points: Vec<Vec3>, is_bezier| BeamShape::Path { points, is_bezier, radius: ends(0.1) };
        let points = || match &self.points {
            Some(points) if points.len() > 1 && points.iter().all(|p| *p == points[0]) => {
                Err("must have 'points' at more than one place".to_owned())
            }
            Some(points) => Ok(points.iter().map(|&p| Vec3::from(p)).collect::<Vec<_>>()),
            None => Err("must have 'points'".to_owned()),
        };
        Ok(match self.shape {
            Kind::Line => {
                let has_end = self.to.is_some() || self.to_node.is_some();
                let length = match (self.length, has_end) {
                    (Some(length), false) => length,
                    (None, true) => 1.0,
                    _ => return Err("must have either a 'length' or an end".to_owned()),
                };
                path(vec![Vec3::ZERO, Vec3::X * length], false)
            }
            Kind::Bezier => path(points()?, true),
            Kind::Polyline => path(points()?, false),
            Kind::Flash => BeamShape::Flash {
                radius: one_radius()?,
                spikes: self.spikes.unwrap_or(18),
                spread: self.spread_deg.unwrap_or(180.0).to_radians(),
                seed: self.seed.unwrap_or(0),
            },
            Kind::Burst => BeamShape::Burst {
                radius: one_radius()?,
                lobes: self.lobes.unwrap_or(14),
                seed: self.seed.unwrap_or(0),
            },
            Kind::LightTrail => {
                if self.from_node.is_none() {
                    return Err("must have a 'from_node' whose way it shows".to_owned());
                }
                let radius = match self.radius {
                    Some(Radius::Ends(ends)) => ends,
                    Some(Radius::Even(radius)) => [0.0, radius],
                    None => [0.0, 0.05],
                };
                // The way is put in when it is known.
                BeamShape::Path { points: vec![Vec3::ZERO; 2], is_bezier: false, radius }
            }
            Kind::Surface => {
                let named = |globs: &Option<Globs>| {
                    globs.as_ref().is_some_and(|globs| !globs.patterns().is_empty())
                };
                if self.model.is_none() && !named(&self.objects) && !named(&self.materials) {
                    return Err(
                        "must name what it marks, by 'objects', 'materials' or 'model'".to_owned()
                    );
                }
                BeamShape::Surfaces {
                    under: None,
                    objects: self.objects.clone().unwrap_or_default(),
                    materials: self.materials.clone().unwrap_or_default(),
                }
            }
        })
    }
}
