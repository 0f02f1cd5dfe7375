//! Measures the quality of extraction for `docs/extraction.md`: `cargo run -p petroglyph-interp --example extraction [SIDE]`.
//!
//! Synthetic surveys of SIDE³ (256) at three signal-to-noise ratios with three seeds; the paper's growing, ours, and ours with its
//! steps left out. Beside the figures of `interp::evaluate`: coverage as far as the extrema themselves allow it.

use interp::evaluate::{EvaluateSettings, Evaluation, TruthIndex, evaluate_with};
use interp::extrema::find_extrema;
use interp::{Extremum, GrowSettings, Method, Surfaces, grow_surfaces};
use std::error::Error;
use std::time::Instant;
use survey::Progress;
use survey::synth::{SynthSettings, Synthetic};

/// Signal-to-noise ratios.
const RATIOS: [f64; 3] = [10.0, 3.0, 1.5];
/// Seeds.
const SEEDS: [u64; 3] = [1, 2, 3];

/// What the tables do not say themselves.
const NOTES: &str = "
## What falls short, and why

- Coverage of a horizon below the unconformity is bounded by the extrema: where it thins out against the unconformity the two
  interfere, and no extremum lies within a sample of it. Ours reaches that bound within 0.01 (0.03 where cuts lie close together).
- Precision falls short where a surface goes on along a side lobe: below the unconformity the lobe of its wavelet joins the
  reflectors that end there without a visible break. Such vertices lie on no reflector, so they cost precision and not purity.
- Where the throw of a fault is a whole period within a sample over 80 traces of strike and 50 samples of depth (normal fault,
  seed 1), all reflectors of that part match wrong ones. Only the planes tell: every surface across it was impure without them.
- The price of the cuts are pieces: surfaces within one fault block that belong together and are not joined. Merging them by the evidence over
  their whole common boundary is not done yet.
- Without fault planes, links alone join nearly everything; a horizon of which no surface is its own shows as 0.
";

/// A survey with its truth.
struct Case {
    survey: Synthetic,
    index: TruthIndex,
}

impl Case {
    fn new(side: usize, snr: f64, seed: u64) -> Result<Self, Box<dyn Error>> {
        let settings = SynthSettings { size: [side; 3], seed, snr: Some(snr), ..SynthSettings::default() };
        let survey = Synthetic::generate(&settings, &Progress::silent())?;
        let index = TruthIndex::new(&survey.truth);
        Ok(Self { survey, index })
    }

    fn grown(&self, settings: &GrowSettings) -> Result<(Surfaces, Evaluation, f64), Box<dyn Error>> {
        let start = Instant::now();
        let surfaces = grow_surfaces(&self.survey.seismic, settings, &Progress::silent())?;
        let seconds = start.elapsed().as_secs_f64();
        let evaluation = evaluate_with(&surfaces, &self.survey.truth, &self.index, &EvaluateSettings::default());
        Ok((surfaces, evaluation, seconds))
    }

    /// Share of the nodes of each horizon that any extremum lies within a sample of.
    fn bounds(&self) -> Result<Vec<f64>, Box<dyn Error>> {
        let extrema = find_extrema(&self.survey.seismic, &[Extremum::Peak, Extremum::Trough], 16, &Progress::silent())?;
        let mut seen = vec![false; self.index.events().len()];
        let [nx, ny, _] = self.survey.truth.size;
        for found in &extrema {
            for (x, y) in (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y))) {
                for v in found.on_trace(x, y) {
                    seen[self.index.range_near(x, y, found.z[v], 1.0)].fill(true);
                }
            }
        }
        let truth = &self.survey.truth;
        Ok((0..truth.horizons.len())
            .map(|h| {
                let reflector = self.index.reflector_index(truth.reflector_of(h));
                let of_it = |n: &usize| Some(usize::from(self.index.events()[*n].reflector)) == reflector;
                let nodes: Vec<usize> = (0..seen.len()).filter(of_it).collect();
                nodes.iter().filter(|&&n| seen[n]).count() as f64 / nodes.len().max(1) as f64
            })
            .collect())
    }
}

