//! Faults on structure maps.

use super::fold::Fold;
use figure::map::{FaultCut, HorizonMap, MapSource, Mapped};
use glam::{DVec2, DVec3};
use survey::{SurveyGeometry, VerticalUnit};
use synth::closed_form::ClosedForm;

#[test]
fn a_map_has_the_lines_at_which_a_fault_cuts_the_horizon_off() {
    let fold = Fold::new();
    let (model, horizon) = (&fold.model, 1);
    let map = HorizonMap::new(&fold.geometry, MapSource::Model(model), Mapped::Structure(horizon)).unwrap();
    assert!(map.faults.iter().all(|cut| cut.fault == 0 && !cut.is_covered), "{:?}", map.faults);
    // One line on each side of the gap that a normal fault leaves, both from rim to rim.
    let long: Vec<&FaultCut> = map.faults.iter().filter(|cut| cut.line.len() > 30).collect();
    assert_eq!(long.len(), 2);
    let on_sheet = |xy: DVec2, block: u16| -> DVec3 {
        xy.extend(f64::from(model.horizon_z(horizon, block, xy.x as f32, xy.y as f32)))
    };
    let surface = &model.faults().surfaces()[0];
    let off_fault = |xy: DVec2| {
        let offs = (0..model.block_count() as u16).map(|block| surface.side(on_sheet(xy, block)).abs());
        offs.fold(f64::INFINITY, f64::min)
    };
    for cut in &long {
        let most = cut.line.iter().map(|place| off_fault(*place)).fold(0.0, f64::max);
        // Of 12.5 metres from trace to trace.
        assert!(most < 0.6, "{most} m beside the fault");
    }
    // Between them the horizon is missing, and just outside it is there.
    let pixels = f64::from(map.image.width() - 1) / 60.0;
    let is_there = |at: DVec2| {
        let px = (at * pixels).round();
        map.image.get_pixel(px.x as u32, px.y as u32).0[3] > 0
    };
    for place in long[0].line.iter().filter(|place| (3.0..37.0).contains(&place.y)) {
        let nearest = long[1].line.iter().min_by(|a, b| a.distance(*place).total_cmp(&b.distance(*place))).unwrap();
        let across = *nearest - *place;
        assert!((1.0..6.0).contains(&across.length()), "a gap of {across}");
        assert!(
            !is_there(*place + 0.5 * across) && is_there(*place - 0.3 * across) && is_there(*nearest + 0.3 * across)
        );
    }
}

#[test]
fn the_lower_line_of_a_reverse_fault_is_covered() {
    let geometry = SurveyGeometry::regular([61, 41, 51], 12.5, 12.5, VerticalUnit::Metres);
    let closed = ClosedForm::dome(&geometry, &[10.0, 22.0, 34.0], 30.0).with_fault(65.0, -6.0);
    let fold = Fold::of(geometry, &closed, &["limestone", "shale", "dolostone", "limestone"]);
    let map = HorizonMap::new(&fold.geometry, MapSource::Model(&fold.model), Mapped::Structure(1)).unwrap();
    let long =
        |is_covered: bool| map.faults.iter().filter(|cut| cut.line.len() > 30 && cut.is_covered == is_covered).count();
    assert_eq!([long(false), long(true)], [1, 1]);
    // No gap: there is a value everywhere.
    assert!(map.image.pixels().all(|pixel| pixel.0[3] > 0));
}
