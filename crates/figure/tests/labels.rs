//! Labels of random pages of every kind: none lies over another, none leaves the page, none is too small to read.

use figure::cut::SectionSource;
use figure::draw::NamedColour;
use figure::draw::block::Comparison;
use figure::draw::label_changes::{Movable, movable};
use figure::{
    Annotation, BlockPart, CorrelationPart, FencePart, Figure, FigureError, FigureInputs, MapPart, PageSize, Part,
    SectionKind, SectionPart, make,
};
use glam::DVec2;
use image::RgbaImage;
use model::{ModelSettings, StructuralModel};
use page::Rect;
use page::list::{DisplayList, Text};
use render::{Corner, DrawnWell, FaceData, Ground, Inputs, NamedVolume, Projection, Scene, VoxelBox, Water};
use survey::well::{Survey as Station, Top, WellPath};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume, Well};
use synth::closed_form::ClosedForm;
use ttf::{Colour, ColourMap, LayerStyle, RawColour, RgbaFunction, TextureLibrary};

const SIZE: [usize; 3] = [31, 25, 41];

fn geometry() -> SurveyGeometry {
    SurveyGeometry::regular(SIZE, 25.0, 4.0, VerticalUnit::Milliseconds)
}

/// Two horizons, flat or folded, and a fault that moves them.
fn model(dip_deg: f64, throw: f64) -> StructuralModel {
    let geometry = geometry();
    let depths = [10.0, 26.0];
    let closed = match dip_deg {
        0.0 => ClosedForm::flat(&geometry, &depths),
        dip_deg => ClosedForm::dome(&geometry, &depths, dip_deg),
    };
    let closed = closed.with_fault(60.0, throw);
    let (settings, quiet) = (ModelSettings::default(), Progress::silent());
    StructuralModel::build(&geometry, &closed.stratigraphy, &closed.horizons, &closed.faults, &settings, &quiet)
        .unwrap()
}

/// A vertical well with two tops.
fn well(name: &str, x: f64, y: f64) -> Well {
    let station = |md_m: f64| Station { md_m, inclination_deg: 0.0, azimuth_deg: 0.0 };
    let path = WellPath::minimum_curvature(DVec2::new(25.0 * x, 25.0 * y), 0.0, &[station(0.0), station(160.0)]);
    let top = |name: &str, md_m: f64| Top { name: name.into(), md_m };
    Well { tops: vec![top("H1", 38.0), top("H2", 104.0), top("a marker", 60.0)], ..Well::new(name, path.unwrap()) }
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
    let wells = [well("A-1", 6.0, 5.0), well("Deep test 2", 8.0, 6.0), well("B", 22.0, 17.0)];
    let paths: Vec<_> = wells.iter().map(|well| well.path_in_voxels(&geometry)).collect();
    let drawn =
        wells.iter().zip(&paths).map(|(well, path)| DrawnWell { name: &well.name, colour: None, path, tops: &[] });
    let drawn: Vec<DrawnWell> = drawn.collect();
    let data = Inputs { model: Some(model), wells: &drawn, ..Inputs::raw(&geometry, &volumes) };
    let horizons = [("H1", Colour::new(255, 0, 0)), ("H2", Colour::new(0, 0, 255))]
        .map(|(name, colour)| NamedColour { name: name.into(), colour });
    let inputs = FigureInputs {
        source: SectionSource { data, raw: Some(&raw) },
        horizons: &horizons,
        strata: &model.stratigraphy().horizons,
        outlined: &[],
        wells: &wells,
        faults: &["Northern boundary fault".to_owned()],
        fault_colours: &[],
        layers,
        library,
        interpretation: None,
        provenance: "Petroglyph · survey",
    };
    let mut paint = |scene: &Scene| Ok(RgbaImage::new(scene.size_px[0], scene.size_px[1]));
    make(figure, &inputs, &mut paint)
}

/// Numbers that look random, the same in every run (Knuth's linear congruential generator).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.below(1001) as f64 / 1000.0
    }

    fn is_so(&mut self) -> bool {
        self.below(2) == 1
    }
}

