//! Moves the world on with each leaf steered, and tells what has come of it.

use crate::asked::Asked;
use crate::book::Played;
use crate::outcome::Outcome;
use crate::support::recording::{Recording, Stepper};
use crate::support::scene::Scene;
use crate::support::{Vec3, from_rapier};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyHandle};
use rapier3d_immersed::training::{BodyState, SketchFollower};
use rapier3d_immersed::{ForceBreakdown, Immersion};

/// The leaves, their air, and what steers them.
pub struct Guided {
    pub immersion: Immersion,
    pub handles: Vec<RigidBodyHandle>,
    pub asked: Vec<Asked>,
    pub followers: Vec<Option<SketchFollower>>,
    pub releases: Vec<BodyState>,
    /// Where each leaf's center of mass was, step by step.
    pub paths: Vec<Vec<Vec3>>,
}

impl Stepper for Guided {
    fn step(&mut self, world: &mut PhysicsWorld) {
        for (handle, follower) in self.handles.iter().zip(&mut self.followers) {
            if let Some(follower) = follower {
                follower.before_step(*handle, &world.bodies, &mut self.immersion);
            }
        }
        self.immersion.step(world);
        for (handle, path) in self.handles.iter().zip(&mut self.paths) {
            path.push(from_rapier(world.bodies[*handle].center_of_mass()));
        }
    }

    fn forces(&self, world: &PhysicsWorld, body: RigidBodyHandle) -> Option<ForceBreakdown> {
        self.immersion.forces(&world.bodies, body)
    }
}

impl Guided {
    /// How each leaf has followed, and with what it can be played again.
    pub fn outcomes(self, scene: &Scene, recording: &Recording) -> (Vec<Outcome>, Vec<Played>) {
        let dt = f64::from(scene.world.integration_parameters.dt);
        let mut both = (Vec::new(), Vec::new());
        let leaves = self.asked.into_iter().zip(self.followers).zip(self.paths);
        for (index, ((asked, follower), path)) in leaves.enumerate() {
            let series = match (asked.known, follower) {
                (Some((_, series)), _) => series,
                (None, follower) => {
                    let follower = follower.expect("what is not known is followed");
                    let followed = follower.followed(self.handles[index], &scene.world.bodies);
                    followed.expect("the world was stepped").series
                }
            };
            let sketch = asked.sketch;
            both.0.push(Outcome::new(
                sketch.clone(),
                path,
                dt,
                &recording.fates[index],
            ));
            both.1.push(Played {
                release: self.releases[index],
                sketch,
                series,
            });
        }
        both
    }
}
