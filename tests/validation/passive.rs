//! The default law is a resistance and a turning force, whatever the state that it is asked in.

use crate::support::solid_box;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::{Fluid, FreeBody, ViscousLaw};

/// Viscous forces take energy out of body and fluid in any state, to the rounding of single precision.
#[test]
fn every_state_loses_energy() {
    // Reproducible, and no more than that: a linear congruence.
    let mut state = 7u64;
    let mut any = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for aspect in [1.0, 3.0, 29.0] {
        let size = [0.1 * aspect, 2e-4, 0.1];
        let (body, mass) = solid_box(size, 2000.0, ViscousLaw::default());
        let mut body = FreeBody::new(&body, &mass, &Fluid::WATER).unwrap();
        for _ in 0..20_000 {
            let size = 10f64.powf(4.0 * any());
            let u = Vector3::new(any(), any(), any()) * size;
            let w = Vector3::new(any(), any(), any()) * (60.0 * size);
            body.set_velocity(u, w);
            let viscous = body.forces(Vector3::zeros()).viscous();
            let vector = |v: rapier3d_immersed::rapier3d::prelude::Vector| {
                Vector3::new(v.x, v.y, v.z).map(f64::from)
            };
            let (f, t) = (vector(viscous.force), vector(viscous.torque));
            let scale = f.norm() * u.norm() + t.norm() * w.norm();
            let power = f.dot(&u) + t.dot(&w);
            assert!(power < 1e-6 * scale, "{aspect} {u} {w}: {power} of {scale}");
        }
    }
}
