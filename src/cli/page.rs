//! The page of `petroglyph render`: a block alone, or sections, fences, maps, compared blocks, a legend.

use super::args::FigureArgs;
use super::draw::{advise, assumptions, written};
use super::report::Report;
use super::request::{RenderRequest, Usage, numbers};
use anyhow::Context;
use figure::draw::block::Comparison;
use figure::draw::section::Zoom;
use figure::{
    Annotation, BlockPart, CorrelationPart, FencePart, Figure, MapPart, PageSize, Part, SectionKind, SectionPart,
    ThrowPart,
};
use project::pictures::figures::{self, FigureSettings, InterpreterView};
use project::{Project, memory_budget};
use render::{FaceData, Scene};
use std::path::PathBuf;
use survey::Progress;
use system::file;

/// A page that was asked for.
#[derive(Debug, Default)]
pub(super) struct PageRequest {
    sections: Vec<(SectionKind, f64)>,
    fence: Vec<[f64; 2]>,
    /// A map: its horizon (`None`: the topmost one), and the horizon down to which thickness is measured.
    map: Option<(Option<String>, Option<String>)>,
    correlation: Option<Box<CorrelationPart>>,
    /// Faults of which a profile is drawn.
    throws: Vec<String>,
    has_block: bool,
    comparison: Comparison,
    is_interpretation: bool,
    has_legend: bool,
    has_scale_bar: bool,
    has_north_arrow: bool,
    annotations: Vec<Annotation>,
    credit: Option<String>,
    title: Option<String>,
    caption: Option<String>,
    size_cm: Option<[f64; 2]>,
    file: Option<PathBuf>,
    fonts: Vec<PathBuf>,
    proportions: Option<f64>,
    section_blend: Option<f32>,
}

impl PageRequest {
    /// Parses the options of the page.
    pub(super) fn meant(typed: FigureArgs, is_map: bool) -> Result<Self, Usage> {
        let correlation = correlation(&typed)?.map(Box::new);
        let kinds = [
            (SectionKind::Inline, typed.inline),
            (SectionKind::Slice, typed.slice),
            (SectionKind::Crossline, typed.crossline),
        ];
        let sections = kinds.into_iter().flat_map(|(kind, at)| at.into_iter().map(move |at| (kind, at))).collect();
        let corner = |text: &String| numbers::<2>("--fence", text, ',');
        let fence: Vec<[f64; 2]> = typed.fence.iter().map(corner).collect::<Result<_, _>>()?;
        let map = match (typed.map, is_map) {
            (None, false) => None,
            (horizon, _) => Some((horizon, typed.thickness_to)),
        };
        let size_cm = typed.size_cm.as_deref().map(size_cm).transpose()?;
        let is_complete = typed.annotate.iter().any(|name| name == "all");
        let mut annotations = annotations(&typed.annotate)?;
        if typed.credit.is_some() && !annotations.contains(&Annotation::Provenance) {
            annotations.push(Annotation::Provenance);
        }
        if typed.heave {
            // A profile has it below; elsewhere it stands beside the throw.
            annotations.extend((!annotations.contains(&Annotation::Heave)).then_some(Annotation::Heave));
        }
        let meant = Self {
            sections,
            fence,
            map,
            correlation,
            throws: typed.throw,
            has_block: typed.block,
            comparison: comparison(typed.compare.as_deref(), typed.wipe)?,
            is_interpretation: typed.interpretation,
            has_legend: typed.legend || is_complete,
            has_scale_bar: typed.scale_bar || is_complete,
            has_north_arrow: typed.north_arrow || is_complete,
            annotations,
            credit: typed.credit,
            title: typed.title,
            caption: typed.caption,
            size_cm,
            file: typed.figure,
            fonts: typed.font,
            proportions: typed.proportions.map(proportions).transpose()?,
            section_blend: typed.section_blend.map(section_blend).transpose()?,
        };
        let parts = meant.sections.len()
            + usize::from(!meant.fence.is_empty())
            + usize::from(meant.map.is_some())
            + usize::from(meant.correlation.is_some())
            + meant.throws.len()
            + usize::from(meant.has_block);
        if parts > 4 {
            return Err(format!("a page holds at most four parts, these are {parts}: leave some out"));
        }
        Ok(meant)
    }

