//! Blocks of one series on a page: panels a, b, c … in a grid, each under its caption, at one scale and with one legend.
//!
//! All blocks have the same scene, so that camera and scale are the same; what differs is the data that they are drawn
//! from. [`SeriesLegend`] gathers what each of them shows, [`SeriesPage`] is laid out for it and takes the blocks one after
//! the other, so that the data of one are held at a time.

use super::legend::Listed;
use super::{FigureInputs, GAP_PT, LEAST_BLOCK_PT, MARGIN_PT, Maker, north, paper, scale, write_words};
use crate::draw::block::BlockPainter;
use crate::draw::legend::Legend;
use crate::draw::words::broken;
use crate::error::FigureError;
use crate::spec::{BlockPart, Figure, Part};
use crate::style::{INK, QUIET_INK, TEXT_PT};
use glam::{DVec2, DVec3};
use page::Rect;
use page::list::{Across, DisplayList, Group, GroupKind, Item, POINTS_PER_INCH, Text, Upright};
use render::{Camera, Scene};
use survey::SurveyGeometry;
use ttf::TextureLibrary;

/// Size of the letters that tell panels apart, and the room that each takes, points.
const LETTER_PT: f64 = 11.0;
const LETTER_ROOM_PT: f64 = 13.0;
/// From one line of a caption to the next, and between the last one and the block, points.
const PITCH_PT: f64 = 10.5;
const BELOW_PT: f64 = 3.0;
/// Most lines of a caption.
const MOST_LINES: usize = 3;
/// Between rows of panels, points.
const ROW_GAP_PT: f64 = 12.0;
/// Up to so many panels stand in two columns on a page whose height is free, more in three.
const MOST_IN_TWO: usize = 8;
/// Share of a page's height that a legend below the panels may take.
const BELOW_SHARE: f64 = 0.4;
/// Share of its width that one beside them may take.
const BESIDE_SHARE: f64 = 0.3;
/// Greatest height of a page whose height is free, cm.
const HIGHEST_CM: f64 = 25.0;
/// Steps along the sides of a block's foot at which it is looked for what is not cut away.
const FOOT_STEPS: u32 = 60;
/// Side of the picture in which the shape of a block is measured, pixels.
const MEASURED_PX: u32 = 2000;

/// What the blocks of a series show, for the one legend that they have.
#[derive(Debug, Default)]
pub struct SeriesLegend {
    listed: Listed,
}

impl SeriesLegend {
    /// Adds what a block shows: the one part of `figure`, drawn from `inputs`.
    ///
    /// # Errors
    /// The figure has another part than a block.
    pub fn add(&mut self, figure: &Figure, inputs: &FigureInputs) -> Result<(), FigureError> {
        let maker = Maker { figure, inputs, geometry: inputs.source.data.geometry };
        let prepared = figure.parts.iter().map(|part| maker.prepared(part)).collect::<Result<Vec<_>, _>>()?;
        // About as large as one of four on a page.
        self.listed.join(maker.listed(&prepared, 0.5 * figure.size_pt()));
        Ok(())
    }

    fn of<'a>(&'a self, figure: &Figure, library: Option<&'a TextureLibrary>) -> Option<Legend<'a>> {
        self.listed.drawn_with(library, figure.dpi).filter(|_| figure.legend)
    }

    /// The size of a page of this width that holds panels with these captions, and everything that `figure` wants.
    pub fn size_cm(
        &self,
        width_cm: f64,
        figure: &Figure,
        captions: &[String],
        (geometry, library): (&SurveyGeometry, Option<&TextureLibrary>),
    ) -> [f64; 2] {
        let points = |cm: f64| cm / 2.54 * POINTS_PER_INCH;
        let columns = match captions.len() {
            1 => 1,
            few if few <= MOST_IN_TWO => 2,
            _ => 3,
        };
        let width = points(width_cm) - 2.0 * MARGIN_PT;
        let grid = Grid::of_width(captions, columns, width, Shape::of(block(figure), geometry));
        let legend = self.of(figure, library).map_or(0.0, |legend| legend.across(width).1 + GAP_PT);
        let tall = Rect::sized(DVec2::ZERO, DVec2::new(width, points(HIGHEST_CM)));
        let words = write_words(figure, None, &mut DisplayList::new(tall.size()), tall);
        let height = grid.height() + legend + strip_pt(figure) + tall.height() - words.height() + 2.0 * MARGIN_PT;
        // A hair more, so that rounding takes nothing away.
        [width_cm, ((height + 0.5) / POINTS_PER_INCH * 2.54).min(HIGHEST_CM)]
    }
}

