//! Surfaces before the block: their cells, how they are shaded, and that they leave no seams.

use super::*;

#[test]
fn a_large_sheet_is_drawn_in_few_cells_up_to_its_far_corner() {
    let [nx, ny] = [301, 120];
    let (z, quality) = (vec![7.0; nx * ny], vec![Quality::Tracked; nx * ny]);
    let cells = Cells::of(&TraceSheet { block: 0, z: &z, quality: &quality }, [nx, ny]).cells;
    assert!(cells.len() <= CELLS * CELLS);
    let high = cells.iter().flat_map(|cell| cell.corners).fold(DVec3::ZERO, |high, corner| high.max(corner));
    assert_eq!(high, DVec3::new(300.0, 119.0, 7.0));
}

#[test]
fn a_hole_larger_than_a_cell_stays_open() {
    let [nx, ny] = [40, 40];
    let z: Vec<f32> = (0..nx * ny).map(|n| if (10..30).contains(&(n / ny)) { f32::NAN } else { 1.0 }).collect();
    let quality = vec![Quality::Tracked; nx * ny];
    let cells = Cells::of(&TraceSheet { block: 0, z: &z, quality: &quality }, [nx, ny]).cells;
    assert!(cells.iter().flat_map(|cell| cell.corners).all(|corner| corner.x < 10.0 || corner.x >= 30.0));
    assert!(!cells.is_empty());
}

#[test]
fn what_was_filled_is_lighter() {
    let geometry = SurveyGeometry::regular([9, 9, 9], 25.0, 4.0, survey::VerticalUnit::Milliseconds);
    let (z, mut quality) = (vec![4.0; 81], vec![Quality::Tracked; 81]);
    quality[..27].fill(Quality::Filled);
    quality[27..36].fill(Quality::Extrapolated);
    let cells = Cells::of(&TraceSheet { block: 0, z: &z, quality: &quality }, [9, 9]);
    let scene = Scene::default();
    let drawn = seen(&scene.view(&geometry), &scene, &geometry, [(&cells, Colour::new(0, 100, 200), 0.5)].into_iter());
    let light = drawn.iter().filter(|cell| cell.colour.rgb[0] > 0).count();
    // Three rows of cells lie between filled nodes; a fourth has as many picked ones as filled.
    assert_eq!((light, drawn.len()), (3 * 8, 8 * 8));
}

#[test]
fn cells_that_share_an_edge_leave_no_seam() {
    let cell = |left: f64, right: f64| SeenCell {
        corners: [[left, 2.3], [right, 2.3], [right, 9.1], [left, 9.1]].map(DVec2::from_array),
        colour: Colour::new(200, 100, 50),
        opacity: 0.5,
    };
    let image = picture(&[cell(1.0, 5.37), cell(5.37, 11.0)], [12, 12]);
    for x in 1..11 {
        let pixel = image.get_pixel(x, 5).0;
        assert!(pixel[3].abs_diff(128) <= 1 && pixel[0].abs_diff(200) <= 2, "{x}: {pixel:?}");
    }
}

/// A fault of two triangles that reaches out of the block: it ends there, black has shades, and a dense one is thinned.
#[test]
fn a_fault_is_seen_within_the_block() {
    let geometry = SurveyGeometry::regular([21, 31, 41], 25.0, 4.0, survey::VerticalUnit::Milliseconds);
    let scene = Scene::default();
    let [a, b, c, d] =
        [[5.0, -30.0, -20.0], [5.0, 60.0, -20.0], [15.0, 60.0, 60.0], [15.0, -30.0, 60.0]].map(DVec3::from);
    let plane = [[a, b, c], [a, c, d]];
    let cells = of_fault(&FaultMesh { name: "F", colour: Colour::BLACK, triangles: &plane }, geometry.size());
    let view = scene.view(&geometry);
    let drawn = seen(&view, &scene, &geometry, [(&cells.0, cells.1, 0.34)].into_iter());
    assert!(drawn.len() > 500 && drawn.iter().all(|cell| cell.colour.rgb[0] > 0x30), "{}", drawn.len());
    // As much as the block shows of the plane, to within the length of a cell around it.
    let area = |[a, b, c, d]: [DVec2; 4]| 0.5 * ((c - a).perp_dot(d - b)).abs();
    let [whole, part] = [-20.0, 0.0].map(|z: f64| {
        let at = |z: f64| 5.0 + 10.0 * (z + 20.0) / 80.0;
        let end = if z < 0.0 { 60.0 } else { 40.0 };
        let (left, right) = if z < 0.0 { (-30.0, 60.0) } else { (0.0, 30.0) };
        area(
            [[at(z), left, z], [at(z), right, z], [at(end), right, end], [at(end), left, end]]
                .map(|p| view.project(DVec3::from(p))),
        )
    });
    let shown: f64 = drawn.iter().map(|cell| area(cell.corners)).sum();
    assert!((shown / part - 1.0).abs() < 0.1 && whole > 4.0 * part, "{shown} of {part} and {whole}");
    // A hundred thousand triangles become a few thousand.
    let node = |x: usize, y: usize| DVec3::new(5.0 + x as f64 * 0.04, y as f64 * 0.13, x as f64 * 0.17);
    let squares = (0..230).flat_map(|x| (0..230).map(move |y| (x, y)));
    let dense: Vec<_> = squares
        .flat_map(|(x, y)| {
            [[node(x, y), node(x + 1, y), node(x, y + 1)], [node(x + 1, y), node(x + 1, y + 1), node(x, y + 1)]]
        })
        .collect();
    let cells = Cells::of_fault(&dense, geometry.size()).cells;
    assert!(dense.len() > 100_000 && (500..4 * CELLS * CELLS).contains(&cells.len()), "{}", cells.len());
}

/// Volume rendering is seen through a fault, and raw faces are not hidden by one either.
#[test]
fn a_fault_is_a_veil_before_volume_rendering() {
    let [before_faces, before_volumes] = [Faces::All, Faces::None].map(fault_opacity);
    assert!(before_volumes > 0.0 && before_volumes < 0.5 * before_faces && before_faces < 0.5);
}
