//! Elementary functions, by whom rapier has them computed: with the feature `enhanced-determinism` by the library libm,
//! whose bits are those of every machine, else by the machine's own.
//!
//! The standard library's methods are the machine's own with either; clippy refuses them in this crate.

use rapier3d::na::{ComplexField, RealField};

/// Functions of one argument.
macro_rules! functions {
    ($($name:ident),*) => {
        $(
            #[doc = concat!("What the standard library's `", stringify!($name), "` is of the argument.")]
            #[inline]
            pub(crate) fn $name<T: ComplexField>(x: T) -> T {
                ComplexField::$name(x)
            }
        )*
    };
}

functions!(
    sin, cos, tan, asin, acos, tanh, exp, exp2, exp_m1, ln, ln_1p, log2, log10, cbrt
);

/// Sine and cosine.
#[inline]
pub(crate) fn sin_cos<T: ComplexField>(x: T) -> (T, T) {
    ComplexField::sin_cos(x)
}

/// `x^power`.
#[inline]
pub(crate) fn powf<T: RealField>(x: T, power: T) -> T {
    ComplexField::powf(x, power)
}

/// Direction of the point (x, y), in radians from the x axis.
#[inline]
pub(crate) fn atan2<T: RealField>(y: T, x: T) -> T {
    RealField::atan2(y, x)
}

/// Length of the hypotenuse.
#[inline]
pub(crate) fn hypot<T: RealField>(x: T, y: T) -> T {
    ComplexField::hypot(x, y)
}
