//! Paths of closed forms: bricks that stay bricks, and areas that lie where rays meet them.

use crate::block::Block;
use glam::{DVec2, DVec3};
use render::vector::{AreaFill, Polyline, VectorBlock, VectorLineKind, vectors};
use render::{Background, Camera, CutShape, DrawnWell, Ground, Inputs, Outlines, Scene, VoxelBox};
use survey::{Progress, SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;
use ttf::{Colour, Frequency, LayerStyle, TextureLibrary, TransferFunctions};

fn library() -> TextureLibrary {
    TextureLibrary::builtin().unwrap()
}

/// Every layer in limestone.
fn bricks(closed: &ClosedForm) -> Block {
    let mut functions = TransferFunctions::default();
    for name in closed.stratigraphy.layer_names_bottom_up() {
        functions.layers.set(LayerStyle::textured(&name, Colour::new(170, 200, 220), "limestone"));
    }
    Block::of(closed, &functions, &library())
}

fn traced(scene: &Scene, block: &Block) -> VectorBlock {
    vectors(scene, &block.inputs(&[]), &library(), 0.05, scene.size_px, &Progress::silent()).unwrap().unwrap()
}

fn head_on(size_px: [u32; 2]) -> Scene {
    let camera = Camera { azimuth_deg: Some(0.0), elevation_deg: 0.0, margin: 0.0, ..Camera::default() };
    Scene { size_px, camera, exaggeration: 1.0, ground: None, outlines: Outlines::none(), ..Scene::default() }
}

/// Lines of the pattern of a layer.
fn lines(traced: &VectorBlock, layer: u16) -> Vec<&Polyline> {
    let areas = traced.areas.iter().filter(|area| area.layer == layer);
    let parts = areas.filter_map(|area| match &area.fill {
        AreaFill::Pattern(parts) => Some(parts),
        _ => None,
    });
    parts.flatten().flat_map(|part| &part.lines).collect()
}

#[test]
fn bricks_on_a_cylindrical_fold_lie_along_it_and_their_joints_across() {
    let geometry = SurveyGeometry::regular([81, 9, 61], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[12.0, 36.0], 35.0);
    let block = bricks(&closed);
    let scene = head_on([1600, 1200]);
    let traced = traced(&scene, &block);
    let view = scene.view(&geometry);
    let [samples, half_width] = [36.0, 0.5 * 80.0];
    let axis = view.project(DVec3::new(half_width, 0.0, samples + half_width / 35f64.to_radians().sin()));
    // Beyond the layer's horizons a joint is cut off.
    let crests = [12.0, 36.0].map(|sample| axis.distance(view.project(DVec3::new(half_width, 0.0, sample))));
    let is_in_layer = |p: DVec2| (crests[1]..crests[0]).contains(&p.distance(axis));
    let (mut joints, mut courses) = (0, 0);
    let (mut askew, mut length, mut oblique) = (0, 0.0, 0.0);
    for line in lines(&traced, 1) {
        let [a, b] = [line.points[0], line.points[line.points.len() - 1]];
        let radius = 0.5 * (a + b) - axis;
        // Angle between a line and bedding.
        let from_bedding = |step: DVec2, radius: DVec2| {
            90.0 - (step.dot(radius).abs() / (step.length() * radius.length())).acos().to_degrees()
        };
        if from_bedding(b - a, radius) > 45.0 {
            if !(is_in_layer(a) && is_in_layer(b)) {
                continue;
            }
            joints += 1;
            askew += usize::from(from_bedding(b - a, radius) < 87.0);
        } else {
            courses += 1;
            // What hangs over the block's sides is cut off there.
            let is_on_block = |p: &DVec2| (20.0..1580.0).contains(&p.x) && (0.0..1180.0).contains(&p.y);
            for ends in line.points.windows(2).filter(|ends| ends.iter().all(is_on_block)) {
                let step = ends[1] - ends[0];
                let angle = from_bedding(step, 0.5 * (ends[0] + ends[1]) - axis);
                length += step.length();
                oblique += if angle > 3.0 { step.length() } else { 0.0 };
            }
        }
    }
    assert!(askew * 50 < joints, "{askew} of {joints} joints are not across");
    assert!(oblique < 0.01 * length, "{oblique} of {length} pixels of courses leave the bedding");
    assert!(joints > 50 && courses > 10, "{joints} joints, {courses} courses");
}

#[test]
fn courses_whose_ends_and_middle_lie_beside_a_narrow_block_cross_it() {
    let geometry = SurveyGeometry::regular([9, 9, 61], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[12.0, 48.0]);
    let scene = head_on([400, 1600]);
    let view = scene.view(&geometry);
    let [left, right] = [0.0, 8.0].map(|i| view.project(DVec3::new(i, 0.0, 30.0)).x);
    let [low, high] = [left.min(right), left.max(right)];
    // So many tiles over the block, from those that are narrower to one that hangs over both sides.
    for across in [3.0, 1.0, 0.7, 0.5, 0.45, 0.4, 0.35, 0.3] {
        let mut functions = TransferFunctions::default();
        let style = LayerStyle::textured(&closed.stratigraphy.layer_names_bottom_up()[1], Colour::WHITE, "limestone");
        functions.layers.set(LayerStyle { frequency: Some(Frequency { horizontal: across, vertical: 2.0 }), ..style });
        let block = Block::of(&closed, &functions, &library());
        // So coarse that a course is one straight piece.
        let found = vectors(&scene, &block.inputs(&[]), &library(), 1.0, scene.size_px, &Progress::silent());
        let found = found.unwrap().unwrap();
        let at = |line: &Polyline, x: f64| {
            let spans = line.points.windows(2).any(|ends| (ends[0].x - x) * (ends[1].x - x) <= 0.0);
            spans && (line.points[0].y - line.points[line.points.len() - 1].y).abs() < 2.0
        };
        let courses = |x: f64| lines(&found, 1).iter().filter(|line| at(line, x)).count();
        for share in [0.2, 0.5, 0.8] {
            let courses = courses(low + share * (high - low));
            assert!(courses >= 8, "{courses} courses at {share} of the width under {across} tiles");
        }
    }
}

#[test]
fn curves_are_as_straight_as_asked() {
    let geometry = SurveyGeometry::regular([81, 9, 61], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[12.0, 36.0], 35.0);
    let block = bricks(&closed);
    let points = |tolerance: f64| {
        let traced =
            vectors(&head_on([800, 600]), &block.inputs(&[]), &library(), tolerance, [800, 600], &Progress::silent());
        lines(&traced.unwrap().unwrap(), 1).iter().map(|line| line.points.len()).sum::<usize>()
    };
    assert!(points(0.02) > points(0.2) && points(0.2) > points(2.0));
}

#[test]
fn areas_are_the_layers_that_rays_meet() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[10.0, 24.0], 30.0).with_fault(60.0, 5.0);
    let mut functions = TransferFunctions::default();
    let names = closed.stratigraphy.layer_names_bottom_up();
    let colours = [Colour::new(250, 0, 0), Colour::new(0, 250, 0), Colour::new(0, 0, 250)];
    for (name, colour) in names.iter().zip(colours) {
        functions.layers.set(LayerStyle::plain(name, colour));
    }
    let block = Block::of(&closed, &functions, &library());
    let camera = Camera { azimuth_deg: Some(35.0), ..Camera::default() };
    let whole = VoxelBox::of_size(geometry.size());
    let scene = Scene {
        camera,
        cut_outs: whole.stair(render::Corner::MinMin, [0.6, 0.5], 0.7, 2),
        face_tone: 0.0,
        background: Background::Colour(Colour::WHITE),
        samples: 1,
        ..head_on([320, 260])
    };
    let traced = traced(&scene, &block);
    let picture = render::reference::render(&scene, &block.inputs(&[]), &Progress::silent()).unwrap();
    let (mut wrong, mut rock) = (0, 0);
    for (x, y, pixel) in picture.enumerate_pixels() {
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let is_met = |area: &&render::vector::VectorArea| {
            let is_seen = |pieces: &Vec<Vec<DVec2>>| pieces.iter().any(|piece| holds(std::slice::from_ref(piece), p));
            holds(&area.rings, p) && area.seen.as_ref().is_none_or(is_seen)
        };
        let found: Vec<Colour> = traced
            .areas
            .iter()
            .filter(is_met)
            .filter_map(|area| match area.fill {
                AreaFill::Colour(colour) => Some(colour),
                _ => None,
            })
            .collect();
        let is_rock = pixel.0 != [255; 4];
        rock += usize::from(is_rock);
        let right = match (found.as_slice(), is_rock) {
            ([], false) => true,
            ([colour], true) => colour.rgb == pixel.0[..3],
            _ => false,
        };
        wrong += usize::from(!right);
    }
    // Rays that graze a line may fall on either side of it.
    assert!(rock > 20_000 && wrong * 400 < rock, "{wrong} of {rock}");
}

