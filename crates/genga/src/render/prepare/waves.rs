//! Waves of a scene → buffers for `waves_bake`, `waves_tiles` and `waves`.

use glam::{DVec3, UVec2, Vec2, Vec3, Vec4};

use crate::render::{
    frame::{Output, Tile},
    generated::{self as gpu, Glow, Wave as GpuWave, WaveCurve as GpuCurve, WaveNode, WaveView},
    gpu::bindings,
    view::{Projected, View},
};
use crate::scene::{
    MAX_WAVES, Pose, Projection, Wave, WaveBlend, WaveMethod, WaveOrder, WaveShape,
    wave_curve::{WaveCurve, domain},
};
use crate::srgb::linear_from_srgb;
use crate::style::{BlendSpace, Style};

/// The waves of a scene at a pose.
pub(crate) struct WaveData {
    /// A [`WaveView`].
    pub(crate) view: wgpu::Buffer,
    pub(crate) waves: wgpu::Buffer,
    /// Whatever has no fixed length.
    pub(crate) data: wgpu::Buffer,
    pub(crate) nodes: wgpu::Buffer,
    /// A [`Glow`].
    pub(crate) glow: wgpu::Buffer,
    pub(crate) count: u32,
    pub(crate) most_leaves: u32,
    /// Layers of the glow target, in the order in which they are added.
    pub(crate) layers: Vec<(WaveOrder, WaveBlend)>,
    pub(crate) method: WaveMethod,
    pub(crate) kind: ReferenceKind,
    fades: bool,
    /// Some wave is hidden by what is before it.
    occluded: bool,
    /// For each wave: a sphere round all its glow in the world, its ε and its R.
    spheres: Vec<(Vec3, f32, [f32; 2])>,
}

/// What the composite is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct GlowKind {
    pub(crate) layers: u32,
    /// Some wave is added in another space than the style's.
    pub(crate) mixes: bool,
    /// Some wave covers what is behind it.
    pub(crate) covers: bool,
}

impl WaveData {
    pub(crate) fn glow_kind(&self, style: &Style) -> GlowKind {
        let is_linear = style.paint.blend_space == BlendSpace::Linear;
        let has = |blend| self.layers.iter().any(|layer| layer.1 == blend);
        GlowKind {
            layers: self.layers.len() as u32,
            mixes: has(if is_linear { WaveBlend::Display } else { WaveBlend::Linear }),
            covers: has(WaveBlend::Normal),
        }
    }
}

/// What the shader of the pixels is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ExactKind {
    /// Some wave has an exponent j that is neither 0 nor 1.
    pub(crate) fades: bool,
    /// Some soft core is less than half a pixel somewhere.
    pub(crate) core_grows: bool,
    /// Some grows to more than a small part of its wave's radius.
    pub(crate) rim_grows: bool,
    /// Surfaces hide some of the waves.
    pub(crate) hides: bool,
    /// The energy itself is wanted.
    pub(crate) keeps_energy: bool,
}

impl WaveData {
    /// What a view needs.
    pub(crate) fn exact_kind(
        &self,
        view: &View,
        projected: &Projected,
        (has_surfaces, keeps_energy): (bool, bool),
    ) -> ExactKind {
        let eye = Vec3::from(view.camera.world_from_camera.translation);
        let half_pixel = |middle: Vec3, radius| {
            let distance = if projected.orthographic { 1.0 } else { eye.distance(middle) + radius };
            0.5 * projected.pixel_footprint * distance
        };
        ExactKind {
            fades: self.fades,
            core_grows: self.spheres.iter().any(|&(p, r, [core, _])| core < half_pixel(p, r)),
            rim_grows: self.spheres.iter().any(|&(p, r, [_, rim])| 0.05 * rim < half_pixel(p, r)),
            hides: has_surfaces && self.occluded,
            keeps_energy,
        }
    }
}

/// What the reference method's shader is made for: what all waves have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ReferenceKind {
    pub(crate) curve_kind: u32,
    pub(crate) point_count: u32,
    pub(crate) second_count: u32,
    pub(crate) order: u32,
    pub(crate) is_even: bool,
    pub(crate) has_more: bool,
    pub(crate) thins: bool,
    pub(crate) de_boor: bool,
}

impl ReferenceKind {
    /// Any waves at all.
    const ANY: Self = Self {
        curve_kind: 255,
        point_count: 0,
        second_count: 0,
        order: 0,
        is_even: false,
        has_more: true,
        thins: true,
        de_boor: true,
    };

