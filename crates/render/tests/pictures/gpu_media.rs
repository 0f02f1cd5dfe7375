//! The GPU renders media as the CPU reference does: at most 2/255 apart off the edges.

use crate::block::Block;
use crate::compare::compare;
use crate::media::{medium, part};
use render::media::{Colouring, LayerOpacity, MediumColour, Paint, white_ramp};
use render::{
    Background, Camera, CandidateVolume, DrawnWell, FaceData, Faces, Ground, Interleaved, Isosurface, IsosurfaceSource,
    Media, Medium, NamedVolume, Occlusion, Outlines, Phong, PickedHorizon, Projection, Renderer, Samples, Scene, Scope,
    Shading, VoxelBox,
};
use survey::Progress;
use synth::{SynthSettings, Synthetic};
use ttf::{
    Colour, ColourMap, LayerStyle, LayerTtf, RawColour, RgbaFunction, RgbaStop, TextureLibrary, TransferFunctions,
    symmetric_clip,
};

/// Distances to some horizons of the synthetic survey, as an extraction would give them.
struct MadeCandidates {
    distance: Vec<u8>,
    leaf: Vec<u32>,
}

const STEP: f32 = 0.04;

fn candidates_of(block: &Block) -> MadeCandidates {
    let [nx, ny, nz] = block.geometry.size();
    let mut made = MadeCandidates { distance: vec![255; nx * ny * nz], leaf: vec![0; nx * ny * nz] };
    for n in 0..nx * ny * nz {
        let p = glam::Vec3::new((n / (ny * nz)) as f32, (n / nz % ny) as f32, (n % nz) as f32);
        let fault_block = block.model.block_at(p);
        for h in 0..block.model.stratigraphy().horizons.len() {
            let distance = (block.model.horizon_z(h, fault_block, p.x, p.y) - p.z).abs();
            let steps = (distance / STEP) as u32;
            if steps < u32::from(made.distance[n]) {
                made.distance[n] = steps as u8;
                made.leaf[n] = 1 + 10 * h as u32 + u32::from(fault_block);
            }
        }
    }
    made
}

/// The media from which scenes are composed.
struct Parts {
    base: Scene,
    ramp: Medium,
    colours: Medium,
    impedance: Medium,
    horizons: Vec<PickedHorizon>,
}

fn picked(first: u32, colour: Colour, emission: f32) -> PickedHorizon {
    PickedHorizon {
        name: None,
        leaves: (first..first + 10).collect(),
        colour,
        colouring: Colouring::Own,
        opacity: 0.9,
        thickness: 1.0,
        emission,
        paint: None,
    }
}

fn parts(base: &Scene, clip: f32) -> Parts {
    let ramp = medium("seismic", white_ramp(clip, 0.1));
    let colours = Medium {
        layers: LayerOpacity::Followed,
        ..medium("seismic", {
            let mut function = RgbaFunction::centred(ColourMap::CoolWarm, clip);
            function.stops.iter_mut().for_each(|stop| stop.opacity = 0.15 + 0.5 * (stop.at - 0.5).abs());
            function
        })
    };
    let impedance = {
        let stop = |at: f32, opacity: f32| RgbaStop { at, colour: Colour::new(250, 120, 40), opacity };
        medium(
            "impedance",
            RgbaFunction { domain: [2000.0, 9000.0], stops: vec![stop(0.0, 0.0), stop(0.3, 0.05), stop(1.0, 0.3)] },
        )
    };
    let painted = PickedHorizon {
        paint: Some(Paint {
            volume: "impedance".into(),
            function: RgbaFunction::over(ColourMap::Strata, [2000.0, 9000.0]),
        }),
        ..picked(21, Colour::WHITE, 0.0)
    };
    let horizons = vec![picked(1, Colour::new(240, 60, 150), 0.0), picked(11, Colour::new(250, 200, 30), 1.5), painted];
    Parts { base: base.clone(), ramp, colours, impedance, horizons }
}

