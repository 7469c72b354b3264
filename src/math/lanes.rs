//! Bodies side by side: as many as the machine's registers hold, eight with AVX2, else four.

use super::scalar::{Binary32, MANTISSA, ONE, ROOT_HALF, Scalar, WHOLE, exponential, logarithm};
use fearless_simd::{ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdMask, f32x4};
use rapier3d::math::Vector;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// No machine has more lanes than this.
pub(crate) const MOST_LANES: usize = 8;

/// One f32 per lane, with the proof `S` that the machine has the instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes<S: Simd>(S::f32s);

/// Four numbers that lanes are filled with at once: a vector and a zero, or a quaternion (x, y, z, w).
pub(crate) type Row = [f32; 4];

/// A vector as a row.
#[inline(always)]
pub(crate) fn row(v: Vector) -> Row {
    [v.x, v.y, v.z, 0.0]
}

/// The vector of a row.
#[inline(always)]
pub(crate) fn vector([x, y, z, _]: Row) -> Vector {
    Vector::new(x, y, z)
}

/// Work that is done in lanes.
pub(crate) trait OnLanes {
    /// Does the work. It has to be inlined, and so has all that it calls: only then may it use the
    /// instructions.
    fn run<S: Simd>(self, simd: S);
}

/// While this is true, [`dispatch`] takes the narrow registers.
#[cfg(test)]
pub(crate) static NARROW: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(false);

/// Runs `task` with the widest registers of this machine.
pub(crate) fn dispatch(task: impl OnLanes) {
    #[cfg(test)]
    if NARROW.load(std::sync::atomic::Ordering::Relaxed) {
        return dispatch_narrow(task);
    }
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(simd) = fearless_simd::Level::new().as_avx2() {
        return simd.vectorize(
            #[inline(always)]
            || task.run(simd),
        );
    }
    dispatch_narrow(task);
}

/// Runs `task` with registers of four lanes.
pub(crate) fn dispatch_narrow(task: impl OnLanes) {
    if let Some(simd) = four_lanes() {
        task.run(simd);
    }
}

/// Four lanes are part of the targets that have them, so that nothing is to be detected: never `None`.
#[cfg(all(
    any(target_arch = "x86", target_arch = "x86_64"),
    target_feature = "sse2",
    target_feature = "fxsr"
))]
fn four_lanes() -> Option<impl Simd> {
    fearless_simd::Level::new().as_sse2()
}

#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
fn four_lanes() -> Option<impl Simd> {
    fearless_simd::Level::new().as_neon()
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
fn four_lanes() -> Option<impl Simd> {
    fearless_simd::Level::new().as_wasm_simd128()
}

/// Other targets have no such instructions; the compiler emulates four lanes.
#[cfg(not(any(
    all(
        any(target_arch = "x86", target_arch = "x86_64"),
        target_feature = "sse2",
        target_feature = "fxsr"
    ),
    all(target_arch = "aarch64", target_feature = "neon"),
    all(target_arch = "wasm32", target_feature = "simd128")
)))]
fn four_lanes() -> Option<impl Simd> {
    Some(fearless_simd::Fallback::new())
}

impl<S: Simd> Lanes<S> {
    /// Number of lanes.
    pub const COUNT: usize = {
        assert!(S::f32s::LEN == 4 || S::f32s::LEN == MOST_LANES);
        S::f32s::LEN
    };

    #[inline(always)]
    pub fn splat(simd: S, value: f32) -> Self {
        Self(S::f32s::splat(simd, value))
    }

    #[inline(always)]
    pub fn from_fn(simd: S, lane: impl FnMut(usize) -> f32) -> Self {
        Self(S::f32s::from_fn(simd, lane))
    }

    /// The largest of the lanes, NaN aside, but not less than `least`.
    #[inline(always)]
    pub fn largest(self, least: f32) -> f32 {
        self.0.as_slice().iter().copied().fold(least, f32::max)
    }

    /// The lanes' numbers; of those beyond [`COUNT`](Self::COUNT), zero.
    #[inline(always)]
    pub fn numbers(self) -> [f32; MOST_LANES] {
        let mut numbers = [0.0; MOST_LANES];
        numbers[..Self::COUNT].copy_from_slice(self.0.as_slice());
        numbers
    }

    /// i + row·j + plane·k of whole numbers ≥ 0, which must be less than 2³¹; zero beyond
    /// [`COUNT`](Self::COUNT).
    #[inline(always)]
    pub fn index(simd: S, [i, j, k]: [Self; 3], [row, plane]: [u32; 2]) -> [u32; MOST_LANES] {
        let row = S::i32s::splat(simd, row as i32);
        let plane = S::i32s::splat(simd, plane as i32);
        let sum = i.0.to_int::<S::i32s>()
            + j.0.to_int::<S::i32s>() * row
            + k.0.to_int::<S::i32s>() * plane;
        let mut index = [0; MOST_LANES];
        for (index, sum) in index.iter_mut().zip(sum.as_slice()) {
            *index = *sum as u32;
        }
        index
    }

