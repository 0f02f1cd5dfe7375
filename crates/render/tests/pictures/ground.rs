//! The march to the ground beside short steps that evaluate the model itself, and a translucent ground in closed form.

use crate::block::Block;
use crate::media::draw;
use glam::Vec3;
use model::{ModelSettings, StructuralModel};
use render::ground::{Relief, is_air};
use render::visible::Ray;
use render::{Background, Camera, Ground, Outlines, Scene, VoxelBox};
use survey::horizon::Horizon;
use survey::stratigraphy::{Contact, StratigraphicHorizon};
use survey::{Progress, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use synth::shapes::Diapir;
use synth::{SynthSettings, Synthetic};
use ttf::{Colour, TextureLibrary, TransferFunctions};

#[test]
fn it_agrees_with_walking() {
    let quiet = Progress::silent();
    let settings = SynthSettings { size: [40, 36, 48], ..SynthSettings::default() };
    let s = Synthetic::generate(&settings, &quiet).unwrap();
    let settings = ModelSettings::default();
    let model =
        StructuralModel::build(&s.geometry, &s.stratigraphy, &s.horizons, &s.faults, &settings, &quiet).unwrap();
    agrees_with_walking(&s.geometry, &model);
}

/// A salt dome that stands out of flat ground and overhangs it.
#[test]
fn it_agrees_with_walking_around_an_overhang() {
    let geometry = SurveyGeometry::regular([41, 33, 41], 25.0, 20.0, VerticalUnit::Metres);
    let mut flat = ClosedForm::flat(&geometry, &[22.0, 30.0]);
    flat.horizons.push(Horizon::of_surface("salt", Diapir::fitting(&geometry).mesh(&geometry, 48)));
    flat.stratigraphy.horizons.push(StratigraphicHorizon { name: "salt".into(), contact: Contact::Intrusive });
    let (settings, quiet) = (ModelSettings::default(), Progress::silent());
    let model = StructuralModel::build(&geometry, &flat.stratigraphy, &flat.horizons, &[], &settings, &quiet);
    agrees_with_walking(&geometry, &model.unwrap());
}

/// Compares the march with short steps along rays that evaluate the model itself, and layers with the rock that is met.
fn agrees_with_walking(geometry: &SurveyGeometry, model: &StructuralModel) {
    let relief = Relief::new(&Ground::default(), &Scene::default(), geometry, model);
    let whole = VoxelBox::of_size(geometry.size());
    let mut other = 0;
    let (mut hits, mut far) = (0, 0);
    for n in 0..1600 {
        let turn = n as f32 * 0.7;
        let direction = Vec3::new(turn.cos(), turn.sin(), 0.15 + 0.9 * (n % 7) as f32 / 7.0).normalize();
        let through = whole.low().as_vec3().lerp(whole.high().as_vec3(), (n % 23) as f32 / 23.0);
        let from = Vec3::new(through.x, through.y, 0.0);
        let ray = Ray { origin: from, direction };
        if is_air(model, from) {
            let inside = |t: f32| whole.high().as_vec3().cmpge(ray.at(t)).all() && ray.at(t).cmpge(Vec3::ZERO).all();
            let end = (0..).map(|s| s as f32 * 0.01).find(|t| !inside(*t)).unwrap();
            let walked = (0..(end * 50.0) as usize).map(|s| s as f32 * 0.02).find(|t| !is_air(model, ray.at(*t)));
            let hit = relief.march(model, &ray, 0.0, end);
            let found = hit.map(|hit| hit.t);
            hits += usize::from(walked.is_some());
            // A ray may miss rock that is thinner than the shortest step.
            far += usize::from((walked.unwrap_or(end) - found.unwrap_or(end)).abs() > 0.1);
            if let (Some(hit), Some(t)) = (hit, walked) {
                other += usize::from(model.region_at(ray.at(t + 0.04)).layer != hit.region.layer);
            }
        }
    }
    assert!(hits > 100, "{hits}");
    assert!(far * 100 <= hits, "{far} of {hits}");
    assert!(other * 100 <= 2 * hits, "{other} of {hits} have another layer");
}

#[test]
fn ground_lets_as_much_light_through_as_its_opacity_says() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 25.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[10.0, 27.0]);
    let block = Block::of(&closed, &TransferFunctions::default(), &TextureLibrary::builtin().unwrap());
    let with = |opacity: f32| Scene {
        camera: Camera { elevation_deg: 90.0, ..Camera::default() },
        ground: Some(Ground { opacity, ..Ground::default() }),
        outlines: Outlines::none(),
        background: Background::Colour(Colour::BLACK),
        size_px: [20, 16],
        samples: 1,
        ..Scene::default()
    };
    let at = |opacity: f32| {
        let pixel = draw(&with(opacity), &block.inputs(&[])).get_pixel(10, 8).0;
        f64::from(ttf::linear_from_srgb(f32::from(pixel[1]) / 255.0))
    };
    // In front of a black background the remaining light is the fraction given by the opacity.
    let (opaque, half, none) = (at(1.0), at(0.5), at(0.0));
    assert!(opaque > 0.05 && (half - 0.5 * opaque).abs() < 0.01 && none == 0.0, "{opaque} {half} {none}");
}