/// Precision and purity over the surfaces that lie on reflectors with at least half of their vertices. (A surface along a side
/// lobe that touches a reflector here and there is nobody's.)
fn quality(evaluation: &Evaluation, reflector: Option<usize>) -> [f64; 2] {
    let own = || {
        let all = evaluation.surfaces.iter().filter(|s| 2 * s.on_any >= s.vertices && s.majority.is_some());
        all.filter(|s| reflector.is_none() || s.majority == reflector)
    };
    let vertices = own().map(|s| s.vertices).sum::<usize>().max(1) as f64;
    let right = own().map(|s| s.on_majority).sum::<usize>() as f64;
    let pure = own().map(|s| s.purity() * s.vertices as f64).fold(0.0, |sum, part| sum + part);
    [right / vertices, pure / vertices]
}

fn main() -> Result<(), Box<dyn Error>> {
    let side = std::env::args().nth(1).map_or(Ok(256), |side| side.parse())?;
    println!(
        "# Extraction\n\nWritten by `make extraction`. Synthetic surveys of {side}³; tolerance one sample. For each horizon coverage /"
    );
    println!(
        "precision / purity per surface (vertex-weighted), over the surfaces that have at least half of their vertices on reflectors.\n"
    );
    println!(
        "Coverage in brackets is what the extrema allow: nodes with any extremum within a sample. Below an unconformity a bed"
    );
    println!("that thins out interferes with it, and no extremum lies within a sample of it.\n\n## Ours\n");
    println!(
        "| SNR | seed | Alpha | Bravo | Unconformity | Charlie | Delta | all reflectors | surfaces ≥ 500 triangles | s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for snr in RATIOS {
        for seed in SEEDS {
            let case = Case::new(side, snr, seed)?;
            row(&case, &format!("{snr} | {seed}"), &GrowSettings::default())?;
        }
    }
    println!("\n## What each step gains\n\nSNR 3, seed 1.\n");
    println!("| | Alpha | Bravo | Unconformity | Charlie | Delta | all reflectors | surfaces ≥ 500 triangles | s |");
    println!("|---|---|---|---|---|---|---|---|---|");
    let case = Case::new(side, 3.0, 1)?;
    let ours = GrowSettings::default();
    let steps = [
        ("the paper's growing", GrowSettings { method: Method::Paper, ..ours.clone() }),
        ("links guided by dip", GrowSettings { core_width: 4, fault_evidence: f32::INFINITY, ..ours.clone() }),
        ("and cores of 10 traces", GrowSettings { fault_evidence: f32::INFINITY, ..ours.clone() }),
        ("or fault planes", GrowSettings { core_width: 4, ..ours.clone() }),
        ("both: ours", ours),
    ];
    for (name, settings) in steps {
        row(&case, name, &settings)?;
    }
    print!("{NOTES}");
    Ok(())
}

/// One line of a table.
fn row(case: &Case, name: &str, settings: &GrowSettings) -> Result<(), Box<dyn Error>> {
    let (surfaces, evaluation, seconds) = case.grown(settings)?;
    let bounds = case.bounds()?;
    print!("| {name} ");
    for (h, score) in evaluation.horizons.iter().enumerate() {
        let reflector = case.index.reflector_index(case.survey.truth.reflector_of(h));
        let [precision, purity] = quality(&evaluation, reflector);
        print!("| {:.3} ({:.3}) / {precision:.3} / {purity:.3} ", score.coverage(), bounds[h]);
    }
    let large = surfaces.surfaces.iter().filter(|s| s.triangles.len() >= 500).count();
    let [precision, purity] = quality(&evaluation, None);
    println!("| {precision:.3} / {purity:.3} | {large} | {seconds:.1} |");
    Ok(())
}
