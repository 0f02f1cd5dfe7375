//! Closed forms beyond faulted height fields, definition by definition: a recumbent fold, bodies that cut folded beds, a
//! thrust that repeats them, a fault that ends inside the block.

use crate::{DEFINITIONS, is_measured_from};
use anyhow::Result;
use glam::{DVec2, DVec3, Vec3};
use model::section::SectionPlane;
use model::{ModelSettings, StructuralModel};
use param::accuracy::Spread;
use param::{KDefinition, ParamSettings, Parameterization, Region};
use rayon::prelude::*;
use survey::horizon::{NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon};
use survey::{Fault, Horizon, Progress, Stratigraphy, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use synth::elliptic::EllipticFault;
use synth::shapes::{Diapir, Laccolith, RecumbentFold};

/// Metres of a voxel along each axis.
const VOXEL_M: DVec3 = DVec3::new(25.0, 25.0, 10.0);
/// Places that are looked for on each horizon and, ten times as many, in the volume.
const PLACES: usize = 4000;

/// A form with what it really is.
pub(crate) struct Form {
    name: &'static str,
    model: StructuralModel,
    /// The layer at a place, voxels.
    layer_at: Box<dyn Fn(DVec3) -> u16 + Sync>,
    /// Places on the true horizons, voxels.
    places: Vec<(usize, DVec3)>,
}

/// What bounds rock: horizons in order of age, and faults.
struct Bounds {
    horizons: Vec<(Horizon, Contact)>,
    faults: Vec<Fault>,
}

impl Form {
    fn new(
        name: &'static str,
        bounds: Bounds,
        layer_at: impl Fn(DVec3) -> u16 + Sync + 'static,
        places: Vec<(usize, DVec3)>,
    ) -> Result<Self> {
        let named =
            |(h, contact): &(Horizon, Contact)| StratigraphicHorizon { name: h.name.clone(), contact: *contact };
        let stratigraphy =
            Stratigraphy { horizons: bounds.horizons.iter().map(named).collect(), layer_names: Vec::new() };
        let horizons: Vec<Horizon> = bounds.horizons.into_iter().map(|(horizon, _)| horizon).collect();
        let (settings, quiet) = (ModelSettings::default(), Progress::silent());
        let model = StructuralModel::build(&geometry(), &stratigraphy, &horizons, &bounds.faults, &settings, &quiet)?;
        Ok(Self { name, model, layer_at: Box::new(layer_at), places })
    }

    /// |k − {0, 1}| on the true horizons, voxels of depth.
    fn k_errors(&self, param: &Parameterization, definition: KDefinition) -> Spread {
        let horizons = self.model.layer_count() - 1;
        let errors = self.places.par_iter().flat_map_iter(|&(horizon, place)| {
            let p = place.as_vec3();
            let block = self.model.block_at(p);
            let above = (horizons - horizon) as u16;
            let of = |q: Vec3| self.model.region_at(q);
            let between = Vec3::AXES.into_iter().any(|axis| {
                let mut sides = [of(p - 0.5 * axis), of(p + 0.5 * axis)];
                sides.sort_by_key(|region| region.layer);
                sides == [Region { layer: above - 1, block }, Region { layer: above, block }]
            });
            let [from_bottom, from_top] = is_measured_from(definition, horizon, horizons);
            let sides = [(from_bottom, above, 0.0), (from_top, above - 1, 1.0)];
            sides.into_iter().filter(move |side| between && side.0).map(move |(_, layer, k)| {
                let (found, jacobian) = param.lookup_in(&self.model, p, Region { layer, block });
                let rate = (Vec3::from_array(jacobian[2]).as_dvec3() / VOXEL_M).length();
                ((f64::from(found.k - k)).abs() / rate / VOXEL_M.z) as f32
            })
        });
        Spread::of(errors.collect())
    }

    /// Angles of ∇k to ∇i and to ∇j, degrees off 90.
    fn angles(&self, param: &Parameterization) -> [Spread; 2] {
        let last = self.model.size().map(|n| n as f64 - 3.0);
        let bodies: Vec<u16> = self.bodies().collect();
        let measured: Vec<[f32; 2]> = (0..10 * PLACES)
            .into_par_iter()
            .filter_map(|n| {
                let place = |axis: usize, step: f64| 1.0 + (n as f64 * step).fract() * last[axis];
                let p = DVec3::new(place(0, 0.414_214), place(1, 0.618_034), place(2, 0.754_878)).as_vec3();
                let region = self.model.region_at(p);
                let around = Vec3::AXES.into_iter().flat_map(|axis| [p + 0.5 * axis, p - 0.5 * axis]);
                if bodies.contains(&region.layer) || around.into_iter().any(|q| self.model.region_at(q) != region) {
                    return None;
                }
                let [i, j, k] = self.gradients(param, p, region);
                let off = |a: DVec3| ((a.angle_between(k).to_degrees() - 90.0).abs()) as f32;
                Some([off(i), off(j)])
            })
            .collect();
        [0, 1].map(|n: usize| Spread::of(measured.iter().map(|pair| pair[n]).collect()))
    }

    /// Layers of bodies: their rock is not layered.
    fn bodies(&self) -> impl Iterator<Item = u16> {
        let horizons = self.model.layer_count() - 1;
        (0..horizons).filter(|h| self.model.is_body(*h)).map(move |h| (horizons - 1 - h) as u16)
    }

    /// The metric gradients of i, j, k by differences over a voxel.
    fn gradients(&self, param: &Parameterization, p: Vec3, region: Region) -> [DVec3; 3] {
        let flat = |p: Vec3| {
            let (flat, _) = param.lookup_in(&self.model, p, region);
            DVec3::new(f64::from(flat.i), f64::from(flat.j), f64::from(flat.k))
        };
        let along = Vec3::AXES.map(|axis| flat(p + 0.5 * axis) - flat(p - 0.5 * axis));
        [0, 1, 2].map(|n: usize| DVec3::new(along[0][n], along[1][n], along[2][n]) / VOXEL_M)
    }
}

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular([61, 51, 81], VOXEL_M.x, VOXEL_M.z, VerticalUnit::Metres)
}

