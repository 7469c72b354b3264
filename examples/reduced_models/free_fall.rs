//! Bodies that fall from rest by the crate's own dynamics: what the surrogates stand for.

use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::{Matrix3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::reduced::Axis;
use rapier3d_immersed::{
    DryMass, Error, Fluid, FreeBody, HydroProperties, ImmersedBody, Integrator, ThesisLaw,
    ViscousLaw,
};

/// m/s², world axes: z is up.
pub const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -9.81);

/// Which law, and with it the parameters.
#[derive(Clone, Copy, PartialEq)]
pub enum Law {
    /// Parameters C_D, C_L1, C_L2, density ratio, release angle; the long axis dips. The force along
    /// (ω × u) × u is a pseudovector: it drives every motion out of its plane.
    Thesis,
    /// Parameters density ratio, release angle; the chord dips. The motion stays in the plane y–z.
    Default,
}

/// A thin ellipsoid in a fluid, its long axis along x and its normal along z.
#[derive(Clone)]
pub struct Specimen {
    pub semi_axes: Vector3<f64>,
    pub fluid: Fluid,
    pub law: Law,
    /// Longest step of the integrator, s.
    pub step: f64,
    hydro: HydroProperties,
}

impl Specimen {
    pub fn new(semi_axes: [f64; 3], fluid: Fluid, law: Law) -> Result<Self, Error> {
        let semi_axes = Vector3::from(semi_axes);
        let ball = SharedShape::ball(1.0);
        let surface = Surface::from_shape(ball.as_ref())?.map(|v| v.component_mul(&semi_axes));
        Ok(Self {
            semi_axes,
            fluid,
            law,
            step: 5e-4,
            hydro: HydroProperties::from_surface(&surface, Vector3::zeros()),
        })
    }

    /// The card of thesis Fig. 5.6 as we read it: 7 × 4 cm × 0.4 mm, in air.
    pub fn card() -> Result<Self, Error> {
        let air = Fluid::new(1.2, 1.5e-5)?;
        Self::new([0.035, 0.02, 0.0002], air, Law::Thesis)
    }

    /// A plate of 10 × 2 cm × 1 mm in water.
    pub fn plate() -> Result<Self, Error> {
        Self::new([0.05, 0.01, 0.0005], Fluid::WATER, Law::Default)
    }

    /// The body at rest at the origin, its axes along the world's. `parameters` without the angle.
    pub fn body(&self, parameters: &[f64]) -> Result<FreeBody, Error> {
        let (law, density_ratio) = match (self.law, parameters) {
            (Law::Thesis, [a, b, c, ratio]) => {
                (ViscousLaw::Thesis(ThesisLaw::new([*a, *b, *c])), *ratio)
            }
            (Law::Default, [ratio]) => (ViscousLaw::default(), *ratio),
            _ => {
                return Err(Error::WrongLength {
                    what: "parameters of the law",
                    expected: if self.law == Law::Thesis { 4 } else { 1 },
                    actual: parameters.len(),
                });
            }
        };
        let semi_axes = self.semi_axes;
        let volume = Ellipsoid { semi_axes }.volume();
        let mass = density_ratio * f64::from(self.fluid.density()) * volume;
        let [a, b, c] = semi_axes.map(|s| s * s).into();
        let dry = DryMass {
            mass,
            center: Vector3::zeros(),
            inertia: Matrix3::from_diagonal(&Vector3::new(b + c, a + c, a + b)) * (mass / 5.0),
        };
        let body = ImmersedBody::new(self.hydro.clone()).with_law(law)?;
        let mut body = FreeBody::new(&body, &dry, &self.fluid)?;
        body.integrator = Integrator {
            iterations: 2,
            ..Integrator::default()
        };
        Ok(body)
    }

    /// How a body is held before it is released.
    pub fn orientation(&self, angle: f64) -> UnitQuaternion<f64> {
        let axis = match self.law {
            Law::Thesis => Vector3::y_axis(),
            Law::Default => Vector3::x_axis(),
        };
        UnitQuaternion::from_axis_angle(&axis, angle)
    }

