//! Bodies by name, with sizes as people measure them: full extents in metres, not halves.

use super::Vec3;
use super::mesh::{self, RawMesh};
use clap::{Args, ValueEnum};
use rapier3d_immersed::geometry::{Ellipsoid, Sheet, Surface};
use rapier3d_immersed::rapier3d::geometry::SharedShape;
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Thickness of a mesh that is an open sheet, m, where none is given.
pub const SHEET_THICKNESS: f64 = 3e-4;

/// Shapes by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShapeName {
    /// Ball: diameter
    #[value(alias = "sphere")]
    Ball,
    /// Box: x,y,z; let go with y up
    Box,
    /// Rectangular plate: x,y,z; the least of them is the thickness whatever the order
    Plate,
    /// Circular plate, coin: diameter,thickness
    Disc,
    /// Elliptic plate: major,minor,thickness
    Ellipse,
    /// Cylinder about y: diameter,height
    Cylinder,
    /// Cone about y, its tip up: diameter,height
    Cone,
    /// Capsule about y: diameter,height over all
    Capsule,
    /// Ellipsoid: x,y,z; let go with y up
    Ellipsoid,
    /// Thin ellipsoid, by default as large as the thesis's leaf: length,width,thickness
    Leaf,
    /// Dart of folded paper, by default the thesis's: side,thickness of the paper
    Airplane,
    /// Mesh of your own: --mesh FILE has its size
    Mesh,
}

impl ShapeName {
    /// What its lengths are called, and those that it has by default, m.
    pub fn sizes(self) -> (&'static str, &'static [f64]) {
        match self {
            Self::Ball => ("diameter", &[0.1]),
            Self::Box => ("x,y,z", &[0.1, 0.1, 0.1]),
            Self::Plate => ("x,y,z", &[0.1, 0.001, 0.05]),
            Self::Disc => ("diameter,thickness", &[0.02, 0.0015]),
            Self::Ellipse => ("major,minor,thickness", &[0.073, 0.042, 0.0003]),
            Self::Cylinder | Self::Cone | Self::Capsule => ("diameter,height", &[0.1, 0.2]),
            Self::Ellipsoid => ("x,y,z", &[0.3, 0.2, 0.1]),
            Self::Leaf => ("length,width,thickness", &[0.073, 0.042, 0.0003]),
            Self::Airplane => ("side,thickness", &[0.083, 0.0001]),
            Self::Mesh => ("", &[]),
        }
    }

    /// The word on the command line.
    pub fn word(self) -> String {
        let value = self.to_possible_value().expect("no shape is hidden");
        value.get_name().to_owned()
    }
}

/// One to three lengths, `A[,B[,C]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Lengths(pub Vec<f64>);

/// Parses [`Lengths`], each above zero.
pub fn lengths(text: &str) -> Result<Lengths, String> {
    let values: Vec<f64> = text
        .split(',')
        .map(super::cli::positive)
        .collect::<Result<_, _>>()?;
    if values.len() > 3 {
        return Err("must be one to three lengths: A[,B[,C]]".into());
    }
    Ok(Lengths(values))
}

/// A mesh from a file.
#[derive(Args, Clone, Debug, Default)]
pub struct MeshArgs {
    /// OBJ or STL file of a body of your own: a closed solid, or an open sheet (see --thickness)
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Metres per unit of the --mesh, such as 0.001 for millimetres [default: 1, up to 10 m]
    #[arg(long, value_name = "M", value_parser = super::cli::positive, requires = "mesh")]
    pub scale: Option<f64>,
    /// Thickness of a --mesh that is an open sheet, m [default: 0.0003]
    #[arg(long, value_name = "M", value_parser = super::cli::positive, requires = "mesh")]
    pub thickness: Option<f64>,
}

impl MeshArgs {
    /// Thickness of an open sheet, m.
    pub fn sheet_thickness(&self) -> f64 {
        self.thickness.unwrap_or(SHEET_THICKNESS)
    }

