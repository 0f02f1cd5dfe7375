//! i, j, k that another program computed: `parameterize --from`.

use crate::program::{project, run_in};
use glam::Vec3;
use std::fs;
use std::path::Path;
use store::{ParameterizationVolumes, StoredParameterization, write_parameterization};
use survey::Progress;

fn arrays(at: &Path, file: &str) -> ParameterizationVolumes {
    StoredParameterization::open(&at.join(file)).unwrap().read(&Progress::silent()).unwrap()
}

/// What a program with another idea of flat space writes: the project's arrays, sheared, without a header of ours.
fn write_sheared(at: &Path, change: impl Fn(&mut ParameterizationVolumes)) -> ParameterizationVolumes {
    run_in(at, "parameterize p.petro").done();
    let mut volumes = arrays(at, "p.petro/derived/parameterization.zarr");
    let k = volumes.k.samples().to_vec();
    volumes.i.samples_mut().iter_mut().zip(k).for_each(|(i, k)| *i += 0.15 * k);
    change(&mut volumes);
    write_parameterization(&at.join("other.zarr"), &volumes, "", &Progress::silent()).unwrap();
    fs::write(at.join("other.zarr/zarr.json"), r#"{"zarr_format": 3, "node_type": "group", "attributes": {}}"#)
        .unwrap();
    volumes
}

fn picture(at: &Path, name: &str) -> Vec<u8> {
    run_in(at, &format!("render p.petro {name} --size 96x72 --samples 1 --device cpu")).done();
    fs::read(at.join(name)).unwrap()
}

#[test]
fn another_map_is_drawn_kept_and_given_up_again() {
    let folder = project();
    let at = folder.path();
    let wanted = write_sheared(at, |_| ());
    let before = picture(at, "before.png");
    let told = run_in(at, "parameterize p.petro --from other.zarr").done().stdout;
    assert!(told.contains("i, j, k of other.zarr: 100.0 % of its samples lie in the same layer"), "{told}");
    // The arrays of the project are now those of the file.
    let found = arrays(at, "p.petro/derived/parameterization.zarr");
    let off = |a: &[f32], b: &[f32]| {
        let mut errors: Vec<f32> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
        errors.sort_by(f32::total_cmp);
        errors[errors.len() * 99 / 100]
    };
    let [i, j, k] = [(&found.i, &wanted.i), (&found.j, &wanted.j), (&found.k, &wanted.k)]
        .map(|(a, b)| off(a.samples(), b.samples()));
    assert!(i < 0.01 && j < 0.01 && k < 0.02, "{}", Vec3::new(i, j, k));
    let after = picture(at, "after.png");
    assert_ne!(after, before, "patterns lean");
    // It is the project's own now: neither the file nor what was computed is needed any more.
    fs::remove_dir_all(at.join("other.zarr")).unwrap();
    fs::remove_dir_all(at.join("p.petro/derived")).unwrap();
    assert!(picture(at, "again.png") == after);
    run_in(at, "check p.petro").done();
    let info = run_in(at, "info p.petro --json").done().json();
    assert_eq!(info["parameterization"], "other", "{info}");
    run_in(at, "parameterize p.petro --computed").done();
    assert!(picture(at, "computed.png") == before);
    run_in(at, "undo p.petro").done();
    assert!(picture(at, "undone.png") == after);
}

#[test]
fn what_is_no_map_of_these_layers_changes_nothing() {
    let folder = project();
    let at = folder.path();
    let refused = |what: &[&str]| {
        let before = fs::read(at.join("p.petro/project.toml")).unwrap();
        run_in(at, "parameterize p.petro --from other.zarr").failed(what);
        assert_eq!(fs::read(at.join("p.petro/project.toml")).unwrap(), before);
        assert!(!at.join("p.petro/parameterizations/other.zarr").exists());
    };
    refused(&["other.zarr"]);
    write_sheared(at, |volumes| volumes.layer.samples_mut().iter_mut().for_each(|layer| *layer = 5 - *layer));
    refused(&["another layer", "counted from the deepest", "--computed"]);
    write_sheared(at, |volumes| volumes.j.samples_mut().fill(f32::NAN));
    refused(&["no values in layer 0"]);
    write_sheared(at, |_| ());
    fs::remove_dir_all(at.join("other.zarr/layer")).unwrap();
    refused(&["layer"]);
    write_sheared(at, |_| ());
    let shard = walk(&at.join("other.zarr/k"));
    let mut damaged = fs::read(&shard).unwrap();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 0x55;
    fs::write(&shard, damaged).unwrap();
    refused(&["k"]);
}

/// The first file of data in a folder.
fn walk(folder: &Path) -> std::path::PathBuf {
    let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    let data = names.into_iter().find(|path| !path.ends_with("zarr.json")).unwrap();
    if data.is_dir() { walk(&data) } else { data }
}
