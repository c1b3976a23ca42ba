//! A named property of each pixel of a picture beside its colour: one number or several, and which pixels have it.

/// One component of a layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// `Y` for a single number, `Z` for a depth, `R` `G` `B`, `X` `Y` `Z` or `U` `V`.
    pub name: &'static str,
    /// One value a pixel, the top row first; 0 where there is none.
    pub values: Vec<f32>,
}

/// A named property of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The name in files and on the command line.
    pub name: &'static str,
    /// Its components.
    pub channels: Vec<Channel>,
    /// True for pixels that have the property.
    pub present: Vec<bool>,
}

impl Layer {
    /// Returns the values of the first channel in pixels that have the property.
    pub fn first_values(&self) -> impl Iterator<Item = f32> + Clone {
        let values = self.channels.first().map_or(&[][..], |channel| &channel.values);
        values.iter().zip(&self.present).filter(|(_, present)| **present).map(|(value, _)| *value)
    }
}
