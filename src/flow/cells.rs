//! The cells of a lattice around several points at once, one point per lane: batches of look-ups use it.

use super::lattice::{FAR, Lattice};
use crate::math::{Lanes, MOST_LANES, Row, Scalar};
use fearless_simd::{Simd, SimdBase, f32x4, f32x8};
use rapier3d::math::Vector;
use std::ops::{Add, Mul, Sub};

/// A [`Lattice`] whose constants are held in every lane.
pub(crate) struct Cells<S: Simd> {
    simd: S,
    axes: [Axis<Lanes<S>>; 3],
    per_spacing: [f32; 3],
    strides: [u32; 2],
    flat: bool,
}

/// One axis of the lattice.
struct Axis<T> {
    origin: T,
    per_spacing: T,
    /// Number of nodes and its inverse, if the axis repeats.
    period: Option<[T; 2]>,
    /// Largest position and largest node below a cell.
    end: T,
    last: T,
}

/// The cells around as many points as there are lanes.
pub(crate) struct Found {
    first: [u32; MOST_LANES],
    weight: [[f32; MOST_LANES]; 3],
}

/// A value and its derivatives along the axes.
pub(crate) struct Jet<V> {
    pub value: V,
    pub dx: V,
    pub dy: V,
    pub dz: V,
}

/// A value and its differences across one plane of a cell.
struct Plane<V> {
    value: V,
    dx: V,
    dy: V,
}

/// What a node holds, as a register of numbers that are interpolated together.
pub(crate) trait Node: Copy {
    /// The register that holds these numbers.
    type Numbers<S: Simd>: Copy
        + Add<Output = Self::Numbers<S>>
        + Sub<Output = Self::Numbers<S>>
        + Mul<f32, Output = Self::Numbers<S>>;
    /// Loads the numbers into the register.
    fn load<S: Simd>(&self, simd: S) -> Self::Numbers<S>;
}

impl Node for Row {
    type Numbers<S: Simd> = f32x4<S>;
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> f32x4<S> {
        f32x4::from_slice(simd, self)
    }
}

/// Two rows that are always needed together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub(crate) struct Pair(pub [Row; 2]);

impl Node for Pair {
    type Numbers<S: Simd> = f32x8<S>;
    #[inline(always)]
    fn load<S: Simd>(&self, simd: S) -> f32x8<S> {
        f32x8::from_slice(simd, self.0.as_flattened())
    }
}

/// The largest whole number that is not larger than x, for |x| ≤ [`FAR`], as `floor` of the lattice.
#[inline(always)]
fn floor<T: Scalar>(x: T) -> T {
    let shift = x.constant(12_582_912.0);
    let near = (x + shift) - shift;
    (near - x.constant(1.0)).select_lt(x, near, near)
}

impl<T: Scalar> Axis<T> {
    /// The node below `x` and the position between it and the next; never out of bounds, whatever x is.
    #[inline(always)]
    fn locate(&self, x: T) -> [T; 2] {
        let (zero, far) = (x.constant(0.0), x.constant(FAR.into()));
        let mut x = (x - self.origin) * self.per_spacing;
        if let Some([nodes, per_node]) = self.period {
            let turns = x * per_node;
            let turns = turns.select_lt(turns.abs(), far, zero);
            x = (turns - floor(turns)) * nodes;
        }
        // A comparison with NaN is false, so that NaN becomes zero.
        let x = x.select_lt(zero, x, zero);
        let x = x.min(self.end);
        let below = floor(x).min(self.last);
        [below, x - below]
    }
}

impl<S: Simd> Cells<S> {
    #[inline(always)]
    pub fn new(simd: S, lattice: &Lattice) -> Self {
        let wide = lattice.lanes();
        let axes = std::array::from_fn(|i| {
            let splat = |value| Lanes::splat(simd, value);
            Axis {
                origin: splat(wide.origin[i]),
                per_spacing: splat(wide.per_spacing[i]),
                period: (wide.periodic[i] > 0.0)
                    .then_some([splat(wide.nodes[i]), splat(wide.per_node[i])]),
                end: splat(wide.end[i]),
                last: splat(wide.last[i]),
            }
        });
        Self {
            simd,
            axes,
            per_spacing: [0, 1, 2].map(|i| wide.per_spacing[i]),
            strides: lattice.strides(),
            flat: lattice.dims[2] == 1,
        }
    }

    /// The cells around points. Their nodes are never out of bounds, and the weights never NaN, whatever
    /// the points are.
    #[inline(always)]
    pub fn locate(&self, [x, y, z]: [Lanes<S>; 3]) -> Found {
        let [i, a] = self.axes[0].locate(x);
        let [j, b] = self.axes[1].locate(y);
        let [k, c] = self.axes[2].locate(z);
        Found {
            first: Lanes::index(self.simd, [i, j, k], self.strides),
            weight: [a.numbers(), b.numbers(), c.numbers()],
        }
    }

    /// Value and gradient in the cell of one lane; beyond a clamped edge the gradient is the edge cell's.
    #[inline(always)]
    pub fn jet<N: Node>(&self, found: &Found, lane: usize, nodes: &[N]) -> Jet<N::Numbers<S>> {
        let [x, y, z] = [
            found.weight[0][lane],
            found.weight[1][lane],
            found.weight[2][lane],
        ];
        let first = found.first[lane] as usize;
        let [row, plane] = self.strides;
        let [dx, dy, dz] = self.per_spacing;
        let low = self.plane(nodes, first, row as usize, x, y);
        if self.flat {
            return Jet {
                value: low.value,
                dx: low.dx * dx,
                dy: low.dy * dy,
                // A product instead of a constant zero: node values are finite.
                dz: low.value * 0.0,
            };
        }
        let high = self.plane(nodes, first + plane as usize, row as usize, x, y);
        let rise = high.value - low.value;
        Jet {
            value: low.value + rise * z,
            dx: (low.dx + (high.dx - low.dx) * z) * dx,
            dy: (low.dy + (high.dy - low.dy) * z) * dy,
            dz: rise * dz,
        }
    }