/// The scene of the one block of a figure.
fn block(figure: &Figure) -> Option<&BlockPart> {
    figure.parts.iter().find_map(|part| if let Part::Block(block) = part { Some(&**block) } else { None })
}

/// The room that a block takes as its scene shows it.
#[derive(Debug, Clone, Copy)]
struct Shape {
    /// Its height over its width.
    height: f64,
    /// Share of the height that is empty at its foot, where the nearest corner is cut away.
    empty: f64,
}

impl Shape {
    fn of(block: Option<&BlockPart>, geometry: &SurveyGeometry) -> Self {
        const USUAL: Shape = Shape { height: 0.75, empty: 0.0 };
        let Some(block) = block else { return USUAL };
        let camera = Camera { pan: [0.0; 2], zoom: 1.0, ..block.scene.camera };
        let scene = Scene { size_px: [MEASURED_PX; 2], camera, ..block.scene.clone() };
        let (view, bounds) = (scene.view(geometry), scene.box_in(geometry));
        let [low, high] = [bounds.low(), bounds.high()];
        let around = |places: &mut dyn Iterator<Item = DVec3>| {
            let px = places.map(|voxel| view.project(voxel));
            px.fold((DVec2::MAX, DVec2::MIN), |(low, high), px| (low.min(px), high.max(px)))
        };
        let whole = around(&mut on_box(1).map(|share| low + (high - low) * share));
        let is_cut = |p: &DVec3| scene.cut_outs.iter().any(|cut| p.cmpge(cut.low()).all() && p.cmple(cut.high()).all());
        let seen = around(&mut on_box(FOOT_STEPS).map(|share| low + (high - low) * share).filter(|p| !is_cut(p)));
        let size = (whole.1 - whole.0) / f64::from(MEASURED_PX);
        let margin = (1.0 - size.max_element()).clamp(0.0, 0.3);
        let height = (size.y + margin) / (size.x + margin);
        let empty = (whole.1.y - seen.1.y) / f64::from(MEASURED_PX) / (size.y + margin);
        let is_sound = height.is_finite() && empty.is_finite() && block.scene.camera.zoom <= 1.0;
        if is_sound { Self { height: height.clamp(0.2, 3.0), empty: empty.clamp(0.0, 0.4) } } else { USUAL }
    }
}

/// Places on the foot and the top of a box, as shares of its sides, with so many steps along each.
fn on_box(steps: u32) -> impl Iterator<Item = DVec3> {
    let share = move |n: u32| f64::from(n) / f64::from(steps);
    let across =
        move |z: f64| (0..=steps).flat_map(move |x| (0..=steps).map(move |y| DVec3::new(share(x), share(y), z)));
    across(0.0).chain(across(1.0))
}

/// Height of the strip that holds scale bar and north arrow, points.
fn strip_pt(figure: &Figure) -> f64 {
    match (figure.north_arrow, figure.scale_bar) {
        (true, _) => north::SIDE_PT,
        (false, true) => scale::STRIP_PT,
        (false, false) => 0.0,
    }
}

/// Where panels stand.
#[derive(Debug, Clone)]
struct Grid {
    columns: usize,
    /// Width of a column.
    column: f64,
    /// Size of a block, and the share of its height down to its foot.
    pane: DVec2,
    filled: f64,
    /// The lines of each caption.
    captions: Vec<Vec<String>>,
}

impl Grid {
    /// In so many columns of a width, with blocks as wide as a column.
    fn of_width(captions: &[String], columns: usize, width: f64, shape: Shape) -> Self {
        let column = (width - GAP_PT * (columns as f64 - 1.0)) / columns as f64;
        let lines = |caption: &String| broken(caption, TEXT_PT, column - LETTER_ROOM_PT, MOST_LINES);
        let pane = DVec2::new(column, column * shape.height);
        Self { filled: 1.0 - shape.empty, columns, column, pane, captions: captions.iter().map(lines).collect() }
    }

