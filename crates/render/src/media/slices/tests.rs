//! The light does not depend on what is skipped or on the code path that computes it.

use super::*;
use crate::cache::Kept;
use crate::inputs::{Inputs, NamedVolume};
use crate::media::light::LightVolume;
use crate::media::light_grid::Asked;
use crate::media::{LayerOpacity, MediumColour};
use crate::media::{Media, Medium, Occlusion, Shading, white_ramp};
use crate::resolved_scene::ResolvedScene;
use crate::{Camera, Projection, Scene};
use survey::{SurveyGeometry, VerticalUnit, Volume};

#[test]
fn blurring_spreads_by_its_variance() {
    let (side, pitch) = (41, 43);
    let mut field = vec![0.0f32; pitch * pitch];
    field[21 * pitch + 21] = 1.0;
    let mut next = field.clone();
    for _ in 0..9 {
        for row in 0..side {
            blur_row(&field, &mut next[(row + 1) * pitch..], pitch, row, [0, side], 0.2);
        }
        std::mem::swap(&mut field, &mut next);
    }
    let total: f32 = field.iter().sum();
    let variance: f32 = field.iter().enumerate().map(|(n, v)| v * ((n % pitch) as f32 - 21.0).powi(2)).sum();
    assert!((total - 1.0).abs() < 1e-5 && (variance - 9.0 * 0.4).abs() < 1e-4, "{total} {variance}");
}

#[test]
fn a_part_wider_than_the_buffer_is_blurred_as_a_whole() {
    let pitch = 302;
    let field: Vec<f32> = (0..pitch * 3).map(|n| ((n * 7919) % 101) as f32).collect();
    let (mut row, mut parts) = (vec![0.0; pitch], vec![0.0; pitch]);
    blur_row(&field, &mut row, pitch, 0, [0, 300], 0.13);
    (0..300).for_each(|u| blur_row(&field, &mut parts, pitch, 0, [u, u + 1], 0.13));
    assert_eq!(row[1..301], parts[1..301]);
}

/// A block with a volume, with or without a cut-out. A second medium that is never visible selects the
/// general code path.
fn scene(projection: Projection, cut: bool, unseen: bool) -> Scene {
    let medium = |function| Medium {
        volume: "v".into(),
        function,
        layers: LayerOpacity::Ignored,
        colour: MediumColour::Function,
    };
    let mut function = white_ramp(1.0, 0.4);
    function.stops.iter_mut().for_each(|stop| stop.opacity *= 0.3);
    let mut nothing = function.clone();
    nothing.stops.iter_mut().for_each(|stop| stop.opacity = 0.0);
    let surroundings = if unseen { vec![medium(function), medium(nothing)] } else { vec![medium(function)] };
    let cut_out = VoxelBox { min: [6.0, 3.0, 2.0], max: [17.0, 20.0, 33.0] };
    Scene {
        cut_outs: if cut { vec![cut_out] } else { Vec::new() },
        camera: Camera { azimuth_deg: Some(35.0), elevation_deg: 28.0, projection, ..Camera::default() },
        media: Media {
            faces: Faces::None,
            shading: Shading::Occlusion(Occlusion { max_cells: 64, ..Occlusion::default() }),
            surroundings,
            ..Media::default()
        },
        ..Scene::default()
    }
}

#[test]
fn light_in_the_block_does_not_depend_on_windows_or_runs() {
    let size = [30, 26, 41];
    let values = (0..size.iter().product::<usize>()).map(|n| {
        let hash = (n as u32 ^ 0x5bd1_e995).wrapping_mul(0x9e37_79b1);
        let noise = ((hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b) >> 8) as f32 / (1 << 24) as f32;
        // Most bricks are empty.
        if n / 3000 % 3 == 1 { noise } else { 0.1 * noise }
    });
    let mut volume = Volume::from_samples(size, values.collect()).unwrap();
    volume.samples_mut()[4444] = f32::NAN;
    let geometry = SurveyGeometry::regular(size, 1.0, 1.0, VerticalUnit::Metres);
    let volumes = [NamedVolume::whole("v", &volume)];
    let inputs = Inputs::raw(&geometry, &volumes);
    let quiet = Progress::silent();
    for projection in [Projection::Orthographic, Projection::Perspective { fov_deg: 60.0 }] {
        for cut in [false, true] {
            let light = |unseen: bool, asked: Asked| {
                let (scene, mut kept) = (scene(projection, cut, unseen), Kept::default());
                let resolved = ResolvedScene::new(&scene, &inputs, &mut kept).unwrap();
                let field = resolved.field.as_ref().unwrap();
                assert_eq!(field.only_medium().is_none(), unseen);
                LightVolume::new(field, &resolved.view, &resolved.solid, &resolved.roaming_box, asked, &quiet)
                    .unwrap()
                    .unwrap()
            };
            let whole = light(false, Asked::Everywhere);
            let (windowed, general) = (light(false, Asked::Block), light(true, Asked::Block));
            let mut darkest = 1.0f32;
            for n in 0..20_000 {
                let place = |axis: usize, by: usize| (n * by % 1009) as f32 / 1008.0 * (size[axis] - 1) as f32;
                let p = Vec3::new(place(0, 1), place(1, 37), place(2, 411));
                let here = whole.at(p);
                assert_eq!(windowed.at(p), here, "{projection:?} {p}");
                let difference = (general.at(p) - here).abs().max_element();
                assert!(difference < 1e-3, "{projection:?} {cut} {p}: {difference}");
                darkest = darkest.min(here.x);
            }
            assert!(darkest < 0.7, "{darkest}");
        }
    }
}
