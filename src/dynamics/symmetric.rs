//! One substep's increment for a symmetric body under a passive law, written out.
//!
//! 𝕄 is diagonal there, and the viscous force acts on the velocity of the pressure point,
//! `v = u + e_z (j·w)`, with torque `j f_z`, j = (a, b, 0) being the arm turned by a right angle. With
//! Δv instead of Δu as unknown (and the torque about the pressure point: a congruence, so that nothing
//! is lost) the force matrix drops out of all blocks but one:
//!
//! ```text
//! ⎡ D − [l]×                −[p]× − (m_z + [c]×) e_z jᵀ ⎤ ⎡Δv⎤   ⎡f ⎤
//! ⎣ −[p]× − j e_zᵀ (m_z + [c]×)  K − [g]× + m_z j jᵀ     ⎦ ⎣Δw⎦ = ⎣t'⎦
//! ```
//!
//! with D and K diagonal, c = mω for the body's own mass and the fluid's that is the same in all directions, p the fluid's linear and g the angular
//! momentum (with `j·p` added along z), l the lift less c, all of them times θh. A diagonal plus a
//! skew matrix has the inverse `(adj D + l lᵀ + [D l]×) / (det D + l·D l)`.

use super::constants::InertiaConstants;
use crate::hydro::viscous::terms::ViscousTerms;
use crate::math::Scalar;
use crate::math::spatial::{Twist, Wrench, cross, inverse3, transform};
use rapier3d::na::{Matrix3, Vector3};

