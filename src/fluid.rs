//! The fluid that bodies are immersed in.

use crate::error::Error;
use rapier3d::math::Real;

/// A homogeneous Newtonian fluid: what an [`Immersion`](crate::Immersion) or a
/// [`FreeBody`](crate::FreeBody) moves in.
///
/// ```
/// use rapier3d_immersed::Fluid;
///
/// let glycerol = Fluid::new(1258.0, 1.12e-3)?; // kg/m³, m²/s at 20 °C
/// assert!((glycerol.dynamic_viscosity() - 1.41).abs() < 0.01); // Pa·s
/// assert_eq!(Fluid::WATER.density(), 997.0);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "Unchecked")
)]
pub struct Fluid {
    density: Real,
    kinematic_viscosity: Real,
}

/// A fluid as it stands in a file.
#[cfg(feature = "serde-serialize")]
#[derive(serde::Deserialize)]
struct Unchecked {
    density: Real,
    kinematic_viscosity: Real,
}

#[cfg(feature = "serde-serialize")]
impl TryFrom<Unchecked> for Fluid {
    type Error = Error;

    fn try_from(file: Unchecked) -> Result<Self, Error> {
        Self::new(file.density, file.kinematic_viscosity)
    }
}

impl Fluid {
    /// Air at 25 °C and one atmosphere: 1.184 kg/m³, 1.562·10⁻⁵ m²/s.
    pub const AIR: Self = Self {
        density: 1.184,
        kinematic_viscosity: 1.562e-5,
    };

    /// Water at 25 °C: 997 kg/m³, 0.89·10⁻⁶ m²/s (the viscosity of the falling-plate
    /// experiments, and the one with which the coin of thesis § 3.6 has the Re that is printed).
    pub const WATER: Self = Self {
        density: 997.0,
        kinematic_viscosity: 0.89e-6,
    };

    /// A fluid of the given density (kg/m³) and kinematic viscosity (m²/s).
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if either is not positive and finite.
    pub fn new(density: Real, kinematic_viscosity: Real) -> Result<Self, Error> {
        Error::check_positive("fluid density", density.into())?;
        Error::check_positive("kinematic viscosity", kinematic_viscosity.into())?;
        Ok(Self {
            density,
            kinematic_viscosity,
        })
    }

    /// Mass density ρ, kg/m³.
    pub fn density(&self) -> Real {
        self.density
    }

    /// Kinematic viscosity ν, m²/s.
    pub fn kinematic_viscosity(&self) -> Real {
        self.kinematic_viscosity
    }

    /// Dynamic viscosity μ = ρν, Pa·s.
    pub fn dynamic_viscosity(&self) -> Real {
        self.density * self.kinematic_viscosity
    }
}
