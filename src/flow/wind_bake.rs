//! Synthesis of the gust field: random Fourier modes of a prescribed spectrum.
//!
//! One complex inverse transform per velocity component gives two independent real fields at once,
//! its real and its imaginary part, with no Hermitian bookkeeping. Variances are computed in f64; the
//! transform itself runs in f32, the precision of the stored field, in half the time of f64.

use super::SpectralWind;
use super::cells::Pair;
use super::wind_params::{Component, Spectrum, WindParams, check, components};
use crate::error::Error;
use crate::math;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rapier3d::math::Real;
use rayon::prelude::*;
use rustfft::{FftPlanner, num_complex::Complex32};

impl SpectralWind {
    /// Synthesizes the gusts. The result depends on `params` only, not on the number of threads.
    ///
    /// ```
    /// use rapier3d_immersed::flow::{Flow, SpectralWind, Spectrum, WindParams};
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let spectrum = Spectrum::Given { deviation: [0.8, 0.6, 0.4], length_scale: 20.0 };
    /// let params = WindParams { nodes: [32, 32, 8], spectrum, seed: 7, ..Default::default() };
    /// let wind = SpectralWind::bake(&params)?;
    /// // The gusts have the energy that was asked for, and blow about the mean wind.
    /// let energy: f32 = wind.fluctuations().map(|u| u.length_squared()).sum();
    /// let asked = 0.8_f32.powi(2) + 0.6_f32.powi(2) + 0.4_f32.powi(2);
    /// assert!((energy / (32.0 * 32.0 * 8.0) / asked - 1.0).abs() < 1e-3);
    /// assert!((wind.velocity(Vector::Y * 10.0, 2.0).x - 4.0).abs() < 4.0);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// If a parameter is not finite or out of range: sizes, heights, spacing and evolution time
    /// positive, the reference height above the roughness, deviations not negative, at least 4 nodes
    /// (or exactly 1) along each axis.
    pub fn bake(params: &WindParams) -> Result<Self, Error> {
        let lattice = check(params)?;
        let modes = Modes::new(params);
        let fields = modes.fields(params);
        let nodes = modes.assemble(params, fields);
        let evolution = params.evolution_time.unwrap_or(f64::INFINITY);
        Self::assemble(
            params.direction,
            params.up,
            params.mean_speed,
            params.reference_height as Real,
            params.roughness as Real,
            params.ground as Real,
            evolution,
            params.height_law,
            lattice,
            &nodes,
        )
    }
}

/// Signed wavenumber index of bin `m` of `n`; zero for the Nyquist bin, whose sign is undefined.
fn signed(m: usize, n: usize) -> f64 {
    if 2 * m == n {
        0.0
    } else if 2 * m < n {
        m as f64
    } else {
        m as f64 - n as f64
    }
}

/// Number of a mode's mirror images, for all of which the octant's mode stands.
fn images(index: [usize; 3]) -> f64 {
    (0..3).filter(|i| index[*i] > 0).map(|_| 2.0).product()
}

/// The variances of the modes.
struct Modes {
    dims: [usize; 3],
    /// Cycles per meter of the lowest mode.
    step: [f64; 3],
    /// Standard deviation of each component's mode, by |index| along x, y, z (z fastest).
    deviation: Vec<[f64; 3]>,
    octant: [usize; 3],
    /// Stretching of wavenumbers that reconciles divergence with unequal components.
    stretch: [f64; 3],
    /// Variance that each component is to have.
    target: [f64; 3],
}

impl Modes {
    fn new(params: &WindParams) -> Self {
        let dims = params.nodes;
        let step: [f64; 3] = core::array::from_fn(|i| params.size[i].recip());
        let octant = dims.map(|n| n / 2 + 1);
        let space = dims.iter().filter(|n| **n > 1).count();
        // What a density (corner² + κ²)^(−(5/3 + space − 1)/2) leaves of itself along one line.
        let line = [1.0, 1.0, 2.240_5, 1.2 * core::f64::consts::PI][space];
        let exponent = -(5.0 / 3.0 + space as f64 - 1.0) / 4.0;
        let volume: f64 = (0..3).filter(|i| dims[*i] > 1).map(|i| step[i]).product();
        let spectra = components(params);

        let deviations = |spectra: [Component; 3]| -> Vec<[f64; 3]> {
            let scale = spectra.map(|c| (0.5 * c.level / line * volume).sqrt());
            let equal = spectra.windows(2).all(|c| c[0].corner == c[1].corner);
            (0..octant[0] * octant[1])
                .into_par_iter()
                .flat_map_iter(|row| {
                    let (x, y) = (row / octant[1], row % octant[1]);
                    (0..octant[2]).map(move |z| {
                        let index = [x, y, z];
                        let nyquist = (0..3).any(|i| dims[i] > 1 && 2 * index[i] == dims[i]);
                        if nyquist || index == [0; 3] {
                            return [0.0; 3];
                        }
                        let k2: f64 = (0..3).map(|i| (index[i] as f64 * step[i]).powi(2)).sum();
                        let shape = |c: Component| math::powf(c.corner * c.corner + k2, exponent);
                        if equal {
                            let shape = shape(spectra[0]);
                            scale.map(|scale| scale * shape)
                        } else {
                            core::array::from_fn(|i| scale[i] * shape(spectra[i]))
                        }
                    })
                })
                .collect()
        };
        let mut modes = Self {
            dims,
            step,
            deviation: deviations(spectra),
            octant,
            stretch: [1.0; 3],
            target: [0.0; 3],
        };
        modes.target = match params.spectrum {
            Spectrum::Given { deviation, .. } => deviation.map(|deviation| deviation * deviation),
            _ => modes.resolved(),
        };
        if params.divergence_free {
            if params.spectrum == Spectrum::Kaimal {
                modes.deviation = deviations([spectra[0]; 3]);
            } else if params.spectrum == Spectrum::Thesis {
                modes.deviation.iter_mut().for_each(|d| *d = [d[0]; 3]);
            }
            modes.stretch = modes.balance();
        }
        modes
    }

