//! What is written on a block, against closed forms: throws, half-arrows, names within their layers, axes.

use figure::cut::SectionSource;
use figure::draw::NamedColour;
use figure::draw::label_changes::movable;
use figure::{Annotation, BlockPart, Figure, FigureInputs, PageSize, make};
use glam::{DVec2, DVec3};
use image::RgbaImage;
use model::{ModelSettings, StructuralModel};
use page::list::{DisplayList, Group, GroupKind, Item, Segment, Text};
use render::{DrawnWell, Ground, Inputs, LabelChange, NamedVolume, Projection, Scene, VoxelBox, Water, pick};
use survey::well::{Survey as Station, Top, WellPath};
use survey::{Progress, SurveyGeometry, VerticalUnit, Volume, Well};
use synth::closed_form::ClosedForm;
use ttf::{Colour, ColourMap, LayerStyle, RawColour, RgbaFunction, TextureLibrary};

const DPI: f64 = 144.0;

/// A survey with its model, and what is read of a page.
struct Survey {
    geometry: SurveyGeometry,
    closed: ClosedForm,
    model: StructuralModel,
    volume: Volume<f32>,
    layers: Vec<LayerStyle>,
    wells: Vec<Well>,
    has_legend: bool,
}

impl Survey {
    fn new(closed: impl Fn(&SurveyGeometry) -> ClosedForm) -> Self {
        let geometry = SurveyGeometry::regular([61, 41, 51], 12.5, 12.5, VerticalUnit::Metres);
        let closed = closed(&geometry);
        let (settings, quiet) = (ModelSettings::default(), Progress::silent());
        let model = StructuralModel::build(
            &geometry,
            &closed.stratigraphy,
            &closed.horizons,
            &closed.faults,
            &settings,
            &quiet,
        );
        let names = closed.stratigraphy.layer_names_bottom_up();
        let layers = (0..names.len()).rev().map(|n| LayerStyle::plain(&format!("Bed {n}"), Colour::WHITE)).collect();
        Self {
            volume: Volume::filled(geometry.size(), 1.0f32),
            model: model.unwrap(),
            geometry,
            closed,
            layers,
            wells: Vec::new(),
            has_legend: false,
        }
    }

    fn raw() -> RawColour {
        RawColour::new("seismic", RgbaFunction::over(ColourMap::Grey, [-3.0, 3.0]))
    }

    fn page(&self, scene: &Scene, annotate: &[Annotation]) -> (DisplayList, Scene) {
        let volumes = [NamedVolume::whole("seismic", &self.volume)];
        let paths: Vec<Vec<DVec3>> = self.wells.iter().map(|well| well.path_in_voxels(&self.geometry)).collect();
        let top = |well: &Well| well.tops.iter().filter_map(|top| well.voxel_at_md(top.md_m, &self.geometry)).collect();
        let tops: Vec<Vec<DVec3>> = self.wells.iter().map(top).collect();
        let drawn = self.wells.iter().zip(paths.iter().zip(&tops)).map(|(well, (path, tops))| DrawnWell {
            name: &well.name,
            colour: None,
            path,
            tops,
        });
        let wells: Vec<DrawnWell> = drawn.collect();
        let data = Inputs { model: Some(&self.model), wells: &wells, ..Inputs::raw(&self.geometry, &volumes) };
        let library = TextureLibrary::builtin().unwrap();
        let inputs = FigureInputs {
            source: SectionSource { data, raw: Some(&Self::raw()) },
            horizons: &[NamedColour { name: "H1".into(), colour: Colour::BLACK }],
            strata: &self.closed.stratigraphy.horizons,
            outlined: &[],
            wells: &self.wells,
            faults: &["F1".to_owned()],
            fault_colours: &[],
            layers: &self.layers,
            library: Some(&library),
            interpretation: None,
            provenance: "Petroglyph · survey",
        };
        let part = BlockPart { scene: scene.clone(), ..BlockPart::default() };
        let figure = Figure {
            size: PageSize::Cm([16.0, 11.0]),
            dpi: DPI,
            annotate: annotate.to_vec(),
            legend: self.has_legend,
            credit: Some("nobody".into()),
            ..Figure::of(part.into())
        };
        let mut asked = Scene::default();
        let mut paint = |scene: &Scene| {
            asked = scene.clone();
            Ok(RgbaImage::new(scene.size_px[0], scene.size_px[1]))
        };
        let page = make(&figure, &inputs, &mut paint).unwrap();
        (page, asked)
    }
}

