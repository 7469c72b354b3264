//! What can be dropped, and the world that it falls in.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rapier3d_immersed::flow::Flow;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceState, TurbulentLayer};
use rapier3d_immersed::{Error, Fluid, HydroProperties, ImmersedBody, Immersion, preset};
use std::sync::{Arc, Mutex};

/// How many bodies of a kind there are at most; who drops more takes up the oldest.
pub const MOST: usize = 250;
/// Numbers that say where a body is: x, y, z, and the quaternion x, y, z, w.
pub const POSE: usize = 7;
/// Where bodies wait that have not been dropped.
const AWAY: Vector = Vector::new(0.0, -1e4, 0.0);
/// Half of the floor's side, m.
const FLOOR: f32 = 1.5;

/// A thing to drop.
struct Kind {
    shape: SharedShape,
    density: f32,
}

impl Kind {
    /// A leaf, a playing card, a piece of confetti and a coin.
    fn all() -> [Self; 4] {
        let outline = [
            [-38.0, 0.0],
            [-30.0, 9.0],
            [-15.0, 19.0],
            [0.0, 21.0],
            [15.0, 17.0],
            [28.0, 8.0],
            [37.0, 0.0],
        ];
        // Both sides of both faces, m.
        let side = |z: f32, y: f32| move |[x, w]: [f32; 2]| Vector::new(x, y, z * w) * 1e-3;
        let [up, down] = [0.15, -0.15];
        let mut corners = Vec::new();
        for y in [up, down] {
            corners.extend(outline.map(side(1.0, y)));
            corners.extend(outline[1..6].iter().copied().map(side(-1.0, y)));
        }
        let leaf = SharedShape::convex_hull(&corners).expect("an outline is a solid");
        let cuboid =
            |x: f32, y: f32, z: f32| SharedShape::cuboid(0.5e-3 * x, 0.5e-3 * y, 0.5e-3 * z);
        let kind = |shape, density| Self { shape, density };
        [
            kind(leaf, 350.0),
            kind(cuboid(89.0, 0.3, 64.0), 900.0),
            kind(cuboid(20.0, 0.15, 12.0), 700.0),
            kind(SharedShape::cylinder(0.85e-3, 11.5e-3), 8000.0),
        ]
    }
}

/// A breath of air: a ball of moving air whose velocity dies down.
#[derive(Clone, Copy, Default)]
struct Puff {
    center: Vector,
    velocity: Vector,
}

/// The wind over everything, and a puff in it.
#[derive(Clone, Default)]
struct Air(Arc<Mutex<(Vector, Puff)>>);

/// Distance at which a puff has lost most of its speed, m.
const REACH: f32 = 0.35;

impl Flow for Air {
    fn velocity(&self, point: Vector, _time: f64) -> Vector {
        let (wind, puff) = *self
            .0
            .lock()
            .expect("nothing panics while it holds the air");
        let away = (point - puff.center).length_squared() / (REACH * REACH);
        // No exponential: this is the same on every machine.
        wind + puff.velocity / (1.0 + away * away)
    }
}

/// Bodies of four kinds in the air over a floor.
pub struct Scene {
    world: PhysicsWorld,
    immersion: Immersion,
    air: Air,
    random: Pcg64Mcg,
    kinds: [Kind; 4],
    bodies: [Vec<RigidBodyHandle>; 4],
    dropped: [usize; 4],
    poses: Vec<f32>,
}

impl Scene {
    /// An empty one. `immersed` is false for plain rapier.
    pub fn new(seed: u64, immersed: bool) -> Result<Self, Error> {
        let mut world = PhysicsWorld::new();
        preset::leaf_scale(&mut world.integration_parameters);
        let floor = ColliderBuilder::cuboid(FLOOR, 0.05, FLOOR).friction(0.6);
        let below = RigidBodyBuilder::fixed().translation(Vector::Y * -0.05);
        world.insert(below, floor);
        let kinds = Kind::all();
        let mut immersion = Immersion::new(Fluid::AIR);
        let mut bodies = [const { Vec::new() }; 4];
        for (kind, handles) in kinds.iter().zip(&mut bodies) {
            let hydro = HydroProperties::from_shape(kind.shape.as_ref())?;
            let description = ImmersedBody::new(hydro);
            for _ in 0..MOST {
                let builder = RigidBodyBuilder::dynamic().translation(AWAY).enabled(false);
                let collider = ColliderBuilder::new(kind.shape.clone())
                    .density(kind.density)
                    .friction(0.4);
                let (handle, _) = world.insert(preset::leaf_body(builder), collider);
                if immersed {
                    immersion.insert(handle, description.clone());
                }
                handles.push(handle);
            }
        }
        let air = Air::default();
        immersion.set_flow(air.clone());
        let mut scene = Self {
            world,
            immersion,
            air,
            random: Pcg64Mcg::seed_from_u64(seed),
            kinds,
            bodies,
            dropped: [0; 4],
            poses: vec![0.0; 4 * MOST * POSE],
        };
        scene.write_poses();
        Ok(scene)
    }