    /// Value and differences in one plane of a cell.
    #[inline(always)]
    fn plane<N: Node>(
        &self,
        nodes: &[N],
        first: usize,
        row: usize,
        x: f32,
        y: f32,
    ) -> Plane<N::Numbers<S>> {
        let near = &nodes[first..first + 2];
        let far = &nodes[first + row..first + row + 2];
        let (a, b) = (near[0].load(self.simd), near[1].load(self.simd));
        let (c, d) = (far[0].load(self.simd), far[1].load(self.simd));
        let (near_dx, far_dx) = (b - a, d - c);
        let (near, far) = (a + near_dx * x, c + far_dx * x);
        let dy = far - near;
        Plane {
            value: near + dy * y,
            dx: near_dx + (far_dx - near_dx) * y,
            dy,
        }
    }
}

impl<S: Simd> Jet<f32x4<S>> {
    /// Curl of the first three components.
    #[inline(always)]
    pub fn curl(&self) -> Vector {
        let (dx, dy, dz) = (self.dx.as_slice(), self.dy.as_slice(), self.dz.as_slice());
        Vector::new(dy[2] - dz[1], dz[0] - dx[2], dx[1] - dy[0])
    }
}

impl<S: Simd> Jet<f32x8<S>> {
    /// The first four numbers times `a` and the last four times `b`, added up.
    #[inline(always)]
    pub fn mixed(&self, simd: S, [a, b]: [f32; 2]) -> Jet<f32x4<S>> {
        let (v, dx) = (simd.split_f32x8(self.value), simd.split_f32x8(self.dx));
        let (dy, dz) = (simd.split_f32x8(self.dy), simd.split_f32x8(self.dz));
        Jet {
            value: v.0 * a + v.1 * b,
            dx: dx.0 * a + dx.1 * b,
            dy: dy.0 * a + dy.1 * b,
            dz: dz.0 * a + dz.1 * b,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::flow::{Flow, FlowSample, GridFlow};
    use crate::math::NARROW;
    use crate::turbulence::NoiseStream;
    use rapier3d::math::Vector;
    use std::sync::atomic::Ordering;

    /// A grid of noise, flat or not, that repeats along x alone.
    fn noisy(nz: usize) -> GridFlow {
        let noise = NoiseStream::new(1, 0);
        let dims = [7, 5, nz];
        let count = (7 * 5 * nz) as u64;
        let velocities: Vec<_> = (0..count).map(|i| noise.vector(i, 0)).collect();
        let spacing = Vector::new(0.5, 1.0, 0.7);
        GridFlow::new(
            dims,
            [true, false, false],
            -Vector::ONE,
            spacing,
            &velocities,
        )
        .unwrap()
    }

    fn points() -> Vec<Vector> {
        let noise = NoiseStream::new(2, 0);
        (0..61).map(|i| noise.vector(i, 0) * 5.0).collect()
    }

    fn sampled(flow: &dyn Flow, points: &[Vector]) -> Vec<FlowSample> {
        let mut samples = vec![FlowSample::default(); points.len()];
        flow.sample(points, 0.7, &mut samples);
        samples
    }

    /// What is found at a point depends, to the bit, neither on the points beside it nor on the machine's
    /// registers, and it is what the scalar look-up finds up to rounding.
    #[test]
    fn a_point_is_looked_up_alike_alone_and_among_others() {
        let flows: &[Box<dyn Flow>] = &[
            Box::new(noisy(1)),
            Box::new(noisy(4)),
            #[cfg(feature = "bake")]
            Box::new({
                let params = crate::flow::WindParams {
                    nodes: [8, 8, 4],
                    up: Vector::Y,
                    ..Default::default()
                };
                crate::flow::SpectralWind::bake(&params).unwrap()
            }),
        ];
        for flow in flows {
            let points = points();
            let together = sampled(&**flow, &points);
            NARROW.store(true, Ordering::Relaxed);
            let narrow = sampled(&**flow, &points);
            NARROW.store(false, Ordering::Relaxed);
            assert_eq!(together, narrow);
            for (point, sample) in points.iter().zip(&together) {
                assert_eq!(sampled(&**flow, &[*point]), [*sample]);
                let velocity = flow.velocity(*point, 0.7);
                // The tolerance is a few roundings of numbers of about 5.
                assert!((velocity - sample.velocity).length() < 1.0e-5, "{point}");
            }
        }
    }

    /// Points far away, infinite or not a number have a finite flow.
    #[test]
    fn any_point_has_a_flow() {
        let wild = [1.0e30, -1.0e30, f32::MAX, f32::INFINITY, f32::NAN, 1.0e9];
        for nz in [1, 4] {
            let flow = noisy(nz);
            for x in wild {
                for point in [
                    Vector::new(x, 0.3, 0.3),
                    Vector::new(0.3, x, 0.3),
                    Vector::new(0.3, 0.3, -x),
                    Vector::splat(x),
                ] {
                    let sample = sampled(&flow, &[point])[0];
                    assert!((sample.velocity + sample.vorticity).is_finite(), "{point}");
                    assert!(flow.velocity(point, 0.7).is_finite(), "{point}");
                }
            }
        }
    }
}
