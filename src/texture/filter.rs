//! The properties and requirements of each filter: the one table for validation, advice, packing
//! and the loop budget. The shader's side is in `glsl/shared/filter/`.

use super::sampler_spec::Filter;

/// The cost of a lookup by a filter in loop iterations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopCost {
    /// A fixed number around one coordinate of a 2D texture.
    Place(u64),
    /// As many lookups as the sampler's anisotropy allows.
    Walk,
    /// All texels of an ellipse.
    Ellipse,
    /// A fixed number for the footprint, whatever its size.
    Footprint(u64),
}

/// The properties of a filter.
#[derive(Clone, Copy, Debug)]
pub struct Traits {
    /// True if the filter is defined only where a footprint covers more than a texel, so that it
    /// cannot magnify.
    pub only_minifies: bool,
    /// True if texture units implement it.
    pub in_hardware: bool,
    /// True if it supports textures of one or two dimensions only.
    pub needs_flat: bool,
    /// True if it selects levels itself, whatever the mip mode.
    pub chooses_levels: bool,
    /// True if it follows the major axis of a footprint, as anisotropic filtering does.
    pub follows_axis: bool,
    /// True if it selects texels stochastically.
    pub is_random: bool,
    /// True if it reads summed-area tables instead of texels.
    pub needs_sums: bool,
    /// True if it blends neighbouring texels.
    pub blends: bool,
    /// The iterations of its loops.
    pub loop_cost: LoopCost,
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
    loop_cost: LoopCost::Place(0),
};
const MIXED: Traits = Traits { blends: true, ..ONE_TEXEL };

impl Filter {
    /// Returns what sets the filter apart.
    pub const fn traits(self) -> Traits {
        match self {
            Filter::Nearest => Traits { in_hardware: true, ..ONE_TEXEL },
            Filter::Linear => Traits { in_hardware: true, ..MIXED },
            // Four by four texels, and the rows.
            Filter::Cubic => Traits { needs_flat: true, loop_cost: LoopCost::Place(20), ..MIXED },
            Filter::Lanczos2 => Traits { needs_flat: true, loop_cost: LoopCost::Place(20), ..MIXED },
            Filter::Lanczos3 => Traits { needs_flat: true, loop_cost: LoopCost::Place(42), ..MIXED },
            Filter::Stochastic => Traits { is_random: true, blends: true, ..ONE_TEXEL },
            Filter::Anisotropic => Traits {
                only_minifies: true,
                in_hardware: true,
                follows_axis: true,
                loop_cost: LoopCost::Walk,
                ..MIXED
            },
            Filter::Ewa => Traits {
                only_minifies: true,
                needs_flat: true,
                chooses_levels: true,
                loop_cost: LoopCost::Ellipse,
                ..MIXED
            },
            // The corners of nine boxes of four rows.
            Filter::SummedArea => Traits {
                only_minifies: true,
                needs_flat: true,
                needs_sums: true,
                loop_cost: LoopCost::Footprint(9 * 24),
                ..MIXED
            },
        }
    }

    /// Returns the filters of magnification and minification that one name stands for: those that only minify
    /// magnify linearly.
    pub fn both(self) -> (Filter, Filter) {
        (if self.only_minifies() { Filter::Linear } else { self }, self)
    }

    /// Returns true for filters that are defined only where a footprint covers more than a texel.
    pub const fn only_minifies(self) -> bool {
        self.traits().only_minifies
    }

    /// Returns the names of the filters that satisfy `is`, as a list in a sentence.
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
        assert_eq!(
            Filter::names_with(|t| !t.only_minifies, "or"),
            "nearest, linear, cubic, stochastic, lanczos-2 or lanczos-3"
        );
        assert_eq!(Filter::names_with(|t| t.needs_sums, "or"), "summed-area");
    }
}
