//! The reflection models: name, what each does with light, and the keys of `[[material]]` that not all of them have.
//! `emits`: it shines by itself; `lit`: it reflects light; `specular`: rays go on from it; `transmits`: through it, too.

/// Hands the table to another macro.
macro_rules! with_models {
    ($consumer:ident) => {
        $consumer! {
            Unlit = "unlit", [emits], [];
            #[default]
            Lambert = "lambert", [lit], [];
            Mirror = "mirror", [specular], [roughness];
            /// Mirrors or refracts, by Fresnel's share of each.
            Dielectric = "dielectric", [specular transmits], [ior roughness];
            /// Lambert with a highlight.
            Phong = "phong", [lit], [specular exponent];
            /// Rough and diffuse; keeps all light.
            OrenNayar = "oren-nayar", [lit], [roughness];
        }
    };
}
with_models!(models);
