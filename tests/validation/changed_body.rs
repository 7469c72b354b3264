//! A user changes what a body in the fluid is made of: it goes on as a body would that had been made so from
//! the start, and whatever it is given back is what the user set last.

use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{BodyChanges, Fluid, HydroProperties, ImmersedBody, Immersion, Warning};

/// A body of two plates side by side, turned so that nothing is symmetric, with or without ballast.
pub(super) struct Scene {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub body: RigidBodyHandle,
    pub plates: [ColliderHandle; 2],
}

impl Scene {
    pub fn new(fluid: Fluid, ballast: Real) -> Self {
        let mut world = PhysicsWorld::new();
        let body = RigidBodyBuilder::dynamic()
            .rotation(Vector::new(0.3, 0.0, 0.2))
            .additional_mass(ballast);
        let body = world.insert_body(body);
        let plates = [-0.025, 0.025].map(|x| {
            let plate = ColliderBuilder::cuboid(0.025, 0.001, 0.05)
                .translation(Vector::X * x)
                .density(1500.0);
            world.insert_collider(plate, Some(body))
        });
        Self {
            world,
            immersion: Immersion::new(fluid),
            body,
            plates,
        }
    }

    pub fn immerse(&mut self) {
        let world = &self.world;
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, self.body);
        self.immersion.insert(self.body, hydro.unwrap());
    }

    pub fn steps(&mut self, count: usize) {
        (0..count).for_each(|_| self.immersion.step(&mut self.world));
    }

    pub fn rigid_body(&mut self) -> &mut RigidBody {
        &mut self.world.bodies[self.body]
    }

    /// Is where another scene's body is, and moves as it does.
    fn take_motion_of(&mut self, other: &Self) {
        let now = &other.world.bodies[other.body];
        let body = self.rigid_body();
        body.set_position(*now.position(), true);
        body.set_linvel(now.linvel(), true);
        body.set_angvel(now.angvel(), true);
    }

    fn plate(&mut self, index: usize) -> &mut Collider {
        &mut self.world.colliders[self.plates[index]]
    }

    /// What rapier has of the body's mass: that of the body, its additional one, and those of its colliders.
    fn masses(&self) -> impl PartialEq + std::fmt::Debug + use<> {
        let body = &self.world.bodies[self.body];
        let properties = body.mass_properties();
        let additional = properties.additional_local_mprops.as_deref().copied();
        // To rapier no additional mass and an additional mass of zero are the same.
        let zero = RigidBodyAdditionalMassProps::MassProps(MassProperties::default());
        let of_colliders: Vec<_> = (body.colliders().iter())
            .map(|handle| {
                let collider = &self.world.colliders[*handle];
                (collider.mass_properties(), collider.density())
            })
            .collect();
        (
            properties.local_mprops,
            additional.unwrap_or(zero),
            of_colliders,
        )
    }
}

type Change = fn(&mut Scene);

