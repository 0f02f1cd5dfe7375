//! The block on a page: one picture or two compared, surfaces and sticks before them, and which is which.

use super::annotation::BlockAnnotation;
use super::label_changes::BLOCK;
use super::north;
use super::overlay;
use super::surfaces::{self, Cells, OPACITY};
use super::vector_block::{self, BlockNames, OnPage};
use super::water;
use crate::error::FigureError;
use crate::interpretation::DrawnInterpretation;
use crate::style::{ACCENT, FRAME_PT, INK, RULE_INK, TEXT_PT};
use glam::{DVec2, DVec3};
use image::RgbaImage;
use model::StructuralModel;
use page::Rect;
use page::list::{Across, Group, GroupKind, Item, POINTS_PER_INCH, Path, PathItem, Picture, Stroke, Text, Upright};
use render::vector::VectorBlock;
use render::{DrawnWell, Outlines, RenderError, Scene, View};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use survey::SurveyGeometry;

/// Two pictures stand one over the other in a room narrower than so many heights: blocks are broader than high.
const NARROW: f64 = 1.4;
/// How far a curve may lie from the straight pieces that stand for it, points.
const STRAIGHT_PT: f64 = 0.05;
/// Lengths upright that are foreshortened to less than this share have no scale bar.
const LEAST_UPRIGHT: f64 = 0.1;

/// Draws pictures of blocks: a renderer with its data, and what watches over it.
pub trait BlockPainter {
    /// The picture of a scene, in the scene's own size.
    ///
    /// # Errors
    /// A scene that shows nothing, or a device that fails.
    fn paint(&mut self, scene: &Scene) -> Result<RgbaImage, RenderError>;

    /// The paths of a scene, straight to `tolerance_px`; `None` where only pictures are wanted.
    ///
    /// # Errors
    /// As [`Self::paint`].
    fn trace(&mut self, _scene: &Scene, _tolerance_px: f64) -> Result<Option<VectorBlock>, RenderError> {
        Ok(None)
    }
}

impl<F: FnMut(&Scene) -> Result<RgbaImage, RenderError>> BlockPainter for F {
    fn paint(&mut self, scene: &Scene) -> Result<RgbaImage, RenderError> {
        self(scene)
    }
}

/// How pictures of one block are compared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Comparison {
    /// One picture.
    #[default]
    None,
    /// Two of these blends beside one another, or one over the other where there is no room.
    SideBySide([f32; 2]),
    /// Two of these blends one over the other, parted at a share of the width.
    Wipe([f32; 2], f64),
}

impl Comparison {
    /// The blends, or none where there is one picture.
    fn blends(self) -> Option<[f32; 2]> {
        match self {
            Self::None => None,
            Self::SideBySide(blends) | Self::Wipe(blends, _) => Some(blends),
        }
    }

    /// Where each picture lies in a room.
    pub fn panes(self, room: Rect) -> Vec<Rect> {
        match self {
            Self::None => vec![room],
            Self::SideBySide(_) if is_narrow(room) => room.split_down(0.5).to_vec(),
            Self::SideBySide(_) => room.split_across(0.5).to_vec(),
            Self::Wipe(..) => vec![room; 2],
        }
    }

    /// The part of a pane that its picture is seen in.
    pub fn seen(self, index: usize, pane: Rect) -> Rect {
        match self {
            Self::Wipe(_, share) => pane.split_across(share)[index.min(1)],
            _ => pane,
        }
    }
}

/// Whether two blocks stand one over the other here.
pub fn is_narrow(room: Rect) -> bool {
    room.width() < NARROW * room.height()
}

/// What a picture of a blend is called.
fn blend_name(blend: f32) -> String {
    match blend {
        b if b <= 0.0 => "illustrated".to_owned(),
        b if b >= 1.0 => "raw".to_owned(),
        b => format!("{:.0} % raw", 100.0 * b),
    }
}

/// Pixels a metre of display space at a voxel position: √(½‖∂p/∂d‖²) over displacements d in display space
/// (‖·‖ Frobenius), whose rows are perpendicular and of that length.
pub fn pixels_per_metre(view: &View, voxel: DVec3) -> f64 {
    let voxel_from_display = view.display_from_voxel().inverse();
    let middle = view.project(voxel);
    let of = |axis: DVec3| (view.project(voxel + voxel_from_display * axis) - middle).length_squared();
    ((of(DVec3::X) + of(DVec3::Y) + of(DVec3::Z)) * 0.5).sqrt()
}

