//! Sections of closed-form models: areas, curves, junctions, lines.

use super::*;
use crate::ModelSettings;
use crate::closed_form::{self, ModelForm, Random};
use glam::DVec3;
use survey::fault::Fault;
use survey::geometry::{SurveyGeometry, VerticalUnit};
use survey::horizon::{Horizon, NodeGrid, Quality, Sheet};
use survey::mesh::TriangleMesh;
use survey::progress::Progress;
use survey::stratigraphy::{Contact, StratigraphicHorizon, Stratigraphy};

fn whole(size: [usize; 3]) -> [DVec3; 2] {
    [DVec3::ZERO, DVec3::from_array(size.map(|n| n as f64 - 1.0))]
}

fn planes(size: [usize; 3]) -> Vec<SectionPlane> {
    let [low, high] = whole(size);
    let mut planes = vec![
        SectionPlane::inline(20.5, low, high),
        SectionPlane::inline(32.0, low, high),
        SectionPlane::crossline(20.0, low, high),
        SectionPlane::crossline(30.3, low, high),
        SectionPlane::slice(33.3, low, high),
        SectionPlane::slice(50.0, low, high),
    ];
    let mut random = Random(5);
    for _ in 0..6 {
        let s_axis = random.direction();
        let t_axis = s_axis.cross(random.direction()).normalize();
        let centre = random.place(size) * 0.5 + high * 0.25;
        let extent = [20.0 + 30.0 * random.next(), 15.0 + 20.0 * random.next()];
        let origin = centre - 0.5 * (s_axis * extent[0] + t_axis * extent[1]);
        planes.push(SectionPlane { origin, s_axis, t_axis, extent });
    }
    planes
}

fn area(rings: &[Vec<DVec2>]) -> f64 {
    rings.iter().map(|r| trace::signed_area(r)).sum()
}

#[test]
fn areas_sum_to_the_rectangle_and_points_agree_with_region_at() {
    for (name, form) in closed_form::all() {
        let model = form.model();
        for plane in planes(form.geometry.size()) {
            let section = Section::new(&model, &plane);
            let full = plane.extent[0] * plane.extent[1];
            let by_region: f64 = section.polygons.iter().map(|p| area(&p.rings)).sum();
            let by_layer: f64 = section.layers.iter().map(|p| area(&p.rings)).sum();
            assert!((by_region / full - 1.0).abs() < 1e-6, "{name}: {by_region} of {full} on {plane:?}");
            assert!((by_layer / full - 1.0).abs() < 1e-6, "{name}: {by_layer} of {full} on {plane:?}");
            let mut random = Random(11);
            for _ in 0..300 {
                let st = closed_form::inside(&mut random, plane.extent);
                let p = plane.voxel(st);
                if form.is_clear(p, 0.06) {
                    let expected = model.region_at(p.as_vec3());
                    assert_eq!(section.region_at(st), Some(expected), "{name} at {p}");
                    let holding: Vec<u16> =
                        section.layers.iter().filter(|l| trace::winding(&l.rings, st) != 0).map(|l| l.layer).collect();
                    assert_eq!(holding, [expected.layer], "{name} at {p}");
                }
            }
        }
    }
}

#[test]
fn lines_lie_on_the_analytic_curves() {
    for (name, form) in closed_form::all().into_iter().filter(|(name, _)| *name != "dying out") {
        let model = form.model();
        for plane in planes(form.geometry.size()) {
            let section = Section::new(&model, &plane);
            for line in &section.lines {
                for &st in &line.points {
                    let p = plane.voxel(st);
                    if p.min_element() < 0.0
                        || (DVec3::from_array(form.geometry.size().map(|n| n as f64 - 1.0)) - p).min_element() < 0.0
                    {
                        continue;
                    }
                    let off = match line.kind {
                        LineKind::Frame => 0.0,
                        LineKind::Fault { fault, .. } => (p.x - (form.faults[fault].at)(p.y, p.z)).abs(),
                        LineKind::Horizon { horizon } => (0..1u32 << form.faults.len())
                            .map(|bits| (p.z - (form.sheet)(horizon, bits, p.x, p.y)).abs())
                            .fold(f64::INFINITY, f64::min),
                    };
                    assert!(off < 0.02, "{name}: {:?} {off} off at {p}", line.kind);
                }
            }
        }
    }
}

