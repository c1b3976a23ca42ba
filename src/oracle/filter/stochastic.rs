//! Filter `stochastic`: one texel, with the weights of `linear` as probabilities: the nearest to a position that is
//! moved by up to half a texel (Fajardo et al. 2023); of two levels one. Twin of `glsl/shared/filter/stochastic.glsl`.

use glam::DVec3;

use crate::oracle::rng::pcg3d;

/// Returns three numbers in [0, 1) from a sample's random bits.
pub fn look_up_dice(random: [u32; 2]) -> DVec3 {
    let bits = pcg3d([random[0], random[1], 0x7E41]);
    DVec3::from_array(bits.map(|b| f64::from(b >> 8) / 16_777_216.0))
}

pub fn stochastic_place(texel: DVec3, dice: DVec3) -> DVec3 {
    texel + (dice - 0.5)
}

/// Returns the level, the next one with probability `rest`, and renews the random number for the following look-up.
pub fn stochastic_level(low: u32, rest: f64, dice: &mut DVec3) -> u32 {
    let low = low + u32::from(dice.z < rest);
    dice.z = (dice.z * 4096.0).fract();
    low
}
