//! Shadow maps: which light has which, and where they look.

use glam::{Affine3A, DMat4, DVec2, DVec3, DVec4, Mat4, Vec3};

use super::{Prepared, beams::BEAM_SHADOW_MAPS};
use crate::render::{
    View,
    generated::{LIGHT_BEAM, LIGHT_DIRECTIONAL, LIGHT_SPOT, Light, ShadowMap},
    gpu::bindings,
    layouts::Layouts,
    targets::DEPTH_FORMAT,
    view::Projected,
};
use crate::scene::{Aabb, Pose, Scene};
use crate::style::Style;

/// Most shadow maps of one frame, as in `shaders/lib/bindings.wesl`.
pub(crate) const MAX_MAPS: usize = 16;
/// Most maps of a light whose rays are parallel, as in `shaders/shading/shadow.wesl`.
pub(crate) const MAX_CASCADES: usize = 4;
/// How many times as far as its beginning a cascade ends, where there are enough of them: texels are
/// the size of pixels at its end, and so much larger at its beginning.
const CASCADE_LENGTH: f64 = 2.5;
/// How far the nearest cascade begins before the end of the farthest one at most.
const DEEPEST: f64 = 512.0;
/// Texels round what a map must show, for the taps and the snapping of its origin.
const BORDER: f64 = 8.0;

/// The shadow maps of a prepared scene.
pub(crate) struct Shadows {
    /// One layer a map; a single texel without shadows.
    pub(crate) depths: wgpu::TextureView,
    pub(crate) nearest: wgpu::Sampler,
    /// All maps, for the passes that read them.
    pub(crate) values: wgpu::Buffer,
    /// What the shadow pass draws into, and its uniforms; empty without shadows.
    pub(crate) layers: Vec<wgpu::TextureView>,
    uniforms: wgpu::Buffer,
    /// Texels of a layer's side.
    resolution: u32,
    /// Group 0 of the shadow pass.
    pub(crate) group: wgpu::BindGroup,
}

