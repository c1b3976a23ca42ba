//! A decoded texture: the exact texels of the file in one of the formats that a device supports.
//! Grey stays one channel and grey with alpha two; three channels are expanded to four.

use crate::core::named::named_enum;
pub use crate::schema::enums::{ColorSpace, TexelFormat};

named_enum! {
    /// The dimensionality of the texel array.
    pub enum Dimension {
        One = "1d",
        Two = "2d",
        Three = "3d",
        Cube = "cube",
    }
}

named_enum! {
    /// The kernel by which a texel of a coarser mip level averages those of finer ones.
    pub enum MipKernel {
        /// The texels that it covers, each weighted by the covered fraction.
        Box = "box",
        /// A Kaiser-windowed sinc over a wider neighbourhood, which is sharper and aliases less.
        Kaiser = "kaiser",
        /// None: the levels are those that the file stores, as written.
        Stored = "stored",
        /// `Stored` where the file stores levels, `Box` elsewhere.
        Auto = "auto",
    }
}

named_enum! {
    /// The number type of a channel.
    pub enum Component {
        Unorm8 = "unorm8",
        Unorm16 = "unorm16",
        Float32 = "float32",
    }
}

impl Component {
    /// Returns the bytes of a number.
    pub const fn bytes(self) -> usize {
        match self {
            Component::Unorm8 => 1,
            Component::Unorm16 => 2,
            Component::Float32 => 4,
        }
    }

    /// Returns the number of values that an integer component can have.
    pub const fn codes(self) -> usize {
        match self {
            Component::Unorm8 => 1 << 8,
            Component::Unorm16 => 1 << 16,
            Component::Float32 => 0,
        }
    }

    /// Returns the stored form of 1 in the first `bytes()` bytes of the array.
    pub const fn one(self) -> [u8; 4] {
        match self {
            Component::Unorm8 | Component::Unorm16 => [255; 4],
            Component::Float32 => 1f32.to_ne_bytes(),
        }
    }
}

impl TexelFormat {
    /// Returns the numbers of a texel.
    pub const fn channels(self) -> usize {
        match self as u32 % 3 {
            0 => 1,
            1 => 2,
            _ => 4,
        }
    }

    /// Returns their type.
    pub const fn component(self) -> Component {
        match self as u32 / 3 {
            0 => Component::Unorm8,
            1 => Component::Unorm16,
            _ => Component::Float32,
        }
    }

    /// Returns the bytes of a texel.
    pub const fn bytes_per_texel(self) -> usize {
        self.channels() * self.component().bytes()
    }

    /// Returns the format of so many channels: 1, 2, or 4.
    pub fn new(channels: usize, component: Component) -> TexelFormat {
        let column = match channels {
            1 => 0,
            2 => 1,
            _ => 2,
        };
        TexelFormat::ALL[component as usize * 3 + column]
    }
}

/// The texels of a texture with their format. Row 0 of `texels` is the one at v = 0: `flip_v` is
/// already applied.
#[derive(Clone, Debug)]
pub struct TextureData {
    /// For messages.
    pub name: String,
    /// Its axes.
    pub dimension: Dimension,
    /// Texels in a row.
    pub width: u32,
    /// The height, which is 1 for a 1D texture.
    pub height: u32,
    /// Slices of a volume, 6 for a cube, otherwise 1.
    pub depth: u32,
    /// Channels and number type of a texel.
    pub format: TexelFormat,
    /// The meaning of the stored values.
    pub color_space: ColorSpace,
    /// Channels of the file, before three were expanded to four.
    pub file_channels: usize,
    /// Tightly packed rows in native byte order, slices one after the other; so are a cube's faces,
    /// +x −x +y −y +z −z in Vulkan's order.
    pub texels: Vec<u8>,
    /// The levels that the file stores, from level 1 on, each of half the size of the one before; they may end early.
    pub stored_levels: Vec<TextureData>,
}