/// A block with what lies before it.
pub(crate) struct BlockPanel<'a> {
    /// What it shows; the size is found here.
    pub scene: &'a Scene,
    /// Where its samples are.
    pub geometry: &'a SurveyGeometry,
    /// One picture, or two.
    pub comparison: Comparison,
    /// Surfaces and sticks in front of it.
    pub interpretation: Option<&'a DrawnInterpretation<'a>>,
    /// Whether horizons are laid over the picture; in volume rendering the picture contains them.
    pub has_surfaces: bool,
    /// Dots an inch that pictures are drawn at.
    pub dpi: f64,
    /// The model, for the water above its ground.
    pub model: Option<&'a StructuralModel>,
    /// The wells that the painter draws, which may stand before water.
    pub wells: &'a [DrawnWell<'a>],
    /// What is written on it.
    pub annotation: Option<BlockAnnotation<'a>>,
    /// What its paths are called.
    pub names: BlockNames<'a>,
}

/// A block on its page.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DrawnBlock {
    /// What is drawn.
    pub group: Group,
    /// The scale on paper in the block's middle, points a metre.
    pub points_per_m: f64,
    /// The same down, points a unit of depth or time; 0 where the block is seen from nearly above.
    pub points_down: f64,
    /// East and north in the block's middle ([`north::compass`]).
    pub compass: [DVec2; 2],
}

/// A scene in its place on the page, as paths where the painter has them and as a picture otherwise; and the picture
/// that has its wells, if one was needed.
pub(crate) fn painted(
    scene: &Scene,
    pane: Rect,
    dpi: f64,
    names: &BlockNames,
    painter: &mut dyn BlockPainter,
) -> Result<(Vec<Item>, Option<Arc<RgbaImage>>), FigureError> {
    let size_px = DVec2::new(f64::from(scene.size_px[0]), f64::from(scene.size_px[1]));
    let page = |px: DVec2| pane.min + px / size_px * pane.size();
    let Some(traced) = painter.trace(scene, STRAIGHT_PT * dpi / POINTS_PER_INCH)? else {
        let picture = Arc::new(painter.paint(scene)?);
        return Ok((vec![Picture::in_rect(Arc::clone(&picture), pane).into()], Some(picture)));
    };
    let picture = match vector_block::needs_picture(&traced) {
        true => Some(Arc::new(painter.paint(&Scene { outlines: Outlines::none(), ..scene.clone() })?)),
        false => None,
    };
    let items = vector_block::items(&traced, &OnPage { picture: picture.as_ref(), pane, names, page: &page });
    Ok((items, picture.or(traced.over)))
}

