//! Damage that partial reads must notice, and shards of other writers.

use super::super::array::StoredArray;
use super::super::{StoreError, StoredVolume, VolumeInfo, write_volume};
use super::file::{CHECKSUM, ENTRY};
use std::fs;
use std::path::{Path, PathBuf};
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::progress::Progress;
use survey::volume::Volume;

/// Two bricks along each axis, the last ones cut at the edge of the volume.
const SIZE: [usize; 3] = [100, 90, 120];

/// Chunks of the only shard, and edges of a chunk.
const CHUNKS: usize = 8;
const EDGE: usize = 64;

fn stored(folder: &Path) -> (PathBuf, Volume<f32>) {
    let path = folder.join("v.zarr");
    let samples = (0..SIZE.iter().product::<usize>()).map(|n| (n * 7919 % 10_007) as f32 - 5000.0).collect();
    let volume = Volume::from_samples(SIZE, samples).unwrap();
    let geometry = SurveyGeometry::regular(SIZE, 25.0, 4.0, VerticalUnit::Milliseconds);
    write_volume(&path, &volume, &VolumeInfo::of(geometry), &Progress::silent()).unwrap();
    (path, volume)
}

/// Sections and boxes of every kind that are cut in different ways, as start and size.
fn boxes() -> Vec<([usize; 3], [usize; 3])> {
    let [nx, ny, nz] = SIZE;
    let mut boxes = Vec::new();
    for at in [3, 63, 64, 89] {
        boxes.push(([at, 0, 0], [1, ny, nz]));
        boxes.push(([0, at, 0], [nx, 1, nz]));
        boxes.push(([0, 0, at], [nx, ny, 1]));
        boxes.push(([at, 7, 0], [1, 1, nz]));
        boxes.push(([at - 3, 60, 50], [5, 20, 30]));
        boxes.push(([10, at - 3, 50], [70, 3, 30]));
    }
    boxes.push(([0; 3], SIZE));
    boxes
}

fn holds(start: [usize; 3], size: [usize; 3], voxel: [usize; 3]) -> bool {
    (0..3).all(|axis| (start[axis]..start[axis] + size[axis]).contains(&voxel[axis]))
}

fn expected(volume: &Volume<f32>, start: [usize; 3], size: [usize; 3]) -> Vec<f32> {
    let places = (start[0]..start[0] + size[0]).flat_map(|x| (start[1]..start[1] + size[1]).map(move |y| (x, y)));
    places.flat_map(|(x, y)| volume.trace(x, y)[start[2]..start[2] + size[2]].to_vec()).collect()
}

#[test]
fn no_wrong_bit_is_ever_read_whatever_the_box() {
    let dir = tempfile::tempdir().unwrap();
    let (path, volume) = stored(dir.path());
    let shard = path.join("0/c/0/0/0");
    let whole = fs::read(&shard).unwrap();
    for voxel in [[3, 7, 5], [63, 63, 63], [64, 64, 64], [89, 7, 119], [20, 89, 60]] {
        let place = voxel.map(|n| n / EDGE);
        let inner = voxel.map(|n| n % EDGE);
        let chunk = (place[0] * 2 + place[1]) * 2 + place[2];
        let sample = (inner[0] * EDGE + inner[1]) * EDGE + inner[2];
        let mut bytes = whole.clone();
        bytes[chunk * (EDGE.pow(3) * 4 + CHECKSUM) + sample * 4 + 1] ^= 0x10;
        fs::write(&shard, bytes).unwrap();
        let stored = StoredVolume::open(&path).unwrap();
        let mut good = 0;
        for (start, size) in boxes() {
            match stored.read_box::<f32>(0, start, size) {
                Ok(part) => {
                    assert!(!holds(start, size, voxel), "{voxel:?} is shown by {start:?} {size:?}");
                    assert_eq!(part.samples(), expected(&volume, start, size));
                    good += 1;
                }
                Err(error) => {
                    let told = error.to_string();
                    let brick = format!("c/0/0/0: the checksum of the brick {place:?}");
                    assert!(told.contains("v.zarr") && told.contains(&brick), "{told}");
                }
            }
        }
        assert!(good > boxes().len() / 2, "{voxel:?}: what does not touch the brick still reads");
    }
}

#[test]
fn a_shard_cut_off_after_it_was_opened_is_an_error() {
    let dir = tempfile::tempdir().unwrap();
    let (path, _) = stored(dir.path());
    let shard = path.join("0/c/0/0/0");
    for length in [0, 10, 1 << 20, 5 << 20] {
        stored(dir.path());
        let volume = StoredVolume::open(&path).unwrap();
        volume.read_box::<f32>(0, [99, 0, 0], [1, 90, 120]).unwrap();
        fs::File::options().write(true).open(&shard).unwrap().set_len(length).unwrap();
        let error = volume.read_box::<f32>(0, [99, 0, 0], [1, 90, 120]).unwrap_err();
        assert!(matches!(error, StoreError::Damaged { .. }), "{error}");
        assert!(error.to_string().contains("c/0/0/0: it was cut off"), "{error}");
    }
}

#[test]
fn shards_without_sums_are_read_and_verified() {
    let dir = tempfile::tempdir().unwrap();
    let (path, volume) = stored(dir.path());
    let shard = path.join("0/c/0/0/0");
    let whole = fs::read(&shard).unwrap();
    let index = whole.len() - CHUNKS * ENTRY - CHECKSUM;
    let sums = index - CHUNKS * super::sums_of([EDGE; 3]) * CHECKSUM - CHECKSUM;
    let mut plain = whole[..sums].to_vec();
    plain.extend(&whole[index..]);
    fs::write(&shard, &plain).unwrap();
    let open = || StoredVolume::open(&path).unwrap();
    for (start, size) in boxes() {
        assert_eq!(open().read_box::<f32>(0, start, size).unwrap().samples(), expected(&volume, start, size));
    }
    plain[77] ^= 1;
    fs::write(&shard, &plain).unwrap();
    assert!(open().read_box::<f32>(0, [0, 0, 0], [1, 90, 120]).is_err());
    let mut altered = whole;
    altered[sums + 5] ^= 1;
    fs::write(&shard, &altered).unwrap();
    assert!(open().read_box::<f32>(0, [0, 0, 0], [1, 90, 120]).is_err(), "the sums have a checksum, too");
}

#[test]
fn a_checksum_advances_as_if_it_were_taken_of_all_bytes() {
    let bytes: Vec<u8> = (0..4000_u32).map(|n| (n * 31 % 251) as u8).collect();
    for length in [1, 7, 256, 1000] {
        let advance = super::CrcAdvance::by(length);
        let whole = bytes.chunks_exact(length).fold(0, |sum, part| advance.apply(sum) ^ crc32c::crc32c(part));
        assert_eq!(whole, crc32c::crc32c(&bytes[..bytes.len() / length * length]), "{length}");
    }
}

#[test]
fn the_array_library_reads_what_we_write() {
    let dir = tempfile::tempdir().unwrap();
    let (path, volume) = stored(dir.path());
    let array = StoredArray::open(&path, "0").unwrap().by_the_library();
    for (start, size) in boxes() {
        let found = array.read_box::<f32>(&start, &size).unwrap();
        assert!(found == expected(&volume, start, size), "{start:?} {size:?}");
    }
}
