//! Linear and quadratic damping in six degrees of freedom, as it is published for underwater vehicles.

use super::place::{PartPlace, moved, velocity_at};
use crate::error::Error;
use crate::math::spatial::{Blocks, Twist, matrix};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::{Matrix3, Matrix6, Vector3, Vector6};

/// Damping `−(D_l + D_q(ν)) ν` of the motion ν = (u, v, w, p, q, r) of a part's frame through the fluid, in N and
/// N·m (Fossen, *Handbook of Marine Craft Hydrodynamics and Motion Control*, § 6.4): along and about x, y and z of
/// the frame, at its origin.
///
/// `D_q(ν)` has the entries `d_ij √(|νᵢ| |νⱼ|)`: on the diagonal, `dᵢᵢ |νᵢ| νᵢ` as published (`−X_{u|u|}` and so on,
/// sign turned). Off-diagonal quadratic terms are rarely published, and as `dᵢⱼ |νⱼ| νⱼ` they would give energy to some motions
/// whatever their size.
///
/// ```
/// use rapier3d_immersed::Damping;
/// use rapier3d_immersed::rapier3d::na::{Matrix6, Vector6};
///
/// let rov = Damping::diagonal(
///     Vector6::new(4.03, 6.22, 5.18, 0.07, 0.07, 0.07),
///     Vector6::new(18.18, 21.66, 36.99, 1.55, 1.55, 1.55),
/// )?;
/// assert_eq!(rov.quadratic[(0, 0)], 18.18);
/// let pumps = Matrix6::from_diagonal_element(-1.0);
/// assert!(Damping::new(pumps, Matrix6::zeros()).unwrap_err().to_string().contains("-1"));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Damping {
    /// D_l: N·s/m, N·s, and N·m·s.
    pub linear: Matrix6<f64>,
    /// d: N·s²/m² and so on.
    pub quadratic: Matrix6<f64>,
}

impl Damping {
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::InvalidParameter`] if the symmetric part of a matrix has a negative
    /// eigenvalue, which it names: such damping gives energy to the motion.
    pub fn new(linear: Matrix6<f64>, quadratic: Matrix6<f64>) -> Result<Self, Error> {
        let new = Self { linear, quadratic };
        new.check()?;
        Ok(new)
    }

    /// Uncoupled damping.
    ///
    /// # Errors
    /// As of [`Damping::new`].
    pub fn diagonal(linear: Vector6<f64>, quadratic: Vector6<f64>) -> Result<Self, Error> {
        Self::new(
            Matrix6::from_diagonal(&linear),
            Matrix6::from_diagonal(&quadratic),
        )
    }

    /// # Errors
    /// As of [`Damping::new`].
    pub fn check(&self) -> Result<(), Error> {
        for (name, matrix) in [
            ("eigenvalue of the linear damping", &self.linear),
            ("eigenvalue of the quadratic damping", &self.quadratic),
        ] {
            Error::check_all_finite("damping matrix", matrix.as_slice())?;
            let least = (matrix + matrix.transpose()).symmetric_eigenvalues().min() * 0.5;
            let rounding = 1e-12 * matrix.amax();
            Error::check(name, least, least >= -rounding, "not negative")?;
        }
        Ok(())
    }
}

scalar_struct! {
    /// What a step needs of a [`Damping`]: the part's frame, with w = ωL in units of speed.
    pub(crate) struct DampingConstants<T> {
        linear11: Matrix3<T>,
        linear12: Matrix3<T>,
        linear21: Matrix3<T>,
        linear22: Matrix3<T>,
        quadratic11: Matrix3<T>,
        quadratic12: Matrix3<T>,
        quadratic21: Matrix3<T>,
        quadratic22: Matrix3<T>,
    }
}

impl DampingConstants<f64> {
    pub fn new(damping: &Damping, mass: f64, length: f64) -> Self {
        // ω = w/L, and torques are over L; the quadratic terms have ω once more, as √ on each side.
        let block = |m: &Matrix6<f64>, i: usize, j: usize, scale: f64| {
            m.fixed_view::<3, 3>(3 * i, 3 * j).into_owned() * (scale / mass)
        };
        let (l, q) = (&damping.linear, &damping.quadratic);
        let once = 1.0 / length;
        let half = once.sqrt();
        Self {
            linear11: block(l, 0, 0, 1.0),
            linear12: block(l, 0, 1, once),
            linear21: block(l, 1, 0, once),
            linear22: block(l, 1, 1, once * once),
            quadratic11: block(q, 0, 0, 1.0),
            quadratic12: block(q, 0, 1, once * half),
            quadratic21: block(q, 1, 0, once * half),
            quadratic22: block(q, 1, 1, once * once * once),
        }
    }
}

impl<T: Scalar> DampingConstants<T> {
    #[inline(always)]
    pub fn matrix(&self, place: &PartPlace<T>, v: &Twist<T>, factor: T) -> Blocks<T> {
        let u = place.back(&velocity_at(v, &place.position));
        let w = place.back(&v.angular);
        let root = |v: Vector3<T>| v.map(|x| x.abs().sqrt());
        let (ru, rw) = (root(u), root(w));
        let block = |l: &Matrix3<T>, q: &Matrix3<T>, a: &Vector3<T>, b: &Vector3<T>| {
            let e = |i: usize, j: usize| (l[(i, j)] + q[(i, j)] * a[i] * b[j]) * -factor;
            let m = matrix(e);
            place.matrix_out(&m)
        };
        let own = Blocks {
            m11: block(&self.linear11, &self.quadratic11, &ru, &ru),
            m12: block(&self.linear12, &self.quadratic12, &ru, &rw),
            m21: block(&self.linear21, &self.quadratic21, &rw, &ru),
            m22: block(&self.linear22, &self.quadratic22, &rw, &rw),
        };
        moved(&own, &place.position)
    }
}
