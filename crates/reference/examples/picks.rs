//! Prints docs/picks.md: how many picks the horizons of synthetic surveys take, for several noise levels and
//! seeds.
//!
//! `cargo run -p reference --example picks [SIZE] [SEEDS]`

use candidates::{Forest, ForestSettings, GrowSettings, grow_surfaces};
use glam::DVec3;
use interp::assembly::{ClimbSettings, Selection, highest_valid, leaf_at};
use interp::faults::{Evidence, ProposeSettings, propose_faults};
use interp::reassembly::{VoxelSheet, reassemble};
use model::FaultNetwork;
use reference::evaluation::{
    EvaluateSettings, HorizonScore, Parts, PickSettings, TruthIndex, count_picks, evaluate_with,
};
use std::error::Error;
use survey::Progress;
use synth::{SynthSettings, Synthetic};

/// Signal-to-noise ratios.
const SNR: [f64; 3] = [10.0, 3.0, 1.5];
/// Seeds that were not used while the method was developed.
const HELD_OUT: [u64; 2] = [4, 5];
/// Explanations of the tables.
const SHORTFALLS: &str = "
## What falls short, and why

- Picks: the aim is at most two more than there are parts. At SNR 3 Alpha and Bravo reach it on every seed, Delta on
  seeds 1 and 3. On seed 2 the throw of a fault is near a period, and one part of Delta, 28 % of it, lies on a surface
  that is mostly another reflector. On seed 5 Delta itself is such a mixture.
- The unconformity of seed 1 is not reached at SNR 3 with a precision of 0.98: it is 0.973, because of wedges of the
  reflectors that end at the unconformity.
- Charlie thins out below the unconformity. 95 % of it cannot be covered by extrema of its own: at most 0.956, 0.945
  and 0.937 (seeds 1 to 3) lie within a sample of an extremum that is not the unconformity's. On seeds 2 and 3 the
  oracle stops there; the replay goes on, picks the unconformity, and its precision falls. On seed 1 the replay takes
  8 picks.
- Seeds 4 and 5 were not used for tuning; the cause of the leak on seed 5 was examined.
- Proposed faults: a trace needs the rims of assembled horizons on both sides. In noise, one pick on each part covers
  too little of each horizon; the more of a horizon is assembled, the better the proposals. The fault that dies out is
  found by the bends where horizons were tracked across it: roughly, and with the throw that it has there, which is
  less than its greatest. Bends add minor proposals (three or four a survey here); on seed 2 at SNR 10 they cost the
  reverse fault its other horizons (65 m off, 7 m before).
";
/// Parts of fewer traces are not picked for the fault search.
const FEWEST_TRACES: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let size: usize = arguments.next().map_or(Ok(256), |text| text.parse())?;
    let seeds: u64 = arguments.next().map_or(Ok(3), |text| text.parse())?;
    let progress = Progress::silent();
    let (mut extraction, mut faults) = (String::new(), String::new());
    let cases = SNR.into_iter().flat_map(|snr| (1..=seeds).map(move |seed| (snr, seed)));
    let held_out = HELD_OUT.into_iter().map(|seed| (3.0, seed)).filter(|_| seeds > 1);
    for (snr, seed) in cases.chain(held_out) {
        let settings = SynthSettings { size: [size; 3], seed, snr: Some(snr), ..SynthSettings::default() };
        let survey = Synthetic::generate(&settings, &progress)?;
        let surfaces = grow_surfaces(&survey.seismic, &GrowSettings::default(), &progress)?;
        let forest = Forest::build(surfaces, &ForestSettings::default(), &progress)?;
        extraction += &extraction_rows(&survey, &forest, snr, seed, &progress)?;
        faults += &fault_rows(&survey, &forest, snr, seed, &progress)?;
        eprintln!("SNR {snr}, seed {seed}: done");
    }
    println!("# Picks\n");
    println!(
        "Written by `cargo run -p reference --example picks`, from synthetic surveys of {size}³ samples;\n\
         no fault is interpreted.\n"
    );
    println!("## Extraction and picks\n");
    println!(
        "Coverage, precision and purity of the surfaces as in `reference::evaluation`, with one sample of tolerance. A\n\
         pick is one seed and one climb. Picks are counted until 95 % of the horizon is covered and at least 98 %\n\
         of what was picked lies on it. The oracle knows the truth and takes the best node of any level; the\n\
         replay puts its seed into the middle of the largest gap and climbs to the highest valid node. Counts in\n\
         brackets did not reach that aim; they are followed by the coverage and the precision that were reached.\n"
    );
    println!("| SNR | seed | horizon | parts | coverage | precision | purity | worst surface | oracle | replay |");
    println!("|---|---|---|---|---|---|---|---|---|---|");
    print!("{extraction}");
    println!("\n## Proposed faults\n");
    println!(
        "The horizons are assembled by one pick on each part, without faults, and the proposals are compared with\n\
         the true fault surfaces. Distances are in metres; a voxel is 25 m across and 10 m down.\n"
    );
    println!("| SNR | seed | fault | median, m | 95 %, m | throw found / true, m | horizons | proposals in all |");
    println!("|---|---|---|---|---|---|---|---|");
    print!("{faults}");
    print!("{SHORTFALLS}");
    Ok(())
}