impl<T: Scalar> InertiaConstants<T> {
    /// As [`InertiaConstants::increment`], where 𝕄 is diagonal and the planform centered.
    #[inline(always)]
    pub(super) fn symmetric_increment(
        &self,
        terms: &ViscousTerms<T>,
        start: &Twist<T>,
        middle: &Twist<T>,
        load: &Wrench<T>,
        h: T,
        theta: T,
    ) -> Twist<T> {
        let (u, w) = (&middle.linear, &middle.angular);
        let share = self.munk * self.per_length;
        let own = self.dry_mass + self.isotropic;
        let p = Vector3::new(
            (self.m11.m11 - own) * u.x * share,
            (self.m11.m22 - own) * u.y * share,
            (self.m11.m33 - own) * u.z * share,
        );
        let c = w * (own * self.per_length);
        let g = Vector3::new(self.m22.m11 * w.x, self.m22.m22 * w.y, self.m22.m33 * w.z)
            * self.per_length;
        let lift = terms.translational_lift + terms.rotational_lift;
        let resistance = terms.creeping.map(|s| terms.drag + s);
        let (a, b) = (terms.arm.y, -terms.arm.x);

        // Right-hand side: h (Nν₀ + Q), the torque about the pressure point.
        let (u0, w0) = (&start.linear, &start.angular);
        let v0 = Vector3::new(u0.x, u0.y, u0.z + a * w0.x + b * w0.y);
        let turned = cross(&p, w0) - cross(&c, u0) + load.force;
        let f = cross(&lift, &v0) - resistance.component_mul(&v0) + turned;
        let gyroscopic = cross(&p, u0) + cross(&g, w0) - terms.damping.component_mul(w0);
        let t = gyroscopic + load.torque;
        let f = f * h;
        let t = Vector3::new(t.x - a * turned.z, t.y - b * turned.z, t.z) * h;

        let scale = theta * h;
        let c = c * scale;
        let l = lift * scale - c;
        let d = Vector3::new(self.m11.m11, self.m11.m22, self.m11.m33) + resistance * scale;
        let p = p * scale;
        let g = g * scale;
        let gz = g.z + a * p.x + b * p.y;
        let k = terms.damping * scale;
        let mz = self.m11.m33;

        // Inverse of the first block, times its determinant.
        let dl = d.component_mul(&l);
        let (yz, zx, xy) = (d.y * d.z, d.z * d.x, d.x * d.y);
        let per = h.constant(1.0) / (d.x * yz + l.x * dl.x + l.y * dl.y + l.z * dl.z);
        let (lxy, lyz, lzx) = (l.x * l.y, l.y * l.z, l.z * l.x);
        let inverse = Matrix3::new(
            (yz + l.x * l.x) * per,
            (lxy - dl.z) * per,
            (lzx + dl.y) * per,
            (lxy + dl.z) * per,
            (zx + l.y * l.y) * per,
            (lyz - dl.x) * per,
            (lzx - dl.y) * per,
            (lyz + dl.x) * per,
            (xy + l.z * l.z) * per,
        );

        // The entries of the other two off-diagonal blocks that are not zero.
        let (ma, mb) = (mz * a, mz * b);
        let (cxa, cxb, cya, cyb) = (c.x * a, c.x * b, c.y * a, c.y * b);
        let (xy12, yx12) = (p.z - cyb, cxa - p.z);
        let (zx12, zy12) = (p.y - ma, -p.x - mb);
        let (xy21, yx21) = (p.z - cxa, cyb - p.z);
        let (xz21, yz21) = (-p.y - ma, p.x - mb);
        let i = &inverse;
        // Second block row times the inverse.
        let through = Matrix3::new(
            cya * i.m11 + xy21 * i.m21 + xz21 * i.m31,
            cya * i.m12 + xy21 * i.m22 + xz21 * i.m32,
            cya * i.m13 + xy21 * i.m23 + xz21 * i.m33,
            yx21 * i.m11 - cxb * i.m21 + yz21 * i.m31,
            yx21 * i.m12 - cxb * i.m22 + yz21 * i.m32,
            yx21 * i.m13 - cxb * i.m23 + yz21 * i.m33,
            p.y * i.m11 - p.x * i.m21,
            p.y * i.m12 - p.x * i.m22,
            p.y * i.m13 - p.x * i.m23,
        );
        let q = &through;
        // First, second and third column of a row of the product with the block to the right.
        let x = |x: T, y: T, z: T| y * yx12 - x * cya + z * zx12;
        let y = |x: T, y: T, z: T| x * xy12 + y * cxb + z * zy12;
        let z = |x: T, y: T| y * p.x - x * p.y;
        let pivot = Matrix3::new(
            self.m22.m11 + k.x + ma * a - x(q.m11, q.m12, q.m13),
            gz + ma * b - y(q.m11, q.m12, q.m13),
            -g.y - z(q.m11, q.m12),
            ma * b - gz - x(q.m21, q.m22, q.m23),
            self.m22.m22 + k.y + mb * b - y(q.m21, q.m22, q.m23),
            g.x - z(q.m21, q.m22),
            g.y - x(q.m31, q.m32, q.m33),
            -g.x - y(q.m31, q.m32, q.m33),
            self.m22.m33 + k.z - z(q.m31, q.m32),
        );
        let dw = transform(&inverse3(&pivot), &(t - transform(q, &f)));
        let rest = Vector3::new(
            f.x - (xy12 * dw.y - cya * dw.x - p.y * dw.z),
            f.y - (yx12 * dw.x + cxb * dw.y + p.x * dw.z),
            f.z - (zx12 * dw.x + zy12 * dw.y),
        );
        let dv = transform(i, &rest);
        Twist {
            linear: Vector3::new(dv.x, dv.y, dv.z - (a * dw.x + b * dw.y)),
            angular: dw,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{DryMass, ImmersedBody};
    use crate::dynamics::constants::BodyConstants;
    use crate::fluid::Fluid;
    use crate::hydro::HydroProperties;
    use crate::hydro::viscous::terms::Evaluate;
    use rapier3d::parry::shape::SharedShape;

    /// Against the general path, which builds the 6×6 matrix from its definition.
    #[test]
    fn equals_the_general_path() {
        let shape = SharedShape::cuboid(0.04, 0.02, 0.001);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let dry = DryMass {
            mass: 1e-3,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(1.3e-7, 5.3e-7, 6.6e-7)),
        };
        let body = ImmersedBody::new(hydro);
        for fluid in [Fluid::AIR, Fluid::WATER] {
            let constants = BodyConstants::new(&body, &dry, &fluid).unwrap();
            assert!(constants.symmetric);
            let twist = |i: f64| Twist {
                linear: Vector3::new((1.1 * i).sin(), (2.3 * i).cos(), (0.7 * i).sin()),
                angular: Vector3::new((3.1 * i).cos(), (1.9 * i).sin(), (0.3 * i).cos()),
            };
            for i in 0..50 {
                let i = f64::from(i);
                let (start, middle) = (twist(i), twist(i + 0.1));
                let load = Wrench {
                    force: twist(2.0 * i).linear,
                    torque: twist(2.0 * i).angular,
                };
                let terms = constants.law.terms(&middle.linear, &middle.angular);
                let args = (&terms, &start, &middle, &load);
                let [general, written] = [false, true].map(|symmetric| {
                    let (terms, start, middle, load) = args;
                    let inertia = &constants.inertia;
                    if symmetric {
                        inertia.increment::<true>(terms, start, middle, load, 0.02, 0.6)
                    } else {
                        inertia.increment::<false>(terms, start, middle, load, 0.02, 0.6)
                    }
                });
                let miss = written.add_scaled(&general, -1.0);
                let size = general.linear.norm() + general.angular.norm();
                assert!(miss.linear.norm() + miss.angular.norm() < 1e-12 * size);
            }
        }
    }
}
