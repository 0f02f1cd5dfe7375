//! Makes the model of a project: what a scene needs is loaded once, and each picture of a face is made once.

use crate::block::{Wanted, block_of, lines_on, wanted_ground};
use crate::covers::CoverMaker;
use crate::ground::Heights;
use crate::model::{
    Block, Cover, Face, Layer, LineKind, Model, Note, RawScale, SceneModel, SectionPlace, Stack, Surface, WellPath,
};
use crate::surfaces::{self, Lattice};
use figure::draw::swatch;
use glam::DVec3;
use image::{RgbImage, imageops};
use model::section::SectionPlane;
use page::list::POINTS_PER_INCH;
use project::Project;
use project::content;
use project::document::{Document, NoteEntry};
use project::error::ProjectError;
use project::pictures::load::{self, Loaded, Request, Rock};
use project::pictures::{Device, Painter, figures, scene};
use project::styles;
use render::ground::is_air;
use render::{Faces, Scene};
use std::collections::HashMap;
use std::path::Path;
use survey::block::BodyPlane;
use survey::{Progress, VerticalUnit};
use ttf::{Colour, LayerStyle, RawColour, TextureLibrary};

/// What a review holds, and in which detail.
#[derive(Debug, Clone)]
pub struct ReviewSettings {
    /// Texels along the longest side of the block.
    pub density: f64,
    /// Sections along each axis, for stepping through the volume; 0 for none.
    pub sections: usize,
    /// Nodes along each axis of the lattice on which horizons are sampled, before it is made finer where that is needed.
    pub surface_nodes: usize,
    /// How far triangles of horizons may be from them, samples.
    pub surface_error: f64,
    /// Most triangles of a fault, and of a horizon that is no height field.
    pub surface_triangles: usize,
    /// Most cells along each axis of the lattice on which the ground is sampled.
    pub ground_cells: usize,
    /// Whether blocks without their cut-outs are made, too.
    pub has_whole: bool,
    /// Names of the scenes, in the order of the project; empty for all.
    pub scenes: Vec<String>,
    /// The device that draws.
    pub device: Device,
    /// Largest memory for the samples of a volume, bytes.
    pub volume_bytes: u64,
}

/// Texels along the longest side of the block, unless stated.
pub const DENSITY: f64 = 1000.0;
/// Limits of the texels along the longest side of the block.
pub const DENSITIES: [f64; 2] = [64.0, 4096.0];
/// Sections along an axis, unless stated.
pub const SECTIONS: usize = 3;
/// Most sections along an axis.
pub const MOST_SECTIONS: usize = 200;
/// Nodes along each axis on which the horizons of a page are sampled.
const PAGE_NODES: usize = 40;
/// How far triangles of the horizons of a page may be from them, samples.
const PAGE_ERROR: f64 = 0.9;
/// Most cells along each axis on which the ground of a page is sampled.
const PAGE_GROUND_CELLS: usize = 256;
/// Most triangles of a fault in a page.
const PAGE_TRIANGLES: usize = 4_000;
/// Pixels of the pictures for readers without 3D.
const PICTURE_PX: [u32; 2] = [1120, 840];
/// Pixels of a swatch of the legend.
const SWATCH_PX: [u32; 2] = [96, 52];
/// Pixels to a millimetre of a pattern's tile in a swatch.
const SWATCH_PX_PER_MM: f32 = 9.0;
/// Most cut-outs of a scene that are switched one by one; more are switched together.
const MOST_SWITCHED: usize = 4;
/// Share of the texels that sections get along each axis.
const SECTION_DENSITY: f64 = 0.4;
/// Colours of faults.
const FAULT: Colour = Colour::new(0x6b, 0x2a, 0x1a);

