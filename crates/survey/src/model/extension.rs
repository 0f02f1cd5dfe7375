//! Continues gridded data over the whole grid.

/// Fills the NaN nodes of `values`, `[x][y]` of `size`; `false` when there is no data at all.
pub(super) fn extend(size: [usize; 2], values: &mut [f32]) -> bool {
    let mut sums = [0.0f64; 9];
    for (n, &z) in values.iter().enumerate() {
        if z.is_finite() {
            let (x, y, z) = ((n / size[1]) as f64, (n % size[1]) as f64, f64::from(z));
            for (sum, term) in sums.iter_mut().zip([1.0, x, y, x * x, x * y, y * y, z, x * z, y * z]) {
                *sum += term;
            }
        }
    }
    if sums[0] == 0.0 {
        return false;
    }
    let [n, sx, sy, sxx, sxy, syy, sz, sxz, syz] = sums;
    let (mx, my, mz) = (sx / n, sy / n, sz / n);
    let (cxx, cxy, cyy) = (sxx / n - mx * mx + 1e-6, sxy / n - mx * my, syy / n - my * my + 1e-6);
    let (cxz, cyz) = (sxz / n - mx * mz, syz / n - my * mz);
    let det = cxx * cyy - cxy * cxy;
    let (a, b) = ((cxz * cyy - cyz * cxy) / det, (cyz * cxx - cxz * cxy) / det);
    let plane = |n: usize| (mz + a * ((n / size[1]) as f64 - mx) + b * ((n % size[1]) as f64 - my)) as f32;
    for (n, z) in values.iter_mut().enumerate() {
        if !z.is_finite() {
            *z = plane(n);
        }
    }
    true
}