    fn of(waves: &[GpuWave], method: WaveMethod) -> Self {
        let mut kinds = waves.iter().map(|wave| Self::of_one(wave, method));
        let Some(first) = kinds.next() else { return Self::ANY };
        if kinds.all(|kind| kind == first) { first } else { Self::ANY }
    }

    fn of_one(wave: &GpuWave, method: WaveMethod) -> Self {
        let curve = &wave.curve;
        let fits = match curve.kind {
            gpu::CURVE_LINE | gpu::CURVE_HELIX => true,
            gpu::CURVE_TRIG => curve.count.max(curve.count_z) <= 8,
            gpu::CURVE_BEZIER => (3..=16).contains(&curve.count),
            gpu::CURVE_B_SPLINE => curve.count <= 16 && curve.order <= 4,
            _ => false,
        };
        if !fits || curve.noise_amplitude > 0.0 {
            return Self::ANY;
        }
        Self {
            curve_kind: curve.kind,
            point_count: curve.count,
            second_count: curve.count_z,
            order: curve.order,
            is_even: wave.flags & gpu::WAVE_EVEN != 0,
            has_more: wave.profile_count > 0 || wave.swell != Vec2::ZERO || wave.attenuation > 0.0,
            thins: matches!(method, WaveMethod::Simpson { thinning: 2.., .. }),
            de_boor: matches!(method, WaveMethod::Simpson { de_boor: true, .. }),
        }
    }
}

impl WaveData {
    /// Without any waves.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        use bytemuck::Zeroable as _;
        use wgpu::BufferUsages as Usage;
        let stored = Usage::STORAGE;
        let buffer =
            |label, usage, bytes: &[u8]| bindings::buffer(device, queue, label, usage, bytes);
        let uniform = Usage::UNIFORM;
        let none = vec![GpuWave::zeroed(); MAX_WAVES];
        let node = bytemuck::bytes_of(&WaveNode::zeroed()).to_vec();
        Self {
            view: buffer("wave view", uniform, bytemuck::bytes_of(&WaveView::zeroed())),
            waves: buffer("waves", uniform, bytemuck::cast_slice(&none)),
            data: buffer("wave data", stored, &[0; 4]),
            nodes: buffer("wave nodes", stored, &node),
            glow: buffer("glow", uniform, bytemuck::bytes_of(&Glow::zeroed())),
            count: 0,
            most_leaves: 0,
            layers: Vec::new(),
            method: WaveMethod::Exact,
            kind: ReferenceKind::ANY,
            fades: false,
            occluded: false,
            spheres: Vec::new(),
        }
    }

    /// Takes over the waves, which must be valid.
    pub(crate) fn write(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        waves: &[Wave],
        method: WaveMethod,
        pose: &Pose,
    ) {
        self.method = method;
        let mut sorted: Vec<&Wave> = waves.iter().filter(|wave| shows(wave)).collect();
        // Pixels write one layer after the other.
        sorted.sort_by_key(|wave| (wave.order, wave.blend));
        self.layers = sorted.iter().map(|wave| (wave.order, wave.blend)).collect();
        self.layers.dedup();
        let mut packer = Packer::default();
        for wave in sorted {
            let key = (wave.order, wave.blend);
            let layer = self.layers.iter().position(|&layer| layer == key).unwrap_or(0);
            packer.add(wave, pose, layer as u32);
        }
        self.fades = packer.waves.iter().any(|w| w.attenuation != 0.0 && w.attenuation != 1.0);
        self.occluded = packer.waves.iter().any(|w| w.flags & gpu::WAVE_OCCLUDED != 0);
        self.spheres = packer.waves.iter().map(sphere).collect();
        self.kind = ReferenceKind::of(&packer.waves, self.method);
        self.count = packer.waves.len() as u32;
        self.most_leaves = packer.waves.iter().map(|wave| wave.leaves).max().unwrap_or(0);
        let fill = |buffer: &mut wgpu::Buffer, label, bytes: &[u8]| {
            if buffer.size() < bytes.len() as u64 {
                *buffer =
                    bindings::buffer(device, queue, label, wgpu::BufferUsages::STORAGE, bytes);
            } else if !bytes.is_empty() {
                queue.write_buffer(buffer, 0, bytes);
            }
        };
        // Loops over them end at the first one that is not used.
        let mut all = packer.waves.clone();
        if all.len() < MAX_WAVES {
            all.push(bytemuck::Zeroable::zeroed());
        }
        queue.write_buffer(&self.waves, 0, bytemuck::cast_slice(&all));
        fill(&mut self.data, "wave data", bytemuck::cast_slice(&packer.data));
        let node_bytes = u64::from(packer.nodes.max(1)) * size_of::<WaveNode>() as u64;
        if self.nodes.size() < node_bytes {
            self.nodes = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("wave nodes"),
                size: node_bytes,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            });
        }
    }

    /// What the composite is told about the layers.
    pub(crate) fn glow_values(&self, output: Output) -> Glow {
        let mut glow: Glow = bytemuck::Zeroable::zeroed();
        if !output.glow {
            return glow;
        }
        for (slot, (order, blend)) in glow.layers.iter_mut().zip(&self.layers) {
            slot.x = match order {
                WaveOrder::Under => gpu::GLOW_UNDER,
                WaveOrder::LinesThrough => gpu::GLOW_LINES_THROUGH,
                WaveOrder::Over => gpu::GLOW_OVER,
            };
            slot.y = match blend {
                WaveBlend::Display => gpu::GLOW_ADDS,
                WaveBlend::Linear => gpu::GLOW_ADDS_LINEAR,
                WaveBlend::Normal => gpu::GLOW_COVERS,
            };
            slot.z = 1;
        }
        glow.dithered = u32::from(output.dithered);
        glow
    }
}