impl ReviewSettings {
    /// Settings of a page. A model's are the same: what of them depends on its triangles, its export chooses.
    pub fn new(density: f64, sections: usize, scenes: Vec<String>, device: Device, volume_bytes: u64) -> Self {
        Self {
            density,
            sections,
            surface_nodes: PAGE_NODES,
            surface_error: PAGE_ERROR,
            surface_triangles: PAGE_TRIANGLES,
            ground_cells: PAGE_GROUND_CELLS,
            has_whole: true,
            scenes,
            device,
            volume_bytes,
        }
    }
}

/// Makes the model of a project.
///
/// # Errors
/// The project has nothing to show or no such scene, data are damaged, a scene cannot be drawn, or the user cancelled.
pub fn make(project: &Project, settings: &ReviewSettings, progress: &Progress) -> Result<Model, ProjectError> {
    let document = project.document();
    let named = scenes(document, settings, progress)?;
    let has_both = !document.volumes.is_empty() && !document.horizons.is_empty();
    let mut first = Scene { blend: if has_both { 0.5 } else { named[0].1.blend }, ..named[0].1.clone() };
    named[1..].iter().for_each(|(_, scene)| load::add_needs(&mut first, scene));
    let request = Request::new(&first).within(settings.volume_bytes);
    let loaded = load::load(project.facts(), &request, progress)?;
    let library = styles::pattern_library(project.root(), document)?;
    let mut maker = Maker {
        project,
        settings,
        has_both,
        raw: loaded.raw.clone(),
        loaded,
        library: &library,
        painter: Painter::new(settings.device, progress)?,
        progress,
        covers: Vec::new(),
        known: HashMap::new(),
    };
    let mut made = Vec::new();
    for (name, scene) in &named {
        made.push(maker.scene(name, scene)?);
    }
    let sections = maker.sections(&named[0].1)?;
    let (horizons, faults) = maker.surfaces(named.iter().any(|(_, scene)| scene.ground.is_some()))?;
    let wells = maker.wells()?;
    let layers = maker.layers(document)?;
    let loaded = Loaded { raw: maker.raw, ..maker.loaded };
    let raw = loaded.raw.as_ref().map(|raw| RawScale {
        volume: raw.volume.clone(),
        function: raw.function.clone(),
        no_data: raw.no_data,
    });
    Ok(Model {
        title: project.title(),
        provenance: provenance(document, &loaded),
        warning: document.uninterpreted().map(|why| why.to_string()),
        geometry: loaded.geometry.clone(),
        layers,
        horizons,
        faults,
        wells,
        covers: maker.covers,
        scenes: made,
        sections,
        notes: notes(document, &loaded),
        raw,
    })
}

/// The scenes of a project that are wanted, or its default view; each has a block to show.
fn scenes(
    document: &Document,
    settings: &ReviewSettings,
    progress: &Progress,
) -> Result<Vec<(String, Scene)>, ProjectError> {
    if document.volumes.is_empty() && document.horizons.is_empty() {
        return Err(ProjectError::NoLayers);
    }
    let mut named: Vec<(String, Scene)> = Vec::new();
    for name in &settings.scenes {
        named.push((name.clone(), scene::choose(document, Some(name))?));
    }
    if named.is_empty() {
        named = document.scenes.iter().map(|entry| (entry.name.clone(), entry.scene.clone())).collect();
    }
    if named.is_empty() {
        named.push(("Block".to_owned(), scene::default_view(document)?));
    }
    for (name, scene) in &mut named {
        scene::prepare(document, scene, &progress.muted())?;
        if scene.media.faces != Faces::All || scene.media.all().next().is_some() {
            progress
                .warn(format!("scene {name} is volume rendering: the model shows its block, its picture the volume"));
        }
        if document.horizons.is_empty() {
            scene.ground = None;
        }
    }
    Ok(named)
}

/// The cut-outs of a scene in the sets that are switched together: boxes first, then other shapes.
fn switched(scene: &Scene) -> Vec<Vec<usize>> {
    let count = scene.cut_outs.len() + scene.cut_shapes.len();
    match count {
        0 => Vec::new(),
        1..=MOST_SWITCHED => (0..count).map(|n| vec![n]).collect(),
        _ => vec![(0..count).collect()],
    }
}

