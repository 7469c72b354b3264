//! Floating bodies against closed forms.

use rapier3d::prelude::*;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::rapier3d::na::Vector6;
use rapier3d_immersed::{Fluid, HydroProperties, ImmersedBody, Immersion, Medium, ViscousLaw};
use std::f32::consts::PI;

/// Air over water, and one body in it.
struct Pond {
    world: PhysicsWorld,
    immersion: Immersion,
    body: RigidBodyHandle,
}

impl Pond {
    fn new(body: RigidBodyBuilder, collider: ColliderBuilder, hertz: f32) -> Self {
        Self::over(Fluid::WATER, body, collider, hertz, |hydro| hydro.into())
    }

    fn over(
        water: Fluid,
        body: RigidBodyBuilder,
        collider: ColliderBuilder,
        hertz: f32,
        describe: impl Fn(HydroProperties) -> ImmersedBody,
    ) -> Self {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = 1.0 / hertz;
        let (body, _) = world.insert(body, collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, body).unwrap();
        let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, water));
        immersion.insert(body, describe(hydro));
        Self {
            world,
            immersion,
            body,
        }
    }

    fn run(&mut self, seconds: f32) {
        let steps = (seconds / self.world.integration_parameters.dt).round() as usize;
        (0..steps).for_each(|_| self.immersion.step(&mut self.world));
    }

    fn body(&self) -> &RigidBody {
        &self.world.bodies[self.body]
    }
}

/// An ideal fluid of water's density: no viscous force at all.
fn ideal(hydro: HydroProperties) -> ImmersedBody {
    ImmersedBody::new(hydro)
        .with_law(ViscousLaw::Inviscid)
        .unwrap()
}

/// A box floats with its density over water's of its height under (Archimedes), and comes to rest and sleeps.
#[test]
fn draft_is_the_ratio_of_densities() {
    for hertz in [60.0, 240.0] {
        for density in [100.0, 400.0, 700.0] {
            let height = 0.2;
            let mut pond = Pond::new(
                RigidBodyBuilder::dynamic().translation(Vector::Y * 0.15),
                ColliderBuilder::cuboid(0.5, 0.5 * height, 0.4).density(density),
                hertz,
            );
            pond.run(40.0);
            let draft = 0.5 * height - pond.body().translation().y;
            // Air carries its part: ρ = s ρ_w + (1 − s) ρ_a.
            let (water, air) = (Fluid::WATER.density(), Fluid::AIR.density());
            let exact = height * (density - air) / (water - air);
            let miss = (draft / exact - 1.0).abs();
            assert!(miss < 3e-3, "{hertz} Hz, {density}: {draft} for {exact}");
            assert!(pond.body().is_sleeping(), "{hertz} Hz, {density}");
        }
    }
}

/// Times at which a signal goes up through zero, s, between samples by a straight line.
fn crossings(signal: &[f32], dt: f32) -> Vec<f32> {
    let pairs = signal.windows(2).enumerate();
    pairs
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(i, pair)| (i as f32 + pair[0] / (pair[0] - pair[1])) * dt)
        .collect()
}

/// A log that bobs by a hundredth of its draft: period 2π√((m + A)/(ρ g A_w)), A being the added mass of the share
/// under water, which the crate itself reads out.
#[test]
fn heave_has_the_period_of_mass_and_added_mass() {
    for hertz in [60.0, 240.0] {
        let half = Vector::new(0.6, 0.1, 0.2);
        let density = 500.0;
        let rest = half.y * (1.0 - 2.0 * (density - 1.184) / (997.0 - 1.184));
        let draft = half.y - rest;
        let mut pond = Pond::over(
            Fluid::WATER,
            RigidBodyBuilder::dynamic().translation(Vector::Y * (rest + 0.01 * draft)),
            ColliderBuilder::cuboid(half.x, half.y, half.z).density(density),
            hertz,
            ideal,
        );
        let mut heights = Vec::new();
        let dt = pond.world.integration_parameters.dt;
        for _ in 0..(8.0 * hertz) as usize {
            pond.immersion.step(&mut pond.world);
            heights.push(pond.body().translation().y - rest);
        }
        let ups = crossings(&heights, dt);
        let period = (ups[ups.len() - 1] - ups[0]) / (ups.len() - 1) as f32;
        let mass = pond.immersion.mass_of(pond.body).unwrap().mass as f32;
        let own = Vector6::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
        let whole = pond.immersion.mass_matrix_of(pond.body).unwrap();
        let with_fluid = own.dot(&(whole * own)) as f32;
        let stiffness = (997.0 - 1.184) * 9.81 * 4.0 * half.x * half.z;
        let exact = 2.0 * PI * (with_fluid / stiffness).sqrt();
        println!("{hertz}: {period} for {exact}, m {mass}, with fluid {with_fluid}");
        assert!(
            (period / exact - 1.0).abs() < 0.01,
            "{hertz}: {period} for {exact}"
        );
        let last = heights[heights.len() - (2.0 * hertz) as usize..]
            .iter()
            .fold(0.0_f32, |a, b| a.max(b.abs()));
        println!("amplitude after 8 s {}", last / (0.01 * draft));
        assert!(last / (0.01 * draft) > 0.9 && last / (0.01 * draft) < 1.02);
    }
}

/// A ball shot from air into water without gravity or friction: m v = (m + ½ρV) v', and the other way nothing changes.
#[test]
fn entry_conserves_momentum_and_exit_velocity() {
    for hertz in [60.0, 240.0] {
        for speed in [1.0, 30.0] {
            let shoot = |from: f32, speed: f32| {
                let body = RigidBodyBuilder::dynamic()
                    .translation(Vector::Y * from)
                    .linvel(Vector::Y * speed);
                let ball = ColliderBuilder::ball(0.1).density(500.0);
                let mut pond = Pond::over(Fluid::WATER, body, ball, hertz, ideal);
                pond.world.gravity = Vector::ZERO;
                pond.run(6.0 / speed.abs());
                pond.body().linvel().y
            };
            let down = shoot(1.0, -speed);
            let (dry, air, water) = (500.0, 0.5 * 1.184, 0.5 * 997.0);
            let exact = -speed * (dry + air) / (dry + water);
            assert!(
                (down / exact - 1.0).abs() < 1e-3,
                "{hertz} {speed}: {down} for {exact}"
            );
            let up = shoot(-1.0, speed);
            assert!((up / speed - 1.0).abs() < 1e-3, "{hertz} {speed}: {up}");
        }
    }
}
