use super::pair::NearField;
use super::solve::Problem;
use crate::geometry::{Ellipsoid, Surface};
use rapier3d::na::Vector3;
use std::collections::HashMap;

fn ico(level: u32) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let t = (1.0 + 5f64.sqrt()) / 2.0;
    let mut v: Vec<Vector3<f64>> = [
        (-1., t, 0.), (1., t, 0.), (-1., -t, 0.), (1., -t, 0.), (0., -1., t), (0., 1., t),
        (0., -1., -t), (0., 1., -t), (t, 0., -1.), (t, 0., 1.), (-t, 0., -1.), (-t, 0., 1.),
    ].iter().map(|(a, b, c)| Vector3::new(*a, *b, *c).normalize()).collect();
    let mut f: Vec<[u32; 3]> = vec![
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
        [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
    ];
    for _ in 0..level {
        let mut mid: HashMap<(u32, u32), u32> = HashMap::new();
        let mut g = vec![];
        for [a, b, c] in &f {
            let mut m = |i: u32, j: u32| *mid.entry((i.min(j), i.max(j))).or_insert_with(|| {
                v.push(((v[i as usize] + v[j as usize]) / 2.0).normalize());
                v.len() as u32 - 1
            });
            let (x, y, z) = (m(*a, *b), m(*b, *c), m(*c, *a));
            g.extend([[*a, x, z], [*b, y, x], [*c, z, y], [x, y, z]]);
        }
        f = g;
    }
    (v, f)
}

fn grid(n: usize, lo: f64, hi: f64, p: f64) -> Vec<f64> {
    (0..=n).map(|i| { let s = 2.0 * i as f64 / n as f64 - 1.0; let g = 1.0 - (1.0 - s.abs()).powf(p); lo + (hi - lo) * 0.5 * (1.0 + s.signum() * g) }).collect()
}

fn boxmesh(size: [f64; 3], n: [usize; 3], p: f64) -> Surface {
    let g: Vec<Vec<f64>> = (0..3).map(|k| grid(n[k], -size[k] / 2.0, size[k] / 2.0, p)).collect();
    let (mut v, mut f) = (vec![], vec![]);
    for k in 0..3 {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        for side in 0..2 {
            let base = v.len() as u32;
            for i in 0..=n[a] { for j in 0..=n[b] {
                let mut x = Vector3::zeros();
                x[k] = if side == 0 { -size[k] / 2.0 } else { size[k] / 2.0 };
                x[a] = g[a][i]; x[b] = g[b][j]; v.push(x);
            } }
            for i in 0..n[a] { for j in 0..n[b] {
                let id = |i: usize, j: usize| base + (i * (n[b] + 1) + j) as u32;
                let q = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                let q = if side == 1 { q } else { [q[3], q[2], q[1], q[0]] };
                f.push([q[0], q[1], q[2]]); f.push([q[0], q[2], q[3]]);
            } }
        }
    }
    Surface::new(&v, &f).unwrap()
}

fn near() -> NearField {
    let e = |k: &str, d: f64| std::env::var(k).ok().and_then(|s| s.parse().ok()).unwrap_or(d);
    NearField { far: e("FAR", 2.0), touching_levels: e("TL", 6.0) as u32, close_levels: e("CL", 14.0) as u32 }
}

#[test]
fn scratch() {
    let near = near();
    for axes in [[1.0, 1.0, 1.0], [3.0, 2.0, 1.0], [3.65, 2.1, 0.15], [3.65, 2.1, 0.015], [3.65, 2.1, 0.0015]] {
        let e = Ellipsoid { semi_axes: axes.into() };
        let exact = e.added_mass().to_matrix6();
        for level in 1..=std::env::var("LV").ok().and_then(|s| s.parse().ok()).unwrap_or(3) {
            let (v, f) = ico(level);
            let s = Surface::new(&v, &f).unwrap();
            let grow = (e.volume() / (s.volume_integrals().volume * axes[0] * axes[1] * axes[2])).cbrt();
            let s = s.map(|x| x.component_mul(&Vector3::from(axes)) * grow);
            let t = std::time::Instant::now();
            let sol = Problem::closed(&s).solve(&near, &|_| ());
            let m = sol.added_mass.to_matrix6();
            let err: Vec<String> = (0..6).map(|i| format!("{:+.2e}", if exact[(i, i)] > 0.0 { m[(i, i)] / exact[(i, i)] - 1.0 } else { m[(i, i)] })).collect();
            println!("{axes:?} {} {:?} err {} asym {:.1e} {} near {}", f.len(), t.elapsed(), err.join(" "), sol.asymmetry, sol.definite, sol.near_pairs);
        }
    }
    for (size, ns, want) in [([1.0, 1.0, 1.0], [[4, 4, 4], [8, 8, 8], [14, 14, 14]], [0.6383, 0.6383, 0.0392]), ([2.0, 1.0, 1.0], [[6, 4, 4], [10, 7, 7], [16, 12, 12]], [0.334, 0.834, 0.0]),
        ([1.0, 1.0, 0.01], [[6, 6, 2], [12, 12, 2], [20, 20, 2]], [0.0, 0.579, 0.8176]), ([1.0, 1.0, 0.001], [[6, 6, 2], [12, 12, 2], [20, 20, 2]], [0.0, 0.579, 0.8176])] {
        for p in [1.0, 2.0, 3.0] { for n in ns {
            let s = boxmesh(size, n, p);
            let t = std::time::Instant::now();
            let sol = Problem::closed(&s).solve(&near, &|_| ());
            let m = sol.added_mass.to_matrix6();
            let plate = std::f64::consts::PI / 4.0;
            println!("{size:?} {n:?} p={p} {:?} k {:.5} {:.5} {:.5} plate {:.5} {:.5} rot {:.6} {:.6} {:.6} want {want:?} asym {:.1e} {}", t.elapsed(), m[(0, 0)] / size.iter().product::<f64>(), m[(1, 1)] / size.iter().product::<f64>(), m[(2, 2)] / size.iter().product::<f64>(), m[(2,2)] / plate, m[(3,3)] / (plate / 32.0), m[(3, 3)], m[(4, 4)], m[(5, 5)], sol.asymmetry, sol.definite);
        } }
    }
}