/// Each thing that a user can do to what a body is made of, and the ballast that it has before, kg.
const CHANGES: &[(&str, Real, Change)] = &[
    ("nothing", 0.0, |_| {}),
    ("collider added", 0.0, |s| {
        let ball = ColliderBuilder::ball(0.01)
            .density(3000.0)
            .translation(Vector::Z * 0.06);
        s.world.insert_collider(ball, Some(s.body));
    }),
    ("sensor with mass added", 0.0, |s| {
        let ball = ColliderBuilder::ball(0.01).mass(0.01).sensor(true);
        s.world.insert_collider(ball, Some(s.body));
    }),
    ("first collider removed", 0.0, |s| {
        s.world.remove_collider(s.plates[0]);
    }),
    ("second collider removed", 0.0, |s| {
        s.world.remove_collider(s.plates[1]);
    }),
    ("first collider disabled", 0.0, |s| {
        s.plate(0).set_enabled(false)
    }),
    ("second collider disabled", 0.0, |s| {
        s.plate(1).set_enabled(false)
    }),
    ("collider made a sensor", 0.0, |s| {
        s.plate(1).set_sensor(true)
    }),
    ("shape set", 0.0, |s| {
        s.plate(0)
            .set_shape(SharedShape::cuboid(0.025, 0.003, 0.05))
    }),
    ("shape changed in place", 0.0, |s| {
        s.plate(1)
            .shape_mut()
            .as_cuboid_mut()
            .unwrap()
            .half_extents
            .y = 0.003;
    }),
    ("collider moved", 0.0, |s| {
        s.plate(0)
            .set_position_wrt_parent(Pose::from_translation(Vector::X * -0.1));
    }),
    ("collider turned", 0.0, |s| {
        s.plate(1).set_rotation_wrt_parent(Vector::Z * 0.5)
    }),
    ("density of the first", 0.0, |s| {
        s.plate(0).set_density(3000.0)
    }),
    ("density of the second", 0.0, |s| {
        s.plate(1).set_density(3000.0)
    }),
    ("density of the second is none", 0.0, |s| {
        s.plate(1).set_density(0.0)
    }),
    ("mass of the second is none", 0.0, |s| {
        s.plate(1).set_mass(0.0)
    }),
    ("mass properties of the second are none", 0.0, |s| {
        s.plate(1).set_mass_properties(MassProperties::default());
    }),
    ("mass of the first", 0.0, |s| s.plate(0).set_mass(0.05)),
    ("mass properties of the second", 0.0, |s| {
        let properties = MassProperties::new(Vector::X * 0.01, 0.02, Vector::splat(1e-5));
        s.plate(1).set_mass_properties(properties);
    }),
    ("ballast", 0.0, |s| {
        s.rigid_body().set_additional_mass(0.03, true)
    }),
    ("other ballast", 0.02, |s| {
        s.rigid_body().set_additional_mass(0.05, true)
    }),
    ("no ballast any more", 0.02, |s| {
        s.rigid_body().set_additional_mass(0.0, true)
    }),
    ("no ballast properties any more", 0.02, |s| {
        s.rigid_body()
            .set_additional_mass_properties(MassProperties::default(), true);
    }),
    ("ballast properties", 0.0, |s| {
        let properties = MassProperties::new(Vector::Z * 0.02, 0.03, Vector::splat(2e-5));
        s.rigid_body()
            .set_additional_mass_properties(properties, true);
    }),
    ("mass recomputed", 0.02, |s| {
        let colliders = &s.world.colliders;
        s.world.bodies[s.body].recompute_mass_properties_from_colliders(colliders);
    }),
    ("gyroscopic forces off and on", 0.0, |s| {
        s.rigid_body().enable_gyroscopic_forces(true);
    }),
];

/// A body falls for half a second, is changed, and falls on for a second next to a twin that was changed
/// before it ever met the fluid and starts with the same pose and velocities. The twin has the same constants
/// and the changed body forgets the history of its acceleration, so that the two are equal to the bit, and so
/// is their energy; and so are their masses when they leave. Where nothing has changed the twin is a body that
/// nobody touched.
#[test]
fn a_changed_body_flies_as_one_made_so() {
    for fluid in [Fluid::AIR, Fluid::WATER] {
        for (what, ballast, change) in CHANGES {
            let mut changed = Scene::new(fluid, *ballast);
            changed.immerse();
            changed.steps(30);
            change(&mut changed);

            let mut twin = Scene::new(fluid, *ballast);
            if ["nothing", "mass recomputed"].contains(what) {
                twin.immerse();
                twin.steps(30);
            } else {
                twin.take_motion_of(&changed);
                change(&mut twin);
                twin.immerse();
            }
            for step in 0..60 {
                changed.steps(1);
                twin.steps(1);
                let state = |scene: &Scene| {
                    let body = &scene.world.bodies[scene.body];
                    (*body.position(), body.linvel(), body.angvel())
                };
                let (is, should) = (state(&changed), state(&twin));
                assert_eq!(is, should, "{what}, step {step}");
                let masses = [&changed, &twin].map(|s| s.immersion.mass_of(s.body).unwrap());
                assert_eq!(masses[0], masses[1], "{what}");
            }
            // A turned plate is one of rapier's wrong inertias, which both hear of.
            let (heard, expected) = (changed.immersion.warnings(), twin.immersion.warnings());
            assert_eq!(heard, expected, "{what}");
            assert!(
                heard.len() <= usize::from(*what == "collider turned"),
                "{heard:?}"
            );
            for scene in [&mut changed, &mut twin] {
                let (bodies, colliders) = (&mut scene.world.bodies, &mut scene.world.colliders);
                scene.immersion.remove(scene.body, bodies, colliders);
            }
            let mut never = Scene::new(fluid, *ballast);
            change(&mut never);
            never.world.step();
            assert_eq!(changed.masses(), never.masses(), "{what}");
            assert_eq!(twin.masses(), never.masses(), "{what}");
        }
    }
}

