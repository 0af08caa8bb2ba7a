//! Reading pictures and their layers pixel by pixel.

use genga::render::{LayerData, LayerKind, Picture};

/// Pixel access. All of it panics outside of the picture or without the layer.
pub trait Pixels {
    /// RGBA, straight alpha, sRGB-encoded.
    fn at(&self, x: u32, y: u32) -> [u8; 4];
    /// A layer of bytes.
    fn bytes(&self, kind: LayerKind) -> &[u8];
    /// A layer of floats.
    fn floats(&self, kind: LayerKind) -> &[f32];
    /// Alpha of the line layer.
    fn ink(&self, x: u32, y: u32) -> u8;
    /// Painted colour without lines and background.
    fn paint(&self, x: u32, y: u32) -> [u8; 4];
    /// Object, material, user line.
    fn ids(&self, x: u32, y: u32) -> [u32; 3];
    /// Distance along the camera's axis in metres.
    fn depth(&self, x: u32, y: u32) -> f32;
    /// World-space normal.
    fn normal(&self, x: u32, y: u32) -> glam::Vec3;
    /// Every pixel's place, row by row.
    fn places(&self) -> impl Iterator<Item = (u32, u32)> + use<Self>;
}

fn data(picture: &Picture, kind: LayerKind) -> &LayerData {
    let layer = picture.layers.iter().find(|layer| layer.kind == kind);
    &layer.unwrap_or_else(|| panic!("the picture was drawn without its {} layer", kind.name())).data
}

fn index(picture: &Picture, x: u32, y: u32) -> usize {
    assert!(x < picture.width && y < picture.height, "({x}, {y}) is outside of the picture");
    y as usize * picture.width as usize + x as usize
}

fn rgba(bytes: &[u8], index: usize) -> [u8; 4] {
    [bytes[4 * index], bytes[4 * index + 1], bytes[4 * index + 2], bytes[4 * index + 3]]
}

impl Pixels for Picture {
    fn at(&self, x: u32, y: u32) -> [u8; 4] {
        rgba(&self.rgba, index(self, x, y))
    }

    fn bytes(&self, kind: LayerKind) -> &[u8] {
        match data(self, kind) {
            LayerData::Rgba8(bytes) => bytes,
            LayerData::F32 { .. } | LayerData::U32 { .. } => panic!("{} has no bytes", kind.name()),
        }
    }

    fn floats(&self, kind: LayerKind) -> &[f32] {
        match data(self, kind) {
            LayerData::F32 { values, .. } => values,
            LayerData::Rgba8(_) | LayerData::U32 { .. } => panic!("{} has no floats", kind.name()),
        }
    }

    fn ink(&self, x: u32, y: u32) -> u8 {
        rgba(self.bytes(LayerKind::Lines), index(self, x, y))[3]
    }

    fn paint(&self, x: u32, y: u32) -> [u8; 4] {
        rgba(self.bytes(LayerKind::Color), index(self, x, y))
    }

    fn ids(&self, x: u32, y: u32) -> [u32; 3] {
        let LayerData::U32 { values, .. } = data(self, LayerKind::Ids) else {
            panic!("ids are whole numbers");
        };
        let i = 3 * index(self, x, y);
        [values[i], values[i + 1], values[i + 2]]
    }

    fn depth(&self, x: u32, y: u32) -> f32 {
        self.floats(LayerKind::Depth)[index(self, x, y)]
    }

    fn normal(&self, x: u32, y: u32) -> glam::Vec3 {
        glam::Vec3::from_slice(&self.floats(LayerKind::Normal)[3 * index(self, x, y)..])
    }

    fn places(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (width, height) = (self.width, self.height);
        (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
    }
}
