//! `petroglyph bench`: how long the stages take on this machine, as ratios where possible, since these differ less
//! between machines.
//!
//! The model is closed form: four folded layers cut by two faults, a cube of n³ voxels. Measured are the structural
//! model, the parameterization (k with its refinement to the surface, and the traces that give i and j), i, j, k at
//! every voxel, and a picture of three textured faces by the exact lookup and by the packed one of the paper. Growth is
//! the time per voxel of the largest cube over that of the smallest. Memory is the peak of the process beyond what it
//! held before, in bytes a voxel.

mod dump;
mod interp;
mod model;
pub(crate) mod segy;

pub(crate) use self::interp::ExtractionRow;
mod store;

use param::{PackedVolume, ParamSettings, Parameterization};
use project::error::ProjectError;
use project::pictures::load::{Loaded, Rock, Stage};
use project::pictures::{Device, Painter};
use render::{Lookup, Scene};
use serde::Serialize;
use std::fmt;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
pub(crate) use store::StoreMeasured;
use survey::Progress;

/// How large the cubes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sizes {
    /// 64³ and 128³: seconds.
    Quick,
    /// 128³, 256³ and 512³: minutes, and about 5 GB.
    Full,
}

impl Sizes {
    fn sides(self) -> &'static [usize] {
        match self {
            Self::Quick => &[64, 128],
            Self::Full => &[128, 256, 512],
        }
    }

    /// Side of the cube that is stored.
    fn stored(self) -> usize {
        match self {
            Self::Quick => 128,
            Self::Full => 512,
        }
    }

    /// Side of the cube that pictures are drawn of and that is dumped for other programs.
    fn middle(self) -> usize {
        match self {
            Self::Quick => 128,
            Self::Full => 256,
        }
    }
}

/// One cube.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Cube {
    /// Voxels along each axis.
    pub side: usize,
    /// Voxels in layers with two horizons, which other programs are timed on.
    pub closed_voxels: usize,
    /// Seconds by stage.
    pub stages: Vec<Stage>,
    /// Microseconds a voxel for the parameterization.
    pub us_per_voxel: f64,
    /// Bytes a voxel at the peak of the parameterization; `None` where the system does not report it.
    pub peak_bytes_per_voxel: Option<f64>,
}

/// What was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Measured {
    /// Threads used.
    pub threads: usize,
    /// The cubes, small to large.
    pub cubes: Vec<Cube>,
    /// Time per voxel of the largest cube over that of the smallest.
    pub growth: f64,
    /// Extractions of horizon candidates, small to large.
    pub extractions: Vec<ExtractionRow>,
    /// Time per voxel of the largest extraction over that of the smallest.
    pub extraction_growth: f64,
    /// The device that drew the pictures.
    pub device: String,
    /// Seconds for a picture by the exact lookup.
    pub exact_picture_seconds: f64,
    /// Seconds for the same picture by the packed lookup.
    pub packed_picture_seconds: f64,
    /// The first over the second.
    pub exact_over_packed: f64,
    /// Times for writing to the store and reading from it.
    pub store: StoreMeasured,
}

impl fmt::Display for Measured {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} threads; four layers, two faults", self.threads)?;
        for cube in &self.cubes {
            write!(f, "{:>4}³ ", cube.side)?;
            for stage in &cube.stages {
                write!(f, " {} {:.2} s,", stage.stage, stage.seconds)?;
            }
            write!(f, " {:.3} µs a voxel", cube.us_per_voxel)?;
            match cube.peak_bytes_per_voxel {
                Some(bytes) => writeln!(f, ", {bytes:.1} bytes a voxel at the peak")?,
                None => writeln!(f)?,
            }
        }
        writeln!(f, "time per voxel, largest over smallest cube: {:.2}", self.growth)?;
        self.extractions.iter().try_for_each(|row| write!(f, "{row}"))?;
        writeln!(f, "extraction, time per voxel, largest over smallest cube: {:.2}", self.extraction_growth)?;
        writeln!(f, "{}", self.store)?;
        writeln!(
            f,
            "picture of three faces on the {}: {:.2} s exact, {:.2} s packed, ratio {:.2}",
            self.device, self.exact_picture_seconds, self.packed_picture_seconds, self.exact_over_packed
        )
    }
}

