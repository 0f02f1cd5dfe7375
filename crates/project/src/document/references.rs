//! The one list of all that refers to something in a project.
//!
//! Every struct on the way is taken apart field by field: a new field does not compile until it is decided whether it
//! refers to anything.

use super::{Document, ExtractionEntry, FigureEntry, Origin, RestoredEntry, Style};
use crate::error::Noun;
use figure::{BlockPart, CorrelationPart, Figure, MapPart, Part, ThrowPart};
use render::{IsosurfaceSource, LabelChange, Media, Scene};
use std::fmt;
use ttf::LayerTtf;

/// What holds a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ReferenceHolder<'a> {
    /// The style of the whole project.
    Style,
    /// The style of a layer.
    Layer(&'a str),
    /// The textures by the values of a volume.
    Scalars(&'a str),
    /// The present extraction of candidates.
    Extraction,
    /// Where something came from.
    Origin,
    /// A fault that ends at another.
    Fault(&'a str),
    /// Sticks of a fault.
    Sticks,
    /// A scene.
    Scene(&'a str),
    /// A note, counted from 1.
    Note(usize),
    /// A figure.
    Figure(&'a str),
}

impl fmt::Display for ReferenceHolder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Style => f.write_str("the style"),
            Self::Layer(name) => write!(f, "the style of layer \"{name}\""),
            Self::Scalars(name) => write!(f, "the textures by the values of \"{name}\""),
            Self::Extraction => f.write_str("the candidates"),
            Self::Origin => f.write_str("the origin of something"),
            Self::Fault(name) => write!(f, "fault \"{name}\""),
            Self::Sticks => f.write_str("the sticks"),
            Self::Scene(name) => write!(f, "scene \"{name}\""),
            Self::Note(number) => write!(f, "note {number}"),
            Self::Figure(file) => write!(f, "figure \"{file}\""),
        }
    }
}

/// How a place refers to something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ReferenceKind {
    /// CalledBy its name; if the thing goes, so does what hangs on the reference.
    Name,
    /// CalledBy its name, as the record of what was done: it outlives the thing.
    Record,
    /// In words that may name something else, or nothing: those of a label, or of a well's top.
    Words,
}

/// A place that refers to something.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reference<'a> {
    /// What it can refer to; of two things of one name it means that of the first kind.
    pub nouns: &'static [Noun],
    /// How.
    pub kind: ReferenceKind,
    /// What it is part of.
    pub holder: ReferenceHolder<'a>,
}

/// Looks at a reference and may change it; `false` drops it with what hangs on it.
pub(crate) type VisitReference<'v> = dyn FnMut(Reference<'_>, &mut String) -> bool + 'v;

pub(super) const VOLUME: &[Noun] = &[Noun::Volume];
pub(super) const HORIZON: &[Noun] = &[Noun::Horizon];
pub(super) const FAULT: &[Noun] = &[Noun::Fault];
pub(super) const WELL: &[Noun] = &[Noun::Well];
pub(super) const LAYER: &[Noun] = &[Noun::Layer];
pub(super) const TEXTURE: &[Noun] = &[Noun::Texture];
const SCENE: &[Noun] = &[Noun::Scene];
const HIDDEN: &[Noun] = &[Noun::Horizon, Noun::Fault, Noun::Well];
const LABELLED: &[Noun] = &[Noun::Layer, Noun::Fault, Noun::Well, Noun::Horizon];

/// The visitor together with what holds the references that it is shown.
pub(super) struct ReferenceVisitor<'v, 'f, 'h> {
    pub visit: &'v mut VisitReference<'f>,
    pub holder: ReferenceHolder<'h>,
}

impl ReferenceVisitor<'_, '_, '_> {
    fn name(&mut self, nouns: &'static [Noun], name: &mut String) -> bool {
        (self.visit)(Reference { nouns, kind: ReferenceKind::Name, holder: self.holder }, name)
    }

    fn words(&mut self, nouns: &'static [Noun], words: &mut String) -> bool {
        (self.visit)(Reference { nouns, kind: ReferenceKind::Words, holder: self.holder }, words)
    }

    fn labels(&mut self, labels: &mut Vec<LabelChange>) {
        labels.retain_mut(|change| self.words(LABELLED, &mut change.label));
    }
}

