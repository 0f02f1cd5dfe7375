//! Divides a ray into stretches inside and outside cut-outs (P-illus 5.1, figure 10). Voxel space; t in
//! voxels along the ray.

use super::medium::Zone;
use crate::visible::{Ray, Solid, TOUCH};

/// A part of a ray that lies in one zone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stretch {
    /// The distances at which it begins and ends.
    pub t: [f32; 2],
    /// The zone.
    pub zone: Zone,
}

/// Calls `found` for each stretch of a ray in the roaming box between `start` and `stop`, front to back.
pub(super) fn stretches(solid: &Solid, ray: &Ray, [start, stop]: [f32; 2], mut found: impl FnMut(Stretch)) {
    let Some([enter, exit]) = solid.box_interval(ray) else { return };
    let last = exit.min(stop);
    let mut t = enter.max(start);
    let mut add = |from: f32, to: f32, zone: Zone| {
        if to > from + TOUCH {
            found(Stretch { t: [from, to], zone });
        }
    };
    if solid.cut_outs.is_empty() {
        add(t, last, Zone::Surroundings);
        return;
    }
    for _ in 0..=solid.cut_outs.len() {
        if t + TOUCH >= last {
            return;
        }
        let Some(span) = solid.next_span(ray, t) else {
            add(t, last, Zone::CutOut);
            return;
        };
        add(t, span.entry.t.min(last), Zone::CutOut);
        add(span.entry.t, span.end.min(last), Zone::Surroundings);
        t = span.end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use survey::block::Body;

    #[test]
    fn stretches_alternate_and_end_at_the_stop() {
        let cut_outs = vec![
            Body::of_box([Vec3::new(2.0, 0.0, 0.0), Vec3::new(4.0, 10.0, 10.0)]),
            Body::of_box([Vec3::new(8.0, 0.0, 0.0), Vec3::new(10.0, 10.0, 10.0)]),
        ];
        let solid = Solid::new([Vec3::ZERO, Vec3::splat(10.0)], cut_outs);
        let ray = Ray { origin: Vec3::new(-5.0, 5.0, 5.0), direction: Vec3::X };
        let all = |stop: f32| {
            let mut list = Vec::new();
            stretches(&solid, &ray, [f32::MIN, stop], |s| list.push((s.t[0], s.t[1], s.zone == Zone::CutOut)));
            list
        };
        let whole = [(5.0, 7.0, false), (7.0, 9.0, true), (9.0, 13.0, false), (13.0, 15.0, true)];
        assert_eq!(all(f32::INFINITY), whole);
        assert_eq!(all(9.5), [(5.0, 7.0, false), (7.0, 9.0, true), (9.0, 9.5, false)]);
        assert_eq!(all(4.0), []);
    }
}
