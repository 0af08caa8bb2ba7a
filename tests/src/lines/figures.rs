//! How drawn lines lie on expected ones.

use std::collections::HashMap;

use genga::render::{LayerKind, View};
use genga::scene::{Pose, Scene};
use genga::style::Style;
use glam::DVec2;

use super::ink::Ink;
use super::places::{Place, STEP_PX, Seen};
use super::show::leave;
use super::{Line, expected, places};
use crate::eye::Eye;
use crate::reference::{Triangle, cast, triangles};
use crate::scenes::style;

/// Least coverage that counts as ink where there should be none.
pub const FAINT: u8 = 26;
/// Least coverage that counts as a line where there should be one.
const DRAWN: u8 = 64;
/// How far from its place a line may be drawn, in pixels.
const OFF_PX: f64 = 1.5;

/// What was found on one or more pictures.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    /// Pixels with ink.
    pub inked: usize,
    /// Inked pixels farther from every visible line than half the width and 1.5 pixels.
    pub astray: usize,
    /// Length in pixels of the lines that must be seen.
    pub expected_px: f64,
    /// Length of those that have ink within 1.5 pixels across.
    pub covered_px: f64,
    /// Longest stretch without, in pixels.
    pub longest_gap_px: f64,
    /// Pixels of the smallest spot of ink that hangs together; `None` without ink.
    pub smallest_spot: Option<usize>,
    /// Pixels of an object's ink on what hides that part of it.
    pub over: usize,
    /// Where the worst was seen, for people.
    pub places: Vec<String>,
}

impl Figures {
    /// Part of the expected length that is drawn.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        if self.expected_px > 0.0 { self.covered_px / self.expected_px } else { 1.0 }
    }

    /// Figures of both together.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.inked += other.inked;
        self.astray += other.astray;
        self.expected_px += other.expected_px;
        self.covered_px += other.covered_px;
        self.longest_gap_px = self.longest_gap_px.max(other.longest_gap_px);
        self.smallest_spot = match (self.smallest_spot, other.smallest_spot) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        self.over += other.over;
        self.places.extend(other.places);
        self
    }

    /// What is not as it must be, in words.
    #[must_use]
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut check = |holds: bool, fault: String| {
            if !holds {
                faults.push(fault);
            }
        };
        let covered = 100.0 * self.coverage();
        check(covered >= 99.5, format!("{covered:.2} % of the expected length is drawn"));
        let gap = self.longest_gap_px;
        check(gap <= 2.0, format!("a gap of {gap:.1} px"));
        let spot = self.smallest_spot.unwrap_or(usize::MAX);
        check(spot >= 4, format!("a spot of {spot} pixels"));
        check(self.astray == 0, format!("{} of {} pixels are astray", self.astray, self.inked));
        check(self.over == 0, format!("{} pixels lie over what hides them", self.over));
        faults
    }
}

/// A scene with its triangles and expected lines in one view.
pub struct Sight {
    /// The posed triangles.
    pub triangles: Vec<Triangle>,
    /// What is a line.
    pub lines: Vec<Line>,
    /// Places on them.
    pub places: Vec<Place>,
    /// The camera.
    pub eye: Eye,
}

impl Sight {
    /// What a pose shows in a view, creases from 40° on.
    ///
    /// # Panics
    /// If the scene reaches behind the camera.
    #[must_use]
    pub fn new(scene: &Scene, pose: &Pose, view: &View) -> Self {
        let triangles = triangles(scene, pose);
        let eye = Eye::new(view);
        let lines = expected(&triangles, &eye, 40.0);
        let places = places(&lines, &triangles, view);
        Self { triangles, lines, places, eye }
    }

    /// The object (node) of a line.
    #[must_use]
    pub fn owner(&self, line: usize) -> usize {
        self.triangles[self.lines[line].faces[0]].owner.0
    }
}

/// A style of `contour` alone with lines that wide in pixels, and more of the set's keys.
#[must_use]
pub fn contour_style(width: f64, height: u32, rest: &str) -> Style {
    style(&format!(
        "[light]\nreplace_model_lights = true\n[lines]\nmethod = \"contour\"\n\
         reference_height = {height}\n[[lines.sets]]\nname = \"lines\"\nwidth = {width}\n{rest}"
    ))
}

/// Draws the scene with lines `width` pixels wide and measures all of them.
///
/// # Panics
/// If the scene cannot be drawn, or reaches behind the camera.
#[must_use]
pub fn measure(scene: &Scene, width: f64, view: &View) -> Figures {
    let (ink, sight) = look(scene, width, view);
    compare(&ink, &sight, width)
}