/// Whether a place lies within rings, by the even-odd rule.
fn holds(rings: &[Vec<DVec2>], p: DVec2) -> bool {
    let sides = rings.iter().flat_map(|ring| (0..ring.len()).map(|n| (ring[n], ring[(n + 1) % ring.len()])));
    let crossed =
        sides.filter(|(a, b)| (a.y <= p.y) != (b.y <= p.y) && a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x);
    crossed.count() % 2 == 1
}

#[test]
fn under_a_ground_faces_are_seen_where_no_nearer_rock_hides_them() {
    let geometry = SurveyGeometry::regular([41, 41, 41], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[8.0, 20.0, 30.0], 35.0);
    let block = bricks(&closed);
    let corner = VoxelBox::of_size([41, 41, 41]).corner_cut(render::Corner::MinMin, [0.5, 0.6]);
    let shaft = CutShape::round(DVec2::splat(20.0), 130.0, None, &geometry);
    let (mut hidden, mut seen) = (0, 0);
    for (cut_outs, cut_shapes) in [(vec![corner], Vec::new()), (Vec::new(), vec![shaft])] {
        let camera = Camera { azimuth_deg: Some(30.0), elevation_deg: 28.0, ..Camera::default() };
        let ground = Some(Ground::default());
        let scene = Scene { size_px: [320, 240], camera, cut_outs, cut_shapes, ground, ..Scene::default() };
        let traced = traced(&scene, &block);
        let colours: Vec<_> = traced.areas.iter().filter(|area| matches!(area.fill, AreaFill::Colour(_))).collect();
        // Facets side by side hide nothing of one another: only the two sides of the block hide parts of them.
        assert!(traced.hidden.iter().all(|faces| faces.len() <= 2));
        for n in 0..320 * 240 {
            let p = DVec2::new(f64::from(n % 320) + 0.37, f64::from(n / 320) + 0.61);
            let met: Vec<_> = colours
                .iter()
                .filter(|area| holds(&area.rings, p))
                .filter(|area| {
                    area.seen.iter().all(|pieces| pieces.iter().any(|piece| holds(std::slice::from_ref(piece), p)))
                })
                .collect();
            let is_seen = |face: usize| traced.hidden[face].iter().all(|rings| !holds(rings, p));
            let left: Vec<_> = met.iter().filter(|area| is_seen(area.face)).collect();
            // Faces come back to front, so that the last one is the nearest.
            assert!(left.len() <= 1, "{p}: {:?}", left.iter().map(|area| (area.face, area.layer)).collect::<Vec<_>>());
            let nearest = met.last().map(|area| (area.face, area.layer));
            assert_eq!(left.first().map(|area| (area.face, area.layer)), nearest, "{p}");
            (hidden, seen) = (hidden + met.len() - left.len(), seen + left.len());
        }
    }
    assert!(hidden > 1000 && seen > 20_000, "{hidden} {seen}");
}