/// Whether a wave gives any energy.
fn shows(wave: &Wave) -> bool {
    wave.alpha > 0.0 || wave.swell != [0.0; 2]
}

/// Waves on their way to the GPU.
#[derive(Default)]
struct Packer {
    waves: Vec<GpuWave>,
    data: Vec<f32>,
    nodes: u32,
}

impl Packer {
    fn add(&mut self, wave: &Wave, pose: &Pose, layer: u32) {
        let mut curve = WaveCurve::new(wave);
        let frame = curve.place(pose);
        let samples: Vec<DVec3> = (0..=64).map(|i| curve.at(f64::from(i) / 64.0)).collect();
        let extent = samples.iter().fold(0.0_f64, |m, p| m.max(p.distance(samples[0])));
        let core = f64::from(wave.core).max(2e-4 * extent).max(1e-9);
        let bounds: Vec<f64> = match wave.shape {
            WaveShape::Sphere => Vec::new(),
            WaveShape::Cylinder { length: None } => vec![0.0, 1.0],
            _ => curve.values_of_s(0.5 * f64::from(wave.tolerance) * core),
        };
        let pieces = bounds.len().saturating_sub(1) as u32;
        let leaves = if pieces == 0 { 0 } else { pieces.next_power_of_two() };
        let node_first = self.nodes;
        self.nodes += 2 * leaves;
        let ends = curve.ends(wave);
        let first = |data: &Vec<f32>| data.len() as u32;
        let bounds_first = first(&self.data);
        self.data.extend(bounds.iter().map(|&s| s as f32));
        let ramp_first = first(&self.data);
        for tone in &wave.ramp {
            let color = added_color(tone.color, wave.blend);
            self.data.push(tone.energy);
            self.data.extend(color.to_array());
        }
        let profile_first = first(&self.data);
        self.data.extend(wave.profile.as_flattened());
        let gpu_curve = self.curve(&curve);
        let has_ends = !matches!(wave.shape, WaveShape::Cylinder { .. });
        let flag = |on: bool, bit: u32| if on { bit } else { 0 };
        let bound = bound(&curve, &bounds, &samples);
        let [tail, head] = ends;
        self.waves.push(GpuWave {
            axis_x: frame.axes.x_axis.as_vec3().extend(frame.stretch as f32),
            axis_y: frame.axes.y_axis.as_vec3().extend(0.0),
            axis_z: frame.axes.z_axis.as_vec3().extend(0.0),
            origin: frame.origin.as_vec3().extend(wave.reach),
            bound,
            color: added_color(wave.color, wave.blend),
            tail,
            head,
            swell: Vec2::from(wave.swell),
            alpha: wave.alpha,
            core: wave.core,
            radius: wave.radius.unwrap_or(0.0),
            attenuation: wave.attenuation,
            flags: gpu::WAVE_USED
                | flag(has_ends, gpu::WAVE_ENDS)
                | flag(wave.occluded, gpu::WAVE_OCCLUDED)
                | flag(is_even(&curve), gpu::WAVE_EVEN),
            layer,
            node_first,
            leaves,
            bounds_first,
            bound_count: bounds.len() as u32,
            ramp_first,
            ramp_count: wave.ramp.len() as u32,
            profile_first,
            profile_count: wave.profile.len() as u32,
            tolerance: wave.tolerance,
            cylinder: cylinder(bound, &samples) + wave.core,
            reserved_0: 0,
            reserved_1: 0,
            curve: gpu_curve,
        });
    }

