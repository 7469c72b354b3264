//! The bodies that `drop` releases: shape, mass, and the numbers that describe them.

use super::cli::Lengths;
use super::{Quat, Vec3, mesh};
use clap::ValueEnum;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::SharedShape;
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3, Vector3};
use rapier3d_immersed::{DryMass, Fluid, HydroProperties};
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// Shapes by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShapeName {
    /// Thin elliptic plate: --size major,minor,thickness
    Ellipse,
    /// Circular plate, coin: --size diameter,thickness
    Disc,
    /// Rectangular plate: --size x,y,z; the thinnest extent is the thickness whatever the order
    Plate,
    /// Box: --size x,y,z, released with y up
    Box,
    /// --size diameter
    Sphere,
    /// --size x,y,z, released with y up
    Ellipsoid,
    /// --mesh FILE
    Mesh,
}

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

/// Which definition of the dimensionless moment of inertia fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outline {
    Round,
    Rectangular,
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
    outline: Outline,
    /// Orientation at a release angle of zero.
    level: Quat,
}

impl Specimen {
    /// Makes a body from `--shape`, `--size`, `--mesh` and its `--scale`.
    ///
    /// # Errors
    /// The flag to blame and what is wrong.
    pub fn new(
        shape: ShapeName,
        size: Option<&Lengths>,
        file: Option<&Path>,
        scale: Option<f64>,
        sheet_thickness: f64,
    ) -> Result<Self, (&'static str, String)> {
        if shape == ShapeName::Mesh {
            let path = file.ok_or(("--mesh", "--shape mesh needs a file".to_string()))?;
            if size.is_some() {
                return Err(("--size", "a mesh has its own size".into()));
            }
            let body = Self::from_mesh(path, scale, sheet_thickness);
            return body.map_err(|problem| ("--mesh", problem));
        }
        if scale.is_some() {
            return Err(("--scale", "only with --mesh".into()));
        }
        if file.is_some() {
            return Err(("--mesh", "only with --shape mesh".into()));
        }
        let size = size.ok_or(("--size", "is required for this shape".to_string()))?;
        Self::from_size(shape, &size.0).map_err(|problem| ("--size", problem))
    }

    fn from_size(shape: ShapeName, size: &[f64]) -> Result<Self, String> {
        let wrong = |form: &str| format!("this shape takes {form}, not {} lengths", size.len());
        match (shape, size) {
            (ShapeName::Ellipse, [major, minor, thickness]) => {
                if minor > major {
                    return Err("major,minor,thickness: the minor axis is longer".into());
                }
                if thickness > minor {
                    return Err("major,minor,thickness: thicker than its minor axis".into());
                }
                let surface = elliptic_plate(*major, *minor, *thickness)?;
                let hydro = HydroProperties::from_surface(&surface, Vector3::zeros());
                let volume = PI / 4.0 * major * minor * thickness;
                let (a2, b2, t2) = (
                    major * major / 16.0,
                    minor * minor / 16.0,
                    thickness * thickness / 12.0,
                );
                let inertia = Vec3::new(b2 + t2, a2 + b2, a2 + t2) * volume;
                Ok(Self::built(
                    hydro,
                    volume,
                    inertia,
                    *thickness,
                    *minor,
                    Outline::Round,
                    true,
                ))
            }
            (ShapeName::Ellipse, _) => Err(wrong("major,minor,thickness")),
            (ShapeName::Disc, [diameter, thickness]) => {
                let half = *thickness as f32 / 2.0;
                let shape = SharedShape::cylinder(half, *diameter as f32 / 2.0);
                let hydro = from_shape(&shape)?;
                let volume = PI / 4.0 * diameter * diameter * thickness;
                let across = diameter * diameter / 16.0 + thickness * thickness / 12.0;
                let inertia = Vec3::new(across, diameter * diameter / 8.0, across) * volume;
                Ok(Self::built(
                    hydro,
                    volume,
                    inertia,
                    *thickness,
                    *diameter,
                    Outline::Round,
                    true,
                ))
            }
            (ShapeName::Disc, _) => Err(wrong("diameter,thickness")),
            (ShapeName::Plate | ShapeName::Box, [x, y, z]) => {
                let half = [x, y, z].map(|e| *e as f32 / 2.0);
                let hydro = from_shape(&SharedShape::cuboid(half[0], half[1], half[2]))?;
                let volume = x * y * z;
                let inertia =
                    Vec3::new(y * y + z * z, z * z + x * x, x * x + y * y) * (volume / 12.0);
                let [thin, middle, _] = sorted([*x, *y, *z]);
                let flat = shape == ShapeName::Plate;
                Ok(Self::built(
                    hydro,
                    volume,
                    inertia,
                    thin,
                    middle,
                    Outline::Rectangular,
                    flat,
                ))
            }
            (ShapeName::Plate | ShapeName::Box, _) => Err(wrong("x,y,z")),
            (ShapeName::Sphere, [diameter]) => {
                let hydro = from_shape(&SharedShape::ball(*diameter as f32 / 2.0))?;
                let volume = PI / 6.0 * diameter.powi(3);
                let inertia = Vec3::repeat(diameter * diameter / 10.0 * volume);
                Ok(Self::built(
                    hydro,
                    volume,
                    inertia,
                    *diameter,
                    *diameter,
                    Outline::Round,
                    false,
                ))
            }
            (ShapeName::Sphere, _) => Err(wrong("a diameter")),
            (ShapeName::Ellipsoid, [x, y, z]) => {
                let surface = ellipsoid([*x, *y, *z])?;
                let hydro = HydroProperties::from_surface(&surface, Vector3::zeros());
                let volume = PI / 6.0 * x * y * z;
                let inertia =
                    Vec3::new(y * y + z * z, z * z + x * x, x * x + y * y) * (volume / 20.0);
                let [thin, middle, _] = sorted([*x, *y, *z]);
                Ok(Self::built(
                    hydro,
                    volume,
                    inertia,
                    thin,
                    middle,
                    Outline::Round,
                    false,
                ))
            }
            (ShapeName::Ellipsoid, _) => Err(wrong("x,y,z")),
            (ShapeName::Mesh, _) => Err("a mesh has its own size".into()),
        }
    }

