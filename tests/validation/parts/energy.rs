//! Nothing gains energy from a still fluid, whatever it is made of and whatever the step.

use proptest::prelude::*;
use rapier3d_immersed::rapier3d::na::{
    Isometry3, Matrix3, Matrix6, Translation3, UnitQuaternion, Vector3, Vector6,
};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    CustomLaw, Damping, DragBox, DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, Part,
    PolarRow, PolarTable,
};

/// A number in (−1, 1) for each (seed, index): a linear congruence, reproducible and no more than that.
fn any(seed: u64, index: u64) -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(index);
    for _ in 0..3 {
        state ^= state >> 29;
        state = state.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    }
    (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn vector(seed: u64, index: u64) -> Vector3<f64> {
    Vector3::from_fn(|i, _| any(seed, 3 * index + i as u64))
}

fn table() -> PolarTable {
    let row = |angle: f64, lift: f64, drag: f64, moment: f64| PolarRow {
        angle,
        lift,
        drag,
        moment,
    };
    PolarTable::new(&[
        row(-15.0, -1.0, 0.2, 0.1),
        row(0.0, 0.3, 0.01, -0.08),
        row(15.0, 1.4, 0.1, -0.1),
    ])
    .unwrap()
}

fn part(seed: u64, index: u64) -> Part {
    let size = vector(seed, 5 * index).map(|x| (0.05 * (1.0 + 0.9 * x)) as f32);
    let thick = if index.is_multiple_of(2) {
        0.001
    } else {
        size.z
    };
    let hydro = HydroProperties::from_shape(&Cuboid::new(Vector::new(size.x, size.y, thick)));
    let part = Part::new(hydro.unwrap()).at(Isometry3::from_parts(
        Translation3::from(vector(seed, 5 * index + 1) * 0.5),
        UnitQuaternion::from_scaled_axis(vector(seed, 5 * index + 2) * 3.0),
    ));
    match (seed + index) % 6 {
        0 => part.with_law(table()),
        1 => {
            let areas = |i| vector(seed, 5 * index + i).map(|x| 0.01 * x * x);
            part.with_law(DragBox::new(areas(3), areas(4)).unwrap())
        }
        2 => {
            let m = Matrix6::from_fn(|i, j| any(seed, 900 + (i * 6 + j) as u64 + 40 * index));
            let skew = m - m.transpose();
            let positive = m * m.transpose() * 0.1;
            part.with_law(Damping::new(positive + skew, positive).unwrap())
        }
        3 => part.with_law(CustomLaw::projected(|m| {
            [
                m.angular.cross(&m.linear) + m.linear * 0.3,
                Vector3::x() - m.angular * m.angular.norm() * 1e-3,
            ]
        })),
        _ => part,
    }
}

/// A body of random parts under random laws, with the mass of a box.
fn body(seed: u64, parts: u64) -> (ImmersedBody, DryMass) {
    let half = Vector::new(0.3, 0.2, 0.1);
    let whole = HydroProperties::from_shape(&Cuboid::new(half)).unwrap();
    let density = 10f64.powf(2.5 + 1.5 * any(seed, 77));
    let mass = density * whole.volume;
    let dry = DryMass {
        mass,
        center: vector(seed, 80) * 0.05,
        inertia: Matrix3::from_diagonal(&Vector3::new(0.017, 0.033, 0.043)) * mass,
    };
    let parts = (0..parts).map(|index| part(seed, index));
    (ImmersedBody::new(whole).with_parts(parts), dry)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// One to sixteen parts, steps from a millisecond to a second, in air and water, without weight: the kinetic energy of body and fluid
    /// never grows by more than rounding, and all stays finite.
    #[test]
    fn parts_are_passive(seed in 0u64..1 << 40, parts in 1u64..=16, log_dt in -3.0..0.0f64, water: bool) {
        let (body, dry) = body(seed, parts);
        let fluid = if water { Fluid::WATER } else { Fluid::AIR };
        let mut free = FreeBody::new(&body, &dry, &fluid).unwrap();
        let speed = 10f64.powf(2.0 * any(seed, 91));
        free.set_velocity(vector(seed, 92) * speed, vector(seed, 93) * (10.0 * speed));
        let mut before = free.kinetic_energy();
        for step in 0..40 {
            free.step(10f64.powf(log_dt), Vector3::zeros());
            let energy = free.kinetic_energy();
            prop_assert!(energy.is_finite());
            prop_assert!(energy <= before * (1.0 + 1e-9) + 1e-20, "{step}: {before} {energy}");
            before = energy;
        }
    }
}

/// Damping that gives energy is refused, and says how much.
#[test]
fn what_pumps_is_refused() {
    let mut linear = Matrix6::identity();
    linear[(0, 1)] = 4.0;
    let error = Damping::new(linear, Matrix6::zeros())
        .unwrap_err()
        .to_string();
    assert!(error.contains("-1"), "{error}");
    let bad = Vector6::new(1.0, 1.0, 1.0, 1.0, f64::NAN, 1.0);
    assert!(Damping::diagonal(bad, Vector6::zeros()).is_err());
    let pumped = CustomLaw::new(|m| [m.linear * m.linear.norm(), Vector3::zeros()]);
    assert!(pumped.unwrap_err().to_string().contains("power"));
    let nan = CustomLaw::new(|_| [Vector3::repeat(f64::NAN), Vector3::zeros()]);
    assert!(nan.is_err());
}