    /// The curve's numbers, with its points in the data.
    fn curve(&mut self, curve: &WaveCurve<'_>) -> GpuCurve {
        let mut result: GpuCurve = bytemuck::Zeroable::zeroed();
        let noise = &curve.wave.noise;
        result.noise_octaves = noise.octaves.clamp(1, 8);
        result.noise_seed = noise.seed;
        result.noise_amplitude = noise.amplitude;
        result.noise_frequency = noise.frequency;
        result.noise_phase = noise.phase;
        result.first = self.data.len() as u32;
        let tau = std::f32::consts::TAU;
        match &curve.wave.shape {
            WaveShape::Sphere => {}
            WaveShape::Cylinder { length } => {
                result.length = length.unwrap_or(2.0 * ENDLESS);
                // x at the beginning.
                result.phase = if length.is_some() { 0.0 } else { -ENDLESS };
            }
            WaveShape::Capsule { length } => result.length = *length,
            WaveShape::Helix { length, radius, turns, phase } => {
                result.kind = gpu::CURVE_HELIX;
                result.length = *length;
                result.radius = *radius;
                result.angle = tau * turns;
                result.phase = *phase;
            }
            WaveShape::Trig { length, turns, y, z } => {
                result.kind = gpu::CURVE_TRIG;
                result.length = *length;
                result.angle = tau * turns;
                result.count = y.len() as u32;
                result.count_z = z.len() as u32;
                self.data.extend(y.as_flattened());
                self.data.extend(z.as_flattened());
            }
            WaveShape::Bezier { .. } => result.kind = gpu::CURVE_BEZIER,
            WaveShape::Polyline { .. } => result.kind = gpu::CURVE_POLYLINE,
            WaveShape::BSpline { order, .. } => {
                result.kind = gpu::CURVE_B_SPLINE;
                result.order = *order as u32;
                let (low, high) = domain(&curve.knots, *order);
                result.knots_first = self.data.len() as u32;
                self.data.extend(curve.knots.iter().map(|k| ((k - low) / (high - low)) as f32));
                result.first = self.data.len() as u32;
            }
        }
        if !curve.points.is_empty() {
            result.count = curve.points.len() as u32;
            self.data.extend(curve.points.iter().flat_map(|p| p.as_vec3().to_array()));
        }
        result
    }
}

/// Metres on each side of the origin that a cylinder without ends has.
const ENDLESS: f32 = 1e6;

impl WaveCurve<'_> {
    /// Tail and head in the curve's frame, and α there.
    fn ends(&self, wave: &Wave) -> [Vec4; 2] {
        if matches!(wave.shape, WaveShape::Cylinder { length: None }) {
            // Growth means nothing without ends.
            return [Vec3::NEG_X, Vec3::X].map(|p| (p * 2.0 * ENDLESS).extend(0.0));
        }
        wave.growth.map(|s| {
            let s = f64::from(s);
            self.at(s).as_vec3().extend(wave.alpha * profile_at(&wave.profile, s as f32))
        })
    }
}

/// The factor on α at s.
fn profile_at(profile: &[[f32; 2]], s: f32) -> f32 {
    let Some([_, first]) = profile.first() else { return 1.0 };
    let mut factor = *first;
    for pair in profile.windows(2) {
        let ([s0, _], [s1, next]) = (pair[0], pair[1]);
        factor += (next - factor) * ((s - s0) / (s1 - s0)).clamp(0.0, 1.0);
    }
    factor
}

/// A sphere round the curve.
fn bound(curve: &WaveCurve<'_>, bounds: &[f64], samples: &[DVec3]) -> Vec4 {
    if matches!(curve.wave.shape, WaveShape::Cylinder { length: None }) {
        return Vec4::new(0.0, 0.0, 0.0, 4.0 * ENDLESS);
    }
    let within = bounds.windows(2).flat_map(|pair| {
        [0.0, 0.25, 0.5, 0.75].map(|part| curve.at(pair[0] + part * (pair[1] - pair[0])))
    });
    let (mut low, mut high) = (samples[0], samples[0]);
    for p in within.chain(samples.iter().copied()) {
        (low, high) = (low.min(p), high.max(p));
    }
    let radius = 0.5 * (high - low).length() * 1.05;
    (0.5 * (low + high)).as_vec3().extend(radius as f32)
}