/// A scene with some sets of its cut-outs: bit n of `taken` stands for set n.
fn with_cuts(scene: &Scene, sets: &[Vec<usize>], taken: u32) -> Scene {
    let is_taken = |cut: usize| sets.iter().enumerate().any(|(n, set)| taken >> n & 1 == 1 && set.contains(&cut));
    let boxes = scene.cut_outs.len();
    let cut_outs = scene.cut_outs.iter().enumerate().filter(|(n, _)| is_taken(*n)).map(|(_, cut)| *cut);
    let cut_shapes = scene.cut_shapes.iter().enumerate().filter(|(n, _)| is_taken(boxes + n));
    Scene {
        cut_outs: cut_outs.collect(),
        cut_shapes: cut_shapes.map(|(_, shape)| shape.clone()).collect(),
        ..scene.clone()
    }
}

/// Makes what scenes share.
struct Maker<'a> {
    project: &'a Project,
    settings: &'a ReviewSettings,
    /// Whether there are measured data and rock, between which a view can blend.
    has_both: bool,
    /// The colours of measured data in scenes that state none.
    raw: Option<RawColour>,
    loaded: Loaded,
    library: &'a TextureLibrary,
    painter: Painter,
    progress: &'a Progress,
    covers: Vec<Cover>,
    known: HashMap<String, usize>,
}

