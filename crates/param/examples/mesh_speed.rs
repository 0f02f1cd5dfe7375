//! Times a model and its parameterization with one horizon of three as a mesh of triangles beside the same one as a height
//! field: `mesh_speed [N …]`, N³ voxels, default 128. The mesh has two triangles for each 1/224 of the side: 100 352.

use glam::{DVec2, DVec3};
use model::{ModelSettings, StructuralModel};
use param::{ParamSettings, Parameterization};
use std::f64::consts::TAU;
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};
use survey::{Progress, SurveyGeometry, TriangleMesh, VerticalUnit};

/// Cells of the mesh along each side.
const CELLS: u32 = 224;

/// Depth of a horizon in m on a survey of `side` m, dips up to 25°.
fn depth(horizon: usize, at: DVec2, side: f64) -> f64 {
    let share = at / side;
    let fold = 0.05 * (TAU * (1.4 * share.x + 0.3 * share.y)).sin() + 0.015 * (TAU * (2.0 * share.y)).cos();
    side * (0.25 + 0.2 * horizon as f64 + fold)
}

fn as_field(geometry: &SurveyGeometry, horizon: usize, side: f64) -> Horizon {
    let grid = NodeGrid::of_survey(geometry);
    let [nu, nv] = grid.count;
    let at = |n: usize| DVec2::new((n / nv) as f64, (n % nv) as f64) * (side / (nu - 1) as f64);
    let depths = (0..nu * nv).map(|n| depth(horizon, at(n), side) as f32).collect();
    Horizon::new(format!("H{horizon}"), vec![Sheet::new(grid, depths, Quality::Picked)])
}

fn as_mesh(geometry: &SurveyGeometry, horizon: usize, side: f64) -> Horizon {
    let count = CELLS + 1;
    let vertex = |n: u32| {
        let at = DVec2::new(f64::from(n / count), f64::from(n % count)) * (side / f64::from(CELLS));
        geometry.origin.extend(0.0) + DVec3::new(at.x, at.y, depth(horizon, at, side))
    };
    let cell = |n: u32| {
        let a = n / CELLS * count + n % CELLS;
        [[a, a + count, a + count + 1], [a, a + count + 1, a + 1]]
    };
    let mesh = TriangleMesh {
        vertices: (0..count * count).map(vertex).collect(),
        triangles: (0..CELLS * CELLS).flat_map(cell).collect(),
    };
    Horizon::of_surface(format!("H{horizon}"), mesh)
}

/// Processor seconds of this process so far, which other processes do not affect. Linux; 0 elsewhere.
fn processor_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    ticks.filter_map(|ticks| ticks.parse::<f64>().ok()).sum::<f64>() / 100.0
}

/// Seconds for the model and for its parameterization, and bytes a voxel that both keep.
fn measure(geometry: &SurveyGeometry, horizons: &[Horizon]) -> [f64; 3] {
    let named = |h: &Horizon| StratigraphicHorizon { name: h.name.clone(), contact: Contact::Conformable };
    let stratigraphy = Stratigraphy { horizons: horizons.iter().map(named).collect(), layer_names: Vec::new() };
    let quiet = Progress::silent();
    let start = processor_s();
    let model =
        StructuralModel::build(geometry, &stratigraphy, horizons, &[], &ModelSettings::default(), &quiet).unwrap();
    let built = processor_s();
    let param = Parameterization::compute(&model, &ParamSettings::default(), &quiet).unwrap();
    let fields = (0..horizons.len()).filter_map(|h| model.level(h, 0)).map(|level| level.field.values.len() * 4);
    let voxels = geometry.size().iter().product::<usize>() as f64;
    let bytes = (param.bytes() + fields.sum::<usize>()) as f64 / voxels;
    [built - start, processor_s() - built, bytes]
}

fn main() {
    let sizes: Vec<usize> = std::env::args().skip(1).filter_map(|size| size.parse().ok()).collect();
    for n in if sizes.is_empty() { vec![128] } else { sizes } {
        let geometry = SurveyGeometry::regular([n; 3], 10.0, 10.0, VerticalUnit::Metres);
        let side = 10.0 * (n - 1) as f64;
        let fields: Vec<Horizon> = (0..3).map(|h| as_field(&geometry, h, side)).collect();
        let mixed = vec![fields[0].clone(), as_mesh(&geometry, 1, side), fields[2].clone()];
        let [plain, meshed] = [&fields, &mixed].map(|horizons| measure(&geometry, horizons));
        for (name, [model_s, param_s, bytes]) in [("height fields", plain), ("one of them a mesh", meshed)] {
            println!(
                "{n:4}³ {name:18} model {model_s:7.2} s, parameterization {param_s:7.2} s of processor time, {bytes:.1} \
                 bytes a voxel"
            );
        }
        let total = |[model_s, param_s, _]: [f64; 3]| model_s + param_s;
        println!("{n:4}³ together {:.2} times as long", total(meshed) / total(plain));
    }
}
