//! Surfaces in colour; the inverted hull, if the style asks for it.

use super::surface::{
    HighlightVariant, SurfacePipelines, Variant, cleared_depth, cleared_samples, draw_items,
    shader, sorted_items,
};
use crate::render::gpu::timing::Timer;
use crate::render::{
    frame::Aim,
    layouts::Layouts,
    prepare::{
        DrawItem, Prepared,
        lights::{MAX_LIGHTS, PlacedLight, light_count},
        shine::Features,
    },
    targets::{PAINT_FORMAT, Targets, paint_samples},
};
use crate::style::LineMethod;

/// What the paint pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PaintOutput {
    /// Surfaces with their highlights.
    All,
    /// Surfaces without highlights.
    Plain,
    /// Highlights alone; surfaces only hide them.
    Highlights,
    /// Where on its first highlight's drawing each surface lies, and the distance to its outline.
    Coordinates,
    /// Surfaces before the ramp.
    Base,
    /// What the ramp makes of white surfaces.
    Tone,
    /// White where lights reach, black in cast shadows.
    Shadow,
    /// The ink of hatching.
    Ink,
}

pub(crate) struct PaintPass {
    surfaces: SurfacePipelines,
    hulls: SurfacePipelines,
}

impl PaintPass {
    pub(crate) fn new(device: &wgpu::Device, layouts: &Layouts) -> Self {
        let module = shader(device, "paint", include_str!("../generated/paint.wgsl"));
        let make = |label, module, entries| {
            let formats = [PAINT_FORMAT];
            SurfacePipelines::new(device, layouts, label, module, entries, &formats)
        };
        Self {
            surfaces: make("paint", module.clone(), ["paint_vertex", "paint_fragment"])
                .with_ink(["hatched_vertex", "hatched_fragment"])
                .with_highlights(
                    device,
                    layouts,
                    ["highlight_fragment", "hatched_highlight_fragment"],
                ),
            hulls: make("hull", module, ["hull_vertex", "hull_fragment"]),
        }
    }

    pub(crate) fn run(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        prepared: &Prepared,
        targets: &Targets,
        (aim, output): (&Aim, PaintOutput),
        timer: &mut Timer,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("paint"),
            color_attachments: &[cleared_samples(
                targets.paint_samples.as_ref().map(|t| &t.view),
                &targets.paint.view,
            )],
            depth_stencil_attachment: cleared_depth(
                &targets.paint_depth.view,
                wgpu::StoreOp::Store,
            ),
            timestamp_writes: timer.render("paint"),
            ..Default::default()
        });
        let samples = paint_samples(targets.size.paint_scale);
        aim.set_viewport(&mut pass, targets.size.paint_scale as f32);
        let [opaque, blended] = sorted_items(prepared, aim.eye);
        let features = Features::of(&prepared.style);
        let features = match output {
            PaintOutput::All | PaintOutput::Highlights => features,
            _ => features.without_shine(),
        };
        let own = light_count(&prepared.lights);
        let lights = (own + prepared.beams.light_count()).min(MAX_LIGHTS) as u32;
        let beam_lights = lights - own as u32;
        let placed_lights = beam_lights > 0 || prepared.lights.iter().any(PlacedLight::has_place);
        let light_colors = prepared.lights.iter().any(PlacedLight::has_color);
        let variant = |item: &DrawItem| {
            let highlights = highlight_variant(prepared, item, output);
            let shadows = prepared.shadows.any();
            let hatch = item.hatch.filter(|_| output_has_ink(output));
            let output = match output {
                PaintOutput::All | PaintOutput::Plain => 0,
                PaintOutput::Highlights => 1,
                PaintOutput::Coordinates => 2,
                PaintOutput::Base => 3,
                PaintOutput::Tone => 4,
                PaintOutput::Shadow => 5,
                PaintOutput::Ink => 6,
            };
            let edited_shading = prepared.shadings.any();
            let proxy_meshes = prepared.shadings.has_meshes();
            Variant {
                highlights,
                hatch,
                shadows,
                output,
                features,
                edited_shading,
                proxy_meshes,
                lights,
                beam_lights,
                placed_lights,
                light_colors,
                ..Variant::of(item, samples)
            }
        };
        let items = opaque.iter().map(|&(i, item)| (i, item, variant(item)));
        draw_items(device, &mut pass, prepared, &self.surfaces, items);
        let has_paint = matches!(output, PaintOutput::All | PaintOutput::Plain);
        if has_paint && prepared.style.lines.method == LineMethod::Hull {
            let cull = Some(wgpu::Face::Front);
            let items = opaque
                .iter()
                .map(|&(i, item)| (i, item, Variant { cull, ..Variant::of(item, samples) }));
            draw_items(device, &mut pass, prepared, &self.hulls, items);
        }
        let items = blended
            .iter()
            .filter(|_| output != PaintOutput::Coordinates)
            .map(|&(i, item)| (i, item, Variant { blend: true, ..variant(item) }));
        draw_items(device, &mut pass, prepared, &self.surfaces, items);
    }
}

/// Whether surfaces are inked.
fn output_has_ink(output: PaintOutput) -> bool {
    matches!(output, PaintOutput::All | PaintOutput::Plain | PaintOutput::Ink)
}

/// How a draw's pipeline draws highlights.
fn highlight_variant(
    prepared: &Prepared,
    item: &DrawItem,
    output: PaintOutput,
) -> Option<HighlightVariant> {
    let variant = prepared.highlights.variant(item.highlights);
    match output {
        PaintOutput::All => (variant.count > 0).then_some(variant),
        PaintOutput::Highlights | PaintOutput::Coordinates => Some(variant),
        PaintOutput::Plain
        | PaintOutput::Base
        | PaintOutput::Tone
        | PaintOutput::Shadow
        | PaintOutput::Ink => None,
    }
}
