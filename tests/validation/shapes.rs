//! Any outline flies by its own planform, moments and chord: nothing here is fitted to a shape, and
//! mass that is off the center acts because the pressure stays with the shape.

use crate::published::samara::{NUT, box_mass, samara};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::math::{Real, Vector};
use rapier3d_immersed::rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{DryMass, Fluid, FreeBody, HydroProperties, ImmersedBody};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const GRAVITY: Vector3<f64> = Vector3::new(0.0, -9.81, 0.0);

/// Points of a polygon around the origin, which sees all of them.
fn outline(name: &str) -> Vec<[f64; 2]> {
    let around = |count: usize, at: fn(f64) -> [f64; 2]| {
        let angle = move |i| TAU * i as f64 / count as f64;
        (0..count).map(|i| at(angle(i))).collect()
    };
    match name {
        "hexagon" => around(6, |a| [a.cos(), a.sin()]),
        "square" => vec![[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]],
        "ellipse" => around(48, |a| [1.4 * a.cos(), 0.7 * a.sin()]),
        "cross" => [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
            .into_iter()
            .flat_map(|(x, y): (f64, f64)| {
                // The end of an arm, and the corner to the next.
                let (across, half) = ([-y, x], 0.3);
                let arm = |s: f64| [x + s * half * across[0], y + s * half * across[1]];
                [
                    arm(-1.0),
                    arm(1.0),
                    [half * (x + across[0]), half * (y + across[1])],
                ]
            })
            .collect(),
        // Pointed, and widest near the stalk.
        "leaf" => around(64, |a| {
            [1.5 * a.cos(), 0.8 * a.sin() * (1.0 - 0.45 * a.cos())]
        }),
        other => panic!("no outline {other}"),
    }
}

const OUTLINES: [&str; 5] = ["hexagon", "square", "ellipse", "cross", "leaf"];

/// The polygon `scale` times its size in the x–z plane, as a sheet of the given thickness and density.
fn sheet(points: &[[f64; 2]], scale: f64, thickness: f64, density: f64) -> (ImmersedBody, DryMass) {
    let n = points.len() as u32;
    let mut vertices = Vec::new();
    for y in [-0.5 * thickness, 0.5 * thickness] {
        vertices.push(Vector3::new(0.0, y, 0.0));
        let corner = |p: &[f64; 2]| Vector3::new(scale * p[0], y, scale * p[1]);
        vertices.extend(points.iter().map(corner));
    }
    let (top, mut triangles) = (n + 1, Vec::new());
    for i in 0..n {
        let (a, b) = (1 + i, 1 + (i + 1) % n);
        triangles.extend([
            [0, a, b],
            [top, top + b, top + a],
            [a, top + a, top + b],
            [a, top + b, b],
        ]);
    }
    let surface = Surface::new(&vertices, &triangles).unwrap();
    let integrals = surface.volume_integrals();
    let dry = DryMass {
        mass: density * integrals.volume,
        center: integrals.centroid,
        inertia: integrals.unit_inertia() * density,
    };
    let hydro = HydroProperties::from_surface(&surface, integrals.centroid);
    (ImmersedBody::new(hydro), dry)
}

/// The planform is the real one: area and second moments of polygons in closed form.
#[test]
fn planforms_are_those_of_the_outlines() {
    let third = 1.0 / 3.0;
    for (name, area, second) in [
        // Side s: A = 3√3/2 s², I = 5√3/16 s⁴.
        ("hexagon", 1.5 * 3f64.sqrt(), [5.0 / 16.0 * 3f64.sqrt(); 2]),
        ("square", 4.0, [4.0 * third; 2]),
        // Two bars of 2 × 0.6 less the square that they share.
        (
            "cross",
            2.4 - 0.36,
            [(2.0 * 0.216 + 0.6 * 8.0 - 0.1296) / 12.0; 2],
        ),
    ] {
        let scale = 0.03;
        let (body, _) = sheet(&outline(name), scale, 1e-4, 800.0);
        let plate = &body.hydro.planform;
        let close = |ours: f64, exact: f64, tolerance: f64| (ours / exact - 1.0).abs() < tolerance;
        // The rim shows as well, as thin as it is, along a plate's own normal by nothing.
        assert!(close(plate.area, area * scale.powi(2), 1e-6), "{name}");
        for (ours, exact) in plate.second_moment.iter().zip(second) {
            assert!(close(*ours, exact * scale.powi(4), 1e-6), "{name} {ours}");
        }
    }
}

/// Speed at which the drag along `direction` (of the body's frame) balances the weight in the fluid.
fn terminal(body: &ImmersedBody, mass: &DryMass, fluid: &Fluid, direction: Vector3<f64>) -> f64 {
    let weight = (mass.mass - f64::from(fluid.density()) * body.hydro.volume) * 9.81;
    let mut free = FreeBody::new(body, mass, fluid).unwrap();
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..60 {
        let speed = 0.5 * (low + high);
        free.set_velocity(direction * speed, Vector3::zeros());
        let drag = -free.forces(Vector3::zeros()).drag.force;
        let along = drag.dot(Vector::new(
            direction.x as f32,
            direction.y as f32,
            direction.z as f32,
        ));
        if f64::from(along) < weight {
            low = speed;
        } else {
            high = speed;
        }
    }
    low
}

/// Cut from paper and dropped in air, or from aluminium in water, each shape comes down slower than
/// edgewise, and not slower than a third of its broadside speed: lift carries the best of them.
/// Through rapier it does the same.
#[test]
fn every_outline_falls_between_edgewise_and_broadside() {
    let paper = (0.02, 1e-4, 800.0, Fluid::AIR);
    let aluminium = (0.01, 1e-3, 2700.0, Fluid::WATER);
    for name in OUTLINES {
        for (scale, thickness, density, fluid) in [paper, aluminium] {
            let (body, mass) = sheet(&outline(name), scale, thickness, density);
            let normal = body.hydro.planform.axes * Vector3::z();
            let along = body.hydro.planform.axes * Vector3::x();
            let broadside = terminal(&body, &mass, &fluid, normal);
            let edgewise = terminal(&body, &mass, &fluid, along);
            assert!(edgewise > 2.0 * broadside, "{name}");
            for tilt in [0.1, 0.5, 1.2] {
                let turn = Vector3::new(tilt, 0.2, 0.3 * tilt);
                let mut free = FreeBody::new(&body, &mass, &fluid).unwrap();
                free.set_orientation(UnitQuaternion::from_scaled_axis(turn));
                let (release, dt) = (BodyState::of(&free), 1.0 / 240.0);
                let mut rapier =
                    BodyInWorld::new(body.clone(), &mass, fluid, &release, dt, 9.81).unwrap();
                let (steps, half) = (2880, 1440);
                let mut before = [0.0; 2];
                for step in 0..steps {
                    if step == half {
                        before = [free.position.y, rapier.state().position.y];
                    }
                    free.step(dt, GRAVITY);
                    rapier.step();
                }
                let fallen = [
                    free.position.y - before[0],
                    rapier.state().position.y - before[1],
                ];
                for descent in fallen.map(|y| -y / (0.5 * f64::from(steps) / 240.0)) {
                    assert!(
                        descent > broadside / 3.0 && descent < edgewise,
                        "{name}, tilt {tilt}: {descent} m/s, broadside {broadside}, edgewise {edgewise}"
                    );
                }
            }
        }
    }
}

/// Set spinning and gliding in a still fluid without gravity, none of them gains energy in any step,
/// weighted on one side or not.
#[test]
fn no_outline_gains_energy() {
    for name in OUTLINES {
        for (fluid, density, dt) in [
            (Fluid::AIR, 800.0, 1.0 / 60.0),
            (Fluid::WATER, 500.0, 1.0 / 240.0),
            (Fluid::WATER, 8000.0, 1.0 / 20.0),
        ] {
            let (body, mass) = sheet(&outline(name), 0.02, 1e-4, density);
            let weight = box_mass([2e-3; 3], 0.5 * mass.mass, [0.012, 0.0, 0.004]);
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
                    assert!(
                        now <= energy * (1.0 + 1e-9),
                        "{name} {step}: {energy} {now}"
                    );
                    energy = now;
                }
                assert!(energy.is_finite(), "{name}");
            }
        }
    }
}