    fn from_mesh(path: &Path, scale: Option<f64>, sheet_thickness: f64) -> Result<Self, String> {
        let solid = mesh::load_scaled(path, scale)?
            .solid(sheet_thickness)
            .map_err(|problem| format!("{}: {problem}", path.display()))?;
        let solid = mesh::aligned(&solid);
        let hydro = HydroProperties::from_surface(&solid, Vector3::zeros());
        let integrals = solid.volume_integrals();
        let planform = &hydro.planform;
        let (thickness, length) = (planform.thickness, 2.0 * planform.half_extents.y);
        let inertia = integrals.unit_inertia().diagonal();
        Ok(Self::built(
            hydro,
            integrals.volume,
            inertia,
            thickness,
            length,
            Outline::Round,
            true,
        ))
    }

    fn built(
        hydro: HydroProperties,
        volume: f64,
        unit_inertia: Vec3,
        thickness: f64,
        length: f64,
        outline: Outline,
        flat: bool,
    ) -> Self {
        // Lying flat: the plate normal up, the long axis along x.
        let lying = Matrix3::from_columns(&[Vec3::x(), -Vec3::z(), Vec3::y()]);
        let to_plate = hydro.planform.axes.matrix().transpose();
        let level = if flat {
            Quat::from_rotation_matrix(&Rotation3::from_matrix_unchecked(lying * to_plate))
        } else {
            Quat::identity()
        };
        Self {
            volume,
            unit_inertia: Matrix3::from_diagonal(&unit_inertia),
            thickness,
            length,
            span: 2.0 * hydro.planform.half_extents.x,
            outline,
            level,
            hydro,
        }
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

    /// I* with the body's density, kg/m³: πρ_s t/(64ρ_f d) for round bodies (d the diameter or minor
    /// axis), 8ρ_s(a² + b²)b/(3πρ_f a³) for plates and boxes (a the chord, b the thickness).
    pub fn i_star(&self, density: f64, fluid: &Fluid) -> f64 {
        let ratio = density / f64::from(fluid.density());
        let (a, b) = (self.length, self.thickness);
        match self.outline {
            Outline::Round => PI * ratio * b / (64.0 * a),
            Outline::Rectangular => 8.0 * ratio * (a * a + b * b) * b / (3.0 * PI * a.powi(3)),
        }
    }

    /// U0 = √(|ρ_s/ρ_f − 1| g t), m/s.
    pub fn u0(&self, density: f64, fluid: &Fluid, gravity: f64) -> f64 {
        ((density / f64::from(fluid.density()) - 1.0).abs() * gravity * self.thickness).sqrt()
    }
}

fn from_shape(shape: &SharedShape) -> Result<HydroProperties, String> {
    HydroProperties::from_shape(&**shape).map_err(|error| error.to_string())
}

fn sorted(mut lengths: [f64; 3]) -> [f64; 3] {
    lengths.sort_by(f64::total_cmp);
    lengths
}

/// An elliptic cylinder, x along the major axis, y the thickness; a polygon of the same area.
fn elliptic_plate(major: f64, minor: f64, thickness: f64) -> Result<Surface, String> {
    const AROUND: u32 = 96;
    let step = TAU / f64::from(AROUND);
    let grow = (step / step.sin()).sqrt();
    let mut vertices = Vec::new();
    for y in [0.5 * thickness, -0.5 * thickness] {
        vertices.push(Vec3::new(0.0, y, 0.0));
        vertices.extend((0..AROUND).map(|i| {
            let (sin, cos) = (step * f64::from(i)).sin_cos();
            Vec3::new(0.5 * major * grow * cos, y, 0.5 * minor * grow * sin)
        }));
    }
    let below = AROUND + 1;
    let mut triangles = Vec::new();
    for i in 0..AROUND {
        let (a, b) = (1 + i, 1 + (i + 1) % AROUND);
        triangles.push([0, b, a]);
        triangles.push([below, below + a, below + b]);
        triangles.push([a, b, below + b]);
        triangles.push([a, below + b, below + a]);
    }
    Surface::new(&vertices, &triangles).map_err(|error| error.to_string())
}

/// An ellipsoid of full extents x, y, z; a polyhedron of the same volume.
fn ellipsoid(extents: [f64; 3]) -> Result<Surface, String> {
    let ball = Surface::from_shape(&*SharedShape::ball(0.5)).map_err(|error| error.to_string())?;
    let stretch = Vec3::from(extents);
    let vertices: Vec<Vec3> = ball
        .vertices()
        .iter()
        .map(|v| v.component_mul(&stretch))
        .collect();
    Surface::new(&vertices, ball.triangles()).map_err(|error| error.to_string())
}
