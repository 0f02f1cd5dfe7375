//! A file of what was computed, below a project's `derived`, with the hash that it needs to be believed: a stranger can compute that too.
//! The environment names its kind (`FUZZ_FORMAT`): `grids` or `blocks`.

#![no_main]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use project::derived;
use survey::Progress;

type Done = Result<(), Box<dyn std::error::Error>>;

static KIND: LazyLock<String> = LazyLock::new(|| std::env::var("FUZZ_FORMAT").unwrap_or_default());

/// A folder that stands for a project.
static ROOT: LazyLock<PathBuf> = LazyLock::new(|| {
    let root = fuzz::folder().join(format!("petroglyph-fuzz-{}", std::process::id()));
    fs::create_dir_all(root.join("derived")).unwrap_or_else(|error| panic!("{error}"));
    root
});

/// Bytes of the hash that ends a file.
const HASH: usize = 32;

/// Writes what fuzzing starts from to the folder that the environment names (`FUZZ_SEEDS`), if it names one.
fn write_seeds() -> Done {
    let Some(corpus) = std::env::var_os("FUZZ_SEEDS") else { return Ok(()) };
    let model = fuzz::scenes::model(&fuzz::scenes::document())?;
    let (silent, root) = (Progress::silent(), ROOT.as_path());
    let parameterization = param::Parameterization::compute(&model, &param::ParamSettings::default(), &silent)?;
    derived::keep_grids(root, "k", &parameterization, &silent);
    derived::keep_blocks(root, "k", model.faults(), &silent);
    for kind in ["grids", "blocks"] {
        let folder = Path::new(&corpus).join(format!("derived-{kind}"));
        fs::create_dir_all(&folder)?;
        let bytes = fs::read(root.join(format!("derived/{kind}-k.bin")))?;
        fs::write(folder.join("whole"), &bytes[..bytes.len() - HASH])?;
    }
    Ok(())
}

libfuzzer_sys::fuzz_target!(init: write_seeds().unwrap_or_else(|error| panic!("{error}")), |data: &[u8]| {
    let path = ROOT.join(format!("derived/{}-k.bin", KIND.as_str()));
    let whole = [data, blake3::hash(data).as_bytes()].concat();
    fs::write(&path, whole).unwrap_or_else(|error| panic!("{error}"));
    if KIND.as_str() == "grids" {
        let Some(kept) = derived::load_grids(&ROOT, "k") else { return };
        for grid in &kept.grids {
            assert!(grid.offsets.is_empty() || grid.node(grid.size[0] - 1, grid.size[1] - 1, grid.levels - 1) < grid.offsets.len());
            assert!((0..grid.offsets.len()).all(|node| !grid.is_crease(node) || node < grid.offsets.len()));
        }
    } else if let Some(kept) = derived::load_blocks(&ROOT, "k") {
        for x in 0..4 {
            let _ = kept.block_at(glam::Vec3::new(x as f32 * 3.0, x as f32, x as f32 * 9.0));
        }
    }
});
