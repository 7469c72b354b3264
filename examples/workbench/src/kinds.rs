//! What can be placed: shapes of everyday things, with their masses and what the fluid feels of them.

use crate::support::leaf::{Blade, Outline};
use crate::support::scene::Kind;
use crate::support::{Vec3, airplane};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::na::Isometry3;
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyBuilder};
use rapier3d_immersed::{DryMass, HydroProperties, ImmersedBody, Part};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A thing by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// An ellipse of 7.3 × 4.2 cm (thesis Fig. 5.14), 0.3 mm, 400 kg/m³.
    Leaf,
    /// Five lobes of 8 cm, as heavy as the leaf.
    Maple,
    /// 10.5 × 7.4 cm of 80 g/m².
    Paper,
    /// A playing card of 88 × 63 × 0.3 mm, 1000 kg/m³.
    Card,
    /// 2 cm of aluminium, 1.5 mm thick.
    Coin,
    /// A wooden disc of 10 cm, 2 mm thick.
    Disc,
    /// 20 × 12 × 0.1 mm of paper.
    Confetti,
    /// A winged seed as a maple's: a nut, and a wing of eight strips.
    Seed,
    /// The folded airplane of the thesis with a paper clip on its nose. It has one size.
    Airplane,
    /// A table-tennis ball.
    Ball,
    /// A block of wood of 8 × 5 × 5 cm, 500 kg/m³.
    Block,
}

impl Shape {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Leaf,
        Self::Maple,
        Self::Paper,
        Self::Card,
        Self::Coin,
        Self::Disc,
        Self::Confetti,
        Self::Seed,
        Self::Airplane,
        Self::Ball,
        Self::Block,
    ];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Leaf => "leaf",
            Self::Maple => "maple leaf",
            Self::Paper => "paper",
            Self::Card => "card",
            Self::Coin => "coin",
            Self::Disc => "disc",
            Self::Confetti => "confetti",
            Self::Seed => "winged seed",
            Self::Airplane => "airplane",
            Self::Ball => "ball",
            Self::Block => "block",
        }
    }

    /// Whether it is flat and of one part: what falls in patterns.
    pub const fn is_flat(self) -> bool {
        !matches!(self, Self::Seed | Self::Airplane | Self::Ball | Self::Block)
    }

    /// Linear RGB of the `index`-th one.
    pub const fn color(self, index: usize) -> [f32; 3] {
        const LEAVES: [[f32; 3]; 5] = [
            [0.62, 0.16, 0.02],
            [0.72, 0.36, 0.03],
            [0.48, 0.06, 0.03],
            [0.66, 0.50, 0.06],
            [0.24, 0.34, 0.06],
        ];
        const CONFETTI: [[f32; 3]; 4] = [
            [0.05, 0.30, 0.70],
            [0.78, 0.08, 0.30],
            [0.85, 0.62, 0.05],
            [0.05, 0.50, 0.25],
        ];
        match self {
            Self::Leaf | Self::Maple => LEAVES[index % LEAVES.len()],
            Self::Confetti => CONFETTI[index % CONFETTI.len()],
            Self::Paper | Self::Airplane => [0.86, 0.86, 0.82],
            Self::Card => [0.62, 0.05, 0.08],
            Self::Coin => [0.55, 0.56, 0.60],
            Self::Disc => [0.52, 0.33, 0.16],
            Self::Seed => [0.45, 0.30, 0.10],
            Self::Ball => [0.85, 0.45, 0.06],
            Self::Block => [0.40, 0.24, 0.11],
        }
    }

    fn make(self, size: f64) -> Result<Kind, String> {
        match self {
            Self::Leaf => blade(Outline::Elliptic, [0.073, 0.042, 3e-4], 400.0, size),
            Self::Maple => blade(Outline::Maple, [0.08, 0.08, 3e-4], 400.0, size),
            Self::Paper => blade(Outline::Rectangle, [0.105, 0.074, 1e-4], 800.0, size),
            Self::Card => blade(Outline::Rectangle, [0.088, 0.063, 3e-4], 1000.0, size),
            Self::Confetti => blade(Outline::Rectangle, [0.02, 0.012, 1e-4], 700.0, size),
            Self::Coin => solid(cylinder(0.01, 0.0015, size), 2700.0),
            Self::Disc => solid(cylinder(0.05, 0.002, size), 600.0),
            Self::Ball => solid(SharedShape::ball(0.02 * size as f32), 80.0),
            Self::Block => {
                let half = [0.04, 0.025, 0.025].map(|x: f32| x * size as f32);
                solid(SharedShape::cuboid(half[0], half[1], half[2]), 500.0)
            }
            Self::Seed => seed(size as f32),
            Self::Airplane => airplane::flying(800.0),
        }
    }
}

