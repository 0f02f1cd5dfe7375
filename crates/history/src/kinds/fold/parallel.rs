//! Parallel folding by flexural slip: beds keep their thickness and their length, and with them their area in section.
//!
//! The reference line z = r(x) = z₀ − A f(x) is bent. A bed at the depth z₀ + n before lies at the distance n from it
//! afterwards, measured along its normal, and slides along its neighbours so that it keeps its length:
//!
//! ```text
//! p = C(x) + n N(x)        u = s(x) − n θ(x)
//! C = (x, r(x)),  θ = atan r′,  N = (−sin θ, cos θ),  s = ∫ √(1 + r′²) dx
//! ```
//!
//! since ds_n = (1 − n θ′) ds along the line at distance n. Going back needs the foot of the perpendicular, a monotone
//! solve within the radius of curvature; beds that lie farther away would cross themselves, and the reader refuses them.
//! Above and below the zone of bounded beds rock is folded as similar folds that carry on its outermost lines.

use super::profile::{Jet, Profile};
use crate::solve::root;

/// Metres to which feet and lengths are found.
const TOLERANCE: f64 = 1e-9;
/// Intervals in which a wavelength is divided for its length.
const INTERVALS: usize = 512;

/// The reference line and the zone in which beds stay parallel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bend {
    profile: Profile,
    wavelength: f64,
    amplitude: f64,
    /// n at the top and at the base of the zone.
    zone: [f64; 2],
    /// Length of the line from `from` to the end of each interval.
    lengths: Vec<f64>,
    from: f64,
    step: f64,
    /// Length from `from` to 0.
    to_origin: f64,
    /// Greatest slope of the line.
    steepest: f64,
}

impl Bend {
    /// Of a line with its crest at 0, and the zone as distances below it.
    pub(crate) fn new(profile: Profile, wavelength: f64, amplitude: f64, zone: [f64; 2]) -> Self {
        let (from, reach) =
            if profile.is_periodic() { (0.0, wavelength) } else { (-3.0 * wavelength, 6.0 * wavelength) };
        let step = reach / INTERVALS as f64;
        let mut made = Self {
            profile,
            wavelength,
            amplitude,
            zone,
            lengths: vec![0.0],
            from,
            step,
            to_origin: 0.0,
            steepest: 0.0,
        };
        let mut length = 0.0;
        for n in 0..INTERVALS {
            let start = from + n as f64 * step;
            length += made.piece(start, start + step);
            made.lengths.push(length);
            made.steepest = made.steepest.max(made.line(start).slope.abs());
        }
        made.steepest *= 1.01;
        made.to_origin = made.length_to(0.0);
        made
    }

    /// The smallest radius of curvature of a line, m.
    pub(crate) fn radius(profile: Profile, wavelength: f64, amplitude: f64) -> f64 {
        let curvature = |n: usize| {
            let jet = profile.at(wavelength * (n as f64 / 2048.0 - 0.5), wavelength);
            (amplitude * jet.bend).abs() / (1.0 + (amplitude * jet.slope).powi(2)).powf(1.5)
        };
        1.0 / (0..=2048).map(curvature).fold(1e-12, f64::max)
    }

    /// Depth of the line below its middle, with derivatives.
    fn line(&self, x: f64) -> Jet {
        let jet = self.profile.at(x, self.wavelength);
        let down = -self.amplitude;
        Jet { value: down * jet.value, slope: down * jet.slope, bend: down * jet.bend }
    }

    /// Length of the line between two places at most an interval apart: Gauss's rule with four points.
    fn piece(&self, a: f64, b: f64) -> f64 {
        const NODES: [(f64, f64); 2] =
            [(0.339_981_043_584_856_3, 0.652_145_154_862_546_1), (0.861_136_311_594_052_6, 0.347_854_845_137_453_9)];
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let rate = |x: f64| self.line(x).slope.hypot(1.0);
        half * NODES.iter().map(|(t, w)| w * (rate(middle - half * t) + rate(middle + half * t))).sum::<f64>()
    }

    fn length_to(&self, x: f64) -> f64 {
        let reach = self.step * INTERVALS as f64;
        let (turns, inside) = if self.profile.is_periodic() {
            let turns = ((x - self.from) / reach).floor();
            (turns * self.lengths[INTERVALS], x - turns * reach)
        } else {
            // Beyond its ends the line is straight and level.
            let inside = x.clamp(self.from, self.from + reach);
            (x - inside, inside)
        };
        let n = (((inside - self.from) / self.step) as usize).min(INTERVALS - 1);
        turns + self.lengths[n] + self.piece(self.from + n as f64 * self.step, inside)
    }

    /// Length of the line from 0 to a place.
    fn length(&self, x: f64) -> f64 {
        self.length_to(x) - self.to_origin
    }