    /// The figure, with this scene for its block.
    fn figure(&self, scene: &Scene, dpi: f64, project: &Project) -> anyhow::Result<Figure> {
        if let Some(file) = &self.file {
            let text = file::read_text(file, file::MAX_DOCUMENT_BYTES)
                .with_context(|| format!("{} could not be read", file.display()))?;
            return toml::from_str(&text).with_context(|| format!("{} is not a figure", file.display()));
        }
        let show = scene.face_data;
        let has_block = self.has_block
            || self.sections.is_empty()
                && self.fence.is_empty()
                && self.map.is_none()
                && self.correlation.is_none()
                && self.throws.is_empty();
        let section = |(kind, at): &(SectionKind, f64)| {
            Part::Section(SectionPart {
                kind: *kind,
                at: *at,
                show,
                blend: self.section_blend,
                zoom: Zoom::default(),
                proportions: self.proportions,
            })
        };
        let mut parts: Vec<Part> = self.sections.iter().map(section).collect();
        if !self.fence.is_empty() {
            parts.push(Part::Fence(FencePart { corners: self.fence.clone(), show, blend: self.section_blend }));
        }
        if let Some((horizon, thickness_to)) = &self.map {
            let topmost = project.document().horizons.first().map(|entry| entry.name.clone());
            let horizon = horizon.clone().or(topmost).context("a map shows a horizon; the project has none")?;
            parts.push(Part::Map(MapPart { horizon, thickness_to: thickness_to.clone() }));
        }
        parts.extend(self.correlation.as_deref().cloned().map(Part::Correlation));
        parts.extend(self.throws.iter().map(|fault| Part::Throw(ThrowPart { fault: fault.clone() })));
        if self.has_block || parts.is_empty() {
            let scene = if self.is_interpretation { figures::interpreted(scene) } else { scene.clone() };
            parts.insert(0, BlockPart { scene, comparison: self.comparison }.into());
        }
        Ok(Figure {
            size: self.size_cm.map_or(PageSize::Px(scene.size_px), PageSize::Cm),
            dpi,
            parts,
            legend: self.has_legend,
            scale_bar: self.has_scale_bar,
            north_arrow: self.has_north_arrow,
            annotate: self.annotations.clone(),
            credit: self.credit.clone(),
            title: self.title.clone(),
            caption: self.caption.clone(),
            interpretation: self.is_interpretation,
            preset: Some(scene.preset),
            hidden: Vec::new(),
            // A block brings those of its scene.
            labels: if has_block { Vec::new() } else { scene.labels.clone() },
        })
    }
}

/// Parses wells side by side; `None` where they were not asked for.
fn correlation(typed: &FigureArgs) -> Result<Option<CorrelationPart>, Usage> {
    let Some(wells) = &typed.correlation else { return Ok(None) };
    let logs = match typed.log.as_slice() {
        [] => None,
        [none] if none == "none" => Some(Vec::new()),
        names => Some(names.to_vec()),
    };
    let range = typed.well_range.as_deref().map(|text| numbers::<2>("--well-range", text, ',')).transpose()?;
    Ok(Some(CorrelationPart { wells: wells.clone(), datum: typed.datum.clone(), logs, range }))
}

/// Parses what is written on blocks.
fn annotations(typed: &[String]) -> Result<Vec<Annotation>, Usage> {
    let mut meant = Vec::new();
    for name in typed {
        let every = || Annotation::ALL.into_iter().chain(Annotation::ON_REQUEST);
        let known: Vec<Annotation> = match name.as_str() {
            "all" => Annotation::ALL.to_vec(),
            _ => every().filter(|known| known.name() == name).collect(),
        };
        if known.is_empty() {
            let names = every().map(Annotation::name).collect::<Vec<_>>().join(", ");
            return Err(format!("--annotate {name}: expected all, or some of {names}, separated by commas"));
        }
        meant.extend(known.into_iter().filter(|known| !meant.contains(known)).collect::<Vec<_>>());
    }
    Ok(meant)
}

/// Checks how many times longer a metre down is than one across.
fn proportions(factor: f64) -> Result<f64, Usage> {
    let is_usable = (0.01..=1000.0).contains(&factor);
    is_usable.then_some(factor).ok_or_else(|| format!("--proportions {factor}: expected a number from 0.01 to 1000"))
}

