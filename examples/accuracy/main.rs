//! Measures the rows of `docs/accuracy.md`; `make accuracy` writes them. `accuracy definitions` and `accuracy shapes` print
//! the tables of the definitions alone.
//!
//! Closed-form models and the synthetic survey, whose truth is a closed form too; the exact lookup and the paper's
//! packed, extrapolated one (P-illus 3.3 and 3.4) side by side, at the same places, by the same yardstick. Lengths are
//! voxels, angles degrees.

#[path = "../../crates/render/tests/pictures/compare.rs"]
#[expect(dead_code, reason = "the tests use more of it")]
mod compare;
mod shapes;

use anyhow::{Context, Result};
use glam::{DVec3, Vec3};
use model::section::SectionPlane;
use model::{ModelSettings, StructuralModel};
use param::accuracy::{self, HorizonPoint, Spread};
use param::{FlatPoint, KDefinition, PackedVolume, ParamSettings, Parameterization, Region};
use render::{Inputs, Lookup, Outlines, Renderer, Scene, VoxelBox};
use survey::{Fault, Horizon, Progress, Stratigraphy, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use synth::{SynthSettings, SynthTruth, Synthetic};
use ttf::{BlockExtent, LayerExtent, TextureLibrary, TransferFunctions, TtfTables};

/// Places measured on each horizon in each block.
const PLACES: usize = 3000;
/// Pixels a voxel at which boundaries are looked at.
const ZOOM: f64 = 4.0;
/// Samples along each axis of the closed-form models.
const SIDE: usize = 96;
/// Samples along each axis of the synthetic survey.
const SYNTHETIC_SIDE: usize = 128;

/// Where horizons, layers and blocks really are.
enum Truth {
    Closed(Box<ClosedForm>),
    Synthetic(Box<SynthTruth>),
}

impl Truth {
    /// Voxel z of a horizon before it is cut off, in the block that the place lies in.
    fn sheet_z(&self, horizon: usize, place: DVec3) -> f64 {
        match self {
            Self::Closed(model) => model.sheet_z(horizon, model.block_at(place), place.x, place.y),
            Self::Synthetic(truth) => truth.sheet_z(horizon, truth.block_at(place), place.x, place.y),
        }
    }

    /// What changes at boundaries that are drawn: layers, and blocks where every fault reaches through the volume.
    fn label(&self, p: DVec3) -> u32 {
        match self {
            Self::Closed(model) => u32::from(model.layer_at(p)) << 8 | u32::from(model.block_at(p)),
            Self::Synthetic(truth) => u32::from(truth.layer_at(p)),
        }
    }

    /// The same of what was computed.
    fn label_of(&self, region: Region) -> u32 {
        match self {
            Self::Closed(_) => u32::from(region.layer) << 8 | u32::from(region.block),
            Self::Synthetic(_) => u32::from(region.layer),
        }
    }
}

/// A model to measure.
struct Case {
    name: &'static str,
    geometry: SurveyGeometry,
    stratigraphy: Stratigraphy,
    model: StructuralModel,
    param: Parameterization,
    packed: PackedVolume,
    truth: Truth,
}

impl Case {
    fn new(
        name: &'static str,
        geometry: SurveyGeometry,
        stratigraphy: Stratigraphy,
        horizons: &[Horizon],
        faults: &[Fault],
        truth: Truth,
    ) -> Result<Self> {
        let quiet = Progress::silent();
        let model =
            StructuralModel::build(&geometry, &stratigraphy, horizons, faults, &ModelSettings::default(), &quiet)?;
        let param = Parameterization::compute(&model, &published(&model), &quiet)?;
        let voxels = param.voxel_volumes(&model, model.size(), &quiet)?;
        let packed = PackedVolume::from_voxels(&voxels, model.size(), model.layer_count(), model.block_count());
        Ok(Self { name, geometry, stratigraphy, model, param, packed, truth })
    }

    fn closed(name: &'static str, form: ClosedForm) -> Result<Self> {
        let (geometry, stratigraphy) = (form.geometry.clone(), form.stratigraphy.clone());
        let (horizons, faults) = (form.horizons.clone(), form.faults.clone());
        Self::new(name, geometry, stratigraphy, &horizons, &faults, Truth::Closed(Box::new(form)))
    }

    fn synthetic(name: &'static str, seed: u64) -> Result<Self> {
        let settings = SynthSettings { size: [SYNTHETIC_SIDE; 3], seed, ..SynthSettings::default() };
        let made = Synthetic::generate(&settings, &Progress::silent())?;
        let truth = Truth::Synthetic(Box::new(made.truth));
        Self::new(name, made.geometry, made.stratigraphy, &made.horizons, &made.faults, truth)
    }

    fn exact(&self, p: Vec3) -> FlatPoint {
        self.param.lookup(&self.model, p)
    }

    fn paper(&self, p: Vec3) -> FlatPoint {
        self.packed.lookup_extrapolated(p)
    }

    /// Places on the true horizons, including places on the outer boundary.
    fn horizon_places(&self) -> Vec<HorizonPoint> {
        let depth = |horizon: usize, block: u16, x: f32, y: f32| {
            let near = self.model.sheet(horizon, block).z_at(x, y);
            self.truth.sheet_z(horizon, DVec3::new(x.into(), y.into(), near.into())) as f32
        };
        accuracy::horizon_points(&self.model, depth, PLACES)
    }

    fn planes(&self) -> [SectionPlane; 3] {
        let high = VoxelBox::of_size(self.geometry.size()).high();
        let low = DVec3::ZERO;
        [
            SectionPlane::crossline(0.37 * high.y, low, high),
            SectionPlane::inline(0.61 * high.x, low, high),
            SectionPlane::slice(0.55 * high.z, low, high),
        ]
    }
}

fn cases() -> Result<Vec<Case>> {
    let geometry = SurveyGeometry::regular([SIDE; 3], 25.0, 20.0, VerticalUnit::Metres);
    let samples = [28.0, 50.0, 72.0];
    Ok(vec![
        Case::closed(
            "parallel planes, dip 35°, fault",
            ClosedForm::dipping(&geometry, &samples, 35.0, 30.0).with_fault(60.0, 7.0),
        )?,
        Case::closed(
            "concentric dome, dip to 35°, fault",
            ClosedForm::dome(&geometry, &samples, 35.0).with_fault(65.0, 6.0),
        )?,
        Case::closed(
            "folds, dip to 32°, thickness ± 30 %, fault",
            ClosedForm::folded(&geometry, &samples, 32.0, 0.3).with_fault(60.0, 6.0),
        )?,
        Case::closed(
            "dipping beds under an unconformity",
            ClosedForm::unconformity(&geometry, 30.0, &[40.0, 60.0], 25.0, 20.0),
        )?,
        Case::synthetic("synthetic survey, seed 1", 1)?,
        Case::synthetic("synthetic survey, seed 7", 7)?,
    ])
}

fn row(name: &str, ours: &Spread, paper: &Spread, digits: usize) {
    println!(
        "| {name} | {:.digits$} | {:.digits$} | {:.digits$} | {:.digits$} | {} |",
        ours.median, ours.p95, paper.median, paper.p95, ours.count
    );
}

fn k_and_angles(cases: &[Case]) -> Result<()> {
    println!("## k on the horizons\n");
    println!(
        "|k − {{0, 1}}| in voxels of depth, at places on the *true* horizons in every block, up to the outer\n\
         boundary. Aim: median ≤ 0.02, 95 % ≤ 0.1.\n"
    );
    println!(
        "| model | ours, median | ours, 95 % | paper's lookup, median | paper's, 95 % | places |\n|---|---|---|---|---|---|"
    );
    for case in cases {
        let places = case.horizon_places();
        let ours = accuracy::k_on_horizons(&case.model, &case.param, |p| case.exact(p), &places);
        let paper = accuracy::k_on_horizons(&case.model, &case.param, |p| case.paper(p), &places);
        row(case.name, &ours, &paper, 3);
    }
    println!("\n## Angles\n");
    println!(
        "Angles between the metric gradients of k and i, and of k and j: degrees off 90. Aim: median ≤ 0.2°, 95 %\n\
         ≤ 1°. Places at creases of f_z, where the closest point jumps, are counted separately.\n"
    );
    println!(
        "| model | ours, median | ours, 95 % | paper's lookup, median | paper's, 95 % | places |\n|---|---|---|---|---|---|"
    );
    for case in cases {
        let ours = accuracy::angles(&case.model, &case.param, |p| case.exact(p), 10 * PLACES)?;
        let paper = accuracy::angles(&case.model, &case.param, |p| case.paper(p), 10 * PLACES)?;
        row(&format!("{}: k to i", case.name), &ours.k_to_i, &paper.k_to_i, 3);
        row(&format!("{}: k to j ({} at creases)", case.name, ours.at_creases), &ours.k_to_j, &paper.k_to_j, 3);
    }
    Ok(())
}

fn boundaries(cases: &[Case]) -> Result<()> {
    println!("\n## Boundaries in an image\n");
    println!(
        "Distance between the boundaries of layers and blocks in an image of {ZOOM} pixels a voxel and the true\n\
         ones, measured both ways on an inline, a crossline and a slice; voxels. Aim: ≤ 0.1, the worst 1 %\n\
         included.\n"
    );
    println!(
        "| model | ours, median | ours, 99 % | ours, worst | paper's lookup, median | paper's, 99 % |\n|---|---|---|---|---|---|"
    );
    for case in cases {
        let mut spreads = [Vec::new(), Vec::new()];
        for plane in case.planes() {
            let truth = |p: DVec3| case.truth.label(p);
            let ours = |p: DVec3| case.truth.label_of(case.model.region_at(p.as_vec3()));
            let paper = |p: DVec3| case.truth.label_of(case.paper(p.as_vec3()).region);
            spreads[0].extend(model::accuracy::boundaries(&plane, ZOOM, ours, truth));
            spreads[1].extend(model::accuracy::boundaries(&plane, ZOOM, paper, truth));
        }
        let worst = |set: &[model::accuracy::BoundaryAccuracy], of: fn(&model::accuracy::BoundaryAccuracy) -> f64| {
            set.iter().map(of).fold(0.0, f64::max)
        };
        let [ours, paper] = &spreads;
        println!(
            "| {} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} |",
            case.name,
            worst(ours, |b| b.median),
            worst(ours, |b| b.percentile_99),
            worst(ours, |b| b.worst),
            worst(paper, |b| b.median),
            worst(paper, |b| b.percentile_99)
        );
    }
    println!();
    println!(
        "The worst places of the synthetic survey lie beside a fault, where a horizon is continued from its last\n\
         node over a fraction of a voxel: there an error of 0.05 voxel in depth becomes 0.2 along a gently\n\
         dipping horizon in a slice."
    );
    Ok(())
}

/// Every definition of k, by the exact lookup.
const DEFINITIONS: [(&str, KDefinition); 6] = [
    ("flow", KDefinition::Flow),
    ("harmonic", KDefinition::Harmonic),
    ("proportional", KDefinition::Proportional),
    ("distance", KDefinition::DistanceRatio),
    ("parallel-to-bottom", KDefinition::ParallelToBottom),
    ("parallel-to-top", KDefinition::ParallelToTop),
];

/// Whether a definition measures the layer above a horizon from there, and the one below. The top and the bottom layer have
/// one horizon alone.
fn is_measured_from(definition: KDefinition, horizon: usize, horizons: usize) -> [bool; 2] {
    [
        definition != KDefinition::ParallelToTop || horizon == 0,
        definition != KDefinition::ParallelToBottom || horizon + 1 == horizons,
    ]
}

/// Error of k at a horizon, voxels of depth: 0 in the layer above it, 1 in the one below, as far as the definition
/// measures that layer from there.
fn k_errors(case: &Case, param: &Parameterization, definition: KDefinition, point: &HorizonPoint) -> Vec<f32> {
    let horizons = case.model.layer_count() - 1;
    let layer_above = (horizons - point.horizon) as u16;
    let [from_bottom, from_top] = is_measured_from(definition, point.horizon, horizons);
    let sides = [(from_bottom, layer_above, 0.0), (from_top, layer_above - 1, 1.0)];
    let error = |(_, layer, k): (bool, u16, f32)| {
        let (found, jacobian) = param.lookup_in(&case.model, point.p, Region { layer, block: point.block });
        (found.k - k).abs() / jacobian[2][2].abs()
    };
    sides.into_iter().filter(|side| side.0).map(error).collect()
}

fn definitions(cases: &[Case]) -> Result<()> {
    println!("\n## Definition by definition\n");
    println!(
        "The same models and aims for every definition (`layer set --k`), without smoothing: 95 % of the errors of k on\n\
         the true horizons, voxels of depth / of the angle between k and i / between k and j, degrees. The parallel\n\
         definitions measure a layer from one horizon, and are held to that one. Regions, and so the boundaries in an\n\
         image, are the same for all.\n"
    );
    let names: Vec<&str> = DEFINITIONS.iter().map(|(name, _)| *name).collect();
    println!("| model | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
    for case in cases {
        let places = case.horizon_places();
        let mut cells = Vec::new();
        for (_, definition) in DEFINITIONS {
            let settings =
                ParamSettings { definitions: vec![definition; case.model.layer_count()], ..ParamSettings::default() };
            let param = Parameterization::compute(&case.model, &settings, &Progress::silent())?;
            let k = Spread::of(places.iter().flat_map(|point| k_errors(case, &param, definition, point)).collect());
            let angles = accuracy::angles(&case.model, &param, |p| param.lookup(&case.model, p), 10 * PLACES)?;
            cells.push(format!("{:.3} / {:.3} / {:.3}", k.p95, angles.k_to_i.p95, angles.k_to_j.p95));
        }
        println!("| {} | {} |", case.name, cells.join(" | "));
    }
    Ok(())
}

/// The same scene by the GPU pass and by the CPU reference.
fn devices(cases: &[Case]) -> Result<()> {
    let mut renderer = Renderer::headless()?;
    println!("\n## GPU against CPU\n");
    println!(
        "Largest channel difference away from edges found in the CPU image, and the share of pixels that are\n\
         edges and differ by more than 2/255. Aim: ≤ 2/255 and ≤ 0.5 %. Adapter: {}.\n",
        renderer.adapter_name()
    );
    println!("| model | lookup | off edges, of 255 | differing edges |\n|---|---|---|---|");
    for (number, case) in (1..).zip(cases) {
        let extent = case.geometry.metric_from_voxel() * VoxelBox::of_size(case.geometry.size()).high();
        let layers = case.stratigraphy.layer_names_bottom_up().into_iter();
        let thickness_m = (extent.z / case.model.layer_count() as f64) as f32;
        let block = BlockExtent {
            extent_i_m: extent.x as f32,
            extent_j_m: extent.y as f32,
            layers: layers.map(|name| LayerExtent { name, thickness_m }).collect(),
            metres_per_mm: extent.x as f32 / 120.0,
        };
        let tables = TtfTables::compile(&TransferFunctions::default(), &block, &TextureLibrary::builtin()?)?;
        let inputs = Inputs {
            model: Some(&case.model),
            param: Some(&case.param),
            packed: Some(&case.packed),
            tables: Some(&tables),
            data_key: number,
            ..Inputs::raw(&case.geometry, &[])
        };
        for lookup in [Lookup::Exact, Lookup::Packed] {
            let scene =
                Scene { size_px: [240, 200], samples: 2, lookup, outlines: Outlines::none(), ..Scene::default() };
            let cpu = render::reference::render(&scene, &inputs, &Progress::silent())?;
            let gpu = renderer.render(&scene, &inputs, &Progress::silent())?;
            let found = compare::compare(&cpu, &gpu).context("pictures of different sizes")?;
            println!(
                "| {} | {lookup:?} | {} | {:.3} % |",
                case.name,
                found.worst_off_edges,
                100.0 * found.differing_edge_share
            );
        }
    }
    Ok(())
}

fn determinism(cases: &[Case]) -> Result<()> {
    println!("\n## Determinism\n");
    println!("| model | 1 thread and 3 threads |\n|---|---|");
    for case in cases {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        let many = rayon::ThreadPoolBuilder::new().num_threads(3).build()?;
        let compute = || Parameterization::compute(&case.model, &published(&case.model), &Progress::silent());
        let (one, three) = (alone.install(compute)?, many.install(compute)?);
        let same = one.grids.iter().map(|grid| &grid.offsets).eq(three.grids.iter().map(|grid| &grid.offsets));
        println!("| {} | {} |", case.name, if same { "the same bytes" } else { "DIFFERENT" });
    }
    Ok(())
}

fn main() -> Result<()> {
    match std::env::args().nth(1).as_deref() {
        None => everything(),
        Some("definitions") => definitions(&cases()?),
        Some("shapes") => shapes::print(&shapes::all()?, ZOOM),
        Some(other) => anyhow::bail!("there is no table {other:?}: give definitions, shapes, or nothing for all"),
    }
}

fn everything() -> Result<()> {
    println!("# Accuracy\n");
    println!(
        "Measured by `make accuracy`. \"Ours\" is the exact lookup, \"paper's\" the packed volume at the same\n\
         resolution with the extrapolated lookup of P-illus 3.4. Closed-form models have {SIDE}³ samples, the\n\
         synthetic survey {SYNTHETIC_SIDE}³. Tests require k, angles and boundaries to meet the aims on folds and\n\
         on the synthetic survey (boundaries of the synthetic survey at 99 %, not at their worst); the remaining\n\
         models are only measured here. Extraction and picks have pages of their own,\n\
         [extraction.md](extraction.md), [picks.md](picks.md), and so has how calm patterns are, [distortion.md](distortion.md).\n\n\
         k is by the published definition in these tables but for the one that compares the definitions.\n"
    );
    let cases = cases()?;
    k_and_angles(&cases)?;
    boundaries(&cases)?;
    definitions(&cases)?;
    shapes::print(&shapes::all()?, ZOOM)?;
    devices(&cases)?;
    determinism(&cases)
}

/// The published definition of k in all layers.
fn published(model: &StructuralModel) -> ParamSettings {
    ParamSettings { definitions: vec![KDefinition::DistanceRatio; model.layer_count()], ..ParamSettings::default() }
}
