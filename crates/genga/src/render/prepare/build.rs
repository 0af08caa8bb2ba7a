//! Puts together what [`Prepared`] holds.

use std::{collections::HashMap, sync::Arc};

use glam::{Vec3, Vec4};

use super::{
    DeformData, DrawItem, NodeDeform, Prepared,
    beams::{BeamData, beam_of},
    directions::{self, Source},
    drawn, dynamic_binding,
    geometry::{Chunk, Geometry, GeometryBuilder},
    highlights::{HighlightSets, Highlights},
    lights::{self, MAX_LIGHTS},
    looks::{LookRange, Looks, RAMP_PICTURE_WIDTH},
    pages::{PAGE_BYTES, Place},
    shading::{Shadings, shading_of},
    shadows::{self, Shadows},
    smears,
    speed_lines::SpeedLineData,
    stipple,
    strokes::{self, StrokeData},
    textures::Textures,
    waves::WaveData,
};
use crate::render::{
    generated::{self as gpu, Deform, Draw, Frame, Light, WorldVertex},
    gpu::bindings,
    layouts::Layouts,
};
use crate::scene::{AlphaMode, BeamShape, Image, Material, Pose, Sampler, Scene, TextureRef};
use crate::style::{self, LineSet, Style};

/// A mesh, and where the hatching directions of its primitives come from.
type ChunkKey = (usize, Vec<Option<Source>>);

/// Everything while it is put together.
pub(super) struct Builder<'a> {
    device: &'a wgpu::Device,
    layouts: &'a Layouts,
    scene: &'a Scene,
    style: &'a Style,
    geometry: GeometryBuilder,
    textures: Textures<'a>,
    looks: Looks<'a>,
    highlights: HighlightSets<'a>,
    /// By primitive.
    chunks: HashMap<ChunkKey, Vec<Vec<Chunk>>>,
    materials: Vec<wgpu::BindGroup>,
    /// By the material, then the addresses of its pictures of ids, hatching and shade.
    material_of: HashMap<[Option<usize>; 4], usize>,
    shade_sampler: wgpu::Sampler,
    draws: Vec<DrawItem>,
    draw_values: Vec<Draw>,
    deforms: Vec<(Deform, [usize; 3])>,
    nodes: Vec<NodeDeform>,
    matrix_count: u32,
    weight_count: u32,
    world_pages: Vec<u32>,
    queue: &'a wgpu::Queue,
}