/// Measures; with `dump`, writes the middle cube there, so that other programs can be timed on it.
///
/// # Errors
/// The user cancelled, or files could not be written.
pub(crate) fn run(sizes: Sizes, dump: Option<&Path>, progress: &Progress) -> anyhow::Result<Measured> {
    let extractions = interp::measure(sizes, dump, progress)?;
    let extraction_growth = match (extractions.first(), extractions.last()) {
        (Some(first), Some(last)) => last.us_per_voxel / first.us_per_voxel,
        _ => 1.0,
    };
    let mut cubes = Vec::new();
    let (mut device, mut pictures) = (String::new(), (0.0, 0.0));
    for &side in sizes.sides() {
        let (cube, loaded) = measure(side, progress)?;
        if side == sizes.middle() {
            if let (Some(folder), Some(rock)) = (dump, &loaded.rock) {
                dump::write(folder, &rock.model, progress)?;
            }
            let mut painter = Painter::new(Device::Auto, progress)?;
            pictures = draw(&mut painter, &loaded, progress)?;
            device = painter.device().to_owned();
        }
        cubes.push(cube);
    }
    let growth = match (cubes.first(), cubes.last()) {
        (Some(first), Some(last)) => last.us_per_voxel / first.us_per_voxel,
        _ => 1.0,
    };
    let store = store::run(sizes.stored(), dump, progress)?;
    let (exact, packed) = pictures;
    Ok(Measured {
        threads: rayon::current_num_threads(),
        cubes,
        growth,
        extractions,
        extraction_growth,
        device,
        exact_picture_seconds: exact,
        packed_picture_seconds: packed,
        exact_over_packed: exact / packed,
        store,
    })
}

fn measure(side: usize, progress: &Progress) -> Result<(Cube, Loaded), ProjectError> {
    let geometry = model::geometry(side);
    let mut stages = Vec::new();
    let start = Instant::now();
    let model = model::build(&geometry, progress)?;
    stages.push(Stage::new("model", start.elapsed()));
    let before = Memory::begin();
    let start = Instant::now();
    let parameterization = Parameterization::compute(&model, &ParamSettings::default(), progress)?;
    let took = start.elapsed();
    // Both run side by side in every thread, so their shares of the processor time are their shares of the elapsed
    // time.
    let cost = parameterization.cost;
    let share = cost.closest_points.as_secs_f64() / (cost.closest_points + cost.traces).as_secs_f64().max(1e-9);
    stages.push(Stage::new("k (closest points)", took.mul_f64(share)));
    stages.push(Stage::new("i, j (traces)", took.mul_f64(1.0 - share)));
    let peak = before.and_then(|before| before.peak());
    let start = Instant::now();
    let voxels = parameterization.voxel_volumes(&model, [side; 3], progress)?;
    stages.push(Stage::new("sampling", start.elapsed()));
    let count = (side * side * side) as f64;
    let open = [0, model.layer_count() as u16 - 1];
    let cube = Cube {
        side,
        closed_voxels: voxels.layer.samples().iter().filter(|layer| !open.contains(layer)).count(),
        stages,
        us_per_voxel: took.as_secs_f64() * 1e6 / count,
        peak_bytes_per_voxel: peak.map(|bytes| bytes / count),
    };
    let packed = PackedVolume::from_voxels(&voxels, [side; 3], model.layer_count(), model.block_count());
    let rock = Rock::new(model, parameterization, String::new(), Vec::new());
    let tables = model::tables(&geometry, &rock)?;
    Ok((
        cube,
        Loaded {
            picked: Vec::new(),
            geometry,
            rock: Some(Arc::new(rock)),
            volumes: Vec::new(),
            packed: Some(Arc::new(packed)),
            candidates: None,
            wells: Arc::default(),
            raw: None,
            tables: Some(tables),
            data_key: side as u64,
            key: side as u64,
        },
    ))
}

/// Seconds for a picture by each lookup when it is drawn for the second time, so that compiling shaders and uploading
/// are not counted.
fn draw(painter: &mut Painter, loaded: &Loaded, progress: &Progress) -> Result<(f64, f64), ProjectError> {
    let mut seconds = |lookup| {
        let scene = Scene { size_px: [800, 600], samples: 2, lookup, ..Scene::default() };
        painter.draw(&scene, loaded, progress)?;
        Ok::<f64, ProjectError>(painter.draw(&scene, loaded, progress)?.1.seconds)
    };
    Ok((seconds(Lookup::Exact)?, seconds(Lookup::Packed)?))
}

/// Memory of this process, as Linux reports it.
struct Memory {
    resident: f64,
}

impl Memory {
    /// Records the present memory and resets the peak.
    fn begin() -> Option<Self> {
        fs::write("/proc/self/clear_refs", "5").ok()?;
        Some(Self { resident: status("VmRSS:")? })
    }

    /// Bytes held at the peak since then, beyond what was held then.
    fn peak(&self) -> Option<f64> {
        Some(status("VmHWM:")? - self.resident)
    }
}

/// A field of `/proc/self/status`, bytes.
fn status(field: &str) -> Option<f64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(field))?;
    Some(line.split_whitespace().next()?.parse::<f64>().ok()? * 1024.0)
}
