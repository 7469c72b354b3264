//! Structs of constants that are computed in f64, kept in f32 and used in lanes.

use super::Lanes;
use fearless_simd::Simd;
use rapier3d::na::{Matrix3, Vector2, Vector3};
use std::fmt::Debug;

/// What a field of a [`scalar_struct`] can be: a scalar, a vector or a matrix.
pub(crate) trait Field {
    /// The scalar that it is made of.
    type Component: Copy;
    /// The same field made of another scalar.
    type Of<U: Copy + Debug + PartialEq + 'static>;

    /// Component `i`, in an order of the field's own.
    fn component(&self, i: usize) -> Self::Component;
    /// Whether a condition holds for every component.
    fn all(&self, is: impl Fn(Self::Component) -> bool) -> bool;
    /// The field of which `of` gives the components.
    fn from_components<U: Copy + Debug + PartialEq + 'static>(
        of: impl Fn(usize) -> U,
    ) -> Self::Of<U>;
}

/// The four kinds of field, for one type of component.
macro_rules! fields_of {
    ($type:ident) => {
        impl Field for $type {
            type Component = $type;
            type Of<U: Copy + Debug + PartialEq + 'static> = U;
            #[inline(always)]
            fn component(&self, _i: usize) -> $type {
                *self
            }
            fn all(&self, is: impl Fn($type) -> bool) -> bool {
                is(*self)
            }
            #[inline(always)]
            fn from_components<U: Copy + Debug + PartialEq + 'static>(
                of: impl Fn(usize) -> U,
            ) -> U {
                of(0)
            }
        }

        impl Field for Vector2<$type> {
            type Component = $type;
            type Of<U: Copy + Debug + PartialEq + 'static> = Vector2<U>;
            #[inline(always)]
            fn component(&self, i: usize) -> $type {
                self[i]
            }
            fn all(&self, is: impl Fn($type) -> bool) -> bool {
                self.iter().all(|x| is(*x))
            }
            #[inline(always)]
            fn from_components<U: Copy + Debug + PartialEq + 'static>(
                of: impl Fn(usize) -> U,
            ) -> Vector2<U> {
                Vector2::new(of(0), of(1))
            }
        }

        impl Field for Vector3<$type> {
            type Component = $type;
            type Of<U: Copy + Debug + PartialEq + 'static> = Vector3<U>;
            #[inline(always)]
            fn component(&self, i: usize) -> $type {
                self[i]
            }
            fn all(&self, is: impl Fn($type) -> bool) -> bool {
                self.iter().all(|x| is(*x))
            }
            #[inline(always)]
            fn from_components<U: Copy + Debug + PartialEq + 'static>(
                of: impl Fn(usize) -> U,
            ) -> Vector3<U> {
                Vector3::new(of(0), of(1), of(2))
            }
        }

        impl Field for Matrix3<$type> {
            type Component = $type;
            type Of<U: Copy + Debug + PartialEq + 'static> = Matrix3<U>;
            #[inline(always)]
            fn component(&self, i: usize) -> $type {
                self[(i / 3, i % 3)]
            }
            fn all(&self, is: impl Fn($type) -> bool) -> bool {
                self.iter().all(|x| is(*x))
            }
                    #[inline(always)]
                    #[rustfmt::skip]
            fn from_components<U: Copy + Debug + PartialEq + 'static>(
                        of: impl Fn(usize) -> U,
                    ) -> Matrix3<U> {
                        Matrix3::new(of(0), of(1), of(2), of(3), of(4), of(5), of(6), of(7), of(8))
                    }
        }
    };
}
fields_of!(f64);
fields_of!(f32);

/// A field in the nearest f32.
#[inline]
pub(crate) fn rounded<F: Field<Component = f64>>(field: &F) -> F::Of<f32> {
    F::from_components(|i| field.component(i) as f32)
}

/// A field of one body in every lane.
#[inline(always)]
pub(crate) fn splat<S: Simd, F: Field<Component = f32>>(simd: S, field: &F) -> F::Of<Lanes<S>> {
    F::from_components(|i| Lanes::splat(simd, field.component(i)))
}

/// A field of one body in each lane.
#[inline(always)]
pub(crate) fn gather<'a, S: Simd, F: Field<Component = f32> + 'a>(
    simd: S,
    of: impl Fn(usize) -> &'a F,
) -> F::Of<Lanes<S>> {
    F::from_components(|i| Lanes::from_fn(simd, |lane| of(lane).component(i)))
}

/// Defines a struct that is generic over the scalar `T` of its fields (each is `T`, `Vector3<T>` or
/// `Matrix3<T>`): computed in f64, kept in f32, used in lanes.
macro_rules! scalar_struct {
    ($(#[$meta:meta])* $vis:vis struct $name:ident<T> { $($(#[$field_meta:meta])* $field:ident: $type:ty,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        $vis struct $name<T> {
            $($(#[$field_meta])* pub(crate) $field: $type,)+
        }

        impl $name<f64> {
            /// The nearest constants in f32.
            pub(crate) fn rounded(&self) -> $name<f32> {
                $name { $($field: $crate::math::fields::rounded(&self.$field),)+ }
            }
        }

        impl $name<f32> {
            /// Whether every constant is a finite number.
            pub(crate) fn is_finite(&self) -> bool {
                $($crate::math::fields::Field::all(&self.$field, f32::is_finite))&&+
            }
        }

        impl<S: fearless_simd::Simd> $name<$crate::math::Lanes<S>> {
            /// The same constants in every lane.
            #[inline(always)]
            pub(crate) fn splat(simd: S, constants: &$name<f32>) -> Self {
                Self { $($field: $crate::math::fields::splat(simd, &constants.$field),)+ }
            }

            /// The constants of one body in each lane. Not asked of what only equal bodies are stepped with.
            #[allow(dead_code)]
            #[inline(always)]
            pub(crate) fn gather<'a>(simd: S, of: impl Fn(usize) -> &'a $name<f32>) -> Self {
                Self { $($field: $crate::math::fields::gather(simd, |lane| &of(lane).$field),)+ }
            }
        }
    };
}
pub(crate) use scalar_struct;
