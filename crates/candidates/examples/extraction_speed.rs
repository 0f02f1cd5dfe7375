//! Times extraction stage by stage and says whether its result changed:
//! `cargo run -p candidates --example extraction_speed [SIDE | NXxNYxNZ [ROUNDS [FILE]]]`.
//!
//! A synthetic survey at SNR 3 of SIDE³ (256) voxels. For every round and stage: seconds of the clock,
//! seconds of the processor (all threads), bytes a voxel held at its peak beyond the volume, and a digest of
//! what the stage made. Equal digests are equal results. With FILE, the samples are read from there
//! (little-endian float32 after a NumPy header), or written there when it does not exist, for `python
//! bench/peers.py --amplitude FILE` to time scipy on the same.

use candidates::{DistanceSettings, Forest, ForestSettings, GrowSettings, LeafDistances, Surfaces, grow_surfaces};
use std::error::Error;
use std::fs::{self, File};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::Path;
use std::time::Instant;
use survey::{Progress, Volume};
use synth::{SynthSettings, Synthetic};

/// Bytes of a NumPy header.
const HEADER: usize = 128;

/// Ticks of processor time a second, as Linux counts it.
const TICKS: f64 = 100.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let size = size(&args.next().unwrap_or_else(|| "256".into()))?;
    let rounds: usize = args.next().map_or(Ok(1), |rounds| rounds.parse())?;
    let volume = volume(size, args.next().as_deref().map(Path::new))?;
    let voxels = size.iter().product::<usize>() as f64;
    println!("{}x{}x{} voxels", size[0], size[1], size[2]);
    for _ in 0..rounds {
        let resident = status("VmRSS:");
        let stage = Stage::begin(resident);
        let surfaces = grow_surfaces(&volume, &GrowSettings::default(), &Progress::silent())?;
        stage.end("growing", voxels, || digest_of_surfaces(&surfaces));
        let stage = Stage::begin(resident);
        let forest = Forest::build(surfaces, &ForestSettings::default(), &Progress::silent())?;
        stage.end("trees", voxels, || digest_of_forest(&forest));
        let stage = Stage::begin(resident);
        let distances = LeafDistances::new(&forest, &DistanceSettings::default())?;
        let found = distances.columns(0..size[0], 0..size[1], &Progress::silent())?;
        stage.end("distances", voxels, || digest(|hasher| (&found.distance, &found.leaf).hash(hasher)));
        drop(found);
        println!("{} triangles, {} leaves", forest.surfaces.triangles.len(), forest.leaf_count());
    }
    Ok(())
}

/// Time used before a stage, and memory held before the first stage.
struct Stage {
    start: Instant,
    processor: f64,
    resident: f64,
}

impl Stage {
    fn begin(resident: f64) -> Self {
        // Resets the peak of the memory.
        let _ = fs::write("/proc/self/clear_refs", "5");
        Self { start: Instant::now(), processor: processor_seconds(), resident }
    }

    fn end(self, name: &str, voxels: f64, digest: impl FnOnce() -> u64) {
        let (seconds, processor) = (self.start.elapsed().as_secs_f64(), processor_seconds() - self.processor);
        let bytes = (status("VmHWM:") - self.resident) / voxels;
        println!(
            "{name:>9}: {seconds:7.3} s, processor {processor:7.2} s, {bytes:5.1} bytes a voxel, digest {:016x}",
            digest()
        );
    }
}

/// Processor seconds that this program has used; 0 where the system does not report them.
fn processor_seconds() -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name in brackets; user and system time are the 14th and 15th field.
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    fields.skip(11).take(2).filter_map(|field| field.parse::<f64>().ok()).sum::<f64>() / TICKS
}

/// A field of `/proc/self/status`, bytes.
fn status(field: &str) -> f64 {
    let text = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let kilobytes = text.lines().find_map(|line| line.strip_prefix(field)?.split_whitespace().next()?.parse().ok());
    kilobytes.unwrap_or(0.0) * 1024.0
}

fn digest(add: impl FnOnce(&mut DefaultHasher)) -> u64 {
    let mut hasher = DefaultHasher::new();
    add(&mut hasher);
    hasher.finish()
}

fn digest_of_surfaces(surfaces: &Surfaces) -> u64 {
    digest(|hasher| {
        surfaces.triangles.hash(hasher);
        surfaces.vertices.iter().for_each(|v| (v.x, v.y, v.z.to_bits()).hash(hasher));
        surfaces.surfaces.iter().for_each(|s| (s.extremum, &s.vertices, &s.triangles).hash(hasher));
    })
}

fn digest_of_forest(forest: &Forest) -> u64 {
    digest(|hasher| {
        digest_of_surfaces(&forest.surfaces).hash(hasher);
        forest.nodes.iter().for_each(|n| (n.parent, n.children, n.surface, &n.triangles).hash(hasher));
        (&forest.roots, &forest.leaves).hash(hasher);
    })
}

/// `256` or `1024x1024x512`.
fn size(text: &str) -> Result<[usize; 3], Box<dyn Error>> {
    let sides = text.split('x').map(str::parse).collect::<Result<Vec<usize>, _>>()?;
    match sides[..] {
        [side] => Ok([side; 3]),
        [nx, ny, nz] => Ok([nx, ny, nz]),
        _ => Err(format!("{text} is no size; give one side, or three with x between them").into()),
    }
}

/// The samples of `file`, or a new synthetic survey, written there.
fn volume(size: [usize; 3], file: Option<&Path>) -> Result<Volume<f32>, Box<dyn Error>> {
    if let Some(path) = file.filter(|path| path.exists()) {
        let mut reader = BufReader::with_capacity(1 << 20, File::open(path)?);
        reader.read_exact(&mut [0; HEADER])?;
        let mut volume = Volume::filled(size, 0.0f32);
        let mut bytes = [0; 4];
        for sample in volume.samples_mut() {
            reader.read_exact(&mut bytes)?;
            *sample = f32::from_le_bytes(bytes);
        }
        return Ok(volume);
    }
    let settings = SynthSettings { size, snr: Some(3.0), ..SynthSettings::default() };
    let volume = Synthetic::generate(&settings, &Progress::silent())?.seismic;
    if let Some(path) = file {
        let mut writer = BufWriter::with_capacity(1 << 20, File::create(path)?);
        let facts =
            format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}), }}", size[0], size[1], size[2]);
        writer.write_all(b"\x93NUMPY\x01\x00")?;
        writer.write_all(&(HEADER as u16 - 10).to_le_bytes())?;
        writeln!(writer, "{facts:<width$}", width = HEADER - 11)?;
        for sample in volume.samples() {
            writer.write_all(&sample.to_le_bytes())?;
        }
        writer.flush()?;
    }
    Ok(volume)
}
