//! Rock on sections and fences: each place shows the layer that the model has there, on any survey.

use crate::fold::Fold;
use figure::{Annotation, FencePart, Figure, PageSize, Part, SectionKind, SectionPart};
use glam::{DVec2, DVec3};
use page::list::{GroupKind, Item};
use page::{raster, svg};
use render::FaceData;
use survey::{SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;

/// From a place on a section to voxels.
type ToVoxel<'a> = Box<dyn Fn(DVec2) -> DVec3 + 'a>;

const SIZE: [usize; 3] = [41, 31, 41];

fn fold(side: f64) -> Fold {
    let mut geometry = SurveyGeometry::regular(SIZE, 12.5, 12.5, VerticalUnit::Metres);
    geometry.inline_vector = DVec2::from_angle(0.6) * 12.5;
    geometry.crossline_vector = geometry.inline_vector.perp() * side;
    let closed = ClosedForm::dome(&geometry, &[8.0, 16.0, 26.0], 30.0).with_fault(65.0, 4.0);
    Fold::of(geometry, &closed, &["#c81e1e", "#1eb41e", "#2828c8", "#dcc814"])
}

fn figure(part: Part) -> Figure {
    Figure { size: PageSize::Cm([12.0, 8.0]), dpi: 150.0, ..Figure::of(part) }
}

fn section(kind: SectionKind, at: f64, blend: f32) -> Part {
    let (show, zoom) = (FaceData::Rock, Default::default());
    Part::Section(SectionPart { kind, at, show, blend: Some(blend), zoom, proportions: None })
}

/// The rectangle that a section's rock is clipped to.
fn pane(items: &[Item]) -> Option<page::Rect> {
    items.iter().find_map(|item| match item {
        Item::Group(group) if group.name == "section" => group.clip.as_ref().and_then(|clip| clip.bounds()),
        Item::Group(group) => pane(&group.items),
        _ => None,
    })
}

#[test]
fn each_place_of_a_section_shows_its_layer_on_turned_and_mirrored_surveys() {
    for side in [1.0, -1.0] {
        let fold = fold(side);
        // Lines are numbered from 1.
        let corners = [[4.0, 3.0], [23.0, 21.0], [39.0, 21.0]];
        let legs = corners.map(|corner| DVec2::from_array(corner) - 1.0);
        let fence = FencePart { corners: corners.to_vec(), show: FaceData::Rock, blend: Some(0.0) };
        let length = legs[0].distance(legs[1]) + legs[1].distance(legs[2]);
        let along = |s: f64| figure::cut::place(&legs, s);
        let kinds: [(Part, DVec2, ToVoxel); 5] = [
            (
                section(SectionKind::Inline, 18.0, 0.0),
                DVec2::new(30.0, 40.0),
                Box::new(|st| DVec3::new(17.0, st.x, st.y)),
            ),
            (
                section(SectionKind::Inline, 41.0, 0.0),
                DVec2::new(30.0, 40.0),
                Box::new(|st| DVec3::new(40.0, st.x, st.y)),
            ),
            (
                section(SectionKind::Crossline, 1.0, 0.0),
                DVec2::new(40.0, 40.0),
                Box::new(|st| DVec3::new(st.x, 0.0, st.y)),
            ),
            (
                section(SectionKind::Slice, 250.0, 0.0),
                DVec2::new(40.0, 30.0),
                Box::new(|st| DVec3::new(st.x, st.y, 20.0)),
            ),
            (Part::Fence(fence), DVec2::new(length, 40.0), Box::new(move |st| along(st.x).extend(st.y))),
        ];
        for (part, extent, voxel) in kinds {
            for has_vectors in [false, true] {
                let page = fold.made(&figure(part.clone()), has_vectors);
                let image = raster(&page, 150.0).unwrap();
                let pane = pane(&page.items).unwrap();
                let (mut asked, mut wrong) = (0, 0);
                for n in 0..900 {
                    let share = DVec2::new(f64::from(n % 30) + 0.5, f64::from(n / 30) + 0.5) / 30.0;
                    let place = voxel(share * extent);
                    // Near a boundary lines are drawn.
                    let layer = fold.model.region_at(place.as_vec3()).layer;
                    let around =
                        [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [place + axis, place - axis]);
                    let mut around = around.map(|p| p.clamp(DVec3::ZERO, DVec3::new(40.0, 30.0, 40.0)));
                    if around.any(|p| fold.model.region_at(p.as_vec3()).layer != layer) {
                        continue;
                    }
                    let px = (pane.min + share * pane.size()) * 150.0 / 72.0;
                    let found = image.get_pixel(px.x as u32, px.y as u32).0;
                    let colour = fold.layers[fold.layers.len() - 1 - usize::from(layer)].colour.rgb;
                    asked += 1;
                    wrong += usize::from((0..3).any(|c| found[c].abs_diff(colour[c]) > 12));
                }
                assert!(asked > 250 && wrong * 100 < asked, "{wrong} of {asked}, {part:?}, {side}, {has_vectors}");
            }
        }
    }
}

#[test]
fn rock_on_a_section_is_paths_with_names_and_throws() {
    let fold = Fold::new();
    let part = section(SectionKind::Crossline, 21.0, 0.0);
    let annotate = vec![Annotation::Layers, Annotation::Faults];
    let page = fold.made(&Figure { annotate, legend: true, ..figure(part) }, true);
    let said: Vec<&str> = page.texts().into_iter().map(|text| text.text.as_str()).collect();
    // The throw of the closed form: six samples of 12.5 m.
    assert!(said.contains(&"F1, 75 m"), "{said:?}");
    for layer in &fold.layers {
        // Along the layer, and in the legend.
        assert!(said.iter().filter(|text| **text == layer.layer).count() == 2, "{} in {said:?}", layer.layer);
    }
    assert!(said.contains(&"Contact") && said.contains(&"Fault"), "{said:?}");
    let layers = page.items.iter().filter(|item| matches!(item, Item::Group(group) if group.kind == GroupKind::Layer));
    assert_eq!(layers.count(), 0, "layers lie in their panel");
    let written = svg(&page, "t").unwrap();
    assert!(written.matches("<path").count() > 40 && !written.contains("<image"), "patterns are paths");
    // Half of the data is a picture below the lines.
    let half = fold.made(&figure(section(SectionKind::Crossline, 21.0, 1.0)), true);
    assert!(svg(&half, "t").unwrap().contains("<image"));
}

/// A bed of 50° is cut off by a fault of 65° at places 169 m apart in depth, although all went down by 75 m: the throw is
/// that of the level horizon, which crosses the fault clearly, not that of the bed nearer to the middle.
#[test]
fn throws_are_not_taken_from_beds_that_run_along_the_fault() {
    let geometry = SurveyGeometry::regular([61, 41, 51], 12.5, 12.5, VerticalUnit::Metres);
    let closed = ClosedForm::unconformity(&geometry, 10.0, &[22.0], 50.0, 0.0).with_fault(65.0, 6.0);
    let fold = Fold::of(geometry, &closed, &["shale", "limestone", "shale"]);
    let part = section(SectionKind::Crossline, 21.0, 0.0);
    let page = fold.made(&Figure { annotate: vec![Annotation::Faults], ..figure(part) }, true);
    let said: Vec<&str> = page.texts().into_iter().map(|text| text.text.as_str()).collect();
    assert!(said.contains(&"F1, 75 m"), "{said:?}");
}
