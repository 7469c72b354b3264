use rapier3d_immersed::reduced::axis::Axis;
use rapier3d_immersed::reduced::cross::CrossParams;
use rapier3d_immersed::reduced::dormand_prince::Accuracy;
use rapier3d_immersed::reduced::falling_plate::FallingPlate;
use rapier3d_immersed::reduced::surrogate::{FlowMap, TrajectorySurrogate};
use rand::{RngExt, SeedableRng};

fn plate(p: &[f64]) -> FallingPlate {
    FallingPlate { translational_lift: p[0], rotational_lift: p[1], drag_mean: p[2], inertia_ratio: p[3], ..FallingPlate::default() }
}
const ACC: Accuracy = Accuracy { relative: 1e-9, absolute: 1e-9, max_steps: 100_000 };

#[test]
fn explore() {
    for (lo, hi) in [(0.45, 0.55), (1.1, 1.4)] {
        let axes = |n: usize| vec![
            Axis::spectral(1.2 * 0.95, 1.2 * 1.05, n).unwrap(),
            Axis::spectral(3.1416 * 0.95, 3.1416 * 1.05, n).unwrap(),
            Axis::spectral(1.4 * 0.95, 1.4 * 1.05, n).unwrap(),
            Axis::spectral(lo, hi, n).unwrap()];
        let angle = Axis::spectral(0.5, 1.0, 9).unwrap();
        let mut random = rand_pcg::Pcg64::seed_from_u64(7);
        let horizons = [2.0, 5.0, 10.0, 20.0, 40.0];
        let points: Vec<Vec<f64>> = (0..200).map(|_| axes(9).iter().chain([&angle]).map(|a| random.random_range(a.start()..a.end())).collect()).collect();
        let truth: Vec<Vec<[f64; 6]>> = points.iter().map(|p| plate(p).trajectory(&[1e-3, 1e-3, 1e-3, p[4], 0.0, 0.0], &horizons, ACC)).collect();
        let sd = |h: usize| { let n = truth.len() as f64; let m = truth.iter().map(|t| t[h][4]).sum::<f64>() / n; (truth.iter().map(|t| (t[h][4] - m).powi(2)).sum::<f64>() / n).sqrt() };
        // trajectory
        for end in horizons {
            let t0 = std::time::Instant::now();
            let time = Axis::elements(0.0, end, (end as usize / 2).max(1), 8).unwrap();
            let model = |p: &[f64], times: &[f64], out: &mut [f64]| {
                for (o, s) in out.chunks_exact_mut(3).zip(plate(p).trajectory(&[1e-3, 1e-3, 1e-3, p[4], 0.0, 0.0], times, ACC)) { o.copy_from_slice(&s[3..]); }
            };
            let mut all = axes(9); all.push(angle.clone());
            let (s, r) = TrajectorySurrogate::bake(time, 3, all, model, &CrossParams { tolerance: 1e-6, max_evaluations: 20_000, ..CrossParams::default() }).unwrap();
            let h = horizons.iter().position(|x| *x == end).unwrap();
            let err = (points.iter().zip(&truth).map(|(p, t)| (s.evaluate(p, &[end])[1] - t[h][4]).powi(2)).sum::<f64>() / 200.0).sqrt() / sd(h);
            println!("I* {lo}-{hi} T={end}: err {err:.1e} evals {} ranks {:?} nodal err {:.1e} {:.1}s", r.evaluations, s.train().ranks(), r.errors.last().unwrap(), t0.elapsed().as_secs_f64());
        }
        // flow map
        for (step, el, deg, tol) in [(0.25, 2, 5, 1e-5), (0.25, 4, 4, 1e-6)] {
            let t0 = std::time::Instant::now();
            let state = vec![
                Axis::elements(-2.5, 2.5, el, deg).unwrap(), Axis::elements(-1.6, 1.6, el, deg).unwrap(),
                Axis::elements(-1.6, 1.6, el, deg).unwrap(), Axis::elements(-1.5708, 1.5708, 1, 9).unwrap()];
            let model = |s: &[f64], p: &[f64], out: &mut [f64]| {
                let mut x = [s[0], s[1], s[2], s[3], 0.0, 0.0];
                plate(p).advance(&mut x, step, Accuracy { relative: 1e-8, absolute: 1e-8, ..ACC });
                for k in 0..6 { out[k] = x[k] - if k < 4 { s[k] } else { 0.0 }; }
            };
            let (f, r) = FlowMap::bake(step, state, axes(4), 2, model, &CrossParams { tolerance: tol, max_evaluations: 400_000, rank_growth: 3, max_rank: 60, ..CrossParams::default() }).unwrap();
            println!("flow map {step} {el}x{deg}: {r:?} ranks {:?} {:.1}s", f.train().ranks(), t0.elapsed().as_secs_f64());
            let mut errs = vec![0.0; horizons.len()];
            let (mut scratch, mut change) = (vec![], [0.0; 6]);
            let t1 = std::time::Instant::now(); let mut steps = 0;
            for (p, t) in points.iter().zip(&truth) {
                let mut x = [1e-3, 1e-3, 1e-3, p[4], 0.0, 0.0];
                let mut h = 0;
                for i in 1..=(40.0 / step) as usize {
                    // symmetric reduction
                    let turns = (x[3] / std::f64::consts::PI).round();
                    let flip = if turns as i64 % 2 == 0 { 1.0 } else { -1.0 };
                    let s = [flip * x[0], flip * x[1], x[2], x[3] - turns * std::f64::consts::PI];
                    f.change(&s, &p[..4], &mut change, &mut scratch); steps += 1;
                    for k in 0..6 { x[k] += change[k] * if k < 2 { flip } else { 1.0 }; }
                    if (i as f64 * step - horizons[h]).abs() < 1e-9 { errs[h] += (x[4] - t[h][4]).powi(2); h += 1; }
                }
            }
            println!("{:.2} us/step", t1.elapsed().as_secs_f64() * 1e6 / steps as f64);
            for (h, e) in errs.iter().enumerate() { print!(" T={}: {:.1e}", horizons[h], (e / 200.0f64).sqrt() / sd(h)); }
            println!();
        }
    }
}
