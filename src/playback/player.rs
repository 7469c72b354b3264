//! How a body follows a synthesized fall (thesis chapter 3).

use crate::error::Error;
use crate::motion::path::MotionPath;
use rapier3d::math::{Pose, Real, Rotation, Vector};
use std::sync::Arc;

/// Farthest place and fastest velocity that is accepted, m and m/s: beyond, single precision moves nothing
/// any more, and sums overflow.
pub(super) const FARTHEST: f64 = 1e9;

/// How a body is made to follow its path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Drive {
    /// The path sets its position. This is for position-based kinematic bodies, which follow exactly and push
    /// others away.
    ///
    /// What is to happen [at a contact](AtContact), with whatever kind of body, begins in the step after
    /// rapier finds it (as near as its prediction distance, or farther with the body's soft CCD
    /// prediction; what moves farther than that in a step is hit late): then the body becomes dynamic,
    /// with the velocities that it had. At the end of the path it becomes dynamic as well. Its colliders look
    /// for contacts with fixed and kinematic bodies from then on
    /// ([`ActiveCollisionTypes`](rapier3d::geometry::ActiveCollisionTypes)).
    Kinematic,
    /// The path sets its velocity in every step. This is for dynamic bodies. A body that a contact displaced
    /// comes back within about `compliance` seconds, at once if that is zero. It may turn by more than 45°
    /// per step from then on, as tumbling leaves do.
    Velocity {
        /// Time constant, s.
        compliance: Real,
    },
}

/// What a contact does to a body that plays a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum AtContact {
    /// The body is no longer played. If it is immersed, the force model takes over, otherwise rapier
    /// alone. This is the default.
    #[default]
    HandOver,
    /// The body is handed over in the same way, but once nothing has touched it for `after` seconds the path
    /// goes on from where the body then is.
    Resume {
        /// Time without contact, s.
        after: Real,
    },
    /// The path goes on from where the contact moved the body, at first with the velocity that the
    /// contact gave it. A kinematic body is dynamic while it touches something.
    Deflect,
    /// The path goes on and pulls the body back; a kinematic one goes through what cannot give way.
    Ignore,
}

/// One body's path and how it follows it.
///
/// ```
/// use rapier3d_immersed::motion::Regime;
/// use rapier3d_immersed::motion::path::{Key, MotionPath};
/// use rapier3d_immersed::playback::{AtContact, Drive, MotionPlayer};
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use std::sync::Arc;
///
/// let key = Key { position: Vector::ZERO, velocity: Vector::ZERO, attitude: Rotation::IDENTITY };
/// let path = MotionPath::new(1.0, vec![key; 2], vec![(0.0, Regime::SteadyDescent)])?;
/// let player = MotionPlayer {
///     heading: 1.2,
///     drive: Drive::Kinematic,
///     at_contact: AtContact::Resume { after: 0.5 },
///     ..MotionPlayer::new(Arc::new(path), Vector::Y * 3.0)
/// };
/// // Where the body is to be put before it plays.
/// assert!((player.release(Vector::ZERO).translation - Vector::Y * 3.0).length() < 1e-6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MotionPlayer {
    /// The path; players may share it.
    pub path: Arc<MotionPath>,
    /// Where the path begins, world axes, m.
    pub origin: Vector,
    /// How far the path is turned about +Y, rad. Default 0.
    pub heading: Real,
    /// The plate axes (x longest, z normal) in the body's frame:
    /// [`Planform::axes`](crate::Planform), or the default, for a body that is longest along x
    /// and thinnest along y.
    pub axes: Rotation,
    /// How the body is made to follow. Default [`Drive::Velocity`] with a compliance of 0.1 s.
    pub drive: Drive,
    /// What a contact does to it. Default [`AtContact::HandOver`].
    pub at_contact: AtContact,
}

impl MotionPlayer {
    /// A player with the defaults.
    pub fn new(path: Arc<MotionPath>, origin: Vector) -> Self {
        Self {
            path,
            origin,
            heading: 0.0,
            axes: Rotation::from_axis_angle(Vector::X, -std::f32::consts::FRAC_PI_2),
            drive: Drive::Velocity { compliance: 0.1 },
            at_contact: AtContact::default(),
        }
    }

    /// Pose of the body's frame at the beginning of the path, for a body whose center of mass is at
    /// `local_com` of its frame.
    pub fn release(&self, local_com: Vector) -> Pose {
        let turn = Rotation::from_axis_angle(Vector::Y, self.heading);
        let key = self.path.at(0.0);
        let rotation = (turn * key.attitude * self.axes.inverse()).normalize();
        let com = self.origin + turn * key.position;
        Pose::from_parts(com - rotation * local_com, rotation)
    }

    /// # Errors
    /// [`Error::NotFinite`] or [`Error::InvalidParameter`] names a value that is not finite, negative,
    /// or no rotation.
    pub fn check(&self) -> Result<(), Error> {
        let origin = self.origin.to_array().map(f64::from);
        Error::check_all_within("origin", &origin, FARTHEST)?;
        Error::check_finite("heading", self.heading.into())?;
        let norm = f64::from(self.axes.length());
        Error::check("norm of the axes", norm, (norm - 1.0).abs() < 1e-3, "1")?;
        self.drive.check()?;
        self.at_contact.check()
    }
}

impl Drive {
    pub(super) fn check(&self) -> Result<(), Error> {
        if let Self::Velocity { compliance } = self {
            Error::check_not_negative("compliance", (*compliance).into())?;
        }
        Ok(())
    }
}

impl AtContact {
    pub(super) fn check(&self) -> Result<(), Error> {
        if let Self::Resume { after } = self {
            Error::check_not_negative("after", (*after).into())?;
        }
        Ok(())
    }
}