fn said(page: &DisplayList) -> Vec<String> {
    page.texts().into_iter().map(|text| text.text.clone()).collect()
}

fn groups<'a>(items: &'a [Item], name: &str, into: &mut Vec<&'a Group>) {
    for item in items {
        if let Item::Group(group) = item {
            if group.name == name {
                into.push(group);
            }
            groups(&group.items, name, into);
        }
    }
}

fn corner(page: &DisplayList) -> DVec2 {
    let pictures = page.leaves().into_iter().filter_map(|item| match item {
        Item::Picture(picture) => Some(picture.corner),
        _ => None,
    });
    pictures.into_iter().next().unwrap()
}

/// Flat beds, moved by six samples of 12.5 m along a fault: 75 m, whichever side went down.
#[test]
fn the_throw_is_that_of_the_model_and_arrows_point_the_way_the_sides_went() {
    for throw in [6.0, -6.0] {
        let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0, 38.0]).with_fault(65.0, throw));
        let (page, scene) = survey.page(&Scene::default(), &[Annotation::Faults]);
        assert!(said(&page).contains(&"F1, 75 m".to_owned()), "{:?}", said(&page));
        let mut arrows = Vec::new();
        groups(&page.items, "half-arrows", &mut arrows);
        assert_eq!(arrows.len(), 1);
        let view = scene.view(&survey.geometry);
        // The hanging wall lies towards larger x.
        let ahead = view.project(DVec3::new(60.0, 0.0, 25.0)) - view.project(DVec3::new(0.0, 0.0, 25.0));
        let drawn: Vec<[DVec2; 2]> = arrows[0].items[2..].iter().map(arrow).collect();
        let is_hanging_first = (drawn[0][0] - drawn[1][0]).dot(ahead) > 0.0;
        let hanging = drawn[usize::from(!is_hanging_first)];
        assert_eq!(hanging[1].y > hanging[0].y, throw > 0.0, "the hanging wall went {throw} samples down");
        let foot = drawn[usize::from(is_hanging_first)];
        assert_eq!(foot[1].y > foot[0].y, throw < 0.0);
    }
}

/// Tail and tip of an arrow.
fn arrow(item: &Item) -> [DVec2; 2] {
    let Item::Path(path) = item else { panic!("no path") };
    match path.path.segments[..2] {
        [Segment::Move(tail), Segment::Line(tip)] => [tail, tip],
        _ => panic!("no arrow"),
    }
}

#[test]
fn a_fault_that_moves_nothing_has_a_name_and_neither_throw_nor_arrows() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0]).with_fault(65.0, 0.0));
    let (page, _) = survey.page(&Scene::default(), &[Annotation::Faults]);
    assert!(said(&page).contains(&"F1".to_owned()));
    let mut arrows = Vec::new();
    groups(&page.items, "half-arrows", &mut arrows);
    assert!(arrows.is_empty());
}

