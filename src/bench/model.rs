//! The closed-form model that is measured: folds of two wavelengths in four layers, a normal fault across and one
//! along.
//!
//! In metres, with the cube 5000 m wide and 2000 m deep: horizon h is at `d_h + A·sin(2πX/λ₁)·cos(2πY/λ₂) + Σ throw_f`
//! over the faults in whose hanging wall the point lies. A fault is the plane `s = s₀ + (depth − 1000)/tan 60°` with s
//! = X or Y.

use glam::{DVec2, DVec3};
use model::{ModelSettings, StructuralModel};
use project::error::ProjectError;
use project::pictures::load::{self, Rock};
use std::f64::consts::TAU;
use survey::{
    Contact, Fault, Horizon, NodeGrid, Progress, Quality, Sheet, StratigraphicHorizon, Stratigraphy, SurveyGeometry,
    TriangleMesh, VerticalUnit,
};
use ttf::{TextureLibrary, TransferFunctions, TtfTables};

const WIDTH_M: f64 = 5000.0;
const DEPTH_M: f64 = 2000.0;
/// Mean depths of the horizons, youngest first.
const HORIZONS_M: [f64; 3] = [550.0, 950.0, 1400.0];
const AMPLITUDE_M: f64 = 140.0;
const WAVELENGTHS_M: [f64; 2] = [3100.0, 4300.0];

/// A fault across X (axis 0) or Y (axis 1).
struct Plane {
    axis: usize,
    at_m: f64,
    throw_m: f64,
}

const FAULTS: [Plane; 2] =
    [Plane { axis: 0, at_m: 2100.0, throw_m: 120.0 }, Plane { axis: 1, at_m: 3200.0, throw_m: 70.0 }];
/// Horizontal metres a metre of depth: dips of 60 degrees.
const HEAVE: f64 = 0.577;

impl Plane {
    fn position_m(&self, depth_m: f64) -> f64 {
        self.at_m + (depth_m - DEPTH_M / 2.0) * HEAVE
    }

    fn hangs(&self, place: DVec2, depth_m: f64) -> bool {
        place[self.axis] > self.position_m(depth_m)
    }
}

/// A cube of `side` voxels along each axis.
pub(super) fn geometry(side: usize) -> SurveyGeometry {
    let steps = side as f64 - 1.0;
    SurveyGeometry::regular([side; 3], WIDTH_M / steps, DEPTH_M / steps, VerticalUnit::Metres)
}

/// Depth of a horizon where the fault blocks agree with it; NaN in a fault's gap.
fn depth_m(mean_m: f64, place: DVec2) -> f64 {
    let fold = AMPLITUDE_M * (TAU * place.x / WAVELENGTHS_M[0]).sin() * (TAU * place.y / WAVELENGTHS_M[1]).cos();
    for hanging in 0..1 << FAULTS.len() {
        let hangs = |index: usize| hanging >> index & 1 == 1;
        let throw: f64 = FAULTS.iter().enumerate().map(|(index, f)| if hangs(index) { f.throw_m } else { 0.0 }).sum();
        let depth = mean_m + fold + throw;
        if FAULTS.iter().enumerate().all(|(index, fault)| fault.hangs(place, depth) == hangs(index)) {
            return depth;
        }
    }
    f64::NAN
}

fn horizon(geometry: &SurveyGeometry, index: usize) -> Horizon {
    let grid = NodeGrid::of_survey(geometry);
    let nodes = (0..grid.count[0] * grid.count[1]).map(|n| {
        let node = DVec2::new((n / grid.count[1]) as f64, (n % grid.count[1]) as f64);
        depth_m(HORIZONS_M[index], grid.world_at(node)) as f32
    });
    let sheet = Sheet::new(grid, nodes.collect(), Quality::Picked);
    Horizon::new(format!("H{index}"), vec![sheet])
}

fn fault(index: usize) -> Fault {
    let plane = &FAULTS[index];
    let vertex = |along: f64, depth: f64| {
        let mut place = DVec2::splat(along);
        place[plane.axis] = plane.position_m(depth);
        DVec3::new(place.x, place.y, depth)
    };
    const CELLS: usize = 16;
    let mut mesh = TriangleMesh::default();
    for row in 0..=CELLS {
        for column in 0..=CELLS {
            // A little beyond the outer boundary, so that the fault certainly reaches it.
            let share = |n: usize| -0.05 + 1.1 * n as f64 / CELLS as f64;
            mesh.vertices.push(vertex(share(row) * WIDTH_M, share(column) * DEPTH_M));
        }
    }
    let node = |row: usize, column: usize| (row * (CELLS + 1) + column) as u32;
    for row in 0..CELLS {
        for column in 0..CELLS {
            let (a, b) = (node(row, column), node(row + 1, column));
            let (c, d) = (node(row, column + 1), node(row + 1, column + 1));
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    Fault::new(format!("F{index}"), mesh)
}

/// Builds the structural model.
pub(super) fn build(geometry: &SurveyGeometry, progress: &Progress) -> Result<StructuralModel, ProjectError> {
    let horizons: Vec<Horizon> = (0..HORIZONS_M.len()).map(|index| horizon(geometry, index)).collect();
    let faults: Vec<Fault> = (0..FAULTS.len()).map(fault).collect();
    let place = |horizon: &Horizon| StratigraphicHorizon { name: horizon.name.clone(), contact: Contact::Conformable };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(place).collect(), layer_names: Vec::new() };
    let settings = ModelSettings::default();
    Ok(StructuralModel::build(geometry, &stratigraphy, &horizons, &faults, &settings, progress)?)
}

/// Default styles.
pub(super) fn tables(geometry: &SurveyGeometry, rock: &Rock) -> Result<TtfTables, ProjectError> {
    let names = rock.model.stratigraphy().layer_names_bottom_up();
    let block = load::block_extent(geometry, rock, names);
    Ok(TtfTables::compile(&TransferFunctions::default(), &block, &TextureLibrary::builtin()?)?)
}