/// A thing of `size` times its lengths. Each is made once.
///
/// # Errors
/// What is wrong with its size.
pub fn kind(shape: Shape, size: f64) -> Result<Kind, String> {
    static MADE: Mutex<Option<HashMap<(Shape, u64), Kind>>> = Mutex::new(None);
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let made = made.get_or_insert_default();
    let key = (shape, size.to_bits());
    if let Some(known) = made.get(&key) {
        return Ok(known.clone());
    }
    let new = shape.make(size)?;
    made.insert(key, new.clone());
    Ok(new)
}

fn blade(outline: Outline, size: [f64; 3], density: f64, scale: f64) -> Result<Kind, String> {
    let [length, width, thickness] = size.map(|x| x * scale);
    let blade = Blade {
        outline,
        length,
        width,
        thickness,
        camber: [0.0; 2],
    };
    let points = outline.points(length, width, 40);
    let picture: Vec<Vec3> = points.iter().map(|p| Vec3::new(p[0], 0.0, p[1])).collect();
    let solid = blade.solid().map_err(|error| error.to_string())?;
    Kind::new(&solid, density, Some(&picture))
}

fn cylinder(radius: f64, thickness: f64, scale: f64) -> SharedShape {
    SharedShape::cylinder((0.5 * thickness * scale) as f32, (radius * scale) as f32)
}

/// A rapier shape of uniform density, kg/m³, that collides as what it is.
fn solid(shape: SharedShape, density: f64) -> Result<Kind, String> {
    let wrong = |error: rapier3d_immersed::Error| error.to_string();
    let hydro = HydroProperties::from_shape(shape.as_ref()).map_err(wrong)?;
    let mut dry = DryMass::of_shape(shape.as_ref(), density).map_err(wrong)?;
    dry.center = Vec3::zeros();
    let solid = surface(&shape)?;
    Ok(Kind {
        body: Arc::new(ImmersedBody::new(hydro)),
        dry,
        collision: shape,
        outline: Arc::new(triangles(&solid)),
        solid: Arc::new(solid),
    })
}

/// The wing along x with its front edge at z = 0, the nut flush with that edge.
fn seed(scale: f32) -> Result<Kind, String> {
    let wrong = |error: rapier3d_immersed::Error| error.to_string();
    let wing = SharedShape::cuboid(0.012 * scale, 1e-4 * scale, 0.004 * scale);
    let nut = SharedShape::ball(0.0025 * scale);
    let of_wing = Vector::new(0.012, 0.0, 0.004) * scale;
    let of_nut = Vector::Z * (0.0025 * scale);
    let mut alone = PhysicsWorld::new();
    let body = alone.insert_body(RigidBodyBuilder::dynamic());
    for (shape, at, density) in [(&wing, of_wing, 150.0), (&nut, of_nut, 800.0)] {
        let collider = ColliderBuilder::new(shape.clone()).translation(at);
        alone.insert_collider(collider.density(density), Some(body));
    }
    let hydro = HydroProperties::from_body(&alone.bodies, &alone.colliders, body).map_err(wrong)?;
    let dry = DryMass::of_body(&alone.bodies, &alone.colliders, body).map_err(wrong)?;
    let place = Isometry3::translation(of_wing.x.into(), 0.0, of_wing.z.into());
    let strips = HydroProperties::strips_of_shape(wing.as_ref(), 8).map_err(wrong)?;
    let strips = strips.into_iter().map(|strip| Part::new(strip).at(place));
    let parts = [(wing, of_wing), (nut, of_nut)];
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for (shape, at) in &parts {
        let mesh = surface(shape)?;
        let first = vertices.len() as u32;
        let shift = Vec3::new(at.x.into(), at.y.into(), at.z.into());
        vertices.extend(mesh.vertices().iter().map(|v| v + shift));
        faces.extend(mesh.triangles().iter().map(|t| t.map(|v| v + first)));
    }
    let solid = Surface::new(&vertices, &faces).map_err(wrong)?;
    let compound = parts.map(|(shape, at)| (Pose::from_translation(at), shape));
    Ok(Kind {
        body: Arc::new(ImmersedBody::new(hydro).with_parts(strips)),
        dry,
        collision: SharedShape::compound(compound.to_vec()),
        outline: Arc::new(triangles(&solid)),
        solid: Arc::new(solid),
    })
}

/// A mesh to look at.
fn surface(shape: &SharedShape) -> Result<Surface, String> {
    let (vertices, triangles) = match shape.as_ball() {
        Some(ball) => ball.to_trimesh(32, 20),
        None => match shape.as_cylinder() {
            Some(cylinder) => cylinder.to_trimesh(48),
            None => shape
                .as_cuboid()
                .ok_or("no mesh for this shape")?
                .to_trimesh(),
        },
    };
    let vertices: Vec<Vec3> = vertices
        .into_iter()
        .map(crate::support::from_rapier)
        .collect();
    Surface::new(&vertices, &triangles).map_err(|error| error.to_string())
}

fn triangles(solid: &Surface) -> Vec<Vec<Vec3>> {
    let corner = |v: &u32| solid.vertices()[*v as usize];
    let faces = solid.triangles().iter();
    faces.map(|t| t.iter().map(corner).collect()).collect()
}