/// What lies under every corner of a letter is asked of the renderer, which knows nothing of labels.
#[test]
fn every_letter_of_a_name_lies_on_its_own_layer_from_any_side() {
    let survey = Survey::new(|geometry| ClosedForm::dome(geometry, &[10.0, 22.0, 36.0], 30.0).with_fault(65.0, 6.0));
    let volumes = [NamedVolume::whole("seismic", &survey.volume)];
    let inputs = Inputs { model: Some(&survey.model), ..Inputs::raw(&survey.geometry, &volumes) };
    let mut letters = 0;
    for (azimuth, elevation, projection) in [
        (35.0, 28.0, Projection::Orthographic),
        (130.0, 15.0, Projection::Orthographic),
        (250.0, 40.0, Projection::Perspective { fov_deg: 40.0 }),
    ] {
        let mut scene = Scene::default();
        (scene.camera.azimuth_deg, scene.camera.elevation_deg) = (Some(azimuth), elevation);
        scene.camera.projection = projection;
        let (page, asked) = survey.page(&scene, &[Annotation::Layers]);
        let corner = corner(&page);
        let seen = Scene { blend: 1.0, raw: Some(Survey::raw()), ..asked };
        for text in page.texts().into_iter().filter(|text| !text.letters.is_empty()) {
            let layer: u16 = text.text.strip_prefix("Bed ").unwrap().parse().unwrap();
            for letter in text.straight().into_iter().filter(|letter| letter.text != " ") {
                let pixel = (letter.outline().bounds().unwrap().centre() - corner) * DPI / 72.0;
                let hit = pick(&seen, &inputs, pixel).unwrap().expect("a letter beside the block");
                assert_eq!(hit.region.unwrap().layer, layer, "{} from {azimuth}", text.text);
                letters += 1;
            }
        }
    }
    assert!(letters > 30, "{letters} letters");
}

/// A layer of two samples has no room for letters.
#[test]
fn a_thin_layer_is_named_beside_the_block_with_a_leader() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[20.0, 22.0]));
    let (page, _) = survey.page(&Scene::default(), &[Annotation::Layers]);
    let named = |name: &str| page.texts().into_iter().find(|text| text.text == name).cloned().unwrap();
    assert!(named("Bed 1").letters.is_empty() && !named("Bed 0").letters.is_empty());
    let mut leaders = Vec::new();
    groups(&page.items, "Bed 1", &mut leaders);
    leaders.retain(|group| group.kind == GroupKind::Leader);
    assert_eq!(leaders.len(), 1);
    assert!(survey.closed.horizons.len() == 2);
}

/// All three titles stand on the page, turned along their edges, wherever the camera is.
#[test]
fn axes_have_titles_and_numbers_beside_the_block_from_any_camera() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[20.0]));
    for azimuth in [0.0, 20.0, 77.0, 140.0, 235.0, 300.0] {
        for elevation in [-50.0, -10.0, 8.0, 30.0, 65.0] {
            let mut scene = Scene::default();
            (scene.camera.azimuth_deg, scene.camera.elevation_deg) = (Some(azimuth), elevation);
            let (page, asked) = survey.page(&scene, &[Annotation::Axes]);
            let (view, corner) = (asked.view(&survey.geometry), corner(&page));
            let block = asked.box_in(&survey.geometry);
            let on_page = |voxel: DVec3| corner + view.project(voxel) * 72.0 / DPI;
            let long = |axis: usize| {
                let [a, b] = [block.low(), block.low() + DVec3::AXES[axis] * block.extent()[axis]].map(on_page);
                a.distance(b) > 45.0
            };
            for (_, title) in ["Inline", "Crossline", "Depth (m)"].into_iter().enumerate().filter(|(n, _)| long(*n)) {
                assert!(
                    said(&page).contains(&title.to_owned()),
                    "no {title} from {azimuth}, {elevation}: {:?}",
                    said(&page)
                );
            }
            // No number lies on the block.
            for text in page.texts() {
                let middle = (text.bounds().centre() - corner) * DPI / 72.0;
                let raw = Scene { blend: 1.0, raw: Some(Survey::raw()), ..asked.clone() };
                let volumes = [NamedVolume::whole("seismic", &survey.volume)];
                let hit = pick(&raw, &Inputs::raw(&survey.geometry, &volumes), middle).unwrap();
                assert!(hit.is_none(), "{} lies on the block from {azimuth}, {elevation}", text.text);
            }
        }
    }
}

#[test]
fn raw_data_have_a_colour_bar_and_a_page_says_where_it_comes_from() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[20.0]));
    let texts = |blend: f32| {
        let scene = Scene { blend, ..Scene::default() };
        said(&survey.page(&scene, &Annotation::ALL).0)
    };
    assert!(texts(0.5).contains(&"−3".to_owned()) && texts(0.5).contains(&"seismic".to_owned()));
    assert!(!texts(0.0).contains(&"seismic".to_owned()), "nothing raw is seen");
    assert!(texts(0.0).contains(&"Petroglyph · survey · data: nobody".to_owned()));
    let plain: Vec<Text> = survey.page(&Scene::default(), &[]).0.texts().into_iter().cloned().collect();
    assert!(plain.is_empty(), "nothing is written unasked");
}

