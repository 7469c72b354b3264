//! How bodies turn to a fall: broadside, apex first, or any way.

use crate::published::bluff::revolved;
use crate::published::samara::box_mass;
use crate::support::solid_box;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody, ViscousLaw};

fn solid(surface: &Surface, density: f64) -> (ImmersedBody, DryMass) {
    let mass = density * surface.volume_integrals().volume;
    let dry = DryMass::uniform(surface, mass).unwrap();
    let hydro = HydroProperties::from_surface(surface, dry.center);
    (ImmersedBody::new(hydro), dry)
}

/// Mean cosine between an axis of the body (its y) and the way it falls, over the last half of 20 s in air.
fn heading((body, mass): &(ImmersedBody, DryMass), tilt: f64) -> f64 {
    let mut free = FreeBody::new(body, mass, &Fluid::AIR).unwrap();
    free.set_orientation(UnitQuaternion::from_euler_angles(tilt, 0.1, 0.05));
    let (steps, mut sum) = (2400, 0.0);
    for step in 0..steps {
        free.step(1.0 / 120.0, Vector3::new(0.0, -9.81, 0.0));
        if step >= steps / 2 {
            let axis = free.orientation() * Vector3::y();
            sum += axis.dot(&free.linear_velocity().normalize()) / f64::from(steps / 2);
        }
    }
    sum
}

/// A cone of 60° falls apex first, wherever it points when it is let go: its pressure acts behind the middle
/// of its volume.
#[test]
fn cones_fall_apex_first() {
    let height = 0.05 / 30f64.to_radians().tan();
    let cone = revolved(&[[0.0, 0.0], [0.05, 0.0], [0.0, height]], 48);
    let cone = solid(&cone, 100.0);
    for tilt in [0.5, 1.5, 2.5, 3.0] {
        let heading = heading(&cone, tilt);
        assert!(heading > 0.9, "{tilt}: {heading}");
    }
}

/// So does a shuttle, a hollow cone of 40° with its weight in the nose, whose volume's middle is far behind
/// its center of mass: even if it is let go base first it turns around.
#[test]
fn shuttles_fall_nose_first() {
    let height = 0.033 / 20f64.to_radians().tan();
    let skirt = [
        [0.0, height],
        [0.033, 0.0],
        [0.0315, 0.0],
        [0.0, height - 0.004],
    ];
    let (body, skirt) = solid(&revolved(&skirt, 48), 200.0);
    let cork = box_mass([0.02; 3], 3e-3, [0.0, height - 0.01, 0.0]);
    let shuttle = (body, skirt.combined(&cork));
    for tilt in [0.3, 1.5, 2.5, 3.0] {
        let heading = heading(&shuttle, tilt);
        assert!(heading > 0.95, "{tilt}: {heading}");
    }
}

/// A rod and a cylinder come to lie broadside.
#[test]
fn rods_fall_broadside() {
    for length in [2.0, 5.0, 10.0] {
        let half = 0.01 * length;
        let cylinder = revolved(
            &[[0.0, -half], [0.01, -half], [0.01, half], [0.0, half]],
            32,
        );
        let rod = solid_box([0.02, 0.02 * length, 0.02], 300.0, ViscousLaw::default());
        for (name, body) in [("cylinder", solid(&cylinder, 300.0)), ("rod", rod)] {
            for tilt in [0.2, 0.7, 1.2] {
                let heading = heading(&body, tilt);
                assert!(heading.abs() < 0.15, "{name} {length} {tilt}: {heading}");
            }
        }
    }
}

/// A cube has no attitude of its own: it comes down the way it was let go.
#[test]
fn cubes_fall_as_they_are() {
    let cube = solid_box([0.05; 3], 300.0, ViscousLaw::default());
    for tilt in [0.0, 0.4, 0.8] {
        let mut free = FreeBody::new(&cube.0, &cube.1, &Fluid::AIR).unwrap();
        let start = UnitQuaternion::from_euler_angles(tilt, 0.1, 0.05);
        free.set_orientation(start);
        for _ in 0..1200 {
            free.step(1.0 / 120.0, Vector3::new(0.0, -9.81, 0.0));
        }
        let turned = free.orientation().angle_to(&start);
        assert!(turned < 1e-3, "{tilt}: {turned}");
    }
}

/// Without gravity no body that has a front and a back gains energy in any step, however it moves and turns, at any step
/// size: its resistance acts at a point that moves with the direction, and is a resistance all the same.
#[test]
fn no_lopsided_body_gains_energy() {
    let cone = [[0.0, 0.0], [0.05, 0.0], [0.0, 0.09]];
    let bowl = [[0.0, -0.04], [0.05, 0.0], [0.045, 0.0], [0.0, -0.035]];
    for surface in [revolved(&cone, 24), revolved(&bowl, 24)] {
        for (density, fluid, dt) in [
            (100.0, Fluid::AIR, 1.0 / 60.0),
            (500.0, Fluid::WATER, 1.0 / 20.0),
            (3000.0, Fluid::WATER, 1.0 / 240.0),
        ] {
            let (body, mass) = solid(&surface, density);
            let weight = box_mass([5e-3; 3], 0.5 * mass.mass, [0.02, 0.01, -0.01]);
            for mass in [mass, mass.combined(&weight)] {
                let mut free = FreeBody::new(&body, &mass, &fluid).unwrap();
                free.set_velocity(
                    Vector3::new(1.0, -0.7, 0.4),
                    Vector3::new(20.0, 35.0, -50.0),
                );
                let mut energy = free.kinetic_energy();
                for step in 0..400 {
                    free.step(dt, Vector3::zeros());
                    let now = free.kinetic_energy();
                    assert!(now <= energy * (1.0 + 1e-9), "{step}: {energy} {now}");
                    energy = now;
                }
            }
        }
    }
}

/// A cone takes the same way in a rapier world, where eight bodies are computed side by side in single precision.
#[test]
fn a_cone_falls_in_rapier_as_alone() {
    let surface = revolved(&[[0.0, 0.0], [0.05, 0.0], [0.0, 0.09]], 24);
    let (body, mass) = solid(&surface, 300.0);
    let mut free = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
    free.set_orientation(UnitQuaternion::from_euler_angles(1.0, 0.2, 0.1));
    let dt = 1.0 / 240.0;
    let mut world =
        BodyInWorld::new(body, &mass, Fluid::AIR, &BodyState::of(&free), dt, 9.81).unwrap();
    for _ in 0..240 {
        free.step(dt, Vector3::new(0.0, -9.81, 0.0));
        world.step();
    }
    let miss = (world.state().position - free.position).norm();
    assert!(
        miss < 1e-3 * free.position.norm(),
        "{miss} {}",
        free.position
    );
    let turned = world.state().orientation.angle_to(&free.orientation());
    assert!(turned < 5e-3, "{turned}");
}
