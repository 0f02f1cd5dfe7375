//! A picture from the samples on faces alone is that from all samples, pixel by pixel.

use crate::Project;
use crate::command::{AddHorizon, Age, Command, ImportVolume};
use crate::document::Polarity;
use crate::pictures::figures::section_places;
use crate::pictures::load::{Extent, Request, load};
use crate::pictures::volumes::LoadedSamples;
use crate::pictures::{Device, Painter, scene};
use figure::cut::{FenceCut, SectionCut, SectionKind, SectionSource};
use figure::{FencePart, Figure, Part, SectionPart};
use files::{Format, ImportOptions};
use render::{CutShape, FaceData, Ground, Scene, Side, VoxelBox};
use std::path::Path;
use store::VolumeInfo;
use survey::{Contact, Progress};
use synth::{SynthSettings, Synthetic};

/// A synthetic survey with dead traces, two horizons of it, and a fault between them.
fn project(folder: &Path) -> Project {
    let quiet = Progress::silent();
    let size = [86, 74, 100];
    let made = Synthetic::generate(&SynthSettings { size, ..SynthSettings::default() }, &quiet).unwrap();
    let mut volume = made.seismic.clone();
    volume.set_live(Some((0..size[0] * size[1]).map(|n| n % 97 != 5).collect())).unwrap();
    let stored = folder.join("seismic.zarr");
    store::write_volume(&stored, &volume, &VolumeInfo::of(made.geometry.clone()), &quiet).unwrap();
    let root = folder.join("p.petro");
    let mut new = Project::create(&root, None).unwrap();
    let import = ImportVolume {
        path: stored,
        name: Some("seismic".into()),
        polarity: Polarity::default(),
        options: Default::default(),
        memory_bytes: None,
        moved: false,
        origin: None,
    };
    new.project().apply(&Command::Import(import), &quiet).unwrap();
    for horizon in made.horizons.iter().take(2) {
        let path = folder.join(format!("{}.csv", horizon.name));
        files::write_horizon(&path, horizon, &made.geometry, Format::Csv).unwrap();
        let (name, options) = (horizon.name.clone(), ImportOptions::default());
        let add = AddHorizon { path, name, contact: Contact::Conformable, age: Age::ByDepth, options };
        new.project().apply(&Command::AddHorizon(add), &quiet).unwrap();
    }
    new.publish().unwrap();
    Project::open(&root).unwrap()
}

/// Raw data with and without rock and ground, and cut-outs of every kind.
fn scenes(project: &Project) -> Vec<Scene> {
    let base = Scene {
        size_px: [240, 200],
        samples: 2,
        blend: 0.6,
        ground: Some(Ground::default()),
        cut_outs: vec![VoxelBox { min: [50.5, 0.0, 0.0], max: [85.0, 30.25, 70.5] }],
        ..scene::default_view(project.document()).unwrap()
    };
    let fence = CutShape::Fence {
        fence: vec![[20.0, 0.0], [40.0, 33.0], [85.0, 50.0]],
        side: Side::Right,
        smooth: true,
        depth: None,
    };
    let plane = CutShape::Plane { through: [43.0, 37.0, 40.0], normal: [0.3, 0.2, -1.0] };
    let roaming = VoxelBox { min: [7.5, 3.0, 11.25], max: [80.0, 70.0, 90.0] };
    vec![
        Scene { ground: None, blend: 1.0, ..base.clone() },
        Scene { cut_outs: Vec::new(), cut_shapes: vec![fence], ..base.clone() },
        Scene { cut_outs: Vec::new(), cut_shapes: vec![plane], ground: None, ..base.clone() },
        Scene { roaming_box: Some(roaming), cut_outs: Vec::new(), blend: 1.0, ..base.clone() },
        base,
    ]
}

#[test]
fn the_samples_on_faces_make_the_picture_of_all_samples() {
    let folder = tempfile::tempdir().unwrap();
    let (project, quiet) = (project(folder.path()), Progress::silent());
    let mut painter = Painter::new(Device::Cpu, &quiet).unwrap();
    for (n, scene) in scenes(&project).into_iter().enumerate() {
        let mut draw = |bytes: u64, extent: Extent| {
            let request = Request { small_bytes: 0, ..Request::new(&scene).of(extent).within(bytes) };
            let loaded = load(project.facts(), &request, &quiet).unwrap();
            (painter.draw(&scene, &loaded, &quiet).unwrap().0, loaded)
        };
        let whole = draw(1 << 30, Extent::Whole).0;
        let (sparse, loaded) = draw(1 << 30, Extent::Faces);
        assert!(!loaded.has_missed(), "scene {n}");
        assert!(matches!(*loaded.volumes[0].samples, LoadedSamples::Sparse(_)), "scene {n}");
        assert!(whole == sparse, "scene {n}");
        // The same of a coarser level, where the cells of the finest are too many.
        let coarse = draw(400 << 10, Extent::Whole).0;
        let (sparse, loaded) = draw(445 << 10, Extent::Faces);
        assert_eq!((loaded.volumes[0].named().volume.size(), loaded.has_missed()), ([43, 37, 50], false), "scene {n}");
        assert!(sparse == coarse, "scene {n}");
    }
}

#[test]
fn a_section_takes_no_samples_but_those_on_its_plane() {
    let folder = tempfile::tempdir().unwrap();
    let (project, quiet) = (project(folder.path()), Progress::silent());
    let frame = project.document().frame().unwrap().clone();
    let section = |kind, at| {
        Part::Section(SectionPart {
            kind,
            at,
            show: FaceData::Rock,
            blend: Some(1.0),
            zoom: Default::default(),
            proportions: None,
        })
    };
    let corners = vec![[105.0, 505.0], [160.0, 520.0], [180.0, 570.0]];
    let fence = Part::Fence(FencePart { corners: corners.clone(), show: FaceData::Rock, blend: Some(1.0) });
    let parts = vec![
        section(SectionKind::Inline, frame.inlines.number_at(41.0)),
        section(SectionKind::Crossline, frame.crosslines.number_at(8.0)),
        section(SectionKind::Slice, frame.vertical.value_at(63.0)),
        fence,
    ];
    for part in parts {
        let figure = Figure { parts: vec![part.clone()], ..Figure::default() };
        let places = section_places(&figure, &frame);
        let image = |places| {
            let scene = Scene::default();
            let request = Request { small_bytes: 0, ..Request::new(&scene).of(Extent::Data(places)) };
            let loaded = load(project.facts(), &request, &quiet).unwrap();
            let volumes = loaded.named_volumes();
            let source = SectionSource { data: loaded.inputs(&volumes, &[]), raw: loaded.raw.as_ref() };
            let image = match &part {
                Part::Section(part) => {
                    let at = [
                        frame.inlines.index_of(part.at),
                        frame.crosslines.index_of(part.at),
                        frame.vertical.index_of(part.at),
                    ];
                    SectionCut::new(&source, part.kind, at[part.kind.axis()].round(), FaceData::Rock).image
                }
                _ => {
                    let corners: Vec<_> = corners.iter().map(|[x, y]| frame.voxel_from_lines(*x, *y)).collect();
                    FenceCut::new(&source, &corners, FaceData::Rock).image
                }
            };
            assert!(!loaded.has_missed());
            image
        };
        assert!(image(Some(&places)) == image(None), "{part:?}");
    }
}