/// Scenes of volumes without cut-outs, and of candidates on faces.
fn volume_scenes(parts: &Parts, cut: VoxelBox, clip: f32) -> Vec<(&'static str, Scene)> {
    let Parts { base, ramp, impedance, horizons, .. } = parts;
    let occlusion = Shading::Occlusion(Occlusion::default());
    let perspective = Camera {
        projection: Projection::Perspective { fov_deg: 45.0 },
        azimuth_deg: Some(130.0),
        elevation_deg: 40.0,
        ..Camera::default()
    };
    let none =
        |surroundings: Vec<Medium>, shading| Media { faces: Faces::None, surroundings, shading, ..Media::default() };
    let clear = Scene { background: Background::Colour(Colour::new(40, 50, 60)), ..base.clone() };
    let with = |media: Media| Scene { media, ..clear.clone() };
    let by_leaf = PickedHorizon { leaves: Vec::new(), colouring: Colouring::ByLeaf, ..picked(1, Colour::WHITE, 0.0) };
    vec![
        ("leaves on faces", Scene { face_data: FaceData::Leaves, ..clear.clone() }),
        ("distances on faces", Scene { face_data: FaceData::Distance, cut_outs: vec![cut], ..clear.clone() }),
        ("leaves", with(Media { horizons: vec![by_leaf], ..none(Vec::new(), occlusion) })),
        ("unshaded", with(none(vec![ramp.clone(), impedance.clone()], Shading::Unshaded))),
        ("phong", Scene { camera: perspective, ..with(none(vec![ramp.clone()], Shading::Phong(Phong::default()))) }),
        ("occlusion", with(none(vec![ramp.clone()], occlusion))),
        ("occlusion in perspective", Scene { camera: perspective, ..with(none(vec![ramp.clone()], occlusion)) }),
        ("horizons", with(Media { horizons: horizons.clone(), ..none(vec![ramp.clone()], occlusion) })),
        (
            "near",
            with(Media {
                horizons: horizons.clone(),
                scope: Scope::NearHorizons,
                reach: 3.0,
                ..none(vec![ramp.clone()], occlusion)
            }),
        ),
        ("isosurfaces", {
            let surface = |of: IsosurfaceSource, value: f32, opacity: f32| Isosurface {
                of,
                value,
                colour: Colour::new(230, 180, 90),
                opacity,
                thickness: 1.0,
            };
            let surfaces = vec![
                surface(IsosurfaceSource::Volume("seismic".into()), 0.4 * clip, 0.5),
                surface(IsosurfaceSource::Depth, 2.5, 1.0),
                surface(IsosurfaceSource::Volume("impedance".into()), 5000.0, 1.0),
            ];
            let shading = Shading::Phong(Phong::default());
            with(Media { isosurfaces: surfaces, samples_per_voxel: 4.0, ..none(vec![ramp.clone()], shading) })
        }),
        ("interleaved", {
            let both = Interleaved { stripes: 3, ..Interleaved::default() };
            with(none(vec![ramp.clone()], Shading::Interleaved(both)))
        }),
    ]
}

/// Scenes of media in cut-outs and around them.
fn cut_out_scenes(parts: &Parts, cut: VoxelBox) -> Vec<(&'static str, Scene)> {
    let Parts { base, colours, impedance, horizons, .. } = parts;
    let occlusion = Shading::Occlusion(Occlusion::default());
    let cut_outs = vec![cut];
    vec![
        (
            "extruding",
            Scene {
                cut_outs: cut_outs.clone(),
                ground: Some(Ground::default()),
                media: Media {
                    cut_outs: vec![colours.clone(), Medium { colour: MediumColour::Layers, ..colours.clone() }],
                    ..Media::default()
                },
                ..base.clone()
            },
        ),
        (
            "ground that lets light through",
            Scene {
                cut_outs: cut_outs.clone(),
                ground: Some(Ground { opacity: 0.4, ..Ground::default() }),
                media: Media {
                    faces: Faces::CutOuts,
                    surroundings: vec![impedance.clone()],
                    cut_outs: vec![colours.clone()],
                    ..Media::default()
                },
                ..base.clone()
            },
        ),
        (
            "surroundings",
            Scene {
                cut_outs: cut_outs.clone(),
                media: Media {
                    faces: Faces::CutOuts,
                    surroundings: vec![impedance.clone()],
                    cut_outs: vec![colours.clone()],
                    shading: occlusion,
                    ..Media::default()
                },
                ..base.clone()
            },
        ),
        (
            "one medium in a cut-out",
            Scene {
                cut_outs: cut_outs.clone(),
                media: Media { cut_outs: vec![colours.clone()], ..Media::default() },
                ..base.clone()
            },
        ),
        (
            "horizons in a cut-out",
            Scene {
                cut_outs,
                media: Media {
                    cut_outs: vec![colours.clone()],
                    horizons: horizons.clone(),
                    shading: occlusion,
                    ..Media::default()
                },
                ..base.clone()
            },
        ),
    ]
}

fn scenes(base: &Scene, cut: VoxelBox, clip: f32) -> Vec<(&'static str, Scene)> {
    let parts = parts(base, clip);
    [volume_scenes(&parts, cut, clip), cut_out_scenes(&parts, cut)].concat()
}