#[test]
fn lines_have_the_names_of_horizons_and_faults() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 10.0, 10.0, VerticalUnit::Metres);
    let block = bricks(&ClosedForm::flat(&geometry, &[10.0, 24.0]).with_fault(60.0, 5.0));
    let traced = traced(&Scene { outlines: Outlines::default(), ..head_on([400, 300]) }, &block);
    let kinds: Vec<VectorLineKind> = traced.lines.iter().map(|line| line.kind).collect();
    use VectorLineKind::{Edge, Fault, Horizon};
    assert_eq!(kinds, [Horizon(Some(0)), Horizon(Some(1)), Fault(0), Edge]);
    assert_eq!(traced.lines[2].colour, Outlines::default().faults.colour);
    // Each horizon is one line on each side of the fault.
    assert_eq!(traced.lines[0].parts.len(), 2);
    assert_eq!(traced.lines[2].parts.len(), 1);
}

/// Beds thinner than a course of bricks are flat tints of the pattern's mean colour; thick ones keep the pattern.
#[test]
fn beds_too_thin_for_their_pattern_have_its_mean_colour() {
    let geometry = SurveyGeometry::regular([41, 31, 61], 10.0, 10.0, VerticalUnit::Metres);
    let block = bricks(&ClosedForm::flat(&geometry, &[20.0, 20.1]));
    let traced = traced(&head_on([400, 300]), &block);
    let of = |layer: u16| -> Vec<&AreaFill> {
        traced.areas.iter().filter(|area| area.layer == layer).map(|area| &area.fill).collect()
    };
    assert!(!lines(&traced, 0).is_empty() && !lines(&traced, 2).is_empty());
    let [AreaFill::Colour(whole), AreaFill::Colour(tint)] = of(1)[..] else { panic!("it has its pattern") };
    // Darker than the layer's colour by the ink of its bricks.
    let darker = whole.luminance() - tint.luminance();
    assert!((0.02..0.3).contains(&darker), "{whole} and {tint}");
    // The corner of a thick layer is as thin, and has its pattern.
    let dipping = bricks(&ClosedForm::dipping(&geometry, &[57.6], 25.0, 240.0));
    let traced = self::traced(&head_on([400, 300]), &dipping);
    let corner: Vec<&AreaFill> = traced.areas.iter().filter(|area| area.layer == 0).map(|area| &area.fill).collect();
    assert!(matches!(corner[..], [AreaFill::Colour(_), AreaFill::Pattern(_)]), "{}", corner.len());
}