    /// Fluctuations of the air, m/s (root mean square of each component), in eddies of 0.3 m.
    pub fn set_turbulence(&mut self, fluctuation: f32) {
        if !(fluctuation > 0.0) {
            self.immersion.clear_turbulence();
            return;
        }
        if let Ok(state) = TurbulenceState::from_intensity(fluctuation, 1.0, 0.3) {
            self.immersion.set_turbulence(TurbulentLayer {
                source: Turbulence::Homogeneous(state),
                mode: LangevinMode::default(),
                seed: 7,
            });
        }
    }

    /// The wind over everything, m/s.
    pub fn set_wind(&mut self, wind: Vector) {
        self.air
            .0
            .lock()
            .expect("nothing panics while it holds the air")
            .0 = wind;
        // Sleepers wake.
        self.immersion.set_flow(self.air.clone());
    }

    /// Blows at a point.
    pub fn blow(&mut self, center: Vector, velocity: Vector) {
        let mut air = self
            .air
            .0
            .lock()
            .expect("nothing panics while it holds the air");
        air.1 = Puff { center, velocity };
        std::mem::drop(air);
        for handle in self.bodies.iter().flatten() {
            let body = &mut self.world.bodies[*handle];
            if body.is_enabled() && (body.translation() - center).length() < 3.0 * REACH {
                body.wake_up(true);
            }
        }
    }

    /// Drops some of a kind around a point, m.
    pub fn release(&mut self, kind: usize, center: Vector, count: usize) {
        let kind = kind % self.kinds.len();
        for _ in 0..count {
            let mut number = || self.random.random_range(-1.0..1.0f32);
            let offset = Vector::new(number(), number(), number()) * (0.04 * (count as f32).sqrt());
            let turn = Vector::new(number(), number(), number()) * 3.0;
            let spin = Vector::new(number(), number(), number()) * 2.0;
            let next = self.dropped[kind] % MOST;
            self.dropped[kind] += 1;
            let body = &mut self.world.bodies[self.bodies[kind][next]];
            body.set_enabled(true);
            let pose = Pose::from_parts(center + offset, Rotation::from_scaled_axis(turn));
            body.set_position(pose, true);
            body.set_linvel(Vector::ZERO, true);
            body.set_angvel(spin, true);
        }
    }

    /// One step of 1/240 s.
    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
        let mut air = self
            .air
            .0
            .lock()
            .expect("nothing panics while it holds the air");
        // A puff dies down within half a second.
        air.1.velocity *= 0.98;
    }

    /// Writes where all bodies are.
    pub fn write_poses(&mut self) {
        let handles = self.bodies.iter().flatten();
        for (handle, to) in handles.zip(self.poses.chunks_exact_mut(POSE)) {
            let pose = self.world.bodies[*handle].position();
            let ([x, y, z], turn) = (pose.translation.to_array(), pose.rotation);
            to.copy_from_slice(&[x, y, z, turn.x, turn.y, turn.z, turn.w]);
        }
    }

    /// Poses of all bodies, kind by kind, as they were last written.
    pub fn poses(&self) -> &[f32] {
        &self.poses
    }

    /// Vertices, and triangles' corners, of a kind.
    pub fn mesh(&self, kind: usize) -> (Vec<f32>, Vec<u32>) {
        let (vertices, triangles) = match self.kinds[kind].shape.as_typed_shape() {
            TypedShape::Cuboid(shape) => shape.to_trimesh(),
            TypedShape::Cylinder(shape) => shape.to_trimesh(24),
            TypedShape::ConvexPolyhedron(shape) => shape.to_trimesh(),
            _ => unreachable!("there are no others"),
        };
        let numbers = vertices.iter().flat_map(|v| v.to_array()).collect();
        (numbers, triangles.into_iter().flatten().collect())
    }

    /// FNV-1a of the bits of all poses.
    pub fn hash(&self) -> u32 {
        let bytes = self.poses.iter().flat_map(|x| x.to_bits().to_le_bytes());
        bytes.fold(0x811c_9dc5, |hash, byte| {
            (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
        })
    }
}
