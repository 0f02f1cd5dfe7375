//! Round trips, damage, cancellation, full and read-only disks.

use super::array::StoredArray;
use super::parameterization::NO_ID;
use super::*;
use glam::{DVec2, DVec3};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use survey::fault::Fault;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::mesh::TriangleMesh;
use survey::progress::{Cancelled, Progress};
use survey::sample::{SampleType, SamplesMut};
use survey::source::{Block, BlockSource, LineOrder, SourceError};
use survey::volume::Volume;

/// A volume of several bricks with an uneven rest on each axis.
const SIZE: [usize; 3] = [131, 70, 150];

fn geometry(size: [usize; 3]) -> SurveyGeometry {
    SurveyGeometry::regular(size, 25.0, 4.0, VerticalUnit::Milliseconds)
}

fn info(size: [usize; 3]) -> VolumeInfo {
    let polarity = Some("normal".to_owned());
    VolumeInfo { quantity: Some("amplitude".to_owned().into()), polarity, ..VolumeInfo::of(geometry(size)) }
}

/// Smooth along z, different in every trace.
fn samples(size: [usize; 3]) -> Vec<f32> {
    let count: usize = size.iter().product();
    (0..count).map(|n| ((n / size[2] * 37 % 113) as f32) + (n % size[2]) as f32 * 0.25).collect()
}

fn volume(size: [usize; 3]) -> Volume<f32> {
    Volume::from_samples(size, samples(size)).unwrap()
}

fn quiet() -> Progress {
    Progress::silent()
}

/// All files under a folder with their content.
fn content(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(
                content(&path).into_iter().map(|(name, bytes)| (path.file_name().unwrap().into_path(name), bytes)),
            );
        } else {
            found.insert(PathBuf::from(path.file_name().unwrap()), fs::read(&path).unwrap());
        }
    }
    found
}

trait Under {
    fn into_path(self, name: PathBuf) -> PathBuf;
}

impl Under for &std::ffi::OsStr {
    fn into_path(self, name: PathBuf) -> PathBuf {
        PathBuf::from(self).join(name)
    }
}

#[test]
fn a_volume_comes_back_whole_and_by_box_with_its_mask_and_facts() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("seismic.zarr");
    let mut original = volume(SIZE);
    let live: Vec<bool> = (0..SIZE[0] * SIZE[1]).map(|n| n % 11 != 3).collect();
    original.set_live(Some(live)).unwrap();
    write_volume(&path, &original, &info(SIZE), &quiet()).unwrap();

    let stored = StoredVolume::open(&path).unwrap();
    assert_eq!((stored.info(), stored.type_name().as_str()), (&info(SIZE), "float32"));
    assert_eq!(stored.read::<f32>(0, &quiet()).unwrap(), original);
    let (start, size) = ([60, 5, 100], [10, 60, 50]);
    let part = stored.read_box::<f32>(0, start, size).unwrap();
    for (x, y, z) in [(0, 0, 0), (9, 59, 49), (5, 30, 28)] {
        assert_eq!(part.at(x, y, z), original.at(x + start[0], y + start[1], z + start[2]));
        assert_eq!(part.is_live(x, y), original.is_live(x + start[0], y + start[1]));
    }
    assert!(matches!(stored.read_box::<f32>(0, start, [10, 70, 50]), Err(StoreError::OutOfBounds { .. })));
    assert!(matches!(stored.read::<i16>(0, &quiet()), Err(StoreError::WrongType { expected: "int16", .. })));
    assert!(matches!(stored.read::<f32>(9, &quiet()), Err(StoreError::MissingArray { .. })));
}

