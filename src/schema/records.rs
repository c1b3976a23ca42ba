//! The records of the scene buffer behind its header (`header.rs`). `f64` and vectors of it are reals: f32 on the device
//! unless its geometry is f64.
//! All positions are relative to the eye. A record's list has a name, and a description of the code that loops over it.

records! {
    /// A plane, or a square part of it.
    Plane in planes as "loop over planes" {
        /// Unit normal n.
        normal: DVec3,
        /// n · (origin − eye).
        distance: f64,
        /// The coordinate u of a point p: axis_u · p counts from the eye, plus `eye_u` from the plane's origin.
        axis_u: DVec3,
        eye_u: f64,
        axis_v: DVec3,
        eye_v: f64,
        material: u32,
        uv_projection: u32,
        /// Half extent in tangents; negative: the plane is infinite.
        half_extent: RealBits,
    }

    Sphere in spheres as "loop over spheres" {
        center: DVec3,
        radius: f64,
        material: u32,
        uv_projection: u32,
    }

    Triangle in triangles as "loop over triangles" {
        a: DVec3,
        u_a: f64,
        b: DVec3,
        u_b: f64,
        c: DVec3,
        u_c: f64,
        /// v of the three vertices.
        v: DVec3,
        /// Unit geometric normal n.
        normal: DVec3,
        /// n · a.
        distance: f64,
        /// Unit shading normals.
        normal_a: DVec3,
        normal_b: DVec3,
        normal_c: DVec3,
        material: u32,
        uv_projection: u32,
        /// True if it has shading normals.
        is_smooth: bool,
    }

    Disc in discs as "loop over discs" {
        /// Unit normal n.
        normal: DVec3,
        /// n · (center − eye).
        distance: f64,
        center: DVec3,
        radius: f64,
        /// Own coordinates of a point p: axis_u · (p − center) and axis_v · (p − center), within the unit circle.
        axis_u: DVec3,
        axis_v: DVec3,
        material: u32,
        uv_projection: u32,
        /// Its texture coordinates are angle and radius.
        is_polar: bool,
    }

    /// Triangles of one material in a tree. All its parts lie in the buffer of meshes, where others may share them.
    Mesh in meshes as "loop over meshes" {
        /// The ball around its box.
        center: DVec3,
        radius: f64,
        material: u32,
        uv_projection: u32,
        /// Texel of the root's first child, two for each child.
        nodes: u32,
        /// Texel of the first triangle's corners, three for each triangle.
        corners: u32,
        /// Texel of the first triangle's attributes.
        attributes: u32,
        /// Their number for each triangle: four, then two each of colours and further texture coordinates.
        attribute_count: u32,
        has_colors: bool,
        has_second_uv: bool,
        has_tangents: bool,
        /// True if some triangle has shading normals.
        is_smooth: bool,
        /// Or `NO_PLACEMENT`.
        placement: u32,
    }

    /// Rows of the matrix from the space of a mesh's triangles to that of the scene, and of the inverse.
    Placement in placements as "meshes that share triangles" {
        x: DVec4,
        y: DVec4,
        z: DVec4,
        to_mesh_x: DVec4,
        to_mesh_y: DVec4,
        to_mesh_z: DVec4,
    }

    Light in lights as "loop over lights" {
        /// Position of point and sphere lights, centre of rectangles.
        position: DVec3,
        /// Radius of a sphere.
        radius: f64,
        /// Unit vector towards a directional light or the centre of the sun.
        direction: DVec3,
        /// Height of the sun's cap on the unit sphere.
        cap_height: f64,
        /// A spot's intensity is that of its axis times the square of `spot_slope` cos + `spot_offset`, within 0 and 1.
        spot_slope: f32,
        spot_offset: f32,
        /// 1 over the distance at which the light of a spot or a point ends; 0 for none.
        inverse_range: f32,
        /// Edges of a rectangle, the longer first; it emits towards edge_u × edge_v.
        edge_u: DVec3,
        /// Their lengths; 0 if they are not at right angles.
        length_u: f64,
        edge_v: DVec3,
        length_v: f64,
        /// Intensity (W/sr) of points and spheres, irradiance of directional lights, radiance of rectangles.
        power: Vec3,
        kind: LightKind,
    }

    /// Where a texture is absent, its index is `NO_TEXTURE`.
    Material in materials as "choice among materials" {
        color: Vec3,
        bump_strength: f32,
        model: Model,
        texture_index: u32,
        sampler_index: u32,
        image_slot: u32,
        bump_texture_index: u32,
        bump_sampler_index: u32,
        bump_image_slot: u32,
        bump_kind: BumpKind,
        /// Roughness of a mirror's or glass's microfacet distribution (GGX); 0 is smooth.
        alpha: f32,
        roughness: f32,
        metallic: f32,
        roughness_texture_index: u32,
        roughness_sampler_index: u32,
        roughness_image_slot: u32,
        emission_texture_index: u32,
        emission_sampler_index: u32,
        emission_image_slot: u32,
        /// Emitted radiance; times its texture.
        emission: Vec3,
        occlusion_strength: f32,
        occlusion_texture_index: u32,
        occlusion_sampler_index: u32,
        occlusion_image_slot: u32,
        /// Maps read at the mesh's second coordinates: a bit for each `MaterialMap`, above them colour and bump map.
        second_uv_maps: u32,
        /// The same bits for maps with coordinates of their own, whose records follow each other in the order of the bits.
        own_uv_maps: u32,
        first_map_uv: u32,
        alpha_mode: AlphaMode,
        alpha_cutoff: f32,
        /// Times the alpha of its texture.
        opacity: f32,
        one_sided: bool,
        /// Share of the light in a body that passes it, of model `metallic-roughness`.
        transmission: f32,
        /// Colour of Phong's highlight, or a dielectric's reflectance head-on, at most `edge` after its maps.
        specular: Vec3,
        /// Reflectance of a dielectric surface at grazing angles, of model `metallic-roughness`.
        edge: f32,
        /// Exponent of Phong's highlight.
        exponent: f32,
        ior: f32,
        specular_weight_texture_index: u32,
        specular_weight_sampler_index: u32,
        specular_weight_image_slot: u32,
        specular_tint_texture_index: u32,
        specular_tint_sampler_index: u32,
        specular_tint_image_slot: u32,
        transmission_texture_index: u32,
        transmission_sampler_index: u32,
        transmission_image_slot: u32,
    }

    /// The mapping from a surface point to a texture coordinate.
    UvProjection in uv_projections as "choice among mappings" {
        /// Frame coordinates of a point p: xyz · p + w.
        x: DVec4,
        y: DVec4,
        z: DVec4,
        /// uv' = (m00 u + m01 v, m10 u + m11 v) + offset.
        m00: f64,
        m01: f64,
        m10: f64,
        m11: f64,
        offset: DVec2,
        kind: MapKind,
        entity: EntityKind,
    }

    /// Coordinates at which one map of a material is read: those of a set of the mesh, transformed.
    MapUv in map_uvs as "coordinates of maps" {
        /// uv' = (row_u · uv, row_v · uv) + offset.
        row_u: DVec2,
        row_v: DVec2,
        offset: DVec2,
        /// Which set, 0 for the second.
        set: u32,
    }

    Texture in textures as "choice among textures" {
        /// Width, height, depth.
        size: UVec3,
        format: TexelFormat,
        /// First word of level 0 in the texel buffer.
        first_word: u32,
        color_space: ColorSpace,
        levels: u32,
        kind: TextureKind,
        /// Index into the list of procedural textures, for those.
        procedural: u32,
    }

    Sampler in samplers as "choice among samplers" {
        border: Vec4,
        address_u: Address,
        address_v: Address,
        address_w: Address,
        texel_center: TexelCenter,
        method: Method,
        mag_filter: Filter,
        min_filter: Filter,
        mip_mode: MipMode,
        max_anisotropy: u32,
        /// Rows continue across the poles.
        crosses_poles: bool,
        /// B and C of the cubic filter (Mitchell & Netravali 1988).
        cubic_b: f32,
        cubic_c: f32,
    }

    Procedural in procedurals as "choice among procedural textures" {
        width: f64,
        aspect: f64,
        offset: f64,
        jitter: f64,
        background: Vec3,
        kind: ProceduralKind,
        figure: Vec3,
        seed: u32,
        lacunarity: f32,
        gain: f32,
        /// 1 / sum of the gains.
        normalization: f32,
        distortion: f32,
        octaves: u32,
        dimensions: u32,
    }

    /// Four numbers of the distribution of the environment's light: cumulative, of its rows, then of the cells of each.
    EnvironmentPart in environment_parts as "environment as a light" {
        values: Vec4,
    }

    /// Two entries of the table of what facets reflect: each the share of light at a reflectance of 1, and what it falls
    /// short of that in Schlick's approximation.
    FacetPart in facet_parts as "light between facets" {
        values: Vec4,
    }

    /// The motion of a shape, in the order of shapes; the list is empty if nothing moves.
    Motion in motions as "choice among motions" {
        /// Displacement between the times 0 and 1.
        shift: DVec3,
    }
}