/// Draws the scene with lines `width` pixels wide, and says where they should be.
///
/// # Panics
/// If the scene cannot be drawn, or reaches behind the camera.
#[must_use]
pub fn look(scene: &Scene, width: f64, view: &View) -> (Ink, Sight) {
    let style = contour_style(width, view.size[1], "");
    let picture = crate::draw_layers(scene, &style, view, &[LayerKind::Lines]);
    (Ink::of(&picture), Sight::new(scene, &Pose::rest(scene), view))
}

/// Compares drawn lines with expected ones.
#[must_use]
pub fn compare(ink: &Ink, sight: &Sight, width: f64) -> Figures {
    let mut figures = Figures::default();
    stray(ink, sight, width, &mut figures);
    gaps(ink, sight, &mut figures);
    let spots = ink.components(|x, y| ink.at(i64::from(x), i64::from(y)) >= FAINT);
    let whole = spots.iter().filter(|spot| !spot.at_border);
    if let Some(spot) = whole.min_by_key(|spot| spot.pixels.len()) {
        figures.smallest_spot = Some(spot.pixels.len());
        if spot.pixels.len() < 4 {
            figures.places.push(format!("spot of {} at {:?}", spot.pixels.len(), spot.pixels[0]));
        }
    }
    figures
}

/// Pixels within `reach` of any of the places.
fn round(places: impl Iterator<Item = DVec2>, reach: f64, size: [u32; 2]) -> Vec<bool> {
    let mut is_near = vec![false; (size[0] * size[1]) as usize];
    for p in places {
        let range = |at: f64, size: u32| {
            (at - reach - 0.5).clamp(0.0, f64::from(size)) as u32
                ..(at + reach + 1.0).clamp(0.0, f64::from(size)) as u32
        };
        for y in range(p.y, size[1]) {
            for x in range(p.x, size[0]) {
                let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                is_near[(y * size[0] + x) as usize] |= (middle - p).length() <= reach;
            }
        }
    }
    is_near
}

fn stray(ink: &Ink, sight: &Sight, width: f64, figures: &mut Figures) {
    let visible = sight.places.iter().filter(|place| place.seen != Seen::Not);
    let reach = 0.5 * width + OFF_PX + 0.5 * STEP_PX;
    let is_near = round(visible.map(|place| place.p_px), reach, [ink.width, ink.height]);
    for (x, y) in ink.places(FAINT) {
        figures.inked += 1;
        // Lines beyond the picture's border have no places.
        let reach = reach.ceil() as u32;
        let inside = x >= reach && y >= reach && x + reach < ink.width && y + reach < ink.height;
        if inside && !is_near[(y * ink.width + x) as usize] {
            figures.astray += 1;
            figures.places.push(format!("astray at ({x}, {y})"));
        }
    }
}

fn gaps(ink: &Ink, sight: &Sight, figures: &mut Figures) {
    let mut bare: Vec<&Place> = Vec::new();
    let border = OFF_PX + 1.0;
    for place in sight.places.iter().filter(|place| place.seen == Seen::Wholly) {
        let p = place.p_px;
        let far = DVec2::new(f64::from(ink.width), f64::from(ink.height)) - border;
        if p.cmplt(DVec2::splat(border)).any() || p.cmpgt(far).any() {
            continue;
        }
        let ends = sight.lines[place.line].ends.map(|end| sight.eye.project(end));
        let across = (ends[1] - ends[0]).normalize_or(DVec2::X).perp();
        let is_drawn = (-3..=3).any(|i| {
            let at = p + across * (f64::from(i) * OFF_PX / 3.0);
            ink.at(at.x.floor() as i64, at.y.floor() as i64) >= DRAWN
        });
        figures.expected_px += place.length_px;
        if is_drawn {
            figures.covered_px += place.length_px;
        } else {
            bare.push(place);
        }
    }
    let Some((gap, at)) = longest_cluster(&bare) else { return };
    figures.longest_gap_px = gap;
    if gap > 2.0 {
        let line = &sight.lines[at.line];
        let owner = sight.owner(at.line);
        figures.places.push(format!(
            "gap of {gap:.1} px round ({:.0}, {:.0}): {:?} of object {owner}",
            at.p_px.x, at.p_px.y, line.kind
        ));
    }
}

/// The largest extent of places that follow each other, and one of them.
fn longest_cluster<'a>(places: &[&'a Place]) -> Option<(f64, &'a Place)> {
    let cell = |p: DVec2| (p.x.floor() as i64, p.y.floor() as i64);
    let mut cells: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for (i, place) in places.iter().enumerate() {
        cells.entry(cell(place.p_px)).or_default().push(i);
    }
    let mut is_left = vec![true; places.len()];
    let mut longest: Option<(f64, &Place)> = None;
    for first in 0..places.len() {
        if !std::mem::take(&mut is_left[first]) {
            continue;
        }
        let (mut low, mut high) = (places[first].p_px, places[first].p_px);
        let mut queue = vec![first];
        while let Some(i) = queue.pop() {
            let p = places[i].p_px;
            (low, high) = (low.min(p), high.max(p));
            let (x, y) = cell(p);
            for near in (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y))) {
                for &j in cells.get(&near).into_iter().flatten() {
                    if is_left[j] && (places[j].p_px - p).length() <= 2.0 * STEP_PX {
                        is_left[j] = false;
                        queue.push(j);
                    }
                }
            }
        }
        let extent = (high - low).length() + STEP_PX;
        if longest.is_none_or(|(most, _)| extent > most) {
            longest = Some((extent, places[first]));
        }
    }
    longest
}

