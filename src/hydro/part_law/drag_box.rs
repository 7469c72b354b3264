//! Drag by direction, as of a box.

use super::place::{PartPlace, at, velocity_at};
use crate::error::Error;
use crate::math::spatial::{Blocks, Twist};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::Vector3;

/// A drag area for each of the six directions along the axes of a part's frame, with the force acting at
/// one point: what is known of a car, a robot's frame or a person.
///
/// The force along each axis is `−½ρ (C_D A) |vᵢ| vᵢ`, v being the velocity of the point through the fluid: each axis
/// by itself, as for a long body that the flow meets askew.
///
/// ```
/// use rapier3d_immersed::DragBox;
/// use rapier3d_immersed::rapier3d::na::Vector3;
///
/// // A van: 0.9 m² forward (−x is its back), more backward and to the sides.
/// let van = DragBox::new(Vector3::new(0.9, 4.0, 8.0), Vector3::new(1.4, 4.0, 8.0))?;
/// let higher = van.at(Vector3::new(0.2, 0.0, 0.6))?;
/// assert_eq!(higher.along, van.along);
/// assert!(DragBox::new(Vector3::x() * -1.0, Vector3::zeros()).is_err());
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct DragBox {
    /// C_D·A of motion along +x, +y and +z of the part's frame, m².
    pub along: Vector3<f64>,
    /// C_D·A of motion along −x, −y and −z, m².
    pub against: Vector3<f64>,
    /// Where the force acts, m, in the part's frame.
    pub center: Vector3<f64>,
}

impl DragBox {
    /// Drag areas, m², of motion along the axes and against them; the force acts at the frame's origin.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] names an area that is negative or not finite.
    pub fn new(along: Vector3<f64>, against: Vector3<f64>) -> Result<Self, Error> {
        let new = Self {
            along,
            against,
            center: Vector3::zeros(),
        };
        new.check()?;
        Ok(new)
    }

    /// With the force acting at a point, m, of the part's frame.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if it is not finite.
    pub fn at(self, center: Vector3<f64>) -> Result<Self, Error> {
        let new = Self { center, ..self };
        new.check()?;
        Ok(new)
    }

    /// # Errors
    /// As of [`DragBox::new`] and [`DragBox::at`].
    pub fn check(&self) -> Result<(), Error> {
        for area in self.along.iter().chain(&self.against) {
            Error::check_not_negative("drag area", *area)?;
        }
        Error::check_all_finite("center of the drag box", self.center.as_slice())
    }
}

scalar_struct! {
    /// What a step needs of a [`DragBox`]; the place's position is its center, and its axes are the frame's.
    pub(crate) struct DragBoxConstants<T> {
        /// ½ρ C_D A over the mass scale, 1/m.
        along: Vector3<T>,
        against: Vector3<T>,
    }
}

impl DragBoxConstants<f64> {
    pub fn new(drag: &DragBox, density: f64, mass: f64) -> Self {
        let scaled = |areas: &Vector3<f64>| areas * (0.5 * density / mass);
        Self {
            along: scaled(&drag.along),
            against: scaled(&drag.against),
        }
    }
}

impl<T: Scalar> DragBoxConstants<T> {
    #[inline(always)]
    pub fn matrix(&self, place: &PartPlace<T>, v: &Twist<T>, factor: T) -> Blocks<T> {
        let u = place.back(&velocity_at(v, &place.position));
        let zero = factor.constant(0.0);
        let by =
            |i: usize| self.against[i].select_lt(u[i], zero, self.along[i]) * u[i].abs() * factor;
        let resistance = place.diagonal_out(&Vector3::new(by(0), by(1), by(2)));
        at(&-resistance, &place.position)
    }
}
