//! Kept parameterizations.

use super::super::file::KEPT;
use super::*;
use glam::Vec3;
use std::fs::{self, File};
use std::time::{Duration, SystemTime};

fn parameterization() -> Parameterization {
    let calm = Arc::new(HeightField { origin: [-4, 0], size: [2, 3], z: vec![1.5; 6] });
    let grid = |layer: u16, top: SheetSource| RegionGrid {
        region: Region { layer, block: 0 },
        origin: [-3, 4],
        size: [2, 2],
        levels: 3,
        bottom: SheetRef { of: SheetSource::Horizon(0), shift: 0.0 },
        top: SheetRef { of: top, shift: -12.5 },
        thickness_m: Some(1.0 / 3.0),
        offsets: (0..12).map(|n| [n as f32, -1.5, f32::MIN_POSITIVE]).collect(),
        creases: vec![5],
        unfolded: None,
    };
    let field = |value: f32| LevelField::from_fn(Vec3::ZERO, Vec3::ONE, [2, 3, 2], |p| value + p.x);
    let folded = RegionGrid {
        size: [0; 2],
        offsets: Vec::new(),
        creases: Vec::new(),
        unfolded: Some(Arc::new(Unfolded { places: [field(1.0), field(-2.5)], log_weight: Some(field(0.5)) })),
        ..grid(1, SheetSource::Plane)
    };
    Parameterization {
        size: [4, 5, 6],
        layers: 3,
        blocks: 1,
        grids: vec![
            grid(0, SheetSource::Calm(calm)),
            grid(1, SheetSource::Plane),
            RegionGrid { region: Region { layer: 2, block: 0 }, ..folded },
        ],
        cost: ComputeCost::default(),
    }
}

#[test]
fn grids_that_do_not_fit_their_counts_are_not_used() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let damages: [fn(&mut Parameterization); 8] = [
        |p| {
            let mut field = LevelField::from_fn(Vec3::ZERO, Vec3::ONE, [2; 3], |p| p.x);
            field.values[3] = f32::NAN;
            p.grids[2].unfolded = Some(Arc::new(Unfolded { places: [field.clone(), field], log_weight: None }));
        },
        |p| p.grids[1].size = [3, 2],
        |p| p.grids[0].levels = usize::MAX,
        |p| p.grids[0].region.block = 7,
        |p| p.layers = 4,
        |p| p.grids[1].creases.clear(),
        |p| p.grids[1].bottom.of = SheetSource::Horizon(2),
        |p| (p.grids[0].size, p.grids[0].levels) = ([1, 4], 3),
    ];
    for (n, damage) in damages.into_iter().enumerate() {
        let mut made = parameterization();
        damage(&mut made);
        keep_grids(root, "aa", &made, &Progress::silent());
        assert!(load_grids(root, "aa").is_none(), "{n}");
    }
}

#[test]
fn what_is_kept_comes_back_and_what_is_damaged_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let (root, wanted) = (folder.path(), parameterization());
    keep_grids(root, "aa", &wanted, &Progress::silent());
    let kept = load_grids(root, "aa").unwrap();
    assert_eq!((kept.size, kept.layers, kept.blocks), (wanted.size, wanted.layers, wanted.blocks));
    assert_eq!(kept.grids, wanted.grids);
    assert!(load_grids(root, "bb").is_none());
    let path = GRIDS.path(root, "aa");
    let whole = fs::read(&path).unwrap();
    for at in [0, 9, 40, whole.len() / 2, whole.len() - 1] {
        let mut damaged = whole.clone();
        damaged[at] ^= 1;
        fs::write(&path, &damaged).unwrap();
        assert!(load_grids(root, "aa").is_none(), "byte {at}");
        fs::write(&path, &whole[..at]).unwrap();
        assert!(load_grids(root, "aa").is_none(), "cut at {at}");
    }
}

#[test]
fn only_the_latest_few_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    for n in 0..KEPT + 3 {
        let key = format!("{n}");
        keep_grids(folder.path(), &key, &parameterization(), &Progress::silent());
        // Times of files may be as coarse as two seconds; a test does not wait for them.
        let made = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000 + 10 * n as u64);
        File::options().write(true).open(GRIDS.path(folder.path(), &key)).unwrap().set_modified(made).unwrap();
    }
    assert_eq!(fs::read_dir(folder.path().join(storage::DERIVED)).unwrap().count(), KEPT);
    for n in 0..KEPT + 3 {
        assert_eq!(load_grids(folder.path(), &format!("{n}")).is_some(), n >= 3, "{n}");
    }
}

#[test]
fn the_key_sees_geometry_and_settings_and_no_layer_names() {
    let geometry = survey::SurveyGeometry::regular([4, 5, 6], 25.0, 4.0, survey::VerticalUnit::Milliseconds);
    let document = Document::empty(Some(geometry));
    let key =
        |document: &Document| parameterization_key(document, &ModelSettings::default(), &ParamSettings::default());
    let mut faster = document.clone();
    faster.geometry.as_mut().unwrap().velocity_m_s = 3000.0;
    assert_ne!(key(&document), key(&faster));
    let mut named = document.clone();
    named.layer_names = vec!["Rock".into()];
    assert_eq!(key(&document), key(&named));
    let settings = ParamSettings { level_spacing: 7.0, ..ParamSettings::default() };
    assert_ne!(key(&document), parameterization_key(&document, &ModelSettings::default(), &settings));
}