/// Kinematic or fixed for a while, and disabled for a while: when the body is dynamic again the fluid acts in
/// the very next step, on the velocities that it has then. The twin enters at that moment.
#[test]
fn a_body_that_was_not_dynamic_comes_back() {
    type Change = fn(&mut RigidBody);
    let kinds: [(&str, Change, Change); 3] = [
        (
            "kinematic",
            |b| b.set_body_type(RigidBodyType::KinematicVelocityBased, true),
            |b| b.set_body_type(RigidBodyType::Dynamic, true),
        ),
        (
            "fixed",
            |b| b.set_body_type(RigidBodyType::Fixed, true),
            |b| b.set_body_type(RigidBodyType::Dynamic, true),
        ),
        (
            "disabled",
            |b| b.set_enabled(false),
            |b| b.set_enabled(true),
        ),
    ];
    for fluid in [Fluid::AIR, Fluid::WATER] {
        for (what, away, back) in kinds {
            for pause in [1, 5, 40] {
                let mut scene = Scene::new(fluid, 0.0);
                scene.immerse();
                scene.steps(30);
                away(scene.rigid_body());
                scene.steps(pause);
                back(scene.rigid_body());
                let mut twin = Scene::new(fluid, 0.0);
                twin.take_motion_of(&scene);
                twin.immerse();
                for step in 0..30 {
                    scene.steps(1);
                    twin.steps(1);
                    let velocities = |s: &Scene| {
                        let body = &s.world.bodies[s.body];
                        (body.linvel(), body.angvel())
                    };
                    let at = format!("{what} for {pause}, step {step}");
                    assert_eq!(velocities(&scene), velocities(&twin), "{at}");
                }
                assert_eq!(scene.immersion.warnings(), []);
            }
        }
    }
}

/// A collider that is taken from a body in the fluid, or left when the body goes, has its own mass again; so
/// has the body that gets it.
#[test]
fn a_collider_that_moves_on_keeps_its_mass() {
    let mut scene = Scene::new(Fluid::WATER, 0.0);
    scene.immerse();
    let other = Scene::new(Fluid::WATER, 0.0);
    let hydro = HydroProperties::from_body(&other.world.bodies, &other.world.colliders, other.body);
    let receiver = ColliderBuilder::cuboid(0.05, 0.001, 0.05).density(1500.0);
    let place = RigidBodyBuilder::dynamic().translation(Vector::X);
    let (receiver, _) = scene.world.insert(place, receiver);
    scene.immersion.insert(receiver, hydro.unwrap());
    scene.steps(10);
    let before = scene.immersion.mass_of(receiver).unwrap().mass;
    let plate = scene.plates[1];
    let bodies = &mut scene.world.bodies;
    scene
        .world
        .colliders
        .set_parent(plate, Some(receiver), bodies);
    scene.steps(3);
    let one = 1500.0 * 0.05 * 0.002 * 0.1;
    let mass = |body| scene.immersion.mass_of(body).unwrap().mass;
    assert!((mass(scene.body) / one - 1.0).abs() < 1e-5);
    assert!(((mass(receiver) - before) / one - 1.0).abs() < 1e-5);
    let bodies = &mut scene.world.bodies;
    scene.world.colliders.set_parent(plate, None, bodies);
    scene.steps(1);
    assert_eq!(scene.plate(1).density(), 1500.0);
}

/// Without mass a body cannot be immersed: it is its user's again, who hears of it once, and it comes back
/// with the step after it has been mended, with the shape that it has then.
#[test]
fn what_cannot_be_immersed_comes_back_when_it_is_mended() {
    let mut scene = Scene::new(Fluid::WATER, 0.0);
    scene.immerse();
    scene.steps(10);
    for round in 0..3 {
        (0..2).for_each(|i| scene.plate(i).set_density(0.0));
        scene.steps(5);
        let [Warning::Refused { body, reason }] = scene.immersion.warnings() else {
            panic!("{:?}", scene.immersion.warnings());
        };
        assert_eq!(*body, scene.body);
        assert!(reason.contains("mass must be positive"), "{reason}");
        assert!(scene.immersion.mass_of(scene.body).is_none());
        assert_eq!(scene.world.bodies[scene.body].mass(), 0.0);
        let thickness = 0.001 * (round + 2) as Real;
        (0..2).for_each(|i| {
            scene.plate(i).set_density(1500.0);
            scene
                .plate(i)
                .set_shape(SharedShape::cuboid(0.025, thickness, 0.05));
        });
        scene.steps(1);
        let mass = scene.immersion.mass_of(scene.body).unwrap().mass;
        let volume = 0.1 * 0.1 * 2.0 * f64::from(thickness);
        assert!((mass / (1500.0 * volume) - 1.0).abs() < 1e-5, "{mass}");
        let displaced = scene.immersion.get(scene.body).unwrap().hydro.volume;
        assert!((displaced / volume - 1.0).abs() < 1e-5, "{displaced}");
    }
}