impl Shadows {
    /// Makes as many maps as the scene's lights need: see [`maps_needed`].
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        layouts: &Layouts,
        draws: &wgpu::Buffer,
        [wanted, parallel]: [usize; 2],
        resolution: u32,
    ) -> Self {
        use wgpu::{BufferUsages as Usage, TextureUsages};
        let count = (wanted + parallel * (MAX_CASCADES - 1)).min(MAX_MAPS);
        let resolution = if count == 0 { 1 } else { resolution };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("shadow maps"),
            size: wgpu::Extent3d {
                width: resolution,
                height: resolution,
                depth_or_array_layers: count.max(1) as u32,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let layer = |layer: usize| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer as u32,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let none: ShadowMap = bytemuck::Zeroable::zeroed();
        let uniforms = bindings::dynamic_uniforms(device, queue, "shadow map", &[none; MAX_MAPS]);
        Self {
            depths: texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            }),
            nearest: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("nearest"),
                ..Default::default()
            }),
            values: bindings::buffer(
                device,
                queue,
                "shadow maps",
                Usage::UNIFORM,
                &[none; MAX_MAPS],
            ),
            layers: (0..count).map(layer).collect(),
            resolution,
            group: bindings::group(
                device,
                "shadow",
                &layouts.shadow,
                &[
                    (0, super::dynamic_binding::<ShadowMap>(&uniforms)),
                    (1, draws.as_entire_binding()),
                ],
            ),
            uniforms,
        }
    }

    /// Whether anything is drawn and looked up.
    pub(crate) fn any(&self) -> bool {
        !self.layers.is_empty()
    }

    /// Shares the maps out among the lights and writes where they look. Returns how many texels
    /// along a side each of them has.
    pub(crate) fn write(
        &self,
        queue: &wgpu::Queue,
        prepared: &Prepared,
        view: &View,
        projected: &Projected,
        lights: &mut [Light],
    ) -> Vec<u32> {
        let texels = used_texels(view).min(self.resolution);
        let mut maps: Vec<ShadowMap> = Vec::new();
        let needed: usize = lights.iter().map(|light| light.shadow_maps as usize).sum();
        let mut spare = self.layers.len().saturating_sub(needed);
        let is_parallel = |l: &&mut Light| l.kind == LIGHT_DIRECTIONAL && l.shadow_maps > 0;
        let mut parallel_left = lights.iter_mut().filter(is_parallel).count();
        for light in lights {
            let count = std::mem::take(&mut light.shadow_maps);
            let Some(bounds) = prepared.bounds else { continue };
            if count == 0 || maps.len() + count as usize > self.layers.len() {
                continue;
            }
            light.shadow_first = maps.len() as u32;
            light.shadow_maps = count;
            match light.kind {
                LIGHT_DIRECTIONAL => {
                    let most = 1 + (spare / parallel_left.max(1)).min(MAX_CASCADES - 1);
                    parallel_left = parallel_left.saturating_sub(1);
                    let slices = slices(&bounds, projected, most);
                    spare -= slices.len() - 1;
                    light.shadow_maps = slices.len() as u32;
                    maps.extend(
                        slices.iter().map(|&s| parallel(light, &bounds, projected, s, texels)),
                    );
                }
                kind => {
                    // Of the size of a pixel where the scene is.
                    let center = 0.5 * (bounds.min + bounds.max);
                    let pixel = projected.pixel_at(center) / view.supersample.max(1) as f32;
                    let away = lamp(light).distance(center);
                    let is_cone = kind == LIGHT_SPOT && count == 1;
                    let tangent = if is_cone { outer_angle(light).tan() as f32 } else { 1.0 };
                    let wanted = 2.0 * tangent * away / pixel.max(1e-12);
                    let texels = (wanted.min(8192.0) as u32).next_power_of_two();
                    let texels = texels.clamp(256.min(self.resolution), self.resolution);
                    if is_cone {
                        maps.push(cone(light, &bounds, texels));
                    } else {
                        maps.extend(cube(light, &bounds, texels));
                    }
                }
            }
        }
        let stride = bindings::DYNAMIC_STRIDE;
        for (i, map) in maps.iter().enumerate() {
            queue.write_buffer(&self.uniforms, i as u64 * stride, bytemuck::bytes_of(map));
        }
        queue.write_buffer(&self.values, 0, bytemuck::cast_slice(&maps));
        maps.iter().map(|map| map.texels as u32).collect()
    }
}

/// Texels of a map of all that is in view. They are a little smaller than pixels: a few of them are
/// smoothed to an edge, and where those are less than a pixel, the edge is not in its place.
fn used_texels(view: &View) -> u32 {
    let longest = view.size[0].max(view.size[1]).max(1) * view.supersample.max(1);
    longest.next_power_of_two().max(256)
}

/// Where the rays of a light come from; those of a beam's light as if all did from its middle.
fn lamp(light: &Light) -> Vec3 {
    let along = if light.kind == LIGHT_BEAM { 0.5 } else { 0.0 };
    (light.position + along * light.direction).truncate()
}

/// Half angle of a spot's cone in radians.
fn outer_angle(light: &Light) -> f64 {
    f64::from(light.factors.w).clamp(-1.0, 1.0).acos()
}

/// How many maps the lights of a scene need, if the style has shadows, and how many of these are of
/// parallel rays, which may take more.
pub(crate) fn maps_needed(scene: &Scene, pose: &Pose, style: &Style) -> [usize; 2] {
    if !style.paint.shadow.enabled {
        return [0; 2];
    }
    let placed = super::lights::placed_lights(scene, pose, style);
    let lights = super::lights::lights_in_view(&placed, &style.light, &Affine3A::IDENTITY);
    let parallel =
        lights.iter().filter(|l| l.kind == LIGHT_DIRECTIONAL && l.shadow_maps > 0).count();
    let beams = scene.beams.iter().filter(|b| b.light.is_some_and(|light| light.casts_shadow));
    let of_lights: usize = lights.iter().map(|light| light.shadow_maps as usize).sum();
    [of_lights + beams.count() * BEAM_SHADOW_MAPS as usize, parallel]
}

