//! What is measured in the written SVG: bricks along a fold, and patterns that end at their layers and faults.

use crate::fold::Fold;
use figure::{Figure, PageSize, Part, SectionKind, SectionPart};
use glam::{DMat2, DVec2, DVec3};
use page::svg;
use render::{Background, Camera, FaceData, Outlines, Scene, VoxelBox};
use std::collections::{HashMap, HashSet};
use survey::{SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;

/// The subpaths of a path's description: their points, and whether they are closed.
fn subpaths(d: &str) -> Vec<(Vec<DVec2>, bool)> {
    let mut paths: Vec<(Vec<DVec2>, bool)> = Vec::new();
    let (mut at, mut begin) = (DVec2::ZERO, DVec2::ZERO);
    let starts: Vec<usize> = d.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(n, _)| n).collect();
    for (n, &start) in starts.iter().enumerate() {
        let end = starts.get(n + 1).copied().unwrap_or(d.len());
        let command = d.as_bytes()[start] as char;
        let numbers = numbers(&d[start + 1..end]);
        let base = |at: DVec2| if command.is_ascii_lowercase() { at } else { DVec2::ZERO };
        match command.to_ascii_lowercase() {
            'm' | 'l' => {
                for (k, pair) in numbers.chunks_exact(2).enumerate() {
                    at = base(at) + DVec2::new(pair[0], pair[1]);
                    if command.eq_ignore_ascii_case(&'m') && k == 0 {
                        begin = at;
                        paths.push((Vec::new(), false));
                    }
                    paths.last_mut().unwrap().0.push(at);
                }
            }
            'h' | 'v' => {
                let axis = usize::from(command.eq_ignore_ascii_case(&'v'));
                for number in numbers {
                    at[axis] = base(at)[axis] + number;
                    paths.last_mut().unwrap().0.push(at);
                }
            }
            'c' => {
                for six in numbers.chunks_exact(6) {
                    at = base(at) + DVec2::new(six[4], six[5]);
                    paths.last_mut().unwrap().0.push(at);
                }
            }
            'z' => {
                at = begin;
                paths.last_mut().unwrap().1 = true;
            }
            other => panic!("{other} in a path"),
        }
    }
    paths
}

fn numbers(text: &str) -> Vec<f64> {
    let mut found: Vec<String> = Vec::new();
    for c in text.chars() {
        match c {
            ' ' | ',' => found.push(String::new()),
            '-' => found.push("-".into()),
            '.' if found.last().is_some_and(|last| last.contains('.')) => found.push(".".into()),
            _ => match found.last_mut() {
                Some(last) => last.push(c),
                None => found.push(c.into()),
            },
        }
    }
    found.iter().filter(|number| !number.is_empty()).map(|number| number.parse().unwrap()).collect()
}

fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let begin = line.find(&format!("{name}=\""))? + name.len() + 2;
    line[begin..].split('"').next()
}

/// The patterns of a document: the rings that each is clipped to, and its paths.
type Pattern = (Vec<Vec<DVec2>>, Vec<String>);

fn patterns(svg: &str) -> Vec<Pattern> {
    let clip = |id: &str| {
        let line = svg.lines().find(|line| line.contains(&format!("<clipPath id=\"{id}\""))).unwrap();
        subpaths(attribute(line, " d").unwrap()).into_iter().map(|(points, _)| points).collect::<Vec<_>>()
    };
    let mut patterns: Vec<Pattern> = Vec::new();
    let mut is_open = false;
    for line in svg.lines() {
        if line.starts_with("<g") {
            // Groups of parts have no name.
            let id = attribute(line, "clip-path").filter(|_| attribute(line, "inkscape:label").is_none());
            is_open = id.is_some();
            if let Some(id) = id.and_then(|id| id.strip_prefix("url(#")).and_then(|id| id.strip_suffix(')')) {
                patterns.push((clip(id), Vec::new()));
            }
        } else if line.starts_with("</g") {
            is_open = false;
        } else if line.starts_with("<path") && is_open {
            // What is both filled and stroked is the colour of a layer.
            if attribute(line, "fill") == Some("none") || attribute(line, " stroke").is_none() {
                patterns.last_mut().unwrap().1.push(attribute(line, " d").unwrap().to_owned());
            }
        }
    }
    patterns.retain(|(_, paths)| !paths.is_empty());
    patterns
}

/// How far a place lies beyond an outline, points; 0 within, by the even-odd rule.
fn beyond(rings: &[Vec<DVec2>], p: DVec2) -> f64 {
    let sides = || rings.iter().flat_map(|ring| (0..ring.len()).map(|n| (ring[n], ring[(n + 1) % ring.len()])));
    let crossed =
        sides().filter(|(a, b)| (a.y <= p.y) != (b.y <= p.y) && a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x);
    if crossed.count() % 2 == 1 {
        return 0.0;
    }
    let off = |(a, b): (DVec2, DVec2)| {
        let along = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-12)).clamp(0.0, 1.0);
        p.distance(a.lerp(b, along))
    };
    sides().map(off).fold(f64::INFINITY, f64::min)
}