/// Pairs of numbers that fill a rectangle evenly.
fn spread(low: DVec2, high: DVec2) -> impl Iterator<Item = DVec2> {
    let unit = |n: usize| DVec2::new((n as f64 * 0.618_034).fract(), (n as f64 * 0.754_878).fract());
    (0..PLACES).map(move |n| low + (high - low) * unit(n))
}

fn recumbent_fold() -> Result<Form> {
    const AGES: [f64; 3] = [-250.0, -50.0, 150.0];
    let geometry = geometry();
    let fold = RecumbentFold::fitting(&geometry);
    let range = [DVec2::new(-150.0, -300.0), DVec2::new(1400.0, 1100.0)];
    let bed = |(n, age): (usize, f64)| {
        (Horizon::of_surface(format!("bed {n}"), fold.mesh(&geometry, age, range, [30, 280])), Contact::Conformable)
    };
    let on = |(h, age): (usize, f64)| {
        let places = spread(DVec2::new(30.0, 30.0), DVec2::new(1220.0, 770.0));
        let places = places.map(move |at| DVec3::new(fold.x_of(age, at.y), at.x, at.y) / VOXEL_M);
        places.filter(|p| (1.0..59.0).contains(&p.x)).map(move |p| (h, p))
    };
    let layer = move |p: DVec3| AGES.iter().filter(|&&age| fold.age(p * VOXEL_M) < age).count() as u16;
    let bounds = Bounds { horizons: AGES.into_iter().enumerate().map(bed).collect(), faults: Vec::new() };
    Form::new(
        "recumbent fold, three beds of triangles",
        bounds,
        layer,
        AGES.into_iter().enumerate().flat_map(on).collect(),
    )
}

