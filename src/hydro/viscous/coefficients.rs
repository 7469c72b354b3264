//! One table of coefficients per law: what a law's struct, its default, its check and everything that
//! goes through coefficients by name are made from.

use crate::error::Error;

/// The values that a coefficient may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bounds {
    /// Any finite number.
    Finite,
    /// Zero or positive.
    NotNegative,
    /// Positive.
    Positive,
    /// From 0 to 1.
    Unit,
}

impl Bounds {
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names the coefficient.
    pub(crate) fn check(self, name: &'static str, value: f64) -> Result<(), Error> {
        match self {
            Self::Finite => Error::check_range(name, value, f64::MIN, f64::MAX),
            Self::NotNegative => Error::check_range(name, value, 0.0, f64::MAX),
            Self::Positive => Error::check_positive(name, value),
            Self::Unit => Error::check_range(name, value, 0.0, 1.0),
        }
        .map(|_| ())
    }
}

/// One coefficient of the viscous law `L`.
#[derive(Debug)]
pub struct Coefficient<L> {
    /// Name, that of the law's field.
    pub name: &'static str,
    /// The values that it may have.
    pub bounds: Bounds,
    /// Where a calibration looks for it; `None` if measurements other than falls decide it.
    pub search: Option<[f64; 2]>,
    pub(crate) field: fn(&mut L) -> &mut f64,
}

impl<L: Copy> Coefficient<L> {
    /// Its value in a law.
    pub fn of(&self, law: &L) -> f64 {
        *(self.field)(&mut law.clone())
    }
}

/// Defines a law's coefficients: one row each with its documentation, default, bounds, and (where a
/// calibration may search for it) the limits of the search.
macro_rules! coefficients {
    ($(#[$meta:meta])* pub struct $law:ident {
        $($(#[$doc:meta])* $name:ident: $default:expr, $bounds:ident $(, search $low:literal to $high:literal)?;)+
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[cfg_attr(
            feature = "serde-serialize",
            derive(serde::Serialize, serde::Deserialize)
        )]
        pub struct $law {
            $($(#[$doc])* pub $name: f64,)+
        }

        impl Default for $law {
            fn default() -> Self {
                Self { $($name: $default,)+ }
            }
        }

        impl $law {
            /// Its coefficients, in the order of its fields.
            pub const COEFFICIENTS: &'static [Coefficient<Self>] = &[$(Coefficient {
                name: stringify!($name),
                bounds: Bounds::$bounds,
                search: $crate::hydro::viscous::coefficients::search!($($low to $high)?),
                field: |law| &mut law.$name,
            },)+];

            /// Checks every coefficient.
            ///
            /// # Errors
            /// [`Error::InvalidParameter`](crate::Error) or [`Error::OutOfRange`](crate::Error) names the
            /// first that is not finite or out of its [`Bounds`].
            pub fn check(&self) -> Result<(), crate::Error> {
                $(Bounds::$bounds.check(stringify!($name), self.$name)?;)+
                Ok(())
            }

            /// Sets the coefficient of this name.
            ///
            /// # Errors
            /// [`Error::UnknownCoefficient`](crate::Error) if there is none, those of [`check`](Self::check)
            /// for the value; the law is then as before.
            pub fn set(&mut self, name: &str, value: f64) -> Result<(), crate::Error> {
                $crate::hydro::viscous::coefficients::set(self, Self::COEFFICIENTS, name, value)
            }
        }
    };
}
pub(crate) use coefficients;

/// The limits of a search, if a row has them.
macro_rules! search {
    () => {
        None
    };
    ($low:literal to $high:literal) => {
        Some([$low, $high])
    };
}
pub(crate) use search;

/// Sets the coefficient of a table that has this name.
pub(crate) fn set<L>(
    law: &mut L,
    coefficients: &[Coefficient<L>],
    name: &str,
    value: f64,
) -> Result<(), Error> {
    let Some(coefficient) = coefficients.iter().find(|known| known.name == name) else {
        return Err(Error::UnknownCoefficient {
            name: name.into(),
            known: coefficients.iter().map(|known| known.name).collect(),
        });
    };
    coefficient.bounds.check(coefficient.name, value)?;
    *(coefficient.field)(law) = value;
    Ok(())
}
