//! Networks of faults that cross, splay and die out.

use survey::Volume;

/// A fault of a network: an ellipse on a plane with the greatest throw in its middle.
pub(crate) struct Drawn {
    middle: [f64; 3],
    angle: f64,
    pub(crate) run: f64,
    throw: f64,
    half: [f64; 2],
    /// The fault on whose other side it is not.
    pub(crate) splays_from: Option<usize>,
}

impl Drawn {
    /// Along strike, and across it from the plane.
    pub(crate) fn place(&self, p: [f64; 3]) -> [f64; 2] {
        let (dx, dy) = (p[0] - self.middle[0], p[1] - self.middle[1]);
        let (c, s) = (self.angle.cos(), self.angle.sin());
        [dx * c + dy * s, -dx * s + dy * c - self.run * (p[2] - self.middle[2])]
    }

    /// Throw next to it, samples.
    pub(crate) fn throw(&self, u: f64, z: f64) -> f64 {
        let r = (u / self.half[0]).powi(2) + ((z - self.middle[2]) / self.half[1]).powi(2);
        if r < 1.0 { self.throw * (1.0 - r).sqrt() } else { 0.0 }
    }
}

struct Random(u64);

impl Random {
    /// In [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as f64) / f64::from(1u32 << 31)
    }
    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// A place before fault `k` moved it.
pub(crate) fn undone(faults: &[Drawn], k: usize, mut p: [f64; 3]) -> [f64; 3] {
    let fault = &faults[k];
    let [u, off] = fault.place(p);
    let behind = fault.splays_from.is_some_and(|m| faults[m].place(p)[1] * faults[m].run < 0.0);
    if off * fault.run > 0.0 && !behind {
        p[2] -= fault.throw(u, p[2]) * fault.run.signum() * (-(off / 45.0).powi(2)).exp();
    }
    p
}

/// A network of faults that cross, splay and die out, on gently folded beds 12 samples apart.
pub(crate) fn network(size: usize, seed: u64, snr: f64) -> (Volume<f32>, Vec<Drawn>) {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x1234_5678);
    (0..10).for_each(|_| _ = random.next());
    let n = size as f64;
    let main = random.between(0.0, std::f64::consts::PI);
    let mut faults: Vec<Drawn> = Vec::new();
    for k in 0..5 {
        let angle = main + random.between(-0.25, 0.25) + if k == 4 { 1.2 } else { 0.0 };
        let sign = if random.next() < 0.5 { -1.0 } else { 1.0 };
        faults.push(Drawn {
            middle: [random.between(0.2, 0.8) * n, random.between(0.2, 0.8) * n, random.between(0.35, 0.65) * n],
            angle,
            run: sign * random.between(0.15, 0.38),
            throw: sign * [5.0, 7.0, 10.0, 14.0, 8.0][k],
            half: [random.between(0.35, 0.9) * n, random.between(0.4, 0.9) * n],
            splays_from: None,
        });
    }
    let (m, run) = (faults[3].middle, faults[3].run);
    faults.push(Drawn {
        middle: [m[0] + 6.0 * run.signum(), m[1], m[2]],
        angle: faults[3].angle + 0.5,
        run,
        throw: 7.0 * run.signum(),
        half: [0.4 * n, 0.5 * n],
        splays_from: Some(3),
    });
    let mut reflectors = Vec::new();
    let mut z = -60.0;
    while z < n + 60.0 {
        z += random.between(8.0, 16.0);
        reflectors.push((z, random.between(0.4, 1.0) * if reflectors.len() % 2 == 0 { 1.0 } else { -1.0 }));
    }
    let [a, b, c] = [random.between(4.0, 8.0), random.between(0.0, 6.0), random.between(-0.25, 0.25)];
    let ricker = |t: f64| {
        let q = (std::f64::consts::PI * t / 8.0).powi(2);
        (1.0 - 2.0 * q) * (-q).exp()
    };
    let mut volume = Volume::filled([size; 3], 0.0f32);
    let mut energy = 0.0;
    for x in 0..size {
        for y in 0..size {
            let values: Vec<f32> = (0..size)
                .map(|z| {
                    let mut p = [x as f64, y as f64, z as f64];
                    for k in (0..faults.len()).rev() {
                        p = undone(&faults, k, p);
                    }
                    let t = p[2] - a * (std::f64::consts::TAU * p[0] / n / 1.3 + b).sin() - c * p[1];
                    reflectors.iter().filter(|(z, _)| (z - t).abs() < 12.0).map(|(z, r)| r * ricker(z - t)).sum::<f64>()
                        as f32
                })
                .collect();
            energy += values.iter().map(|v| f64::from(v * v)).sum::<f64>();
            volume.trace_mut(x, y).copy_from_slice(&values);
        }
    }
    let level = (energy / n.powi(3)).sqrt() / snr;
    // White noise through the wavelet, smoothed over a trace and its neighbours as the noise of surveys is.
    let kernel: Vec<f64> = (-12..=12).map(|k| ricker(f64::from(k))).collect();
    let norm = kernel.iter().map(|k| k * k).sum::<f64>().sqrt();
    for x in 0..size {
        for y in 0..size {
            let white: Vec<f64> =
                (0..size + 24).map(|_| (0..4).map(|_| random.between(-1.0, 1.0)).sum::<f64>() * 0.866).collect();
            for (z, value) in volume.trace_mut(x, y).iter_mut().enumerate() {
                let filtered: f64 = kernel.iter().zip(&white[z..]).map(|(k, w)| k * w).sum();
                *value += (level * filtered / norm) as f32;
            }
        }
    }
    (volume, faults)
}