/// Empties what does not stay.
fn keep<T>(slot: &mut Option<T>, stays: impl FnOnce(&mut T) -> bool) {
    if slot.as_mut().is_some_and(|value| !stays(value)) {
        *slot = None;
    }
}

impl Document {
    /// Shows `visit` every reference of the project, in a fixed order.
    pub(crate) fn visit_references(&mut self, visit: &mut VisitReference<'_>) {
        let Self {
            version: _,
            step: _,
            last_id: _,
            geometry: _,
            geological_history: _,
            history_until: _,
            restored,
            layer_names: _,
            fonts: _,
            volumes,
            extraction,
            fault_proposals: _,
            horizons,
            faults,
            wells,
            sticks,
            textures,
            style,
            k,
            parameterization,
            scenes,
            notes,
            figures,
        } = self;
        if let Some(ExtractionEntry { key: _, volume }) = extraction {
            // It stays whatever the answer is.
            visit(
                Reference { nouns: VOLUME, kind: ReferenceKind::Record, holder: ReferenceHolder::Extraction },
                volume,
            );
        }
        if let Some(RestoredEntry { from: _, to, datum: _, depth: _ }) = restored {
            visit(Reference { nouns: HORIZON, kind: ReferenceKind::Record, holder: ReferenceHolder::Origin }, to);
        }
        let origins = volumes.iter_mut().map(|entry| &mut entry.origin);
        let origins = origins.chain(horizons.iter_mut().map(|entry| &mut entry.origin));
        let origins = origins.chain(faults.iter_mut().map(|entry| &mut entry.origin));
        let origins = origins.chain(wells.iter_mut().map(|entry| &mut entry.origin));
        let origins = origins.chain(textures.iter_mut().map(|entry| &mut entry.origin));
        let origins = origins.chain(parameterization.iter_mut().map(|entry| &mut entry.origin));
        for (nouns, name) in origins.flat_map(Origin::names_mut) {
            // Where something came from stays true when that is gone.
            visit(Reference { nouns, kind: ReferenceKind::Record, holder: ReferenceHolder::Origin }, name);
        }
        for fault in faults {
            let mut visitor = ReferenceVisitor { visit, holder: ReferenceHolder::Fault(&fault.name) };
            keep(&mut fault.truncated_by, |by| visitor.name(FAULT, by));
        }
        sticks.retain_mut(|drawn| {
            ReferenceVisitor { visit, holder: ReferenceHolder::Sticks }.name(FAULT, &mut drawn.fault)
        });
        visit_style(style, visit);
        *k = std::mem::take(k)
            .into_iter()
            .filter_map(|(mut layer, definition)| {
                let holder = layer.clone();
                let stays = ReferenceVisitor { visit, holder: ReferenceHolder::Layer(&holder) }.name(LAYER, &mut layer);
                stays.then_some((layer, definition))
            })
            .collect();
        for entry in scenes {
            visit_scene(&mut entry.scene, &mut ReferenceVisitor { visit, holder: ReferenceHolder::Scene(&entry.name) });
        }
        for (index, note) in notes.iter_mut().enumerate() {
            let mut visitor = ReferenceVisitor { visit, holder: ReferenceHolder::Note(index + 1) };
            keep(&mut note.scene, |scene| visitor.name(SCENE, scene));
        }
        figures.retain_mut(|entry| {
            let FigureEntry { file, scene, figure } = entry;
            let mut visitor = ReferenceVisitor { visit, holder: ReferenceHolder::Figure(file) };
            keep(scene, |scene| visitor.name(SCENE, scene));
            visit_figure(figure, &mut visitor)
        });
    }
}