impl Maker<'_> {
    /// A scene with its block, its pictures among the covers.
    fn scene(&mut self, name: &str, scene: &Scene) -> Result<SceneModel, ProjectError> {
        self.load_for(scene)?;
        // Faces are those of the rock, whatever the volume rendering of the scene leaves of them.
        let solid = Scene { media: Default::default(), ..scene.clone() };
        let ground = match (&scene.ground, &self.loaded.rock) {
            (Some(style), Some(rock)) => {
                let cells = self.settings.ground_cells;
                Some(Heights::of((style, &solid), &self.loaded.geometry, &rock.model, cells))
            }
            _ => None,
        };
        let sets = switched(&solid);
        let all = (1u32 << sets.len()) - 1;
        let ground_parts = self.ground(&solid, &sets, ground.as_ref())?;
        let mut variants = Vec::new();
        let first = if self.settings.has_whole { 0 } else { all };
        for taken in first..=all {
            variants.push(self.block(&with_cuts(&solid, &sets, taken), ground.as_ref())?);
        }
        let mut cut = variants.last().cloned().unwrap_or_default();
        for (_, part) in ground_parts.iter().filter(|(cuts, _)| *cuts == 0) {
            cut.faces.extend(part.faces.iter().cloned());
            cut.lines.extend(part.lines.iter().copied());
        }
        let (variants, ground) = if self.settings.has_whole { (variants, ground_parts) } else { Default::default() };
        let cuts = (1..=sets.len()).map(|n| if all == 1 { "Cut-out".to_owned() } else { format!("Cut-out {n}") });
        let cuts: Vec<String> = cuts.collect();
        let shown = Scene { size_px: PICTURE_PX, samples: 2, ..scene.clone() };
        let picture = self.painter.picture(&shown, &self.loaded, POINTS_PER_INCH, self.progress)?;
        Ok(SceneModel {
            name: name.to_owned(),
            scene: scene.clone(),
            cut,
            cuts,
            variants,
            ground,
            picture: on_white(&picture),
        })
    }

    /// Loads what a scene needs, in its own styles; most of it is in memory.
    fn load_for(&mut self, scene: &Scene) -> Result<(), ProjectError> {
        let blend = if self.has_both { 0.5 } else { scene.blend };
        let needed = Scene { blend, raw: scene.raw.clone().or_else(|| self.raw.clone()), ..scene.clone() };
        let request = Request::new(&needed).within(self.settings.volume_bytes);
        self.loaded = load::load(self.project.facts(), &request, &self.progress.muted())?;
        Ok(())
    }

    fn block(&mut self, scene: &Scene, ground: Option<&Heights>) -> Result<Block, ProjectError> {
        let model = self.loaded.rock.as_ref().map(|rock| &*rock.model);
        let on = ground.zip(model).map(|(heights, model)| heights.on(model));
        let (mut block, wanted) = block_of(scene, &self.loaded.geometry, model, on.as_ref());
        let mut covers = Vec::with_capacity(wanted.len());
        for wanted in &wanted {
            covers.push(self.cover(wanted, scene, ground, 1.0)?);
        }
        block.faces.iter_mut().for_each(|face| face.cover = covers[face.cover]);
        Ok(block)
    }

    /// The parts of the ground with their pictures, by the cut-outs in which they lie.
    fn ground(
        &mut self,
        scene: &Scene,
        sets: &[Vec<usize>],
        ground: Option<&Heights>,
    ) -> Result<Vec<(u32, Block)>, ProjectError> {
        let Some((heights, rock)) = ground.zip(self.loaded.rock.as_ref()) else { return Ok(Vec::new()) };
        let (geometry, on) = (&self.loaded.geometry, heights.on(&rock.model));
        let bodies: Vec<_> = (0..sets.len()).map(|n| with_cuts(scene, sets, 1 << n).solid(geometry).cut_outs).collect();
        let parts = on.parts(&bodies).into_iter().filter(|part| self.settings.has_whole || part.cuts == 0);
        let parts = parts.map(|part| (wanted_ground(scene, geometry, &on, part.fault), part));
        let mut made = Vec::new();
        for ((name, wanted), part) in parts.collect::<Vec<_>>() {
            let cover = self.cover(&wanted, scene, ground, 1.0)?;
            let contact = LineKind::Horizon { is_picked: true };
            let faults = part.lines.into_iter().map(|ends| (LineKind::Fault, ends));
            let lines = faults.chain(part.contacts.into_iter().map(|ends| (contact, ends))).collect();
            let face = Face { cover, name: name.to_owned(), mesh: part.mesh };
            let faces = Some(face).filter(|face| !face.mesh.triangles.is_empty()).into_iter().collect();
            made.push((part.cuts, Block { faces, lines }));
        }
        Ok(made)
    }

    /// The index of a picture, which is made unless it is there.
    fn cover(
        &mut self,
        wanted: &Wanted,
        scene: &Scene,
        ground: Option<&Heights>,
        share: f64,
    ) -> Result<usize, ProjectError> {
        let light = match (&wanted.plane, scene.face_tone > 0.0) {
            (Some(_), false) => String::new(),
            _ => format!("{:?} {:?}", scene.ground, scene.camera),
        };
        let key = format!(
            "{:?} {:?} {:?} {} {:?} {} {share} {light}",
            wanted.rectangle,
            wanted.shade,
            wanted.plane.map(|plane| plane.wall),
            scene.exaggeration,
            scene.preset,
            scene.global_frequency
        );
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        let geometry = &self.loaded.geometry;
        let extent = scene.box_in(geometry).extent();
        let metric = geometry.metric_from_voxel();
        let longest_m = (0..2).map(|axis| metric.col(axis).length() * extent[axis]).fold(1e-9, f64::max);
        let texels_per_m = share * self.settings.density / longest_m;
        let mut maker = CoverMaker {
            loaded: &self.loaded,
            painter: &mut self.painter,
            progress: self.progress,
            texels_per_m,
            nodes_per_voxel: if share < 1.0 { 1.0 } else { 2.0 },
        };
        self.covers.push(maker.make(wanted, scene, ground)?);
        self.known.insert(key, self.covers.len() - 1);
        Ok(self.covers.len() - 1)
    }

    /// Sections through the whole box of a scene, evenly spaced, on lines and samples.
    fn sections(&mut self, scene: &Scene) -> Result<Vec<Stack>, ProjectError> {
        let count = self.settings.sections;
        if count == 0 {
            return Ok(Vec::new());
        }
        self.load_for(scene)?;
        let block = scene.box_in(&self.loaded.geometry);
        let (low, high) = (block.low(), block.high());
        let mut stacks = Vec::new();
        for axis in 0..3 {
            let mut places: Vec<f64> = (1..=count)
                .map(|n| (low[axis] + (high[axis] - low[axis]) * n as f64 / (count + 1) as f64).round())
                .collect();
            places.dedup();
            let mut stack = Stack { axis, places: Vec::new() };
            for at in places {
                let rectangle = match axis {
                    0 => SectionPlane::inline(at, low, high),
                    1 => SectionPlane::crossline(at, low, high),
                    _ => SectionPlane::slice(at, low, high),
                };
                let plane = Some(BodyPlane::of_axis(axis, at as f32, 1.0));
                let cover = self.cover(&Wanted { plane, rectangle, shade: None }, scene, None, SECTION_DENSITY)?;
                let model = self.loaded.rock.as_ref().map(|rock| &*rock.model);
                let lines = model.map_or_else(Vec::new, |model| lines_on(model, &rectangle));
                stack.places.push(SectionPlace { at, cover, lines });
            }
            stacks.push(stack);
        }
        Ok(stacks)
    }

    fn surfaces(&self, has_ground: bool) -> Result<(Vec<Surface>, Vec<Surface>), ProjectError> {
        let document = self.project.document();
        let geometry = &self.loaded.geometry;
        let Some(rock) = &self.loaded.rock else { return Ok((Vec::new(), Vec::new())) };
        let shares = rock.picked_shares();
        let mut horizons = Vec::new();
        self.progress.begin("surfaces", (document.horizons.len() + document.faults.len()) as u64);
        for ((index, named), entry) in figures::horizons(document).iter().enumerate().zip(&document.horizons) {
            self.progress.step(1)?;
            let label = (named.name.as_str(), named.colour);
            let mut surface = match is_any_shape(rock, index) {
                true => {
                    let horizon = content::read_horizon(self.project.root(), entry, &self.progress.muted())?;
                    let mesh = horizon.any_shape().cloned().unwrap_or_default();
                    surfaces::triangles(geometry, label, &mesh, self.settings.surface_triangles)
                }
                false => {
                    let lattice = Lattice { nodes: self.settings.surface_nodes, error: self.settings.surface_error };
                    surfaces::horizon(&rock.model, geometry, (index, label.0, label.1), lattice)
                }
            };
            surface.picked_share = shares.get(index).copied().filter(|share| share.is_finite()).unwrap_or(1.0);
            horizons.push(surface);
        }
        let mut faults = Vec::new();
        for entry in &document.faults {
            self.progress.step(1)?;
            let fault = content::read_fault(self.project.root(), entry)?;
            let most = self.settings.surface_triangles;
            let mut surface = surfaces::triangles(geometry, (&entry.name, FAULT), &fault.mesh, most);
            if has_ground {
                surfaces::cut_at_ground(&mut surface, |p| !is_air(&rock.model, p.as_vec3()));
            }
            faults.push(surface);
        }
        Ok((horizons, faults))
    }

    fn wells(&self) -> Result<Vec<WellPath>, ProjectError> {
        let geometry = &self.loaded.geometry;
        let mut wells = Vec::new();
        for entry in &self.project.document().wells {
            let well = content::read_well(self.project.root(), entry)?;
            let inside = |p: &DVec3| surfaces::is_inside(*p, geometry.size());
            let tops =
                well.tops.iter().filter_map(|top| Some((top.name.clone(), well.voxel_at_md(top.md_m, geometry)?)));
            wells.push(WellPath {
                name: entry.name.clone(),
                tops: tops.filter(|(_, p)| inside(p)).collect(),
                path: well.path_in_voxels(geometry).into_iter().filter(inside).collect(),
            });
        }
        wells.retain(|well| well.path.len() > 1);
        Ok(wells)
    }

    /// The layers, deepest first, with what the legend says of them.
    fn layers(&self, document: &Document) -> Result<Vec<Layer>, ProjectError> {
        if self.loaded.rock.is_none() {
            return Ok(Vec::new());
        }
        let mut seen = [false; 256];
        for cover in &self.covers {
            cover.data.pixels().for_each(|pixel| seen[usize::from(pixel.0[1])] = true);
        }
        let styles = styles::layer_styles(document, self.library);
        // Patterns of what nobody interpreted say nothing of rocks.
        let is_interpreted = document.uninterpreted().is_none();
        let layer = |(number, style): (usize, &LayerStyle)| {
            let drawn = swatch::draw(style, self.library, SWATCH_PX, SWATCH_PX_PER_MM)?;
            let rocks = style.intervals.iter().filter_map(|interval| self.library.find(&interval.texture));
            let mut rocks: Vec<String> = rocks.map(|index| self.library.pattern(index).title.clone()).collect();
            rocks.dedup();
            rocks.truncate(if is_interpreted { rocks.len() } else { 0 });
            let age = ttf::ages()
                .filter(|age| is_interpreted && age.colour == style.colour)
                .max_by(|a, b| (a.base_ma - a.top_ma).total_cmp(&(b.base_ma - b.top_ma)));
            Ok(Layer {
                name: style.layer.clone(),
                rock: rocks.join(", "),
                age: age.map_or_else(String::new, |age| age.name.to_owned()),
                colour: style.colour,
                swatch: on_white(&drawn),
                is_seen: seen[(number + 1).min(255)],
            })
        };
        styles.iter().rev().enumerate().map(layer).collect()
    }
}

