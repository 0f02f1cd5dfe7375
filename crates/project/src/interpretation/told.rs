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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Project;
    use crate::command::{Command, SetLayer, TellHistory};
    use crate::interpretation::solid::{self, SolidModel};
    use std::path::Path;

    /// Beds of 400, 300 and 200 m, similar folds with their crest over the centre, and a normal fault that dips east.
    const TEXT: &str = "size = [4000, 3000, 1500]
        [[events]]
        kind = \"beds\"
        beds = [ { rock = \"granite\", thickness = 600, name = \"Basement\" },
                 { rock = \"sandstone\", thickness = 400, name = \"Sand\" },
                 { rock = \"limestone\", thickness = 300, name = \"Lime\" },
                 { rock = \"shale\", thickness = 200, name = \"Shale\" } ]
        [[events]]
        kind = \"fold\"
        wavelength = 2500
        amplitude = 60
        [[events]]
        kind = \"fault\"
        at = [2000, 1500, 0]
        strike = 0
        dip = 60
        slip = 150
        [[events]]
        kind = \"erosion\"
        depth = 150";

    fn project(folder: &Path, until: Option<f64>) -> Project {
        let mut new = Project::create(&folder.join("p.petro"), None).unwrap();
        let tell = TellHistory { text: TEXT.to_owned(), until, styles: Vec::new(), fault_colours: Vec::new() };
        new.project().apply(&Command::TellHistory(tell), &Progress::silent()).unwrap();
        new.publish().unwrap()
    }

    /// Where rock was laid down (metres east, depth), by ways back that share no line with the history's.
    fn back(east: f64, depth: f64, slip: f64) -> [f64; 2] {
        let (sin, cos) = 60f64.to_radians().sin_cos();
        let is_hanging = (east - 2000.0) * sin > depth * cos;
        let [east, depth] = if is_hanging { [east - slip * cos, depth - slip * sin] } else { [east, depth] };
        [east, depth + 60.0 * (std::f64::consts::TAU * (east - 2000.0) / 2500.0).cos()]
    }

    /// The largest misfits of i (m) and k of a project at places away from boundaries.
    fn misfits(project: &Project, slip: f64) -> [f64; 2] {
        let (document, geometry) = (project.document(), project.document().geometry.clone().unwrap());
        let model = project.facts().get(&SolidModel, &Progress::silent()).unwrap();
        let settings = solid::param_settings(document);
        let told = parameterization(document, &model, &settings, &Progress::silent()).unwrap().expect("told");
        let beds = [("Shale", 0.0, 200.0), ("Lime", 200.0, 500.0), ("Sand", 500.0, 900.0)];
        let names = document.layers();
        let size = geometry.size();
        let (mut worst, mut seen) = ([0.0f64; 2], 0);
        for n in 0..20_000usize {
            let share = |prime: f64| (n as f64 * prime).fract();
            let p =
                DVec3::from_array([0.754_877, 0.569_840, 0.430_159].map(share)) * DVec3::new(4000.0, 3000.0, 1500.0);
            let [east, depth] = back(p.x, p.z, slip);
            let Some((name, top, base)) = beds.iter().find(|bed| (bed.1 + 20.0..bed.2 - 20.0).contains(&depth)) else {
                continue;
            };
            let sin = 60f64.to_radians().sin();
            if p.z < 180.0 || ((p.x - 2000.0) * sin - p.z * 0.5).abs() < 50.0 {
                continue;
            }
            let at = geometry.voxel_from_world(p).as_vec3();
            let found = told.lookup(&*model, at);
            let layer = names.len() - 1 - usize::from(found.region.layer);
            assert_eq!(names[layer], *name, "{p}");
            let laid = geometry.voxel_from_world(DVec3::new(east, p.y, 0.0));
            let i_m = (f64::from(found.i) - laid.x / (size[0] - 1) as f64).abs() * 4000.0;
            worst = [worst[0].max(i_m), worst[1].max((f64::from(found.k) - (base - depth) / (base - top)).abs())];
            seen += 1;
        }
        assert!(seen > 5000, "{seen}");
        worst
    }

    #[test]
    fn coordinates_are_those_of_the_rock_before_its_events() {
        let folder = tempfile::tempdir().unwrap();
        let [i_m, k] = misfits(&project(folder.path(), None), 150.0);
        assert!(i_m < 0.5 && k < 2e-3, "{i_m} m, {k}");
    }

    #[test]
    fn a_stage_has_its_own_coordinates() {
        let folder = tempfile::tempdir().unwrap();
        let [i_m, k] = misfits(&project(folder.path(), Some(2.5)), 75.0);
        assert!(i_m < 0.5 && k < 2e-3, "{i_m} m, {k}");
    }

    #[test]
    fn whoever_states_how_beds_lie_is_obeyed() {
        let folder = tempfile::tempdir().unwrap();
        let mut project = project(folder.path(), None);
        let layer =
            SetLayer { layer: "Lime".to_owned(), k: Some(param::KDefinition::ParallelToTop), ..SetLayer::default() };
        project.apply(&Command::SetLayer(layer), &Progress::silent()).unwrap();
        let model = project.facts().get(&SolidModel, &Progress::silent()).unwrap();
        let settings = solid::param_settings(project.document());
        assert!(parameterization(project.document(), &model, &settings, &Progress::silent()).unwrap().is_none());
    }
}
