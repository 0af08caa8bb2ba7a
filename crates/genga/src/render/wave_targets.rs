//! What the energy waves alone need of a tile.

use super::generated::{self as gpu, WaveLevel};
use super::targets::{ENERGY_FORMAT, Target, target};

/// Sizes of squares: coarse and middle ones get patches, the finest ones are left for pixels.
pub(crate) const LEVELS: usize = 3;

/// Sides of the levels' squares, in those of the finest.
const SCALES: [u32; LEVELS] = [4, 2, 1];

pub(crate) struct WaveTargets {
    pub(crate) energy: Target,
    /// Range of the depths in each of the finest squares.
    pub(crate) depths: wgpu::Buffer,
    /// The nodes of each square of the level at hand.
    pub(crate) lists: wgpu::Buffer,
    /// For each level the squares with a list, and those that are given up: see `waves_tiles`.
    pub(crate) used: [wgpu::Buffer; LEVELS],
    pub(crate) left: [wgpu::Buffer; LEVELS],
    /// For all levels but the finest the squares with a patch.
    pub(crate) smooth: [wgpu::Buffer; LEVELS - 1],
    pub(crate) patches: wgpu::Buffer,
    /// A [`WaveLevel`] for each level.
    pub(crate) levels: [wgpu::Buffer; LEVELS],
    pub(crate) grid: ListGrid,
}

/// How the pixels are shared out among squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ListGrid {
    /// Pixels of one of the finest squares along a side.
    side: u32,
    /// Most squares of each level: one more than the pixels need along each side, since a tile may
    /// begin anywhere.
    squares: [u32; LEVELS],
    /// Words of all lists together.
    words: u32,
    layers: u32,
}

impl ListGrid {
    /// As much as 64 MiB hold: long lists are rare, but walking the trees instead is slow.
    const MOST_WORDS: u32 = 16 << 20;

    fn new(pixels: [u32; 2], layers: u32) -> Self {
        let grid = |side: u32| {
            let squares = SCALES.map(|scale| {
                let [x, y] = pixels.map(|n| n.div_ceil(scale * side) + 1);
                x * y
            });
            let finest = squares[LEVELS - 1];
            let entries = (Self::MOST_WORDS / finest).saturating_sub(gpu::LIST_HEAD);
            let words = finest * (entries.clamp(96, 1024) + gpu::LIST_HEAD);
            Self { side, squares, words, layers }
        };
        let fits = |grid: &Self| {
            grid.words <= Self::MOST_WORDS && grid.patch_bytes() <= 4 * u64::from(Self::MOST_WORDS)
        };
        [8, 16].map(grid).into_iter().find(fits).unwrap_or_else(|| grid(32))
    }

    fn patch_bytes(self) -> u64 {
        let squares: u32 = self.squares[..LEVELS - 1].iter().sum();
        u64::from(squares) * u64::from(self.layers * gpu::PATCH_RAYS) * 16
    }

    /// Most squares of the coarsest level and of the finest.
    pub(crate) fn coarsest(self) -> u32 {
        self.squares[0]
    }

    pub(crate) fn finest(self) -> u32 {
        self.squares[LEVELS - 1]
    }

    /// The levels of a tile that begins at a pixel of the whole picture.
    pub(crate) fn levels(self, origin: [u32; 2], size: [u32; 2]) -> [WaveLevel; LEVELS] {
        let squares = |side: u32| -> [u32; 2] {
            std::array::from_fn(|i| (origin[i] + size[i]).div_ceil(side) - origin[i] / side)
        };
        let mut patch_first = 0;
        std::array::from_fn(|i| {
            let side = SCALES[i] * self.side;
            let [across, down] = squares(side);
            let first = patch_first;
            patch_first += self.squares[i];
            WaveLevel {
                side,
                scale: SCALES[i],
                across,
                down,
                finest: squares(self.side).into(),
                stride: (self.words / self.squares[i]).min(4096),
                patch_first: first,
            }
        })
    }
}

impl WaveTargets {
    pub(crate) fn new(device: &wgpu::Device, pixels: [u32; 2], layers: u32) -> Self {
        use wgpu::{BufferUsages as Buffer, TextureUsages as Texture};
        let grid = ListGrid::new(pixels, layers);
        let buffer = |label, size: u64, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let squares = |label, count: u32| {
            let usage = Buffer::STORAGE | Buffer::INDIRECT | Buffer::COPY_DST;
            buffer(label, 16 + 4 * u64::from(count), usage)
        };
        let finest = grid.squares[LEVELS - 1];
        let level = |_| {
            let usage = Buffer::UNIFORM | Buffer::COPY_DST;
            buffer("wave level", size_of::<WaveLevel>() as u64, usage)
        };
        let usage = Texture::STORAGE_BINDING | Texture::COPY_SRC | Texture::RENDER_ATTACHMENT;
        Self {
            energy: target(device, "energy", pixels, 1, ENERGY_FORMAT, usage),
            depths: buffer("wave depths", 8 * u64::from(finest), Buffer::STORAGE),
            lists: buffer("wave lists", 4 * u64::from(grid.words), Buffer::STORAGE),
            used: grid.squares.map(|count| squares("used squares", count)),
            left: grid.squares.map(|count| squares("squares left", count)),
            smooth: std::array::from_fn(|i| squares("smooth squares", grid.squares[i])),
            patches: buffer("wave patches", grid.patch_bytes(), Buffer::STORAGE),
            levels: std::array::from_fn(level),
            grid,
        }
    }
}