/// Beds of a closed form that a body cuts.
fn cut_by(name: &'static str, form: ClosedForm, mesh: survey::TriangleMesh, holds: fn(DVec3) -> bool) -> Result<Form> {
    let horizons = form.horizons.iter().cloned().map(|horizon| (horizon, Contact::Conformable));
    let body = (Horizon::of_surface("body", mesh), Contact::Intrusive);
    let places = sheets(&form).into_iter().filter(|(_, p)| !holds(*p * VOXEL_M)).collect();
    let bounds = Bounds { horizons: horizons.chain([body]).collect(), faults: Vec::new() };
    Form::new(name, bounds, move |p| if holds(p * VOXEL_M) { 0 } else { 1 + form.layer_at(p) }, places)
}

/// Places on the horizons of a closed form, each in the block that it lies in.
fn sheets(form: &ClosedForm) -> Vec<(usize, DVec3)> {
    let blocks: Vec<u16> = if form.faults.is_empty() { vec![0] } else { vec![0, 1] };
    let mut places = Vec::new();
    for h in 0..form.horizons.len() {
        for at in spread(DVec2::ONE, DVec2::new(59.0, 49.0)) {
            for &block in &blocks {
                let p = at.extend(form.sheet_z(h, block, at.x, at.y));
                if form.block_at(p) == block && (1.0..79.0).contains(&p.z) {
                    places.push((h, p));
                }
            }
        }
    }
    places
}

fn diapir() -> Result<Form> {
    let body = || Diapir::fitting(&geometry());
    let beds = ClosedForm::folded(&geometry(), &[24.0, 40.0, 58.0], 20.0, 0.2);
    cut_by("folds cut by a mushroom-shaped diapir", beds, body().mesh(&geometry(), 160), |p| {
        Diapir::fitting(&geometry()).holds(p)
    })
}

const LACCOLITH: Laccolith = Laccolith { axis: DVec2::new(740.0, 610.0), base_z: 560.0, radius: 520.0, height: 180.0 };

fn laccolith() -> Result<Form> {
    let beds = ClosedForm::folded(&geometry(), &[24.0, 40.0, 58.0], 20.0, 0.2);
    cut_by("folds cut by a laccolith", beds, LACCOLITH.mesh(&geometry(), 120), |p| LACCOLITH.holds(p))
}

fn thrust() -> Result<Form> {
    // A reverse fault of 25° with a throw of 11 samples.
    let form = ClosedForm::folded(&geometry(), &[34.0, 46.0], 15.0, 0.1).with_fault(25.0, -11.0);
    let places = sheets(&form);
    let horizons = form.horizons.iter().cloned().map(|horizon| (horizon, Contact::Conformable)).collect();
    let bounds = Bounds { horizons, faults: form.faults.clone() };
    Form::new("folds that a thrust of 25° repeats", bounds, move |p| form.layer_at(p), places)
}

fn elliptic_fault() -> Result<Form> {
    const LEVELS: [f64; 3] = [22.0, 36.0, 52.0];
    const FAULT: EllipticFault = EllipticFault {
        centre: DVec3::new(30.0, 25.0, 40.0),
        axes: DVec2::new(18.0, 24.0),
        lean: 0.24,
        throw: 8.0,
        width: 18.0,
    };
    let grid = NodeGrid::of_survey(&geometry());
    // On either side the horizon ends where it meets the fault.
    let z_at = |level: f64, x: f64, y: f64| {
        let sides = [true, false].map(|is_hanging| (is_hanging, FAULT.height(level, is_hanging, x, y)));
        sides.into_iter().find(|&(is_hanging, z)| (x > FAULT.x_at(z)) == is_hanging).map(|(_, z)| z)
    };
    let horizon = |(h, level): (usize, f64)| {
        let depth = (0..grid.count[0] * grid.count[1]).map(|n| {
            let [x, y] = [n / grid.count[1], n % grid.count[1]].map(|n| n as f64);
            z_at(level, x, y).map_or(f32::NAN, |z| (VOXEL_M.z * z) as f32)
        });
        (Horizon::new(format!("H{h}"), vec![Sheet::new(grid, depth.collect(), Quality::Picked)]), Contact::Conformable)
    };
    let on = |(h, level): (usize, f64)| {
        spread(DVec2::ONE, DVec2::new(59.0, 49.0))
            .filter_map(move |at| z_at(level, at.x, at.y).map(|z| (h, at.extend(z))))
    };
    let places = LEVELS.into_iter().enumerate().flat_map(on).collect();
    let layer = move |p: DVec3| {
        let is_hanging = p.x > FAULT.x_at(p.z);
        LEVELS.iter().filter(|&&level| p.z < FAULT.height(level, is_hanging, p.x, p.y)).count() as u16
    };
    let bounds = Bounds {
        horizons: LEVELS.into_iter().enumerate().map(horizon).collect(),
        faults: vec![FAULT.drawn(&geometry(), &[15.0, 25.0, 35.0], 5)],
    };
    Form::new("an elliptic fault drawn by three sticks", bounds, layer, places)
}