#[test]
fn horizons_meet_the_fault_where_they_should() {
    let form = closed_form::dipping_normal();
    let [low, high] = whole(form.geometry.size());
    let plane = SectionPlane::crossline(17.0, low, high);
    let section = Section::new(&form.model(), &plane);
    for h in 0..3 {
        for bits in 0..2 {
            // Fixed point of x = fault(y, sheet(x, y)).
            let mut x = 30.0;
            for _ in 0..100 {
                x = (form.faults[0].at)(17.0, (form.sheet)(h, bits, x, 17.0));
            }
            let junction = DVec2::new(x, (form.sheet)(h, bits, x, 17.0));
            let ends = section.lines.iter().filter(|l| l.kind == LineKind::Horizon { horizon: h });
            let nearest = ends
                .flat_map(|l| [l.points[0], l.points[l.points.len() - 1]])
                .map(|p| p.distance(junction))
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.01, "horizon {h}, side {bits}: {nearest}");
        }
    }
    // One fault line from top to bottom, one line per horizon and side.
    let count = |kind: LineKind| section.lines.iter().filter(|l| l.kind == kind).count();
    assert_eq!(count(LineKind::Fault { fault: 0, real: true }), 1);
    assert_eq!((0..3).map(|h| count(LineKind::Horizon { horizon: h })).collect::<Vec<_>>(), [2, 2, 2]);
    // Four layers on each side.
    assert_eq!(section.polygons.len(), 8);
}

#[test]
fn a_fault_is_drawn_to_its_tip_and_its_layers_are_joined_beyond() {
    let form = closed_form::dying_out();
    let model = form.model();
    let [low, high] = whole(form.geometry.size());
    let section = Section::new(&model, &SectionPlane::slice(20.0, low, high));
    let real = LineKind::Fault { fault: 0, real: true };
    let end = section.lines.iter().filter(|l| l.kind == real).flat_map(|l| &l.points).map(|p| p.y).fold(0.0, f64::max);
    assert!((end - 26.0).abs() < 0.2, "{end}");
    // A section through its end shows all of it.
    let last = Section::new(&model, &SectionPlane::crossline(26.0, low, high));
    let lines = last.lines.iter().filter(|line| line.kind == real);
    let length: f64 = lines.flat_map(|line| line.points.windows(2)).map(|ends| ends[0].distance(ends[1])).sum();
    assert!(length >= high.z - low.z, "{length}");
    // Regions stop at the extended fault, layers do not.
    let beyond = DVec2::new(31.4, 40.0);
    let [left, right] = [-0.5, 0.5].map(|d| section.region_at(beyond + DVec2::new(d, 0.0)).unwrap());
    assert!(left.layer == right.layer && left.block != right.block);
    let across =
        |l: &&LayerPolygon| [-0.5, 0.5].iter().all(|&d| trace::winding(&l.rings, beyond + DVec2::new(d, 0.0)) != 0);
    assert_eq!(section.layers.iter().filter(across).count(), 1);
    // On a section beyond the tip nothing is cut at all.
    let section = Section::new(&model, &SectionPlane::crossline(40.0, low, high));
    assert_eq!(section.layers.len(), 4);
    assert!(section.lines.iter().all(|l| !matches!(l.kind, LineKind::Fault { .. })));
    let horizons: Vec<usize> =
        (0..3).map(|h| section.lines.iter().filter(|l| l.kind == LineKind::Horizon { horizon: h }).count()).collect();
    assert_eq!(horizons, [1, 1, 1]);
}

