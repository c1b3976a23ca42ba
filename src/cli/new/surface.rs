//! The pictures of a new scene by what they are. Input: pictures, and what is shown. Output: which of them is the colours,
//! the normal map and so on; what has no place in a material is left out, with the reason.

use super::Kind;
use super::names::Role;
use super::photo::Photo;

#[derive(Default)]
pub(super) struct Surface {
    pub color: Option<Photo>,
    /// With true, green points up in the picture.
    pub normal: Option<(Photo, bool)>,
    pub height: Option<Photo>,
    /// Green multiplies the roughness, blue the metal.
    pub roughness: Option<Photo>,
    pub packed: Option<Photo>,
    pub emission: Option<Photo>,
    pub occlusion: Option<Photo>,
    pub sky: Option<Photo>,
    /// Means of pictures that have no map in a material.
    pub mean_roughness: Option<f64>,
    pub mean_metal: Option<f64>,
    pub left_out: Vec<String>,
}

impl Surface {
    pub fn new(photos: Vec<Photo>, kind: Kind) -> Surface {
        let mut surface = Surface::default();
        let is_alone = photos.len() == 1;
        let mut metal = None;
        for photo in photos {
            let role = role(&photo, is_alone);
            let (shown, words) = (photo.path.display().to_string(), role.words());
            let place = match role {
                Role::Color => &mut surface.color,
                Role::Height => &mut surface.height,
                Role::Roughness => &mut surface.roughness,
                Role::Packed => &mut surface.packed,
                Role::Emission => &mut surface.emission,
                Role::Occlusion => &mut surface.occlusion,
                Role::Sky => &mut surface.sky,
                Role::Metallic => &mut metal,
                Role::Normal | Role::NormalDown => {
                    match &surface.normal {
                        None => surface.normal = Some((photo, role == Role::Normal)),
                        Some(_) => surface.left_out.push(format!("{shown}: a second normal map")),
                    }
                    continue;
                }
                Role::Gloss => {
                    surface.mean_roughness = Some(1.0 - photo.mean);
                    surface
                        .left_out
                        .push(format!("{shown}: gloss has no map here; its mean is the roughness"));
                    continue;
                }
                Role::Opacity => {
                    let what = "opacity is the alpha of the colors; put it into that channel";
                    surface.left_out.push(format!("{shown}: {what}"));
                    continue;
                }
            };
            match place {
                None => *place = Some(photo),
                Some(first) => {
                    let first = first.path.display();
                    surface.left_out.push(format!("{shown}: {words}, as {first} is already"));
                }
            }
        }
        surface.settle(metal, kind);
        surface
    }

    /// Leaves out what does not go together.
    fn settle(&mut self, metal: Option<Photo>, kind: Kind) {
        let mut leave = |photo: Option<Photo>, why: &str| {
            self.left_out.extend(photo.map(|photo| format!("{}: {why}", photo.path.display())));
        };
        if self.packed.is_some() {
            leave(self.roughness.take(), "the packed picture has roughness, too");
            leave(self.occlusion.take(), "the packed picture has occlusion, too");
        }
        if let Some(metal) = metal {
            if self.packed.is_none() {
                self.mean_metal = Some(metal.mean);
            }
            let why = match self.packed {
                Some(_) => "the packed picture has metal, too",
                None => "one map has both roughness (green) and metal (blue); its mean is the metal",
            };
            leave(Some(metal), why);
            if self.mean_metal.is_some_and(|metal| metal > 0.5)
                && let Some(roughness) = self.roughness.take()
            {
                // Grey multiplies the metal as well.
                self.mean_roughness = Some(roughness.mean);
                leave(
                    Some(roughness),
                    "a map of roughness alone makes metal dull; its mean is the roughness",
                );
            }
        }
        if self.normal.is_some() {
            leave(
                self.height.take(),
                "a material takes a normal map or heights, and the normal map is sharper",
            );
        }
        if self.sky.is_none() {
            leave(self.occlusion.take(), "occlusion dims the light of a sky, of which there is none");
        }
        if kind == Kind::Quad {
            leave(self.sky.take(), "the picture covers the sky");
        }
    }

    /// Returns true if light has to fall on it.
    pub fn is_lit(&self) -> bool {
        self.normal.is_some()
            || self.height.is_some()
            || self.roughness.is_some()
            || self.packed.is_some()
            || self.mean_roughness.is_some()
            || self.mean_metal.is_some()
            || self.sky.as_ref().is_some_and(|sky| sky.is_float)
    }
}

/// Returns what a picture is: by its texels where they tell, else by its name. A picture alone is of colours whatever it is
/// called, as `metal.jpg` may be.
fn role(photo: &Photo, is_alone: bool) -> Role {
    let is_sky = photo.is_panorama() && (photo.is_float || photo.named == Some(Role::Sky));
    match photo.named {
        _ if is_sky => Role::Sky,
        Some(role @ (Role::Normal | Role::NormalDown)) => role,
        _ if photo.is_normals => Role::Normal,
        Some(Role::Sky) | None => Role::Color,
        Some(_) if is_alone => Role::Color,
        Some(role) => role,
    }
}
