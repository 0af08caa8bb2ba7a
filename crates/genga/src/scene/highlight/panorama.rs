//! The mode of the paper: a panorama on which the drawing moves.

use std::f64::consts::TAU;

use glam::{DMat3, Vec3};

use super::angles::{unit, wrapped, yaw_pitch_f64};
use super::{KeyInterpolation, Moment, PlaceError, Placed};

/// A drawing on the panorama of yaw and pitch round the frame.
///
/// Its x (yaw) is a periodic function of `yaw(light) − yaw(view)`, its y (pitch) one of
/// `pitch(light) − pitch(view)`, which is held outside of its keys. Without keys the drawing
/// stands at the mirror direction of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct PanoramaPlacement {
    yaw_keys: Vec<AngleKey>,
    pitch_keys: Vec<AngleKey>,
    /// Lowest and highest pitch of the drawing's middle in radians.
    pub limits: [f32; 2],
}

/// A place on one axis of the panorama for a relative angle of light and view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleKey {
    /// Light's angle less the view's, in radians.
    pub at: f32,
    /// Where the drawing's middle stands, in radians.
    pub place: f32,
    /// How it goes on to the next key.
    pub interpolation: KeyInterpolation,
}

/// Keys nearer than this (radians) are of the same moment.
const SAME: f64 = 1e-5;
/// More than the rounding of an angle to single precision.
const ROUNDING: f64 = 1e-6;

impl Default for PanoramaPlacement {
    fn default() -> Self {
        let limit = std::f32::consts::FRAC_PI_2;
        Self { yaw_keys: Vec::new(), pitch_keys: Vec::new(), limits: [-limit, limit] }
    }
}

impl PanoramaPlacement {
    /// The yaw's keys, by rising relative angle in [−π, π).
    #[must_use]
    pub fn yaw_keys(&self) -> &[AngleKey] {
        &self.yaw_keys
    }

    /// The pitch's keys, by rising relative angle.
    #[must_use]
    pub fn pitch_keys(&self) -> &[AngleKey] {
        &self.pitch_keys
    }

    /// Adds a key of the yaw, or replaces the one at the same relative angle.
    pub fn set_yaw_key(&mut self, key: AngleKey) {
        let at = wrapped(f64::from(key.at)) as f32;
        insert(&mut self.yaw_keys, AngleKey { at, ..key }, Some(TAU));
    }

    /// Adds a key of the pitch, or replaces the one at the same relative angle.
    pub fn set_pitch_key(&mut self, key: AngleKey) {
        insert(&mut self.pitch_keys, key, None);
    }

    /// Moves a key of the yaw to another relative angle; a key there gives way. `false` if there
    /// is no such key.
    pub fn move_yaw_key(&mut self, index: usize, at: f32) -> bool {
        let Some(key) = self.remove_yaw_key(index) else { return false };
        self.set_yaw_key(AngleKey { at, ..key });
        true
    }

    /// Moves a key of the pitch to another relative angle; a key there gives way. `false` if there
    /// is no such key.
    pub fn move_pitch_key(&mut self, index: usize, at: f32) -> bool {
        let Some(key) = self.remove_pitch_key(index) else { return false };
        self.set_pitch_key(AngleKey { at, ..key });
        true
    }

    /// Removes a key of the yaw; `None` if there is no such key.
    pub fn remove_yaw_key(&mut self, index: usize) -> Option<AngleKey> {
        (index < self.yaw_keys.len()).then(|| self.yaw_keys.remove(index))
    }

    /// Removes a key of the pitch; `None` if there is no such key.
    pub fn remove_pitch_key(&mut self, index: usize) -> Option<AngleKey> {
        (index < self.pitch_keys.len()).then(|| self.pitch_keys.remove(index))
    }

    /// Light's yaw and pitch less the view's, in radians: what the keys are set for. The yaw is in
    /// [−π, π).
    #[must_use]
    pub fn relative(moment: &Moment) -> [f32; 2] {
        relative(moment).map(|angle| angle as f32)
    }

    pub(super) fn evaluate(&self, moment: &Moment) -> Placed {
        let [relative_yaw, relative_pitch] = relative(moment);
        let [light_yaw, light_pitch] = yaw_pitch_f64(unit(moment.light));
        let yaw = curve(&self.yaw_keys, relative_yaw, Some(TAU)).unwrap_or(light_yaw);
        let pitch = curve(&self.pitch_keys, relative_pitch, None).unwrap_or(light_pitch);
        let [low, high] = self.limits.map(f64::from);
        Placed {
            axes: DMat3::IDENTITY,
            panorama: Some([wrapped(yaw), pitch.max(low).min(high.max(low))]),
            rotation: 0.0,
            scale: [1.0; 2],
            split: [0.0; 2],
            square: 0.0,
            opacity: 1.0,
        }
    }