#[test]
fn gpu_and_cpu_render_media_alike() {
    if std::env::var("PETROGLYPH_GPU_TESTS").is_ok_and(|value| value == "skip") {
        eprintln!("skipped: PETROGLYPH_GPU_TESTS=skip");
        return;
    }
    let quiet = Progress::silent();
    let settings = SynthSettings { size: [36, 32, 48], ..SynthSettings::default() };
    let synthetic = Synthetic::generate(&settings, &quiet).unwrap();
    let clip = symmetric_clip(synthetic.seismic.samples(), 0.99).unwrap();
    let names = synthetic.stratigraphy.layer_names_bottom_up();
    let colours = [Colour::new(190, 160, 120), Colour::new(120, 160, 90), Colour::new(230, 220, 150)];
    let styles = names.iter().enumerate().map(|(n, name)| {
        let mut style = LayerStyle::plain(name, colours[n % 3]);
        style.opacity = [0.0, 1.0, 0.6][n % 3];
        if n % 3 == 1 {
            style.intervals = vec![part([0.0, 0.4], Colour::new(30, 60, 160), 1.0), part([0.4, 1.0], colours[1], 1.0)];
        }
        style
    });
    let functions = TransferFunctions {
        raw: Some(RawColour::new("seismic", RgbaFunction::centred(ColourMap::Grey, clip))),
        layers: LayerTtf { styles: styles.collect() },
        ..TransferFunctions::default()
    };
    let library = TextureLibrary::builtin().unwrap();
    let (horizons, faults) = (&synthetic.horizons, &synthetic.faults);
    let block = Block::new(&synthetic.geometry, &synthetic.stratigraphy, horizons, faults, &functions, &library);
    let covers = VoxelBox {
        min: synthetic.attribute.origin.to_array(),
        max: (synthetic.attribute.origin + synthetic.attribute.extent).to_array(),
    };
    let volumes = [
        NamedVolume::whole("seismic", &synthetic.seismic),
        NamedVolume { name: "impedance", volume: Samples::Whole(&synthetic.attribute.volume), covers },
    ];
    let made = candidates_of(&block);
    // Leaves of one horizon in two groups, one of them not shown.
    let groups: Vec<u32> = (0..64).map(|leaf| if leaf == 12 { 0 } else { leaf / 2 }).collect();
    let path =
        [glam::DVec3::new(20.0, 14.0, -5.0), glam::DVec3::new(22.0, 13.0, 20.0), glam::DVec3::new(27.0, 10.0, 44.0)];
    let wells = [DrawnWell { name: "A-1", colour: None, path: &path, tops: &path[1..2] }];
    let mut inputs = block.inputs(&volumes);
    inputs.wells = &wells;
    inputs.candidates = Some(CandidateVolume {
        size: synthetic.geometry.size(),
        distance: &made.distance,
        leaf: &made.leaf,
        voxels_per_step: STEP,
        groups: Some(&groups),
    });
    let whole = VoxelBox::of_size(synthetic.geometry.size());
    let base =
        Scene { size_px: [120, 96], samples: 2, exaggeration: 1.5, outlines: Outlines::none(), ..Scene::default() };
    let nearest = base.view(&synthetic.geometry).nearest_corner(&whole);
    let mut renderer = Renderer::headless().expect("a Vulkan driver, or PETROGLYPH_GPU_TESTS=skip");
    let mut earlier: Vec<image::RgbaImage> = Vec::new();
    let mut wrong = Vec::new();
    for (name, scene) in scenes(&base, whole.corner_cut(nearest, [0.6, 0.6]), clip) {
        let reference = render::reference::render(&scene, &inputs, &quiet).unwrap();
        let picture = renderer.render(&scene, &inputs, &quiet).unwrap();
        if let Ok(folder) = std::env::var("PETROGLYPH_KEEP_PICTURES") {
            reference.save(format!("{folder}/{name}-cpu.png")).unwrap();
            picture.save(format!("{folder}/{name}-gpu.png")).unwrap();
        }
        let found = compare(&reference, &picture).unwrap();
        println!("{name}: {found:?}");
        if !found.agrees() {
            wrong.push(name);
        }
        for other in &earlier {
            assert!(!compare(&reference, other).unwrap().agrees(), "{name} is like another");
        }
        earlier.push(picture);
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn a_lost_device_is_opened_anew() {
    if std::env::var("PETROGLYPH_GPU_TESTS").is_ok_and(|value| value == "skip") {
        eprintln!("skipped: PETROGLYPH_GPU_TESTS=skip");
        return;
    }
    let geometry = survey::SurveyGeometry::regular([9; 3], 10.0, 10.0, survey::VerticalUnit::Metres);
    let volume = survey::Volume::filled([9; 3], 0.7f32);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = render::Inputs { data_key: 1, ..render::Inputs::raw(&geometry, &volumes) };
    let media = Media { faces: Faces::None, surroundings: vec![medium("v", white_ramp(1.0, 0.0))], ..Media::default() };
    let scene = Scene { size_px: [40, 30], samples: 1, media, ..Scene::default() };
    let mut renderer = Renderer::headless().expect("a Vulkan driver, or PETROGLYPH_GPU_TESTS=skip");
    let quiet = Progress::silent();
    let before = renderer.render(&scene, &inputs, &quiet).unwrap();
    for _ in 0..2 {
        renderer.lose_device();
        assert!(renderer.render(&scene, &inputs, &quiet).unwrap() == before);
    }
}
