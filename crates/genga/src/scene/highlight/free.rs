//! Keys on the directions of light and view themselves: no poles, no separate axes.

use glam::{DMat3, DQuat, DVec2, DVec3, Vec2, Vec3};

use super::angles::unit;
use super::{KeyInterpolation, Moment, Placed};

/// A drawing that stands at the mirror direction of the light, moved and changed by keys.
///
/// Keys are weighted by `1/(2 − l·lᵢ − v·vᵢ)`, normalised: at a key its values hold exactly. What
/// is blended is the rotation vector from the mirror direction to the drawing's middle, so the
/// place is continuous in all directions of light and view.
#[derive(Clone, Debug, PartialEq)]
pub struct FreePlacement {
    /// The direction, in the frame, where the drawing is upright along the frame's +Y; elsewhere it
    /// is turned there the shortest way. Only in the opposite direction its turn (not its place) is
    /// not defined.
    pub front: Vec3,
    /// Instead, the drawing is level everywhere round the frame's Y axis, as a ring on hair is. Then
    /// its turn (not its place) is not defined straight up and down.
    pub level: bool,
    /// The keys, in any order.
    pub keys: Vec<FreeKey>,
}

/// What the drawing is like for one light and view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeKey {
    /// Direction to the light, in the frame.
    pub light: Vec3,
    /// Direction to the eye, in the frame.
    pub view: Vec3,
    /// How far the middle is right of the mirror direction and above it, in radians.
    pub offset: Vec2,
    /// Turn in radians, counter-clockwise.
    pub rotation: f32,
    /// Factors on width and height, > 0.
    pub scale: Vec2,
    /// How far the halves are moved apart along both axes, in halves of the drawing's side.
    pub split: Vec2,
    /// How far the drawing is stretched out into its corners, in [0, 1]: at 1 a disc is a square.
    pub square: f32,
    /// How its values go on towards the other keys.
    pub interpolation: KeyInterpolation,
    /// Largest angles in radians of light and view to those of the key at which the drawing
    /// shows; `None` for no limit. It shows where any key allows it.
    pub light_range: Option<f32>,
    /// As `light_range`, for the view.
    pub view_range: Option<f32>,
}

/// Over this many radians beyond its range a drawing fades.
const FADE: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// Keys are of the same moment if `2 − l·lᵢ − v·vᵢ` is below this.
const SAME: f64 = 1e-10;

impl Default for FreePlacement {
    fn default() -> Self {
        Self { front: Vec3::Z, level: false, keys: Vec::new() }
    }
}

impl FreeKey {
    /// A key that leaves the drawing as it is, at the mirror direction.
    #[must_use]
    pub fn at(moment: &Moment) -> Self {
        Self {
            light: moment.light,
            view: moment.view,
            offset: Vec2::ZERO,
            rotation: 0.0,
            scale: Vec2::ONE,
            split: Vec2::ZERO,
            square: 0.0,
            interpolation: KeyInterpolation::default(),
            light_range: None,
            view_range: None,
        }
    }

    /// `2 − l·lᵢ − v·vᵢ`, without its cancellation near the key.
    fn distance(&self, light: DVec3, view: DVec3) -> f64 {
        let halved = |a: Vec3, b: DVec3| 0.5 * (unit(a) - b).length_squared();
        halved(self.light, light) + halved(self.view, view)
    }

    fn shown(&self, light: DVec3, view: DVec3) -> f64 {
        let within = |range: Option<f32>, own: Vec3, now: DVec3| {
            let Some(range) = range else { return 1.0 };
            let angle = angle_between(unit(own), now);
            (1.0 - (angle - f64::from(range)) / FADE).clamp(0.0, 1.0)
        };
        within(self.light_range, self.light, light).min(within(self.view_range, self.view, view))
    }
}

impl FreePlacement {
    /// Adds a key, or replaces the one of the same light and view. Returns its index.
    pub fn set_key(&mut self, key: FreeKey) -> usize {
        match self.key_at(&Moment { light: key.light, view: key.view }) {
            Some(index) => {
                self.keys[index] = key;
                index
            }
            None => {
                self.keys.push(key);
                self.keys.len() - 1
            }
        }
    }

    /// The key of this very light and view.
    #[must_use]
    pub fn key_at(&self, moment: &Moment) -> Option<usize> {
        let (light, view) = (unit(moment.light), unit(moment.view));
        self.keys.iter().position(|key| key.distance(light, view) < SAME)
    }

    /// Moves a key to another light and view; a key there gives way. `false` if there is no such
    /// key.
    pub fn move_key(&mut self, index: usize, moment: &Moment) -> bool {
        let Some(key) = self.remove_key(index) else { return false };
        self.set_key(FreeKey { light: moment.light, view: moment.view, ..key });
        true
    }

    /// Removes a key; `None` if there is no such key.
    pub fn remove_key(&mut self, index: usize) -> Option<FreeKey> {
        (index < self.keys.len()).then(|| self.keys.remove(index))
    }