/// Depths between which each cascade lies, from near to far: at most `most`, and one where the scene is
/// about as near everywhere (Engel 2006).
fn slices(bounds: &Aabb, projected: &Projected, most: usize) -> Vec<[f64; 2]> {
    const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let clip_from_world = projected.clip_from_world.as_dmat4();
    let seen = in_view(&corners(bounds), clip_from_world, ALL);
    let depths = seen.iter().map(|p| clip_from_world.row(3).dot(p.extend(1.0)));
    let (near, far) = depths.fold((f64::INFINITY, 0.0_f64), |(n, f), d| (n.min(d), f.max(d)));
    let near = near.max(far / DEEPEST);
    if projected.orthographic || !(near > 0.0 && far > near && far.is_finite()) {
        return vec![ALL];
    }
    let count = ((far / near).ln() / CASCADE_LENGTH.ln()).ceil().clamp(1.0, most.max(1) as f64);
    let end = |i: usize| near * (far / near).powf(i as f64 / count);
    let count = count as usize;
    let slice = |i: usize| {
        // They overlap by what a pixel may reach over.
        let from = if i == 0 { f64::NEG_INFINITY } else { 0.85 * end(i) };
        [from, if i + 1 == count { f64::INFINITY } else { end(i + 1) }]
    };
    (0..count).map(slice).collect()
}

/// Parallel rays onto what is in view of the scene between two depths.
///
/// The grid of texels stands still in the world: its axes come from the light alone, its texels
/// have one of few sizes, and its origin is a whole number of them. So edges do not swim when the
/// camera moves.
fn parallel(
    light: &Light,
    bounds: &Aabb,
    projected: &Projected,
    slice: [f64; 2],
    texels: u32,
) -> ShadowMap {
    let back = light.direction.truncate().as_dvec3().normalize_or(DVec3::Y);
    let axes = axes_of(back);
    let in_light = |p: DVec3| DVec3::new(p.dot(axes[0]), p.dot(axes[1]), p.dot(back));
    let corners = corners(bounds);
    let mut seen = in_view(&corners, projected.clip_from_world.as_dmat4(), slice);
    if seen.is_empty() {
        seen = corners.to_vec();
    }
    let extent = |points: &[DVec3]| {
        points
            .iter()
            .map(|&p| in_light(p))
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
                (low.min(p), high.max(p))
            })
    };
    let ((low, high), (all_low, all_high)) = (extent(&seen), extent(&corners));
    let used = f64::from(texels) - 2.0 * BORDER;
    let texel = (high - low).truncate().map(|side| {
        // Steps of a fifth.
        let side = side.max(1e-9);
        2_f64.powf((4.0 * side.log2()).ceil() / 4.0) / used
    });
    let origin = (low.truncate() / texel).floor() * texel - BORDER * texel;
    let size = texel * f64::from(texels);
    let margin = 1e-3 * (all_high.z - all_low.z).max(1e-9) + texel.max_element() * 4.0;
    let (near, far) = (all_high.z + margin, all_low.z - margin);
    let depth = 1.0 / (near - far);
    let scale = DVec2::new(2.0, 2.0) / size;
    let row = |axis: DVec3, scale: f64, offset: f64| (axis * scale).extend(offset);
    let clip_from_world = DMat4::from_cols(
        row(axes[0], scale.x, -origin.x * scale.x - 1.0),
        row(axes[1], scale.y, -origin.y * scale.y - 1.0),
        row(back, depth, -far * depth),
        DVec4::W,
    )
    .transpose();
    shadow_map(clip_from_world, texels, texel.max_element(), depth, false)
}

/// A spot's cone.
fn cone(light: &Light, bounds: &Aabb, texels: u32) -> ShadowMap {
    let back = -light.direction.truncate().as_dvec3().normalize_or(DVec3::NEG_Z);
    perspective(light, back, axes_of(back), outer_angle(light).tan(), bounds, texels)
}

/// The six sides of a cube round a light: +X, −X, +Y, −Y, +Z, −Z.
fn cube(light: &Light, bounds: &Aabb, texels: u32) -> [ShadowMap; 6] {
    let sides = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    sides.map(|side| perspective(light, -side, axes_of(-side), 1.0, bounds, texels))
}

