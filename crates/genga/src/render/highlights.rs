//! Highlights as a user interface sees them: where each stands, and placing one by hand.

use glam::{Vec2, Vec3};

use super::{
    RenderError, View,
    generated::Light,
    prepare::{Prepared, lights::lights_in_view},
};
use crate::scene::{Highlight, Moment, PlaceError, Placed, Pose, Scene};

/// Where a highlight stands in a view.
#[derive(Clone, Debug, PartialEq)]
pub struct HighlightState {
    /// Its index in [`Scene::highlights`].
    pub index: usize,
    /// Its name.
    pub name: String,
    /// Light and view in its frame.
    pub moment: Moment,
    /// Where its keys put it.
    pub placed: Placed,
    /// The unit normal, in its frame, where an eye in the direction of the view sees its middle.
    pub normal: Vec3,
}

impl Prepared {
    /// The highlights with their keys as they are drawn.
    #[must_use]
    pub fn highlights(&self) -> &[Highlight] {
        &self.highlights.items
    }

    /// Where each highlight stands in a view, in the present pose.
    #[must_use]
    pub fn highlight_states(&self, view: &View) -> Vec<HighlightState> {
        let lights = self.lights_in(view);
        let state = |(index, highlight): (usize, &Highlight)| {
            let (_, moment) = self.highlights.moment(index, &self.lights, &lights, view)?;
            let placed = highlight.placement.evaluate(&moment);
            let between = placed.middle() + moment.view.as_dvec3();
            let normal = between.as_vec3().normalize_or(Vec3::Z);
            Some(HighlightState { index, name: highlight.name.clone(), moment, placed, normal })
        };
        self.highlights.items.iter().enumerate().filter_map(state).collect()
    }

    /// Takes over another state of a highlight: its keys, size, colour and whatever else is not
    /// uploaded. Drawing, mask, tone, proxy mesh, node, and the surfaces that it lies on stay
    /// those that were prepared.
    ///
    /// # Errors
    /// A highlight that is not valid, or an index out of range.
    pub fn set_highlight(&mut self, index: usize, highlight: Highlight) -> Result<(), RenderError> {
        let wrong = |reason: String| RenderError::View { reason };
        highlight.validate(self.node_count).map_err(|problem| {
            wrong(format!("highlight {index} '{}' {problem}", highlight.name))
        })?;
        match self.highlights.items.get_mut(index) {
            Some(slot) => *slot = highlight,
            None => return Err(wrong(PlaceError::NoHighlight(index).to_string())),
        }
        Ok(())
    }

    /// Sets keys of a highlight so that its middle stands at `pixel` (from the picture's top left,
    /// the first pixel's middle at 0.5) for this light and view: what a drag does. `scene` and
    /// `pose` are those that are shown. Read the keys back with [`Self::highlights`].
    ///
    /// # Errors
    /// Why it cannot stand there.
    pub fn put_highlight(
        &mut self,
        index: usize,
        scene: &Scene,
        pose: &Pose,
        view: &View,
        pixel: Vec2,
    ) -> Result<(), PlaceError> {
        let lights = self.lights_in(view);
        let setting = self.highlights.moment(index, &self.lights, &lights, view);
        let (frame, moment) = setting.ok_or(PlaceError::NoHighlight(index))?;
        let [origin, direction] = view.ray(pixel);
        let hit = scene.pick(pose, origin, direction).ok_or(PlaceError::NoSurface)?;
        if !self.highlights.carries(scene, index, hit.node, hit.primitive) {
            return Err(PlaceError::OtherSurface);
        }
        let highlight =
            self.highlights.items.get_mut(index).ok_or(PlaceError::NoHighlight(index))?;
        let to_eye = view.camera.to_eye(hit.point);
        let middle = frame.reflected(highlight, hit.point, hit.normal, to_eye);
        highlight.placement.put(&moment, middle)
    }

    fn lights_in(&self, view: &View) -> Vec<Light> {
        lights_in_view(&self.lights, &self.style.light, &view.camera.world_from_camera)
    }
}
