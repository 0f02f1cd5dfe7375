use interp::evaluate::*;
use interp::{Forest, ForestSettings, GrowSettings, grow_surfaces};
use survey::Progress;
use survey::model::FaultNetwork;
use survey::synth::{SynthSettings, Synthetic};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let size: usize = args[1].parse().unwrap();
    let seed: u64 = args[2].parse().unwrap();
    let snr: f64 = args[3].parse().unwrap();
    let p = Progress::silent();
    let s = Synthetic::generate(&SynthSettings { size: [size; 3], seed, snr: Some(snr), ..Default::default() }, &p).unwrap();
    let index = TruthIndex::new(&s.truth);
    for share in &args[4..] {
        let g = GrowSettings { join_share: share.parse().unwrap(), ..Default::default() };
        let t = std::time::Instant::now();
        let surfaces = grow_surfaces(&s.seismic, &g, &p).unwrap();
        let dt = t.elapsed().as_secs_f32();
        let forest = Forest::build(surfaces, &ForestSettings::default(), &p).unwrap();
        let e = EvaluateSettings::default();
        let f = evaluate_with(&forest.surfaces, &s.truth, &index, &e);
        let [one, any] = f.surfaces.iter().fold([0, 0], |a, s| [a[0] + s.on_majority, a[1] + s.on_any]);
        let large = forest.surfaces.surfaces.iter().filter(|s| s.triangles.len() >= 500).count();
        println!("share {share}: {dt:.1} s, large {large}, purity over all {:.4}", one as f64 / any as f64);
        let picks = count_picks(&forest, &s.truth, &index, &FaultNetwork::none(), &e, &PickSettings { climb: interp::assembly::ClimbSettings { tolerated_share: std::env::var("TOL").map_or(0.02, |t| t.parse().unwrap()), tolerated_beside: std::env::var("BES").map_or(0.1, |t| t.parse().unwrap()) }, ..PickSettings::default() }, &p).unwrap();
        for (h, k) in f.horizons.iter().zip(&picks) {
            println!("  {:14} parts {} cov {:.3} prec {:.3} pur {:.3} worst {:.3} oracle {} ({:.2},{:.2}) replay {} ({:.2},{:.2})", h.name, h.parts.len(), h.coverage(), h.precision(), h.purity,
                h.worst.map_or(0.0, |w| w.purity()), k.oracle.picks, k.oracle.coverage, k.oracle.precision, k.replay.picks, k.replay.coverage, k.replay.precision);
        }
        if std::env::var("DUMP").is_ok() {
        for (h, hz) in s.truth.horizons.iter().enumerate() {
            let r = index.reflector_index(s.truth.reflector_of(h));
            let mut own: Vec<_> = f.surfaces.iter().filter(|x| x.majority == r && x.on_majority > 60).collect();
            own.sort_by_key(|x| std::cmp::Reverse(x.on_majority));
            println!("  {}", hz.name);
            for x in own.iter().take(14) {
                let vs = &forest.surfaces.vertices[forest.surfaces.surfaces[x.surface].vertices.start as usize..forest.surfaces.surfaces[x.surface].vertices.end as usize];
                let b = vs.iter().fold([u16::MAX, 0, u16::MAX, 0], |b, v| [b[0].min(v.x), b[1].max(v.x), b[2].min(v.y), b[3].max(v.y)]);
                println!("     {:?} {} vertices, on {} any {} x {}..{} y {}..{}", forest.surfaces.surfaces[x.surface].extremum, x.vertices, x.on_majority, x.on_any, b[0], b[1], b[2], b[3]);
            }
        }
        }
    }
}
