//! The bodies that `drop` releases: shape, mass, and the numbers that describe them.

use super::mesh;
use super::shape::{ShapeName, Shaped, Solid};
use super::{Quat, Vec3};
use clap::ValueEnum;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::motion::{DimensionlessNumbers, Outline};
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3};
use rapier3d_immersed::{DryMass, Error, Fluid, HydroProperties};
use std::f64::consts::PI;

/// Axis of the body that stays horizontal when it is tilted for the release.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TiltAxis {
    /// The long one, along x: the chord dips, as in the experiments with falling plates
    Long,
    /// The shorter in-plane one, along z: the long axis dips, as we read the card of the thesis, § 5.4
    Short,
}

impl TiltAxis {
    /// The axis of the published cases: short for an ellipse, long for everything else.
    pub fn usual(shape: ShapeName) -> Self {
        match shape {
            ShapeName::Ellipse => Self::Short,
            _ => Self::Long,
        }
    }
}

/// A body without material: shape, volume and unit inertia, about its center of mass.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// What the fluid feels of it.
    pub hydro: HydroProperties,
    /// Volume, m³.
    pub volume: f64,
    /// Inertia at unit density about the center of mass, m⁵.
    pub unit_inertia: Matrix3<f64>,
    /// Smallest extent t, m.
    pub thickness: f64,
    /// Length L of the Reynolds numbers, m: diameter, minor axis, chord (the shorter in-plane side).
    pub length: f64,
    /// Longest extent, m.
    pub span: f64,
    /// Which definition of the dimensionless moment of inertia fits.
    pub outline: Outline,
    /// Its surface, about the center of mass.
    pub solid: Surface,
    /// Orientation at a release angle of zero.
    level: Quat,
}

/// Volume, m³, and inertia at unit density about the center of mass, m⁵.
struct Exact {
    volume: f64,
    inertia: Matrix3<f64>,
}

impl Exact {
    /// Of a body whose mean squares of the coordinates are those of a box of extents `size` times `share` over 12.
    fn new(volume: f64, size: Vec3, share: f64) -> Self {
        let square = size.component_mul(&size) * (share / 12.0);
        let inertia = Vec3::new(
            square.y + square.z,
            square.z + square.x,
            square.x + square.y,
        );
        Self {
            volume,
            inertia: Matrix3::from_diagonal(&inertia) * volume,
        }
    }

    /// Of a cylinder about y whose cross-section is an ellipse.
    fn elliptic_cylinder(major: f64, height: f64, minor: f64) -> Self {
        let volume = PI / 4.0 * major * minor * height;
        // The mean square across an ellipse is a sixteenth of its axis squared, along a box a twelfth.
        let round = (12.0_f64 / 16.0).sqrt();
        Self::new(volume, Vec3::new(major * round, height, minor * round), 1.0)
    }

    fn of(shape: ShapeName, size: &[f64]) -> Option<Self> {
        let all = || Vec3::new(size[0], size[1], size[2]);
        match shape {
            ShapeName::Ball => {
                let diameter = size[0];
                let volume = PI / 6.0 * diameter.powi(3);
                Some(Self::new(volume, Vec3::repeat(diameter), 12.0 / 20.0))
            }
            ShapeName::Box | ShapeName::Plate => Some(Self::new(all().product(), all(), 1.0)),
            ShapeName::Disc | ShapeName::Cylinder => {
                Some(Self::elliptic_cylinder(size[0], size[1], size[0]))
            }
            ShapeName::Ellipse => Some(Self::elliptic_cylinder(size[0], size[2], size[1])),
            ShapeName::Ellipsoid | ShapeName::Leaf => {
                Some(Self::new(PI / 6.0 * all().product(), all(), 12.0 / 20.0))
            }
            ShapeName::Cone | ShapeName::Capsule | ShapeName::Airplane | ShapeName::Mesh => None,
        }
    }
}

