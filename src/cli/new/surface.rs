//! The pictures of a new scene by what they are. Input: pictures, and what is shown. Output: which of them is the colours,
//! the normal map and so on; what has no place in a material is left out, with the reason.

use super::Kind;
use super::names::Role;
use super::photo::Photo;

#[derive(Default)]
pub(super) struct Surface {
    pub color: Option<Photo>,
    pub normal: Option<Photo>,
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
    /// Pictures that are not in the scene, with the reasons.
    pub left_out: Vec<String>,
    /// What should be known of those that are.
    pub notes: Vec<String>,
}

impl Surface {
    pub fn new(photos: Vec<Photo>, kind: Kind) -> Surface {
        let mut surface = Surface::default();
        let (is_alone, mut metal) = (photos.len() == 1, None);
        // A picture whose name says nothing is of the colours only where no other is.
        let (named, others): (Vec<Photo>, Vec<Photo>) =
            photos.into_iter().partition(|photo| photo.named.is_some());
        for photo in named.into_iter().chain(others) {
            let role = role(&photo, is_alone, kind);
            let shown = photo.path.display().to_string();
            let mut leave = |why: &str| surface.left_out.push(format!("{shown}: {why}"));
            let place = match role {
                Role::Color => &mut surface.color,
                Role::Normal => &mut surface.normal,
                Role::Height => &mut surface.height,
                Role::Roughness => &mut surface.roughness,
                Role::Packed => &mut surface.packed,
                Role::Emission => &mut surface.emission,
                Role::Occlusion => &mut surface.occlusion,
                Role::Sky => &mut surface.sky,
                Role::Metallic => &mut metal,
                Role::Gloss => {
                    leave("gloss has no map here; its mean is the roughness");
                    surface.mean_roughness = Some(1.0 - photo.mean());
                    continue;
                }
                Role::MetalGloss => {
                    leave("metal and gloss in one have no map here; their means are metal and roughness");
                    surface.mean_metal = Some(photo.mean());
                    // Without alpha it is of metal alone.
                    surface.mean_roughness = photo.means.get(3).map(|gloss| 1.0 - gloss);
                    continue;
                }
                Role::Opacity => {
                    leave("opacity is the alpha of the colors; put it into that channel");
                    continue;
                }
                Role::OtherPacked(word) => {
                    let order = "roughness has to be green, and metal blue, as in ORM";
                    leave(&format!("its channels are in another order (\"{word}\"): {order}"));
                    continue;
                }
                Role::Other(word) => {
                    leave(&format!("no material here has a map of this kind (\"{word}\")"));
                    continue;
                }
            };
            match place {
                None => *place = Some(photo),
                Some(first) => {
                    let first = first.path.display();
                    leave(&format!("{}, as {first} is already", role.words()));
                }
            }
        }
        surface.settle(metal, kind);
        surface.note();
        surface
    }

    /// Leaves out what does not go together.
    fn settle(&mut self, metal: Option<Photo>, kind: Kind) {
        let is_sky_light = kind != Kind::Quad && self.is_sky_light();
        let mut leave = |photo: Option<Photo>, why: &str| {
            self.left_out.extend(photo.map(|photo| format!("{}: {why}", photo.path.display())));
        };
        if self.packed.is_some() {
            leave(self.roughness.take(), "the packed picture has roughness, too");
            leave(self.occlusion.take(), "the packed picture has occlusion, too");
        }
        if let Some(metal) = metal {
            if self.packed.is_none() {
                self.mean_metal = Some(metal.mean());
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
                self.mean_roughness = Some(roughness.mean());
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
        if kind == Kind::Quad {
            leave(self.sky.take(), "the picture covers the sky");
        }
        if !is_sky_light {
            leave(
                self.occlusion.take(),
                "occlusion dims the light of a sky, of which there is none: add a panorama of floats (HDR, EXR)",
            );
        }
    }

    /// Notes what is not as it looks in other programs.
    fn note(&mut self) {
        let mut notes = Vec::new();
        for photo in [&self.color, &self.emission, &self.sky].into_iter().flatten() {
            let shown = photo.path.display();
            if let Some(profile) = &photo.profile
                && let Some(why) = profile.fault()
            {
                let name = &profile.name;
                notes.push(format!(
                    "{shown}: its color profile ({name}) {why} and is not applied; convert it to sRGB for true colors"
                ));
            }
            if photo.is_premultiplied {
                notes.push(format!(
                    "{shown}: colors of OpenEXR are multiplied by alpha, and blending does so again: edges darken"
                ));
            }
        }
        if let Some(color) = &self.color
            && color.named == Some(Role::Sky)
        {
            let [width, height] = color.size;
            if !color.is_panorama() {
                let what = format!("{width} x {height} is not twice as wide as high, as skies are");
                notes.push(format!("{}: {what}, so it is of colors", color.path.display()));
            }
        }
        if let Some(normal) = &self.normal
            && let (Some(named), Some(found)) = (normal.green_named, normal.green_found)
            && named != found
        {
            notes.push(format!(
                "{}: its texels look as if green points {}, and its name says {}; if bumps look like dents, change green",
                normal.path.display(),
                if found { "up (OpenGL)" } else { "down (DirectX)" },
                if named { "up" } else { "down" },
            ));
        }
        self.notes = notes;
    }

    /// Returns true if light falls on the surface itself.
    pub fn is_lit(&self) -> bool {
        self.has_relief_or_gloss() || self.is_sky_light()
    }

    /// Returns true if anything but colours is known of the surface.
    pub fn has_relief_or_gloss(&self) -> bool {
        self.normal.is_some()
            || self.height.is_some()
            || self.roughness.is_some()
            || self.packed.is_some()
            || self.mean_roughness.is_some()
            || self.mean_metal.is_some()
    }

    /// Returns true if a sky of floats lights the scene.
    pub fn is_sky_light(&self) -> bool {
        self.sky.as_ref().is_some_and(|sky| sky.is_float)
    }
}

/// Returns what a picture is: by its texels where they tell, else by its name. A picture alone is of colours whatever it is
/// called, as `metal.jpg` may be.
fn role(photo: &Photo, is_alone: bool, kind: Kind) -> Role {
    let may_be_sky = matches!(photo.named, None | Some(Role::Sky)) && !(is_alone && kind == Kind::Quad);
    let is_sky = photo.is_panorama() && (photo.is_float || photo.named == Some(Role::Sky));
    match photo.named {
        _ if is_sky && may_be_sky => Role::Sky,
        Some(Role::Normal) => Role::Normal,
        _ if photo.is_normals => Role::Normal,
        Some(Role::Sky) | None => Role::Color,
        Some(_) if is_alone => Role::Color,
        // Rusty metal's roughness.
        Some(Role::Packed) if photo.is_grey => Role::Roughness,
        Some(role) => role,
    }
}