/// Whether a horizon is no height field in any block.
fn is_any_shape(rock: &Rock, horizon: usize) -> bool {
    (0..rock.model.block_count() as u16).any(|block| rock.model.level(horizon, block).is_some())
}

fn on_white(image: &image::RgbaImage) -> RgbImage {
    let mut white = image::RgbaImage::from_pixel(image.width(), image.height(), image::Rgba([255; 4]));
    imageops::overlay(&mut white, image, 0, 0);
    image::DynamicImage::from(white).to_rgb8()
}

/// What a reader must know about the data and the scales.
fn provenance(document: &Document, loaded: &Loaded) -> Vec<String> {
    let geometry = &loaded.geometry;
    let [inlines, crosslines, samples] = geometry.size();
    let unit = geometry.vertical.unit;
    let mut lines = vec![format!(
        "{inlines} inlines, {crosslines} crosslines, {samples} samples; {:.0} to {:.0} {}",
        geometry.vertical.first,
        geometry.vertical.last(),
        unit.symbol()
    )];
    if unit == VerticalUnit::Milliseconds {
        lines.push(format!("two-way time, drawn at {} m/s, one velocity for the whole survey", geometry.velocity_m_s));
    }
    if let Some(raw) = &loaded.raw {
        lines.push(format!("raw data: volume {}", raw.volume));
    }
    lines.extend(project::pictures::sparse_sentences(&loaded.sparse()));
    for entry in document.volumes.iter().take(1) {
        let file = entry.origin.file().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        lines.extend(file.map(|file| format!("seismic data: {file}")));
    }
    lines.push(format!("made by Petroglyph {}", env!("CARGO_PKG_VERSION")));
    lines
}

/// The notes of a project, where they lie in the survey.
fn notes(document: &Document, loaded: &Loaded) -> Vec<Note> {
    let geometry = &loaded.geometry;
    let note = |entry: &NoteEntry| {
        let [inline, crossline, z] = entry.at;
        let at = geometry.voxel_from_lines(inline, crossline).extend(geometry.vertical.index_of(z));
        Note { text: entry.text.clone(), at, scene: entry.scene.clone() }
    };
    document.notes.iter().map(note).collect()
}
