//! Whole pages of a closed-form survey: two flat horizons and a fault that moves nothing.

use figure::cut::SectionSource;
use figure::draw::NamedColour;
use figure::draw::block::Comparison;
use figure::draw::label_changes::{LabelChange, changed, movable};
use figure::{
    BlockPart, FencePart, Figure, FigureError, FigureInputs, MapPart, PageSize, Part, SectionKind, SectionPart, make,
};
use glam::DVec2;
use image::{Rgba, RgbaImage};
use model::{ModelSettings, StructuralModel};
use page::list::{DisplayList, Text};
use page::{Rect, raster};
use render::{FaceData, Inputs, NamedVolume, Scene};
use survey::{
    Contact, Horizon, NodeGrid, Progress, Quality, Sheet, StratigraphicHorizon, Stratigraphy, SurveyGeometry,
    VerticalUnit, Volume,
};
use ttf::{Colour, ColourMap, LayerStyle, RawColour, RgbaFunction, TextureLibrary};

const SIZE: [usize; 3] = [31, 25, 41];

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular(SIZE, 25.0, 4.0, VerticalUnit::Milliseconds)
}

fn model(geometry: &SurveyGeometry) -> StructuralModel {
    let grid = NodeGrid::of_survey(geometry);
    let flat =
        |name: &str, ms: f32| Horizon::new(name, vec![Sheet::new(grid, vec![ms; SIZE[0] * SIZE[1]], Quality::Picked)]);
    let horizon = |name: &str| StratigraphicHorizon { name: name.into(), contact: Contact::Conformable };
    let stratigraphy = Stratigraphy { horizons: ["Top", "Base"].map(horizon).into(), layer_names: Vec::new() };
    let horizons = [flat("Top", 40.0), flat("Base", 120.0)];
    let settings = ModelSettings::default();
    StructuralModel::build(geometry, &stratigraphy, &horizons, &[], &settings, &Progress::silent()).unwrap()
}

fn made(figure: &Figure) -> Result<DisplayList, FigureError> {
    made_of(&model(&geometry()), figure, &[], None)
}

fn made_of(
    model: &StructuralModel,
    figure: &Figure,
    layers: &[LayerStyle],
    library: Option<&TextureLibrary>,
) -> Result<DisplayList, FigureError> {
    let geometry = geometry();
    let volume = Volume::filled(SIZE, 1.0f32);
    let volumes = [NamedVolume::whole("seismic", &volume)];
    let raw = RawColour::new("seismic", RgbaFunction::over(ColourMap::Grey, [0.0, 2.0]));
    let data = Inputs { model: Some(model), ..Inputs::raw(&geometry, &volumes) };
    let horizons = [("Top", Colour::new(255, 0, 0)), ("Base", Colour::new(0, 0, 255))]
        .map(|(name, colour)| NamedColour { name: name.into(), colour });
    let inputs = FigureInputs {
        source: SectionSource { data, raw: Some(&raw) },
        horizons: &horizons,
        strata: &model.stratigraphy().horizons,
        outlined: &[],
        wells: &[],
        faults: &[],
        fault_colours: &[],
        layers,
        library,
        interpretation: None,
        provenance: "Petroglyph · survey",
    };
    let mut paint = |scene: &Scene| {
        Ok(RgbaImage::from_pixel(scene.size_px[0], scene.size_px[1], Rgba([(255.0 * scene.blend) as u8, 90, 0, 255])))
    };
    make(figure, &inputs, &mut paint)
}

fn section(kind: SectionKind, at: f64) -> Part {
    Part::Section(SectionPart {
        kind,
        at,
        show: FaceData::Rock,
        blend: None,
        zoom: Default::default(),
        proportions: None,
    })
}

fn figure(parts: Vec<Part>) -> Figure {
    Figure { size: PageSize::Cm([14.0, 10.0]), dpi: 150.0, parts, legend: true, scale_bar: true, ..Figure::default() }
}

fn parts() -> Vec<Part> {
    vec![
        section(SectionKind::Inline, 12.0),
        section(SectionKind::Slice, 80.0),
        Part::Fence(FencePart {
            corners: vec![[2.0, 3.0], [20.0, 9.0], [30.0, 24.0]],
            show: FaceData::Rock,
            blend: None,
        }),
        Part::Map(MapPart { horizon: "Top".into(), thickness_to: Some("Base".into()) }),
    ]
}

/// Rows of the page, in points, in which a colour is seen within a column.
fn rows(image: &RgbaImage, colour: [u8; 3], x: u32) -> Vec<f64> {
    let is_near = |pixel: &Rgba<u8>| (0..3).all(|c| pixel.0[c].abs_diff(colour[c]) < 60);
    let rows = (0..image.height()).filter(|&y| is_near(image.get_pixel(x, y)));
    rows.map(|y| (f64::from(y) + 0.5) * 72.0 / 150.0).collect()
}