fn perspective(
    light: &Light,
    back: DVec3,
    axes: [DVec3; 2],
    tangent: f64,
    bounds: &Aabb,
    texels: u32,
) -> ShadowMap {
    let at = lamp(light).as_dvec3();
    let farthest = corners(bounds).iter().map(|p| p.distance(at)).fold(0.0, f64::max);
    let near = (1e-4 * farthest).max(1e-9);
    // The border lies outside of the cone.
    let tangent = tangent * f64::from(texels) / (f64::from(texels) - 2.0 * BORDER);
    let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(at) * scale);
    let clip_from_world = DMat4::from_cols(
        row(axes[0], 1.0 / tangent),
        row(axes[1], 1.0 / tangent),
        DVec4::W * near,
        row(-back, 1.0),
    )
    .transpose();
    shadow_map(clip_from_world, texels, 2.0 * tangent / f64::from(texels), near, true)
}

fn shadow_map(
    clip_from_world: DMat4,
    texels: u32,
    texel_m: f64,
    depth_scale: f64,
    is_perspective: bool,
) -> ShadowMap {
    ShadowMap {
        clip_from_world: clip_from_world.as_mat4(),
        clip_from_plane: finite(clip_from_world.inverse().transpose().as_mat4()),
        texels: texels as f32,
        texel_m: texel_m as f32,
        depth_scale: depth_scale as f32,
        is_perspective: f32::from(u8::from(is_perspective)),
    }
}

fn finite(matrix: Mat4) -> Mat4 {
    if matrix.is_finite() { matrix } else { Mat4::IDENTITY }
}

/// Two axes across a direction that depend on nothing else.
fn axes_of(back: DVec3) -> [DVec3; 2] {
    let up = if back.y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
    let right = up.cross(back).normalize_or(DVec3::X);
    [right, back.cross(right)]
}

/// The corners of a box, without sides of no length.
fn corners(bounds: &Aabb) -> [DVec3; 8] {
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
        DVec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z))
    })
}

/// The corners of the part of a box that a view shows between two depths; none if it shows none of it.
fn in_view(corners: &[DVec3; 8], clip_from_world: DMat4, [from, to]: [f64; 2]) -> Vec<DVec3> {
    let rows = clip_from_world.transpose();
    let [x, y, z, w] = [rows.x_axis, rows.y_axis, rows.z_axis, rows.w_axis];
    let mut planes = vec![w + x, w - x, w + y, w - y, w - z];
    if from.is_finite() {
        planes.push(w - DVec4::W * from);
    }
    if to.is_finite() {
        planes.push(DVec4::W * to - w);
    }
    let sides =
        [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let mut seen = Vec::new();
    for side in sides {
        let mut polygon: Vec<DVec3> = side.iter().map(|&corner| corners[corner]).collect();
        for plane in planes.iter().copied() {
            polygon = clipped(&polygon, plane);
        }
        seen.extend(polygon);
    }
    // Inside of the box, the view's own corners at its ends: reverse-Z depth is near / w.
    let (low, high) = (corners[0], corners[7]);
    let world_from_clip = clip_from_world.inverse();
    let near = z.w;
    let ends = [from, to].into_iter().filter(|&depth| depth.is_finite() && depth > near);
    let ends = ends.map(|depth| near / depth).chain((!from.is_finite()).then_some(1.0));
    for depth in ends {
        for [x, y] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
            let p = world_from_clip.project_point3(DVec3::new(x, y, depth));
            if p.is_finite() && p.cmpge(low).all() && p.cmple(high).all() {
                seen.push(p);
            }
        }
    }
    seen
}

/// The part of a polygon on the positive side of a plane (Sutherland and Hodgman 1974).
fn clipped(polygon: &[DVec3], plane: DVec4) -> Vec<DVec3> {
    let distance = |p: DVec3| plane.dot(p.extend(1.0));
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (da, db) = (distance(a), distance(b));
        if da >= 0.0 {
            kept.push(a);
        }
        if (da < 0.0) != (db < 0.0) {
            kept.push(a.lerp(b, da / (da - db)));
        }
    }
    kept
}

#[cfg(test)]
#[path = "shadows_tests.rs"]
mod tests;