/// A vertical well at a voxel place, 40 samples deep, with a top at sample 18.
fn well(name: &str, x: f64, y: f64) -> Well {
    let station = |md_m: f64| Station { md_m, inclination_deg: 0.0, azimuth_deg: 0.0 };
    let path = WellPath::minimum_curvature(DVec2::new(12.5 * x, 12.5 * y), 0.0, &[station(0.0), station(500.0)]);
    let tops = vec![Top { name: format!("Top of {name}"), md_m: 225.0 }];
    Well { tops, ..Well::new(name, path.unwrap()) }
}

/// The nearest corner is cut away.
fn cut(survey: &Survey) -> Scene {
    let mut scene = Scene::default();
    (scene.camera.azimuth_deg, scene.camera.elevation_deg) = (Some(45.0), 30.0);
    let size = survey.geometry.size().map(|count| count as f64 - 1.0);
    scene.cut_outs = vec![VoxelBox { min: [0.0; 3], max: [0.5 * size[0], 0.5 * size[1], 30.0] }];
    scene
}

#[test]
fn wells_have_names_on_top_faces_and_in_cut_outs_and_tops_where_they_are_seen() {
    let mut survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0]));
    survey.wells = vec![well("in the cut-out", 15.0, 10.0), well("in rock", 50.0, 30.0), well("outside", 90.0, 10.0)];
    let scene = cut(&survey);
    let texts = said(&survey.page(&scene, &[Annotation::Wells]).0);
    let has = |name: &str| texts.iter().any(|text| text == name);
    assert!(has("in the cut-out") && has("Top of in the cut-out") && has("in rock"), "{texts:?}");
    assert!(!has("Top of in rock") && !has("outside"), "{texts:?}");
    // From below the heads are hidden.
    let mut below = scene;
    below.camera.elevation_deg = -40.0;
    assert!(!said(&survey.page(&below, &[Annotation::Wells]).0).contains(&"in rock".to_owned()));
}

#[test]
fn a_legend_lists_what_is_seen_and_nothing_else() {
    let mut survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0, 40.0]).with_fault(65.0, 2.0));
    survey.has_legend = true;
    survey.closed.stratigraphy.horizons[1].contact = survey::Contact::Erosional;
    survey.wells = vec![well("in the cut-out", 15.0, 10.0), well("in rock", 50.0, 30.0)];
    let legend = |scene: &Scene| {
        let (page, _) = survey.page(scene, &[]);
        let mut found = Vec::new();
        groups(&page.items, "legend", &mut found);
        let entries = found.iter().flat_map(|legend| &legend.items);
        entries
            .filter_map(|item| if let Item::Group(entry) = item { Some(entry.name.clone()) } else { None })
            .collect::<Vec<_>>()
    };
    let whole = cut(&survey);
    // The head of a well on a top face is seen, though the rest of it lies in rock.
    let wells = ["in the cut-out", "in rock", "Well top"];
    assert_eq!(legend(&whole)[..7], ["Bed 3", "Bed 2", "Bed 1", "Bed 0", "Contact", "H2 (erosional)", "Fault"]);
    assert_eq!(legend(&whole)[7..], wells);
    let mut below = whole.clone();
    below.camera.elevation_deg = -40.0;
    assert!(!legend(&below).contains(&"in rock".to_owned()));
    // A block that ends above the deepest layers.
    let last = survey.geometry.size().map(|count| count as f64 - 1.0);
    let shallow = VoxelBox { min: [0.0; 3], max: [last[0], last[1], 20.0] };
    let upper = Scene { roaming_box: Some(shallow), cut_outs: Vec::new(), ..whole.clone() };
    assert_eq!(legend(&upper), ["Bed 3", "Bed 2", "Contact", "Fault", wells[0], wells[1]]);
    // From straight above a flat top is one layer, and a ground the layer below the air.
    let mut above = Scene { cut_outs: Vec::new(), ..whole.clone() };
    above.camera.elevation_deg = 90.0;
    above.wells.radius = 0.0;
    assert_eq!(legend(&above), ["Bed 3", "Fault"]);
    let ground = legend(&Scene { ground: Some(Ground::default()), ..above });
    assert!(ground.contains(&"Bed 2".to_owned()) && !ground.contains(&"Bed 3".to_owned()), "{ground:?}");
    assert!(!ground.contains(&"Bed 0".to_owned()), "{ground:?}");
    // The fault breaks the ground; no face shows it.
    assert!(ground.contains(&"Fault".to_owned()), "{ground:?}");
    // Zoomed in on the cut-out's foot.
    let mut near = whole.clone();
    (near.camera.zoom, near.camera.elevation_deg) = (9.0, 30.0);
    let seen = legend(&near);
    assert!(seen.len() > 1 && !seen.contains(&"Bed 0".to_owned()) && !seen.contains(&"in rock".to_owned()), "{seen:?}");
    // Nothing is drawn of faults whose lines have no width.
    let mut plain = whole;
    plain.outlines.faults.width_px = 0.0;
    assert!(!legend(&plain).contains(&"Fault".to_owned()));
}