    /// The sum of the modes' variances.
    fn resolved(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (number, deviation) in self.deviation.iter().enumerate() {
            let images = images(self.index(number));
            for i in 0..3 {
                sum[i] += deviation[i].powi(2) * images;
            }
        }
        sum
    }

    /// Stretch s such that s_i² Σ W (1 − k'_i²/k'²), k' = s∘k, has the targets' ratios: a field that
    /// is perpendicular to k' before and multiplied by s after is perpendicular to k. The lowest
    /// modes, which hold nearly all variance, decide.
    fn balance(&self) -> [f64; 3] {
        let reach = 12.min(self.octant.into_iter().max().unwrap_or(1));
        let lowest: Vec<([f64; 3], f64)> = (0..self.deviation.len())
            .map(|number| (self.index(number), self.deviation[number][0]))
            .filter(|(index, _)| index.iter().all(|i| *i < reach))
            .map(|(index, deviation)| {
                let k2 = core::array::from_fn(|i| (index[i] as f64 * self.step[i]).powi(2));
                (k2, deviation.powi(2) * images(index))
            })
            .collect();
        let mut stretch = self.target.map(|target| target.sqrt());
        for _ in 0..24 {
            let squared = stretch.map(|s| s * s);
            let mut variance = [0.0; 3];
            for (k2, weight) in &lowest {
                let k2: [f64; 3] = core::array::from_fn(|i| k2[i] * squared[i]);
                let sum = k2[0] + k2[1] + k2[2];
                let per = if sum > 0.0 { 1.0 / sum } else { 0.0 };
                for i in 0..3 {
                    variance[i] += weight * squared[i] * (1.0 - k2[i] * per);
                }
            }
            for i in 0..3 {
                if variance[i] > 0.0 {
                    stretch[i] *= math::powf(self.target[i] / variance[i], 0.4);
                }
            }
        }
        stretch
    }

    /// Where a mode is in the octant.
    fn index(&self, number: usize) -> [usize; 3] {
        let [_, ny, nz] = self.octant;
        [number / (ny * nz), number / nz % ny, number % nz]
    }

    /// The three complex fields in the order (y, z, x), x fastest.
    fn fields(&self, params: &WindParams) -> Vec<Vec<Complex32>> {
        let [nx, ny, nz] = self.dims;
        let count = nx * ny * nz;
        let mut fields = vec![vec![Complex32::default(); count]; 3];
        let [a, b, c] = &mut fields[..] else {
            unreachable!("three components")
        };
        // Modes are in the order (x, y, z), z fastest; with one random stream per plane the result does not
        // depend on the threads.
        let plane = ny * nz;
        let stretch = self.stretch.map(|s| s as f32);
        let step: [f64; 3] = core::array::from_fn(|i| self.step[i] * self.stretch[i]);
        a.par_chunks_mut(plane)
            .zip(b.par_chunks_mut(plane))
            .zip(c.par_chunks_mut(plane))
            .enumerate()
            .for_each(|(x, ((a, b), c))| {
                let mut random = Pcg64Mcg::seed_from_u64(
                    params.seed ^ (x as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15),
                );
                let mut normal = || -> f32 { StandardNormal.sample(&mut random) };
                let kx = signed(x, nx) * step[0];
                for y in 0..ny {
                    let base = (x.min(nx - x) * self.octant[1] + y.min(ny - y)) * self.octant[2];
                    let ky = signed(y, ny) * step[1];
                    for z in 0..nz {
                        let deviation = self.deviation[base + z.min(nz - z)];
                        let mut mode = deviation
                            .map(|deviation| Complex32::new(normal(), normal()) * deviation as f32);
                        if params.divergence_free {
                            let k = [kx, ky, signed(z, nz) * step[2]];
                            let k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
                            if k2 > 0.0 {
                                // The modes are f32: k is normalized before, so that nothing underflows.
                                let per = k2.sqrt().recip();
                                let k = k.map(|k| (k * per) as f32);
                                let along = mode[0] * k[0] + mode[1] * k[1] + mode[2] * k[2];
                                for (mode, k) in mode.iter_mut().zip(k) {
                                    *mode -= along * k;
                                }
                            }
                            for (mode, stretch) in mode.iter_mut().zip(stretch) {
                                *mode *= stretch;
                            }
                        }
                        [a[y * nz + z], b[y * nz + z], c[y * nz + z]] = mode;
                    }
                }
            });
        let mut planner = FftPlanner::new();
        let plans = self.dims.map(|n| planner.plan_fft_inverse(n));
        let mut spare = vec![Complex32::default(); count];
        for field in &mut fields {
            // Each turn (x, y, z) → (z, x, y) → (y, z, x) makes the fastest axis the slowest.
            for (step, axis) in [2, 1, 0].into_iter().enumerate() {
                if step > 0 {
                    transpose(field, &mut spare, self.dims[axis + 1]);
                    core::mem::swap(field, &mut spare);
                }
                let n = self.dims[axis];
                if n > 1 {
                    let rows = n * (count / n).div_ceil(16 * rayon::current_num_threads());
                    field
                        .par_chunks_mut(rows)
                        .for_each(|rows| plans[axis].process(rows));
                }
            }
        }
        fields
    }

