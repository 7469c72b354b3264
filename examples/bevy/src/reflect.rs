//! How inspectors see types of rapier3d_immersed: field by field, as `bevy_rapier3d::reflect` does with rapier's. A field that is
//! missing here does not compile.

use bevy::prelude::*;
use bevy::reflect::reflect_remote;
use rapier3d_immersed::turbulence::LangevinMode;
use rapier3d_immersed::{
    ForceAndTorque, ForceBreakdown, ForceFactors, PhysicalLaw, StochasticLaw, ThesisLaw, ViscousLaw,
};

/// [`ViscousLaw`], reflected.
#[reflect_remote(ViscousLaw)]
#[derive(Clone, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub enum ViscousLawWrapper {
    /// See [`ViscousLaw::Inviscid`].
    Inviscid,
    /// See [`ViscousLaw::Physical`].
    Physical(#[reflect(remote = PhysicalLawWrapper)] PhysicalLaw),
    /// See [`ViscousLaw::Thesis`].
    Thesis(#[reflect(remote = ThesisLawWrapper)] ThesisLaw),
    /// See [`ViscousLaw::Stochastic`].
    Stochastic(#[reflect(remote = StochasticLawWrapper)] StochasticLaw),
}

/// [`LangevinMode`], reflected.
#[reflect_remote(LangevinMode)]
#[derive(Clone, Debug, PartialEq)]
#[reflect(Clone, Debug, PartialEq)]
pub enum LangevinModeWrapper {
    /// See [`LangevinMode::FluidSeen`].
    FluidSeen,
    /// See [`LangevinMode::BodyIncrements`].
    BodyIncrements,
    /// See [`LangevinMode::FractionalStep`].
    FractionalStep,
}

/// [`PhysicalLaw`], reflected.
#[reflect_remote(PhysicalLaw)]
#[derive(Clone, Debug, Default, PartialEq)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct PhysicalLawWrapper {
    /// See [`PhysicalLaw::pressure_travel`].
    pub pressure_travel: f64,
    /// See [`PhysicalLaw::lift_slope`].
    pub lift_slope: f64,
    /// See [`PhysicalLaw::vortex_lift`].
    pub vortex_lift: f64,
    /// See [`PhysicalLaw::stalled_lift`].
    pub stalled_lift: f64,
    /// See [`PhysicalLaw::stalled_lift_narrow`].
    pub stalled_lift_narrow: f64,
    /// See [`PhysicalLaw::steady_lift`].
    pub steady_lift: f64,
    /// See [`PhysicalLaw::steady_rate`].
    pub steady_rate: f64,
    /// See [`PhysicalLaw::stall_sine`].
    pub stall_sine: f64,
    /// See [`PhysicalLaw::stall_aspect`].
    pub stall_aspect: f64,
    /// See [`PhysicalLaw::stall_limit`].
    pub stall_limit: f64,
    /// See [`PhysicalLaw::stall_width`].
    pub stall_width: f64,
    /// See [`PhysicalLaw::pitch_stall`].
    pub pitch_stall: f64,
    /// See [`PhysicalLaw::pitch_stall_narrow`].
    pub pitch_stall_narrow: f64,
    /// See [`PhysicalLaw::stall_delay`].
    pub stall_delay: f64,
    /// See [`PhysicalLaw::pressure_retreat`].
    pub pressure_retreat: f64,
    /// See [`PhysicalLaw::stalled_travel`].
    pub stalled_travel: f64,
    /// See [`PhysicalLaw::stalled_travel_narrow`].
    pub stalled_travel_narrow: f64,
    /// See [`PhysicalLaw::travel_onset`].
    pub travel_onset: f64,
    /// See [`PhysicalLaw::rotational_stall`].
    pub rotational_stall: f64,
    /// See [`PhysicalLaw::rotational_stall_narrow`].
    pub rotational_stall_narrow: f64,
    /// See [`PhysicalLaw::munk`].
    pub munk: f64,
    /// See [`PhysicalLaw::attached_damping`].
    pub attached_damping: f64,
    /// See [`PhysicalLaw::roll_damping`].
    pub roll_damping: f64,
    /// See [`PhysicalLaw::roll_damping_narrow`].
    pub roll_damping_narrow: f64,
    /// See [`PhysicalLaw::translation_damping`].
    pub translation_damping: f64,
    /// See [`PhysicalLaw::translation_damping_narrow`].
    pub translation_damping_narrow: f64,
    /// See [`PhysicalLaw::rotation_damping`].
    pub rotation_damping: f64,
    /// See [`PhysicalLaw::rotation_damping_narrow`].
    pub rotation_damping_narrow: f64,
    /// See [`PhysicalLaw::friction`].
    pub friction: f64,
    /// See [`PhysicalLaw::edge_drag`].
    pub edge_drag: f64,
    /// See [`PhysicalLaw::lift_onset`].
    pub lift_onset: f64,
    /// See [`PhysicalLaw::damping_onset`].
    pub damping_onset: f64,
    /// See [`PhysicalLaw::suction_loss`].
    pub suction_loss: f64,
    /// See [`PhysicalLaw::induced_drag`].
    pub induced_drag: f64,
    /// See [`PhysicalLaw::magnus`].
    pub magnus: f64,
}

/// [`ThesisLaw`], reflected.
#[reflect_remote(ThesisLaw)]
#[derive(Clone, Debug, Default, PartialEq)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct ThesisLawWrapper {
    /// See [`ThesisLaw::drag`].
    pub drag: f64,
    /// See [`ThesisLaw::rotational_lift`].
    pub rotational_lift: f64,
    /// See [`ThesisLaw::translational_lift`].
    pub translational_lift: f64,
    /// See [`ThesisLaw::regularisation`].
    pub regularisation: f64,
    /// See [`ThesisLaw::damping`].
    pub damping: f64,
}