#[test]
fn labels_stand_where_a_scene_moves_them_and_what_marks_a_place_stays() {
    let mut survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 16.0, 30.0]).with_fault(65.0, 6.0));
    survey.has_legend = true;
    survey.wells = vec![well("W", 15.0, 10.0)];
    let wanted = [Annotation::Axes, Annotation::Layers, Annotation::Faults, Annotation::Wells];
    let told = said(&survey.page(&cut(&survey), &wanted).0);
    assert!(["Well", "Well top"].iter().all(|one| told.iter().filter(|text| text == one).count() == 1), "{told:?}");
    let plain = cut(&survey);
    let labels = |scene: &Scene| movable(&survey.page(scene, &wanted).0);
    let before = labels(&plain);
    let by = DVec2::new(4.0, -3.0);
    for label in ["Bed 0", "Bed 2", "F1", "W", "W Top of W", "legend", "axes"] {
        let place = |labels: &[figure::draw::label_changes::Movable]| {
            labels.iter().find(|known| known.label == label).unwrap().bounds
        };
        let moved = LabelChange { label: label.into(), moved_mm: by.to_array(), ..LabelChange::default() };
        let scene = Scene { labels: vec![moved.clone()], ..plain.clone() };
        let after = labels(&scene);
        let off = place(&after).min - place(&before).min;
        assert!((off - by * 72.0 / 25.4).length() < 1e-6, "{label}: {off}");
        let others = |all: &[figure::draw::label_changes::Movable]| {
            all.iter().filter(|known| known.label != label).cloned().collect::<Vec<_>>()
        };
        assert_eq!(others(&before), others(&after), "{label} alone");
        let hidden = Scene { labels: vec![LabelChange { is_hidden: true, ..moved }], ..plain.clone() };
        assert!(!labels(&hidden).iter().any(|known| known.label == label));
    }
    // Half-arrows stay with their fault.
    let scene = |labels: Vec<LabelChange>| Scene { labels, ..plain.clone() };
    let arrows = |scene: &Scene| {
        let (page, _) = survey.page(scene, &wanted);
        let mut found = Vec::new();
        groups(&page.items, "half-arrows", &mut found);
        found[0].clone()
    };
    let far = LabelChange { label: "F1".into(), moved_mm: [9.0, 9.0], size_pt: Some(12.0), ..LabelChange::default() };
    assert_eq!(arrows(&scene(Vec::new())), arrows(&scene(vec![far.clone()])));
    let (page, _) = survey.page(&scene(vec![far]), &wanted);
    assert_eq!(page.texts().into_iter().find(|text| text.text.starts_with("F1")).unwrap().size, 12.0);
}

