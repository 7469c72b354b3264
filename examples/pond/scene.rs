//! The pond: a channel of still air over slowly flowing water between two banks, a log that floats against two posts,
//! and leaves above.

use crate::support::leaf::{Blade, Outline};
use crate::support::scene::{Kind, Scene};
use crate::support::{Quat, Vec3, from_rapier};
use rand::{RngExt, SeedableRng};
use rapier3d_immersed::flow::{Flow, LogLaw};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::math::{Pose, Rotation, Vector};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    DryMass, Error, Fluid, HydroProperties, ImmersedBody, Immersion, Layer, Medium, preset,
};
use std::f64::consts::PI;
use std::sync::Arc;

/// Half the width of the water, m.
pub const HALF_WIDTH: f64 = 1.0;
/// Of water and banks along the current, m.
const LENGTH: f64 = 12.0;
/// Rise of the banks over the way across.
const SLOPE: f64 = 0.3;
/// Where the log floats, m along the current, and its radius and length, m: so short that its ends are clear of the banks.
const LOG: f64 = 1.35;
const LOG_RADIUS: f64 = 0.07;
const LOG_LENGTH: f64 = 1.4;
/// Where the leaves come from: along the current, m, and over the water, m.
const UPSTREAM: f64 = -2.6;
const LOWEST: f64 = 0.6;
const HIGHEST: f64 = 3.6;

const WATER: [f32; 3] = [0.10, 0.20, 0.22];
const BANK: [f32; 3] = [0.28, 0.30, 0.12];
const WOOD: [f32; 3] = [0.22, 0.13, 0.07];
const AUTUMN: [[f32; 3]; 5] = [
    [0.55, 0.16, 0.02],
    [0.70, 0.33, 0.03],
    [0.42, 0.06, 0.03],
    [0.62, 0.48, 0.06],
    [0.26, 0.30, 0.06],
];

/// A current along x, fastest in the middle and none at the banks: U (1 − z²/w²).
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// In the middle, m/s.
    pub speed: f32,
}

impl Flow for Channel {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        let across = point.z / HALF_WIDTH as f32;
        Vector::X * (self.speed * (1.0 - across * across).max(0.0))
    }

    fn vorticity(&self, point: Vector, _time: f64) -> Vector {
        let half_width = HALF_WIDTH as f32;
        let inside = point.z.abs() < half_width;
        let slope = -2.0 * self.speed * point.z / (half_width * half_width);
        Vector::Y * if inside { slope } else { 0.0 }
    }
}

/// What rains where.
#[derive(Clone, Copy, Debug)]
pub struct Pond {
    /// Number of leaves.
    pub leaves: usize,
    /// Seed of their places and attitudes.
    pub seed: u64,
    /// Current in the middle of the water, m/s along x.
    pub current: f64,
    /// Breeze at 2 m height, m/s, along x and a third as much across.
    pub wind: f64,
}

/// Height of the ground over the water at a place across, m; negative under it.
pub fn ground(z: f64) -> f64 {
    (SLOPE * (z.abs() - HALF_WIDTH)).max(-0.3)
}

impl Pond {
    /// The world with everything in it, the log being the last piece, and its fluids.
    ///
    /// # Errors
    /// A line that says what is wrong with a flow.
    pub fn build(&self) -> Result<(Scene, Immersion), String> {
        let mut world = PhysicsWorld::new();
        preset::leaf_scale(&mut world.integration_parameters);
        let mut scene = Scene::new(world);
        scene.add_water([LENGTH, 2.0 * HALF_WIDTH], WATER);
        furnish(&mut scene);
        scene.kinds = kinds();
        let species = scene.kinds.len();
        self.rain(&mut scene);
        scene.kinds.push(log().map_err(|error| error.to_string())?);
        let across = Quat::from_axis_angle(&Vec3::x_axis(), PI / 2.0);
        // Almost half of it is over the water.
        let place = Vec3::new(LOG, 0.01, 0.0);
        scene.add_piece(species, WOOD, (place, across), Vec3::zeros(), |body| body);

        let medium = self.medium().map_err(|error| error.to_string())?;
        let mut immersion = Immersion::new(medium);
        for (index, kind) in scene.kinds.iter().enumerate() {
            let pieces = scene.pieces.iter().filter(|piece| piece.kind == index);
            immersion.insert_all(pieces.map(|piece| piece.handle), (*kind.body).clone());
        }
        Ok((scene, immersion))
    }

