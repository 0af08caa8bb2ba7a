//! Pictures in memory: drawn in tiles, read back, with the layers that were asked for.

use super::{
    RenderError,
    frame::{Aim, Output, Tile, apron, gbuffer_scale, viewport},
    generated::ID_OBJECT,
    gpu::{readback::TextureRead, scope, timing::Timer},
    passes::paint::PaintOutput,
    prepare::{Prepared, shine::Features},
    renderer::{Renderer, check_view},
    targets::{Scale, Target, target},
    view::{Projected, View},
};

/// Largest side of a picture in pixels.
pub const MAX_PICTURE_SIDE: u32 = 16_384;

/// Largest side of a tile's paint target in texels; it bounds the memory that a picture takes.
const MAX_TILE_TEXELS: u32 = 3072;

/// What a layer shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LayerKind {
    /// Painted surfaces without highlights, lines and background: RGBA, sRGB-encoded, straight
    /// alpha. The `hull` and `rim` methods are part of it.
    Color,
    /// Distance along the camera's axis in metres; infinite on the background.
    Depth,
    /// World-space normal of the visible surface; 0 on the background.
    Normal,
    /// Object (node index + 1), material (index + 1; 0 for the default one), user line id; 0 on
    /// the background.
    Ids,
    /// Lines alone: RGBA, sRGB-encoded, straight alpha.
    Lines,
    /// Coverage of the pixel by each line set in [0, 1], four channels in the sets' order, 0 for
    /// sets that are not there. Only the methods `contour` and `reference` fill it.
    LineMask,
    /// Which types of lines detection found at the pixel, as a sum: silhouette 1, crease 2,
    /// object 4, material 8, user 32.
    LineType,
    /// Highlights alone, in front of what hides them: RGBA, sRGB-encoded, straight alpha. Colour
    /// times alpha goes on top of [`Self::Color`].
    Highlight,
    /// Where each pixel lies on the drawing of its surface's first highlight: the drawing's square
    /// is [−1, 1]², y up; then the distance to its outline in the same unit, negative inside. 0
    /// without a highlight, and on transparent surfaces what lies behind.
    HighlightUv,
    /// Energy of all waves together, before any colour; see [`crate::scene::Wave`].
    Energy,
    /// Surfaces before the ramp: RGBA, sRGB-encoded, straight alpha.
    Base,
    /// What the ramp, with cast shadows in it, makes of white surfaces: RGBA, sRGB-encoded, straight
    /// alpha. Where all tones multiply, [`Self::Base`] times it is [`Self::Color`] without
    /// highlights and what shines by itself.
    Tone,
    /// White where all lights reach, black where all of them are cut off by what stands before
    /// them, by their weights: RGBA, straight alpha. Surfaces turned away from a light count as
    /// reached; their shade is in [`Self::Tone`].
    Shadow,
    /// Hatching alone, in front of what hides it: RGBA, sRGB-encoded, straight alpha. It lies over
    /// [`Self::Tone`], which it multiplies, and under highlights.
    Ink,
    /// Beams alone, where nothing hides them: RGBA, sRGB-encoded, straight alpha. They go on top of
    /// [`Self::Color`]; lines that go through them are not in it.
    Beam,
}

impl LayerKind {
    /// All layers.
    pub const ALL: [Self; 15] = [
        Self::Color,
        Self::Depth,
        Self::Normal,
        Self::Ids,
        Self::Lines,
        Self::LineMask,
        Self::LineType,
        Self::Highlight,
        Self::HighlightUv,
        Self::Energy,
        Self::Base,
        Self::Tone,
        Self::Shadow,
        Self::Ink,
        Self::Beam,
    ];

    /// Name in file names and options.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Ids => "ids",
            Self::Lines => "lines",
            Self::LineMask => "line-mask",
            Self::LineType => "line-type",
            Self::Highlight => "highlight",
            Self::HighlightUv => "highlight-uv",
            Self::Energy => "energy",
            Self::Base => "base",
            Self::Tone => "tone",
            Self::Shadow => "shadow",
            Self::Ink => "ink",
            Self::Beam => "beam",
        }
    }
}

/// Pixels of a layer, row by row from the top, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerData {
    /// Floats.
    F32 {
        /// Channels per pixel.
        channels: usize,
        /// `width · height · channels` numbers.
        values: Vec<f32>,
    },
    /// Whole numbers.
    U32 {
        /// Channels per pixel.
        channels: usize,
        /// `width · height · channels` numbers.
        values: Vec<u32>,
    },
    /// RGBA, sRGB-encoded, straight alpha: `width · height · 4` bytes.
    Rgba8(Vec<u8>),
}