/// Ground at samples 14 and 26 on the two sides of a fault, water up to sample 20 between them.
#[test]
fn ground_above_the_water_stays_dry_and_hides_what_lies_behind() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 36.0]).with_fault(65.0, 12.0));
    let mut scene = Scene { ground: Some(Ground::default()), ..Scene::default() };
    let clip = |scene: &Scene| {
        let (page, _) = survey.page(scene, &[]);
        let mut found = Vec::new();
        groups(&page.items, "Water", &mut found);
        found.first().map(|group| group.clip.clone())
    };
    scene.water = Some(Water { level: Some(20.0), ..Water::default() });
    // From either end, the high side before the water or behind it.
    let sizes = [20.0, 200.0].map(|azimuth| {
        let mut seen = scene.clone();
        (seen.camera.azimuth_deg, seen.camera.elevation_deg) = (Some(azimuth), 12.0);
        let clip = clip(&seen).expect("there is water").expect("it is hidden in places");
        clip.segments.len()
    });
    assert!(sizes[0].max(sizes[1]) > 10, "{sizes:?}");
    scene.water = Some(Water::default());
    assert_eq!(clip(&scene), Some(None), "nothing rises above the block's top");
}

/// A well that stands two lines beside an inline is drawn on it with its top, and on no other.
#[test]
fn wells_near_a_section_are_drawn_on_it() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0]).with_fault(65.0, 0.0));
    let well = well("W", 15.0, 10.0);
    let on = |kind, at| figure::draw::section_wells::WellOnSection::of(&well, &survey.geometry, kind, at);
    let near = on(figure::SectionKind::Inline, 13.0).unwrap();
    assert!(near.parts.len() == 1 && near.parts[0].iter().all(|st| (st.x - 10.0).abs() < 0.1), "{near:?}");
    assert_eq!(near.tops.len(), well.tops.len());
    assert!(on(figure::SectionKind::Inline, 25.0).is_none());
    let slice = on(figure::SectionKind::Slice, 12.0).unwrap();
    assert!(slice.tops.is_empty() && (slice.parts[0][0] - DVec2::new(15.0, 10.0)).length() < 0.2, "{slice:?}");
    // A fence that turns beside it: five lines to the corner, then ten to where the well stands.
    let fence = |corners: [[f64; 2]; 3]| {
        let corners = corners.map(DVec2::from_array);
        figure::draw::section_wells::WellOnSection::on_fence(&well, &survey.geometry, &corners)
    };
    let on_fence = fence([[8.0, 0.0], [13.0, 0.0], [13.0, 30.0]]).unwrap();
    assert!(on_fence.parts[0].iter().all(|st| (st.x - 15.0).abs() < 0.1), "{on_fence:?}");
    assert_eq!(on_fence.tops.len(), well.tops.len());
    assert!(fence([[30.0, 0.0], [30.0, 20.0], [50.0, 20.0]]).is_none());
}

