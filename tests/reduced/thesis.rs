//! The four examples of thesis §6.4.

use rapier3d_immersed::reduced::axis::Axis;
use rapier3d_immersed::reduced::dormand_prince::Accuracy;
use rapier3d_immersed::reduced::evolution::{EvolutionParams, evolve};
use rapier3d_immersed::reduced::pgd::PgdParams;
use rapier3d_immersed::reduced::example_systems::*;
use rand::{RngExt, SeedableRng};

#[test]
fn kirchhoff() {
    let system = kirchhoff_ellipsoid(&Axis::spectral(0.0, 1.0, 5).unwrap());
    println!("{:?}", system.find_singularity(1.0, 1));
    let time = Axis::time(0.0, 1.0, 3, 3).unwrap();
    let mut random = rand_pcg::Pcg64::seed_from_u64(5);
    let accuracy = Accuracy { relative: 1e-11, absolute: 1e-11, ..Accuracy::default() };
    let points: Vec<(Vec<f64>, Vec<f64>)> = (0..400).map(|_| {
        let p: Vec<f64> = (0..7).map(|_| random.random()).collect();
        let v = system.integrate(&p[1..], p[0], accuracy).unwrap();
        (p, v)
    }).collect();
    for rounds in [1, 2] {
        let start = std::time::Instant::now();
        let params = EvolutionParams { pgd: PgdParams { max_modes: 16, tolerance: 1e-6, update_rounds: rounds, ..PgdParams::default() }, ..EvolutionParams::default() };
        let mut line = String::new();
        let (_, report) = evolve(&system, &time, &params, |n, u| {
            let (mut e, mut s) = (0.0, 0.0);
            for (p, v) in &points {
                let w = u.evaluate(p);
                for k in 0..6 { e += (w[k] - v[k]).powi(2); s += v[k] * v[k]; }
            }
            line += &format!("{n}:{:.2e}({:.1}s) ", (e / s).sqrt(), start.elapsed().as_secs_f64());
        }).unwrap();
        println!("{rounds}: {line}");
        println!("{:.2e}", report.residuals.last().unwrap());
    }
}