impl<'a> Builder<'a> {
    pub(super) fn new(
        device: &'a wgpu::Device,
        queue: &'a wgpu::Queue,
        layouts: &'a Layouts,
        scene: &'a Scene,
        style: &'a Style,
    ) -> Self {
        Self {
            device,
            layouts,
            scene,
            style,
            geometry: GeometryBuilder::new(),
            textures: Textures::new(device, queue, scene),
            looks: Looks::new(style),
            highlights: HighlightSets::new(scene),
            chunks: HashMap::new(),
            materials: Vec::new(),
            material_of: HashMap::new(),
            shade_sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("shade"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            draws: Vec::new(),
            draw_values: Vec::new(),
            deforms: Vec::new(),
            nodes: Vec::new(),
            matrix_count: 0,
            weight_count: 0,
            world_pages: Vec::new(),
            queue,
        }
    }

    pub(super) fn build(mut self) -> Prepared {
        let pose = Pose::rest(self.scene);
        for index in (0..self.scene.nodes.len()).filter(|&i| pose.visible[i]) {
            self.add_node(index);
        }
        let counts = [self.matrix_count, self.weight_count];
        let deforms = self.deforms.iter_mut().map(|(deform, _)| deform).zip(&self.draws);
        smears::add(self.scene, self.style, deforms, counts);
        self.finish(&pose)
    }

    fn add_node(&mut self, index: usize) {
        let scene = self.scene;
        let node = &scene.nodes[index];
        let Some(mesh_index) = node.mesh else { return };
        let mesh = &scene.meshes[mesh_index];
        let joint_count = node.skin.map_or(0, |skin| scene.skins[skin].joints.len() as u32);
        let weight_count =
            mesh.primitives.iter().map(|p| p.morph_targets.len()).max().unwrap_or(0) as u32;
        let deform = NodeDeform {
            node: index,
            matrix_first: self.matrix_count,
            joint_count,
            weight_first: self.weight_count,
            weight_count,
        };
        self.matrix_count += joint_count + 1;
        self.weight_count += weight_count;
        let ranges: Vec<LookRange> = mesh
            .primitives
            .iter()
            .map(|primitive| {
                let material = primitive.material.map_or("", |m| scene.materials[m].name.as_str());
                self.looks.range(&node.name, material)
            })
            .collect();
        for (range, primitive) in ranges.iter().zip(&mesh.primitives) {
            if range.hatch.on_uv && primitive.uvs.is_empty() {
                self.looks.warn(format!(
                    "object '{}': its hatching lies on texture coordinates, which it does not have: \
                     none is drawn",
                    node.name
                ));
            }
        }
        let sources: Vec<Option<Source>> =
            ranges.iter().map(|range| Source::of(range.hatch.direction?, node.skin)).collect();
        let chunks_of = match self.chunks.get(&(mesh_index, sources.clone())) {
            Some(chunks) => chunks.clone(),
            None => {
                let uv_set = |t: Option<TextureRef>| t.map_or(0, |t| t.uv_set);
                let uv_sets = mesh.primitives.iter().map(|primitive| {
                    primitive.material.map(|m| &scene.materials[m]).map_or([0, 0], |material| {
                        [material.base_color_texture, material.emissive_texture].map(uv_set)
                    })
                });
                let directions = directions::of_primitives(scene, mesh, &sources);
                let uv_sets: Vec<_> = uv_sets.collect();
                let chunks = self.geometry.add(mesh, &uv_sets, &directions);
                self.chunks.insert((mesh_index, sources), chunks.clone());
                chunks
            }
        };
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let default = Material::default();
            let material = primitive.material.map_or(&default, |m| &scene.materials[m]);
            let is_skinned = joint_count > 0 && !primitive.joints.is_empty();
            let matrix_first = deform.matrix_first + if is_skinned { 0 } else { joint_count };
            let chunks = chunks_of[p].clone();
            let look = ranges[p].clone();
            let shading = shading_of(scene, index, &node.name, &material.name);
            let group = self.material_group(primitive.material, material, &look, shading);
            let highlights = self.highlights.of(index, &node.name, &material.name);
            let beam = beam_of(scene, index, &node.name, &material.name);
            for chunk in chunks {
                let world = self.world_place(chunk.vertex_count);
                self.deforms.push((
                    Deform {
                        rest_first: chunk.rest.first,
                        world_first: world.first,
                        vertex_count: chunk.vertex_count,
                        matrix_first,
                        weight_first: deform.weight_first,
                        target_count: chunk.target_count,
                        morph_first: chunk.morph.first,
                        ..bytemuck::Zeroable::zeroed()
                    },
                    [chunk.rest.page, world.page, chunk.morph.page],
                ));
                let mut values =
                    self.draw_values(index, primitive.material, &node.name, material, &look);
                values.shading = shading.map_or(0, |shading| shading as u32 + 1);
                self.draw_values.push(values);
                self.draws.push(DrawItem {
                    world,
                    material: group,
                    highlights,
                    double_sided: material.double_sided,
                    blend: material.alpha == AlphaMode::Blend,
                    mirrored: false,
                    casts_shadow: look.casts_shadow && beam.is_none(),
                    beam,
                    tests_alpha: material.alpha != AlphaMode::Opaque,
                    center: chunk.center,
                    matrix_first,
                    surface: [index, p],
                    hatch: look.hatch.variant,
                    look: drawn::variant(material, primitive, look.rule_count > 0),
                    chunk,
                });
            }
        }
        self.nodes.push(deform);
    }