/// Draws each object's lines alone and counts those of its pixels that lie on what hides them.
/// Where there are any, a picture of that name is left in `out/lines`.
///
/// # Panics
/// If the scene cannot be drawn, or reaches behind the camera.
#[must_use]
pub fn measure_owners(scene: &Scene, width: f64, view: &View, name_of_picture: &str) -> Figures {
    let sight = Sight::new(scene, &Pose::rest(scene), view);
    let hits = cast(view, &sight.triangles);
    let mut figures = Figures::default();
    let reach = 0.5 * width + OFF_PX;
    let size = DVec2::new(f64::from(view.size[0]), f64::from(view.size[1]));
    for (node, name) in scene.nodes.iter().enumerate().map(|(n, node)| (n, &node.name)) {
        if scene.nodes[node].mesh.is_none() {
            continue;
        }
        let style = contour_style(width, view.size[1], &format!("objects = [\"{name}\"]"));
        let picture = crate::draw_layers(scene, &style, view, &[LayerKind::Lines]);
        let ink = Ink::of(&picture);
        let mut own: HashMap<(i64, i64), Vec<&Place>> = HashMap::new();
        for place in sight.places.iter().filter(|place| {
            let faces = sight.lines[place.line].faces;
            faces.iter().any(|&f| sight.triangles[f].owner.0 == node)
        }) {
            let p = place.p_px.floor();
            own.entry((p.x as i64, p.y as i64)).or_default().push(place);
        }
        let before_this = figures.over;
        let seen = |x: u32, y: u32| hits[(y * view.size[0] + x) as usize];
        for (x, y) in ink.places(FAINT) {
            let inside = x > 0 && y > 0 && x + 1 < ink.width && y + 1 < ink.height;
            let Some(hit) = seen(x, y) else { continue };
            let before = sight.triangles[hit.triangle].owner.0;
            let in_front = |x, y| {
                seen(x, y).is_some_and(|hit| sight.triangles[hit.triangle].owner.0 == before)
            };
            // The antialiased rim of what lies before belongs to both.
            let is_rim =
                !inside || (y - 1..=y + 1).any(|y| (x - 1..=x + 1).any(|x| !in_front(x, y)));
            if before == node || is_rim {
                continue;
            }
            let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let beside = &sight.triangles[hit.triangle];
            let cells = reach.ceil() as i64;
            let (column, row) = (i64::from(x), i64::from(y));
            let near = (row - cells..=row + cells)
                .flat_map(|y| (column - cells..=column + cells).map(move |x| (x, y)))
                .filter_map(|cell| own.get(&cell))
                .flatten()
                .filter(|place| (place.p_px - middle).length() <= reach);
            let mut any = false;
            let mut all_hidden = true;
            for place in near {
                any = true;
                // What hides it there; beyond its edge, as it would go on.
                let nearest = (-1..=1)
                    .flat_map(|y| (-1..=1).map(move |x| DVec2::new(f64::from(x), f64::from(y))))
                    .map(|step| (place.p_px + step).floor())
                    .filter(|at| at.cmpge(DVec2::ZERO).all() && at.cmplt(size).all())
                    .filter_map(|at| Some((at, seen(at.x as u32, at.y as u32)?.triangle)))
                    .filter(|(_, triangle)| sight.triangles[*triangle].owner.0 == before)
                    .min_by(|(a, _), (b, _)| {
                        let away = |at: &DVec2| (*at + 0.5 - place.p_px).length();
                        away(a).total_cmp(&away(b))
                    });
                let plane = nearest.map_or(beside, |(_, triangle)| &sight.triangles[triangle]);
                let ray = sight.eye.ray(place.p_px);
                let along = ray.direction.dot(plane.outward);
                let t = (plane.corners[0] - ray.origin).dot(plane.outward) / along;
                let distance = sight.eye.distance(place.p);
                all_hidden &= along != 0.0 && t < distance - 3.0 * sight.eye.footprint(distance);
            }
            if any && all_hidden {
                figures.over += 1;
                figures.places.push(format!("'{name}' drawn over object {before} at ({x}, {y})"));
            }
        }
        if figures.over > before_this {
            leave(&ink, &sight, &format!("{name_of_picture}-{name}"));
        }
    }
    figures
}
