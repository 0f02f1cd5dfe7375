//! tmp
use project::{
    Project,
    command::{Command, PickByTime, TimeLevel},
    facts,
};
use std::time::Instant;
use survey::Progress;
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let a: Vec<String> = std::env::args().collect();
    if a.get(4).is_some() {
        facts::keep_within(1 << 30);
    }
    let mut p = Project::open(std::path::Path::new(&a[1]))?;
    for n in 0..a[3].parse::<usize>()? {
        let at: Vec<f64> = a[2].split(',').map(|v| v.parse().unwrap()).collect();
        let t = Instant::now();
        let c = Command::PickByTime(PickByTime {
            level: TimeLevel::Through([at[0], at[1], at[2]]),
            horizon: format!("T{n}"),
        });
        p.apply(&c, &Progress::silent())?;
        println!("click {n}: {:.3} s", t.elapsed().as_secs_f64());
        p.undo()?;
    }
    Ok(())
}