/// Random folds and random planar faults, some of them truncated by others.
fn tangle(seed: u32, faults: usize) -> StructuralModel {
    let g = SurveyGeometry::regular([40, 36, 44], 10.0, 10.0, VerticalUnit::Metres);
    let mut random = Random(seed);
    let mut given: Vec<Fault> = Vec::new();
    for f in 0..faults {
        let n = random.direction();
        let (u, v) = n.any_orthonormal_pair();
        let centre = random.place(g.size()) * 0.6 + DVec3::new(8.0, 7.0, 9.0);
        // Some go right through, some end inside.
        let reach = if random.next() < 0.5 { 100.0 } else { 15.0 };
        let corner = |a: f64, b: f64| g.world_from_voxel(centre + reach * (a * u + b * v));
        let mesh = TriangleMesh {
            vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let truncated_by = (f > 0 && random.next() < 0.4).then(|| format!("F{}", f - 1));
        given.push(Fault { truncated_by, ..Fault::new(format!("F{f}"), mesh) });
    }
    let contacts = [Contact::Conformable, Contact::Erosional, Contact::Conformable, Contact::Intrusive];
    let horizons: Vec<Horizon> = (0..4)
        .map(|h| {
            let (a, b, c) = (random.next(), random.next(), random.next());
            let depth = (0..40 * 36)
                .map(|n| {
                    let (x, y) = ((n / 36) as f64, (n % 36) as f64);
                    let z = 8.0
                        + 9.0 * h as f64
                        + 4.0 * (x * 0.2 * a + 6.0 * b).sin()
                        + 3.0 * (y * 0.3 * c + x * 0.1).cos();
                    (10.0 * z) as f32
                })
                .collect();
            let sheet = Sheet::new(NodeGrid::of_survey(&g), depth, Quality::Picked);
            Horizon::new(format!("H{h}"), vec![sheet])
        })
        .collect();
    let named = |(h, &contact): (usize, &Contact)| StratigraphicHorizon { name: format!("H{h}"), contact };
    let s = Stratigraphy { horizons: contacts.iter().enumerate().map(named).collect(), layer_names: Vec::new() };
    let settings = ModelSettings { margin: Some(4), crossing_nodes: usize::MAX, ..ModelSettings::default() };
    StructuralModel::build(&g, &s, &horizons, &given, &settings, &Progress::silent()).unwrap()
}

#[test]
fn any_tangle_of_faults_and_horizons_is_covered_once() {
    for (seed, faults) in [(1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 7)] {
        let model = tangle(seed, faults);
        for plane in planes(model.size()).into_iter().step_by(2) {
            let section = Section::new(&model, &plane);
            let full = plane.extent[0] * plane.extent[1];
            let by_region: f64 = section.polygons.iter().map(|p| area(&p.rings)).sum();
            let by_layer: f64 = section.layers.iter().map(|p| area(&p.rings)).sum();
            assert!((by_region / full - 1.0).abs() < 1e-6 && (by_layer / full - 1.0).abs() < 1e-6, "{seed}");
            let mut random = Random(seed);
            for _ in 0..200 {
                let st = closed_form::inside(&mut random, plane.extent);
                let at = |d: DVec2| model.region_at(plane.voxel(st + 0.03 * d).as_vec3());
                let expected = at(DVec2::ZERO);
                if [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y, DVec2::ONE, -DVec2::ONE]
                    .iter()
                    .all(|&d| at(d) == expected)
                {
                    let holding: Vec<_> = section
                        .polygons
                        .iter()
                        .filter(|p| trace::winding(&p.rings, st) != 0)
                        .map(|p| p.region)
                        .collect();
                    assert_eq!(holding, [expected], "{seed}, {st}");
                }
            }
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let form = closed_form::crossing_x();
    let model = form.model();
    for plane in planes(form.geometry.size()) {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Section::new(&model, &plane))
        };
        assert!(with(1) == with(3));
    }
}

/// A contact and z(x).
type Layered = (Contact, fn(f64) -> f64);

/// A model without faults from closed forms.
fn layered(forms: &[Layered]) -> StructuralModel {
    let g = SurveyGeometry::regular([81, 20, 60], 10.0, 10.0, VerticalUnit::Metres);
    let horizons: Vec<Horizon> = forms
        .iter()
        .enumerate()
        .map(|(h, (_, z))| {
            let depth = (0..81 * 20).map(|n| (10.0 * z((n / 20) as f64)) as f32).collect();
            let sheet = Sheet::new(NodeGrid::of_survey(&g), depth, Quality::Picked);
            Horizon::new(format!("H{h}"), vec![sheet])
        })
        .collect();
    let named = |(h, f): (usize, &Layered)| StratigraphicHorizon { name: format!("H{h}"), contact: f.0 };
    let s = Stratigraphy { horizons: forms.iter().enumerate().map(named).collect(), layer_names: Vec::new() };
    StructuralModel::build(&g, &s, &horizons, &[], &ModelSettings::default(), &Progress::silent()).unwrap()
}

fn layer_area(section: &Section, layer: u16) -> f64 {
    section.layers.iter().filter(|l| l.layer == layer).map(|l| area(&l.rings)).sum()
}

#[test]
fn pinch_outs_and_thin_layers_keep_their_area() {
    // A wedge that laps out at x = 50 and a layer of 0.05 voxels.
    let model = layered(&[
        (Contact::Conformable, |x| 20.0 + 0.1 * x),
        (Contact::Onlap, |x| 30.0 - 0.1 * x),
        (Contact::Conformable, |x| 30.05 - 0.1 * x),
    ]);
    let plane = SectionPlane::crossline(9.3, DVec3::ZERO, DVec3::new(80.0, 19.0, 59.0));
    let section = Section::new(&model, &plane);
    // Layer 2 between H0 and H1: a triangle 50 wide and 10 high.
    assert!((layer_area(&section, 2) - 250.0).abs() < 0.05, "{}", layer_area(&section, 2));
    assert!((layer_area(&section, 1) - 4.0).abs() < 0.01, "{}", layer_area(&section, 1));
    let tip = DVec2::new(50.0, 25.0);
    let wedge = section.layers.iter().find(|l| l.layer == 2).unwrap();
    let nearest = wedge.rings[0].iter().map(|p| p.distance(tip)).fold(f64::INFINITY, f64::min);
    assert!(nearest < 0.01, "{nearest}");
    // H0 is drawn to the tip and no farther.
    let end = section
        .lines
        .iter()
        .filter(|l| l.kind == LineKind::Horizon { horizon: 0 })
        .flat_map(|l| &l.points)
        .map(|p| p.x)
        .fold(0.0, f64::max);
    assert!((end - 50.0).abs() < 0.01, "{end}");
}

#[test]
fn a_dome_cut_at_its_flank_is_a_ring_with_a_hole() {
    let g = SurveyGeometry::regular([81, 81, 60], 10.0, 10.0, VerticalUnit::Metres);
    let z = |x: f64, y: f64| 40.0 - 20.0 * (-((x - 40.0).powi(2) + (y - 40.0).powi(2)) / 800.0).exp();
    let depth = (0..81 * 81).map(|n| (10.0 * z((n / 81) as f64, (n % 81) as f64)) as f32).collect();
    let sheet = Sheet::new(NodeGrid::of_survey(&g), depth, Quality::Picked);
    let horizon = Horizon::new("H0", vec![sheet]);
    let s = Stratigraphy {
        horizons: vec![StratigraphicHorizon { name: "H0".into(), contact: Contact::Conformable }],
        layer_names: Vec::new(),
    };
    let model =
        StructuralModel::build(&g, &s, &[horizon], &[], &ModelSettings::default(), &Progress::silent()).unwrap();
    let plane = SectionPlane::slice(30.0, DVec3::ZERO, DVec3::new(80.0, 80.0, 59.0));
    let section = Section::new(&model, &plane);
    // z = 30 where exp(…) = 1/2: r² = 800 ln 2.
    let circle = std::f64::consts::PI * 800.0 * std::f64::consts::LN_2;
    assert_eq!(section.polygons.len(), 2);
    let inner = section.polygons.iter().find(|p| p.region.layer == 0).unwrap();
    let outer = section.polygons.iter().find(|p| p.region.layer == 1).unwrap();
    assert_eq!((inner.rings.len(), outer.rings.len()), (1, 2));
    assert!((area(&inner.rings) / circle - 1.0).abs() < 1e-3);
    let line = section.lines.iter().find(|l| l.kind == LineKind::Horizon { horizon: 0 }).unwrap();
    assert_eq!(line.points[0], line.points[line.points.len() - 1]);
    for p in &line.points {
        assert!((p.distance(DVec2::splat(40.0)) - (800.0 * std::f64::consts::LN_2).sqrt()).abs() < 0.01);
    }
}

#[test]
fn quality_shows_in_the_lines() {
    let model = layered(&[(Contact::Conformable, |x| if x < 40.0 { 20.0 + 0.1 * x } else { f64::NAN })]);
    let plane = SectionPlane::crossline(9.0, DVec3::ZERO, DVec3::new(80.0, 19.0, 59.0));
    let section = Section::new(&model, &plane);
    let reach = |quality: LineQuality| {
        section
            .lines
            .iter()
            .filter(|l| l.kind != LineKind::Frame && l.quality == quality)
            .flat_map(|l| &l.points)
            .map(|p| p.x)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
    };
    let (certain, inferred) = (reach(LineQuality::Certain), reach(LineQuality::Inferred));
    assert!(certain.0 == 0.0 && certain.1 > 40.0 && certain.1 < 46.0 && inferred == (certain.1, 80.0));
}

#[test]
fn an_improper_rectangle_is_an_empty_section() {
    let form: ModelForm = closed_form::flat();
    let model = form.model();
    for extent in [[0.0, 5.0], [f64::NAN, 5.0], [5.0, -1.0]] {
        let plane = SectionPlane { origin: DVec3::ZERO, s_axis: DVec3::X, t_axis: DVec3::Z, extent };
        assert!(Section::new(&model, &plane).polygons.is_empty());
    }
    let folded = SectionPlane { origin: DVec3::ZERO, s_axis: DVec3::X, t_axis: DVec3::X, extent: [5.0, 5.0] };
    assert!(Section::new(&model, &folded).polygons.is_empty());
}