    /// Air over water.
    fn medium(&self) -> Result<Medium, Error> {
        let current = Channel {
            speed: self.current as f32,
        };
        let water = Layer::new(Fluid::WATER).with_flow(current);
        if self.wind == 0.0 {
            return Ok(Medium::layered(Fluid::AIR, water));
        }
        let toward = Vector::new(1.0, 0.0, 0.33);
        let breeze = LogLaw::new(toward, Vector::Y, self.wind as f32, 2.0, 0.001)?;
        Ok(Medium::layered(
            Layer::new(Fluid::AIR).with_flow(breeze),
            water,
        ))
    }

    /// The leaves, in a tall box over the water and the banks.
    fn rain(&self, scene: &mut Scene) {
        const CELL: f64 = 0.12;
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(self.seed);
        let [along, across] = [3.4, 2.6].map(|size| (size / CELL) as usize);
        let layers = self.leaves.div_ceil(along * across).max(4);
        let rise = (HIGHEST - LOWEST) / layers as f64;
        // The cells of all layers in random order, as many as there are leaves.
        let mut cells: Vec<usize> = (0..along * across * layers).collect();
        for i in 0..self.leaves {
            let other = random.random_range(i..cells.len());
            cells.swap(i, other);
        }
        for cell in &cells[..self.leaves] {
            let mut within = |room: f64| random.random_range(0.0..room);
            let free = CELL - 0.08;
            let position = Vec3::new(
                UPSTREAM + (cell % along) as f64 * CELL + within(free),
                LOWEST + (cell / (along * across)) as f64 * rise + within((rise - 0.08).max(free)),
                (((cell / along) % across) as f64 - 0.5 * across as f64) * CELL + within(free),
            );
            let mut angle = || random.random_range(-1.0..1.0_f64);
            let heading = Quat::from_axis_angle(&Vec3::y_axis(), PI * angle());
            let tilt = Quat::from_scaled_axis(Vec3::new(angle(), 0.0, angle()) * 0.9);
            let spin = Vec3::new(angle(), angle(), angle()) * 2.0;
            let kind = random.random_range(0..scene.kinds.len());
            let color = AUTUMN[random.random_range(0..AUTUMN.len())];
            let normal = scene.kinds[kind].body.hydro.planform.axes * Vec3::z();
            let level = Quat::rotation_between(&normal, &Vec3::y()).unwrap_or_else(Quat::identity);
            let attitude = heading * tilt * level;
            scene.add_piece(kind, color, (position, attitude), spin, preset::leaf_body);
        }
    }
}

/// Four species, of a few triangles each: each of them is cut by the water in every step.
fn kinds() -> Vec<Kind> {
    let species = [
        (Outline::Elliptic, 0.073, 0.042, 12),
        (Outline::Ovate, 0.064, 0.044, 12),
        (Outline::Lanceolate, 0.080, 0.022, 12),
        (Outline::Maple, 0.068, 0.070, 20),
    ];
    let kind = |(outline, length, width, around)| {
        let blade = Blade {
            outline,
            length,
            width,
            thickness: 0.0003,
            camber: [0.001, 0.001],
        };
        let seen = outline.points(length, width, 20);
        let seen: Vec<Vec3> = seen.iter().map(|p| Vec3::new(p[0], 0.0, p[1])).collect();
        let solid = blade
            .solid_of(around, 1)
            .expect("a blade is a closed solid");
        Kind::new(&solid, 350.0, Some(&seen)).expect("a leaf of some weight")
    };
    species.map(kind).into()
}

/// Of spruce, with its bark.
fn log() -> Result<Kind, Error> {
    let shape = SharedShape::cylinder(0.5 * LOG_LENGTH as f32, LOG_RADIUS as f32);
    let dry = DryMass::of_shape(shape.as_ref(), 550.0)?;
    let hydro = HydroProperties::from_shape(shape.as_ref())?;
    let solid = Surface::from_shape(shape.as_ref())?;
    // Narrow faces, so that they are sorted well among the leaves.
    let (around, along) = (20, 24);
    let rim = |k: usize, j: usize| {
        let (sin, cos) = (2.0 * PI * k as f64 / f64::from(around)).sin_cos();
        let y = LOG_LENGTH * (j as f64 / along as f64 - 0.5);
        Vec3::new(LOG_RADIUS * cos, y, LOG_RADIUS * sin)
    };
    let mut faces = Vec::new();
    for k in 0..around as usize {
        faces.extend(
            (0..along).map(|j| vec![rim(k, j), rim(k, j + 1), rim(k + 1, j + 1), rim(k + 1, j)]),
        );
    }
    faces.extend([0, along].map(|j| (0..around as usize).map(|k| rim(k, j)).collect()));
    Ok(Kind {
        body: Arc::new(ImmersedBody::new(hydro)),
        dry,
        collision: shape,
        solid: Arc::new(solid),
        outline: Arc::new(faces),
    })
}