fn section(random: &mut Random, kind: SectionKind, [first, last]: [f64; 2]) -> Part {
    let at = random.between(first, last).round();
    let proportions = random.is_so().then(|| random.between(0.3, 4.0));
    let blend = Some(0.5 * random.below(3) as f32);
    Part::Section(SectionPart { kind, at, show: FaceData::Rock, blend, zoom: Default::default(), proportions })
}

/// A figure of blocks, or of parts of all kinds, with every annotation switched by chance.
fn random_figure(random: &mut Random, has_all: bool) -> Figure {
    let words = "Seen towards north-west, with a corner cut away that shows how the folded limestone ends at the fault";
    let mut said = |most: u64| {
        let count = random.below(most) as usize;
        (count > 0).then(|| words.split(' ').cycle().take(count).collect::<Vec<_>>().join(" "))
    };
    let (title, caption) = (said(9), said(40));
    let block = |random: &mut Random| {
        let mut scene = Scene::default();
        scene.camera.azimuth_deg = Some(random.between(0.0, 360.0));
        scene.camera.elevation_deg = random.between(-80.0, 90.0);
        if random.is_so() {
            scene.camera.projection = Projection::Perspective { fov_deg: random.between(10.0, 70.0) };
        }
        scene.exaggeration = random.between(0.5, 5.0);
        scene.blend = random.below(3) as f32 * 0.5;
        if random.is_so() {
            let corner = Corner::ALL[random.below(4) as usize];
            let share = [random.between(0.2, 0.8), random.between(0.2, 0.8)];
            scene.cut_outs = vec![VoxelBox::of_size(SIZE).corner_cut(corner, share)];
        }
        scene.ground = random.is_so().then(Ground::default);
        scene.water = random.is_so().then(Water::default);
        BlockPart { scene, comparison: Comparison::None }.into()
    };
    let part = |random: &mut Random| match random.below(if has_all { 9 } else { 1 }) {
        1 => section(random, SectionKind::Inline, [1.0, 31.0]),
        2 => section(random, SectionKind::Crossline, [1.0, 25.0]),
        3 => section(random, SectionKind::Slice, [0.0, 160.0]),
        4 | 5 => {
            let corner = |random: &mut Random| [random.between(1.0, 31.0), random.between(1.0, 25.0)];
            let corners = (0..2 + random.below(3)).map(|_| corner(random)).collect();
            Part::Fence(FencePart { corners, show: FaceData::Rock, blend: Some(0.5 * random.below(3) as f32) })
        }
        6 => {
            let thickness_to = random.is_so().then(|| "H2".to_owned());
            Part::Map(MapPart { horizon: "H1".into(), thickness_to })
        }
        7 => {
            let datum = random.is_so().then(|| "H1".to_owned());
            Part::Correlation(CorrelationPart { datum, ..CorrelationPart::default() })
        }
        _ => block(random),
    };
    let count = 1 + random.below(4);
    Figure {
        size: PageSize::Cm([random.between(5.0, 25.0), random.between(4.0, 18.0)]),
        dpi: 72.0,
        parts: (0..count).map(|_| part(random)).collect(),
        legend: random.is_so(),
        scale_bar: random.is_so(),
        north_arrow: random.is_so(),
        annotate: Annotation::ALL.into_iter().filter(|_| random.below(4) > 0).collect(),
        credit: Some("TNO and dGB Earth Sciences, CC BY-SA 3.0".into()),
        title,
        caption,
        ..Figure::default()
    }
}

#[test]
fn no_two_labels_overlap_on_two_hundred_random_pages_of_blocks() {
    let (drawn, labels) = checked(260, false);
    assert!(drawn >= 200 && labels > 1000, "{drawn} pages, {labels} labels");
}

#[test]
fn no_two_labels_overlap_on_two_hundred_random_pages_of_all_kinds() {
    let (drawn, labels) = checked(320, true);
    assert!(drawn >= 200 && labels > 4000, "{drawn} pages, {labels} labels");
}