fn visit_style(style: &mut Style, visit: &mut VisitReference<'_>) {
    let Style { raw, layers: LayerTtf { styles }, scalars } = style;
    keep(raw, |raw| ReferenceVisitor { visit, holder: ReferenceHolder::Style }.name(VOLUME, &mut raw.volume));
    styles.retain_mut(|style| {
        let holder = style.layer.clone();
        let mut visitor = ReferenceVisitor { visit, holder: ReferenceHolder::Layer(&holder) };
        style.intervals.retain_mut(|interval| visitor.name(TEXTURE, &mut interval.texture));
        visitor.name(LAYER, &mut style.layer)
    });
    scalars.retain_mut(|scalar| {
        let holder = scalar.volume.clone();
        let mut visitor = ReferenceVisitor { visit, holder: ReferenceHolder::Scalars(&holder) };
        scalar.intervals.retain_mut(|interval| visitor.name(TEXTURE, &mut interval.texture));
        visitor.name(VOLUME, &mut scalar.volume)
    });
}

pub(super) fn visit_scene(scene: &mut Scene, visitor: &mut ReferenceVisitor<'_, '_, '_>) {
    let Scene {
        size_px: _,
        samples: _,
        exaggeration: _,
        blend: _,
        global_frequency: _,
        pattern_size: _,
        in_motion: _,
        lookup: _,
        preset: _,
        background: _,
        face_tone: _,
        roaming_box: _,
        camera: _,
        ground: _,
        water: _,
        raw,
        outlines: _,
        cut_outs: _,
        cut_shapes: _,
        face_data: _,
        tree_level: _,
        wells: _,
        hidden_wells,
        media,
        labels,
    } = scene;
    keep(raw, |raw| visitor.name(VOLUME, &mut raw.volume));
    hidden_wells.retain_mut(|well| visitor.name(WELL, well));
    let Media {
        faces: _,
        samples_per_voxel: _,
        shading: _,
        empty_space: _,
        scope: _,
        reach: _,
        cut_outs,
        surroundings,
        horizons,
        isosurfaces,
    } = media;
    for media in [surroundings, cut_outs] {
        media.retain_mut(|medium| visitor.name(VOLUME, &mut medium.volume));
    }
    isosurfaces.retain_mut(|surface| match &mut surface.of {
        IsosurfaceSource::Volume(volume) => visitor.name(VOLUME, volume),
        IsosurfaceSource::Depth => true,
    });
    horizons.retain_mut(|horizon| {
        keep(&mut horizon.paint, |paint| visitor.name(VOLUME, &mut paint.volume));
        horizon.name.as_mut().is_none_or(|name| visitor.name(HORIZON, name))
    });
    visitor.labels(labels);
}

/// Whether the figure still shows something, if it did.
fn visit_figure(figure: &mut Figure, visitor: &mut ReferenceVisitor<'_, '_, '_>) -> bool {
    let Figure {
        size: _,
        dpi: _,
        parts,
        legend: _,
        scale_bar: _,
        north_arrow: _,
        annotate: _,
        credit: _,
        title: _,
        caption: _,
        interpretation: _,
        hidden,
        labels,
        preset: _,
    } = figure;
    hidden.retain_mut(|name| visitor.name(HIDDEN, name));
    visitor.labels(labels);
    let had_parts = !parts.is_empty();
    parts.retain_mut(|part| match part {
        Part::Block(block) => {
            let BlockPart { scene, comparison: _ } = block.as_mut();
            visit_scene(scene, visitor);
            true
        }
        Part::Section(_) | Part::Fence(_) => true,
        Part::Map(MapPart { horizon, thickness_to }) => {
            let [from, to] =
                [Some(horizon), thickness_to.as_mut()].map(|name| name.is_none_or(|name| visitor.name(HORIZON, name)));
            from && to
        }
        Part::Correlation(CorrelationPart { wells, datum, logs: _, range: _ }) => {
            let had_wells = !wells.is_empty();
            wells.retain_mut(|well| visitor.name(WELL, well));
            keep(datum, |surface| visitor.words(HORIZON, surface));
            !(had_wells && wells.is_empty())
        }
        Part::Throw(ThrowPart { fault }) => visitor.name(FAULT, fault),
    });
    !(had_parts && parts.is_empty())
}