/// Checks how much of the measured data sections show.
fn section_blend(blend: f32) -> Result<f32, Usage> {
    let is_usable = (0.0..=1.0).contains(&blend);
    is_usable.then_some(blend).ok_or_else(|| format!("--section-blend {blend}: expected a number from 0 to 1"))
}

/// Parses width and height in centimetres.
pub(super) fn size_cm(text: &str) -> Result<[f64; 2], Usage> {
    let usage = || format!("--size-cm {text}: expected width and height in centimetres such as 16x11");
    let size: [f64; 2] = numbers("--size-cm", &text.replace(['X', '×'], "x"), 'x').map_err(|_| usage())?;
    if size.iter().all(|side| *side > 0.0) { Ok(size) } else { Err(usage()) }
}

/// Parses two blends, side by side or divided by a line.
fn comparison(blends: Option<&str>, wipe: Option<f64>) -> Result<Comparison, Usage> {
    let Some(text) = blends else { return Ok(Comparison::None) };
    let blends = numbers::<2>("--compare", text, ',')?.map(|blend| blend as f32);
    if !blends.iter().all(|blend| (0.0..=1.0).contains(blend)) {
        return Err(format!("--compare {text}: expected two blends between 0 and 1, such as 0,1"));
    }
    match wipe {
        None => Ok(Comparison::SideBySide(blends)),
        Some(share) if (0.0..=1.0).contains(&share) => Ok(Comparison::Wipe(blends, share)),
        Some(share) => Err(format!("--wipe {share}: expected a share of the width between 0 and 1")),
    }
}

/// Makes the page and writes it.
pub(super) fn draw(
    request: &RenderRequest,
    project: &Project,
    scene: &Scene,
    progress: &Progress,
) -> anyhow::Result<Report> {
    let RenderRequest { page, format, device, .. } = request;
    let figure = page.figure(scene, request.dpi, project)?;
    let volume_bytes = request.volume_bytes.unwrap_or_else(memory_budget::half_of_available);
    let (format, device, fonts) = (*format, *device, page.fonts.clone());
    let settings = FigureSettings { format, device, volume_bytes, fonts, picture_dpi: None };
    let (made, loaded) = figures::make(project, &figure, &InterpreterView::default(), &settings, progress)?;
    figures::write(&made.page, format, &request.out, figure.dpi, &project.title())?;
    let mut report = Report::line(written(&request.out, figure.size_px(), figure.dpi));
    advise(&request.project, made.confusions, &mut report);
    let blocks = figure.parts.iter().filter_map(|part| match part {
        Part::Block(block) => Some(&block.scene),
        _ => None,
    });
    if let Some(scene) = blocks.clone().find(|scene| scene.face_data == FaceData::Distortion) {
        super::distortion::say(project.document(), &loaded.distortion(scene, progress)?, &mut report);
    }
    let shown = blocks.clone().map(|scene| assumptions(project, scene)).next().unwrap_or_default();
    shown.iter().for_each(|line| {
        report.say(format!("  {line}"));
    });
    report
        .field("file", &request.out)
        .field("size_px", figure.size_px())
        .field("dpi", figure.dpi)
        .field("parts", figure.parts.len())
        .field("device", made.device)
        .field("assumptions", shown)
        .field("stages", made.stages);
    if let Some(scene) = blocks.clone().next() {
        report.field("exaggeration", scene.exaggeration).field("blend", scene.blend);
    }
    Ok(report)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nonsense_is_a_usage_error() {
        let refused = |typed: FigureArgs| PageRequest::meant(typed, false).unwrap_err();
        refused(FigureArgs { fence: vec!["1,2".into(), "3".into()], ..FigureArgs::default() });
        refused(FigureArgs { compare: Some("0,2".into()), ..FigureArgs::default() });
        refused(FigureArgs { compare: Some("0,1".into()), wipe: Some(1.5), ..FigureArgs::default() });
        refused(FigureArgs { section_blend: Some(1.5), ..FigureArgs::default() });
        refused(FigureArgs { size_cm: Some("16".into()), ..FigureArgs::default() });
        refused(FigureArgs { size_cm: Some("0x4".into()), ..FigureArgs::default() });
        refused(FigureArgs { annotate: vec!["axes".into(), "north".into()], ..FigureArgs::default() });
        refused(FigureArgs { inline: vec![1.0; 5], ..FigureArgs::default() });
    }
}
