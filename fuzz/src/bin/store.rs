//! One file of what the store keeps, as a damaged disk or a stranger leaves it. The environment names what (`FUZZ_FORMAT`): `fault`,
//! `well`, or `volume`, `horizon`, `candidates` and `parameterization`, of which the first byte of an input says which of its files it
//! replaces.

#![no_main]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use store::{
    CandidateWriter, ParameterizationVolumes, StoredCandidates, StoredParameterization, StoredVolume, VolumeInfo,
};
use survey::candidates::CandidateSink as _;
use survey::{CandidateInfo, ForestTables, Progress, Volume};

type Done = Result<(), Box<dyn std::error::Error + Send + Sync>>;

/// Its path, and its bytes.
type StoredFile = (PathBuf, Vec<u8>);

/// What is kept in groups of files.
const GROUPS: [&str; 4] = ["volume", "horizon", "candidates", "parameterization"];

static KIND: LazyLock<String> = LazyLock::new(|| std::env::var("FUZZ_FORMAT").unwrap_or_default());

/// The group, its files, and what they hold.
static GROUP: LazyLock<(PathBuf, Vec<StoredFile>)> = LazyLock::new(|| {
    let path = fuzz::folder().join(format!("petroglyph-fuzz-{}.zarr", std::process::id()));
    write(&KIND, &path).unwrap_or_else(|error| panic!("{error}"));
    let files = files_of(&path);
    (path, files)
});

fn write(kind: &str, path: &Path) -> Done {
    let (silent, mut small, size) = (Progress::silent(), fuzz::survey(), [4, 3, 5]);
    (small.inlines.count, small.crosslines.count, small.vertical.count) = (size[0], size[1], size[2]);
    match kind {
        "volume" => {
            let mut volume = Volume::filled(size, 1.5_f32);
            volume.set_live(Some((0..12).map(|n| n != 5).collect()))?;
            store::write_volume(path, &volume, &VolumeInfo::of(small), &silent)?;
        }
        "horizon" => store::write_horizon(path, &fuzz::interpretation(&small).0, &silent)?,
        "candidates" => {
            let mut writer = CandidateWriter::create(path, size, 2)?;
            let codes: Vec<u8> = (0..60).collect();
            let ids: Vec<u32> = (0..60).map(|n| n % 3).collect();
            writer.write_slab(0, &codes, &ids, &silent)?;
            let info =
                CandidateInfo { key: "k".into(), size, max_distance: 3.0, leaves: 2, report: serde_json::json!({}) };
            let tables = ForestTables {
                trace: vec![[0, 1], [1, 1], [2, 2]],
                z: vec![0.5, 1.25, 2.0],
                triangles: vec![[0, 1, 2]],
                surfaces: vec![[1, 0, 3, 0, 1]],
                nodes: vec![[u32::MAX, u32::MAX, u32::MAX, 0, 0, 1]],
            };
            writer.finish(&info, &tables, &silent)?;
        }
        "parameterization" => {
            let (f, n) = (Volume::filled(size, 0.5_f32), Volume::filled(size, 1_u16));
            let volumes = ParameterizationVolumes { i: f.clone(), j: f.clone(), k: f, layer: n.clone(), block: n };
            store::write_parameterization(path, &volumes, "k", &silent)?;
        }
        other => panic!("FUZZ_FORMAT {other} is nothing that the store keeps"),
    }
    Ok(())
}

fn files_of(folder: &Path) -> Vec<StoredFile> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.append(&mut files_of(&path));
        } else if let Ok(bytes) = fs::read(&path) {
            found.push((path, bytes));
        }
    }
    found.sort();
    found
}

fn read(kind: &str, path: &Path) {
    let silent = Progress::silent();
    match kind {
        "volume" => {
            let Ok(stored) = StoredVolume::open(path) else { return };
            let _ = stored.brick_ranges(0);
            let _ = stored.checksums();
            let _ = stored.read_f32(0, &silent);
            let _ = stored.read_box_f32(0, [1, 1, 1], [1, 2, 3]);
        }
        "horizon" => drop(store::read_horizon(path, &silent)),
        "candidates" => {
            let Ok(stored) = StoredCandidates::open(path) else { return };
            let _ = stored.read(0, &silent);
            let _ = stored.read_forest(&silent);
        }
        _ => {
            if let Ok(stored) = StoredParameterization::open(path) {
                let _ = stored.read(&silent);
            }
        }
    }
}

/// Writes what fuzzing starts from to the folder that the environment names (`FUZZ_SEEDS`), if it names one.
fn write_seeds() -> Done {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return Ok(()) };
    let corpus = Path::new(&corpus);
    for kind in GROUPS {
        let folder = corpus.join(format!("store-{kind}"));
        fs::create_dir_all(&folder)?;
        let group = fuzz::folder().join(format!("petroglyph-seed-{}.zarr", std::process::id()));
        write(kind, &group)?;
        for (n, (_, bytes)) in files_of(&group).into_iter().enumerate() {
            fs::write(folder.join(n.to_string()), [&[n as u8], bytes.as_slice()].concat())?;
        }
        fs::remove_dir_all(&group)?;
    }
    for kind in ["fault", "well"] {
        fs::create_dir_all(corpus.join(format!("store-{kind}")))?;
    }
    store::write_fault(&corpus.join("store-fault/fault"), &fuzz::interpretation(&fuzz::survey()).1)?;
    store::write_well(&corpus.join("store-well/well"), &survey::Well::new("A", fuzz::well_path()))?;
    Ok(())
}

libfuzzer_sys::fuzz_target!(init: write_seeds().unwrap_or_else(|error| panic!("{error}")), |data: &[u8]| {
    match KIND.as_str() {
        "fault" => fuzz::with_file(data, |path| drop(store::read_fault(path))),
        "well" => fuzz::with_file(data, |path| drop(store::read_well(path))),
        // The run that only writes seeds.
        "" => {}
        kind => {
            let Some((first, content)) = data.split_first() else { return };
            let (group, files) = &*GROUP;
            let (file, whole) = &files[usize::from(*first) % files.len()];
            let put = |bytes: &[u8]| fs::write(file, bytes).unwrap_or_else(|error| panic!("{error}"));
            put(content);
            read(kind, group);
            put(whole);
        }
    }
});