#[test]
fn levels_halve_and_keep_the_place_of_their_voxels() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("ramp.zarr");
    let plane = |x: f32, y: f32, z: f32| 2.0 * x - y + 0.5 * z;
    let mut ramp = Volume::filled(SIZE, 0.0f32);
    for x in 0..SIZE[0] {
        for y in 0..SIZE[1] {
            for (z, value) in ramp.trace_mut(x, y).iter_mut().enumerate() {
                *value = plane(x as f32, y as f32, z as f32);
            }
        }
    }
    write_volume(&path, &ramp, &info(SIZE), &quiet()).unwrap();
    let stored = StoredVolume::open(&path).unwrap();
    assert_eq!(stored.level_count(), 3);
    for level in 1..3 {
        let step = 1 << level;
        let coarse = stored.read_f32(level, &quiet()).unwrap();
        assert_eq!(coarse.size(), SIZE.map(|n| n.div_ceil(step)));
        let lattice = stored.geometry(level);
        assert_eq!(lattice.size(), coarse.size());
        let voxel = DVec3::new(7.0, 5.0, 9.0);
        let same_place = info(SIZE).geometry.voxel_from_world(lattice.world_from_voxel(voxel));
        assert!((same_place - voxel * step as f64).length() < 1e-9);
        for (x, y, z) in [(7, 5, 9), (10, 8, 20), (15, 9, 30)] {
            let expected = plane((x * step) as f32, (y * step) as f32, (z * step) as f32);
            assert!((coarse.at(x, y, z) - expected).abs() < 0.01, "level {level}: {} at {x}", coarse.at(x, y, z));
        }
    }
}

#[test]
fn dead_traces_do_not_leak_into_levels_and_ranges() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("holes.zarr");
    let size = [70, 20, 30];
    let live: Vec<bool> = (0..size[0] * size[1]).map(|n| n % 5 != 1).collect();
    let mut holes = Volume::filled(size, 7.0f32);
    for (n, trace) in holes.samples_mut().chunks_mut(size[2]).enumerate() {
        if !live[n] {
            trace.fill(-1e9);
        }
    }
    holes.set_live(Some(live)).unwrap();
    write_volume(&path, &holes, &info(size), &quiet()).unwrap();
    let stored = StoredVolume::open(&path).unwrap();
    for level in 0..2 {
        let (_, ranges) = stored.brick_ranges(level).unwrap();
        assert!(ranges.iter().flatten().all(|v| (v - 7.0).abs() < 1e-4), "{ranges:?}");
    }
    let coarse = stored.read_f32(1, &quiet()).unwrap();
    for x in 0..coarse.size()[0] {
        for y in 0..coarse.size()[1] {
            assert_eq!(coarse.is_live(x, y), holes.is_live(2 * x, 2 * y));
            let expected = if coarse.is_live(x, y) { 7.0 } else { 0.0 };
            assert!(coarse.trace(x, y).iter().all(|v| (v - expected).abs() < 1e-4));
        }
    }
}

#[test]
fn brick_ranges_are_those_of_a_plain_search() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("v.zarr");
    let original = volume(SIZE);
    write_volume(&path, &original, &info(SIZE), &quiet()).unwrap();
    let (counts, ranges) = StoredVolume::open(&path).unwrap().brick_ranges(0).unwrap();
    assert_eq!(counts, [3, 2, 3]);
    let mut expected = vec![[f32::INFINITY, f32::NEG_INFINITY]; 18];
    for x in 0..SIZE[0] {
        for y in 0..SIZE[1] {
            for z in 0..SIZE[2] {
                let range = &mut expected[((x / BRICK) * 2 + y / BRICK) * 3 + z / BRICK];
                *range = [range[0].min(original.at(x, y, z)), range[1].max(original.at(x, y, z))];
            }
        }
    }
    assert_eq!(ranges, expected);
}

#[test]
fn integers_keep_their_type_and_read_as_floats() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("i16.zarr");
    let size = [66, 10, 12];
    let values: Vec<i16> = samples(size).iter().map(|v| (v * 100.0) as i16).collect();
    let original = Volume::from_samples(size, values).unwrap();
    write_volume(&path, &original, &info(size), &quiet()).unwrap();
    let stored = StoredVolume::open(&path).unwrap();
    assert_eq!(stored.type_name(), "int16");
    assert_eq!(stored.read::<i16>(0, &quiet()).unwrap(), original);
    let floats = stored.read_f32(0, &quiet()).unwrap();
    assert!(floats.samples().iter().zip(original.samples()).all(|(&f, &i)| f == f32::from(i)));
    assert_eq!(stored.read_f32(1, &quiet()).unwrap().size(), [33, 5, 6]);
}

