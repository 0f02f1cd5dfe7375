//! Values on a grid continued into its gaps as smoothly as a membrane, from coarse to fine.

/// Sweeps on each level: what the coarser level gave is smooth already.
const SWEEPS: usize = 40;
/// By how much more than to the mean of its neighbours a node is moved in each.
const OVER: f64 = 1.7;

/// Fills what is NaN on a grid `[u][v]` between and beyond what is known, which stays; `false` when nothing is known.
///
/// From coarse to fine: the means of what is known in 2 × 2 nodes are filled first, and give the start for relaxing
/// each unknown node towards the mean of its neighbours.
pub(crate) fn fill([nu, nv]: [usize; 2], values: &mut [f64]) -> bool {
    let known: Vec<bool> = values.iter().map(|value| value.is_finite()).collect();
    if !known.contains(&true) {
        return false;
    }
    if known.iter().all(|known| *known) {
        return true;
    }
    let [cu, cv] = [nu.div_ceil(2), nv.div_ceil(2)];
    if [cu, cv] != [nu, nv] {
        let (mut sum, mut count) = (vec![0.0; cu * cv], vec![0u32; cu * cv]);
        for n in (0..values.len()).filter(|&n| known[n]) {
            let c = (n / nv / 2) * cv + n % nv / 2;
            sum[c] += values[n];
            count[c] += 1;
        }
        let mut coarse: Vec<f64> =
            sum.iter().zip(&count).map(|(sum, n)| if *n > 0 { sum / f64::from(*n) } else { f64::NAN }).collect();
        fill([cu, cv], &mut coarse);
        for n in (0..values.len()).filter(|&n| !known[n]) {
            values[n] = between([cu, cv], &coarse, [(n / nv) as f64 / 2.0 - 0.25, (n % nv) as f64 / 2.0 - 0.25]);
        }
    }
    for _ in 0..SWEEPS {
        for n in (0..values.len()).filter(|&n| !known[n]) {
            let (u, v) = (n / nv, n % nv);
            let beside =
                [(u > 0, n.wrapping_sub(nv)), (u + 1 < nu, n + nv), (v > 0, n.wrapping_sub(1)), (v + 1 < nv, n + 1)];
            let (sum, count) = beside
                .iter()
                .filter(|(inside, _)| *inside)
                .fold((0.0, 0.0), |(s, c), (_, m)| (s + values[*m], c + 1.0));
            if count > 0.0 {
                values[n] += OVER * (sum / count - values[n]);
            }
        }
    }
    true
}

/// Bilinear between nodes, constant beyond them.
fn between([nu, nv]: [usize; 2], values: &[f64], [u, v]: [f64; 2]) -> f64 {
    let (u, v) = (u.clamp(0.0, (nu - 1) as f64), v.clamp(0.0, (nv - 1) as f64));
    let (u0, v0) = (u.floor() as usize, v.floor() as usize);
    let (u1, v1) = ((u0 + 1).min(nu - 1), (v0 + 1).min(nv - 1));
    let (fu, fv) = (u - u0 as f64, v - v0 as f64);
    let row = |u: usize| values[u * nv + v0] * (1.0 - fv) + values[u * nv + v1] * fv;
    row(u0) * (1.0 - fu) + row(u1) * fu
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_between_two_sides_is_straight_and_a_constant_stays() {
        let size = [33, 17];
        let mut values = vec![f64::NAN; 33 * 17];
        for v in 0..17 {
            values[v] = 2.0;
            values[32 * 17 + v] = 10.0;
        }
        assert!(fill(size, &mut values));
        for (n, value) in values.iter().enumerate() {
            let straight = 2.0 + 8.0 * (n / 17) as f64 / 32.0;
            assert!((value - straight).abs() < 0.15, "{n}: {value} {straight}");
        }
        let mut one = vec![f64::NAN; 20];
        one[7] = 3.0;
        assert!(fill([4, 5], &mut one));
        assert!(one.iter().all(|value| (value - 3.0).abs() < 1e-9));
        assert!(!fill([2, 2], &mut [f64::NAN; 4]));
    }
}
