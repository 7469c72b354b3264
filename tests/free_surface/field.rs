//! Sampled heights.

use crate::{at_surface, rise};
use rapier3d_immersed::free_surface::{
    Dispersion, FreeSurface, HeightField, HeightGrid, Wave, Waves,
};
use rapier3d_immersed::rapier3d::na::Vector3;

fn waves() -> Waves {
    let one = Wave {
        wavelength: 8.0,
        ..Wave::default()
    };
    let other = Wave {
        amplitude: 0.05,
        wavelength: 4.0,
        direction: [0.0, 1.0],
        phase: 1.0,
    };
    Waves::new(Dispersion::default(), &[one, other]).unwrap()
}

/// The waves at nodes of a spacing, over a periodic patch of 8 × 4 m, with the water's velocity at the surface.
fn sampled(per_meter: usize) -> HeightField {
    let waves = waves();
    let nodes = [8 * per_meter, 4 * per_meter];
    let step = 1.0 / per_meter as f64;
    let grid = HeightGrid {
        nodes,
        spacing: [step; 2],
        periodic: [true; 2],
        frames: 8 * per_meter,
        interval: 0.25 * step,
        ..HeightGrid::default()
    };
    let places = (0..nodes[0] * nodes[1] * grid.frames).map(|n| {
        let (i, j, k) = (
            n % nodes[0],
            n / nodes[0] % nodes[1],
            n / nodes[0] / nodes[1],
        );
        (i as f64 * step, j as f64 * step, k as f64 * grid.interval)
    });
    let heights = places
        .clone()
        .map(|(x, z, t)| waves.elevation(x, z, t).height as f32);
    let velocities = places.map(|(x, z, t)| {
        let velocity = waves.velocity(&at_surface(&waves, x, z, t), t);
        [velocity.x as f32, velocity.z as f32]
    });
    let field = HeightField::new(grid, heights.collect()).unwrap();
    field.with_velocities(velocities.collect()).unwrap()
}

/// Largest errors of height, slope and rise away from the first and last frame.
fn errors(field: &HeightField) -> [f64; 3] {
    let (waves, mut most) = (waves(), [0.0; 3]);
    for i in 0..400 {
        let (x, z, t) = (
            0.173 * f64::from(i) - 20.0,
            0.091 * f64::from(i) - 9.0,
            0.5 + 0.0021 * f64::from(i),
        );
        let (found, exact) = (field.elevation(x, z, t), waves.elevation(x, z, t));
        let point = Vector3::new(x, found.height, z);
        let velocity = field.velocity(&point, t);
        let up = velocity.y - velocity.x * found.slope[0] - velocity.z * found.slope[1];
        let errors = [
            found.height - exact.height,
            (found.slope[0] - exact.slope[0]).hypot(found.slope[1] - exact.slope[1]),
            up - rise(&waves, x, z, t),
        ];
        for (most, error) in most.iter_mut().zip(errors) {
            *most = f64::max(*most, error.abs());
        }
    }
    most
}

/// Catmull and Rom's interpolation is of the third order at least, and its derivative of the second.
#[test]
fn finer_grids_are_nearer_the_waves() {
    let [coarse, fine, finer] = [1, 2, 4].map(|per_meter| errors(&sampled(per_meter)));
    println!("{coarse:?} {fine:?} {finer:?}");
    for (order, power) in [(0, 6.0), (1, 3.4), (2, 3.4)] {
        assert!(coarse[order] > power * fine[order] && fine[order] > power * finer[order]);
    }
    assert!(finer[0] < 2e-4);
}

/// Water at the surface has the velocity that was given, and falls off below.
#[test]
fn water_moves_with_the_surface() {
    let (field, waves) = (sampled(4), waves());
    for i in 0..50 {
        let (x, z, t) = (
            0.31 * f64::from(i),
            0.17 * f64::from(i),
            0.3 + 0.02 * f64::from(i),
        );
        let point = at_surface(&field, x, z, t);
        let velocity = field.velocity(&point, t);
        let exact = waves.velocity(&point, t);
        // The waves are right to their steepness, of .16 in all.
        assert!(
            (velocity.xz() - exact.xz()).norm() < 1e-3,
            "{velocity} {exact}"
        );
        assert!((velocity - exact).norm() < 0.16 * 0.3, "{velocity} {exact}");
        let below = field.velocity(&(point - Vector3::y()), t);
        assert!((below - velocity * (-1.0_f64).exp()).norm() < 1e-12);
        assert_eq!(field.velocity(&(point + Vector3::y()), t), velocity);
    }
    assert!(!field.is_still() && field.bend() == 1.0);
}