/// Every form, with its model.
pub(crate) fn all() -> Result<Vec<Form>> {
    Ok(vec![recumbent_fold()?, diapir()?, laccolith()?, thrust()?, elliptic_fault()?])
}

/// Prints the rows of every form.
pub(crate) fn print(forms: &[Form], zoom: f64) -> Result<()> {
    println!("\n## Folds of any shape, bodies, a thrust, a fault with a tip\n");
    println!(
        "Closed forms on 61 × 51 × 81 voxels of 25 × 25 × 10 m, as above: 95 % of the errors of k on the true horizons, voxels\n\
         of depth / of the angle between k and i / between k and j, degrees. Errors of k are measured across the beds, which\n\
         may be upright. Rock of bodies is not layered. No place is left out of the angles.\n"
    );
    let names: Vec<&str> = DEFINITIONS.iter().map(|(name, _)| *name).collect();
    println!("| form | {} |\n|---|{}", names.join(" | "), "---|".repeat(names.len()));
    for form in forms {
        let mut cells = Vec::new();
        for (_, definition) in DEFINITIONS {
            let definitions = vec![definition; form.model.layer_count()];
            let settings = ParamSettings { definitions, ..ParamSettings::default() };
            let param = Parameterization::compute(&form.model, &settings, &Progress::silent())?;
            let k = form.k_errors(&param, definition);
            let [to_i, to_j] = form.angles(&param);
            cells.push(format!("{:.3} / {:.2} / {:.2}", k.p95, to_i.p95, to_j.p95));
        }
        println!("| {} | {} |", form.name, cells.join(" | "));
    }
    println!("\nBoundaries of layers in an image of {zoom} pixels a voxel, as above; voxels.\n");
    println!("| form | median | 99 % | worst |\n|---|---|---|---|");
    for form in forms {
        let high = DVec3::from_array(form.model.size().map(|n| n as f64 - 1.0));
        let planes = [
            SectionPlane::crossline(0.37 * high.y, DVec3::ZERO, high),
            SectionPlane::inline(0.53 * high.x, DVec3::ZERO, high),
            SectionPlane::slice(0.55 * high.z, DVec3::ZERO, high),
        ];
        let found: Vec<_> = planes
            .iter()
            .filter_map(|plane| {
                let ours = |p: DVec3| u32::from(form.model.region_at(p.as_vec3()).layer);
                model::accuracy::boundaries(plane, zoom, ours, |p| u32::from((form.layer_at)(p)))
            })
            .collect();
        let worst = |of: fn(&model::accuracy::BoundaryAccuracy) -> f64| found.iter().map(of).fold(0.0, f64::max);
        let [median, share, most] = [worst(|b| b.median), worst(|b| b.percentile_99), worst(|b| b.worst)];
        println!("| {} | {median:.3} | {share:.3} | {most:.3} |", form.name);
    }
    Ok(())
}