#[test]
fn slabs_and_threads_make_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let original = volume(SIZE);
    let write = |name: &str, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let path = dir.path().join(name);
        pool.install(|| write_volume(&path, &original, &info(SIZE), &quiet())).unwrap();
        content(&path)
    };
    let (one, many) = (write("one", 1), write("many", 4));
    assert!(one == many, "threads show in the files");
    let path = dir.path().join("slabs");
    let row = SIZE[1] * SIZE[2];
    let mut asked = Vec::new();
    let make = |block: &Block| {
        assert_eq!(block.crosslines, 0..SIZE[1]);
        asked.push(block.inlines.clone());
        Ok(original.samples()[block.inlines.start * row..block.inlines.end * row].to_vec())
    };
    let mut slabs = Made { size: SIZE, order: LineOrder::Inlines, make };
    write_blocks(&path, &mut slabs, &info(SIZE), MEMORY_BYTES, &quiet()).unwrap();
    assert_eq!(asked, [0..128, 128..131]);
    assert!(content(&path) == one);
}

#[test]
fn a_source_that_fails_or_a_cancel_leaves_the_old_volume() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("v.zarr");
    let size = [20, 20, 20];
    write_volume(&path, &volume(size), &info(size), &quiet()).unwrap();
    let before = content(dir.path());
    let mut broken = Made { size, order: LineOrder::Inlines, make: |_: &Block| Err("trace 5 is cut off".into()) };
    let error = write_blocks(&path, &mut broken, &info(size), MEMORY_BYTES, &quiet()).unwrap_err();
    assert!(error.source().unwrap().to_string().contains("trace 5"));
    let cancelled = quiet();
    cancelled.cancel();
    let error = write_volume(&path, &Volume::filled(size, 0.0f32), &info(size), &cancelled).unwrap_err();
    assert!(matches!(error, StoreError::Cancelled(Cancelled)));
    let error = write_volume(&path, &volume([20, 20, 19]), &info(size), &quiet()).unwrap_err();
    assert!(matches!(error, StoreError::SizeMismatch { .. }));
    assert!(content(dir.path()) == before);
}

/// Blocks of floats that a test makes up, in an order of its own.
struct Made<F> {
    size: [usize; 3],
    order: LineOrder,
    make: F,
}

impl<F: FnMut(&Block) -> Result<Vec<f32>, SourceError>> BlockSource for Made<F> {
    fn size(&self) -> [usize; 3] {
        self.size
    }

    fn live(&self) -> Option<Cow<'_, [bool]>> {
        None
    }

    fn order(&self) -> LineOrder {
        self.order
    }

    fn sample_type(&self) -> SampleType {
        SampleType::Float32
    }

    fn read_block(&mut self, block: &Block, out: SamplesMut<'_>, _: &Progress) -> Result<(), SourceError> {
        let SamplesMut::Float32(out) = out else { panic!("room for another type: {out:?}") };
        out.copy_from_slice(&(self.make)(block)?);
        Ok(())
    }
}

/// The samples of a block of a volume.
fn block_of(volume: &Volume<f32>, block: &Block) -> Vec<f32> {
    let lines = block.inlines.clone().flat_map(|x| block.crosslines.clone().map(move |y| (x, y)));
    lines.flat_map(|(x, y)| volume.trace(x, y).iter().copied()).collect()
}

#[test]
fn little_memory_makes_small_blocks_in_the_order_of_the_source_and_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let size = [140, 270, 20];
    let original = volume(size);
    let whole = dir.path().join("whole");
    write_volume(&whole, &original, &info(size), &quiet()).unwrap();
    let column = 128 * 128 * 20 * 4;
    for (order, columns, expected) in [
        (LineOrder::Inlines, 1, 6),
        (LineOrder::Inlines, 2, 4),
        (LineOrder::Crosslines, 1, 6),
        (LineOrder::Crosslines, 2, 3),
    ] {
        let mut asked = Vec::new();
        let make = |block: &Block| {
            asked.push(block.clone());
            Ok(block_of(&original, block))
        };
        let path = dir.path().join("parts");
        write_blocks(&path, &mut Made { size, order, make }, &info(size), 2 * columns * column, &quiet()).unwrap();
        assert_eq!(asked.len(), expected, "{order:?} {columns} {asked:?}");
        assert!(content(&path) == content(&whole));
    }
}