/// What changes while a body is switched off is taken over when it is switched on.
#[test]
fn a_change_outside_of_the_fluid_counts_too() {
    let mut scene = Scene::new(Fluid::WATER, 0.0);
    scene.immerse();
    scene.steps(10);
    scene.immersion.set_body_enabled(scene.body, false);
    scene.steps(2);
    scene
        .plate(0)
        .set_shape(SharedShape::cuboid(0.025, 0.003, 0.05));
    scene.steps(2);
    scene.immersion.set_body_enabled(scene.body, true);
    scene.steps(2);
    let world = &scene.world;
    let volume = scene.immersion.get(scene.body).unwrap().hydro.volume;
    let expected = 0.05 * 0.1 * (0.002 + 0.006);
    assert!((volume / expected - 1.0).abs() < 1e-5, "{volume}");
    assert!(world.bodies[scene.body].linvel().is_finite());
    assert_eq!(scene.immersion.warnings(), []);
}

/// A description of the user's own stays when the shape changes, and that is said once; the mass is taken
/// over all the same. A new description that comes with the new shape says nothing.
#[test]
fn a_description_of_the_users_own_is_kept() {
    for described_anew in [false, true] {
        let mut scene = Scene::new(Fluid::WATER, 0.0);
        let of_body = |s: &Scene| {
            HydroProperties::from_body(&s.world.bodies, &s.world.colliders, s.body).unwrap()
        };
        let mut hydro = of_body(&scene);
        hydro.added_mass.linear *= 1.1;
        scene.immersion.insert(scene.body, hydro.clone());
        scene.steps(10);
        for thickness in [0.002, 0.003] {
            let shape = SharedShape::cuboid(0.025, thickness, 0.05);
            (0..2).for_each(|i| scene.plate(i).set_shape(shape.clone()));
            if described_anew {
                hydro.added_mass.linear *= 1.1;
                scene.immersion.insert(scene.body, hydro.clone());
            }
            scene.steps(3);
            let expected = 1500.0 * 0.1 * 0.1 * 2.0 * f64::from(thickness);
            let mass = scene.immersion.mass_of(scene.body).unwrap().mass;
            assert!((mass / expected - 1.0).abs() < 1e-5, "{mass}");
        }
        let body = scene.body;
        let kept = scene.immersion.get(body).unwrap();
        assert_eq!(*kept, ImmersedBody::new(hydro));
        if described_anew {
            assert_eq!(scene.immersion.warnings(), []);
        } else {
            assert_eq!(scene.immersion.warnings(), [Warning::ShapeKept { body }]);
        }
    }
}

/// Who does not want changes followed has the body go on as it was, and is told once; when it leaves it is what its user has made of it.
#[test]
fn changes_can_be_ignored() {
    for (what, ballast, change) in CHANGES {
        let mut scenes = [(); 2].map(|()| {
            let mut scene = Scene::new(Fluid::WATER, *ballast);
            scene.immersion.body_changes = BodyChanges::Ignore;
            scene.immerse();
            scene.steps(10);
            scene
        });
        change(&mut scenes[0]);
        for _ in 0..30 {
            scenes.iter_mut().for_each(|s| s.steps(1));
            let [is, should] = [0, 1].map(|i| {
                let body = &scenes[i].world.bodies[scenes[i].body];
                (body.linvel(), body.angvel())
            });
            // Rapier's sum over the colliders rounds otherwise when there is one more or less of them.
            let off = (is.0 - should.0).length() + 0.01 * (is.1 - should.1).length();
            assert!(off <= 1e-6 * should.0.length(), "{what}: {off}");
        }
        let [mut scene, _] = scenes;
        let body = scene.body;
        if !["nothing", "mass recomputed"].contains(what) {
            assert_eq!(
                scene.immersion.warnings(),
                [Warning::ChangeIgnored { body }],
                "{what}"
            );
        }
        let (bodies, colliders) = (&mut scene.world.bodies, &mut scene.world.colliders);
        scene.immersion.remove(body, bodies, colliders);
        let mut never = Scene::new(Fluid::WATER, *ballast);
        change(&mut never);
        never.world.step();
        assert_eq!(scene.masses(), never.masses(), "{what}");
    }
}

