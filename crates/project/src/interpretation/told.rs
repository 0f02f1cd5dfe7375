//! i, j and k of a block that was made from its geological history: what the history says, not what flows between its
//! horizons.

use crate::document::Document;
use glam::{DVec3, Vec3};
use history::{History, Rock, Stage};
use model::{Region, StructuralModel};
use param::{KnownPlaces, ParamError, ParamSettings, Parameterization};
use rayon::prelude::*;
use std::collections::HashMap;
use survey::{Progress, SurveyGeometry};

/// Voxels between the places at which the history is asked what a region is.
const ASKED_EVERY: usize = 3;
/// The share of them that have to be the same bed, so that the project still is that of its history.
const SAME_BED: f64 = 0.97;

/// What a history says of the regions of a model.
struct Told<'h> {
    stage: Stage<'h>,
    geometry: &'h SurveyGeometry,
    layers: usize,
    /// The rock of each region in the order of grids; of several the one that most of its places have.
    rocks: Vec<Option<Rock>>,
    /// The share of the places that have the bed of their layer.
    same: f64,
}

/// What is continued as one: the act that made the rock, its bed, and the sides of later faults on which it lies.
type Kind = (usize, Option<usize>, history::Sides);

impl<'h> Told<'h> {
    fn of(stage: Stage<'h>, geometry: &'h SurveyGeometry, model: &StructuralModel) -> Self {
        let (size, layers) = (model.size(), model.layer_count());
        let regions = layers * model.block_count();
        let counts = size.map(|n| n.div_ceil(ASKED_EVERY));
        let asked = (0..counts.iter().product::<usize>()).into_par_iter().filter_map(|n| {
            let index = [n / (counts[1] * counts[2]), n / counts[2] % counts[1], n % counts[2]];
            let p = Vec3::from_array(index.map(|n| (n * ASKED_EVERY) as f32));
            let Region { layer, block } = model.region_at(p);
            let rock = *stage.place(geometry.world_from_voxel(p.as_dvec3())).rock()?;
            Some((usize::from(block) * layers + usize::from(layer), rock))
        });
        let mut kinds: Vec<HashMap<Kind, (usize, Rock)>> = vec![HashMap::new(); regions];
        for (region, rock) in asked.collect::<Vec<_>>() {
            let kind = (rock.act, stage.history().units()[rock.unit].bed, rock.sides);
            kinds[region].entry(kind).or_insert((0, rock)).0 += 1;
        }
        let (mut all, mut same) = (0, 0);
        let rocks = kinds.into_iter().map(|kinds| {
            let most = kinds.iter().max_by_key(|(kind, (count, _))| (*count, **kind))?;
            let (act, bed, _) = *most.0;
            all += kinds.values().map(|(count, _)| count).sum::<usize>();
            let is_same = |kind: &Kind| kind.0 == act && kind.1 == bed;
            let of_bed = kinds.iter().filter(|(kind, (_, rock))| is_same(kind) || rock.altered.is_some());
            same += of_bed.map(|(_, (count, _))| count).sum::<usize>();
            Some(most.1.1)
        });
        let rocks = rocks.collect();
        Self { stage, geometry, layers, rocks, same: f64::from(same as u32) / f64::from(all.max(1) as u32) }
    }

    fn rock(&self, region: Region) -> Option<&Rock> {
        self.rocks[usize::from(region.block) * self.layers + usize::from(region.layer)].as_ref()
    }
}

impl KnownPlaces for Told<'_> {
    fn place(&self, region: Region, p: Vec3) -> Option<Vec3> {
        let found = self.stage.coordinates(self.rock(region)?, self.geometry.world_from_voxel(p.as_dvec3()));
        let voxel = self.geometry.voxel_from_world(DVec3::new(found.x, found.y, 0.0));
        Some(DVec3::new(voxel.x, voxel.y, found.z).as_vec3())
    }

    fn thickness_m(&self, region: Region) -> Option<f64> {
        self.stage.bed_thickness_m(self.rock(region)?)
    }
}

/// The parameterization of a project that was made from its history; `None` where the project is none, or is no longer what
/// its history tells: then it is computed as that of any other.
///
/// # Errors
/// As [`Parameterization::compute`].
pub(crate) fn parameterization(
    document: &Document,
    model: &StructuralModel,
    settings: &ParamSettings,
    progress: &Progress,
) -> Result<Option<Parameterization>, ParamError> {
    let (Some((text, until)), Some(geometry)) = (document.history_of_coordinates(), &document.geometry) else {
        return Ok(None);
    };
    let Ok(history) = History::from_toml(text) else { return Ok(None) };
    let stage = until.map_or_else(|| history.last_stage(), |until| history.stage(until));
    if stage.geometry() != *geometry {
        return Ok(None);
    }
    let told = Told::of(stage, geometry, model);
    if told.same < SAME_BED {
        return Ok(None);
    }
    Parameterization::of_known(model, &told, settings, progress).map(Some)
}
