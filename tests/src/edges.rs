//! Drawn lines against the edges of the mesh, projected in f64: is all ink near an edge, and has
//! every visible edge ink?

use std::collections::HashMap;

use genga::render::{LayerKind, Orbit, View};
use genga::scene::{Pose, Scene};
use glam::{DVec2, DVec3};

use crate::eye::Eye;
use crate::pixels::Pixels;
use crate::reference::{Triangle, distance_to_segment, triangles};
use crate::scenes::{orbit_view, style};

/// How lines lie on edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct Figures {
    /// Pixels with at least a tenth of ink.
    pub inked: usize,
    /// Inked pixels whose middle is farther from every edge than the line's width.
    pub astray: usize,
    /// Largest distance in pixels from the middle of an inked pixel to an edge.
    pub farthest_px: f64,
    /// Inked pixels whose middle is farther from what is visible of the edges than the line's
    /// width.
    pub hidden: usize,
    /// Places of visible edges that were looked at, half a pixel apart.
    pub places: usize,
    /// Those beside a pixel with at least half ink.
    pub covered: usize,
}

impl Figures {
    /// Part of the places that have ink.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        self.covered as f64 / self.places.max(1) as f64
    }

    /// Figures of both together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            inked: self.inked + other.inked,
            astray: self.astray + other.astray,
            farthest_px: self.farthest_px.max(other.farthest_px),
            hidden: self.hidden + other.hidden,
            places: self.places + other.places,
            covered: self.covered + other.covered,
        }
    }
}

/// Smallest angle between two faces whose edge is a crease, as styles have it by default.
const CREASE_DEG: f64 = 40.0;

/// The edges that can be lines in a view: silhouettes, creases, borders and material seams of
/// faces that are turned to the eye.
#[must_use]
pub fn line_edges(triangles: &[Triangle], eye: &Eye) -> Vec<[DVec3; 2]> {
    let bits = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut faces: HashMap<_, Vec<&Triangle>> = HashMap::new();
    let mut ends = HashMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle.corners;
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let key = (triangle.owner.0, bits(p).min(bits(q)), bits(p).max(bits(q)));
            faces.entry(key).or_default().push(triangle);
            ends.insert(key, [p, q]);
        }
    }
    let mut edges: Vec<_> = faces
        .into_iter()
        .filter(|(_, faces)| {
            let turned = |t: &Triangle| t.double_sided || t.faces(eye);
            match faces[..] {
                [a, b] => {
                    let angle = a.outward.angle_between(b.outward).to_degrees();
                    let is_line =
                        a.faces(eye) != b.faces(eye) || angle > CREASE_DEG || a.owner != b.owner;
                    is_line && (turned(a) || turned(b))
                }
                _ => faces.iter().any(|t| turned(t)),
            }
        })
        .map(|(key, _)| (key, ends[&key]))
        .collect();
    edges.sort_by_key(|(key, _)| *key);
    edges.into_iter().map(|(_, ends)| ends).collect()
}

/// Whether nothing lies before a point of the scene's surface.
fn is_visible(p: DVec3, triangles: &[Triangle], eye: &Eye) -> bool {
    let distance = eye.distance(p);
    let ray = eye.ray(eye.project(p));
    triangles.iter().filter(|t| t.double_sided || t.faces(eye)).all(|triangle| {
        ray.meets(triangle.corners).is_none_or(|(t, _)| t > distance - 1e-6 * distance.abs())
    })
}

/// Draws the scene with lines `width` pixels wide and measures them.
///
/// # Panics
/// If the scene cannot be drawn, or reaches behind the camera.
#[must_use]
pub fn measure(scene: &Scene, method: &str, width: f64, view: &View) -> Figures {
    let height = view.size[1];
    let style = style(&format!(
        "[light]\nreplace_model_lights = true\n[lines]\nmethod = \"{method}\"\n\
         reference_height = {height}\n[[lines.sets]]\nwidth = {width}"
    ));
    let picture = crate::draw_layers(scene, &style, view, &[LayerKind::Lines]);
    let triangles = triangles(scene, &Pose::rest(scene));
    let eye = Eye::new(view);
    let edges: Vec<[DVec3; 2]> = line_edges(&triangles, &eye);
    assert!(edges.iter().flatten().all(|&p| eye.distance(p) > eye.near), "behind the camera");
    let drawn: Vec<[DVec2; 2]> = edges.iter().map(|ends| ends.map(|p| eye.project(p))).collect();

    let mut figures = Figures::default();
    let inside = |p_px: DVec2| {
        p_px.cmpge(DVec2::ONE).all()
            && p_px.x < f64::from(view.size[0]) - 1.0
            && p_px.y < f64::from(view.size[1]) - 1.0
    };
    let mut visible = Vec::new();
    for (ends, [a, b]) in edges.iter().zip(&drawn) {
        let steps = ((*b - *a).length() * 2.0).ceil().max(1.0) as usize;
        for i in 0..steps {
            // Even steps in space are not even on the picture, but close enough.
            let p = ends[0].lerp(ends[1], (i as f64 + 0.5) / steps as f64);
            if is_visible(p, &triangles, &eye) {
                visible.push(eye.project(p));
            }
        }
    }
    for p_px in visible.iter().filter(|p_px| inside(**p_px)) {
        figures.places += 1;
        // The four pixels whose middles are nearest; the line passes one of them within 0.36 px.
        let first = (p_px - 0.5).as_uvec2();
        let around = [(0, 0), (1, 0), (0, 1), (1, 1)];
        let ink = around.map(|(x, y)| picture.ink(first.x + x, first.y + y));
        figures.covered += usize::from(ink.into_iter().any(|ink| ink >= 128));
    }
    for (x, y) in picture.places().filter(|&(x, y)| picture.ink(x, y) >= 26) {
        let p_px = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let distances = drawn.iter().map(|&edge| distance_to_segment(p_px, edge));
        let nearest = distances.fold(f64::INFINITY, f64::min);
        figures.inked += 1;
        figures.farthest_px = figures.farthest_px.max(nearest);
        figures.astray += usize::from(nearest > width);
        // A quarter of a pixel for the steps between the places.
        let is_near = |place: &DVec2| (*place - p_px).length() <= width + 0.25;
        figures.hidden += usize::from(!visible.iter().any(is_near));
    }
    figures
}

/// Cameras round a scene, near and far in turn; all of the scene is before each of them.
#[must_use]
pub fn cameras(scene: &Scene, count: u32, size: [u32; 2]) -> Vec<View> {
    (0..count)
        .map(|i| {
            let orbit = Orbit {
                azimuth_deg: -170.0 + 360.0 / count as f32 * i as f32,
                elevation_deg: 8.0 + 13.0 * (i % 4) as f32,
                zoom: if i % 2 == 0 { 2.0 } else { 0.5 },
                orthographic: i % 5 == 4,
                ..Orbit::default()
            };
            View { supersample: 1, ..orbit_view(scene, &orbit, size) }
        })
        .collect()
}