    /// A place at the distance n below the line.
    fn off(&self, x: f64, n: f64) -> (f64, f64) {
        let jet = self.line(x);
        let root = jet.slope.hypot(1.0);
        (x - n * jet.slope / root, jet.value + n / root)
    }

    /// u of a place at the distance n below the line.
    fn material(&self, x: f64, n: f64) -> f64 {
        self.length(x) - n * self.line(x).slope.atan()
    }

    /// The foot and the distance below the line of a place within the zone.
    fn foot(&self, u: f64, z: f64) -> Option<(f64, f64)> {
        let above = z - self.line(u).value;
        let reach = self.zone[0].abs().max(self.zone[1].abs());
        if above.abs() > reach * self.steepest.hypot(1.0) {
            return None;
        }
        let towards = |x: f64| {
            let jet = self.line(x);
            (u - x) + (z - jet.value) * jet.slope
        };
        let h = above.abs() + 1e-6;
        let x = root(u - h, u + h, TOLERANCE, towards);
        let jet = self.line(x);
        let n = (z - jet.value - (u - x) * jet.slope) / jet.slope.hypot(1.0);
        let is_foot = towards(x).abs() < 1e-5 * (1.0 + h);
        (is_foot && n >= self.zone[0] && n <= self.zone[1]).then_some((x, n))
    }

    /// Where rock at (u, z below the line's middle) was before.
    pub(crate) fn undo(&self, u: f64, z: f64) -> (f64, f64) {
        if let Some((x, n)) = self.foot(u, z) {
            return (self.material(x, n), n);
        }
        let n = if z > self.line(u).value { self.zone[1] } else { self.zone[0] };
        let most = n.abs() + 1e-6;
        let x = root(u - most, u + most, TOLERANCE, |x| self.off(x, n).0 - u);
        (self.material(x, n), n + z - self.off(x, n).1)
    }

    /// Where rock at (u, n below the line) is afterwards.
    pub(crate) fn apply(&self, u: f64, n: f64) -> (f64, f64) {
        let inside = n.clamp(self.zone[0], self.zone[1]);
        // s(x) lies between x and √(1 + r′²) x.
        let (most, stretch) = (inside.abs() * self.steepest.atan() + 1e-6, self.steepest.hypot(1.0));
        let (low, high) = (u - most, u + most);
        let (low, high) = (low.min(low / stretch), high.max(high / stretch));
        let x = root(low, high, TOLERANCE, |x| self.material(x, inside) - u);
        let (across, depth) = self.off(x, inside);
        (across, depth + n - inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_those_of_a_polygon() {
        let bend = Bend::new(Profile::Sine, 1000.0, 150.0, [-100.0, 100.0]);
        let polygon: f64 = (0..20_000)
            .map(|n| {
                let at = |n: f64| bend.line(0.1 * n - 700.0).value;
                (at(f64::from(n) + 1.0) - at(f64::from(n))).hypot(0.1)
            })
            .sum();
        assert!((bend.length(1300.0) - bend.length(-700.0) - polygon).abs() < 1e-4);
    }

    #[test]
    fn going_back_and_forth_comes_back_in_and_beyond_the_zone() {
        for (profile, amplitude) in [(Profile::Sine, 90.0), (Profile::Monocline, 200.0), (Profile::Chevron(0.8), 80.0)]
        {
            let bend = Bend::new(profile, 1000.0, amplitude, [-150.0, 150.0]);
            assert!(Bend::radius(profile, 1000.0, amplitude) > 150.0);
            for k in 0..2000 {
                let (u, n) = (f64::from(k) * 1.7 - 1500.0, f64::from(k % 83) * 12.0 - 500.0);
                let (x, z) = bend.apply(u, n);
                let (back, depth) = bend.undo(x, z);
                assert!((back - u).abs() < 1e-5 && (depth - n).abs() < 1e-5, "{profile:?} {u} {n}: {back} {depth}");
            }
        }
    }

    #[test]
    fn area_is_kept_within_the_zone() {
        let bend = Bend::new(Profile::Sine, 1000.0, 90.0, [-150.0, 150.0]);
        for k in 0..500 {
            let (u, n, h) = (f64::from(k) * 3.1, f64::from(k % 29) * 10.0 - 140.0, 1e-3);
            let at = |du: f64, dn: f64| bend.apply(u + du, n + dn);
            let [(a, b), (c, d), (e, f), (g, i)] = [at(h, 0.0), at(-h, 0.0), at(0.0, h), at(0.0, -h)];
            let area = ((a - c) * (f - i) - (b - d) * (e - g)) / (4.0 * h * h);
            assert!((area - 1.0).abs() < 1e-4, "{area}");
        }
    }
}
