//! Scores of surfaces and picks on surfaces made by hand from a truth, where every figure is known.

use super::*;
use candidates::grow::grow_slabs_by;
use candidates::{Extremum, Forest, ForestSettings, GrowSettings, Method, Surface, Vertex};
use model::FaultNetwork;
use survey::Progress;
use synth::{SynthSettings, Synthetic};

fn truth() -> SynthTruth {
    let settings = SynthSettings { size: [48, 40, 64], snr: None, ..SynthSettings::default() };
    Synthetic::generate(&settings, &Progress::silent()).unwrap().truth
}

/// A surface over given nodes, each moved by `shift`; only the count of its triangles matters.
fn surface_of(all: &mut Surfaces, nodes: impl Iterator<Item = (usize, usize, f64)>, triangles: u32) {
    let first = all.vertices.len() as u32;
    all.vertices.extend(nodes.map(|(x, y, z)| Vertex { x: x as u16, y: y as u16, z: z as f32 }));
    let start = all.triangles.len() as u32;
    all.triangles.extend((0..triangles).map(|_| [first; 3]));
    let last = all.vertices.len() as u32;
    all.surfaces.push(Surface { extremum: Extremum::Peak, vertices: first..last, triangles: start..start + triangles });
}

/// The nodes of a horizon in one block.
fn nodes(truth: &SynthTruth, h: usize, block: u16) -> Vec<(usize, usize, f64)> {
    let [nx, ny, _] = truth.size;
    let traces = (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y)));
    traces
        .filter(|&(x, y)| truth.exists(h, block, x as f64, y as f64))
        .map(|(x, y)| (x, y, truth.sheet_z(h, block, x as f64, y as f64)))
        .collect()
}

fn empty(truth: &SynthTruth) -> Surfaces {
    Surfaces { size: truth.size, ..Surfaces::default() }
}

#[test]
fn the_truth_itself_has_full_marks() {
    let truth = truth();
    let mut surfaces = empty(&truth);
    for h in 0..truth.horizons.len() {
        for block in 0..truth.block_count() as u16 {
            surface_of(&mut surfaces, nodes(&truth, h, block).into_iter().map(|(x, y, z)| (x, y, z + 0.9)), 600);
        }
    }
    let found = evaluate(&surfaces, &truth, &EvaluateSettings::default());
    for score in &found.horizons {
        assert!(score.nodes > 500 && !score.parts.is_empty(), "{}", score.name);
        assert_eq!((score.coverage(), score.precision()), (1.0, 1.0), "{}", score.name);
        assert_eq!((score.purity, score.least_part()), (1.0, 1.0), "{}", score.name);
    }
    assert!(found.all.coverage() < 0.9, "other reflectors are not covered");
}

#[test]
fn more_than_a_sample_off_is_nowhere() {
    let truth = truth();
    let mut surfaces = empty(&truth);
    surface_of(&mut surfaces, nodes(&truth, 0, 0).into_iter().map(|(x, y, z)| (x, y, z - 1.1)), 1);
    let found = evaluate(&surfaces, &truth, &EvaluateSettings::default());
    assert_eq!((found.horizons[0].covered, found.horizons[0].surfaces), (0, 0));
}

/// A surface that leaks from Alpha to Bravo: a third of it is impure, and Bravo is covered nevertheless.
#[test]
fn a_leak_lowers_purity_and_precision_but_not_coverage() {
    let truth = truth();
    let (alpha, bravo) = (nodes(&truth, 0, 0), nodes(&truth, 1, 0));
    let leaked = alpha.len() / 2;
    assert!(leaked < bravo.len());
    let mut surfaces = empty(&truth);
    surface_of(&mut surfaces, alpha.iter().chain(&bravo[..leaked]).copied(), 600);
    let found = evaluate(&surfaces, &truth, &EvaluateSettings::default());
    let expected = alpha.len() as f64 / (alpha.len() + leaked) as f64;
    let score = &found.horizons[0];
    assert!((score.purity - expected).abs() < 1e-12 && (score.precision() - expected).abs() < 1e-12);
    assert_eq!(score.worst.unwrap().surface, 0);
    assert_eq!(found.horizons[1].covered, leaked);
    assert_eq!(found.horizons[1].surfaces, 0);
    assert_eq!(score.covered, alpha.len());
}

/// Vertices on no reflector lower the precision, not the purity.
#[test]
fn off_every_reflector_is_imprecise_but_pure() {
    let truth = truth();
    let alpha = nodes(&truth, 0, 0);
    let off = alpha.iter().map(|&(x, y, z)| (x, y, z + 3.0));
    let mut surfaces = empty(&truth);
    surface_of(&mut surfaces, alpha.iter().copied().chain(off), 1);
    let found = evaluate(&surfaces, &truth, &EvaluateSettings::default());
    assert_eq!(found.horizons[0].purity, 1.0);
    assert!((found.horizons[0].precision() - 0.5).abs() < 1e-12);
    // With one more vertex off, fewer than half lie on a reflector, so the surface belongs to none.
    surfaces.surfaces[0].vertices.start += 1;
    assert_eq!(evaluate(&surfaces, &truth, &EvaluateSettings::default()).horizons[0].surfaces, 0);
}

/// The normal and the reverse fault separate; around the tip of the dying fault blocks 1 and 2 are one part.
#[test]
fn parts_are_what_faults_separate() {
    let truth = truth();
    let parts = Parts::of(&truth, 0).empty();
    let mut blocks: Vec<Vec<u16>> = parts.into_iter().map(|part| part.blocks).collect();
    blocks.sort();
    assert_eq!(blocks, [vec![0], vec![1, 2], vec![3]]);
}