/// One target of the frame beside the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What it shows.
    pub kind: LayerKind,
    /// Its pixels.
    pub data: LayerData,
}

/// A finished picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// sRGB-encoded, straight alpha, row by row from the top: `width · height · 4` bytes.
    pub rgba: Vec<u8>,
    /// The layers that were asked for, in that order.
    pub layers: Vec<Layer>,
}

/// A texture that takes a composite to be read back.
pub(crate) fn color_target(device: &wgpu::Device, size: [u32; 2]) -> Target {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
    target(device, "picture", size, 1, wgpu::TextureFormat::Rgba8Unorm, usage)
}

impl Renderer {
    /// Draws a view of any size up to [`MAX_PICTURE_SIDE`] and brings it back, with `layers`
    /// beside it. Large pictures are drawn in tiles; a tiled picture equals the whole one.
    /// `progress` is called with the number of tiles done and of all tiles.
    ///
    /// # Errors
    /// Impossible sizes or camera numbers, what the driver refuses, or a lost device.
    pub async fn picture(
        &self,
        prepared: &Prepared,
        view: &View,
        layers: &[LayerKind],
        progress: &mut dyn FnMut(u32, u32),
    ) -> Result<Picture, RenderError> {
        self.picture_in_tiles(prepared, view, layers, MAX_TILE_TEXELS, progress).await
    }

    /// As [`Self::picture`], with paint targets of at most `max_texels` on a side.
    ///
    /// # Errors
    /// As [`Self::picture`].
    #[doc(hidden)]
    pub async fn picture_in_tiles(
        &self,
        prepared: &Prepared,
        view: &View,
        layers: &[LayerKind],
        max_texels: u32,
        progress: &mut dyn FnMut(u32, u32),
    ) -> Result<Picture, RenderError> {
        check_view(view, MAX_PICTURE_SIDE)?;
        let [width, height] = view.size;
        let pixels = width as usize * height as usize;
        let mut picture = Picture {
            width,
            height,
            rgba: vec![0; 4 * pixels],
            layers: layers.iter().map(|&kind| empty_layer(kind, pixels)).collect(),
        };
        let limit =
            self.device.limits().max_texture_dimension_2d.min(max_texels) / view.supersample;
        let tiles = tiles(view.size, limit.max(64), apron(prepared, view));
        let total = tiles.len() as u32;
        progress(0, total);
        for (done, (tile, kept)) in tiles.into_iter().enumerate() {
            self.draw_into(&mut picture, prepared, view, tile, kept).await?;
            progress(done as u32 + 1, total);
        }
        Ok(picture)
    }

    /// Draws one tile and copies the part that is kept.
    async fn draw_into(
        &self,
        picture: &mut Picture,
        prepared: &Prepared,
        view: &View,
        tile: Tile,
        kept: Tile,
    ) -> Result<(), RenderError> {
        let reads = self.record_tile(picture, prepared, view, tile, kept)?;
        let mut reads = reads.into_iter();
        if let Some(Some(read)) = reads.next() {
            let bytes = read.finish(&self.device).await?;
            copy_rows(&mut picture.rgba, picture.width, &bytes, kept, 4);
        }
        let texels = Texels {
            projected: Projected::new(&view.camera, view.size, prepared.bounds),
            offset: [kept.origin[0] - tile.origin[0], kept.origin[1] - tile.origin[1]],
            kept,
            scale: gbuffer_scale(prepared, view),
            width: gbuffer_scale(prepared, view).of(tile.size[0]),
            paint_scale: view.supersample,
            paint_width: tile.size[0] * view.supersample,
        };
        for (layer, read) in picture.layers.iter_mut().zip(reads) {
            // Without waves there is no target and no energy.
            if let Some(read) = read {
                texels.copy(layer, picture.width, &read.finish(&self.device).await?);
            }
        }
        Ok(())
    }