    /// The mesh in metres, if one is asked for.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn load(&self) -> Option<Result<RawMesh, String>> {
        let path = self.mesh.as_deref()?;
        Some(mesh::load_scaled(path, self.scale))
    }
}

/// A body's shape and size.
#[derive(Args, Clone, Debug, Default)]
pub struct ShapeArgs {
    /// Shape of the body, and the lengths that its --size takes [default: leaf, or mesh with --mesh]
    #[arg(long, value_enum)]
    pub shape: Option<ShapeName>,
    /// Full extents of the body, m (diameters, not radii), in the order that --shape says [default: for ball 0.1;
    /// box 0.1,0.1,0.1; plate 0.1,0.001,0.05; disc 0.02,0.0015; ellipse and leaf 0.073,0.042,0.0003; cylinder, cone and
    /// capsule 0.1,0.2; ellipsoid 0.3,0.2,0.1; airplane 0.083,0.0001]
    #[arg(long, value_name = "A[,B[,C]]", value_parser = lengths, allow_hyphen_values = true)]
    pub size: Option<Lengths>,
    #[command(flatten)]
    pub mesh: MeshArgs,
}

/// The flag to blame and what is wrong.
pub type Problem = (&'static str, String);

/// What a body is made of.
#[derive(Clone, Debug)]
pub enum Solid {
    /// One of rapier's shapes.
    Shape(SharedShape),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid),
    /// A closed surface.
    Surface(Surface),
    /// An open mesh and its thickness, m.
    Sheet(RawMesh, f64),
    /// A sheet that is folded to an airplane: its side and thickness, m.
    Airplane(f64, f64),
}

/// A body that was asked for.
#[derive(Clone, Debug)]
pub struct Shaped {
    /// Its shape.
    pub shape: ShapeName,
    /// Name of its files: that of the shape, or of the mesh's file.
    pub name: String,
    /// Its lengths, m, as [`ShapeName::sizes`] names them.
    pub size: Vec<f64>,
    /// Its geometry.
    pub solid: Solid,
}

impl ShapeArgs {
    /// The body; a bad value ends the program.
    pub fn shaped(&self) -> Shaped {
        self.try_shaped()
            .unwrap_or_else(|(flag, problem)| super::cli::bad_value(flag, problem))
    }

    /// The body.
    ///
    /// # Errors
    /// The flag to blame and what is wrong.
    pub fn try_shaped(&self) -> Result<Shaped, Problem> {
        let shape = match (self.shape, &self.mesh.mesh) {
            (Some(shape), _) => shape,
            (None, Some(_)) => ShapeName::Mesh,
            (None, None) => ShapeName::Leaf,
        };
        let word = shape.word();
        match (shape, &self.mesh.mesh) {
            (ShapeName::Mesh, None) => return Err(("--mesh", "--shape mesh needs a file".into())),
            (ShapeName::Mesh, Some(path)) => {
                if self.size.is_some() {
                    return Err(("--size", "a mesh has its own size (see --scale)".into()));
                }
                let raw = self.mesh.load().expect("there is a file");
                let solid = raw.and_then(|raw| {
                    let problem = |problem| format!("{}: {problem}", path.display());
                    solid_of(raw, self.mesh.sheet_thickness()).map_err(problem)
                });
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                return Ok(Shaped {
                    shape,
                    name: name.into_owned(),
                    size: Vec::new(),
                    solid: solid.map_err(|problem| ("--mesh", problem))?,
                });
            }
            (_, Some(_)) => return Err(("--mesh", format!("not with --shape {word}"))),
            (_, None) => {}
        }
        let (names, usual) = shape.sizes();
        let size = self.size.as_ref().map_or(usual, |size| &size.0);
        let told = || {
            let numbers: Vec<String> = size.iter().map(f64::to_string).collect();
            numbers.join(",")
        };
        if size.len() != usual.len() {
            let problem = format!("{word} takes {names}, not {}", told());
            return Err(("--size", problem));
        }
        let solid =
            built(shape, size).map_err(|problem| ("--size", format!("{}: {problem}", told())));
        Ok(Shaped {
            shape,
            name: word,
            size: size.to_vec(),
            solid: solid?,
        })
    }
}