/// Places along the paths of a pattern, from end to end, no farther apart than a fifth of a point.
fn places(paths: &[String]) -> Vec<DVec2> {
    let mut places = Vec::new();
    for (points, is_closed) in paths.iter().flat_map(|d| subpaths(d)) {
        let back = is_closed.then(|| points[0]);
        let ends: Vec<DVec2> = points.into_iter().chain(back).collect();
        for pair in ends.windows(2) {
            let steps = (pair[0].distance(pair[1]) / 0.2).ceil().max(1.0) as usize;
            places.extend((0..=steps).map(|n| pair[0].lerp(pair[1], n as f64 / steps as f64)));
        }
    }
    places
}

/// Layers cut by a fault, in lines, filled dots and bricks: of each pattern's path no place lies more than a tenth of a
/// point beyond the outline of its layer in its fault block.
#[test]
fn no_pattern_leaves_its_layer_or_crosses_a_fault() {
    let geometry = SurveyGeometry::regular([61, 41, 51], 12.5, 12.5, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[10.0, 22.0, 34.0], 30.0).with_fault(65.0, 6.0);
    let fold = Fold::of(geometry, &closed, &["conglomerate", "sandstone-bedded", "limestone", "shale"]);
    let whole = VoxelBox::of_size([61, 41, 51]);
    let scene = Scene {
        size_px: [1100, 800],
        camera: Camera { azimuth_deg: Some(35.0), ..Camera::default() },
        cut_outs: vec![whole.corner_cut(render::Corner::MinMin, [0.4, 0.4])],
        ground: None,
        ..Scene::default()
    };
    let svg = svg(&fold.page(&scene, true), "t").unwrap();
    let (mut asked, mut cut, mut worst) = (0, 0, 0.0f64);
    for (rings, paths) in patterns(&svg) {
        for p in places(&paths) {
            let off = beyond(&rings, p);
            asked += 1;
            cut += usize::from(off > 0.0);
            worst = worst.max(off);
        }
    }
    assert!(worst <= 0.1, "{worst} points beyond");
    // Many end at the outline, some on its far side by rounding.
    assert!(asked > 20_000 && cut > 50, "{asked} places, {cut} at the outline");
}

/// The same against the model instead of outlines: on a face seen head on, each place of a pattern's path lies in one layer
/// and one fault block, or within a tenth of a point of it; paths moved by half a point do not.
#[test]
fn patterns_lie_in_the_layers_and_fault_blocks_of_the_model() {
    let geometry = SurveyGeometry::regular([61, 21, 51], 12.5, 12.5, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[10.0, 22.0, 34.0], 30.0).with_fault(65.0, 6.0);
    let fold = Fold::of(geometry, &closed, &["conglomerate", "sandstone-bedded", "limestone", "shale"]);
    let camera = Camera { azimuth_deg: Some(0.0), elevation_deg: 0.0, margin: 0.0, ..Camera::default() };
    let scene = Scene { size_px: [1200, 1000], camera, exaggeration: 1.0, ground: None, ..Scene::default() };
    let view = scene.view(&fold.geometry);
    let points = |voxel: DVec3| view.project(voxel) * 72.0 / 200.0;
    let origin = points(DVec3::ZERO);
    let [x, z] = [DVec3::X, DVec3::Z].map(|axis| points(axis) - origin);
    let voxel_from_page = DMat2::from_cols(x, z).inverse();
    let region = |p: DVec2| {
        let at = voxel_from_page * (p - origin);
        fold.model.region_at(DVec3::new(at.x, 0.0, at.y).as_vec3())
    };
    let svg = svg(&fold.page(&scene, true), "t").unwrap();
    let (mut asked, mut regions) = (0, HashSet::new());
    let [mut outside, mut moved_outside] = [0, 0];
    for (_, paths) in patterns(&svg) {
        let places = places(&paths);
        let mut counts: HashMap<_, usize> = HashMap::new();
        places.iter().for_each(|p| *counts.entry(region(*p)).or_default() += 1);
        let Some((own, _)) = counts.into_iter().max_by_key(|(_, count)| *count) else { continue };
        regions.insert(own);
        asked += places.len();
        let around = (0..16).map(|n| DVec2::from_angle(f64::from(n) * std::f64::consts::TAU / 16.0) * 0.1);
        let near: Vec<DVec2> = std::iter::once(DVec2::ZERO).chain(around).collect();
        let lies_off = |p: DVec2| !near.iter().any(|step| region(p + *step) == own);
        outside += places.iter().filter(|p| lies_off(**p)).count();
        moved_outside += places.iter().filter(|p| lies_off(**p + DVec2::new(0.35, 0.35))).count();
    }
    // Four layers on two sides of the fault.
    assert!(asked > 20_000 && regions.len() >= 7, "{asked} places in {regions:?}");
    assert_eq!(outside, 0, "of {asked} places");
    assert!(moved_outside > 100, "{moved_outside} of {asked} places");
}

