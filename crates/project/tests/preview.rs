//! A page that is looked at before it is written is the page that is written, but for the pixels of its pictures.

use figure::draw::label_changes::{changed, movable};
use figure::{Annotation, BlockPart, Figure, MapPart, PageSize, Part};
use files::ImportOptions;
use glam::DVec2;
use image::RgbaImage;
use page::FileFormat;
use page::list::{DisplayList, Group, Item};
use project::Project;
use project::command::{AddHorizon, Age, Command};
use project::pictures::Device;
use project::pictures::figures::{FigureSettings, InterpreterView, make};
use render::{Ground, LabelChange, Scene, VoxelBox};
use std::path::Path;
use std::sync::Arc;
use survey::{Contact, Progress, SurveyGeometry, VerticalUnit};

fn project(folder: &Path) -> Project {
    let geometry = SurveyGeometry::regular([31, 26, 41], 25.0, 25.0, VerticalUnit::Metres);
    let root = folder.join("p.petro");
    let mut new = Project::create(&root, Some(geometry.clone())).unwrap();
    for (name, depth) in [("Top", 300.0), ("Base", 700.0)] {
        let mut csv = String::from("x,y,z\n");
        for (i, j) in (0..31).flat_map(|i| (0..26).map(move |j| (i, j))) {
            let at = geometry.world_from_voxel([f64::from(i), f64::from(j), 0.0].into());
            csv += &format!("{},{},{}\n", at.x, at.y, depth + 40.0 * (f64::from(i) * 0.3).sin());
        }
        let path = folder.join(format!("{name}.csv"));
        std::fs::write(&path, csv).unwrap();
        let options = ImportOptions::default();
        let add = AddHorizon { path, name: name.into(), contact: Contact::Conformable, age: Age::ByDepth, options };
        new.project().apply(&Command::AddHorizon(add), &Progress::silent()).unwrap();
    }
    new.publish().unwrap();
    Project::open(&root).unwrap()
}

/// The page with every picture of one pixel.
fn laid_out(mut page: DisplayList) -> DisplayList {
    fn blank(items: &mut [Item]) {
        for item in items {
            match item {
                Item::Picture(picture) => picture.pixels = Arc::new(RgbaImage::new(1, 1)),
                Item::Group(Group { items, .. }) => blank(items),
                _ => {}
            }
        }
    }
    blank(&mut page.items);
    page
}

#[test]
fn the_preview_is_the_page_that_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let project = project(folder.path());
    let cut_out = VoxelBox { min: [18.0, 14.0, 0.0], max: [30.0, 25.0, 40.0] };
    // In a file of paths its faces are paths, and its ground is a picture.
    let scene = Scene { cut_outs: vec![cut_out], ground: Some(Ground::default()), ..Scene::default() };
    let map = MapPart { horizon: "Top".into(), thickness_to: None };
    let figure = Figure {
        size: PageSize::Cm([17.3, 8.9]),
        dpi: 283.0,
        parts: vec![BlockPart { scene: scene.clone(), ..BlockPart::default() }.into(), Part::Map(map)],
        legend: true,
        scale_bar: true,
        north_arrow: true,
        annotate: Annotation::ALL.to_vec(),
        title: Some("North".into()),
        ..Figure::default()
    };
    for format in FileFormat::pages() {
        is_previewed(&project, &figure, &scene, format);
    }
}

fn is_previewed(project: &Project, figure: &Figure, scene: &Scene, format: &'static FileFormat) {
    let page = |figure: &Figure, picture_dpi: Option<f64>| {
        let settings =
            FigureSettings { format, device: Device::Cpu, volume_bytes: 1 << 28, fonts: Vec::new(), picture_dpi };
        make(project, figure, &InterpreterView::default(), &settings, &Progress::silent()).unwrap().0.page
    };
    let (written, seen) = (page(figure, None), page(figure, Some(60.0)));
    assert_eq!(laid_out(written.clone()), laid_out(seen.clone()));
    let pixels = |page: &DisplayList| {
        let counted = page.leaves().into_iter().filter_map(|item| match item {
            Item::Picture(picture) => Some(picture.pixels.width() as usize * picture.pixels.height() as usize),
            _ => None,
        });
        counted.max().unwrap()
    };
    assert!(pixels(&written) > 10 * pixels(&seen));
    // With a label of each part dragged.
    let labels: Vec<String> = movable(&seen).into_iter().map(|label| label.label).collect();
    let changes: Vec<LabelChange> = labels
        .iter()
        .step_by(2)
        .map(|label| LabelChange { label: label.clone(), moved_mm: [3.0, -2.0], ..LabelChange::default() })
        .collect();
    assert!(labels.len() > 8 && labels.iter().any(|label| label.contains(": ")), "{labels:?}");
    let mut asked = figure.clone();
    if let Part::Block(block) = &mut asked.parts[0] {
        block.scene = Scene { labels: changes.clone(), ..scene.clone() };
    }
    let dragged = changed(&seen, &changes, figure.printed_in());
    assert_eq!(laid_out(page(&asked, None)), laid_out(dragged));
    assert_ne!(DVec2::ZERO, movable(&seen)[0].bounds.min);
}