impl Specimen {
    /// Makes a body from what the command line asks for.
    ///
    /// # Errors
    /// What is wrong with its shape.
    pub fn new(shaped: &Shaped) -> Result<Self, String> {
        let Shaped {
            shape, size, solid, ..
        } = shaped;
        let (surface, exact) = match Exact::of(*shape, size) {
            Some(exact) => (shaped.surface()?, exact),
            None => integrated(shaped)?,
        };
        let hydro = match (solid, shape) {
            // The frame of a cone has its origin elsewhere.
            (Solid::Shape(shape), name) if *name != ShapeName::Cone => {
                HydroProperties::from_shape(&**shape).map_err(|error| error.to_string())?
            }
            _ => HydroProperties::from_surface(&surface, Vec3::zeros()),
        };
        let plate = &hydro.planform;
        let chord = 2.0 * plate.half_extents.y;
        let sorted = |size: &[f64]| {
            let mut size = size.to_vec();
            size.sort_by(f64::total_cmp);
            size
        };
        let (thickness, length) = match (*shape, &size[..]) {
            (ShapeName::Box | ShapeName::Plate | ShapeName::Ellipsoid | ShapeName::Leaf, size) => {
                let [thin, middle, _] = sorted(size)[..] else {
                    unreachable!("three lengths");
                };
                (thin, middle)
            }
            (ShapeName::Disc, size) => (size[1], size[0]),
            (ShapeName::Ellipse, size) => (size[2], size[1]),
            (ShapeName::Ball, size) => (size[0], size[0]),
            (ShapeName::Cylinder | ShapeName::Cone | ShapeName::Capsule, size) => {
                (size[0].min(size[1]), size[0])
            }
            (ShapeName::Airplane | ShapeName::Mesh, _) => (plate.thickness, chord),
        };
        let outline = match shape {
            ShapeName::Box | ShapeName::Plate => Outline::Rectangular,
            _ => Outline::Round,
        };
        let lies_flat = matches!(
            shape,
            ShapeName::Plate
                | ShapeName::Disc
                | ShapeName::Ellipse
                | ShapeName::Leaf
                | ShapeName::Mesh
        );
        // Lying flat: the plate normal up, the long axis along x.
        let lying = Matrix3::from_columns(&[Vec3::x(), -Vec3::z(), Vec3::y()]);
        let to_plate = plate.axes.matrix().transpose();
        let turned = |matrix| Quat::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        let level = match shape {
            // Its keel, along −z in its own frame, is down.
            ShapeName::Airplane => turned(lying),
            _ if lies_flat => turned(lying * to_plate),
            _ => Quat::identity(),
        };
        Ok(Self {
            volume: exact.volume,
            unit_inertia: exact.inertia,
            thickness,
            length,
            span: 2.0 * plate.half_extents.x,
            outline,
            solid: surface,
            level,
            hydro,
        })
    }

    /// Mass properties at a density, kg/m³.
    pub fn dry_mass(&self, density: f64) -> DryMass {
        DryMass {
            mass: density * self.volume,
            center: Vec3::zeros(),
            inertia: self.unit_inertia * density,
        }
    }

    /// Orientation for a release angle (rad): turned about the horizontal axis along which the body's
    /// `axis` lies, so that a positive angle lowers the +z side (long) or the +x end (short).
    pub fn released_at(&self, angle: f64, axis: TiltAxis) -> Quat {
        let tilt = match axis {
            TiltAxis::Long => Quat::from_axis_angle(&Vec3::x_axis(), angle),
            TiltAxis::Short => Quat::from_axis_angle(&Vec3::z_axis(), -angle),
        };
        tilt * self.level
    }

    /// U0, Re and I* at a density, kg/m³, and gravity, m/s²; d is the diameter or minor axis of what is round, a the chord of
    /// plates and boxes.
    ///
    /// # Errors
    /// Those of [`DimensionlessNumbers::new`].
    pub fn numbers(
        &self,
        density: f64,
        fluid: &Fluid,
        gravity: f64,
    ) -> Result<DimensionlessNumbers, Error> {
        let (length, thickness) = (self.length, self.thickness);
        DimensionlessNumbers::new(self.outline, length, thickness, density, fluid, gravity)
    }
}

/// A surface, and what integrals over it say. It is moved to its center of mass; a mesh, which may lie at any angle, is turned to
/// its principal axes, too.
fn integrated(shaped: &Shaped) -> Result<(Surface, Exact), String> {
    let solid = shaped.surface()?;
    let solid = if shaped.shape == ShapeName::Mesh {
        mesh::aligned(&solid)
    } else {
        let center = solid.volume_integrals().centroid;
        solid.map(|v| v - center)
    };
    let integrals = solid.volume_integrals();
    let exact = Exact {
        volume: integrals.volume,
        inertia: integrals.unit_inertia(),
    };
    Ok((solid, exact))
}