    pub(super) fn put(&mut self, moment: &Moment, middle: Vec3) -> Result<(), PlaceError> {
        let [yaw, pitch] = yaw_pitch_f64(unit(middle)).map(|angle| angle as f32);
        let [low, high] = self.limits;
        if pitch < low || pitch > high {
            let [low, high, pitch] = [low, high, pitch].map(f32::to_degrees);
            return Err(PlaceError::Limits(low, high, pitch));
        }
        let [at_yaw, at_pitch] = Self::relative(moment);
        let interpolation = KeyInterpolation::default();
        self.set_yaw_key(AngleKey { at: at_yaw, place: yaw, interpolation });
        self.set_pitch_key(AngleKey { at: at_pitch, place: pitch, interpolation });
        Ok(())
    }

    pub(super) fn validate(&self) -> Result<(), String> {
        let keys = self.yaw_keys.iter().chain(&self.pitch_keys);
        if keys.clone().any(|key| !key.at.is_finite() || !key.place.is_finite()) {
            return Err("has a key that is not a finite number".to_owned());
        }
        let [low, high] = self.limits;
        // Written so that NaN fails, too.
        if !(low <= high && low.is_finite() && high.is_finite()) {
            return Err("has limits that are not a lower and a higher number".to_owned());
        }
        Ok(())
    }
}

fn relative(moment: &Moment) -> [f64; 2] {
    let [light_yaw, light_pitch] = yaw_pitch_f64(unit(moment.light));
    let [view_yaw, view_pitch] = yaw_pitch_f64(unit(moment.view));
    [wrapped(light_yaw - view_yaw), light_pitch - view_pitch]
}

fn insert(keys: &mut Vec<AngleKey>, key: AngleKey, period: Option<f64>) {
    let distance = |other: &AngleKey| {
        let d = f64::from(other.at) - f64::from(key.at);
        period.map_or(d, |_| wrapped(d)).abs()
    };
    keys.retain(|other| distance(other) > SAME);
    let index = keys.partition_point(|other| other.at < key.at);
    keys.insert(index, key);
}

/// The value of keys at an angle, or `None` without keys. With a period the last key goes on to the
/// first one, whose place is taken a whole number of turns away, the nearest way.
fn curve(keys: &[AngleKey], at: f64, period: Option<f64>) -> Option<f64> {
    let count = keys.len();
    let (first, last) = (keys.first()?, keys.last()?);
    if count == 1 {
        return Some(f64::from(first.place));
    }
    // Turns that the place has made after one round of keys.
    let round = period.map_or(0.0, |period| {
        let gap = f64::from(last.place) - f64::from(first.place);
        period * (gap / period).round()
    });
    // Key by number; those beyond the ends are of the next or last round.
    let key = |index: isize| -> Option<(f64, f64, KeyInterpolation)> {
        let turns = index.div_euclid(count as isize);
        let key = keys.get(index.rem_euclid(count as isize) as usize)?;
        let (mut at, mut place) = (f64::from(key.at), f64::from(key.place));
        if turns != 0 {
            at += period? * turns as f64;
            place += round * turns as f64;
        }
        Some((at, place, key.interpolation))
    };
    let next = keys.partition_point(|key| f64::from(key.at) <= at) as isize;
    let Some((at0, place0, interpolation)) = key(next - 1) else {
        return Some(f64::from(first.place));
    };
    let Some((at1, place1, _)) = key(next) else { return Some(place0) };
    // A key holds at its own angle, which is rounded to single precision.
    if at1 - at < ROUNDING {
        return Some(place1);
    }
    let length = at1 - at0;
    let u = if length > 0.0 { ((at - at0) / length).clamp(0.0, 1.0) } else { 0.0 };
    Some(match interpolation {
        KeyInterpolation::Hold => place0,
        KeyInterpolation::Linear => place0 + (place1 - place0) * u,
        KeyInterpolation::Smooth => {
            let before = slope(key(next - 2), (at0, place0), (at1, place1));
            let after = slope(key(next + 1), (at1, place1), (at0, place0));
            hermite([place0, place1], [before * length, after * length], u)
        }
    })
}

/// Slope at `here` between its neighbours: the harmonic mean of both sides weighted by their
/// lengths, and 0 at a turning point or end, so that nothing overshoots (Fritsch and Butland 1984).
fn slope(beyond: Option<(f64, f64, KeyInterpolation)>, here: (f64, f64), there: (f64, f64)) -> f64 {
    let Some((at, place, _)) = beyond else { return 0.0 };
    let (length_a, length_b) = ((here.0 - at).abs(), (there.0 - here.0).abs());
    let (a, b) = ((here.1 - place) / (here.0 - at), (there.1 - here.1) / (there.0 - here.0));
    if a * b <= 0.0 {
        return 0.0;
    }
    let (weight_a, weight_b) = (2.0 * length_b + length_a, length_b + 2.0 * length_a);
    (weight_a + weight_b) / (weight_a / a + weight_b / b)
}

fn hermite([p0, p1]: [f64; 2], [m0, m1]: [f64; 2], u: f64) -> f64 {
    let (u2, u3) = (u * u, u * u * u);
    (2.0 * u3 - 3.0 * u2 + 1.0) * p0
        + (u3 - 2.0 * u2 + u) * m0
        + (3.0 * u2 - 2.0 * u3) * p1
        + (u3 - u2) * m1
}