/// Ballast on a ball in water: at the start of the fall, when drag is nothing, it sinks with
/// g·Δm/(1.5 m + Δm), where 1.5 m is the ball of the water's density with half of its displaced water.
#[test]
fn ballast_sinks_as_it_should() {
    for extra in [0.5, 1.0, 3.0_f32] {
        for how in ["additional mass", "mass of the collider", "second collider"] {
            let mut world = PhysicsWorld::new();
            let ball = ColliderBuilder::ball(0.15).density(997.0);
            let (body, collider) = world.insert(RigidBodyBuilder::dynamic(), ball);
            let mass = world.bodies[body].mass();
            let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
            let mut immersion = Immersion::new(Fluid::WATER);
            immersion.insert(body, hydro);
            (0..10).for_each(|_| immersion.step(&mut world));
            match how {
                "additional mass" => world.bodies[body].set_additional_mass(extra, true),
                "mass of the collider" => world.colliders[collider].set_mass(mass + extra),
                _ => {
                    let weight = ColliderBuilder::ball(0.01).mass(extra).sensor(true);
                    world.insert_collider(weight, Some(body));
                }
            }
            let before = world.bodies[body].linvel().y;
            immersion.step(&mut world);
            let acceleration = (world.bodies[body].linvel().y - before) * 60.0;
            let expected = -9.81 * extra / (1.5 * mass + extra);
            let off = (acceleration / expected - 1.0).abs();
            // The ball floats to 1e-4 of its weight before, and drag takes a little in the step.
            assert!(
                off < 0.01,
                "{how}, {extra} kg: {acceleration} for {expected}"
            );
        }
    }
}

/// A body that rests asleep on the floor is made lighter than water: it rises.
#[test]
fn a_sleeper_that_is_changed_wakes() {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(5.0, 0.5, 5.0).translation(Vector::Y * -0.5);
    world.insert(RigidBodyBuilder::fixed(), floor);
    let place = RigidBodyBuilder::dynamic().translation(Vector::Y * 0.1);
    let (body, ball) = world.insert(place, ColliderBuilder::ball(0.1).density(2000.0));
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
    let mut immersion = Immersion::new(Fluid::WATER);
    immersion.insert(body, hydro);
    (0..300).for_each(|_| immersion.step(&mut world));
    assert!(world.bodies[body].is_sleeping());
    world.colliders[ball].set_density(500.0);
    (0..60).for_each(|_| immersion.step(&mut world));
    assert!(world.bodies[body].translation().y > 0.2);
}

/// A loaded snapshot goes on to the bit: that shapes have other addresses then is no change. What is changed
/// after loading is seen.
#[cfg(feature = "serde-serialize")]
#[test]
fn loading_is_no_change() {
    let mut scene = Scene::new(Fluid::WATER, 0.02);
    scene.immerse();
    scene.steps(30);
    let world = postcard::to_stdvec(&scene.world).unwrap();
    let immersion = postcard::to_stdvec(&scene.immersion).unwrap();
    let mut loaded = Scene {
        world: postcard::from_bytes(&world).unwrap(),
        immersion: postcard::from_bytes(&immersion).unwrap(),
        body: scene.body,
        plates: scene.plates,
    };
    for changed in [false, true] {
        if changed {
            for scene in [&mut scene, &mut loaded] {
                scene
                    .plate(0)
                    .set_shape(SharedShape::cuboid(0.025, 0.003, 0.05));
                scene.rigid_body().set_additional_mass(0.0, true);
            }
        }
        for step in 0..20 {
            scene.steps(1);
            loaded.steps(1);
            let [is, should] = [&loaded, &scene].map(|s| {
                let body = &s.world.bodies[s.body];
                (*body.position(), body.linvel(), body.angvel())
            });
            assert_eq!(is, should, "changed: {changed}, step {step}");
        }
        let mass = loaded.immersion.mass_of(loaded.body).unwrap().mass;
        let volume = 0.05 * 0.1 * if changed { 0.008 } else { 0.004 };
        let expected = 1500.0 * volume + if changed { 0.0 } else { 0.02 };
        assert!((mass / expected - 1.0).abs() < 1e-5, "{mass}");
        assert_eq!(loaded.immersion.warnings(), []);
    }
}
