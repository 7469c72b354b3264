#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod admission;
mod components;
mod context;
#[cfg(feature = "debug-render")]
mod gizmos;
mod look;
mod plugin;
mod readout;
mod reflect;
mod step;
mod surroundings;

pub use components::{Description, FluidForces, GivenBody, Immersed};
pub use context::{InFluid, RapierContextImmersion, WriteImmersion};
#[cfg(feature = "debug-render")]
pub use gizmos::{ImmersedDebugRender, ImmersedDebugRenderPlugin};
pub use plugin::{ImmersedPlugin, ImmersedSet};
pub use rapier3d_immersed as immersed;
pub use readout::ImmersionWarning;
pub use reflect::{
    ForceAndTorqueWrapper, ForceBreakdownWrapper, ForceFactorsWrapper, LangevinModeWrapper,
    PhysicalLawWrapper, StochasticLawWrapper, ThesisLawWrapper, ViscousLawWrapper,
};
pub use surroundings::{
    ContextSurroundings, Medium, MediumLayer, SharedFlow, SharedSurface, SharedTurbulence,
    Turbulence, Wind,
};

/// What most apps need.
pub mod prelude {
    pub use crate::{
        ContextSurroundings, Description, FluidForces, Immersed, ImmersedPlugin, ImmersedSet,
        ImmersionWarning, Medium, MediumLayer, RapierContextImmersion, Turbulence, Wind,
        WriteImmersion,
    };
    #[cfg(feature = "debug-render")]
    pub use crate::{ImmersedDebugRender, ImmersedDebugRenderPlugin};
    pub use rapier3d_immersed::{
        Fluid, ForceFactors, HydroProperties, ImmersedBody, PhysicalLaw, StochasticLaw, ThesisLaw,
        ViscousLaw,
    };
}