/// [`StochasticLaw`], reflected.
#[reflect_remote(StochasticLaw)]
#[derive(Clone, Debug, Default, PartialEq)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct StochasticLawWrapper {
    /// See [`StochasticLaw::drag`].
    pub drag: f64,
    /// See [`StochasticLaw::lift`].
    pub lift: f64,
    /// See [`StochasticLaw::arm`].
    pub arm: f64,
    /// See [`StochasticLaw::damping`].
    pub damping: f64,
}

/// [`ForceFactors`], reflected.
#[reflect_remote(ForceFactors<f32>)]
#[derive(Clone, Debug, Default, PartialEq)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct ForceFactorsWrapper {
    /// See [`ForceFactors::drag`].
    pub drag: f32,
    /// See [`ForceFactors::rotational_lift`].
    pub rotational_lift: f32,
    /// See [`ForceFactors::translational_lift`].
    pub translational_lift: f32,
}

/// [`ForceAndTorque`], reflected.
#[reflect_remote(ForceAndTorque)]
#[derive(Clone, Debug, Default, PartialEq)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct ForceAndTorqueWrapper {
    /// See [`ForceAndTorque::force`].
    pub force: Vec3,
    /// See [`ForceAndTorque::torque`].
    pub torque: Vec3,
}

/// [`ForceBreakdown`], reflected.
#[reflect_remote(ForceBreakdown)]
#[derive(Clone, Debug, Default, PartialEq)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct ForceBreakdownWrapper {
    /// See [`ForceBreakdown::added_mass`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub added_mass: ForceAndTorque,
    /// See [`ForceBreakdown::drag`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub drag: ForceAndTorque,
    /// See [`ForceBreakdown::translational_lift`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub translational_lift: ForceAndTorque,
    /// See [`ForceBreakdown::rotational_lift`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub rotational_lift: ForceAndTorque,
    /// See [`ForceBreakdown::damping`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub damping: ForceAndTorque,
    /// See [`ForceBreakdown::buoyancy`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub buoyancy: ForceAndTorque,
    /// See [`ForceBreakdown::thrust`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub thrust: ForceAndTorque,
    /// See [`ForceBreakdown::weight`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub weight: ForceAndTorque,
    /// See [`ForceBreakdown::turbulence`].
    #[reflect(remote = ForceAndTorqueWrapper)]
    pub turbulence: ForceAndTorque,
    /// See [`ForceBreakdown::angle_of_attack`].
    pub angle_of_attack: f32,
}