/// How a card flew over the second half of its fall.
#[derive(Debug)]
struct Flight {
    /// Turns about its long axis.
    turns: f64,
    /// Horizontal and downward mean velocity, m/s.
    drift: f64,
    descent: f64,
}

/// A card of span (x) × thickness × chord (z) with a rod along one of its long edges, so heavy that the
/// center of mass is `offset` chords in front of the middle.
fn card(
    span: f64,
    chord: f64,
    thickness: f64,
    density: f64,
    offset: f64,
) -> (ImmersedBody, DryMass) {
    let half = [span, thickness, chord].map(|x| (0.5 * x) as Real);
    let shape = SharedShape::cuboid(half[0], half[1], half[2]);
    let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
    let paper = box_mass(
        [span, thickness, chord],
        density * span * chord * thickness,
        [0.0; 3],
    );
    let mass = if offset > 0.0 {
        let rod = paper.mass * 2.0 * offset / (1.0 - 2.0 * offset);
        paper.combined(&box_mass([span, 1e-3, 1e-3], rod, [0.0, 0.0, 0.5 * chord]))
    } else {
        paper
    };
    (ImmersedBody::new(hydro), mass)
}

/// Released with its heavy edge down by `tilt`.
fn fly((body, mass): &(ImmersedBody, DryMass), fluid: Fluid, tilt: f64) -> Flight {
    let mut free = FreeBody::new(body, mass, &fluid).unwrap();
    free.set_orientation(UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt));
    let (dt, steps) = (1.0 / 480.0, 2880);
    let (mut turned, mut start) = (0.0, Vector3::zeros());
    for step in 0..steps {
        if step == steps / 2 {
            start = free.position;
        }
        free.step(dt, GRAVITY);
        if step >= steps / 2 {
            turned += free.angular_velocity().dot(&free.long_axis()) * dt;
        }
    }
    let seconds = dt * f64::from(steps / 2);
    let way = (free.position - start) / seconds;
    Flight {
        turns: turned / TAU,
        drift: way.x.hypot(way.z),
        descent: -way.y,
    }
}