    /// In the columns that make blocks largest in a room.
    fn fitted(captions: &[String], room: DVec2, shape: Shape) -> Option<Self> {
        let fitted = |columns: usize| {
            let mut grid = Self::of_width(captions, columns, room.x, shape);
            let rows = grid.rows() as f64;
            let taken = grid.filled * grid.pane.y;
            let free = (room.y - (grid.height() - rows * taken)) / rows;
            grid.pane *= (free / taken).min(1.0);
            grid
        };
        let all = (1..=captions.len()).map(fitted);
        let best = all.fold(None, |best: Option<Self>, grid| match best {
            Some(best) if best.pane.x + 1e-6 >= grid.pane.x => Some(best),
            _ => Some(grid),
        });
        best.filter(|grid| grid.pane.min_element() >= LEAST_BLOCK_PT)
    }

    fn rows(&self) -> usize {
        self.captions.len().div_ceil(self.columns)
    }

    /// Height of the captions of a row.
    fn heading(&self, row: usize) -> f64 {
        let of_row = self.captions.iter().skip(row * self.columns).take(self.columns);
        PITCH_PT * of_row.map(Vec::len).max().unwrap_or(1).max(1) as f64 + BELOW_PT
    }

    fn height(&self) -> f64 {
        let rows = self.rows();
        let headings: f64 = (0..rows).map(|row| self.heading(row)).sum();
        headings + rows as f64 * self.filled * self.pane.y + rows.saturating_sub(1) as f64 * ROW_GAP_PT
    }

    /// Where a panel's caption begins, and where its block stands.
    fn place(&self, panel: usize, origin: DVec2) -> (DVec2, Rect) {
        let (row, column) = (panel / self.columns, panel % self.columns);
        let above: f64 = (0..row).map(|row| self.heading(row) + self.filled * self.pane.y + ROW_GAP_PT).sum();
        let corner = origin + DVec2::new(column as f64 * (self.column + GAP_PT), above);
        (corner, Rect::sized(corner + DVec2::new(0.0, self.heading(row)), self.pane))
    }
}

/// The letter of a panel of a series, counted from 0: a … z, then aa, ab …
pub fn panel_letter(panel: usize) -> String {
    let last = char::from(b'a' + (panel % 26) as u8);
    if panel < 26 { last.to_string() } else { format!("{}{last}", panel_letter(panel / 26 - 1)) }
}

/// A page that is laid out, and takes one block after the other.
pub struct SeriesPage {
    figure: Figure,
    list: DisplayList,
    grid: Grid,
    origin: DVec2,
    strip: Rect,
    panels: Vec<Item>,
}

impl SeriesPage {
    /// Lays out a page: one part of `figure`, a block, for each caption.
    ///
    /// # Errors
    /// [`FigureError::NoRoom`], [`FigureError::Parts`] where the figure is no block, or a pattern that does not draw.
    pub fn lay_out(
        figure: &Figure,
        captions: &[String],
        legend: &SeriesLegend,
        (geometry, library): (&SurveyGeometry, Option<&TextureLibrary>),
        provenance: Option<&String>,
    ) -> Result<Self, FigureError> {
        let part = block(figure).filter(|_| figure.parts.len() == 1 && !captions.is_empty());
        let part = part.ok_or(FigureError::Parts { found: figure.parts.len() })?;
        let mut list = DisplayList::new(figure.size_pt());
        page::raster::size_px(&list, figure.dpi)?;
        list.paper = paper(figure);
        let mut room = list.bounds().grown(-MARGIN_PT);
        room = write_words(figure, provenance, &mut list, room);
        let size_cm = (figure.size_pt() / POINTS_PER_INCH * 2.54).to_array();
        let no_room = || FigureError::NoRoom { what: "the series", size_cm };
        let [above, strip] = room.split_down(1.0 - strip_pt(figure) / room.height());
        room = above;
        let least = room.size().min_element();
        if least.is_nan() || least < LEAST_BLOCK_PT {
            return Err(no_room());
        }
        let shape = Shape::of(Some(part), geometry);
        let mut below = room;
        if let Some(legend) = legend.of(figure, library) {
            // Below or beside the panels, wherever it leaves more room for blocks.
            let (columns, height) = legend.across(room.width());
            let width = legend.width(room.size(), BESIDE_SHARE * room.width());
            let [left, right] = room.split_across(1.0 - width / room.width());
            let left = left.inside([0.0, 0.0, GAP_PT, 0.0]);
            let [over, under] = room.split_down(1.0 - height / room.height());
            let over = over.inside([0.0, 0.0, 0.0, GAP_PT]);
            let block = |rect: Rect| Grid::fitted(captions, rect.size(), shape).map_or(0.0, |grid| grid.pane.x);
            if height < BELOW_SHARE * room.height() && block(over) >= block(left) {
                list.items.push(legend.drawn_across(under, columns)?.into());
                below = over;
            } else {
                list.items.push(legend.drawn(right.inside([0.0, 2.0, 0.0, 0.0]))?.into());
                below = left;
            }
        }
        let grid = Grid::fitted(captions, below.size(), shape).ok_or_else(no_room)?;
        let panels = Vec::new();
        Ok(Self { figure: figure.clone(), list, grid, origin: below.min, strip, panels })
    }