/// A sphere round all that glows, in the world, ε and R.
fn sphere(wave: &GpuWave) -> (Vec3, f32, [f32; 2]) {
    let local = wave.bound;
    let axes = [wave.axis_x, wave.axis_y, wave.axis_z].map(Vec4::truncate);
    let middle = wave.origin.truncate() + axes[0] * local.x + axes[1] * local.y + axes[2] * local.z;
    let glow = if wave.radius > 0.0 { wave.radius } else { wave.origin.w };
    (middle, local.w + glow, [wave.core, if wave.radius > 0.0 { wave.radius } else { f32::MAX }])
}

/// Radius about the middle of the bound, parallel to x, that holds the curve.
fn cylinder(bound: Vec4, samples: &[DVec3]) -> f32 {
    let off = |p: &DVec3| (p.as_vec3() - bound.truncate()).with_x(0.0).length();
    samples.iter().map(off).fold(0.0, f32::max)
}

/// Whether x is in proportion to s, so that nothing need be solved to pair a point with its place.
fn is_even(curve: &WaveCurve<'_>) -> bool {
    let (first, last) = (curve.at(0.0).x, curve.at(1.0).x);
    (1..64).all(|i| {
        let s = f64::from(i) / 64.0;
        (curve.at(s).x - first - s * (last - first)).abs() <= 1e-5 * (last - first)
    })
}

/// A colour as it is added: premultiplied, in the wave's blend space.
fn added_color(color: Vec4, blend: WaveBlend) -> Vec4 {
    let rgb = match blend {
        WaveBlend::Display | WaveBlend::Normal => color.truncate(),
        WaveBlend::Linear => color.truncate().map(linear_from_srgb),
    };
    (rgb * color.w).extend(color.w)
}

/// The numbers of a view.
pub(crate) fn view_values(
    data: &WaveData,
    view: &View,
    projected: &Projected,
    tile: Tile,
    gbuffer_scale: u32,
    has_surfaces: bool,
) -> WaveView {
    let matrix = &view.camera.world_from_camera;
    let axis = |v: glam::Vec3A| Vec3::from(v).as_dvec3().normalize_or(DVec3::X);
    let (right, up, back) =
        (axis(matrix.matrix3.x_axis), axis(matrix.matrix3.y_axis), axis(matrix.matrix3.z_axis));
    let eye = Vec3::from(matrix.translation).as_dvec3();
    let [width, height] = view.size.map(f64::from);
    let is_orthographic = matches!(view.camera.projection, Projection::Orthographic { .. });
    // Metres a pixel covers at a distance of 1 m, or anywhere.
    let pixel = match view.camera.projection {
        Projection::Perspective { fov_y } => {
            2.0 * (0.5 * f64::from(fov_y.clamp(1e-4, 3.1))).tan() / height
        }
        Projection::Orthographic { height: metres } => f64::from(metres.max(1e-9)) / height,
    };
    let corner = 0.5 * pixel * (height * up - width * right);
    let (origin, corner) =
        if is_orthographic { (eye + corner, -back) } else { (eye, corner - back) };
    let (reference_points, reference_thinning) = match data.method {
        WaveMethod::Exact => (0, 0),
        WaveMethod::Simpson { points, thinning, .. } => (points, thinning),
    };
    let vec4 = |v: DVec3| v.as_vec3().extend(0.0);
    let mut flags = if is_orthographic { gpu::WAVE_VIEW_ORTHOGRAPHIC } else { 0 };
    if has_surfaces {
        flags |= gpu::WAVE_VIEW_SURFACES;
    }
    WaveView {
        origin: vec4(origin),
        corner: vec4(corner),
        right: vec4(right * pixel),
        down: vec4(-up * pixel),
        tile_origin: UVec2::from(tile.origin),
        tile_size: UVec2::from(tile.size),
        depth_range: projected.depth_range,
        pixel_footprint: projected.pixel_footprint,
        layers: data.layers.len() as u32,
        gbuffer_scale,
        flags,
        reference_points,
        reference_thinning,
    }
}