/// A well in a cut-out stands before the water behind it; one in rock stands under water.
#[test]
fn water_is_not_painted_over_wells_that_stand_before_it() {
    let mut survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0]).with_fault(65.0, 0.0));
    survey.wells = vec![well("in the cut-out", 20.0, 14.0), well("in rock", 50.0, 30.0)];
    let mut scene = cut(&survey);
    scene.ground = Some(Ground::default());
    let water = Water { opacity: 0.4, ..Water::default() };
    scene.size_px = [400, 300];
    let paths: Vec<Vec<DVec3>> = survey.wells.iter().map(|well| well.path_in_voxels(&survey.geometry)).collect();
    let drawn = survey.wells.iter().zip(&paths).map(|(well, path)| DrawnWell {
        name: &well.name,
        colour: None,
        path,
        tops: &[],
    });
    let wells: Vec<DrawnWell> = drawn.collect();
    let volumes = [NamedVolume::whole("seismic", &survey.volume)];
    let inputs = Inputs { model: Some(&survey.model), wells: &wells, ..Inputs::raw(&survey.geometry, &volumes) };
    let red = image::Rgba([200, 0, 0, 255]);
    let dry = RgbaImage::from_pixel(400, 300, red);
    let over = |scene: &Scene| figure::draw::water::over(dry.clone(), scene, &inputs, 72.0);
    assert_eq!(over(&scene), dry, "a scene without water");
    scene.water = Some(water);
    let picture = over(&scene);
    let view = scene.view(&survey.geometry);
    let at = |x: f64, y: f64, z: f64| {
        let px = view.project(DVec3::new(x, y, z)).round();
        *picture.get_pixel(px.x as u32, px.y as u32)
    };
    let wet = |pixel: image::Rgba<u8>| pixel.0[2] > 40;
    // Beside the well, across the eye's direction, lies the wall behind it.
    assert!((2..12).any(|z| wet(at(24.0, 10.0, f64::from(z)))));
    assert!((1..12).all(|z| !wet(at(20.0, 14.0, f64::from(z)))));
    assert!(wet(at(50.0, 30.0, 0.5)));
    scene.wells.radius = 0.0;
    assert!((1..12).any(|z| {
        let px = view.project(DVec3::new(20.0, 14.0, f64::from(z))).round();
        wet(*over(&scene).get_pixel(px.x as u32, px.y as u32))
    }));
    // On a page the same, as a group of its own.
    scene.wells.radius = 0.006;
    let (page, _) = survey.page(&scene, &[]);
    let mut found = Vec::new();
    groups(&page.items, "wells before water", &mut found);
    assert_eq!(found.len(), 1);
}

/// Flat ground at sample 14: the sides of the water are as high as the air, and its upper face is the block's.
#[test]
fn water_lies_between_the_ground_and_the_top_of_the_block_and_not_in_cut_outs() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0]).with_fault(65.0, 0.0));
    let size = survey.geometry.size().map(|count| count as f64 - 1.0);
    let mut scene = cut(&survey);
    (scene.ground, scene.water) = (Some(Ground::default()), Some(Water::default()));
    let drawn = |scene: &Scene| {
        let (page, asked) = survey.page(scene, &[]);
        let mut found = Vec::new();
        groups(&page.items, "Water", &mut found);
        (found.into_iter().cloned().collect::<Vec<_>>(), asked)
    };
    let (water, asked) = drawn(&scene);
    assert_eq!(water.len(), 1);
    let view = asked.view(&survey.geometry);
    let paths = water[0].items.iter().filter_map(|face| match face {
        Item::Group(face) => face.items.first(),
        _ => None,
    });
    let paths: Vec<&Item> = paths.collect();
    let bounds = paths.iter().filter_map(|item| if let Item::Path(path) = item { path.path.bounds() } else { None });
    let bounds = bounds.reduce(|a, b| a.around(b.min).around(b.max)).unwrap();
    // From the highest corner of the block's top to the lowest one of the ground.
    let corners = |z: f64| {
        [[0.0, 0.0], [size[0], 0.0], [0.0, size[1]], [size[0], size[1]]]
            .map(|[x, y]| view.project(DVec3::new(x, y, z)).y)
    };
    let high = corners(0.0).into_iter().fold(f64::INFINITY, f64::min) * 72.0 / DPI;
    let low = corners(14.0).into_iter().fold(f64::NEG_INFINITY, f64::max) * 72.0 / DPI;
    assert!(bounds.min.y - high > -1.0 && bounds.max.y - low < 1.0, "{bounds:?} beside {high} and {low}");
    assert!(bounds.height() > 0.7 * (low - high), "{bounds:?} beside {high} and {low}");
    // The walls of the cut-out are faces of the water too; without a cut-out there are three.
    assert!(paths.len() > 3, "{}", paths.len());
    assert_eq!(drawn(&Scene { cut_outs: Vec::new(), ..scene.clone() }).0[0].items.len(), 3);
    assert!(drawn(&Scene { ground: None, ..scene.clone() }).0.is_empty(), "no ground, no water");
    // Up to a level only, and not at all below the ground.
    let up_to = |level: f64| {
        let water = Some(Water { level: Some(level), ..Water::default() });
        drawn(&Scene { water, cut_outs: Vec::new(), ..scene.clone() }).0
    };
    let inner = |group: &Group| match &group.items[0] {
        Item::Group(face) => match &face.items[0] {
            Item::Path(path) => path.path.bounds().unwrap(),
            _ => panic!("no path"),
        },
        _ => panic!("no face"),
    };
    let top = corners(10.0).into_iter().fold(f64::INFINITY, f64::min) * 72.0 / DPI;
    let shallow = up_to(10.0);
    let highest = shallow[0].items.len();
    assert!(highest == 3 && inner(&shallow[0]).min.y > high - 1.0 && top > high + 2.0);
    assert!(up_to(20.0).is_empty());
    assert!(drawn(&Scene { water: None, ..scene }).0.is_empty());
}