impl Shaped {
    /// As a closed surface: of rapier's shapes the one that the fluid feels, of sheets one with their thickness.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn surface(&self) -> Result<Surface, String> {
        match &self.solid {
            Solid::Shape(shape) => {
                Surface::from_shape(shape.as_ref()).map_err(|error| error.to_string())
            }
            Solid::Ellipsoid(body) => stretched_ball(body.semi_axes * 2.0),
            Solid::Surface(surface) => Ok(surface.clone()),
            Solid::Sheet(raw, thickness) => raw.solid(*thickness),
            Solid::Airplane(side, thickness) => {
                let sheet = Sheet::paper_airplane(*side, *thickness, 6);
                let sheet = sheet.map_err(|error| error.to_string())?;
                let raw = RawMesh {
                    vertices: sheet.vertices().to_vec(),
                    triangles: sheet.triangles().to_vec(),
                };
                raw.mitred(*thickness)
            }
        }
    }
}

/// A closed mesh as it is; an open one as a sheet that can be thickened.
fn solid_of(raw: RawMesh, thickness: f64) -> Result<Solid, String> {
    if let Ok(closed) = Surface::new(&raw.vertices, &raw.triangles) {
        return Ok(Solid::Surface(closed));
    }
    raw.solid(thickness)?;
    Ok(Solid::Sheet(raw, thickness))
}

fn built(shape: ShapeName, size: &[f64]) -> Result<Solid, String> {
    let half = |i: usize| (size[i] / 2.0) as f32;
    Ok(match shape {
        ShapeName::Ball => Solid::Shape(SharedShape::ball(half(0))),
        ShapeName::Box | ShapeName::Plate => {
            Solid::Shape(SharedShape::cuboid(half(0), half(1), half(2)))
        }
        ShapeName::Disc | ShapeName::Cylinder => {
            Solid::Shape(SharedShape::cylinder(half(1), half(0)))
        }
        ShapeName::Cone => Solid::Shape(SharedShape::cone(half(1), half(0))),
        ShapeName::Capsule if size[1] <= size[0] => {
            return Err("a capsule must be higher than its diameter".into());
        }
        ShapeName::Capsule => Solid::Shape(SharedShape::capsule_y(half(1) - half(0), half(0))),
        ShapeName::Ellipse if size[1] > size[0] => {
            return Err("major,minor,thickness: the minor axis is longer".into());
        }
        ShapeName::Ellipse if size[2] > size[1] => {
            return Err("major,minor,thickness: thicker than its minor axis".into());
        }
        ShapeName::Ellipse => Solid::Surface(elliptic_plate(size[0], size[1], size[2])?),
        ShapeName::Ellipsoid | ShapeName::Leaf => Solid::Ellipsoid(Ellipsoid {
            semi_axes: Vec3::new(size[0], size[1], size[2]) / 2.0,
        }),
        ShapeName::Airplane => {
            let sheet = Sheet::paper_airplane(size[0], size[1], 6);
            sheet.map_err(|error| error.to_string())?;
            Solid::Airplane(size[0], size[1])
        }
        ShapeName::Mesh => return Err("a mesh has its own size".into()),
    })
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
fn stretched_ball(extents: Vec3) -> Result<Surface, String> {
    let ball = Surface::from_shape(&*SharedShape::ball(0.5)).map_err(|error| error.to_string())?;
    let vertices: Vec<Vec3> = ball
        .vertices()
        .iter()
        .map(|v| v.component_mul(&extents))
        .collect();
    Surface::new(&vertices, ball.triangles()).map_err(|error| error.to_string())
}