    pub(super) fn evaluate(&self, moment: &Moment) -> Placed {
        let (light, view) = (unit(moment.light), unit(moment.view));
        let weights = self.weights(light, view);
        let mut turn = DVec3::ZERO;
        let (mut rotation, mut square) = (0.0, 0.0);
        let (mut scale, mut split) = (DVec2::ZERO, DVec2::ZERO);
        let mut opacity = 0.0_f64;
        for (key, weight) in self.keys.iter().zip(&weights) {
            turn += *weight * self.turn(key);
            rotation += weight * f64::from(key.rotation);
            scale += *weight * key.scale.as_dvec2();
            split += *weight * key.split.as_dvec2();
            square += weight * f64::from(key.square);
            opacity = opacity.max(key.shown(light, view));
        }
        if self.keys.is_empty() {
            (scale, opacity) = (DVec2::ONE, 1.0);
        }
        let middle = DQuat::from_scaled_axis(turn) * light;
        Placed {
            axes: self.upright(middle),
            panorama: None,
            rotation,
            scale: scale.to_array(),
            split: split.to_array(),
            square,
            opacity,
        }
    }

    /// Weights that add up to 1; the nearest key's alone if it holds.
    fn weights(&self, light: DVec3, view: DVec3) -> Vec<f64> {
        let distances: Vec<f64> = self.keys.iter().map(|key| key.distance(light, view)).collect();
        let nearest = (0..distances.len()).min_by(|&a, &b| distances[a].total_cmp(&distances[b]));
        let Some(nearest) = nearest else { return Vec::new() };
        let holds = self.keys[nearest].interpolation == KeyInterpolation::Hold;
        if holds || distances[nearest] < 1e-24 {
            return (0..distances.len()).map(|i| f64::from(u8::from(i == nearest))).collect();
        }
        // Taken relative to the nearest, so that nothing overflows.
        let weight = |(key, distance): (&FreeKey, &f64)| {
            let ratio = distances[nearest] / distance;
            // The root bends at the key: without it the way is flat there.
            let is_linear = key.interpolation == KeyInterpolation::Linear;
            if is_linear { ratio.sqrt() } else { ratio }
        };
        let mut weights: Vec<f64> = self.keys.iter().zip(&distances).map(weight).collect();
        let total: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= total);
        weights
    }

    /// The rotation vector from a key's mirror direction to the middle of its drawing.
    fn turn(&self, key: &FreeKey) -> DVec3 {
        let offset = key.offset.as_dvec2();
        let light = unit(key.light);
        let axes = self.upright(light);
        let towards = axes.x_axis * offset.x + axes.y_axis * offset.y;
        // Its length is the angle already.
        light.cross(towards)
    }

    /// Right, up and direction of a drawing in that direction.
    fn upright(&self, direction: DVec3) -> DMat3 {
        let across = |d: DVec3| {
            let up = DVec3::Y - d * d.y;
            if up.length_squared() > 1e-12 { up.normalize() } else { DVec3::Z }
        };
        let up = if self.level {
            across(direction)
        } else {
            let front = unit(self.front);
            DQuat::from_rotation_arc(front, direction) * across(front)
        };
        DMat3::from_cols(up.cross(direction), up, direction)
    }

    pub(super) fn put(&mut self, moment: &Moment, middle: Vec3) {
        let placed = self.evaluate(moment);
        let (light, middle) = (unit(moment.light), unit(middle));
        let axes = self.upright(light);
        let angle = angle_between(light, middle);
        let towards = DVec2::new(middle.dot(axes.x_axis), middle.dot(axes.y_axis));
        let offset = towards.try_normalize().unwrap_or(DVec2::X) * angle;
        let old = self.key_at(moment).map(|index| self.keys[index]);
        // A new key keeps what the others make of the drawing here.
        let key = old.unwrap_or(FreeKey {
            rotation: placed.rotation as f32,
            scale: DVec2::from(placed.scale).as_vec2(),
            split: DVec2::from(placed.split).as_vec2(),
            square: placed.square as f32,
            ..FreeKey::at(moment)
        });
        self.set_key(FreeKey { offset: offset.as_vec2(), ..key });
    }

    pub(super) fn validate(&self) -> Result<(), String> {
        let direction = |v: Vec3| v.is_finite() && v.length_squared() > 1e-12;
        if !direction(self.front) {
            return Err("has a front that is not a direction".to_owned());
        }
        for (i, key) in self.keys.iter().enumerate() {
            let number = i + 1;
            if !(direction(key.light) && direction(key.view)) {
                return Err(format!("has a key, number {number}, without a direction"));
            }
            let numbers = [key.rotation, key.square]
                .into_iter()
                .chain([key.offset, key.scale, key.split].into_iter().flat_map(|v| v.to_array()));
            let ranges = [key.light_range, key.view_range];
            let mut all = numbers.chain(ranges.into_iter().flatten());
            if !all.all(f32::is_finite) {
                return Err(format!("has a key, number {number}, that is not a finite number"));
            }
            if !key.scale.cmpgt(Vec2::ZERO).all() {
                return Err(format!(
                    "has a key, number {number}, with a scale that is not above 0"
                ));
            }
        }
        Ok(())
    }
}

/// Exact for small angles, too.
fn angle_between(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}