#[test]
fn the_middle_of_a_part_lies_on_it_away_from_its_rim() {
    let truth = truth();
    for h in 0..truth.horizons.len() {
        let parts = Parts::of(&truth, h);
        let middles = parts.middles(&truth, h, 64);
        assert!(!middles.is_empty());
        for p in middles {
            let block = (0..4u16).find(|&block| truth.sheet_z(h, block, p.x, p.y) == p.z).unwrap();
            for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                assert!(truth.exists(h, block, p.x + dx, p.y + dy), "{p}");
            }
        }
    }
    assert_eq!(Parts::of(&truth, 0).middles(&truth, 0, 64).len(), 3);
}

#[test]
fn named_horizons_are_reflectors_of_the_index() {
    let truth = truth();
    let index = TruthIndex::new(&truth);
    for h in 0..truth.horizons.len() {
        let wanted = index.reflector_index(truth.reflector_of(h)).unwrap();
        for (x, y, z) in nodes(&truth, h, 1) {
            let near = index.near(x, y, z as f32, 0.01);
            assert!(near.iter().any(|event| usize::from(event.reflector) == wanted && event.block == 1));
        }
    }
}

/// A sheet with two triangles in each cell whose corners all have a height.
fn add_sheet(all: &mut Surfaces, height: impl Fn(usize, usize) -> Option<f32>) {
    let [nx, ny, _] = all.size;
    let (first, start) = (all.vertices.len() as u32, all.triangles.len() as u32);
    let traces = || (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y)));
    let is_whole = |x: usize, y: usize| {
        x + 1 < nx && y + 1 < ny && [(0, 0), (1, 0), (0, 1), (1, 1)].iter().all(|(a, b)| height(x + a, y + b).is_some())
    };
    let mut places = vec![None; nx * ny];
    for (x, y) in traces() {
        let near = |a: usize, b: usize| x >= a && y >= b && is_whole(x - a, y - b);
        if let Some(z) = height(x, y).filter(|_| near(0, 0) || near(1, 0) || near(0, 1) || near(1, 1)) {
            places[x * ny + y] = Some(all.vertices.len() as u32);
            all.vertices.push(Vertex { x: x as u16, y: y as u16, z });
        }
    }
    for (x, y) in traces().filter(|&(x, y)| is_whole(x, y)) {
        let [a, b, c, d] = [0, ny, 1, ny + 1].map(|step| places[x * ny + y + step].unwrap());
        all.triangles.extend([[a, b, c], [b, d, c]]);
    }
    let (vertices, triangles) = (first..all.vertices.len() as u32, start..all.triangles.len() as u32);
    all.surfaces.push(Surface { extremum: Extremum::Peak, vertices, triangles });
}

/// Whole true sheets as surfaces: each part takes one pick, and only the overlap of the reverse fault stops a
/// climb.
#[test]
fn true_sheets_take_a_pick_a_part() {
    let truth = truth();
    let index = TruthIndex::new(&truth);
    let height = |h: usize, block: u16, x: usize, y: usize| {
        let (x, y) = (x as f64, y as f64);
        truth.exists(h, block, x, y).then(|| truth.sheet_z(h, block, x, y) as f32)
    };
    // Blocks 1 and 2 are one part around the tip of the fault between them: two picks here, since the sheets
    // are not joined.
    let mut surfaces = Surfaces { size: truth.size, ..Surfaces::default() };
    (0..4).for_each(|block| add_sheet(&mut surfaces, |x, y| height(0, block, x, y)));
    let settings = ForestSettings { min_leaf_triangles: 50, ..ForestSettings::default() };
    let forest = Forest::build(surfaces, &settings, &Progress::silent()).unwrap();
    let play = |blocks: &FaultNetwork| {
        let (evaluate, settings) = (EvaluateSettings::default(), PickSettings::default());
        count_picks(&forest, &truth, &index, blocks, &evaluate, &settings, &Progress::silent()).unwrap()
    };
    let open = play(&FaultNetwork::none());
    assert_eq!(open[0].parts, 3);
    assert_eq!((open[0].oracle.picks, open[0].oracle.reached), (4, true));
    assert!(open[0].oracle.coverage > 0.95 && open[0].oracle.precision == 1.0, "{:?}", open[0].oracle);
    assert!(open[0].replay.reached, "{:?}", open[0].replay);
    assert!(!open[1].oracle.reached && open[1].oracle.picks == 0, "nothing of Bravo is there");
}

#[test]
fn ours_is_purer_than_the_papers_on_a_faulted_survey() {
    let settings = SynthSettings { size: [96, 96, 96], seed: 1, snr: Some(3.0), ..SynthSettings::default() };
    let survey = Synthetic::generate(&settings, &Progress::silent()).unwrap();
    let [ours, papers] = [Method::Ours, Method::Paper].map(|method| {
        let settings = GrowSettings { method, ..GrowSettings::default() };
        let surfaces =
            grow_slabs_by(crate::growing::method(method), &survey.seismic, &settings, &Progress::silent()).unwrap();
        let found = evaluate(&surfaces, &survey.truth, &EvaluateSettings::default());
        // Over all surfaces, so that merged ones count whatever else they run along.
        let [on_one, on_any] = found.surfaces.iter().fold([0, 0], |sum, s| [sum[0] + s.on_majority, sum[1] + s.on_any]);
        (on_one as f64 / on_any as f64, found.all.coverage())
    });
    assert!(ours.0 > 0.95 && papers.0 < 0.8, "{} {}", ours.0, papers.0);
    assert!(ours.1 > 0.94, "{}", ours.1);
}