#[test]
fn a_flat_horizon_lies_beside_its_time_on_the_axis() {
    let page = made(&figure(vec![section(SectionKind::Inline, 12.0)])).unwrap();
    let image = raster(&page, 150.0).unwrap();
    let number = |value: &str| page.texts().into_iter().find(|text| text.text == value).unwrap().at.y;
    // Linear between the numbers 0 and 100 along the left edge.
    let at = |ms: f64| number("0") + (number("100") - number("0")) * ms / 100.0;
    for (colour, ms) in [([255, 0, 0], 40.0), ([0, 0, 255], 120.0)] {
        let found = rows(&image, colour, 300);
        let middle = found.iter().sum::<f64>() / found.len() as f64;
        assert!((middle - at(ms)).abs() < 0.35, "{ms} ms lies at {middle}, not at {}", at(ms));
        assert!((found.last().unwrap() - found[0] - 1.2).abs() < 1.0, "a line of 1.2 points");
    }
}

/// Twenty-four crosslines of 25 m across, 40 samples of 4 ms down.
#[test]
fn a_section_has_the_proportions_that_were_asked_for() {
    for factor in [0.5, 1.0, 2.0] {
        let mut part = SectionPart {
            kind: SectionKind::Inline,
            at: 12.0,
            show: FaceData::Rock,
            blend: None,
            zoom: Default::default(),
            proportions: Some(factor),
        };
        let picture = |part: SectionPart| {
            let page = made(&figure(vec![Part::Section(part)])).unwrap();
            let pictures = page.leaves().into_iter().filter_map(|item| match item {
                page::list::Item::Picture(picture) => Some(picture.down.y / picture.right.x),
                _ => None,
            });
            pictures.into_iter().next().unwrap()
        };
        let geometry = geometry();
        // A picture has a whole pixel for each sample, half of it outside of the section.
        let metres = [25.0 * geometry.crossline_vector.length(), 41.0 * geometry.sample_m()];
        assert!((picture(part) - factor * metres[1] / metres[0]).abs() < 1e-3, "{factor}: {}", picture(part));
        part.proportions = None;
        assert!((picture(part) - factor * metres[1] / metres[0]).abs() > 0.01);
    }
}

#[test]
fn what_is_hidden_has_no_line() {
    let shown = figure(vec![section(SectionKind::Inline, 12.0)]);
    let has = |figure: &Figure, colour: [u8; 3]| {
        !rows(&raster(&made(figure).unwrap(), 150.0).unwrap(), colour, 300).is_empty()
    };
    let [top, base] = [[255, 0, 0], [0, 0, 255]];
    assert!(has(&shown, top) && has(&shown, base));
    let hidden = Figure { hidden: vec!["Top".into()], legend: false, ..shown };
    assert!(!has(&hidden, top) && has(&hidden, base));
}

#[test]
fn texts_of_a_full_page_lie_within_it_and_none_over_another() {
    for size in [[14.0, 10.0], [9.0, 14.0], [24.0, 18.0]] {
        let page = made(&Figure { size: PageSize::Cm(size), ..figure(parts()) }).unwrap();
        let texts: Vec<&Text> = page.texts();
        assert!(texts.len() > 20);
        let inner = |text: &Text| Rect::new(text.bounds().min + 0.8, text.bounds().max - 0.8);
        for (n, text) in texts.iter().enumerate() {
            let bounds = text.bounds();
            assert!(page.bounds().grown(0.5).contains(bounds.min) && page.bounds().grown(0.5).contains(bounds.max));
            for other in &texts[..n] {
                // Turned text is left out: its upright bounds are larger than itself.
                let is_flat = text.turn_deg == 0.0 && other.turn_deg == 0.0;
                assert!(!is_flat || !inner(text).meets(&inner(other)), "{} over {} at {size:?}", text.text, other.text);
            }
        }
    }
}

#[test]
fn the_same_figure_is_the_same_page_and_the_same_bytes() {
    let figure = figure(parts());
    let (one, two) = (made(&figure).unwrap(), made(&figure).unwrap());
    assert!(one == two);
    assert!(raster(&one, 100.0).unwrap() == raster(&two, 100.0).unwrap());
}

#[test]
fn a_wipe_shows_one_blend_on_each_side() {
    let part = BlockPart { scene: Scene::default(), comparison: Comparison::Wipe([0.0, 1.0], 0.25) };
    let page = Figure { legend: false, scale_bar: false, ..figure(vec![part.into()]) };
    let image = raster(&made(&page).unwrap(), 150.0).unwrap();
    let quarter = image.width() / 4;
    assert_eq!(image.get_pixel(quarter - 20, 400).0[0], 0);
    assert_eq!(image.get_pixel(quarter + 20, 400).0[0], 255);
}