    /// Submits everything that a tile needs: reads of the picture, then of each layer.
    fn record_tile(
        &self,
        picture: &Picture,
        prepared: &Prepared,
        view: &View,
        tile: Tile,
        kept: Tile,
    ) -> Result<Vec<Option<TextureRead>>, RenderError> {
        let whole = Output {
            background: view.background,
            paint: true,
            lines: true,
            glow: true,
            beams: true,
            energy: picture.layers.iter().any(|layer| layer.kind == LayerKind::Energy),
            dithered: true,
            straight: true,
        };
        let device = &self.device;
        let offset = [kept.origin[0] - tile.origin[0], kept.origin[1] - tile.origin[1]];
        let all = wgpu::TextureAspect::All;
        let _turn = self.turn();
        scope::checked(device, || {
            let mut encoder = self.encoder("tile");
            let mut timer = Timer::off();
            let targets = self.draw_tile(&mut encoder, prepared, view, tile, whole, &mut timer);
            let shown = color_target(device, tile.size);
            let read_shown = |encoder: &mut wgpu::CommandEncoder| {
                let output = (&shown.view, shown.texture.format());
                self.composite(encoder, prepared, &targets, output, &mut Timer::off());
                TextureRead::record(device, encoder, &shown.texture, all, offset, kept.size)
            };
            let mut reads = vec![Some(read_shown(&mut encoder))];
            self.queue.submit([encoder.finish()]);
            let projected = Projected::new(&view.camera, view.size, prepared.bounds);
            let aim = Aim { eye: projected.eye, tile, viewport: viewport(device, view, tile) };
            // What the paint target holds at the moment.
            let mut painted = PaintOutput::All;
            let mut repaint = |encoder: &mut wgpu::CommandEncoder, mut wanted: PaintOutput| {
                // Without highlights both are the same.
                let shines = Features::of(&prepared.style).shines();
                if wanted == PaintOutput::Plain && !prepared.highlights.any() && !shines {
                    wanted = PaintOutput::All;
                }
                if wanted != painted {
                    let off = &mut Timer::off();
                    self.paint.run(device, encoder, prepared, &targets, (&aim, wanted), off);
                    painted = wanted;
                }
            };
            for layer in &picture.layers {
                let mut encoder = self.encoder("layer");
                let output = Output { background: false, glow: false, beams: false, ..whole };
                reads.push(Some(match layer.kind {
                    LayerKind::Color
                    | LayerKind::Lines
                    | LayerKind::Highlight
                    | LayerKind::Base
                    | LayerKind::Tone
                    | LayerKind::Shadow
                    | LayerKind::Ink
                    | LayerKind::Beam => {
                        let lines = layer.kind == LayerKind::Lines;
                        let beams = layer.kind == LayerKind::Beam;
                        let output = Output { paint: !lines && !beams, lines, beams, ..output };
                        self.write_frame(prepared, view, &projected, tile, output);
                        if let Some(wanted) = paint_output(layer.kind) {
                            repaint(&mut encoder, wanted);
                        }
                        read_shown(&mut encoder)
                    }
                    LayerKind::HighlightUv => {
                        repaint(&mut encoder, PaintOutput::Coordinates);
                        read_whole(device, &mut encoder, &targets.paint.texture, all)
                    }
                    LayerKind::Depth => {
                        // Depth textures can only be copied whole.
                        let aspect = wgpu::TextureAspect::DepthOnly;
                        read_whole(device, &mut encoder, &targets.depth.texture, aspect)
                    }
                    LayerKind::Normal => {
                        read_whole(device, &mut encoder, &targets.normal.texture, all)
                    }
                    LayerKind::Ids => read_whole(device, &mut encoder, &targets.ids.texture, all),
                    LayerKind::LineMask => {
                        let coverage = &targets.coverage.texture;
                        TextureRead::record(device, &mut encoder, coverage, all, offset, kept.size)
                    }
                    LayerKind::LineType => {
                        let off = &mut Timer::off();
                        self.detect.mask(device, &mut encoder, prepared, &targets, off);
                        read_whole(device, &mut encoder, &targets.mask.texture, all)
                    }
                    LayerKind::Energy => {
                        let Some(waves) = &targets.waves else {
                            reads.push(None);
                            continue;
                        };
                        let energy = &waves.energy.texture;
                        TextureRead::record(device, &mut encoder, energy, all, offset, kept.size)
                    }
                }));
                self.queue.submit([encoder.finish()]);
            }
            Ok(reads)
        })
    }
}

/// What the paint target must hold for a layer that is composited from it.
fn paint_output(kind: LayerKind) -> Option<PaintOutput> {
    match kind {
        LayerKind::Color | LayerKind::Beam => Some(PaintOutput::Plain),
        LayerKind::Highlight => Some(PaintOutput::Highlights),
        LayerKind::Base => Some(PaintOutput::Base),
        LayerKind::Tone => Some(PaintOutput::Tone),
        LayerKind::Shadow => Some(PaintOutput::Shadow),
        LayerKind::Ink => Some(PaintOutput::Ink),
        _ => None,
    }
}

fn read_whole(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
    aspect: wgpu::TextureAspect,
) -> TextureRead {
    let size = [texture.width(), texture.height()];
    TextureRead::record(device, encoder, texture, aspect, [0, 0], size)
}

