//! The states of a sampler as data: the table from which scene vocabulary, `VkSampler` objects,
//! shader constants, oracle and test names are generated.

use crate::core::named::named_enum;
pub use crate::schema::enums::{Address, Filter, Method, MipMode, TexelCenter};

/// The addressing and filtering of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerSpec {
    /// The address modes along u and v.
    pub address: [Address; 2],
    /// The address mode along w of 3D textures.
    pub address_w: Address,
    /// The filter where a texel covers more than a pixel.
    pub mag: Filter,
    /// The filter where a footprint covers more than a texel.
    pub min: Filter,
    /// Which levels are read.
    pub mip: MipMode,
    /// True if the levels are those that the files of its textures store.
    pub stored_levels: bool,
    /// The minimum level of detail, of hardware samplers only. Above 0, every lookup minifies.
    pub min_lod: f32,
    /// The colour of `clamp-to-border`, red, green, blue and alpha.
    pub border_color: [f32; 4],
    /// Who filters.
    pub method: Method,
    /// The position of texel centres.
    pub texel_center: TexelCenter,
    /// The largest anisotropy, in footprint widths, that `anisotropic` and `ewa` resolve; wider
    /// footprints are blurred.
    pub max_anisotropy: u32,
    /// B and C of the cubic filter.
    pub cubic: [f32; 2],
}

named_enum! {
    /// How levels are read, as scenes and the command line name it.
    pub enum LevelUse {
        /// Level 0 alone.
        None = "none",
        /// The nearest level.
        Nearest = "nearest",
        /// Between two levels.
        Linear = "linear",
        /// Between two of the levels that the files of textures store.
        Stored = "stored",
    }
}

impl LevelUse {
    /// Returns the mip mode, and whether levels are those that files store.
    pub const fn parts(self) -> (MipMode, bool) {
        match self {
            LevelUse::None => (MipMode::None, false),
            LevelUse::Nearest => (MipMode::Nearest, false),
            LevelUse::Linear => (MipMode::Linear, false),
            LevelUse::Stored => (MipMode::Linear, true),
        }
    }
}

impl From<MipMode> for LevelUse {
    fn from(mode: MipMode) -> LevelUse {
        match mode {
            MipMode::None => LevelUse::None,
            MipMode::Nearest => LevelUse::Nearest,
            MipMode::Linear => LevelUse::Linear,
        }
    }
}

/// B = 0, C = ½, which interpolates.
pub const CATMULL_ROM: [f32; 2] = [0.0, 0.5];
/// Cubic filters by name, with B and C (Mitchell & Netravali 1988).
pub const CUBICS: [(&str, [f32; 2]); 3] =
    [("catmull-rom", CATMULL_ROM), ("b-spline", [1.0, 0.0]), ("mitchell", [1.0 / 3.0, 1.0 / 3.0])];

impl Address {
    /// Returns the mode whose whole tiles may leave a coordinate that both modes read.
    pub fn in_common(self, other: Address) -> Address {
        match (self, other) {
            _ if self == other => self,
            (Address::Repeat | Address::MirroredRepeat, Address::Repeat | Address::MirroredRepeat) => {
                Address::MirroredRepeat
            }
            _ => Address::ClampToEdge,
        }
    }
}

impl Default for SamplerSpec {
    fn default() -> Self {
        SamplerSpec {
            address: [Address::Repeat; 2],
            address_w: Address::Repeat,
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: MipMode::None,
            stored_levels: false,
            min_lod: 0.0,
            border_color: [0.0; 4],
            method: Method::Shader,
            texel_center: TexelCenter::Half,
            max_anisotropy: 16,
            cubic: CATMULL_ROM,
        }
    }
}

/// The filters of texture units.
const BASIC: [Filter; 2] = [Filter::Nearest, Filter::Linear];

/// Returns the filter of texture units that blends neighbours, or the one that does not.
pub fn basic_filter(blends: bool) -> Filter {
    BASIC[usize::from(blends)]
}

impl SamplerSpec {
    /// Returns true if lookups depend on the footprint.
    pub fn needs_footprint(&self) -> bool {
        self.mag != self.min || self.mip != MipMode::None
    }

    /// Returns true if a magnified texture is interpolated between the four nearest texels.
    pub fn magnifies_linearly(&self) -> bool {
        self.mag == Filter::Linear
    }

    /// Returns true if lookups blend several texels.
    pub fn blends(&self) -> bool {
        self.mag.traits().blends || self.min.traits().blends
    }

    /// Returns true if lookups follow the major axis of footprints.
    pub fn follows_axis(&self) -> bool {
        self.min.traits().follows_axis
    }

    /// Returns true if lookups read summed-area tables.
    pub fn needs_sums(&self) -> bool {
        self.min.traits().needs_sums
    }

    /// Returns true if some axis has this address mode.
    pub fn has(&self, mode: Address) -> bool {
        self.address.contains(&mode) || self.address_w == mode
    }

    /// Returns true if lookups read mip levels other than the base level.
    pub fn reads_levels(&self) -> bool {
        self.mip != MipMode::None || self.min.traits().chooses_levels
    }

    /// Returns every variant of a hardware sampler that differs in more than border colour, texel
    /// centre or anisotropy: 5 × 5 address modes, 2 × 2 filters, 3 mip modes. Hardware tests and
    /// reports iterate over this table.
    pub fn all() -> impl Iterator<Item = SamplerSpec> {
        let axes = Address::ALL.iter().flat_map(|&u| Address::ALL.iter().map(move |&v| [u, v]));
        axes.flat_map(|address| {
            BASIC.iter().flat_map(move |&mag| {
                BASIC.iter().flat_map(move |&min| {
                    MipMode::ALL.iter().map(move |&mip| SamplerSpec {
                        address,
                        mag,
                        min,
                        mip,
                        ..Default::default()
                    })
                })
            })
        })
    }

    /// Returns a name for tests and report rows: `repeat/clamp-to-edge mag=linear min=nearest
    /// mip=none`.
    pub fn label(&self) -> String {
        let [u, v] = self.address;
        format!("{u}/{v} mag={} min={} mip={}", self.mag, self.min, self.mip)
    }
}