/// A fault that was given a colour is drawn in it, as paths and as pixels, and printed as the preset says.
#[test]
fn a_fault_has_the_colour_that_it_was_given() {
    let geometry = SurveyGeometry::regular([41, 31, 41], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[10.0, 24.0]).with_fault(60.0, 5.0);
    let red = Colour::new(0xe0, 0x10, 0x20);
    let scene = Scene { outlines: Outlines::default(), samples: 2, ..head_on([400, 300]) };
    let reds = |faults: Vec<Option<Colour>>| {
        let block = Block::of(&closed, &TransferFunctions { faults, ..TransferFunctions::default() }, &library());
        let line = traced(&scene, &block).lines.into_iter().find(|line| line.kind == VectorLineKind::Fault(0));
        let picture = render::reference::render(&scene, &block.inputs(&[]), &Progress::silent()).unwrap();
        let is_red = |pixel: &&image::Rgba<u8>| pixel.0[0] > 200 && pixel.0[1] < 60 && pixel.0[2] < 70;
        (line.unwrap().colour, picture.pixels().filter(is_red).count())
    };
    assert_eq!(reds(vec![None]), (Outlines::default().faults.colour, 0));
    let (colour, pixels) = reds(vec![Some(red)]);
    assert!(colour == red && pixels > 60, "{colour}: {pixels}");
    let settings = ttf::TtfSettings { preset: ttf::Preset::BlackAndWhite, ..Default::default() };
    let printed = TransferFunctions { faults: vec![Some(red)], settings, ..TransferFunctions::default() };
    let line = traced(&scene, &Block::of(&closed, &printed, &library())).lines.swap_remove(2);
    assert_eq!((line.kind, line.colour), (VectorLineKind::Fault(0), Colour::BLACK));
}