/// Where the texels of one tile's layers lie.
struct Texels {
    projected: Projected,
    /// The kept part in the tile, in pixels.
    offset: [u32; 2],
    kept: Tile,
    scale: Scale,
    /// G-buffer texels in a row.
    width: u32,
    /// Paint texels per pixel.
    paint_scale: u32,
    /// Paint texels in a row.
    paint_width: u32,
}

impl Texels {
    /// A G-buffer texel of each pixel of the part that is kept, `N` bytes each.
    fn pick<'a, const N: usize>(&self, bytes: &'a [u8]) -> impl Iterator<Item = &'a [u8; N]> {
        let (texels, _) = bytes.as_chunks::<N>();
        let (offset, size, scale, width) = (self.offset, self.kept.size, self.scale, self.width);
        (0..size[1]).flat_map(move |y| {
            let row = (scale.at(offset[1] + y) * width) as usize;
            (0..size[0]).map(move |x| &texels[row + scale.at(offset[0] + x) as usize])
        })
    }

    /// Copies what was read to its place in a layer.
    fn copy(&self, layer: &mut Layer, picture_width: u32, bytes: &[u8]) {
        match (&mut layer.data, layer.kind) {
            (LayerData::Rgba8(rgba), _) => copy_rows(rgba, picture_width, bytes, self.kept, 4),
            (LayerData::F32 { values, .. }, LayerKind::HighlightUv) => {
                let means = self.paint_means(bytes);
                copy_rows(values, picture_width, &means, self.kept, 3);
            }
            (LayerData::F32 { values, .. }, LayerKind::LineMask) => {
                let coverage: Vec<f32> = bytes.iter().map(|&b| f32::from(b) / 255.0).collect();
                copy_rows(values, picture_width, &coverage, self.kept, 4);
            }
            (LayerData::U32 { values, .. }, LayerKind::LineType) => {
                // The lowest byte; margins lie above it.
                let types: Vec<u32> = self.pick::<4>(bytes).map(|t| u32::from(t[0])).collect();
                copy_rows(values, picture_width, &types, self.kept, 1);
            }
            (LayerData::F32 { values, .. }, LayerKind::Depth) => {
                let distances: Vec<f32> = self
                    .pick::<4>(bytes)
                    .map(|texel| self.distance(f32::from_le_bytes(*texel)))
                    .collect();
                copy_rows(values, picture_width, &distances, self.kept, 1);
            }
            (LayerData::F32 { values, .. }, LayerKind::Energy) => {
                let (floats, _) = bytes.as_chunks::<4>();
                let floats: Vec<f32> = floats.iter().map(|b| f32::from_le_bytes(*b)).collect();
                copy_rows(values, picture_width, &floats, self.kept, 1);
            }
            (LayerData::F32 { values, .. }, _) => {
                let half = |a: u8, b: u8| half::f16::from_le_bytes([a, b]).to_f32();
                let normals: Vec<f32> = self
                    .pick::<8>(bytes)
                    .flat_map(|t| [half(t[0], t[1]), half(t[2], t[3]), half(t[4], t[5])])
                    .collect();
                copy_rows(values, picture_width, &normals, self.kept, 3);
            }
            (LayerData::U32 { values, .. }, _) => {
                let ids: Vec<u32> = self
                    .pick::<8>(bytes)
                    .flat_map(|t| {
                        let object = u32::from_le_bytes([t[0], t[1], t[2], t[3]]) & ID_OBJECT;
                        let material = u32::from(u16::from_le_bytes([t[4], t[5]]));
                        [object, material, u32::from(u16::from_le_bytes([t[6], t[7]]))]
                    })
                    .collect();
                copy_rows(values, picture_width, &ids, self.kept, 3);
            }
        }
    }

    /// Mean of the paint texels of each pixel of the part that is kept, without alpha.
    fn paint_means(&self, bytes: &[u8]) -> Vec<f32> {
        let (texels, _) = bytes.as_chunks::<8>();
        let (offset, size, scale) = (self.offset, self.kept.size, self.paint_scale);
        let width = self.paint_width as usize;
        let channel = |texel: &[u8; 8], c: usize| {
            half::f16::from_le_bytes([texel[2 * c], texel[2 * c + 1]]).to_f32()
        };
        let mut means = Vec::with_capacity(3 * size[0] as usize * size[1] as usize);
        for y in 0..size[1] {
            for x in 0..size[0] {
                let mut sum = [0.0_f32; 3];
                for i in 0..scale * scale {
                    let row = ((offset[1] + y) * scale + i / scale) as usize;
                    let column = ((offset[0] + x) * scale + i % scale) as usize;
                    let texel = &texels[row * width + column];
                    (0..3).for_each(|c| sum[c] += channel(texel, c));
                }
                means.extend(sum.map(|sum| sum / (scale * scale) as f32));
            }
        }
        means
    }

    /// Metres along the camera's axis; infinite for the cleared value.
    fn distance(&self, depth: f32) -> f32 {
        let range = self.projected.depth_range;
        if depth <= 0.0 {
            f32::INFINITY
        } else if self.projected.orthographic {
            range.y + (range.x - range.y) * depth
        } else {
            range.x / depth
        }
    }
}