/// How many of so many random pages have room for their parts, and how many labels these have.
fn checked(pages: usize, has_all: bool) -> (usize, usize) {
    let library = TextureLibrary::builtin().unwrap();
    let models = [model(0.0, 0.0), model(0.0, 5.0), model(25.0, 5.0)];
    let mut random = Random(16);
    let (mut drawn, mut labels) = (0, 0);
    for n in 0..pages {
        let figure = random_figure(&mut random, has_all);
        let style = |k: u64| match format!("Layer {k} of marl and chalk") {
            name if k == 0 => LayerStyle::textured(&name, Colour::WHITE, "shale"),
            name => LayerStyle::plain(&name, Colour::WHITE),
        };
        let layers: Vec<LayerStyle> = (0..random.below(14)).map(style).collect();
        let page = match made_of(&models[n % 3], &figure, &layers, Some(&library)) {
            Ok(page) => page,
            Err(FigureError::NoRoom { .. }) => continue,
            Err(error) => panic!("page {n}: {error}"),
        };
        drawn += 1;
        let texts = page.texts();
        labels += texts.len();
        for text in &texts {
            let letters = lettering(text);
            let is_inside = letters.iter().flatten().all(|corner| page.bounds().contains(*corner));
            assert!(is_inside, "page {n}: {} at {letters:?} leaves {:?}", text.text, page.size);
            assert!((7.0..=12.0).contains(&text.size), "page {n}: {} is set in {} points", text.text, text.size);
        }
        // A fault's label is called by its name, beside its line or with a leader, whatever throw is written.
        for name in
            texts.iter().filter_map(|text| text.text.strip_suffix(" ms")?.rsplit_once(", ")).map(|(name, _)| name)
        {
            let is_called = |label: &Movable| label.label == name;
            assert!(has_all || movable(&page).iter().any(is_called), "page {n}: {name}");
        }
        let over = overlapping(&texts);
        assert!(over.is_none(), "page {n}: {over:?}");
        // A label that is dragged onto another is found.
        let middle = |text: &Text| lettering(text).first().map(|corners| corners.iter().sum::<DVec2>() / 4.0);
        if let [first, .., last] = &texts[..]
            && let (Some(to), Some(from)) = (middle(first), middle(last))
        {
            let mut dragged = (*last).clone();
            dragged.shift(to - from);
            assert!(overlapping(&[first, &dragged]).is_some(), "page {n}: {} on {}", dragged.text, first.text);
        }
    }
    (drawn, labels)
}

/// Two texts of which one lies over the other.
fn overlapping<'a>(texts: &[&'a Text]) -> Option<[&'a str; 2]> {
    let letters: Vec<Vec<[DVec2; 4]>> = texts.iter().map(|text| lettering(text)).collect();
    let is_over = |a: usize, b: usize| letters[a].iter().any(|one| letters[b].iter().any(|other| meet(one, other)));
    let pairs = (0..texts.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let mut near = pairs.filter(|(a, b)| texts[*a].bounds().meets(&texts[*b].bounds()));
    near.find(|(a, b)| is_over(*a, *b)).map(|(a, b)| [texts[a].text.as_str(), texts[b].text.as_str()])
}

/// The rectangles around a text's letters, turned as they are: one, or one for each letter of a bent text.
fn lettering(text: &Text) -> Vec<[DVec2; 4]> {
    let turned = |line: Text| {
        let Rect { min, max } = line.clone().turned(0.0).outline().bounds()?;
        let turn = DVec2::from_angle(line.turn_deg.to_radians());
        let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
        Some(corners.map(|corner| line.at + turn.rotate(corner - line.at)))
    };
    text.straight().into_iter().filter_map(turned).collect()
}

/// Whether two rectangles meet: no line along a side of either parts them.
fn meet(one: &[DVec2; 4], other: &[DVec2; 4]) -> bool {
    let span = |corners: &[DVec2; 4], axis: DVec2| {
        let along = corners.map(|corner| corner.dot(axis));
        [along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max)]
    };
    let axes = [one, other].into_iter().flat_map(|corners| [corners[1] - corners[0], corners[3] - corners[0]]);
    !axes.into_iter().any(|axis| {
        let ([low, high], [other_low, other_high]) = (span(one, axis), span(other, axis));
        high < other_low || other_high < low
    })
}