    /// Rows side by side: their first numbers, their second ones …
    #[inline(always)]
    pub fn side_by_side(simd: S, row: impl Fn(usize) -> Row) -> [Self; 4] {
        let load = |lane| f32x4::load_array(simd, row(lane));
        let [x, y, z, w] = transposed([load(0), load(1), load(2), load(3)]);
        if Self::COUNT == 4 {
            let one = |v: f32x4<S>| Self(S::f32s::from_slice(simd, v.as_slice()));
            return [one(x), one(y), one(z), one(w)];
        }
        let [i, j, k, l] = transposed([load(4), load(5), load(6), load(7)]);
        let both = |v, w| {
            Self(S::f32s::from_slice(
                simd,
                simd.combine_f32x4(v, w).as_slice(),
            ))
        };
        [both(x, i), both(y, j), both(z, k), both(w, l)]
    }

    /// Vectors side by side, of which there may be fewer than lanes but not none: the last is repeated.
    #[inline(always)]
    pub fn points(simd: S, points: &[Vector]) -> [Self; 4] {
        Self::side_by_side(simd, |lane| {
            let [x, y, z] = points[lane.min(points.len() - 1)].to_array();
            [x, y, z, 0.0]
        })
    }

    /// Gives each lane's number and row to `store`: [`side_by_side`](Self::side_by_side) undone.
    #[inline(always)]
    pub fn apart([x, y, z, w]: [Self; 4], mut store: impl FnMut(usize, Row)) {
        let simd = x.0.token();
        let four = |v: &Self, from| f32x4::from_slice(simd, &v.0.as_slice()[from..from + 4]);
        for from in (0..Self::COUNT).step_by(4) {
            let columns = [
                four(&x, from),
                four(&y, from),
                four(&z, from),
                four(&w, from),
            ];
            let [a, b, c, d] = transposed(columns);
            store(from, a.to_array());
            store(from + 1, b.to_array());
            store(from + 2, c.to_array());
            store(from + 3, d.to_array());
        }
    }
}

#[inline(always)]
fn transposed<S: Simd>([a, b, c, d]: [f32x4<S>; 4]) -> [f32x4<S>; 4] {
    let (ac, bd) = (a.interleave(c), b.interleave(d));
    let (xy, zw) = (ac.0.interleave(bd.0), ac.1.interleave(bd.1));
    [xy.0, xy.1, zw.0, zw.1]
}

impl<S: Simd> PartialEq for Lanes<S> {
    fn eq(&self, other: &Self) -> bool {
        self.0.as_slice() == other.0.as_slice()
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// Defines an operator that acts lane by lane.
macro_rules! operator {
    ($trait:ident $name:ident, $assign_trait:ident $assign:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(other.0))
            }
        }

        impl<S: Simd> $assign_trait for Lanes<S> {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                self.0 = self.0.$name(other.0);
            }
        }
    };
}
operator!(Add add, AddAssign add_assign);
operator!(Sub sub, SubAssign sub_assign);
operator!(Mul mul, MulAssign mul_assign);
operator!(Div div, DivAssign div_assign);