/// How many joints bricks on a cylindrical fold have in the SVG, and how far the worst of them is from a right angle to the
/// bedding of a fold whose axis lies so many voxels beside it, degrees.
fn joints(aside: f64) -> (usize, f64) {
    let geometry = SurveyGeometry::regular([81, 9, 61], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[12.0, 36.0], 35.0);
    let camera = Camera { azimuth_deg: Some(0.0), elevation_deg: 0.0, margin: 0.0, ..Camera::default() };
    let background = Background::Colour(ttf::Colour::WHITE);
    let outlines = Outlines::none();
    let size_px = [1600, 1200];
    let scene = Scene { size_px, camera, background, exaggeration: 1.0, ground: None, outlines, ..Scene::default() };
    let view = scene.view(&geometry);
    let fold = Fold::of(geometry, &closed, &["shale", "limestone", "shale"]);
    let svg = svg(&fold.page(&scene, true), "t").unwrap();
    let points = |voxel: DVec3| view.project(voxel) * 72.0 / 200.0;
    let axis = points(DVec3::new(40.0, 0.0, 36.0 + 40.0 / 35f64.to_radians().sin()));
    let crests = [12.0, 36.0].map(|sample| axis.distance(points(DVec3::new(40.0, 0.0, sample))));
    let middle = 0.5 * (crests[0] + crests[1]);
    let aside = points(DVec3::X * aside) - points(DVec3::ZERO);
    let bricks = patterns(&svg).into_iter().filter(|(rings, _)| {
        // The layer between the horizons is the one around the middle of the fold.
        beyond(rings, axis - DVec2::new(0.0, middle)) == 0.0
    });
    let (mut joints, mut worst) = (0, 0.0f64);
    for (points, _) in bricks.flat_map(|(_, paths)| paths).flat_map(|d| subpaths(&d)) {
        let [a, b] = [points[0], points[points.len() - 1]];
        let (step, radius) = (b - a, 0.5 * (a + b) - axis - aside);
        // Places are written to a hundredth of a point: shorter lines have no direction.
        let from_radius = (step.dot(radius).abs() / (step.length() * radius.length())).min(1.0).acos().to_degrees();
        if step.length() < 1.0 || from_radius > 45.0 {
            continue;
        }
        joints += 1;
        worst = worst.max(from_radius);
    }
    (joints, worst)
}

/// At exaggeration 1 joints stand on bedding within three degrees; they do not on that of another fold.
#[test]
fn joints_of_bricks_stand_across_the_bedding_of_a_fold() {
    let (count, worst) = joints(0.0);
    assert!(count > 100, "{count} joints");
    assert!(worst < 3.0, "a joint is {worst} degrees askew");
    let (count, worst) = joints(8.0);
    assert!(count > 100 && worst > 3.0, "{count} joints, {worst} degrees");
}

/// Ooids are circles, also on sections that are drawn higher than they are: the pattern has the page's proportions.
#[test]
fn ooids_stay_round_on_exaggerated_sections() {
    let geometry = SurveyGeometry::regular([61, 41, 51], 12.5, 12.5, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[1.0, 13.0, 25.0, 37.0, 49.0]);
    let fold = Fold::of(geometry, &closed, &["limestone-oolitic"; 6]);
    for proportions in [1.0, 2.0, 3.5] {
        let (kind, show, zoom) = (SectionKind::Crossline, FaceData::Rock, Default::default());
        let part = SectionPart { kind, at: 21.0, show, blend: Some(0.0), zoom, proportions: Some(proportions) };
        let page = fold.made(&Figure { size: PageSize::Cm([12.0, 24.0]), ..Figure::of(Part::Section(part)) }, true);
        let svg = svg(&page, "t").unwrap();
        let shapes = patterns(&svg).into_iter().flat_map(|(_, paths)| paths).flat_map(|d| subpaths(&d));
        let ratio = |(points, is_closed): (Vec<DVec2>, bool)| {
            let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
            let size = points.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max) - low;
            is_closed.then_some(size.y / size.x)
        };
        let mut ratios: Vec<f64> = shapes.filter_map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        assert!(ratios.len() > 50, "{} ooids", ratios.len());
        let [low, high] = [0.1, 0.9].map(|share| ratios[(share * ratios.len() as f64) as usize]);
        assert!(low > 0.9 && high < 1.1, "{low} to {high} at {proportions}");
    }
}