#[test]
fn an_interrupted_volume_goes_on_where_it_was_and_ends_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let size = [300, 130, 70];
    let original = volume(size);
    let whole = dir.path().join("whole");
    write_volume(&whole, &original, &info(size), &quiet()).unwrap();
    let path = dir.path().join("resumed");
    let resume = |fingerprint: &str, stop_after: usize| {
        let mut supplied = 0;
        let make = |block: &Block| {
            if supplied == stop_after {
                return Err("the program was killed".into());
            }
            supplied += 1;
            Ok(block_of(&original, block))
        };
        let mut blocks = Made { size, order: LineOrder::Inlines, make };
        let done = resume_blocks(&path, fingerprint, &mut blocks, &info(size), 1, &quiet());
        (done, supplied)
    };
    assert!(resume("a", 4).0.is_err());
    assert!(matches!(StoredVolume::open(&path).err(), Some(StoreError::Unfinished { .. })));
    // A file cut short, as a power cut may leave it, is written again, and so is one with a wrong bit.
    let files = ["0/c/0/0/0", "0/c/1/0/0"].map(|file| path.join(file));
    let bytes = fs::read(&files[0]).unwrap();
    fs::write(&files[0], &bytes[..bytes.len() - 9]).unwrap();
    let mut bytes = fs::read(&files[1]).unwrap();
    bytes[77] ^= 4;
    fs::write(&files[1], bytes).unwrap();
    let (done, supplied) = resume("a", usize::MAX);
    assert_eq!((done.unwrap().kept, supplied), (2, 4));
    assert!(content(&path) == content(&whole));

    fs::remove_dir_all(&path).unwrap();
    assert!(resume("a", 4).0.is_err());
    let (done, supplied) = resume("b", usize::MAX);
    assert_eq!((done.unwrap().kept, supplied), (0, 6), "another fingerprint starts anew");
    assert!(content(&path) == content(&whole));
}

#[test]
fn sections_and_boxes_of_every_kind_are_those_of_the_volume() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("v.zarr");
    let mut original = volume(SIZE);
    // A brick of nothing is not stored, and reads as nothing.
    for x in 64..128 {
        for y in 0..64 {
            original.trace_mut(x, y)[64..128].fill(0.0);
        }
    }
    write_volume(&path, &original, &info(SIZE), &quiet()).unwrap();
    let stored = StoredVolume::open(&path).unwrap();
    let [nx, ny, nz] = SIZE;
    for (start, size) in [
        ([64, 0, 0], [1, ny, nz]),
        ([130, 0, 0], [1, ny, nz]),
        ([0, 69, 0], [nx, 1, nz]),
        ([0, 0, 128], [nx, ny, 1]),
        ([63, 63, 63], [2, 2, 2]),
        ([3, 5, 7], [120, 60, 140]),
        ([130, 69, 149], [1, 1, 1]),
    ] {
        let part = stored.read_box::<f32>(0, start, size).unwrap();
        for x in 0..size[0] {
            for y in 0..size[1] {
                let trace = &original.trace(x + start[0], y + start[1])[start[2]..start[2] + size[2]];
                assert_eq!(part.trace(x, y), trace, "{start:?} {size:?} at {x} {y}");
            }
        }
    }
}

/// A sheet on the survey's lattice and one on a rotated grid of its own.
fn horizon() -> Horizon {
    let survey = NodeGrid::of_survey(&geometry([30, 20, 10]));
    let native = NodeGrid {
        origin: DVec2::new(3.5, 1.25),
        u_step: DVec2::new(8.0, 6.0),
        v_step: DVec2::new(-6.0, 8.0),
        count: [7, 9],
    };
    let depth = |count: usize| (0..count).map(|n| if n % 4 == 1 { f32::NAN } else { n as f32 * 1.5 }).collect();
    let mut sheets =
        vec![Sheet::new(survey, depth(600), Quality::Picked), Sheet::new(native, depth(63), Quality::Extrapolated)];
    sheets[1].block = Some(3);
    sheets[0].quality[0] = Quality::Filled;
    Horizon::new("Top Ølund/2", sheets)
}