    fn draw_values(
        &self,
        node: usize,
        material_index: Option<usize>,
        object: &str,
        material: &Material,
        look: &LookRange,
    ) -> Draw {
        let mut flags = 0;
        let mut set = |condition: bool, flag: u32| flags |= if condition { flag } else { 0 };
        set(material.unlit, gpu::DRAW_UNLIT);
        set(material.double_sided, gpu::DRAW_DOUBLE_SIDED);
        set(material.alpha == AlphaMode::Blend, gpu::DRAW_ALPHA_BLEND);
        set(matches!(material.alpha, AlphaMode::Mask { .. }), gpu::DRAW_ALPHA_MASK);
        let [base_uv_u, base_uv_v] = uv_rows(material.base_color_texture);
        let [emissive_uv_u, emissive_uv_v] = uv_rows(material.emissive_texture);
        let sets = || self.style.lines.sets.iter().take(4).enumerate();
        let bits = |on: &dyn Fn(&LineSet) -> bool| {
            sets().filter(|(_, set)| on(set)).fold(0_u32, |bits, (i, _)| bits | 1 << i)
        };
        let line_sets = bits(&|set| set.matches(object, &material.name));
        let through =
            bits(&|set| !set.through.patterns().is_empty() && set.through.matches(&material.name));
        Draw {
            base_color: material.base_color,
            emissive: material.emissive.extend(0.0),
            base_uv_u,
            base_uv_v,
            emissive_uv_u,
            emissive_uv_v,
            object_id: ((node as u32 + 1) & gpu::ID_OBJECT)
                | line_sets << gpu::ID_SETS_SHIFT
                | through << gpu::ID_THROUGH_SHIFT,
            material_id: (material_index.map_or(0, |m| m + 1) & 0xffff) as u32,
            look_first: look.look_first,
            rule_first: look.rule_first,
            rule_count: look.rule_count,
            flags,
            alpha_cutoff: match material.alpha {
                AlphaMode::Mask { cutoff } => cutoff,
                AlphaMode::Opaque | AlphaMode::Blend => 0.0,
            },
            line_width: if look.rule_count == 0 {
                self.looks.looks[look.look_first as usize].line_width
            } else {
                -1.0
            },
            rest_scale: 1.0,
            shading: 0,
            reserved_0: 0,
            reserved_1: 0,
        }
    }

    fn material_group(
        &mut self,
        index: Option<usize>,
        material: &Material,
        look: &LookRange,
        shading: Option<usize>,
    ) -> usize {
        let shade = Shadings::picture(self.scene, shading).or(look.shade_image.as_ref());
        let pointer = |image: Option<&Arc<Image>>| image.map(|image| Arc::as_ptr(image) as usize);
        let [id, hatch] = [look.id_image.as_ref(), look.hatch.image.as_ref()];
        let key = [index, pointer(id), pointer(hatch), pointer(shade)];
        if let Some(&group) = self.material_of.get(&key) {
            return group;
        }
        let (base, base_sampler) = self.textures.get(material.base_color_texture);
        let (emissive, emissive_sampler) = self.textures.get(material.emissive_texture);
        let id = self.textures.style_image(look.id_image.as_ref());
        let hatch = self.textures.hatch_picture(look.hatch.image.as_ref());
        let hatch_sampler = self.textures.sampler(Sampler::default());
        let shade = self.textures.style_image(shade);
        use wgpu::BindingResource as R;
        let group = bindings::group(
            self.device,
            "material",
            &self.layouts.material,
            &[
                (0, R::TextureView(&base)),
                (1, R::Sampler(&base_sampler)),
                (2, R::TextureView(&emissive)),
                (3, R::Sampler(&emissive_sampler)),
                (4, R::TextureView(&id)),
                (5, R::TextureView(&hatch)),
                (6, R::Sampler(&hatch_sampler)),
                (7, R::TextureView(&shade)),
                (8, R::Sampler(&self.shade_sampler)),
            ],
        );
        self.materials.push(group);
        self.material_of.insert(key, self.materials.len() - 1);
        self.materials.len() - 1
    }

    fn world_place(&mut self, vertex_count: u32) -> Place {
        let capacity = (PAGE_BYTES / size_of::<WorldVertex>()) as u32;
        let fits = self.world_pages.last().is_some_and(|&used| used + vertex_count <= capacity);
        if !fits {
            self.world_pages.push(0);
        }
        let page = self.world_pages.len() - 1;
        let first = self.world_pages[page];
        self.world_pages[page] += vertex_count;
        Place { page, first }
    }

