//! Apps, and rapier worlds of their own to compare them with.

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d::rapier::prelude as rapier;
use bevy_rapier3d_immersed::immersed::{Immersion, RapierSets};
use bevy_rapier3d_immersed::prelude::*;
use std::time::Duration;

pub const STEP: f32 = 1.0 / 60.0;
pub const FIXED: TimestepMode = TimestepMode::Fixed {
    dt: STEP,
    substeps: 1,
};
/// Half extents, m, and density, kg/m³, of a leaf.
pub const LEAF: [f32; 3] = [0.0365, 0.00015, 0.021];
pub const DENSITY: f32 = 300.0;

/// An app with bevy_rapier alone, each of whose updates but the first takes a step's time.
pub fn bare(mode: TimestepMode) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin))
        .add_plugins(RapierPhysicsPlugin::<NoUserData>::default())
        .insert_resource(mode);
    frame_time(&mut app, STEP);
    app
}

/// The same with the plugin.
pub fn app(mode: TimestepMode) -> App {
    let mut app = bare(mode);
    app.add_plugins(ImmersedPlugin::<NoUserData>::default());
    app
}

pub fn frame_time(app: &mut App, seconds: f32) {
    let step = Duration::from_secs_f32(seconds);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
}

pub fn update(app: &mut App, times: usize) {
    (0..times).for_each(|_| app.update());
}

pub fn place() -> Transform {
    Transform::from_xyz(0.3, 2.0, -0.2).with_rotation(Quat::from_rotation_x(0.3))
}

/// A leaf without the component.
pub fn leaf(place: Transform) -> impl Bundle {
    let [x, y, z] = LEAF;
    (
        RigidBody::Dynamic,
        Collider::cuboid(x, y, z),
        ColliderMassProperties::Density(DENSITY),
        place,
    )
}

pub fn spawn(app: &mut App, bundle: impl Bundle) -> Entity {
    app.world_mut().spawn(bundle).id()
}

/// The body of an entity, as rapier has it.
pub fn body(app: &App, entity: Entity) -> &rapier::RigidBody {
    let world = app.world();
    let handle = world.get::<RapierRigidBodyHandle>(entity).unwrap().0;
    let set = world.get::<RapierRigidBodySet>(context_of(app, entity));
    &set.unwrap().bodies[handle]
}

pub fn context_of(app: &App, entity: Entity) -> Entity {
    app.world()
        .get::<RapierContextEntityLink>(entity)
        .unwrap()
        .0
}

pub fn immersion(app: &App, entity: Entity) -> &Immersion {
    let context = context_of(app, entity);
    app.world().get::<RapierContextImmersion>(context).unwrap()
}

pub fn handle(app: &App, entity: Entity) -> rapier::RigidBodyHandle {
    app.world().get::<RapierRigidBodyHandle>(entity).unwrap().0
}

/// Where a body is and how it moves, to the bit.
pub fn bits(body: &rapier::RigidBody) -> Vec<u32> {
    let place = body.translation().to_array();
    let turn = body.rotation().to_array();
    let motion = [body.linvel().to_array(), body.angvel().to_array()];
    let numbers = place.into_iter().chain(turn).chain(motion.concat());
    numbers.map(f32::to_bits).collect()
}

/// A leaf in a rapier world without bevy.
pub struct Own {
    pub world: rapier::PhysicsWorld,
    pub immersion: Immersion,
    pub leaf: rapier::RigidBodyHandle,
}

impl Own {
    pub fn new(place: Transform, fluid: Fluid) -> Self {
        Self::over(None, place, fluid)
    }

    /// Over a ground.
    pub fn over(ground: Option<rapier::ColliderBuilder>, place: Transform, fluid: Fluid) -> Self {
        let mut world = rapier::PhysicsWorld::new();
        if let Some(ground) = ground {
            world.insert_collider(ground, None);
        }
        // As bevy_rapier reads it, by way of an affine map.
        let place = GlobalTransform::from(place).compute_transform();
        let pose = rapier::Pose::from_parts(place.translation, place.rotation);
        let [x, y, z] = LEAF;
        let (leaf, _) = world.insert(
            rapier::RigidBodyBuilder::dynamic().pose(pose),
            rapier::ColliderBuilder::cuboid(x, y, z).density(DENSITY),
        );
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
        let mut immersion = Immersion::new(fluid);
        immersion.insert(leaf, hydro);
        Self {
            world,
            immersion,
            leaf,
        }
    }

    pub fn step(&mut self, dt: f32) {
        self.world.integration_parameters.dt = dt;
        self.immersion
            .before_step(&mut RapierSets::of(&mut self.world));
        self.world.step();
        self.immersion
            .after_step(&mut RapierSets::of(&mut self.world));
    }

    pub fn body(&self) -> &rapier::RigidBody {
        &self.world.bodies[self.leaf]
    }
}