#[test]
fn a_horizon_comes_back_with_grids_blocks_and_qualities() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("horizons").join("top.zarr");
    write_horizon(&path, &horizon(), &quiet()).unwrap();
    let (back, original) = (read_horizon(&path, &quiet()).unwrap(), horizon());
    assert_eq!(back.name, original.name);
    for (a, b) in back.sheets.iter().zip(&original.sheets) {
        assert_eq!((a.block, a.grid, &a.quality), (b.block, b.grid, &b.quality));
        let bits = |sheet: &Sheet| sheet.depth.iter().map(|d| d.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(a), bits(b));
    }
    assert!(matches!(StoredVolume::open(&path), Err(StoreError::WrongKind { .. })));
    let empty = Horizon::new("none", Vec::new());
    write_horizon(&path, &empty, &quiet()).unwrap();
    assert_eq!(read_horizon(&path, &quiet()).unwrap(), empty);
}

#[test]
fn a_fault_comes_back_and_reads_well() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("faults").join("main.json");
    let vertices = vec![DVec3::new(605_835.1, 6_073_556.2, 1.0 / 3.0), DVec3::new(0.1, -1e-7, 1e9), DVec3::ONE];
    let mesh = TriangleMesh { vertices, triangles: vec![[0, 1, 2]] };
    let fault = Fault { truncated_by: Some("Main".to_owned()), grown_m: 12.5, ..Fault::new("F \"1\"", mesh) };
    write_fault(&path, &fault).unwrap();
    assert_eq!(read_fault(&path).unwrap(), fault);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains("\n[605835.1, 6073556.2, 0.3333333333333333],\n"), "{text}");

    fs::write(&path, text.replace("[0, 1, 2]", "[0, 1, 3]")).unwrap();
    assert!(matches!(read_fault(&path), Err(StoreError::WrongKind { .. })));
    fs::write(&path, text.replace("\"version\": 1", "\"version\": 99")).unwrap();
    assert!(matches!(read_fault(&path), Err(StoreError::NewerVersion { found: 99, .. })));
    assert!(matches!(read_fault(&dir.path().join("none.json")), Err(StoreError::Missing { .. })));
    let mut broken = fault;
    broken.mesh.vertices[0].x = f64::NAN;
    assert!(write_fault(&path, &broken).is_err());
}

#[test]
fn a_parameterization_comes_back_with_ids_of_either_width() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("derived").join("parameterization.zarr");
    let size = [70, 12, 65];
    let count: usize = size.iter().product();
    let field = |scale: f32| {
        let values = (0..count).map(|n| if n % 9 == 0 { f32::NAN } else { n as f32 * scale }).collect();
        Volume::from_samples(size, values).unwrap()
    };
    let ids = |most: u16| {
        let values = (0..count).map(|n| if n % 9 == 0 { NO_ID } else { (n % usize::from(most)) as u16 }).collect();
        Volume::from_samples(size, values).unwrap()
    };
    let original =
        ParameterizationVolumes { i: field(1e-3), j: field(-2.0), k: field(1e-5), layer: ids(254), block: ids(300) };
    write_parameterization(&path, &original, "abc123", &quiet()).unwrap();
    let stored = StoredParameterization::open(&path).unwrap();
    assert_eq!((stored.size(), stored.key()), (size, "abc123"));
    for (name, id_type) in [("layer", "uint8"), ("block", "uint16")] {
        assert_eq!(StoredArray::open(&path, name).unwrap().type_name(), id_type);
    }
    let bits = |v: &Volume<f32>| v.samples().iter().map(|s| s.to_bits()).collect::<Vec<_>>();
    let back = stored.read(&quiet()).unwrap();
    assert!([&back.i, &back.j, &back.k].map(bits) == [&original.i, &original.j, &original.k].map(bits));
    assert!(back.layer == original.layer && back.block == original.block);
    let part = stored.read_box([60, 1, 60], [5, 4, 5]).unwrap();
    assert_eq!(part.block.at(4, 3, 4), original.block.at(64, 4, 64));
    assert_eq!(part.k.at(1, 1, 0).to_bits(), original.k.at(61, 2, 60).to_bits());
}

