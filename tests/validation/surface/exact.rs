//! Floating bodies against closed forms.

use super::{Pond, ideal};
use rapier3d::prelude::*;
use rapier3d_immersed::Fluid;
use rapier3d_immersed::rapier3d;
use rapier3d_immersed::rapier3d::na::Vector6;
use std::f32::consts::PI;

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

/// A log that bobs by a twentieth of its draft: period 2π√((m + A)/(ρ g A_w)), A being the added mass of the share
/// under water, which the crate itself reads out, in the mean over the swings: it changes by a twentieth with the draft.
#[test]
fn heave_has_the_period_of_mass_and_added_mass() {
    for hertz in [60.0, 240.0] {
        let half = Vector::new(0.6, 0.1, 0.2);
        let density = 500.0;
        let rest = half.y * (1.0 - 2.0 * (density - 1.184) / (997.0 - 1.184));
        let draft = half.y - rest;
        let mut pond = Pond::over(
            Fluid::WATER,
            RigidBodyBuilder::dynamic().translation(Vector::Y * (rest + 0.05 * draft)),
            ColliderBuilder::cuboid(half.x, half.y, half.z).density(density),
            hertz,
            ideal,
        );
        let (mut heights, mut with_fluid) = (Vec::new(), 0.0);
        let dt = pond.world.integration_parameters.dt;
        let own = Vector6::new(0.0, 1.0, 0.0, 0.0, 0.0, 0.0);
        for _ in 0..(8.0 * hertz) as usize {
            pond.immersion.step(&mut pond.world);
            heights.push(pond.body().translation().y - rest);
            let whole = pond.immersion.mass_matrix_of(pond.body).unwrap();
            with_fluid += own.dot(&(whole * own)) as f32;
        }
        with_fluid /= heights.len() as f32;
        let ups = crossings(&heights, dt);
        let period = (ups[ups.len() - 1] - ups[0]) / (ups.len() - 1) as f32;
        let mass = pond.immersion.mass_of(pond.body).unwrap().mass as f32;
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
        println!("amplitude after 8 s {}", last / (0.05 * draft));
        assert!(last / (0.05 * draft) > 0.9 && last / (0.05 * draft) < 1.02);
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

/// The righting moment of a box at heel φ, while its sides stay wall-sided: m g sin φ (GM + ½ BM tan² φ), with
/// GM = BM − BG and BM = I/V (Attwood; Rawson & Tupper, *Basic Ship Theory*). The box heels about the middle of its
/// waterline, where the displacement stays.
#[test]
fn righting_moment_of_a_wall_sided_box() {
    let half = Vector::new(1.0, 0.15, 0.3);
    let density = 498.5 + 0.592; // half of it under, air counted
    for degrees in [2.0_f32, 10.0, 20.0] {
        let heel = degrees.to_radians();
        // The center of mass is at the waterline, so that it stays where it is.
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic().rotation(Vector::X * heel),
            ColliderBuilder::cuboid(half.x, half.y, half.z).density(density),
            1e6,
        );
        pond.immersion.step(&mut pond.world);
        let forces = pond
            .immersion
            .forces(&pond.world.bodies, pond.body)
            .unwrap();
        let mass = pond.immersion.mass_of(pond.body).unwrap().mass as f32;
        let floats = pond
            .immersion
            .hydrostatics(&pond.world.bodies, pond.body)
            .unwrap();
        // Upright: BM = (2z)²/12 / draft, BG = half of the draft.
        let draft = half.y;
        let (bm, bg) = ((2.0 * half.z).powi(2) / (12.0 * draft), 0.5 * draft);
        // The moment of the water alone, less that of the air that it replaces.
        let exact = mass * 9.81 * heel.sin() * (bm - bg + 0.5 * bm * heel.tan().powi(2));
        let found = -forces.buoyancy.torque.x;
        assert!(
            (found / exact - 1.0).abs() < 3e-3,
            "{degrees}: {found} for {exact}"
        );
        assert!((floats.submerged_share - 0.5).abs() < 1e-3);
        // The waterplane is longer by 1/cos φ across, so that its moment is by 1/cos³ φ.
        let radius = bm / heel.cos().powi(3);
        let found = floats.metacentric_radii[0] as f32;
        assert!(
            (found / radius - 1.0).abs() < 3e-3,
            "{degrees}: {found} for {radius}"
        );
    }
}

/// Small rolling in an ideal fluid: ω² = m g GM (𝕄⁻¹)_φφ, the body being free to sway while it rolls. 𝕄 is read out, GM
/// is I/V − BG.
#[test]
fn roll_has_the_period_of_its_metacentric_height() {
    for hertz in [60.0, 240.0] {
        let half = Vector::new(1.0, 0.15, 0.3);
        let density = 0.5 * (997.0 + 1.184);
        let mut pond = Pond::over(
            Fluid::WATER,
            RigidBodyBuilder::dynamic().rotation(Vector::X * 0.02),
            ColliderBuilder::cuboid(half.x, half.y, half.z).density(density),
            hertz,
            ideal,
        );
        let mut angles = Vec::new();
        for _ in 0..(20.0 * hertz) as usize {
            pond.immersion.step(&mut pond.world);
            angles.push(pond.body().rotation().to_scaled_axis().x);
        }
        let ups = crossings(&angles, pond.world.integration_parameters.dt);
        let period = (ups[ups.len() - 1] - ups[0]) / (ups.len() - 1) as f32;
        let inverse = pond.immersion.mass_matrix_of(pond.body).unwrap();
        let inverse = inverse.try_inverse().unwrap();
        let mass = pond.immersion.mass_of(pond.body).unwrap().mass as f32;
        let draft = half.y;
        let height = (2.0 * half.z).powi(2) / (12.0 * draft) - 0.5 * draft;
        // The air's share of the moment: (ρ_w − ρ_a)/(ρ_w + ρ_a) of it, which half of either displaces.
        let moment = mass * 9.81 * height * (997.0 - 1.184) / (997.0 + 1.184);
        let exact = 2.0 * PI / (moment * inverse[(3, 3)] as f32).sqrt();
        println!("{hertz}: {period} for {exact}");
        assert!(
            (period / exact - 1.0).abs() < 0.02,
            "{hertz}: {period} for {exact}"
        );
    }
}

/// How a long square log floats: upright for relative densities below .2113 and above .7887, on an edge for ½ (*Floating of a
/// Long Square Bar*, Am. J. Phys. 31, 565 (1963)). Let go in between, it turns there.
#[test]
fn a_square_log_floats_upright_or_on_its_edge() {
    for (share, wanted) in [(0.15, 0.0), (0.85, 0.0), (0.5, 45.0_f32)] {
        let density = 1.184 + share * (997.0 - 1.184);
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic().rotation(Vector::X * 12.0_f32.to_radians()),
            ColliderBuilder::cuboid(2.0, 0.1, 0.1).density(density),
            60.0,
        );
        pond.run(60.0);
        let side = pond.body().rotation() * Vector::Y;
        let angle = side.y.abs().clamp(0.0, 1.0).acos().to_degrees();
        let angle = angle.min(90.0 - angle);
        println!("{share}: {angle}");
        assert!(
            (angle - wanted).abs() < 2.5,
            "{share}: {angle} for {wanted}"
        );
    }
}

/// A cork let go a meter deep breaks through, bobs, comes to rest and sleeps.
#[test]
fn a_cork_comes_up_and_sleeps() {
    for hertz in [60.0, 240.0] {
        let mut pond = Pond::new(
            RigidBodyBuilder::dynamic().translation(Vector::Y * -1.0),
            ColliderBuilder::cylinder(0.02, 0.012).density(240.0),
            hertz,
        );
        let mut highest = f32::MIN;
        for _ in 0..(30.0 * hertz) as usize {
            pond.immersion.step(&mut pond.world);
            highest = highest.max(pond.body().translation().y);
        }
        println!(
            "{hertz}: up to {highest}, at {}",
            pond.body().translation().y
        );
        assert!(highest > 0.01 && highest < 0.5, "{hertz}: {highest}");
        assert!(pond.body().translation().y.abs() < 0.02);
        assert!(pond.body().is_sleeping(), "{hertz}");
    }
}
