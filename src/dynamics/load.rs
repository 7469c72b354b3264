//! What acts on a body besides the fluid's resistance.

use super::locked::Locks;
use crate::math::Scalar;
use crate::math::spatial::{Wrench, cross, rotate_back};
use rapier3d::na::{Quaternion, Vector3};

/// What acts on a body besides the fluid's resistance, constant over a step. World axes, per unit of
/// the mass scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Load<T> {
    /// Weight, buoyancy and user's force, m/s².
    pub force: Vector3<T>,
    /// User's torque over L, m/s².
    pub torque: Vector3<T>,
    /// Buoyancy −ρVg over the mass scale, m/s²; acts at `buoyancy_arm`.
    pub buoyancy: Vector3<T>,
    /// From the center of mass to the center of buoyancy, plate axes, in L.
    pub buoyancy_arm: Vector3<T>,
    /// Half the vorticity of the fluid times L, m/s: the spin at which damping rests.
    pub fluid_spin: Vector3<T>,
    /// The fluid's rate of strain, 1/s: stretching along and shearing across the axes of the world; and what
    /// spin, in units of speed, the shearing across each plate axis is worth (m).
    pub stretching: Vector3<T>,
    pub shearing: Vector3<T>,
    pub strain_response: Vector3<T>,
    /// Whether torque or buoyancy arm are not zero for some body.
    pub turning: bool,
    /// Whether the fluid's spin is not zero around some body.
    pub spinning: bool,
    /// Whether the fluid strains around some body, which then counts as spinning, too.
    pub straining: bool,
    /// Axes along which nothing changes the velocity.
    pub locks: Locks<T>,
}

impl<T: Scalar> Load<T> {
    /// Force and torque on a body at an attitude, plate axes.
    #[inline(always)]
    pub fn applied(&self, attitude: &Quaternion<T>) -> Wrench<T> {
        let mut applied = Wrench {
            force: rotate_back(attitude, &self.force),
            torque: Vector3::repeat(self.force.x.constant(0.0)),
        };
        if self.turning {
            let buoyancy = rotate_back(attitude, &self.buoyancy);
            applied.torque =
                rotate_back(attitude, &self.torque) + cross(&self.buoyancy_arm, &buoyancy);
        }
        applied
    }

    /// The spin that the fluid's strain is worth to an ellipsoid, plate axes:
    /// ωₓ = (b² − c²)/(b² + c²) E_yz and so on (Jeffery 1922).
    #[inline(always)]
    pub fn strain_spin(&self, attitude: &Quaternion<T>) -> Vector3<T> {
        let (n, s) = (&self.stretching, &self.shearing);
        // The columns of E in plate axes, and the rows of what comes out once more: RᵀER.
        let x = rotate_back(attitude, &Vector3::new(n.x, s.z, s.y));
        let y = rotate_back(attitude, &Vector3::new(s.z, n.y, s.x));
        let z = rotate_back(attitude, &Vector3::new(s.y, s.x, n.z));
        let row = |i: usize| rotate_back(attitude, &Vector3::new(x[i], y[i], z[i]));
        Vector3::new(row(1).z, row(2).x, row(0).y).component_mul(&self.strain_response)
    }
}