    /// Calls `visit` with the body at increasing `times` (≥ 0), released from rest. `parameters` end
    /// with the release angle, rad.
    pub fn fall(
        &self,
        parameters: &[f64],
        times: &[f64],
        mut visit: impl FnMut(&FreeBody),
    ) -> Result<(), Error> {
        let (angle, parameters) = parameters.split_last().unwrap_or((&0.0, &[]));
        let mut body = self.body(parameters)?;
        body.set_orientation(self.orientation(*angle));
        self.follow(&mut body, times, &mut visit);
        Ok(())
    }

    /// Calls `visit` at increasing `times` (≥ 0) with a body that flies on from time 0.
    pub fn follow(&self, body: &mut FreeBody, times: &[f64], mut visit: impl FnMut(&FreeBody)) {
        let mut now = 0.0;
        for time in times {
            let steps = ((time - now) / self.step - 1e-9).ceil().max(0.0);
            for _ in 0..steps as usize {
                body.step((time - now) / steps, GRAVITY);
            }
            now = *time;
            visit(body);
        }
    }

    /// Horizontal positions at the times, m.
    pub fn positions(&self, parameters: &[f64], times: &[f64]) -> Result<Vec<[f64; 2]>, Error> {
        let mut positions = Vec::with_capacity(times.len());
        self.fall(parameters, times, |body| {
            positions.push([body.position.x, body.position.y]);
        })?;
        Ok(positions)
    }
}

/// A domain of parameters, named for its pattern.
pub struct Domain {
    pub name: &'static str,
    /// Centers of the coefficients, which vary by ± 5 %.
    pub coefficients: &'static [f64],
    pub density_ratio: (f64, f64),
    /// rad.
    pub release_angle: (f64, f64),
}

impl Domain {
    /// The card zigzags, everywhere (the coefficients are those of thesis Fig. 5.6c).
    pub const ZIGZAG: Self = Self {
        name: "card, thesis's law: zigzag, ρ_s/ρ_f 600 to 735",
        coefficients: &ThesisLaw::ZIGZAG,
        density_ratio: (600.0, 735.0),
        release_angle: (0.1, 0.3),
    };
    /// The card zigzags where it is released flat, and autorotates where it is released steeply.
    pub const AUTOROTATION: Self = Self {
        name: "card: across autorotation, ρ_s/ρ_f 450 to 650",
        coefficients: &ThesisLaw::AUTOROTATION,
        density_ratio: (450.0, 650.0),
        release_angle: (0.1, 0.35),
    };
    /// The plate flutters, everywhere.
    pub const LIGHT: Self = Self {
        name: "plate in water: ρ_s/ρ_f 2 to 2.6",
        coefficients: &[],
        density_ratio: (2.0, 2.6),
        release_angle: (0.3, 0.7),
    };
    /// The plate flutters more widely; from 5 on it turns over now and then.
    pub const HEAVY: Self = Self {
        name: "plate in water: ρ_s/ρ_f 3.8 to 4.8",
        coefficients: &[],
        density_ratio: (3.8, 4.8),
        release_angle: (0.3, 0.7),
    };

    /// Coefficients, on which forces depend linearly, and density ratio.
    pub fn body_axes(&self, coefficients: usize, ratios: usize) -> Result<Vec<Axis>, Error> {
        let centers = self.coefficients.iter();
        let mut axes = centers
            .map(|c| Axis::spectral(0.95 * c, 1.05 * c, coefficients))
            .collect::<Result<Vec<_>, _>>()?;
        let (low, high) = self.density_ratio;
        axes.push(Axis::spectral(low, high, ratios)?);
        Ok(axes)
    }

    /// All parameters: those, and the release angle.
    pub fn axes(&self, nodes: [usize; 3]) -> Result<Vec<Axis>, Error> {
        let mut axes = self.body_axes(nodes[0], nodes[1])?;
        let (low, high) = self.release_angle;
        axes.push(Axis::spectral(low, high, nodes[2])?);
        Ok(axes)
    }
}