fn extraction_rows(
    survey: &Synthetic,
    forest: &Forest,
    snr: f64,
    seed: u64,
    progress: &Progress,
) -> Result<String, Box<dyn Error>> {
    let index = TruthIndex::new(&survey.truth);
    let evaluate = EvaluateSettings::default();
    let found = evaluate_with(&forest.surfaces, &survey.truth, &index, &evaluate);
    let none = FaultNetwork::none();
    let picks = count_picks(forest, &survey.truth, &index, &none, &evaluate, &PickSettings::default(), progress)?;
    let mut rows = String::new();
    for (n, score) in found.horizons.iter().chain([&found.all]).enumerate() {
        let worst = score.worst.map_or("–".to_owned(), |worst| format!("{:.3}", worst.purity()));
        let counts = picks.get(n).map_or(["–".to_owned(), "–".to_owned()], |pick| {
            [pick.oracle, pick.replay].map(|count| match count.reached {
                true => count.picks.to_string(),
                false => format!("({}: {:.2}, {:.2})", count.picks, count.coverage, count.precision),
            })
        });
        let HorizonScore { name, purity, .. } = score;
        rows += &format!(
            "| {snr} | {seed} | {name} | {} | {:.3} | {:.3} | {purity:.3} | {worst} | {} | {} |\n",
            score.parts.len(),
            score.coverage(),
            score.precision(),
            counts[0],
            counts[1]
        );
    }
    Ok(rows)
}

/// Horizons by one pick on each part.
fn picked(survey: &Synthetic, forest: &Forest) -> Vec<Vec<VoxelSheet>> {
    let none = FaultNetwork::none();
    let pick = |h: usize| {
        let (mut selected, mut seeds) = (Selection::default(), Vec::new());
        for place in Parts::of(&survey.truth, h).middles(&survey.truth, h, FEWEST_TRACES) {
            if let Ok(hit) = leaf_at(forest, place.as_vec3(), 2.0) {
                // Without faults the sides of a reverse fault overlap: each pick climbs for itself.
                let settings = ClimbSettings::default();
                let node = highest_valid(forest, hit.leaf, &Selection::default(), &none, &settings).node;
                selected.insert(forest.nodes[node as usize].triangles.clone());
                seeds.push(hit.triangle);
            }
        }
        reassemble(forest, &selected, &seeds, &none).sheets
    };
    (0..survey.truth.horizons.len()).map(pick).collect()
}

fn fault_rows(
    survey: &Synthetic,
    forest: &Forest,
    snr: f64,
    seed: u64,
    progress: &Progress,
) -> Result<String, Box<dyn Error>> {
    let sheets = picked(survey, forest);
    let none = FaultNetwork::none();
    let names = survey.truth.horizons.iter().map(|horizon| horizon.name.as_str());
    let evidence: Vec<Evidence> = names.zip(&sheets).map(|(name, sheets)| Evidence { name, sheets }).collect();
    let settings = ProposeSettings::default();
    let found = propose_faults(&evidence, &survey.geometry, &none, None, &settings, progress)?.proposals;
    let mut rows = String::new();
    for (f, truth) in survey.truth.faults.iter().enumerate() {
        let distances = |mesh: &survey::TriangleMesh| {
            let size = DVec3::from_array(survey.truth.size.map(|count| count as f64 - 1.0));
            let voxels = mesh.vertices.iter().map(|v| survey.geometry.voxel_from_world(*v));
            let inside = voxels.filter(|p| p.cmpge(DVec3::ZERO).all() && p.cmple(size).all());
            let mut all: Vec<f64> = inside.map(|p| survey.truth.fault_side_m(f, p).abs()).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let measured = found.iter().map(|proposal| (proposal, distances(&proposal.mesh)));
        let nearest = measured
            .filter(|(_, all)| !all.is_empty())
            .min_by(|a, b| a.1[a.1.len() / 2].total_cmp(&b.1[b.1.len() / 2]))
            .filter(|(_, all)| all[all.len() / 2] < 150.0);
        rows += &match nearest {
            Some((proposal, all)) => format!(
                "| {snr} | {seed} | {} | {:.0} | {:.0} | {:.0} / {:.0} | {} | {} |\n",
                truth.name,
                all[all.len() / 2],
                all[all.len() * 95 / 100],
                proposal.throw[1],
                truth.throw_m.abs(),
                proposal.horizons.len(),
                found.len()
            ),
            None => format!("| {snr} | {seed} | {} | not found | | | | {} |\n", truth.name, found.len()),
        };
    }
    Ok(rows)
}
