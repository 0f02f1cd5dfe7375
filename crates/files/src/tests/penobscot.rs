//! One real horizon in thirteen files: each reproduces the truth within what its own sampling allows. The
//! table of it is `docs/horizon-formats.md`; with `PETROGLYPH_WRITE_DOCS=1` this test writes it, otherwise it
//! checks that it still holds.
//!
//! Two measures. At the file's own nodes, where these are traces: |file − truth| is at most the rounding of
//! its digits. At all traces: a value interpolated between nodes is a mean of truths around it, so it lies
//! between the lowest and highest truth of the traces within reach of its nodes; the table has the part of
//! traces that do and the worst excess.

use super::*;
use glam::{DVec2, DVec3};
use std::fmt::Write as _;
use survey::geometry::{LineAxis, VerticalAxis, VerticalUnit};

/// Counts of inlines and crosslines.
const LINES: [usize; 2] = [250, 150];

struct Case {
    file: &'static str,
    /// Traces that a value may depend on, inlines and crosslines either way.
    reach: [usize; 2],
    /// Allowed at nodes, ms; None where nodes are no traces.
    at_nodes_ms: Option<f64>,
    /// Allowed beyond the truth around, ms.
    excess_ms: f64,
    why: &'static str,
}

const fn case(
    file: &'static str,
    reach: [usize; 2],
    at_nodes_ms: Option<f64>,
    excess_ms: f64,
    why: &'static str,
) -> Case {
    Case { file, reach, at_nodes_ms, excess_ms, why }
}

const EVERY_OTHER: &str = "every other inline and crossline; 4 decimals";

const CASES: [Case; 13] = [
    case("truth_il_xl_x_y_twt.csv", [0, 0], Some(1e-4), 1e-4, "the truth itself, in f32"),
    case(
        "irap_classic_rotated.gri",
        [1, 1],
        Some(1e-3),
        0.01,
        "origin and steps are f32: nodes a quarter of a metre off",
    ),
    case("irap_classic_rotated.irap", [2, 2], Some(1e-3), 0.01, EVERY_OTHER),
    case("petromod_rotated.pmd", [2, 2], Some(1e-3), 0.01, "every other inline and crossline; f32"),
    case("opendtect_xy_ilxl.dat", [2, 2], Some(1e-3), 0.01, EVERY_OTHER),
    case("opendtect_ilxl_multiline.dat", [2, 2], Some(1e-3), 0.01, EVERY_OTHER),
    case("charisma.dat", [2, 2], Some(1e-3), 0.01, EVERY_OTHER),
    case("earthvision_grid.dat", [2, 2], Some(1e-3), 0.01, EVERY_OTHER),
    case(
        "petrel_points_attributes.txt",
        [2, 2],
        Some(1e-3),
        0.01,
        "every other inline and crossline; read with --z-positive up",
    ),
    case("xyz_points.txt", [2, 6], Some(2e-3), 0.01, "every other inline, every sixth crossline; 3 decimals"),
    case(
        "gocad_tsurf.ts",
        [10, 6],
        None,
        0.01,
        "vertices at every tenth inline and sixth crossline, flat triangles between",
    ),
    case(
        "zmap_plus_unrotated.zmap",
        [4, 3],
        None,
        0.01,
        "resampled to an unrotated grid of 31.6 x 17.9 m by the program that wrote it",
    ),
    case("cps3_unrotated.cps3", [4, 3], None, 0.01, "the same unrotated grid"),
];

struct Truth {
    geometry: SurveyGeometry,
    twt: Vec<f64>,
}

impl Truth {
    fn open(folder: &Path) -> Self {
        let text = std::fs::read_to_string(folder.join("truth_il_xl_x_y_twt.csv")).unwrap();
        let rows: Vec<Vec<f64>> =
            text.lines().skip(1).map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect();
        let at =
            |il: f64, xl: f64| rows.iter().find(|r| r[0] == il && r[1] == xl).map(|r| DVec2::new(r[2], r[3])).unwrap();
        let origin = at(1207.0, 1253.0);
        let geometry = SurveyGeometry {
            inlines: LineAxis { first: 1207, step: 1, count: LINES[0] },
            crosslines: LineAxis { first: 1253, step: 1, count: LINES[1] },
            vertical: VerticalAxis { first: 876.0, interval: 4.0, count: 40, unit: VerticalUnit::Milliseconds },
            origin,
            inline_vector: (at(1456.0, 1253.0) - origin) / 249.0,
            crossline_vector: (at(1207.0, 1402.0) - origin) / 149.0,
            velocity_m_s: 2500.0,
        };
        let mut twt = vec![f64::NAN; LINES[0] * LINES[1]];
        for r in &rows {
            twt[(r[0] as usize - 1207) * LINES[1] + r[1] as usize - 1253] = r[4];
        }
        Self { geometry, twt }
    }

    /// Lowest and highest truth within reach of a trace.
    fn around(&self, x: usize, y: usize, reach: [usize; 2]) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for i in x.saturating_sub(reach[0])..=(x + reach[0]).min(LINES[0] - 1) {
            for j in y.saturating_sub(reach[1])..=(y + reach[1]).min(LINES[1] - 1) {
                let z = self.twt[i * LINES[1] + j];
                range = [range[0].min(z), range[1].max(z)];
            }
        }
        range
    }
}

