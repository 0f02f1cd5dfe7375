//! A bundle of rays gives the same result as each ray alone.

use super::*;
use crate::cache::Kept;
use crate::inputs::{Inputs, NamedVolume};
use crate::media::light_grid::Asked;
use crate::media::{EmptySpace, LayerOpacity, Media, Medium, MediumColour, Occlusion, Phong};
use crate::resolved_scene::ResolvedScene;
use crate::{Camera, Projection, Scene, VoxelBox};
use glam::DVec2;
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume};
use ttf::{Colour, RgbaFunction, RgbaStop};

/// A smooth volume with noise; some samples and the traces of a corner are missing.
fn volume(size: [usize; 3]) -> Volume<f32> {
    let count: usize = size.iter().product();
    let value = |n: usize| {
        let hash = (n as u32 ^ 0x5bd1_e995).wrapping_mul(0x9e37_79b1);
        let noise = (hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b) >> 20;
        let [x, y, z] = [n / (size[1] * size[2]), n / size[2] % size[1], n % size[2]];
        let smooth = (x as f32 * 0.31).sin() + (y as f32 * 0.23).cos() + (z as f32 * 0.4).sin();
        smooth * 0.3 + noise as f32 / 40_960.0
    };
    let mut volume = Volume::from_samples(size, (0..count).map(value).collect()).unwrap();
    if count > 1000 {
        volume.samples_mut()[count / 2 + 7] = f32::NAN;
        volume.samples_mut()[count / 3] = f32::INFINITY;
        let corner = |n: usize| n / size[1] < size[0] / 3 && n % size[1] < size[1] / 3;
        volume.set_live(Some((0..size[0] * size[1]).map(|n| !corner(n)).collect())).unwrap();
    }
    volume
}

fn function(colours: [Colour; 2]) -> RgbaFunction {
    let stop = |at: f32, colour: Colour, opacity: f32| RgbaStop { at, colour, opacity };
    RgbaFunction {
        domain: [-1.0, 1.0],
        stops: vec![stop(0.0, colours[0], 0.0), stop(0.5, colours[0], 0.0), stop(1.0, colours[1], 0.3)],
    }
}

/// The largest difference in colour or transmittance, and the largest opacity.
fn apart(scene: &Scene, inputs: &Inputs) -> (f32, f32) {
    let mut kept = Kept::default();
    let resolved = ResolvedScene::new(scene, inputs, &mut kept).unwrap();
    let field = resolved.field.as_ref().unwrap();
    let quiet = Progress::silent();
    let light =
        LightVolume::new(field, &resolved.view, &resolved.solid, &resolved.roaming_box, Asked::Block, &quiet).unwrap();
    let [width, height] = scene.size_px;
    let rays: Vec<(Ray, [f32; 2])> = (0..width * height)
        .map(|n| {
            let pixel = DVec2::new(f64::from(n % width), f64::from(n / width));
            // Some rays end early.
            let end = if n % 5 == 0 { 3.0 * f64::from(width) as f32 } else { f32::INFINITY };
            (Ray::from(resolved.view.ray(pixel)), [f32::MIN, end])
        })
        .collect();
    let all = gather_all(field, light.as_ref(), &resolved.solid, &rays);
    assert_eq!(all.len(), rays.len());
    let mut most = (0.0f32, 0.0f32);
    for ((ray, between), found) in rays.iter().zip(&all) {
        let alone = gather(field, light.as_ref(), &resolved.solid, ray, *between);
        let colour = (alone.colour - found.colour).abs().max_element();
        most = (
            most.0.max(colour).max((alone.transmittance - found.transmittance).abs()),
            most.1.max(1.0 - found.transmittance),
        );
    }
    most
}

#[test]
fn rays_gather_together_what_each_gathers_alone() {
    let white = [Colour::WHITE; 2];
    let two = [Colour::new(240, 30, 80), Colour::new(20, 200, 230)];
    let occlusion = Shading::Occlusion(Occlusion { max_cells: 48, ..Occlusion::default() });
    let shadings = [Shading::Unshaded, Shading::Phong(Phong::default()), occlusion];
    let samples = [37, 28, 45];
    let geometry = SurveyGeometry::regular(samples, 25.0, 25.0, VerticalUnit::Metres);
    for (n, size) in [samples, [9, 33, 20], [2, 2, 2], [1, 40, 3]].into_iter().enumerate() {
        let volume = volume(size);
        let covers = VoxelBox { min: [3.0, 0.0, 5.0], max: [30.0, 27.0, 41.5] };
        let volumes = [if n == 0 {
            NamedVolume::whole("v", &volume)
        } else {
            NamedVolume { name: "v", volume: crate::Samples::Whole(&volume), covers }
        }];
        let inputs = Inputs::raw(&geometry, &volumes);
        for (shading, colours, projection, inside, empty_space) in shadings.iter().flat_map(|shading| {
            [
                (*shading, white, Projection::Orthographic, false, EmptySpace::Skipped),
                (*shading, two, Projection::Perspective { fov_deg: 50.0 }, false, EmptySpace::Sampled),
                (*shading, two, Projection::Orthographic, true, EmptySpace::Skipped),
            ]
        }) {
            let medium = Medium {
                volume: "v".into(),
                function: function(colours),
                layers: LayerOpacity::Ignored,
                colour: MediumColour::Function,
            };
            let (cut_outs, surroundings) = if inside { (vec![medium], vec![]) } else { (vec![], vec![medium]) };
            let cuts = [[2.0, 3.0, 1.0], [14.0, 9.0, 8.0]]
                .map(|min: [f64; 3]| VoxelBox { min, max: [min[0] + 11.0, min[1] + 17.0, min[2] + 30.0] });
            let scene = Scene {
                size_px: [29, 23],
                cut_outs: cuts.to_vec(),
                camera: Camera { azimuth_deg: Some(35.0), projection, ..Camera::default() },
                media: Media { faces: Faces::None, shading, empty_space, cut_outs, surroundings, ..Media::default() },
                ..Scene::default()
            };
            let (difference, covered) = apart(&scene, &inputs);
            assert!(difference < 2e-3, "{size:?} {shading:?} {projection:?} {inside}: {difference}");
            assert!(covered > 0.2 || size[0] < 3, "{size:?} {shading:?} {projection:?} {inside}: {covered}");
        }
    }
}