    /// Draws the next block, the one part of `figure`, from `inputs`.
    ///
    /// # Errors
    /// What the painter says.
    pub fn draw(
        &mut self,
        figure: &Figure,
        inputs: &FigureInputs,
        painter: &mut dyn BlockPainter,
    ) -> Result<(), FigureError> {
        let panel = self.panels.len();
        let Some(lines) = self.grid.captions.get(panel) else {
            return Err(FigureError::Parts { found: panel + 1 });
        };
        let (corner, pane) = self.grid.place(panel, self.origin);
        let mut heading = Group::new(GroupKind::Annotation, "caption");
        let baseline = |line: usize| corner + DVec2::new(0.0, PITCH_PT * (line as f64 + 0.8));
        let at_baseline = |at: DVec2, words: &str, size: f64| {
            Text::new(at, words).sized(size).anchored(Across::Start, Upright::Baseline)
        };
        heading.push(at_baseline(baseline(0), &panel_letter(panel), LETTER_PT).inked(INK));
        for (n, line) in lines.iter().enumerate() {
            let text = at_baseline(baseline(n) + DVec2::new(LETTER_ROOM_PT, 0.0), line, TEXT_PT).inked(QUIET_INK);
            heading.push(text.fitted(self.grid.column - LETTER_ROOM_PT));
        }
        let maker = Maker { figure: &self.figure, inputs, geometry: inputs.source.data.geometry };
        let part = block(figure).ok_or(FigureError::Parts { found: 0 })?;
        let drawn = maker.block_alone(part, pane, painter)?;
        if panel + 1 == self.grid.captions.len() {
            self.list.items.extend(maker.strip(part, self.strip, &drawn));
        }
        self.panels
            .push(Group::new(GroupKind::Panel, panel_letter(panel)).with([heading.into(), drawn.group.into()]).into());
        Ok(())
    }

    /// The page.
    #[must_use]
    pub fn finish(mut self) -> DisplayList {
        crate::draw::label_changes::change(&mut self.list.items, &self.figure.all_labels());
        self.panels.append(&mut self.list.items);
        self.list.items = self.panels;
        self.list.print(self.figure.printed_in());
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_lettered_on_and_on() {
        let letters = [0, 1, 25, 26, 27, 52].map(panel_letter);
        assert_eq!(letters, ["a", "b", "z", "aa", "ab", "ba"]);
    }

    #[test]
    fn blocks_are_as_large_as_the_room_allows_and_never_meet() {
        let captions: Vec<String> = (0..5).map(|n| "words ".repeat(1 + 3 * n)).collect();
        for room in [DVec2::new(460.0, 600.0), DVec2::new(700.0, 300.0), DVec2::new(150.0, 900.0)] {
            let grid = Grid::fitted(&captions, room, Shape { height: 0.7, empty: 0.0 }).unwrap();
            assert!(grid.height() <= room.y + 1e-6, "{grid:?}");
            let panes: Vec<Rect> = (0..5).map(|panel| grid.place(panel, DVec2::ZERO).1).collect();
            for (n, pane) in panes.iter().enumerate() {
                assert!(pane.max.cmple(room + 1e-6).all() && (pane.height() / pane.width() - 0.7).abs() < 1e-9);
                assert!(panes[..n].iter().all(|other| !other.grown(-0.1).meets(&pane.grown(-0.1))));
                let (corner, _) = grid.place(n, DVec2::ZERO);
                assert!(pane.min.y - corner.y >= PITCH_PT * grid.captions[n].len() as f64);
            }
        }
        assert!(Grid::fitted(&captions, DVec2::new(60.0, 60.0), Shape { height: 0.7, empty: 0.1 }).is_none());
    }
}