/// Of a block that is larger than its picture, nothing is written beyond what is seen of it.
#[test]
fn nothing_is_written_on_the_parts_of_a_block_that_the_picture_cuts_off() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0, 38.0]).with_fault(65.0, 6.0));
    for (zoom, azimuth) in [(1.8, 35.0), (3.0, 120.0), (6.0, 300.0)] {
        let mut scene = Scene::default();
        (scene.camera.zoom, scene.camera.azimuth_deg) = (zoom, Some(azimuth));
        let (page, asked) = survey.page(&scene, &[Annotation::Axes, Annotation::Layers, Annotation::Faults]);
        let size = DVec2::from(asked.size_px.map(f64::from)) * 72.0 / DPI;
        let seen = page::Rect::sized(corner(&page), size);
        let mut leaders = Vec::new();
        for item in page.leaves() {
            match item {
                // Names along layers stand on what is seen of them, and leaders begin there.
                Item::Text(text) if !text.letters.is_empty() => {
                    assert!(seen.grown(1.0).contains(text.bounds().centre()), "{} at zoom {zoom}", text.text);
                }
                Item::Path(path) => leaders.extend(path.path.segments.first().cloned()),
                _ => {}
            }
        }
        for from in leaders {
            let Segment::Move(from) = from else { continue };
            assert!(seen.grown(12.0).contains(from), "a line begins at {from} beside {seen:?}, zoom {zoom}");
        }
    }
}

/// A steep fault runs level on a face along its strike: arrows there would tell of a movement along strike.
#[test]
fn a_fault_has_no_half_arrows_where_its_line_is_level() {
    let survey = Survey::new(|geometry| ClosedForm::flat(geometry, &[14.0, 26.0, 38.0]).with_fault(65.0, 6.0));
    let mut named = 0;
    for azimuth in [0.0, 90.0, 180.0, 270.0] {
        // The fault strikes along inlines, and meets the inline at x = 35 near sample 36.
        let block = VoxelBox { min: [35.0, 0.0, 0.0], max: [60.0, 40.0, 50.0] };
        let mut scene = Scene { roaming_box: Some(block), ..Scene::default() };
        (scene.camera.azimuth_deg, scene.camera.elevation_deg) = (Some(azimuth), 10.0);
        let (page, asked) = survey.page(&scene, &[Annotation::Faults]);
        let mut arrows = Vec::new();
        groups(&page.items, "half-arrows", &mut arrows);
        let is_across_strike = asked.view(&survey.geometry).towards_camera(block.centre()).normalize().y.abs() > 0.5;
        assert_eq!(arrows.len(), usize::from(is_across_strike), "from {azimuth}");
        named += usize::from(said(&page).iter().any(|text| text.starts_with("F1")));
    }
    assert_eq!(named, 3, "it does not reach the inline at x = 60");
}

/// Water that lies nowhere above the ground is not in the legend.
#[test]
fn a_legend_lists_water_only_where_there_is_some() {
    let survey = Survey { has_legend: true, ..Survey::new(|geometry| ClosedForm::flat(geometry, &[20.0, 36.0])) };
    let lists_water = |level: f64| {
        let water = Water { level: Some(level), ..Water::default() };
        let scene = Scene { ground: Some(Ground::default()), water: Some(water), ..Scene::default() };
        said(&survey.page(&scene, &[]).0).contains(&"Water".to_owned())
    };
    // The ground lies at sample 20.
    assert!(lists_water(10.0) && !lists_water(32.0));
}