#[test]
fn a_picture_of_distortion_has_its_colours_in_the_legend() {
    let library = TextureLibrary::builtin().unwrap();
    let layers = [LayerStyle::textured("Chalk", Colour::WHITE, "chalk")];
    let legend = |face_data: FaceData| -> Vec<String> {
        let scene = Scene { face_data, ..Scene::default() };
        let page = figure(vec![BlockPart { scene, comparison: Comparison::None }.into()]);
        let made = made_of(&model(&geometry()), &page, &layers, Some(&library)).unwrap();
        made.texts().into_iter().map(|text| text.text.clone()).collect()
    };
    let measured = legend(FaceData::Distortion);
    let classes = ["4 × too dense", "2 × too dense", "undistorted", "2 × too sparse", "4 × too sparse"];
    assert!(classes.iter().all(|class| measured.iter().any(|text| text == class)), "{measured:?}");
    assert!(!measured.contains(&"Chalk".to_owned()) && legend(FaceData::Rock).contains(&"Chalk".to_owned()));
}

/// A slice is a plan: under it stand its own scale and no exaggeration, neither its own nor the block's beside it.
#[test]
fn under_a_slice_stands_no_exaggeration() {
    let scene = Scene { exaggeration: 2.5, ..Scene::default() };
    let block: Part = BlockPart { scene, comparison: Comparison::None }.into();
    let page = |parts: Vec<Part>| -> (usize, Vec<String>) {
        let made = made(&Figure { scale_bar: true, ..figure(parts) }).unwrap();
        let texts = made.texts().into_iter().map(|text| text.text.clone());
        let (told, rest): (Vec<String>, Vec<String>) = texts.partition(|text| text.contains("exaggeration"));
        (told.len(), rest)
    };
    let (told, rest) = page(vec![section(SectionKind::Slice, 12.0)]);
    assert!(told == 0 && rest.iter().any(|text| text.ends_with(" m")), "{told} {rest:?}");
    assert_eq!(page(vec![section(SectionKind::Inline, 12.0)]).0, 1);
    assert_eq!(page(vec![block, section(SectionKind::Slice, 12.0)]).0, 1);
}

#[test]
fn what_has_no_page_is_refused() {
    assert!(matches!(made(&figure(Vec::new())), Err(FigureError::Parts { found: 0 })));
    assert!(matches!(made(&figure(vec![section(SectionKind::Inline, 99.0)])), Err(FigureError::Outside { .. })));
    let tiny = Figure { size: PageSize::Px([30, 30]), ..figure(parts()) };
    assert!(matches!(made(&tiny), Err(FigureError::NoRoom { .. })));
    let seen = Figure { interpretation: true, ..figure(parts()) };
    assert!(matches!(made(&seen), Err(FigureError::NoInterpretation)));
    let short = Part::Fence(FencePart { corners: vec![[2.0, 3.0]; 3], show: FaceData::Rock, blend: None });
    assert!(matches!(made(&figure(vec![short])), Err(FigureError::ShortFence { corners: 1 })));
}

#[test]
fn labels_of_maps_and_sections_stand_where_they_were_moved() {
    let plain = Figure { title: Some("North".into()), ..figure(parts()) };
    let page = made(&plain).unwrap();
    let before = movable(&page);
    let by = DVec2::new(2.0, -1.5);
    let names = before.iter().map(|label| label.label.as_str()).collect::<Vec<_>>();
    assert!(names.contains(&"Inline 12: heading") && names.contains(&"Inline 12: axes"), "{names:?}");
    assert!(names.iter().any(|name| name.ends_with(": north arrow")), "{names:?}");
    for label in ["Inline 12: heading", "Inline 12: scale bar", "title", "legend"] {
        let moved = LabelChange { label: label.into(), moved_mm: by.to_array(), ..LabelChange::default() };
        let dragged = changed(&page, std::slice::from_ref(&moved), ttf::Preset::Colour);
        // What the preview shows is what is made.
        assert_eq!(dragged, made(&Figure { labels: vec![moved], ..plain.clone() }).unwrap(), "{label}");
        for (a, b) in before.iter().zip(movable(&dragged)) {
            let expected = if a.label == label { by * 72.0 / 25.4 } else { DVec2::ZERO };
            assert!((b.bounds.min - a.bounds.min - expected).length() < 1e-6, "{label} {}", a.label);
        }
    }
    let hidden = LabelChange { label: "Inline 12: heading".into(), is_hidden: true, ..LabelChange::default() };
    let without = made(&Figure { labels: vec![hidden], ..plain }).unwrap();
    assert!(!movable(&without).iter().any(|label| label.label == "Inline 12: heading"));
}