#[test]
fn what_paths_cannot_show_is_left_to_the_picture() {
    let geometry = SurveyGeometry::regular([21, 21, 21], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::flat(&geometry, &[10.0]);
    let block = bricks(&closed);
    let names = closed.stratigraphy.layer_names_bottom_up();
    let mut functions = TransferFunctions::default();
    let mut halves = LayerStyle::textured(&names[0], Colour::WHITE, "limestone");
    halves.intervals[0].k = [0.0, 0.5];
    halves.intervals.push(ttf::DepthInterval {
        k: [0.5, 1.0],
        colour: Some(Colour::BLACK),
        ..halves.intervals[0].clone()
    });
    functions.layers.set(halves);
    functions.layers.set(LayerStyle::textured(&names[1], Colour::WHITE, "chalk"));
    let two = Block::of(&closed, &functions, &library());
    let parts = traced(&head_on([200, 160]), &two);
    let fills = |layer: u16| {
        let areas = parts.areas.iter().filter(|area| area.layer == layer);
        areas.map(|area| (matches!(area.fill, AreaFill::Colour(_)), area.band.is_some())).collect::<Vec<_>>()
    };
    // The layer, the pattern of its lower half, and colour and pattern of the upper half.
    assert_eq!(fills(0), [(true, false), (false, true), (true, true), (false, true)]);
    assert_eq!(fills(1), [(true, false), (false, false)]);
    // The halves lie one above the other, and meet.
    let range = |area: &render::vector::VectorArea| {
        let ys = || area.band.iter().flatten().flatten().map(|p| p.y);
        [ys().fold(f64::INFINITY, f64::min), ys().fold(f64::NEG_INFINITY, f64::max)]
    };
    let halves: Vec<_> = parts.areas.iter().filter(|area| area.band.is_some()).map(range).collect();
    assert!((halves[1][1] - halves[0][0]).abs() < 0.2 && halves[0][1] > halves[0][0] + 10.0, "{halves:?}");
    // A scene that is half raw is a picture with lines.
    let volume = survey::Volume::filled([21; 3], 0.5f32);
    let volumes = [render::NamedVolume::whole("seismic", &volume)];
    let raw = ttf::RawColour::new("seismic", ttf::RgbaFunction::centred(ttf::ColourMap::Grey, 1.0));
    let scene = Scene { raw: Some(raw), blend: 0.5, outlines: Outlines::default(), ..head_on([200, 160]) };
    let half =
        vectors(&scene, &block.inputs(&volumes), &library(), 0.1, scene.size_px, &Progress::silent()).unwrap().unwrap();
    assert!(!half.has_areas && half.areas.is_empty() && !half.lines.is_empty());
}

/// The ground and a well are drawn alone, in the colours that a picture has there, and clear where faces are seen; in as
/// many pixels as are asked for.
#[test]
fn the_ground_and_wells_are_drawn_alone_as_in_a_picture() {
    let geometry = SurveyGeometry::regular([41, 41, 31], 10.0, 10.0, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[8.0, 18.0], 30.0).with_fault(60.0, 4.0);
    let block = bricks(&closed);
    let path = [DVec3::new(32.0, 6.0, 0.0), DVec3::new(32.0, 6.0, 30.0)];
    let wells = [DrawnWell { name: "A", colour: Some(Colour::new(10, 200, 30)), path: &path, tops: &[] }];
    let scene = Scene {
        size_px: [240, 200],
        samples: 3,
        cut_outs: vec![VoxelBox { min: [25.0, 0.0, 0.0], max: [40.0, 15.0, 30.0] }],
        ground: Some(Ground::default()),
        outlines: Outlines::none(),
        background: Background::Transparent,
        ..Scene::default()
    };
    let inputs = Inputs { wells: &wells, ..block.inputs(&[]) };
    let drawn = |scene: &Scene, size_px| {
        let traced = vectors(scene, &inputs, &library(), 0.1, size_px, &Progress::silent()).unwrap().unwrap();
        traced.over
    };
    let over = drawn(&scene, scene.size_px).unwrap();
    let picture = render::reference::render(&scene, &inputs, &Progress::silent()).unwrap();
    let (mut whole, mut clear, mut rim, mut green) = (0, 0, 0, 0);
    for (over, seen) in over.pixels().zip(picture.pixels()) {
        match over.0[3] {
            0 => clear += usize::from(seen.0[3] == 255),
            255 => {
                whole += 1;
                let off = (0..3).map(|n| over.0[n].abs_diff(seen.0[n])).max().unwrap();
                assert!(off <= 8, "{:?} is {:?} in the picture", over.0, seen.0);
            }
            _ => rim += 1,
        }
        green += usize::from(over.0[3] == 255 && over.0[1] / 2 > over.0[0].max(over.0[2]));
    }
    assert!(whole > 4000 && clear > 4000 && green > 50, "{whole} whole, {clear} clear, {green} of the well");
    assert!(rim * 10 < whole, "{rim} at the rim");
    assert_eq!(drawn(&scene, [60, 50]).unwrap().dimensions(), (60, 50));
    let bare = Scene { ground: None, ..scene.clone() };
    let well = drawn(&bare, scene.size_px).unwrap();
    assert!(well.pixels().filter(|pixel| pixel.0[3] > 0).count() < whole / 4);
    let closed = Scene { cut_outs: Vec::new(), ..bare };
    assert!(
        drawn(&closed, scene.size_px).is_none_or(|over| over.pixels().filter(|pixel| pixel.0[3] > 0).count() < 200)
    );
}
