//! A maple seed.

use rapier3d_immersed::rapier3d::math::{Pose, Real, Vector};
use rapier3d_immersed::rapier3d::na::{Matrix3, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::{DryMass, Error, HydroProperties, ImmersedBody};

/// Full extents of the nut, m, and its mass, kg.
pub const NUT: ([f64; 3], f64) = ([0.009, 0.006, 0.003], 1e-4);

/// A solid box with edges along the axes.
pub fn box_mass(size: [f64; 3], mass: f64, center: [f64; 3]) -> DryMass {
    let [x, y, z] = size.map(|s| s * s / 12.0);
    DryMass {
        mass,
        center: Vector3::from(center),
        inertia: Matrix3::from_diagonal(&Vector3::new(y + z, z + x, x + y)) * mass,
    }
}

/// A maple seed: a wing of 32 × 11 mm and 20 mg with a spar of 20 mg along its front edge, and a nut of
/// 100 mg at its root; 38.5 mm long over all. Frame: x along the wing, z its normal.
///
/// # Errors
/// None for these numbers.
pub fn samara() -> Result<(ImmersedBody, DryMass), Error> {
    let (wing, (nut, nut_mass)) = ([0.032, 0.011, 1.5e-4], NUT);
    let middle = [0.018, -0.002, 0.0];
    let cuboid = |size: [f64; 3]| {
        let half = size.map(|x| (0.5 * x) as Real);
        SharedShape::cuboid(half[0], half[1], half[2])
    };
    let at = Vector::new(middle[0] as Real, middle[1] as Real, 0.0);
    let shape = SharedShape::compound(vec![
        (Pose::from_translation(at), cuboid(wing)),
        (Pose::IDENTITY, cuboid(nut)),
    ]);
    let front = [middle[0], middle[1] - 0.45 * wing[1], 0.0];
    let mass = box_mass(wing, 2e-5, middle)
        .combined(&box_mass(nut, nut_mass, [0.0; 3]))
        .combined(&box_mass([wing[0], 1e-3, 1e-3], 2e-5, front));
    let hydro = HydroProperties::from_shape(shape.as_ref())?;
    Ok((ImmersedBody::new(hydro), mass))
}
