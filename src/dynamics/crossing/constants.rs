//! What a body that is cut by boundaries of fluids needs, made once.

use super::portion::Portion;
use crate::body::{DryMass, ImmersedBody, Part};
use crate::dynamics::constants::{BodyConstants, InertiaConstants};
use crate::dynamics::part_constants::{BodyFrame, PartConstants, coupled_mass};
use crate::hydro::part_law::place::CoupledMass;
use crate::hydro::viscous::ViscousLaw;
use crate::hydro::{AddedMass, Hull, HydroProperties};
use crate::medium::Medium;
use rapier3d::na::{Matrix3, Vector3};

/// What a body that is cut needs: plate axes about its center of mass, SI units unless said otherwise.
#[derive(Clone, Debug)]
pub(crate) struct CrossingConstants {
    /// Mass scale, kg, and length scale L, m, of the integrator.
    pub mass: f64,
    pub length: f64,
    pub dry_mass: f64,
    pub dry_inertia: Matrix3<f64>,
    /// The whole body, and each of its parts; of one part the body is it.
    pub whole: CutBody,
    pub parts: Vec<CutBody>,
    /// Semi-axes of the proxy ellipsoid: how high the body is.
    pub semi_axes: Vector3<f64>,
    /// Added mass per unit density about the middle of the volume.
    pub added_mass: AddedMass,
    /// What the integrator needs besides the mass: in units of the scales.
    pub inertia: InertiaConstants<f64>,
    pub fluids: Vec<CrossingFluid>,
    /// Whether the body loses energy to waves: not in an ideal fluid.
    pub radiates: bool,
}

/// Edges that hulls on waves are divided to are at least this share of the body's length.
const LONGEST: f64 = 0.05;

/// A hull and what it displaces.
#[derive(Clone, Debug)]
pub(crate) struct CutBody {
    pub hull: Hull,
    /// Largest distance from the center of mass, and length over which waves bend its waterline, m.
    pub radius: f64,
    pub length: f64,
    /// Volume, m³, and its middle.
    pub volume: f64,
    pub middle: Vector3<f64>,
    /// What the volume of the hull is multiplied by.
    pub scale: f64,
}

/// One of the fluids, in units of the scales.
#[derive(Clone, Debug)]
pub(crate) struct CrossingFluid {
    /// kg/m³.
    pub density: f64,
    pub parts: Vec<PartConstants<f64>>,
    pub coupled: CoupledMass<f64>,
}

impl CutBody {
    fn new(hull: Hull, hydro: &HydroProperties, medium: &Medium) -> Self {
        let length = 2.0 * hydro.proxy.semi_axes.max();
        let (radius, middle) = (hull.radius(), hull.centroid());
        let scale = hydro.volume / hull.volume();
        // Waves are straight along the edges of the triangles of a hull that is cut corner by corner.
        let edge = (0.25 * medium.surface().bend()).max(LONGEST * length);
        let hull = if medium.is_plane_over(length) {
            hull
        } else {
            hull.divided(edge)
        };
        Self {
            radius,
            length,
            volume: hydro.volume,
            middle,
            scale,
            hull,
        }
    }
}

impl CrossingConstants {
    /// Of a body whose constants in the uppermost fluid these are; `None` if there is no boundary to cut it.
    pub fn new(
        body: &ImmersedBody,
        dry: &DryMass,
        medium: &Medium,
        first: &BodyConstants,
    ) -> Option<Self> {
        if !medium.has_surface() {
            return None;
        }
        let hydro = &body.hydro;
        let turn = first.axes.inverse();
        let about_center = |hull: &Hull| hull.posed(&turn, &(turn * -dry.center));
        let mut cut = body.clone();
        if cut.parts.is_empty() {
            cut.parts.push(Part::new(hydro.clone()));
        }
        let parts = body.parts.iter().map(|part| {
            let rotation = part.pose.rotation.to_rotation_matrix();
            let in_body = part
                .hydro
                .hull
                .posed(&rotation, &part.pose.translation.vector);
            CutBody::new(about_center(&in_body), &part.hydro, medium)
        });
        let densest = medium
            .fluids()
            .map(|fluid| fluid.density())
            .fold(0.0, f32::max);
        let added_mass = hydro.added_mass_about(hydro.centroid).rotated(&turn);
        let mass = dry.mass + f64::from(densest) * added_mass.linear.trace() / 3.0;
        let frame = BodyFrame {
            center: dry.center,
            axes: first.axes,
            mass,
            length: first.length,
        };
        let fluids = medium.fluids().map(|fluid| CrossingFluid {
            density: fluid.density().into(),
            parts: cut
                .parts
                .iter()
                .map(|part| PartConstants::new(part, &cut, fluid, &frame))
                .collect(),
            coupled: coupled_mass(&cut, fluid.density().into(), &frame),
        });
        Some(Self {
            mass,
            length: first.length,
            dry_mass: dry.mass,
            dry_inertia: turn.matrix() * dry.inertia * first.axes.matrix(),
            whole: CutBody::new(about_center(&hydro.hull), hydro, medium),
            parts: parts.collect(),
            semi_axes: hydro.proxy.semi_axes,
            added_mass,
            inertia: InertiaConstants {
                dry_mass: dry.mass / mass,
                ..first.inertia
            },
            fluids: fluids.collect(),
            radiates: body.law != ViscousLaw::Inviscid,
        })
    }

    /// What of the body is in a layer, of whose parts this is.
    pub fn of_body(&self, own: &[Portion]) -> Portion {
        if let [whole] = own {
            return *whole;
        }
        let nothing = (0.0, Vector3::zeros());
        let (volume, moment) =
            self.parts
                .iter()
                .zip(own)
                .fold(nothing, |(volume, moment), (part, own)| {
                    let under = part.volume * own.share;
                    let middle = part.middle + own.shift;
                    (volume + under, moment + middle * under)
                });
        let shift = if volume > 0.0 {
            moment / volume - self.whole.middle
        } else {
            Vector3::zeros()
        };
        Portion {
            share: volume / self.whole.volume,
            shift,
        }
    }

    /// Number of parts, at least one.
    pub fn part_count(&self) -> usize {
        self.parts.len().max(1)
    }
}
