//! Volume rendering as the window sets it up: one volume in the cut-outs or in the whole block, and horizons in it that
//! may give off light (P-illus 5.1, P-horiz 5).

use project::document::Document;
use project::error::ProjectError;
use project::pictures::scene::{Technique, VolumeRendering};
use render::media::Interleaved;
use render::{Faces, Ground, Medium, Occlusion, Phong, PickedHorizon, Scene, Scope, Shading};
use ttf::{Colour, RgbaFunction, RgbaStop};

/// Values up to this share of the volume's clip are transparent at first, so that only strong reflections remain.
const CLEAR_BELOW: f32 = 0.35;
/// Error of colour and opacity, as a share of their range, that is accepted when a function is drawn with fewer stops.
const TOLERANCE: f32 = 0.02;

/// Where a volume is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Nowhere.
    Nowhere,
    /// In the cut-outs, in front of the rock behind them.
    CutOuts,
    /// In the whole block, in place of the rock.
    Block,
}

/// How the volume is shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Light {
    /// Not at all.
    None,
    /// By the volume's gradients.
    Gradients,
    /// By occlusion.
    Occlusion,
    /// By gradients and by occlusion, in alternating stripes.
    Stripes,
}

impl Light {
    /// The shading of a scene.
    pub fn of(scene: &Scene) -> Self {
        match scene.media.shading {
            Shading::Unshaded => Self::None,
            Shading::Phong(_) => Self::Gradients,
            Shading::Occlusion(_) => Self::Occlusion,
            Shading::Interleaved(_) => Self::Stripes,
        }
    }

    /// The shading to begin with.
    pub fn shading(self) -> Shading {
        match self {
            Self::None => Shading::Unshaded,
            Self::Gradients => Shading::Phong(Phong::default()),
            Self::Occlusion => Shading::Occlusion(Occlusion::default()),
            Self::Stripes => Shading::Interleaved(Interleaved::default()),
        }
    }
}

/// Where a scene renders a volume.
pub fn extent(scene: &Scene) -> Extent {
    match (scene.media.faces, scene.media.cut_outs.is_empty()) {
        (Faces::None, _) => Extent::Block,
        (_, false) => Extent::CutOuts,
        (_, true) => Extent::Nowhere,
    }
}

/// The volume that is rendered.
pub fn medium(scene: &mut Scene) -> Option<&mut Medium> {
    let media = &mut scene.media;
    media.surroundings.first_mut().or(media.cut_outs.first_mut())
}

/// Renders a volume in that extent, with colours and shading to match; horizons in it stay.
///
/// # Errors
/// The project has no such volume.
pub fn set_volume(scene: &mut Scene, document: &Document, extent: Extent, volume: &str) -> Result<(), ProjectError> {
    let mut next = scene.clone();
    if next.media.faces == Faces::None {
        let usual = Scene::default();
        (next.background, next.outlines.edges) = (usual.background, usual.outlines.edges);
        next.ground = (document.horizons.len() > 1).then(Ground::default);
    }
    next.media.faces = Faces::All;
    next.media.cut_outs.clear();
    next.media.surroundings.clear();
    let technique = match extent {
        Extent::Nowhere => None,
        Extent::CutOuts => Some(Technique::Illustrate),
        Extent::Block => Some(Technique::Occlusion),
    };
    if technique.is_some() {
        let options = VolumeRendering {
            technique,
            medium: Some(volume.to_owned()),
            clear_below: CLEAR_BELOW,
            isosurfaces: Vec::new(),
            horizons: Vec::new(),
            scope: Scope::Everywhere,
        };
        options.change(&mut next, document)?;
        if let Some(medium) = medium(&mut next) {
            medium.function = with_fewer_stops(&medium.function);
        }
    }
    *scene = next;
    Ok(())
}

/// Shows or hides a horizon in the rendered volume. Shading is switched on with it: surfaces of one colour have no
/// shape without it.
pub fn show_horizon(scene: &mut Scene, name: &str, colour: Colour, is_shown: bool) {
    let media = &mut scene.media;
    media.horizons.retain(|horizon| horizon.name.as_deref() != Some(name));
    if is_shown {
        media.horizons.push(PickedHorizon { name: Some(name.to_owned()), ..PickedHorizon::of(Vec::new(), colour) });
        if media.shading == Shading::Unshaded {
            media.shading = Light::Occlusion.shading();
        }
    } else if media.horizons.is_empty() {
        media.scope = Scope::Everywhere;
    }
}

/// The same function within [`TOLERANCE`], with as few stops as possible (the line simplification of Douglas and
/// Peucker).
fn with_fewer_stops(function: &RgbaFunction) -> RgbaFunction {
    let stops = &function.stops;
    let mut kept = vec![false; stops.len()];
    let mut parts = vec![(0, stops.len().saturating_sub(1))];
    while let Some((first, last)) = parts.pop() {
        let (Some(low), Some(high)) = (stops.get(first), stops.get(last)) else { continue };
        (kept[first], kept[last]) = (true, true);
        let error = |n: usize| {
            let share = (stops[n].at - low.at) / (high.at - low.at).max(f32::MIN_POSITIVE);
            let (from, to, here) = (channels(low), channels(high), channels(&stops[n]));
            (0..4).map(|c| (from[c] + (to[c] - from[c]) * share - here[c]).abs()).fold(0.0, f32::max)
        };
        let worst = (first + 1..last).max_by(|a, b| error(*a).total_cmp(&error(*b)));
        if let Some(worst) = worst.filter(|n| error(*n) > TOLERANCE) {
            parts.extend([(first, worst), (worst, last)]);
        }
    }
    let stops = stops.iter().zip(kept).filter_map(|(stop, kept)| kept.then_some(*stop)).collect();
    RgbaFunction { domain: function.domain, stops }
}

fn channels(stop: &RgbaStop) -> [f32; 4] {
    let [r, g, b] = stop.colour.to_unit();
    [r, g, b, stop.opacity]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ttf::ColourMap;

    #[test]
    fn fewer_stops_make_the_same_function() {
        let stop = |n: usize| {
            let at = n as f32 / 32.0;
            let colour = Colour::new((at * 200.0) as u8, 40, 255 - (at * 100.0) as u8);
            RgbaStop { at, colour, opacity: ((at - 0.5).abs() * 3.0 - 0.5).clamp(0.0, 1.0) }
        };
        let function = RgbaFunction { domain: [-7.0, 9.0], stops: (0..=32).map(stop).collect() };
        let fewer = with_fewer_stops(&function);
        assert!((2..=8).contains(&fewer.stops.len()), "{}", fewer.stops.len());
        for n in 0..=64 {
            let value = -7.0 + 16.0 * n as f32 / 64.0;
            for (one, other) in fewer.evaluate(value).into_iter().zip(function.evaluate(value)) {
                assert!((one - other).abs() <= 1.5 * TOLERANCE, "{value}: {one} and {other}");
            }
        }
        let line = RgbaFunction::over(ColourMap::Grey, [0.0, 1.0]);
        assert_eq!(with_fewer_stops(&line).stops.len(), 2);
    }

    #[test]
    fn a_horizon_is_lit_and_taken_out_again() {
        let mut scene = Scene::default();
        show_horizon(&mut scene, "Top", Colour::WHITE, true);
        assert_eq!(scene.media.horizons[0].name.as_deref(), Some("Top"));
        assert_eq!(Light::of(&scene), Light::Occlusion);
        scene.media.scope = Scope::NearHorizons;
        show_horizon(&mut scene, "Top", Colour::WHITE, false);
        assert!(scene.media.horizons.is_empty() && scene.media.scope == Scope::Everywhere);
    }
}
