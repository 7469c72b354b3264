//! What a step needs of the parts of one body in one fluid, made once.

use crate::body::{ImmersedBody, Part};
use crate::fluid::Fluid;
use crate::hydro::part_law::PreparedPart;
use crate::hydro::part_law::place::{CoupledMass, HingePlace, PartPlace};
use crate::hydro::{AddedMass, HydroProperties, PartLaw};
use rapier3d::na::{Matrix3, Rotation3, Vector3};

/// What a step needs of one part, `f64` or `f32`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PartConstants<K> {
    pub place: PartPlace<K>,
    pub law: PreparedPart<K>,
    pub hinge: Option<HingePlace<K>>,
}

impl PartConstants<f64> {
    /// Of a part of a body whose center of mass, plate axes and scales these are.
    pub fn new(part: &Part, body: &ImmersedBody, fluid: &Fluid, frame: &BodyFrame) -> Self {
        let of_body = PartLaw::Viscous(body.law);
        let law = part.law.as_ref().unwrap_or(&of_body);
        let (law, point, axes) = law.prepare(&part.hydro, fluid, frame.mass, frame.length);
        let to_plate = frame.axes.inverse();
        let from_center = |p: Vector3<f64>| to_plate * (p - frame.center) / frame.length;
        Self {
            place: PartPlace {
                position: from_center(part.pose.transform_point(&point.into()).coords),
                turn: to_plate.matrix() * part.pose.rotation.to_rotation_matrix().matrix() * axes,
            },
            law,
            hinge: part.hinge.map(|hinge| HingePlace {
                point: from_center(hinge.point),
                axis: to_plate * hinge.axis,
            }),
        }
    }

    /// The nearest constants in f32.
    pub fn rounded(&self) -> PartConstants<f32> {
        PartConstants {
            place: self.place.rounded(),
            law: self.law.rounded(),
            hinge: self.hinge.map(|hinge| hinge.rounded()),
        }
    }
}

impl PartConstants<f32> {
    /// Whether every constant is a finite number.
    pub fn is_finite(&self) -> bool {
        let hinge = self.hinge.is_none_or(|hinge| hinge.is_finite());
        self.place.is_finite() && self.law.is_finite() && hinge
    }
}

/// What the places of a body's parts are given in.
pub(crate) struct BodyFrame {
    /// Center of mass, m, body axes.
    pub center: Vector3<f64>,
    /// Plate axes to body axes.
    pub axes: Rotation3<f64>,
    pub mass: f64,
    pub length: f64,
}

/// The coupled mass of all parts of a body.
pub(super) fn coupled_mass(
    body: &ImmersedBody,
    density: f64,
    frame: &BodyFrame,
) -> CoupledMass<f64> {
    let to_plate = frame.axes.inverse();
    let mut coupled = AddedMass::zero();
    let (mut isotropic, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for part in &body.parts {
        let of_body = PartLaw::Viscous(body.law);
        let law = part.law.as_ref().unwrap_or(&of_body);
        let hydro = &part.hydro;
        // What is the same in all directions is felt whole, at the part's center of volume.
        let same = hydro.isotropic_added_mass() * hydro.thickness();
        let at = part.pose.transform_point(&hydro.centroid.into()).coords - frame.center;
        let of_same = AddedMass::diagonal(Vector3::repeat(same), Vector3::zeros()).about(-at);
        let own = added_mass_in_body(hydro, part, &frame.center);
        let rest = own.to_matrix6() - of_same.to_matrix6();
        coupled = coupled + AddedMass::from_matrix6(&(rest * law.munk_factor(hydro)));
        let at = to_plate * at / frame.length;
        isotropic += same;
        first += at * same;
        second += at * at.transpose() * same;
    }
    let plate = coupled.rotated(&to_plate);
    let scale = density / frame.mass;
    CoupledMass {
        m11: plate.linear * scale,
        m12: plate.coupling * (scale / frame.length),
        isotropic: isotropic * scale,
        first: first * scale,
        second: second * scale,
    }
}

/// A part's added mass about a point of the body's frame, in its axes.
pub(crate) fn added_mass_in_body(
    hydro: &HydroProperties,
    part: &Part,
    about: &Vector3<f64>,
) -> AddedMass {
    let turn = part.pose.rotation.to_rotation_matrix();
    let at = part.pose.transform_point(&hydro.reference.into()).coords;
    hydro.added_mass.rotated(&turn).about(about - at)
}
