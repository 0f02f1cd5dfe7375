//! The faces of a scene as areas: one for each connected piece of a layer.

use super::pattern::{FacePattern, Tile};
use super::visible::{seen_faces, seen_pieces};
use super::{AreaFill, PatternPart, VectorArea};
use crate::error::RenderError;
use crate::ground::air_layer;
use crate::outline::solid::Face;
use crate::pattern_size::Frequencies;
use crate::resolved::{ResolvedInterpretation, ResolvedScene};
use glam::DVec2;
use model::Region;
use model::section::{Section, SectionPlane};
use rayon::prelude::*;
use survey::Progress;
use ttf::tables::IntervalEntry;
use ttf::{Colour, TextureLibrary, TileDrawing};

/// The areas of all faces that are seen, back to front.
pub(super) fn face_areas(
    resolved: &ResolvedScene,
    library: &TextureLibrary,
    tolerance_px: f64,
    progress: &Progress,
) -> Result<Vec<VectorArea>, RenderError> {
    let Some(interpretation) = resolved.interpretation else { return Ok(Vec::new()) };
    let tiles = tiles(resolved, library)?;
    let faces = seen_faces(&resolved.solid, &resolved.view);
    let air = resolved.relief.as_ref().map(|_| air_layer(interpretation.model));
    progress.begin("pattern", faces.len() as u64);
    let mut areas = Vec::new();
    for (index, face) in faces.iter().enumerate() {
        let seen = seen_pieces(&faces, index, &resolved.view, air.is_some());
        progress.step(1)?;
        if seen.as_ref().is_some_and(Vec::is_empty) {
            continue;
        }
        let plane = face.face.section_plane();
        let section = Section::new(interpretation.model, &plane);
        let painter = FacePainter { resolved, interpretation, face: &face.face, plane, tiles: &tiles, tolerance_px };
        // Colours of whole layers, so that no seam shows where a fault is only continued; then their patterns.
        let colours = section.layers.iter().map(|area| (area.layer, None, &area.rings));
        let patterns = section.polygons.iter().map(|area| (area.region.layer, Some(area.region), &area.rings));
        let all: Vec<_> = colours.chain(patterns).filter(|(layer, ..)| Some(*layer) != air).collect();
        let drawn = all.into_par_iter().filter_map(|(layer, region, rings)| {
            let fill = match region {
                None => painter.colour(layer),
                Some(region) => painter.pattern(region, rings)?,
            };
            Some(VectorArea { layer, rings: painter.outline(rings), seen: seen.clone(), fill })
        });
        areas.extend(drawn.collect::<Vec<_>>());
        progress.check()?;
    }
    Ok(areas)
}

/// The drawing of each texture in use, by slot.
fn tiles(resolved: &ResolvedScene, library: &TextureLibrary) -> Result<Vec<Option<Tile>>, RenderError> {
    let tile = |index: &usize| {
        let [width, height] = library.pattern(*index).tile_mm.map(f64::from);
        let drawing: Option<TileDrawing> = library.drawing(*index)?;
        Ok(drawing.map(|drawing| Tile { drawing, aspect: width / height }))
    };
    resolved.tables.patterns.iter().map(tile).collect()
}

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
            Fill::Plain(colour) | Fill::Tiled(colour, ..) => AreaFill::Colour(self.toned(colour)),
            Fill::Painted => AreaFill::Picture,
        }
    }

    fn tile(&self, layer: u16) -> Fill<'_> {
        let tables = &self.resolved.tables;
        let Some(layer) = tables.layers.get(usize::from(layer)) else { return Fill::Painted };
        let first = layer.first_interval as usize;
        match &tables.intervals[first..first + layer.interval_count as usize] {
            [] => Fill::Plain(layer.colour),
            [interval] if interval.k == [f32::MIN, f32::MAX] => {
                match self.tiles.get(interval.texture as usize).and_then(Option::as_ref) {
                    Some(tile) => Fill::Tiled(interval.colour, interval, tile),
                    None => Fill::Painted,
                }
            }
            _ => Fill::Painted,
        }
    }

    /// A colour on a face of this direction.
    fn toned(&self, [r, g, b, _]: [f32; 4]) -> Colour {
        Colour::from_unit([r, g, b].map(|channel| channel * self.resolved.tone(&self.face.plane)))
    }

    /// The pattern of a layer's part in one block; `None` if it has none, or is painted.
    fn pattern(&self, region: Region, rings: &[Vec<DVec2>]) -> Option<AreaFill> {
        let Fill::Tiled(_, interval, tile) = self.tile(region.layer) else { return None };
        let pattern = FacePattern {
            resolved: self.resolved,
            interpretation: self.interpretation,
            frame: self.resolved.frame(&self.face.plane),
            plane: self.plane,
            region,
            frequency: interval.frequency.map(|part| part * Frequencies::nearest(&self.resolved.tables.globals)),
            tolerance_px: self.tolerance_px,
        };
        let ink = |[r, g, b]: [f32; 3]| self.toned(if interval.ink[3] > 0.5 { interval.ink } else { [r, g, b, 1.0] });
        let parts = pattern.drawn(rings, tile).into_iter().map(|part| PatternPart {
            paint: part.paint,
            colour: ink(part.colour),
            opacity: part.opacity * interval.colour[3],
            lines: part.lines,
        });
        Some(AreaFill::Pattern(parts.collect()))
    }
}

/// What a layer is filled with.
enum Fill<'a> {
    Plain([f32; 4]),
    Tiled([f32; 4], &'a IntervalEntry, &'a Tile),
    Painted,
}