fn empty_layer(kind: LayerKind, pixels: usize) -> Layer {
    let data = match kind {
        LayerKind::Color
        | LayerKind::Lines
        | LayerKind::Highlight
        | LayerKind::Base
        | LayerKind::Tone
        | LayerKind::Shadow
        | LayerKind::Ink
        | LayerKind::Beam => LayerData::Rgba8(vec![0; 4 * pixels]),
        LayerKind::Depth | LayerKind::Energy => {
            LayerData::F32 { channels: 1, values: vec![0.0; pixels] }
        }
        LayerKind::Normal | LayerKind::HighlightUv => {
            LayerData::F32 { channels: 3, values: vec![0.0; 3 * pixels] }
        }
        LayerKind::LineMask => LayerData::F32 { channels: 4, values: vec![0.0; 4 * pixels] },
        LayerKind::LineType => LayerData::U32 { channels: 1, values: vec![0; pixels] },
        LayerKind::Ids => LayerData::U32 { channels: 3, values: vec![0; 3 * pixels] },
    };
    Layer { kind, data }
}

/// Copies the rows of a tile to their place in the picture.
fn copy_rows<T: Copy>(to: &mut [T], to_width: u32, from: &[T], kept: Tile, channels: usize) {
    let row = kept.size[0] as usize * channels;
    for (y, from) in from.chunks_exact(row.max(1)).enumerate() {
        let at = (kept.origin[1] as usize + y) * to_width as usize + kept.origin[0] as usize;
        to[at * channels..at * channels + row].copy_from_slice(from);
    }
}

/// Tiles as (drawn, kept): the kept parts cover the picture once, the drawn ones reach `apron`
/// pixels further where the picture does.
fn tiles(size: [u32; 2], limit: u32, apron: u32) -> Vec<(Tile, Tile)> {
    let spans = |length: u32| -> Vec<(u32, u32, u32, u32)> {
        if length <= limit {
            return vec![(0, length, 0, length)];
        }
        // The beginning is rounded down by up to five pixels.
        let step = limit.saturating_sub(2 * apron + 5).max(limit / 4).max(1);
        (0..length)
            .step_by(step as usize)
            .map(|start| {
                let end = (start + step).min(length);
                // Tiles begin at even pixels, since derivatives are taken over pairs of pixels, and
                // where a texel of the smallest detection does.
                let drawn = start.saturating_sub(apron) / 6 * 6;
                (drawn, (end + apron).min(length), start, end)
            })
            .collect()
    };
    let columns = spans(size[0]);
    let mut result = Vec::new();
    for &(y0, y1, ky0, ky1) in &spans(size[1]) {
        for &(x0, x1, kx0, kx1) in &columns {
            result.push((
                Tile { origin: [x0, y0], size: [x1 - x0, y1 - y0] },
                Tile { origin: [kx0, ky0], size: [kx1 - kx0, ky1 - ky0] },
            ));
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_tiles_cover_every_pixel_once() {
        for (size, limit, apron) in [([300, 70], 64, 6), ([64, 64], 64, 6), ([1, 500], 100, 40)] {
            let mut covered = vec![0_u8; (size[0] * size[1]) as usize];
            for (drawn, kept) in tiles(size, limit, apron) {
                assert!(drawn.size[0] <= limit.max(limit / 4 + 2 * apron + 5));
                for (axis, side) in size.into_iter().enumerate() {
                    let low = kept.origin[axis].saturating_sub(apron);
                    assert!(drawn.origin[axis] <= low && drawn.origin[axis] % 6 == 0);
                    assert!(drawn.origin[axis] + drawn.size[axis] <= side);
                }
                for y in 0..kept.size[1] {
                    for x in 0..kept.size[0] {
                        covered[((kept.origin[1] + y) * size[0] + kept.origin[0] + x) as usize] +=
                            1;
                    }
                }
            }
            assert!(covered.iter().all(|&n| n == 1), "{size:?}");
        }
    }
}