/// A row of the table.
struct Measured {
    format: Format,
    nodes: usize,
    at_nodes: Option<[f64; 2]>,
    traces: usize,
    between: [f64; 2],
    within: f64,
    excess: f64,
}

fn median_and_largest(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values[values.len() / 2], values[values.len() - 1]]
}

fn measure(case: &Case, folder: &Path, truth: &Truth) -> Measured {
    let z_positive = case.file.starts_with("petrel").then_some(ZPositive::Up);
    let options = ImportOptions { z_positive, ..ImportOptions::default() };
    let read = read_horizons(&folder.join(case.file), &truth.geometry, &options);
    let (horizon, report) = read.unwrap_or_else(|e| panic!("{}: {e}", case.file)).remove(0);
    let sheet = &horizon.sheets[0];
    let nv = sheet.grid.count[1];
    let at_nodes = case.at_nodes_ms.map(|_| {
        let known = sheet.depth.iter().enumerate().filter(|(_, z)| z.is_finite());
        median_and_largest(
            known
                .map(|(n, z)| {
                    let world = sheet.grid.world_at(DVec2::new((n / nv) as f64, (n % nv) as f64));
                    let voxel = truth.geometry.voxel_from_world(world.extend(0.0)).round();
                    (f64::from(*z) - truth.twt[voxel.x as usize * LINES[1] + voxel.y as usize]).abs()
                })
                .collect(),
        )
    });
    let (mut differences, mut within, mut excess) = (Vec::new(), 0usize, 0.0f64);
    for x in 0..LINES[0] {
        for y in 0..LINES[1] {
            let world = truth.geometry.world_from_voxel(DVec3::new(x as f64, y as f64, 0.0)).truncate();
            let node = sheet.grid.node_at(world);
            // Coordinates with two decimals put a node a little off its trace.
            let node = if (node - node.round()).abs().max_element() < 0.03 { node.round() } else { node };
            let z = f64::from(sheet.depth_at_node(node));
            if !z.is_finite() {
                continue;
            }
            differences.push((z - truth.twt[x * LINES[1] + y]).abs());
            let [low, high] = truth.around(x, y, case.reach);
            let off = (low - z).max(z - high).max(0.0);
            excess = excess.max(off);
            within += usize::from(off <= case.excess_ms);
        }
    }
    Measured {
        format: report.format.value,
        nodes: sheet.node_count(),
        at_nodes,
        traces: differences.len(),
        within: within as f64 / differences.len() as f64,
        between: median_and_largest(differences),
        excess,
    }
}

#[test]
fn every_file_of_horizon_b_reproduces_the_truth_and_the_table_says_so() {
    let Some(data) = testdata::folder() else { return };
    let folder = data.join("interpretation/penobscot_horizon_B");
    let truth = Truth::open(&folder);
    let mut text = String::from(
        "# One horizon in thirteen files\n\n\
        Horizon B of the Penobscot survey (offshore Nova Scotia; see [ATTRIBUTION.md](ATTRIBUTION.md)), 250 inlines\n\
        by 150 crosslines, picked at every trace, in thirteen files of eleven formats. Each file is read with the\n\
        survey's geometry and compared with the picks.\n\n\
        *At nodes*: |file - picks| where a node of the file lies on a trace. *All traces*: the same at every trace\n\
        that the surface covers; between nodes the roughness of the picks decides, since they jump at faults.\n\
        *Within reach*: the share of all traces at which the value lies between the lowest and the highest of the\n\
        picks that it can depend on, as interpolation may; and the worst excess.\n\n\
        | file | format | nodes | at nodes: median, max (ms) | allowed (ms) | all traces: median, max (ms) \
        | within reach, worst excess (ms) | why |\n\
        |---|---|---|---|---|---|---|---|\n",
    );
    for case in &CASES {
        let found = measure(case, &folder, &truth);
        let nodes = found.at_nodes.map_or("-".into(), |[m, l]| format!("{m:.4}, {l:.4}"));
        let allowed = case.at_nodes_ms.map_or("-".into(), |a| format!("{a}"));
        writeln!(
            text,
            "| `{}` | {} | {} | {nodes} | {allowed} | {:.3}, {:.2} | {:.2} % of {} (± {} x {}), {:.4} | {} |",
            case.file,
            found.format,
            found.nodes,
            found.between[0],
            found.between[1],
            100.0 * found.within,
            found.traces,
            case.reach[0],
            case.reach[1],
            found.excess,
            case.why
        )
        .unwrap();
        if let (Some(allowed), Some([_, largest])) = (case.at_nodes_ms, found.at_nodes) {
            assert!(largest <= allowed, "{}: {largest} at a node", case.file);
        }
        assert!(found.excess <= case.excess_ms.max(case.at_nodes_ms.unwrap_or(0.0)), "{}: {}", case.file, found.excess);
        assert!(found.traces >= 34_000, "{}: {} traces", case.file, found.traces);
    }
    text += "\nWritten by `PETROGLYPH_WRITE_DOCS=1 cargo test -p files horizon_b`; \
             the test fails when a figure changes.\n";
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/horizon-formats.md");
    if std::env::var("PETROGLYPH_WRITE_DOCS").is_ok() {
        std::fs::write(&table, &text).unwrap();
    }
    let written = std::fs::read_to_string(&table).unwrap_or_default();
    assert!(written == text, "docs/horizon-formats.md is not up to date; the table is now\n{text}");
}