impl<S: Simd> Scalar for Lanes<S> {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.0.token(), value as f32)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        exponential(self)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        logarithm(self)
    }
    #[inline(always)]
    fn all_ge(self, limit: f64) -> bool {
        self.0.simd_ge(self.constant(limit).0).all_true()
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }
    #[inline(always)]
    fn select_lt(self, a: Self, b: Self, other: Self) -> Self {
        Self(a.0.simd_lt(b.0).select(self.0, other.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        Self(self.0.ceil())
    }
    #[inline(always)]
    fn by_lane<const I: usize, const O: usize>(
        inputs: [Self; I],
        mut of: impl FnMut([f64; I]) -> [f64; O],
    ) -> [Self; O] {
        let numbers = inputs.map(Self::numbers);
        let mut found = [[0.0; MOST_LANES]; O];
        for lane in 0..Self::COUNT {
            let of_lane = of(std::array::from_fn(|i| f64::from(numbers[i][lane])));
            for (row, x) in found.iter_mut().zip(of_lane) {
                row[lane] = x as f32;
            }
        }
        let simd = inputs[0].0.token();
        found.map(|row| Self::from_fn(simd, |lane| row[lane]))
    }
}

impl<S: Simd> Binary32 for Lanes<S> {
    #[inline(always)]
    fn power_of_two(shifted: Self) -> Self {
        Self(S::f32s::from_bits((shifted.0.to_bits() << MANTISSA) + ONE))
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> (Self, Self) {
        let bits = self.0.to_bits();
        let above = bits - ROOT_HALF;
        let exponent = ((above + ONE) >> MANTISSA) + WHOLE;
        let mantissa = bits - (above & (!0 << MANTISSA));
        (
            Self(S::f32s::from_bits(mantissa)),
            Self(S::f32s::from_bits(exponent)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    fn both_widths(task: impl OnLanes + Copy) {
        dispatch(task);
        dispatch_narrow(task);
    }

    /// Numbers of all sizes, in any of eight lanes.
    fn numbers(seed: u64, exponent: f32) -> [f32; MOST_LANES] {
        let mut random = rand_pcg::Pcg32::seed_from_u64(seed);
        std::array::from_fn(|_| {
            let size = random.random_range(-exponent..exponent).exp2();
            random.random_range(-1.0..1.0_f32) * size
        })
    }

    #[derive(Clone, Copy)]
    struct Operations;

    impl OnLanes for Operations {
        fn run<S: Simd>(self, simd: S) {
            for seed in 0..2000 {
                // So that products and quotients go to both ends of f32's range, and beyond.
                let (a, b) = (numbers(seed, 70.0), numbers(seed + 10_000, 70.0));
                let [x, y] = [a, b].map(|v| Lanes::<S>::from_fn(simd, |lane| v[lane]));
                let check = |name: &str, lanes: Lanes<S>, scalar: fn(f32, f32) -> f32| {
                    for lane in 0..Lanes::<S>::COUNT {
                        let (got, wanted) = (lanes.0[lane], scalar(a[lane], b[lane]));
                        assert_eq!(
                            got.to_bits(),
                            wanted.to_bits(),
                            "{name} of {:e}, {:e}: {got:e} {wanted:e}",
                            a[lane],
                            b[lane]
                        );
                    }
                };
                check("+", x + y, |a, b| a + b);
                check("−", x - y, |a, b| a - b);
                check("×", x * y, |a, b| a * b);
                check("÷", x / y, |a, b| a / b);
                check("negative", -x, |a, _| -a);
                check("square root", x.abs().sqrt(), |a, _| a.abs().sqrt());
                check("ceiling", x.ceil(), |a, _| a.ceil());
                check("maximum", x.max(y), f32::max);
                check("minimum", x.min(y), f32::min);
                check("select_lt", x.select_lt(x, y, y), f32::min);
                check("constant", x.constant(0.1), |_, _| 0.1);
                check("exponential", x.exp(), |a, _| Scalar::exp(a));
                let normal = x.abs().max(x.constant(f32::MIN_POSITIVE.into()));
                check("logarithm", normal.ln(), |a, _| {
                    Scalar::ln(a.abs().max(f32::MIN_POSITIVE))
                });
                let least = (0..Lanes::<S>::COUNT).fold(f32::MAX, |least, i| least.min(a[i]));
                let whole = x.abs().min(x.constant(600.0)).ceil();
                let index = Lanes::index(simd, [whole, whole, whole], [10, 100]);
                for (lane, number) in whole.numbers().iter().enumerate() {
                    assert_eq!(index[lane], 111 * *number as u32);
                    let wanted = a[lane].abs().min(600.0).ceil();
                    assert!(lane >= Lanes::<S>::COUNT || *number == wanted);
                }
                assert!(x.all_ge(least.into()));
                assert!(!x.all_ge(f64::from(least.next_up())));
                let most = (0..Lanes::<S>::COUNT).fold(1.0, |most, i| a[i].max(most));
                assert_eq!(x.largest(1.0), most);
            }
        }
    }

    /// To the bit, at either width.
    #[test]
    fn a_lane_computes_what_a_scalar_does() {
        both_widths(Operations);
    }

    #[derive(Clone, Copy)]
    struct Rows;

    impl OnLanes for Rows {
        fn run<S: Simd>(self, simd: S) {
            let row = |lane: usize| [0.0, 0.1, 0.2, 0.3].map(|x| x + lane as f32);
            let columns = Lanes::<S>::side_by_side(simd, row);
            for (i, column) in columns.iter().enumerate() {
                for lane in 0..Lanes::<S>::COUNT {
                    assert_eq!(column.0[lane], row(lane)[i]);
                }
            }
            let mut lanes = vec![];
            Lanes::apart(columns, |lane, got| {
                assert_eq!(got, row(lane));
                lanes.push(lane);
            });
            assert_eq!(lanes, Vec::from_iter(0..Lanes::<S>::COUNT));
        }
    }

    /// Rows that are put side by side and taken apart again are the same.
    #[test]
    fn rows_become_columns() {
        both_widths(Rows);
    }
}