    /// Scales the fields to their variances and makes each pair uncorrelated, so that every mixture
    /// of the two has that variance too.
    fn rescale(&self, params: &WindParams, fields: &mut [Vec<Complex32>]) {
        let count = self.dims.iter().product::<usize>() as f64;
        // These are ⟨a²⟩, ⟨ab⟩ and ⟨b²⟩, summed in a fixed order.
        let moments: Vec<[f64; 3]> = fields
            .par_iter()
            .map(|field| {
                field.iter().fold([0.0; 3], |sum: [f64; 3], c| {
                    let (a, b) = (f64::from(c.re), f64::from(c.im));
                    [sum[0] + a * a, sum[1] + a * b, sum[2] + b * b]
                })
            })
            .map(|sum| sum.map(|sum| sum / count))
            .collect();
        let total = (0..3)
            .map(|m| moments.iter().map(|sum| sum[m]).sum())
            .collect::<Vec<f64>>();
        for i in 0..3 {
            // Only a common factor keeps the field free of divergence.
            let ([aa, ab, bb], target) = if params.divergence_free {
                ([total[0], total[1], total[2]], self.target.iter().sum())
            } else {
                (moments[i], self.target[i])
            };
            let mixed = if aa > 0.0 { ab / aa } else { 0.0 };
            let scale = |variance: f64| {
                if variance > 0.0 {
                    (target / variance).sqrt()
                } else {
                    0.0
                }
            };
            let (a, b) = (scale(aa) as f32, scale(bb - mixed * ab) as f32);
            let mixed = mixed as f32;
            fields[i]
                .par_iter_mut()
                .with_min_len(4096)
                .for_each(|c| *c = Complex32::new(c.re * a, (c.im - mixed * c.re) * b));
        }
    }

    /// Scales the fields where the spectrum says so, and interleaves them into nodes.
    fn assemble(&self, params: &WindParams, mut fields: Vec<Vec<Complex32>>) -> Vec<Pair> {
        let [nx, ny, nz] = self.dims;
        if let Spectrum::Given { .. } = params.spectrum {
            self.rescale(params, &mut fields);
        }
        let mut nodes = vec![Pair::default(); nx * ny * nz];
        nodes
            .par_chunks_mut(nx)
            .enumerate()
            .for_each(|(row, nodes)| {
                let (z, y) = (row / ny, row % ny);
                let from = (y * nz + z) * nx;
                for (x, node) in nodes.iter_mut().enumerate() {
                    let [u, v, w] = [0, 1, 2].map(|i: usize| fields[i][from + x]);
                    *node = Pair([[u.re, v.re, w.re, 0.0], [u.im, v.im, w.im, 0.0]]);
                }
            });
        nodes
    }
}

/// Transposes a matrix of rows of length `columns`, in strips that fit the cache.
fn transpose(from: &[Complex32], to: &mut [Complex32], columns: usize) {
    const STRIP: usize = 8;
    let rows = from.len() / columns;
    to.par_chunks_mut(rows * STRIP)
        .enumerate()
        .for_each(|(strip, to)| {
            let first = strip * STRIP;
            let width = STRIP.min(columns - first);
            for row in 0..rows {
                let line = &from[row * columns + first..][..width];
                for (column, value) in line.iter().enumerate() {
                    to[column * rows + row] = *value;
                }
            }
        });
}