/// Two banks and two posts that hold the log.
fn furnish(scene: &mut Scene) {
    let (half_thickness, half_across) = (0.1, 2.2);
    let angle = SLOPE.atan();
    for side in [-1.0, 1.0] {
        // The upper side goes through the water's edge, a meter of it below.
        let edge = Vec3::new(0.0, 0.0, side * HALF_WIDTH);
        let uphill = Vec3::new(0.0, angle.sin(), side * angle.cos());
        let normal = Vec3::new(0.0, angle.cos(), -side * angle.sin());
        let middle = edge + uphill * (half_across - 1.0) - normal * half_thickness;
        let pose = Pose::from_parts(
            Vector::new(0.0, middle.y as f32, middle.z as f32),
            Rotation::from_rotation_x(-(side * angle) as f32),
        );
        let size = [LENGTH, 2.0 * half_thickness, 2.0 * half_across];
        scene.add_box(pose, size, BANK);
    }
    for z in [-0.55, 0.55] {
        let behind = LOG + LOG_RADIUS + 0.03;
        let at = Pose::from_translation(Vector::new(behind as f32, 0.0, z));
        scene.add_box(at, [0.05, 0.6, 0.05], WOOD);
    }
}

/// What becomes of the leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    /// In the air.
    pub falling: usize,
    /// On a bank.
    pub ashore: usize,
    /// On the water.
    pub afloat: usize,
    /// Of these, in touch with the log, or with others that are.
    pub at_log: usize,
    /// Under water by more than 5 cm without anything that holds them there.
    pub sunk: usize,
    /// Asleep.
    pub asleep: usize,
    /// Of those that float the ones that touch nothing.
    pub free: usize,
    /// Mean velocity of these along the current, m/s, and of the water where they are.
    pub drift: [f64; 2],
    /// Poses or velocities that are no numbers.
    pub broken: usize,
}

impl Count {
    /// Of the leaves now.
    pub fn of(scene: &Scene, immersion: &Immersion, current: &Channel) -> Self {
        let bodies = &scene.world.bodies;
        let held = held_by_log(scene);
        let mut count = Self::default();
        let leaves = scene.pieces.len() - 1;
        for (piece, held) in scene.pieces[..leaves].iter().zip(held) {
            let body = &bodies[piece.handle];
            let at = from_rapier(body.center_of_mass());
            count.asleep += usize::from(body.is_sleeping());
            if !(body.linvel().is_finite() && body.translation().is_finite()) {
                count.broken += 1;
                continue;
            }
            let touched = held.is_some();
            let over_ground = at.y - ground(at.z);
            if at.z.abs() > HALF_WIDTH && over_ground.abs() < 0.05 {
                count.ashore += 1;
            } else if at.y < -0.05 && !touched {
                count.sunk += 1;
            } else if is_wet(immersion, bodies, piece.handle) || touched {
                count.afloat += 1;
                count.at_log += usize::from(held == Some(true));
                if !touched {
                    count.free += 1;
                    count.drift[0] += f64::from(body.linvel().x);
                    let water = current.velocity(body.center_of_mass(), 0.0);
                    count.drift[1] += f64::from(water.x);
                }
            } else {
                count.falling += 1;
            }
        }
        count.drift = count.drift.map(|sum| sum / count.free.max(1) as f64);
        count
    }
}

fn is_wet(immersion: &Immersion, bodies: &RigidBodySet, handle: RigidBodyHandle) -> bool {
    immersion
        .hydrostatics(bodies, handle)
        .is_some_and(|floats| floats.submerged_share > 0.0)
}

/// Of each leaf whether it is in touch with the log, through others or not; `None` if it touches nothing.
fn held_by_log(scene: &Scene) -> Vec<Option<bool>> {
    let leaves = scene.pieces.len() - 1;
    let handles = scene.pieces.iter().map(|piece| piece.handle);
    let index: std::collections::HashMap<_, _> = handles.enumerate().map(|(i, h)| (h, i)).collect();
    let piece_of = |collider| {
        let parent = scene.world.colliders.get(collider)?.parent()?;
        index.get(&parent).copied()
    };
    let mut held = vec![None; leaves + 1];
    let mut pairs = Vec::new();
    for pair in scene.world.contact_pairs() {
        if pair.has_any_active_contact() {
            let both = [piece_of(pair.collider1), piece_of(pair.collider2)];
            both.into_iter()
                .flatten()
                .for_each(|i| held[i] = Some(false));
            if let [Some(a), Some(b)] = both {
                pairs.push([a, b]);
            }
        }
    }
    held[leaves] = Some(true);
    let mut found = true;
    while found {
        found = false;
        for [a, b] in &pairs {
            if held[*a] != held[*b] {
                (held[*a], held[*b]) = (Some(true), Some(true));
                found = true;
            }
        }
    }
    held.truncate(leaves);
    held
}
