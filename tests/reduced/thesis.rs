//! The four examples of thesis §6.4.

use rapier3d_immersed::reduced::axis::Axis;
use rapier3d_immersed::reduced::dormand_prince::Accuracy;
use rapier3d_immersed::reduced::evolution::{Coupling, EvolutionParams, evolve};
use rapier3d_immersed::reduced::pgd::PgdParams;
use rapier3d_immersed::reduced::quadratic::{InitialTerm, QuadraticSystem, RateTerm};
use rand::{RngExt, SeedableRng};

fn falling() -> QuadraticSystem {
    let rate = |coefficient: f64, states: &[usize], parameters: &[(usize, fn(f64) -> f64)]| RateTerm {
        component: 0, coefficient, states: states.to_vec(), parameters: parameters.to_vec(),
    };
    QuadraticSystem {
        components: 1,
        parameters: vec![Axis::spectral(0.5, 2.0, 24).unwrap()],
        initial: vec![],
        rates: vec![rate(-9.81, &[], &[]), rate(1.23 * 0.5 / (2.0 * 0.1), &[0, 0], &[(0, |c| c)])],
    }
}

#[test]
fn falling_body() {
    let time = Axis::time(0.0, 1.0, 16, 4).unwrap();
    for rounds in [2, 4] {
    let params = EvolutionParams { pgd: PgdParams { max_modes: 12, tolerance: 1e-12, update_rounds: rounds, ..PgdParams::default() }, ..EvolutionParams::default() };
    let exact = |t: f64, c: f64| {
        let terminal = (2.0 * 0.1 * 9.81 / (1.23 * c * 0.5) as f64).sqrt();
        -terminal * (9.81 * t / terminal).tanh()
    };
    let (_, report) = evolve(&falling(), &time, &params, |n, u| {
        let (mut e, mut s) = (0.0, 0.0);
        for i in 0..=60 { for j in 0..=60 {
            let (t, c) = (i as f64 / 60.0, 0.5 + 1.5 * j as f64 / 60.0);
            let v = exact(t, c);
            e += (u.evaluate(&[t, c])[0] - v).powi(2); s += v * v;
        }}
        println!("{n} {:.3e}", (e / s).sqrt());
    }).unwrap();
    println!("{report:?}");
    }
}

fn triple() -> QuadraticSystem {
    let rate = |component, coefficient: f64, states: &[usize]| RateTerm {
        component, coefficient, states: states.to_vec(), parameters: vec![],
    };
    QuadraticSystem {
        components: 3,
        parameters: vec![Axis::spectral(0.0, 1.0, 10).unwrap(); 3],
        initial: (0..3).map(|k| InitialTerm { component: k, coefficient: 1.0, parameters: vec![(k, |x| x)] }).collect(),
        rates: vec![
            rate(0, 1.0, &[]), rate(0, -1.0, &[1, 2]),
            rate(1, 2.0, &[]), rate(1, -1.0, &[0, 2]),
            rate(2, 3.0, &[]), rate(2, -1.0, &[0, 1]),
        ],
    }
}

#[test]
fn three_unknown_initial_values() {
    let system = triple();
    println!("{:?}", system.find_singularity(1.0, 1));
    let time = Axis::time(0.0, 0.5, 3, 4).unwrap();
    let mut random = rand_pcg::Pcg64::seed_from_u64(5);
    let accuracy = Accuracy { relative: 1e-11, absolute: 1e-11, ..Accuracy::default() };
    let points: Vec<([f64; 4], Vec<f64>)> = (0..400).map(|_| {
        let p = [random.random_range(0.0..0.5), random.random(), random.random(), random.random()];
        (p, system.integrate(&p[1..], p[0], accuracy).unwrap())
    }).collect();
    for (coupling, rounds, modes) in [(Coupling::Monolithic, 2, 40), (Coupling::Monolithic, 5, 24), (Coupling::Decoupled, 2, 24)] {
        let start = std::time::Instant::now();
        let params = EvolutionParams { pgd: PgdParams { max_modes: modes, tolerance: 1e-6, update_rounds: rounds, ..PgdParams::default() }, coupling, ..EvolutionParams::default() };
        let mut line = String::new();
        let (_, report) = evolve(&system, &time, &params, |n, u| {
            let (mut e, mut s) = (0.0, 0.0);
            for (p, v) in &points {
                let w = u.evaluate(p);
                for k in 0..3 { e += (w[k] - v[k]).powi(2); s += v[k] * v[k]; }
            }
            line += &format!("{n}:{:.2e}({:.1}s) ", (e / s).sqrt(), start.elapsed().as_secs_f64());
        }).unwrap();
        println!("{coupling:?} {rounds}: {line}");
        println!("{:.2e}", report.residuals.last().unwrap());
    }
}
