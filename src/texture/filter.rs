//! What each filter can do and what it asks for: the one table from which validation, advice, packing and the loop budget
//! read. The shader's side stands in `glsl/shared/filter/`.

use super::sampler_spec::Filter;

/// What a look-up by a filter costs in turns of loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turns {
    /// So many around one place of a flat texture.
    Place(u64),
    /// As many look-ups as the sampler's anisotropy allows.
    Walk,
    /// All texels of an ellipse.
    Ellipse,
    /// So many for the footprint, whatever its size.
    Footprint(u64),
}

/// The properties of a filter.
#[derive(Clone, Copy, Debug)]
pub struct Traits {
    /// It means something only where a footprint covers more than a texel, so that it cannot magnify.
    pub only_minifies: bool,
    /// Texture units have it.
    pub in_hardware: bool,
    /// It reads textures of one or two dimensions only.
    pub needs_flat: bool,
    /// It chooses levels by itself, whatever the mip mode.
    pub chooses_levels: bool,
    /// It follows the longer axis of a footprint, as texture units do where they can.
    pub follows_axis: bool,
    /// It takes texels at random.
    pub is_random: bool,
    /// It reads sums over rectangles in place of texels.
    pub needs_sums: bool,
    /// It mixes neighbouring texels.
    pub blends: bool,
    /// How often its loops run.
    pub turns: Turns,
}

const ONE_TEXEL: Traits = Traits {
    only_minifies: false,
    in_hardware: false,
    needs_flat: false,
    chooses_levels: false,
    follows_axis: false,
    is_random: false,
    needs_sums: false,
    blends: false,
    turns: Turns::Place(0),
};
const MIXED: Traits = Traits { blends: true, ..ONE_TEXEL };

impl Filter {
    /// Returns what sets the filter apart.
    pub const fn traits(self) -> Traits {
        match self {
            Filter::Nearest => Traits { in_hardware: true, ..ONE_TEXEL },
            Filter::Linear => Traits { in_hardware: true, ..MIXED },
            // Four by four texels, and the rows.
            Filter::Cubic => Traits { needs_flat: true, turns: Turns::Place(20), ..MIXED },
            Filter::Stochastic => Traits { is_random: true, blends: true, ..ONE_TEXEL },
            Filter::Anisotropic => Traits {
                only_minifies: true,
                in_hardware: true,
                follows_axis: true,
                turns: Turns::Walk,
                ..MIXED
            },
            Filter::Ewa => Traits {
                only_minifies: true,
                needs_flat: true,
                chooses_levels: true,
                turns: Turns::Ellipse,
                ..MIXED
            },
            // Corners of nine boxes of four rows.
            Filter::SummedArea => Traits {
                only_minifies: true,
                needs_flat: true,
                needs_sums: true,
                turns: Turns::Footprint(9 * 24),
                ..MIXED
            },
        }
    }

    /// Returns the filters of magnification and minification that one name stands for: those that only minify
    /// magnify linearly.
    pub fn both(self) -> (Filter, Filter) {
        (if self.only_minifies() { Filter::Linear } else { self }, self)
    }

    /// Filters that only mean something where a footprint covers more than a texel.
    pub const fn only_minifies(self) -> bool {
        self.traits().only_minifies
    }

    /// Their names, as a person lists them.
    pub fn names_with(is: impl Fn(&Traits) -> bool, last: &str) -> String {
        let all = Filter::ALL.iter().filter(|f| is(&f.traits()));
        let names: Vec<&str> = all.map(|f| f.name()).collect();
        match names.split_last() {
            Some((end, [])) => (*end).to_string(),
            Some((end, rest)) => format!("{} {last} {end}", rest.join(", ")),
            None => String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_names_end_with_a_word() {
        assert_eq!(Filter::names_with(|t| t.in_hardware, "or"), "nearest, linear or anisotropic");
        assert_eq!(Filter::names_with(|t| !t.only_minifies, "or"), "nearest, linear, cubic or stochastic");
        assert_eq!(Filter::names_with(|t| t.needs_sums, "or"), "summed-area");
    }
}
