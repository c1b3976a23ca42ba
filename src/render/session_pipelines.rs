//! The pipelines of a session. Input: its scene with one choice of samples, and the features of that. Output: pipelines for
//! each pass, and tile culling; several are built at the same time, as drivers take one thread for each.

use std::sync::Arc;

use rayon::prelude::*;

use super::sample_pipeline::SamplePipeline;
use super::session::Session;
use super::tile_culling::TileCulling;
use super::{Tuning, build_pipeline, mesh_passes, specialization, tuning};
use crate::core::error::Result;
use crate::gpu::Pipeline;
use crate::gpu::shaders::Shader;
use crate::pack::features::Features;
use crate::pack::{PackedScene, Schedule};
use crate::render::resources::shader_for;
use crate::schema::constants::{SEARCH_TEAM, SEARCH_TEAM_REST, TEAM_HEIGHT, TEAM_WIDTH};
use crate::schema::layout::Slice;
use crate::schema::specialization::Constant;

/// The pipelines of all passes, and the first one's number of workgroups per tile.
type Passes = (Vec<Arc<Pipeline>>, u32);

impl Session<'_> {
    /// Returns tile culling. The pipelines of samples, which need its lists, are built meanwhile and kept for later.
    pub(super) fn new_tile_culling(&self, scene: &PackedScene, features: &Features) -> Result<TileCulling> {
        let ahead = || match scene.schedule {
            Schedule::Tiles if scene.beams => {}
            Schedule::Tiles | Schedule::Batches => {
                // An error comes back when they are asked for.
                let _ = shader_for(scene.algorithm, features)
                    .and_then(|shader| self.pipelines(scene, features, shader));
            }
        };
        // Not by the pool's threads: one that waits for the device could keep the thread that has it from the pool.
        std::thread::scope(|threads| {
            threads.spawn(ahead);
            TileCulling::new(self.gpu, scene, &self.resources, features)
        })
    }

    /// Returns the pipelines of the passes by which tiles are rendered.
    pub(super) fn pipelines(
        &self,
        scene: &PackedScene,
        features: &Features,
        shader: &'static Shader,
    ) -> Result<Passes> {
        // Lists serve all choices of samples of a session.
        let lists_shades = match self.tile_culling() {
            Some(tile_culling) => tile_culling.lists_shades,
            None => mesh_passes::lists_shades(self.gpu.info(), scene, features),
        };
        let searches = mesh_passes::passes(self.gpu.info(), scene, features, lists_shades);
        let build = |&search: &u32| self.pipeline(features, shader, search, lists_shades);
        let pipelines = searches.par_iter().map(build).collect::<Result<Vec<_>>>()?;
        Ok((pipelines, tuning::groups_per_tile(self.group_size(searches[0])?)))
    }

    fn group_size(&self, search: u32) -> Result<[u32; 2]> {
        match search {
            SEARCH_TEAM | SEARCH_TEAM_REST => Ok([TEAM_WIDTH, TEAM_HEIGHT]),
            _ => self.tuning.group_size(self.gpu.info()),
        }
    }

    pub(super) fn sample_pipeline(&self, scene: &PackedScene, features: &Features) -> Result<SamplePipeline> {
        let shader = shader_for(scene.algorithm, features)?;
        let (pipelines, groups_per_tile) = self.pipelines(scene, features, shader)?;
        Ok(SamplePipeline { pipelines, shader, groups_per_tile })
    }

    fn pipeline(
        &self,
        features: &Features,
        shader: &'static Shader,
        search: u32,
        lists_shades: bool,
    ) -> Result<Arc<Pipeline>> {
        let group_size = self.group_size(search)?;
        let slots = self.resources.slots;
        let mut constants =
            specialization::constants(shader, features, &self.resources.sections, group_size, slots);
        let tables_in_head = u32::from(Tuning::tables_in_head(self.gpu.info()));
        let parameters = [
            (Constant::TablesInHead, tables_in_head),
            (Constant::MeshSearch, search),
            (Constant::ListsShades, u32::from(lists_shades)),
            (Constant::Quantities, features.quantities),
        ];
        constants.extend(shader.values(parameters));
        build_pipeline(self.gpu, shader, &constants, slots, size_of::<Slice>())
    }
}
