//! The faces of a scene as areas: one for each connected piece of a layer.

use super::outline::Outline;
use super::pattern::{FacePattern, Tile};
use super::visible::{HiddenParts, SeenFace, hidden_parts, seen_faces, seen_pieces};
use super::{AreaFill, PatternPart, VectorArea};
use crate::camera::View;
use crate::error::RenderError;
use crate::ground::air_layer;
use crate::outline::solid::Face;
use crate::pattern_size::Frequencies;
use crate::resolved_scene::{ResolvedInterpretation, ResolvedScene};
use glam::DVec2;
use model::Region;
use model::section::{Section, SectionPlane};
use rayon::prelude::*;
use survey::Progress;
use ttf::tables::IntervalEntry;
use ttf::{Colour, TextureLibrary};

/// The areas of all faces that are seen, and of each face what is hidden of it ([`VectorBlock::hidden`]).
///
/// [`VectorBlock::hidden`]: super::VectorBlock::hidden
pub(super) fn face_areas(
    resolved: &ResolvedScene,
    library: &TextureLibrary,
    tolerance_px: f64,
    progress: &Progress,
) -> Result<(Vec<VectorArea>, Vec<HiddenParts>), RenderError> {
    let Some(interpretation) = resolved.interpretation else { return Ok(Default::default()) };
    let tiles = tiles(resolved, library)?;
    let faces = seen_faces(&resolved.solid, &resolved.view);
    let air = resolved.relief.as_ref().map(|_| air_layer(interpretation.model));
    let section = |face: &SeenFace| Section::new(interpretation.model, &face.face.section_plane());
    let sections: Vec<Section> = faces.par_iter().map(section).collect();
    // Over a relief faces may be partly air, so that what they hide is known from their sections alone.
    let hidden = match air.filter(|_| !resolved.solid.cut_outs.is_empty()) {
        Some(air) => {
            let rock =
                faces.iter().zip(&sections).map(|(face, section)| rock_rings(&resolved.view, face, section, air));
            let rock: Vec<_> = rock.collect();
            (0..faces.len()).into_par_iter().map(|n| hidden_parts(&faces, n, &resolved.view, &rock)).collect()
        }
        None => vec![HiddenParts::new(); faces.len()],
    };
    progress.begin("pattern", faces.len() as u64);
    let mut areas = Vec::new();
    for (index, (face, section)) in faces.iter().zip(&sections).enumerate() {
        let seen = seen_pieces(&faces, index, &resolved.view, air.is_some());
        progress.step(1)?;
        if seen.as_ref().is_some_and(Vec::is_empty) {
            continue;
        }
        let plane = face.face.section_plane();
        let painter = FacePainter { resolved, interpretation, face: &face.face, plane, tiles: &tiles, tolerance_px };
        // Colours of whole layers, so that no seam shows where a fault is only continued; then what lies on them.
        let colours = section.layers.iter().map(|area| (area.layer, None, &area.rings));
        let patterns = section.polygons.iter().map(|area| (area.region.layer, Some(area.region), &area.rings));
        let all: Vec<_> = colours.chain(patterns).filter(|(layer, ..)| Some(*layer) != air).collect();
        let drawn = all.into_par_iter().flat_map_iter(|(layer, region, rings)| {
            let fills = match region {
                None => vec![(None, painter.colour(layer))],
                Some(region) => painter.intervals(region, rings),
            };
            let (outline, seen) = (painter.outline(rings), seen.clone());
            let area = move |(band, fill)| VectorArea {
                layer,
                face: index,
                rings: outline.clone(),
                seen: seen.clone(),
                band,
                fill,
            };
            fills.into_iter().map(area)
        });
        areas.extend(drawn.collect::<Vec<_>>());
        progress.check()?;
    }
    Ok((areas, hidden))
}

/// The outlines of the rock on a face, pixels: of each area that is not air its rings, holes turned against them.
fn rock_rings(view: &View, face: &SeenFace, section: &Section, air: u16) -> Vec<Vec<DVec2>> {
    let plane = face.face.section_plane();
    let rings = section.layers.iter().filter(|area| area.layer != air).flat_map(|area| &area.rings);
    rings.map(|ring| ring.iter().map(|st| view.project(plane.voxel(*st))).collect()).collect()
}

/// The drawing of each texture in use, by slot.
fn tiles(resolved: &ResolvedScene, library: &TextureLibrary) -> Result<Vec<Option<Tile>>, RenderError> {
    let tile = |index: &usize| {
        let [width, height] = library.pattern(*index).tile_mm.map(f64::from);
        let drawing = library.drawing(*index)?;
        Ok(drawing.map(|drawing| Tile { drawing, aspect: width / height }))
    };
    resolved.tables.patterns.iter().map(tile).collect()
}

/// The interval of a pattern that fills its layer.
const EVERYWHERE: [f32; 2] = [f32::MIN, f32::MAX];

/// Fills the areas of one face.
struct FacePainter<'a> {
    resolved: &'a ResolvedScene<'a>,
    interpretation: ResolvedInterpretation<'a>,
    face: &'a Face,
    plane: SectionPlane,
    tiles: &'a [Option<Tile>],
    tolerance_px: f64,
}