#[test]
fn damage_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("v.zarr");
    write_volume(&path, &volume(SIZE), &info(SIZE), &quiet()).unwrap();
    let open = || StoredVolume::open(&path);
    let chunk = path.join("0/c/1/0/1");
    let whole = fs::read(&chunk).unwrap();
    let read = || open().unwrap().read::<f32>(0, &quiet()).unwrap_err();

    for cut in [whole.len() / 2, 3, 0] {
        fs::write(&chunk, &whole[..cut]).unwrap();
        let error = read();
        assert!(matches!(&error, StoreError::Damaged { array, .. } if array == "0"), "{error}");
        assert!(error.to_string().contains("v.zarr"), "{error}");
    }
    let mut altered = whole;
    altered[40] ^= 0x55;
    fs::write(&chunk, &altered).unwrap();
    let error = read();
    assert!(matches!(error, StoreError::Damaged { .. }), "{error:?}");
    fs::remove_file(&chunk).unwrap();
    assert!(read().to_string().contains("c/1/0/1 is missing"));
    let other_box = open().unwrap().read_box::<f32>(0, [0, 0, 0], [5, 5, 5]);
    assert!(other_box.is_ok(), "what does not need the lost file still reads");

    fs::remove_dir_all(path.join("2")).unwrap();
    assert!(matches!(open().err(), Some(StoreError::MissingArray { array, .. }) if array == "2"));
    let header = fs::read_to_string(path.join("zarr.json")).unwrap();
    fs::write(path.join("zarr.json"), header.replace("\"version\": 1", "\"version\": 7")).unwrap();
    assert!(matches!(open().err(), Some(StoreError::NewerVersion { found: 7, known: 1, .. })));
    fs::write(path.join("zarr.json"), "hello").unwrap();
    assert!(matches!(open().err(), Some(StoreError::WrongKind { .. })));
    fs::remove_file(path.join("zarr.json")).unwrap();
    assert!(open().is_err());
    fs::remove_dir_all(&path).unwrap();
    assert!(matches!(open().err(), Some(StoreError::Missing { .. })));
}

#[test]
fn a_volume_left_under_its_replaced_name_is_found() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("v.zarr");
    let size = [10, 10, 10];
    write_volume(&path, &volume(size), &info(size), &quiet()).unwrap();
    fs::rename(&path, dir.path().join(".v.zarr.replaced")).unwrap();
    assert_eq!(StoredVolume::open(&path).unwrap().read_f32(0, &quiet()).unwrap(), volume(size));
}

/// A small file system of its own, if this machine lets us mount one.
struct SmallDisk(tempfile::TempDir);

impl SmallDisk {
    fn mount(options: &str) -> Option<Self> {
        let dir = tempfile::tempdir().unwrap();
        let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", options, "tmpfs"]).arg(dir.path()).output();
        if mounted.is_ok_and(|output| output.status.success()) {
            Some(Self(dir))
        } else {
            eprintln!("skipped: mounting a tmpfs is not permitted here");
            None
        }
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0.path()).output();
    }
}

#[test]
fn a_full_disk_costs_nothing_but_the_new_state() {
    let Some(disk) = SmallDisk::mount("size=1m") else { return };
    let path = disk.0.path().join("v.zarr");
    let small = [20, 20, 20];
    write_volume(&path, &volume(small), &info(small), &quiet()).unwrap();
    let before = content(disk.0.path());
    // Noise does not compress: 4 MB into what is left of 1 MiB.
    let size = [100, 100, 100];
    let mut state = 1u32;
    let noise = (0..1_000_000).map(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state as f32
    });
    let noise = Volume::from_samples(size, noise.collect()).unwrap();
    let error = write_volume(&path, &noise, &info(size), &quiet()).unwrap_err();
    assert!(matches!(error, StoreError::DiskFull { .. }), "{error:?}");
    assert!(content(disk.0.path()) == before, "the old volume is whole and nothing half-written stays");
    assert_eq!(StoredVolume::open(&path).unwrap().read_f32(0, &quiet()).unwrap(), volume(small));
}

#[test]
fn a_read_only_folder_is_named() {
    let Some(disk) = SmallDisk::mount("size=1m,ro") else { return };
    let path = disk.0.path().join("v.zarr");
    let size = [10, 10, 10];
    let error = write_volume(&path, &volume(size), &info(size), &quiet()).unwrap_err();
    assert!(matches!(error, StoreError::ReadOnly { .. }), "{error:?}");
    assert!(matches!(write_horizon(&path, &horizon(), &quiet()), Err(StoreError::ReadOnly { .. })));
    let fault = Fault::new("F", TriangleMesh::default());
    assert!(matches!(write_fault(&path, &fault), Err(StoreError::ReadOnly { .. })));
}
