//! Carlson's symmetric elliptic integrals (B. C. Carlson, *Numerical computation of real or complex
//! elliptic integrals*, Numer. Algorithms 10 (1995)): duplication until the arguments agree, then a
//! Taylor series. Accurate to rounding for non-negative arguments whose products are within f64's range, and
//! NaN for others.

/// Each duplication brings the arguments four times closer to each other; of f64's 2098 binary orders the
/// farthest apart need half as many. What has not agreed by then is NaN or infinite.
const MOST_DUPLICATIONS: u32 = 1100;

/// `R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z))`; at most one argument may be zero.
pub(crate) fn rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    for _ in 0..MOST_DUPLICATIONS {
        let mean = (x + y + z) / 3.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 2e-3 {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
            return series / mean.sqrt();
        }
        let (sx, sy, sz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = sx * sy + sy * sz + sz * sx;
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
    f64::NAN
}

/// `R_D(x, y, z) = 3/2 ∫₀^∞ dt / √((t+x)(t+y)(t+z)³)`; `z > 0` and at most one of `x`, `y` zero.
pub(crate) fn rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut weight) = (0.0, 1.0);
    for _ in 0..MOST_DUPLICATIONS {
        let mean = (x + y + 3.0 * z) / 5.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) < 1e-3 {
            let (xy, zz) = (dx * dy, dz * dz);
            let e2 = xy - 6.0 * zz;
            let e3 = (3.0 * xy - 8.0 * zz) * dz;
            let e4 = 3.0 * (xy - zz) * zz;
            let e5 = xy * zz * dz;
            let series = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0
                - 3.0 * e4 / 22.0
                - 9.0 * e2 * e3 / 52.0
                + 3.0 * e5 / 26.0;
            return 3.0 * sum + weight * series / (mean * mean.sqrt());
        }
        let (sx, sy, sz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = sx * sy + sy * sz + sz * sx;
        sum += weight / (sz * (z + lambda));
        weight /= 4.0;
        (x, y, z) = ((x + lambda) / 4.0, (y + lambda) / 4.0, (z + lambda) / 4.0);
    }
    f64::NAN
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Reference values printed in Carlson's paper.
    #[test]
    fn published_values() {
        assert_relative_eq!(
            rf(1.0, 2.0, 0.0),
            1.311_028_777_146_06,
            max_relative = 1e-13
        );
        assert_relative_eq!(
            rf(2.0, 3.0, 4.0),
            0.584_082_841_677_150,
            max_relative = 1e-13
        );
        assert_relative_eq!(
            rd(0.0, 2.0, 1.0),
            1.797_210_352_103_39,
            max_relative = 1e-13
        );
        assert_relative_eq!(
            rd(2.0, 3.0, 4.0),
            0.165_105_272_942_61,
            max_relative = 1e-12
        );
    }
}