impl FacePainter<'_> {
    /// The rings of an area in pixels.
    fn outline(&self, rings: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
        let px = |st: &DVec2| self.resolved.view.project(self.plane.voxel(*st));
        rings.iter().map(|ring| ring.iter().map(px).collect()).collect()
    }

    /// What a layer is filled with; the picture where paths cannot show it.
    fn colour(&self, layer: u16) -> AreaFill {
        match self.tile(layer) {
            Fill::Tiled(colour, _) => AreaFill::Colour(self.toned(colour)),
            Fill::Painted => AreaFill::Picture,
        }
    }

    fn tile(&self, layer: u16) -> Fill<'_> {
        let tables = &self.resolved.tables;
        let Some(layer) = tables.layers.get(usize::from(layer)) else { return Fill::Painted };
        let first = layer.first_interval as usize;
        let intervals = &tables.intervals[first..first + layer.interval_count as usize];
        let tile = |interval: &IntervalEntry| self.tiles.get(interval.texture as usize).and_then(Option::as_ref);
        let tiled: Option<Vec<_>> = intervals.iter().map(|interval| Some((interval, tile(interval)?))).collect();
        let colour = match intervals {
            [only] if only.k == EVERYWHERE => only.colour,
            _ => layer.colour,
        };
        tiled.map_or(Fill::Painted, |tiled| Fill::Tiled(colour, tiled))
    }

    /// A colour on a face of this direction.
    fn toned(&self, [r, g, b, _]: [f32; 4]) -> Colour {
        Colour::from_unit([r, g, b].map(|channel| channel * self.resolved.tone(&self.face.plane)))
    }

    /// What lies on the colour of a layer's part in one block: for each interval its colour, where that is another, and
    /// its pattern, with the part of the area that the interval has if that is not all.
    fn intervals(&self, region: Region, rings: &[Vec<DVec2>]) -> Vec<(Option<Vec<Vec<DVec2>>>, AreaFill)> {
        let Fill::Tiled(below, tiled) = self.tile(region.layer) else { return Vec::new() };
        let mut fills = Vec::new();
        for (interval, tile) in tiled {
            let pattern = self.pattern(region, interval);
            let band = (interval.k != EVERYWHERE).then(|| pattern.band(rings, interval.k));
            if interval.colour[..3] != below[..3] {
                fills.push((band.clone(), AreaFill::Colour(self.toned(interval.colour))));
            }
            fills.push((band, self.drawn(&pattern, interval, rings, tile)));
        }
        fills
    }

    fn pattern(&self, region: Region, interval: &IntervalEntry) -> FacePattern<'_> {
        FacePattern {
            resolved: self.resolved,
            interpretation: self.interpretation,
            map: self.resolved.face_map(&self.face.plane),
            plane: self.plane,
            region,
            frequency: interval.frequency.map(|part| part * Frequencies::nearest(&self.resolved.tables.globals)),
            tolerance_px: self.tolerance_px,
        }
    }

    /// The pattern of an interval in a region, or its mean colour where the region is too thin for it.
    fn drawn(&self, pattern: &FacePattern, interval: &IntervalEntry, rings: &[Vec<DVec2>], tile: &Tile) -> AreaFill {
        let ink = |[r, g, b]: [f32; 3]| self.toned(if interval.ink[3] > 0.5 { interval.ink } else { [r, g, b, 1.0] });
        let rings_px = self.outline(rings);
        let Some(parts) = pattern.drawn(rings, tile, thickness(&rings_px)) else {
            let [low, high] = interval.k.map(|k| k.clamp(0.0, 1.0));
            let [r, g, b] = self.resolved.tables.average_colour(u32::from(pattern.region.layer), 0.5 * (low + high));
            return AreaFill::Colour(self.toned([r, g, b, 1.0]));
        };
        let outline = Outline::new(&rings_px);
        let parts = parts.into_iter().map(|part| PatternPart {
            lines: outline.cut(&part.paint, part.lines),
            paint: part.paint,
            colour: ink(part.colour),
            opacity: part.opacity * interval.colour[3],
        });
        AreaFill::Pattern(parts.filter(|part| !part.lines.is_empty()).collect())
    }
}

/// How thick a strip within these rings is, a ring and its holes: twice its area by the length of its sides.
fn thickness(rings: &[Vec<DVec2>]) -> f64 {
    let sides = || rings.iter().flat_map(|ring| (0..ring.len()).map(|n| [ring[n], ring[(n + 1) % ring.len()]]));
    let twice: f64 = sides().map(|[a, b]| a.perp_dot(b)).sum();
    twice.abs() / sides().map(|[a, b]| a.distance(b)).sum::<f64>().max(1e-9)
}

/// What a layer is filled with.
enum Fill<'a> {
    /// A colour, and patterns over it.
    Tiled([f32; 4], Vec<(&'a IntervalEntry, &'a Tile)>),
    Painted,
}
