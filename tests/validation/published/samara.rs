//! A maple seed.

use rapier3d_immersed::rapier3d::math::{Pose, Real, Vector};
use rapier3d_immersed::rapier3d::na::{Isometry3, Matrix3, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::{DryMass, Error, HydroProperties, ImmersedBody, Part};

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

/// Full extents of the wing, m, and its mass without the spar, kg.
const WING: ([f64; 3], f64) = ([0.032, 0.011, 1.5e-4], 2e-5);
/// Middle of the wing, m, from that of the nut.
const MIDDLE: [f64; 3] = [0.018, 0.0025, 0.0];
/// Strips of the wing.
const STRIPS: usize = 6;

/// A maple seed: a wing of 32 × 11 mm and 20 mg with a spar of 20 mg along its front edge, and a nut of
/// 100 mg at its root; 38.5 mm long over all. Frame: x along the wing, y to its rear edge, z its normal.
///
/// The nut is flush with the front edge, as that of a maple's is, so that the center of mass is 27 % of the chord behind it:
/// why a samara turns at all (Norberg, *Biol. Rev.* 48, 561 (1973)). With the nut in the middle of the chord (the center of mass at
/// 57 %) it glides down nut first instead.
///
/// The wing is divided into strips, since its tip goes ten times as fast through the air as its root.
///
/// # Errors
/// None for these numbers.
pub fn samara() -> Result<(ImmersedBody, DryMass), Error> {
    let (body, mass) = as_one_plate()?;
    let at = Isometry3::translation(MIDDLE[0], MIDDLE[1], MIDDLE[2]);
    let strips = HydroProperties::strips_of_shape(cuboid(WING.0).as_ref(), STRIPS)?;
    let nut = HydroProperties::from_shape(cuboid(NUT.0).as_ref())?;
    let wing = strips.into_iter().map(|strip| Part::new(strip).at(at));
    Ok((body.with_parts(wing.chain([Part::new(nut)])), mass))
}

/// The same as a single plate of the outline of both, whose lift is that of its middle.
///
/// # Errors
/// None for these numbers.
pub fn as_one_plate() -> Result<(ImmersedBody, DryMass), Error> {
    let at = Vector::new(MIDDLE[0] as Real, MIDDLE[1] as Real, MIDDLE[2] as Real);
    let shape = SharedShape::compound(vec![
        (Pose::from_translation(at), cuboid(WING.0)),
        (Pose::IDENTITY, cuboid(NUT.0)),
    ]);
    let front = [MIDDLE[0], MIDDLE[1] - 0.45 * WING.0[1], MIDDLE[2]];
    let mass = box_mass(WING.0, WING.1, MIDDLE)
        .combined(&box_mass(NUT.0, NUT.1, [0.0; 3]))
        .combined(&box_mass([WING.0[0], 1e-3, 1e-3], 2e-5, front));
    let hydro = HydroProperties::from_shape(shape.as_ref())?;
    Ok((ImmersedBody::new(hydro), mass))
}

fn cuboid(size: [f64; 3]) -> SharedShape {
    let [x, y, z] = size.map(|x| (0.5 * x) as Real);
    SharedShape::cuboid(x, y, z)
}