/// No slope and no rise jumps: not at nodes, not at frames, not where the grid ends, begins again or stands still.
#[test]
fn slopes_and_rises_do_not_jump() {
    for (periodic, repeats) in [
        ([false; 2], false),
        ([true, false], true),
        ([true; 2], false),
    ] {
        let grid = HeightGrid {
            nodes: [4, 3],
            frames: 5,
            interval: 0.5,
            periodic,
            repeats,
            ..HeightGrid::default()
        };
        let heights = (0..60).map(|i| (f64::from(i) * 2.3).sin() as f32).collect();
        let field = HeightField::new(grid, heights).unwrap();
        let all = |x: f64, z: f64, t: f64| {
            let here = field.elevation(x, z, t);
            let rise = field.velocity(&Vector3::new(x, 9.0, z), t).y;
            [here.height, here.slope[0], here.slope[1], rise]
        };
        let e = 1e-9;
        for i in -4..9 {
            let at = f64::from(i);
            for (dx, dz, dt) in [(e, 0.0, 0.0), (0.0, e, 0.0), (0.0, 0.0, e)] {
                let place = |s: f64| {
                    let [x, z, t] = [(dx, 0.3), (dz, 1.4), (dt, 0.7)]
                        .map(|(d, rest)| if d > 0.0 { at + s * d } else { rest });
                    all(x, z, if dt > 0.0 { 0.5 * t } else { t })
                };
                for (before, after) in place(-1.0).into_iter().zip(place(1.0)) {
                    assert!((before - after).abs() < 1e-6, "at {at}");
                }
            }
            assert!(all(at, 0.3, 0.7)[0].abs() <= field.highest());
        }
        let same = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert_eq!(same(all(0.7, 0.4, 0.3), all(4.7, 0.4, 0.3)), periodic[0]);
        assert_eq!(same(all(0.7, 0.4, 0.3), all(0.7, -2.6, 0.3)), periodic[1]);
        assert_eq!(same(all(0.7, 0.4, 0.3), all(0.7, 0.4, 2.8)), repeats);
        assert_eq!(same(all(0.7, 0.4, 2.9), all(0.7, 0.4, 77.0)), !repeats);
        if !repeats {
            assert!(all(0.7, 0.4, 77.0)[3].abs() < 1e-15);
            assert_eq!(all(0.7, 0.4, -77.0)[0], all(0.7, 0.4, -2.0)[0]);
        }
    }
}

/// Places that are none give numbers, not NaN; a single frame never moves.
#[test]
fn every_place_has_a_height() {
    let grid = HeightGrid {
        nodes: [3, 3],
        periodic: [true, false],
        ..HeightGrid::default()
    };
    let field = HeightField::new(grid, (0..9).map(|i| i as f32).collect()).unwrap();
    assert!(field.is_still());
    assert_eq!(field.elevation(1.0, 2.0, 5.0).height, 7.0);
    for bad in [f64::NAN, f64::INFINITY, -1e300] {
        for (x, z, t) in [(bad, 1.0, 0.0), (1.0, bad, 0.0), (1.0, 1.0, bad)] {
            let elevation = field.elevation(x, z, t);
            assert!(elevation.height.abs() <= field.highest());
            let velocity = field.velocity(&Vector3::new(x, bad, z), t);
            assert!(velocity == Vector3::zeros(), "{velocity}");
        }
    }
}

/// A file that keeps its checksum, whatever else stands in it, is refused or gives a surface of numbers.
#[test]
fn altered_files_are_refused_or_give_numbers() {
    const HEADER: usize = 28;
    let seal = |content: &[u8], bytes: &[u8]| {
        let checksum = content
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
            });
        let length = (content.len() as u64).to_le_bytes();
        [&bytes[..12], &length, &checksum.to_le_bytes(), content].concat()
    };
    let grid = HeightGrid {
        nodes: [3, 2],
        frames: 2,
        ..HeightGrid::default()
    };
    let field = HeightField::new(grid, (0..12).map(|i| i as f32).collect()).unwrap();
    let bytes = field
        .with_velocities(vec![[0.5, 1.0]; 12])
        .unwrap()
        .to_bytes();
    let content = &bytes[HEADER..];
    assert_eq!(seal(content, &bytes), bytes);
    let (mut refused, mut loaded) = (0, 0);
    let mut load = |content: &[u8]| match HeightField::from_bytes(&seal(content, &bytes)) {
        Ok(field) => {
            loaded += 1;
            for (x, z, t) in [(0.5, 0.5, 0.5), (-7.0, 1e9, 3.0), (1.0, 0.0, -1.0)] {
                let elevation = field.elevation(x, z, t);
                let numbers = [elevation.height, elevation.slope[0], elevation.slope[1]];
                let velocity = field.velocity(&Vector3::new(x, -0.1, z), t);
                assert!(
                    numbers.iter().chain(velocity.iter()).all(|x| x.is_finite()),
                    "{field:?}"
                );
            }
        }
        Err(_) => refused += 1,
    };
    for at in 0..content.len() {
        load(&content[..at]);
        for other in [
            0,
            0x7f,
            0xff,
            content[at] ^ 1,
            content[at] ^ 0x40,
            content[at] ^ 0x80,
        ] {
            let mut bad = content.to_vec();
            bad[at] = other;
            load(&bad);
        }
    }
    println!("{refused} refused, {loaded} loaded");
    assert!(refused > 300 && loaded > 300, "{refused} {loaded}");
}