impl BlockPanel<'_> {
    /// The panel in its room, with what holds in the block's middle.
    ///
    /// # Errors
    /// What the painter says.
    pub(crate) fn drawn(&self, room: Rect, painter: &mut dyn BlockPainter) -> Result<DrawnBlock, FigureError> {
        let mut group = Group::new(GroupKind::Panel, BLOCK);
        let (mut points_per_m, mut points_down, mut compass) = (0.0, 0.0, [DVec2::ZERO; 2]);
        let blends = self.comparison.blends();
        let beside = |room: Rect| self.annotation.map_or(room, |annotation| annotation.pane(room, self.scene));
        let is_wipe = matches!(self.comparison, Comparison::Wipe(..));
        let (whole, room) = (room, if is_wipe { beside(room) } else { room });
        let mut written: Vec<Group> = Vec::new();
        for (index, pane) in self.comparison.panes(room).into_iter().enumerate() {
            let panel = if is_wipe { whole } else { pane };
            let pane = self.on_pixels(if is_wipe { pane } else { beside(pane) });
            let size_px = (pane.size() * self.dpi / POINTS_PER_INCH).round().max(DVec2::ONE);
            let size_px = [size_px.x as u32, size_px.y as u32];
            let blend = blends.map_or(self.scene.blend, |blends| blends[index]);
            let scene = Scene { size_px, blend, ..self.scene.clone() };
            let seen = self.on_pixels(self.comparison.seen(index, pane));
            let mut shown = Group::new(GroupKind::Data, blend_name(blend)).clipped(Path::rect(seen));
            let (items, picture) = painted(&scene, pane, self.dpi, &self.names, painter)?;
            shown.items.extend(items);
            let view = scene.view(self.geometry);
            let on_page = |px: DVec2| pane.min + px * POINTS_PER_INCH / self.dpi;
            if let Some((model, water)) =
                self.model.and_then(|model| Some((model, water::drawn(&scene, self.geometry, model, &on_page)?)))
            {
                shown.push(water);
                let wells = water::wells_before(&scene, self.geometry, model, self.wells, &on_page);
                let again = picture.zip(wells).map(|(picture, wells)| water::again(&picture, pane, wells));
                again.into_iter().for_each(|again| shown.push(again));
            }
            if let Some(interpretation) = self.interpretation {
                self.lay_over(&mut shown, &scene, &view, interpretation, pane);
            }
            group.push(shown);
            if let Some(annotation) = self.annotation.filter(|_| index == 0 || !is_wipe) {
                written.push(annotation.drawn(panel, pane, &scene, self.dpi));
            }
            let middle = scene.box_in(self.geometry).centre();
            points_per_m = pixels_per_metre(&view, middle) * POINTS_PER_INCH / self.dpi;
            let sample = view.project(middle + 0.5 * DVec3::Z).distance(view.project(middle - 0.5 * DVec3::Z));
            let metres = self.geometry.metric_from_voxel().z_axis.length() * scene.exaggeration;
            // Seen from nearly above, lengths upright cannot be read.
            let is_seen = sample > LEAST_UPRIGHT * metres * pixels_per_metre(&view, middle);
            let points = sample / self.geometry.vertical.interval.abs() * POINTS_PER_INCH / self.dpi;
            points_down = if is_seen { points } else { 0.0 };
            compass = north::compass(&view, self.geometry, middle);
        }
        if let Some(blends) = blends {
            group.push(self.rule(room, blends));
        }
        group.items.extend(written.into_iter().filter(|group| !group.items.is_empty()).map(Item::from));
        Ok(DrawnBlock { group, points_per_m, points_down, compass })
    }

    /// The rectangle with its sides on pixels, so that a picture is not sampled again.
    fn on_pixels(&self, rect: Rect) -> Rect {
        let scale = self.dpi / POINTS_PER_INCH;
        Rect::new((rect.min * scale).round() / scale, (rect.max * scale).round() / scale)
    }

    /// Surfaces and sticks before the block.
    fn lay_over(&self, group: &mut Group, scene: &Scene, view: &View, shown: &DrawnInterpretation, pane: Rect) {
        let [nx, ny, _] = self.geometry.size();
        let opacity = surfaces::fault_opacity(scene.media.faces);
        let faults = shown.faults.iter().map(|fault| {
            let (cells, colour) = surfaces::of_fault(fault, self.geometry.size());
            (cells, colour, opacity)
        });
        let mut cells: Vec<(Cells, ttf::Colour, f32)> = faults.collect();
        if self.has_surfaces {
            for horizon in &shown.horizons {
                let opacity = OPACITY[usize::from(shown.picked == Some(horizon.name))];
                let sheets = horizon.sheets.iter().map(|sheet| Cells::of(sheet, [nx, ny]));
                cells.extend(sheets.map(|cells| (cells, horizon.colour, opacity)));
            }
            if let Some(selection) = &shown.selection {
                let sheets = selection.sheets.iter().map(|sheet| Cells::of(sheet, [nx, ny]));
                cells.extend(sheets.map(|cells| (cells, selection.colour, OPACITY[2])));
            }
        }
        let all = cells.iter().map(|(cells, colour, opacity)| (cells, *colour, *opacity));
        let seen = surfaces::seen(view, scene, self.geometry, all);
        if !seen.is_empty() {
            group.push(Picture::in_rect(surfaces::picture(&seen, scene.size_px), pane));
        }
        let page = |voxel: &DVec3| pane.min + view.project(*voxel) * POINTS_PER_INCH / self.dpi;
        for stick in &shown.sticks {
            group.push(overlay::stick(stick.places.iter().map(page).collect(), stick.colour));
        }
    }

    /// What parts compared pictures, and which is which.
    fn rule(&self, room: Rect, blends: [f32; 2]) -> Group {
        let mut group = Group::new(GroupKind::Annotation, "comparison");
        let is_over = matches!(self.comparison, Comparison::SideBySide(_)) && is_narrow(room);
        let share = match self.comparison {
            Comparison::Wipe(_, share) => share,
            _ => 0.5,
        };
        let top = room.min.y + 6.0;
        let places = if is_over {
            let y = room.centre().y;
            let line = Path::line(&[DVec2::new(room.min.x, y), DVec2::new(room.max.x, y)]);
            group.push(PathItem::stroked(line, Stroke::new(FRAME_PT, RULE_INK)));
            [(room.min.x + 7.0, top, Across::Start), (room.min.x + 7.0, y + 6.0, Across::Start)]
        } else {
            let x = room.min.x + share * room.width();
            let line = Path::line(&[DVec2::new(x, room.min.y), DVec2::new(x, room.max.y)]);
            let is_wipe = matches!(self.comparison, Comparison::Wipe(..));
            let stroke = if is_wipe { Stroke::new(1.2, ACCENT) } else { Stroke::new(FRAME_PT, RULE_INK) };
            group.push(PathItem::stroked(line, stroke));
            [(x - 7.0, top, Across::End), (x + 7.0, top, Across::Start)]
        };
        for ((x, y, across), blend) in places.into_iter().zip(blends) {
            let text = Text::new(DVec2::new(x, y), blend_name(blend)).sized(TEXT_PT).inked(INK);
            let text = text.anchored(across, Upright::Top).haloed(1.2, ttf::Colour::WHITE);
            // Where the line stands at the rim there is no room for a name beside it.
            let bounds = text.bounds();
            if bounds.min.x >= room.min.x && bounds.max.x <= room.max.x {
                group.push(text);
            }
        }
        group
    }
}

#[cfg(test)]
mod tests;
