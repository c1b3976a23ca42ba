//! The reflection models: name, properties, and the keys of `[[material]]` that only some of them have. `emits`: it emits
//! light and has no other property; `lit`: it reflects the light of lights; `specular`: it reflects or refracts rays; `transmits`: it transmits them;
//! `glossy`: beside the light of lights it reflects rays, by chance.

/// Hands the table to another macro.
macro_rules! with_models {
    ($consumer:ident) => {
        $consumer! {
            Unlit = "unlit", [emits], [];
            #[default]
            Lambert = "lambert", [lit], [];
            Mirror = "mirror", [specular], [roughness];
            /// Reflects or refracts, in the ratio of the Fresnel equations.
            Dielectric = "dielectric", [specular transmits], [ior roughness];
            /// Lambert with a highlight.
            Phong = "phong", [lit], [specular exponent];
            /// Rough diffuse, energy-preserving.
            OrenNayar = "oren-nayar", [lit], [roughness];
            /// A metal, or a diffuse body under a dielectric surface; facets follow GGX (glTF 2.0, Appendix B).
            MetallicRoughness = "metallic-roughness", [lit glossy], [metallic roughness metallic_roughness_map ior
                specular_weight specular_weight_map specular_tint specular_tint_map transmission transmission_texture];
        }
    };
}
with_models!(models);
