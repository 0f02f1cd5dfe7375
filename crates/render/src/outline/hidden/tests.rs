//! Lines are cut where they disappear.

use super::*;
use crate::{Camera, VoxelBox};
use survey::{SurveyGeometry, VerticalUnit};

#[test]
fn a_line_is_cut_where_it_disappears() {
    let geometry = SurveyGeometry::regular([11, 11, 11], 10.0, 10.0, VerticalUnit::Metres);
    let view = View::new(&Camera::default(), &geometry, &VoxelBox::of_size([11; 3]), 1.0, [400, 400]);
    let line = [DVec3::new(0.0, 5.0, 0.0), DVec3::new(4.0, 5.0, 0.0), DVec3::new(10.0, 5.0, 0.0)];
    let parts = seen_parts(&view, &line, |p| (2.0..3.0).contains(&p.x) || p.x > 7.5);
    let expected = [[2.0, 3.0], [7.5, 10.0]];
    assert_eq!(parts.len(), 2);
    for (part, ends) in parts.iter().zip(expected) {
        for (found, x) in [part[0], part[part.len() - 1]].into_iter().zip(ends) {
            assert!((found - view.project(DVec3::new(x, 5.0, 0.0))).length() < 0.05);
        }
    }
    assert!(seen_parts(&view, &line, |_| false).is_empty());
    assert!(seen_parts(&view, &line, |p| p.x < 1e-4).is_empty(), "a dot at the beginning");
    assert_eq!(seen_parts(&view, &line, |_| true), vec![line.map(|p| view.project(p)).to_vec()]);
}
