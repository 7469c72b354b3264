//! A leaf that is trained once, planned with, and played back in rapier.

use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::motion::{Classifier, ControlSeries, Moment, MotionGraph, Trajectory};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::training::{
    Experiment, Grid, Planner, PlannerParams, Release, Subspaces, Sweep,
};
use rapier3d_immersed::{DryMass, Fluid, HydroProperties, Immersion, OnContact};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::LazyLock;

/// A leaf of 7.3 × 4.2 × 0.03 cm and 400 kg/m³ under the default law.
pub struct Leaf {
    pub experiment: Experiment,
    pub subspaces: Subspaces,
}

pub static LEAF: LazyLock<Leaf> = LazyLock::new(|| {
    let mut world = PhysicsWorld::new();
    let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), collider());
    let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf).unwrap();
    let mass = DryMass::of_body(&world.bodies, &world.colliders, leaf).unwrap();
    let mut experiment = Experiment::new(hydro, mass, Fluid::AIR);
    experiment.release.tilt_axis = 80f64.to_radians();
    let mut sweep = Sweep::new(Grid::of_coefficients(9, PI).unwrap());
    sweep
        .run_coefficients(
            &experiment.clone().for_training(),
            &Classifier::default(),
            |_, _| ControlFlow::Continue(()),
        )
        .unwrap();
    let subspaces = Subspaces::new(sweep.grid().clone(), sweep.patterns().unwrap()).unwrap();
    Leaf {
        experiment,
        subspaces,
    }
});

pub fn collider() -> ColliderBuilder {
    ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0)
}

impl Leaf {
    pub fn planner(&self, params: PlannerParams) -> Planner {
        let (experiment, subspaces) = (self.experiment.clone(), self.subspaces.clone());
        Planner::new(experiment, subspaces, &MotionGraph::thesis(), params).unwrap()
    }

    /// A builder for the leaf at its release.
    pub fn released(&self, release: &Release) -> RigidBodyBuilder {
        let rotation = release.rotation(&self.experiment.body.hydro);
        let mut body = RigidBodyBuilder::dynamic().can_sleep(false);
        body.position.rotation = rotation;
        body.linvel(Vector::from_array(
            release.velocity.map(|x| x as f32).into(),
        ))
    }

    /// Plays every series with a leaf of its own, far from the others, in one rapier world.
    pub fn play(&self, series: &[&ControlSeries]) -> Vec<Trajectory> {
        self.play_under(&self.experiment, series)
    }

    /// The same from another release.
    pub fn play_from(&self, release: &Release, series: &[&ControlSeries]) -> Vec<Trajectory> {
        let experiment = Experiment {
            release: *release,
            ..self.experiment.clone()
        };
        self.play_under(&experiment, series)
    }

    /// The same under the release, the wind and the center of mass of `experiment`.
    pub fn play_under(
        &self,
        experiment: &Experiment,
        series: &[&ControlSeries],
    ) -> Vec<Trajectory> {
        let release = &experiment.release;
        let mut collider = collider();
        if experiment.mass != self.experiment.mass {
            collider = collider.mass_properties(experiment.mass.to_mass_properties());
        }
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = self.experiment.dt as f32;
        let mut immersion = Immersion::new(Fluid::AIR);
        if experiment.wind != Vector3::zeros() {
            let [x, y, z] = experiment.wind.map(|v| v as f32).into();
            immersion.set_flow(Uniform::new(x, y, z));
        }
        let origin = |i: usize| Vector::new(0.0, 0.0, 50.0 * i as f32);
        let handles: Vec<RigidBodyHandle> = series
            .iter()
            .enumerate()
            .map(|(i, series)| {
                let body = self.released(release).translation(origin(i));
                let (handle, _) = world.insert(body, collider.clone());
                immersion.insert(handle, self.experiment.body.clone());
                immersion.replay(handle, series, OnContact::Restart);
                handle
            })
            .collect();
        let axes = self.experiment.body.hydro.planform.axes;
        let moment = |world: &PhysicsWorld, handle: RigidBodyHandle, i: usize| {
            let body = &world.bodies[handle];
            let turn = |axis: Vector3<f64>| {
                let axis: [f64; 3] = (axes * axis).into();
                let v = *body.rotation() * Vector::from_array(axis.map(|x| x as f32));
                Vector3::new(v.x, v.y, v.z).cast::<f64>()
            };
            let p = body.translation() - origin(i);
            Moment {
                position: Vector3::new(p.x, p.y, p.z).cast(),
                normal: turn(Vector3::z()),
                long_axis: turn(Vector3::x()),
            }
        };
        let mut falls: Vec<Trajectory> = handles
            .iter()
            .enumerate()
            .map(|(i, handle)| Trajectory {
                interval: self.experiment.dt,
                moments: vec![moment(&world, *handle, i)],
            })
            .collect();
        let longest = series.iter().fold(0.0, |t: f64, s| t.max(s.duration()));
        for _ in 0..(longest / self.experiment.dt).round() as usize {
            immersion.step(&mut world);
            for (i, handle) in handles.iter().enumerate() {
                falls[i].moments.push(moment(&world, *handle, i));
            }
        }
        falls
    }
}