/// A long card of paper autorotates, and goes on doing so with a weight that puts its center of mass 2 %
/// of the chord off the middle: around and around, drifting faster than it comes down.
#[test]
fn a_weighted_card_autorotates() {
    for offset in [0.0, 0.02] {
        for tilt in [0.3, 0.9] {
            let card = card(0.2, 0.04, 3e-4, 700.0, offset);
            let flight = fly(&card, Fluid::AIR, tilt);
            assert!(flight.turns.abs() > 6.0, "{offset} {tilt}: {flight:?}");
            assert!(flight.drift > flight.descent, "{offset} {tilt}: {flight:?}");
        }
    }
}

/// Moving the center of mass of a plate in water forward takes it from swinging to and fro through gliding,
/// no turns and more than a meter forward per meter down, to a dive nose first (the order of Li, Goodwill,
/// Wang & Ristroph 2022). Where the glide begins and ends depends on the law: with the calibration that this
/// was written with it is 2 to 6 % of the chord. Real plates may want their weight farther in front, because
/// the center of pressure of wide plates is one of falling plates, and travels less than that of a glider.
#[test]
fn a_plate_weighted_in_front_glides() {
    let at = |percent: f64| {
        let plate = card(0.3, 0.05, 1e-3, 2700.0, percent / 100.0);
        fly(&plate, Fluid::WATER, 0.6)
    };
    let gliding = |f: &Flight| f.turns.abs() < 0.3 && f.drift > f.descent;
    let bare = at(0.0);
    assert!(!gliding(&bare), "{bare:?}");
    let dive = at(40.0);
    assert!(dive.turns.abs() < 0.3, "{dive:?}");
    assert!(dive.drift < 0.2 * dive.descent, "{dive:?}");
    let glides: Vec<(f64, Flight)> = (1..=66)
        .map(|half| 0.5 * f64::from(half))
        .map(|percent| (percent, at(percent)))
        .filter(|(_, flight)| gliding(flight))
        .collect();
    eprintln!("{glides:.2?}");
    assert!(!glides.is_empty());
    for (percent, glide) in &glides {
        assert!(
            glide.descent < 0.5 * dive.descent,
            "{percent} %: {glide:?}, {dive:?}"
        );
    }
}

/// Let go about as it hangs from the tree (the nut at the stalk, the wing down), a maple seed ends in a spin, and comes down at less than
/// half the speed of its nut alone. Maple samaras (*Acer palmatum*) were measured to spin at 131 rad/s and to come down at 1.2 m/s (Lee, Lee
/// & Sohn, *Exp. Fluids* 55, 1718 (2014)).
#[test]
fn a_maple_seed_spins() {
    let (body, mass) = samara().unwrap();
    let descent = |free: &mut FreeBody| {
        (0..1920).for_each(|_| free.step(1.0 / 480.0, GRAVITY));
        let before = free.position.y;
        (0..480).for_each(|_| free.step(1.0 / 480.0, GRAVITY));
        before - free.position.y
    };
    let nut = {
        let (size, mass) = NUT;
        let half = size.map(|x| (0.5 * x) as Real);
        let shape = SharedShape::cuboid(half[0], half[1], half[2]);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let mass = box_mass(size, mass, [0.0; 3]);
        let mut free = FreeBody::new(&ImmersedBody::new(hydro), &mass, &Fluid::AIR).unwrap();
        free.set_orientation(UnitQuaternion::from_euler_angles(0.4, 0.1, 0.2));
        descent(&mut free)
    };
    for release in 0..8 {
        let angle = f64::from(release) * PI / 4.0;
        let mut free = FreeBody::new(&body, &mass, &Fluid::AIR).unwrap();
        free.set_orientation(UnitQuaternion::from_euler_angles(
            0.3 * angle.cos(),
            0.3 * angle.sin(),
            -FRAC_PI_2,
        ));
        let seed = descent(&mut free);
        let spin = free.angular_velocity().y.abs();
        assert!(seed < 0.5 * nut, "{release}: {seed}, the nut {nut}");
        assert!((seed / 1.2 - 1.0).abs() < 0.15, "{release}: {seed} m/s");
        assert!((spin / 131.0 - 1.0).abs() < 0.15, "{release}: {spin} rad/s");
    }
}