    fn finish(self, pose: &Pose) -> Prepared {
        use wgpu::BufferUsages as Usage;
        let (device, queue) = (self.device, self.queue);
        let geometry = Geometry::upload(device, queue, &self.geometry, &self.world_pages);
        let stored = Usage::STORAGE;
        let frame = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frame"),
            size: size_of::<Frame>() as u64,
            usage: Usage::UNIFORM | Usage::COPY_DST,
            mapped_at_creation: false,
        });
        let draw_data = bindings::buffer(device, queue, "draws", stored, &self.draw_values);
        let look_data = bindings::buffer(device, queue, "looks", Usage::STORAGE, &self.looks.looks);
        let rule_data = bindings::buffer(device, queue, "rules", Usage::STORAGE, &self.looks.rules);
        let lights = lights::placed_lights(self.scene, pose, self.style);
        let no_light: Light = bytemuck::Zeroable::zeroed();
        let uniform = Usage::UNIFORM;
        let light_data =
            bindings::buffer(device, queue, "lights", uniform, &[no_light; MAX_LIGHTS]);
        let ramps = ramp_texture(device, self.queue, &self.looks.ramp_rows);
        let wanted = shadows::maps_needed(self.scene, pose, self.style);
        let resolution = self.style.paint.shadow.resolution;
        let shadows = Shadows::new(device, queue, self.layouts, &draw_data, wanted, resolution);
        let shadings = Shadings::new(device, queue, self.scene);
        let stipple = stipple::texture(device, queue, self.looks.have_stipple());
        let numbers = drawn::numbers(device, queue, &self.draw_values);
        let surface_group = bindings::group(
            device,
            "surfaces",
            &self.layouts.surface,
            &[
                (0, frame.as_entire_binding()),
                (1, draw_data.as_entire_binding()),
                (2, look_data.as_entire_binding()),
                (3, rule_data.as_entire_binding()),
                (4, light_data.as_entire_binding()),
                (5, wgpu::BindingResource::TextureView(&ramps)),
                (6, shadows.values.as_entire_binding()),
                (7, wgpu::BindingResource::TextureView(&shadows.depths)),
                (8, wgpu::BindingResource::Sampler(&shadows.nearest)),
                (9, shadings.values.as_entire_binding()),
                (10, dynamic_binding::<gpu::DrawNumber>(&numbers)),
                (11, wgpu::BindingResource::TextureView(&stipple)),
                (12, wgpu::BindingResource::TextureView(&shadings.normal_maps)),
            ],
        );
        let deform = self.deform_data(&geometry);
        let strokes =
            StrokeData::new(device, queue, self.layouts, &geometry, &self.draws, self.style);
        let (sets, warned) = self.highlights.finish();
        let highlights = Highlights::new(device, queue, self.layouts, self.scene, sets, self.style);
        let mut warnings = self.geometry.warnings;
        let speed_lines =
            SpeedLineData::new(device, queue, self.scene, self.style, &self.draws, &mut warnings);
        warnings.extend(self.textures.warnings);
        if lights.len() > MAX_LIGHTS {
            warnings.push(format!(
                "the scene has {} lights; only the {MAX_LIGHTS} strongest ones are used",
                lights.len()
            ));
        }
        let [wanted, _] = wanted;
        if wanted > shadows::MAX_MAPS {
            warnings.push(format!(
                "the scene's lights need {wanted} shadow maps (one a light, six a point light), more \
                 than {}: the weaker lights cast no shadows",
                shadows::MAX_MAPS
            ));
        }
        for (i, beam) in self.scene.beams.iter().enumerate() {
            let is_marked = matches!(beam.shape, BeamShape::Surfaces { .. });
            if is_marked && !self.draws.iter().any(|draw| draw.beam == Some(i)) {
                warnings.push(format!(
                    "beam {i} '{}' marks no surface: no object and material has such names, or a \
                     later one has them all",
                    beam.name
                ));
            }
            if beam.has_no_length(pose) {
                warnings.push(format!(
                    "beam {i} '{}' is not drawn: in this pose its points, or what it goes between, are \
                     at one place",
                    beam.name
                ));
            }
        }
        for (i, shading) in self.scene.shadings.iter().enumerate() {
            let number = i as u32 + 1;
            if !self.draw_values.iter().any(|draw| draw.shading == number) {
                let what = if shading.face_shadow.is_some() { "face shadow" } else { "proxy" };
                warnings.push(format!(
                    "shading {i} ({what}) lies on no surface: no object and material has such names, or \
                     a later one has them all"
                ));
            }
        }
        let curves = |set: &LineSet| -> f32 {
            strokes::curves(set).into_iter().flatten().map(style::Curve::largest).product()
        };
        let widest = self.style.lines.sets.iter().map(curves).fold(1.0, f32::max);
        let max_width_factor =
            self.looks.max_width_factor() * self.geometry.max_line_width * widest;
        warnings.extend(self.looks.warnings);
        let mut anchors = HashMap::new();
        for set in &self.style.lines.sets {
            let Some(name) = &set.width_by.depth_from else { continue };
            match self.scene.nodes.iter().position(|node| node.name == *name) {
                Some(node) => drop(anchors.insert(name.clone(), (node, Vec3::ZERO))),
                None => warnings.push(format!(
                    "line set '{}' counts its depth from '{name}', which the scene does not have: \
                     it is counted from the camera",
                    set.name
                )),
            }
        }
        warnings.extend(warned);
        Prepared {
            anchors,
            style: self.style.clone(),
            geometry,
            draws: self.draws,
            materials: self.materials,
            frame,
            draw_data,
            light_data,
            surface_group,
            lights,
            shadows,
            shadings,
            deform,
            strokes,
            highlights,
            waves: WaveData::new(device, queue),
            beams: BeamData::new(device, queue),
            speed_lines,
            bounds: None,
            max_width_factor,
            draw_values: self.draw_values,
            warnings,
            node_count: self.scene.nodes.len(),
        }
    }

    fn deform_data(&self, geometry: &Geometry) -> DeformData {
        use wgpu::BufferUsages as Usage;
        let stored = Usage::STORAGE;
        let has_smear = self.deforms.iter().any(|(deform, _)| deform.past_offset > 0);
        let count = self.matrix_count.max(1) as usize * if has_smear { 2 } else { 1 };
        let matrices = vec![[Vec4::ZERO; 3]; count];
        let matrices = bindings::buffer(
            self.device,
            self.queue,
            "joint matrices",
            stored,
            matrices.as_flattened(),
        );
        let count = self.weight_count.max(1) as usize * if has_smear { 2 } else { 1 };
        let weights = vec![0.0_f32; count];
        let weights = bindings::buffer(self.device, self.queue, "morph weights", stored, &weights);
        let mut groups = HashMap::new();
        for (_, pages) in &self.deforms {
            groups.entry(*pages).or_insert_with(|| {
                bindings::group(
                    self.device,
                    "deform",
                    &self.layouts.deform,
                    &[
                        (0, geometry.rest[pages[0]].as_entire_binding()),
                        (1, geometry.world[pages[1]].as_entire_binding()),
                        (2, matrices.as_entire_binding()),
                        (3, geometry.morph[pages[2]].as_entire_binding()),
                        (4, weights.as_entire_binding()),
                    ],
                )
            });
        }
        let values: Vec<Deform> = self.deforms.iter().map(|(deform, _)| *deform).collect();
        let uniforms = bindings::dynamic_uniforms(self.device, self.queue, "deforms", &values);
        let uniforms = bindings::group(
            self.device,
            "deforms",
            &self.layouts.dynamic,
            &[(0, dynamic_binding::<Deform>(&uniforms))],
        );
        DeformData {
            matrices,
            weights,
            groups,
            uniforms,
            nodes: self.nodes.clone(),
            matrix_count: self.matrix_count as usize,
            has_smear,
            weight_count: self.weight_count as usize,
        }
    }
}

/// Rows of KHR_texture_transform's matrix.
fn uv_rows(texture: Option<TextureRef>) -> [Vec4; 2] {
    let t = texture.map(|t| t.transform).unwrap_or_default();
    let (sin, cos) = t.rotation.sin_cos();
    [
        Vec4::new(cos * t.scale.x, sin * t.scale.y, t.offset.x, 0.0),
        Vec4::new(-sin * t.scale.x, cos * t.scale.y, t.offset.y, 0.0),
    ]
}

fn ramp_texture(device: &wgpu::Device, queue: &wgpu::Queue, rows: &[u8]) -> wgpu::TextureView {
    use wgpu::util::DeviceExt as _;
    let white = vec![255; 4 * RAMP_PICTURE_WIDTH as usize];
    let rows = if rows.is_empty() { &white } else { rows };
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some("ramp pictures"),
            size: wgpu::Extent3d {
                width: RAMP_PICTURE_WIDTH,
                height: (rows.len() / white.len()) as u32,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        rows,
    );
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
