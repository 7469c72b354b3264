//! What the default law does not see of a shape is said when it is described, and nothing is said of the bodies
//! that it is for.

use crate::published::bluff::{cone, cup, hemisphere, revolved};
use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::{Isometry3, Vector3};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{
    DragBox, Fluid, HydroProperties, ImmersedBody, Immersion, OutOfScope, Part, StochasticLaw,
    ViscousLaw, Warning,
};
use std::f64::consts::{FRAC_PI_2, TAU};

fn of_shape(shape: &SharedShape) -> HydroProperties {
    HydroProperties::from_shape(shape.as_ref()).unwrap()
}

fn of_surface(surface: &Surface) -> HydroProperties {
    HydroProperties::from_surface(surface, Vector3::zeros())
}

/// Bars of this width along x and z that cross in the middle, 1 long and .01 thick.
fn cross(width: f32) -> SharedShape {
    let bar = SharedShape::cuboid(0.5, 0.005, 0.5 * width);
    let turn = Rotation::from_rotation_y(FRAC_PI_2 as f32);
    SharedShape::compound(vec![
        (Pose::IDENTITY, bar.clone()),
        (Pose::from_rotation(turn), bar),
    ])
}

/// Blades from .1 to 1 along ±x, .1 wide and .002 thick, pitched about x.
fn propeller(pitch: f32) -> SharedShape {
    let blades = [0.0, std::f32::consts::PI].map(|turn| {
        let place = Pose::from_rotation(Rotation::from_rotation_y(turn))
            * Pose::from_translation(Vector::X * 0.55)
            * Pose::from_rotation(Rotation::from_rotation_x(pitch));
        (place, SharedShape::cuboid(0.45, 0.001, 0.05))
    });
    SharedShape::compound(blades.to_vec())
}

/// A plate 2 long, 1 wide, .01 thick, bent to a parabola of this rise over its width.
fn bent(rise: f64) -> Surface {
    const N: u32 = 32;
    let mut vertices = Vec::new();
    for i in 0..=N {
        let x = f64::from(i) / f64::from(N) - 0.5;
        let y = rise * (1.0 - 4.0 * x * x);
        for (y, z) in [(y, -1.0), (y, 1.0), (y + 0.01, -1.0), (y + 0.01, 1.0)] {
            vertices.push(Vector3::new(x, y, z));
        }
    }
    let mut triangles = Vec::new();
    let mut quad = |[a, b, c, d]: [u32; 4]| triangles.extend([[a, b, c], [a, c, d]]);
    for i in (0..4 * N).step_by(4) {
        for [a, b] in [[0, 1], [1, 3], [3, 2], [2, 0]] {
            quad([i + a, i + b, i + 4 + b, i + 4 + a]);
        }
    }
    quad([0, 2, 3, 1]);
    let end = 4 * N;
    quad([end, end + 1, end + 3, end + 2]);
    Surface::new(&vertices, &triangles).unwrap()
}

/// Bodies that the law is for, plates and others, thin and thick, as primitives and as meshes; and pebbles, hulls
/// of random points, which are convex and turn hardly at all in a stream.
#[test]
fn ordinary_bodies_are_in_scope() {
    let shapes = [
        ("leaf", SharedShape::cuboid(0.0365, 0.000_15, 0.021)),
        ("strip", SharedShape::cuboid(0.5, 0.001, 0.02)),
        ("paper", SharedShape::cuboid(0.105, 0.000_05, 0.148)),
        ("coin", SharedShape::cylinder(0.001, 0.01)),
        ("slab", SharedShape::cuboid(0.2, 0.035, 0.1)),
        ("cube", SharedShape::cuboid(0.1, 0.1, 0.1)),
        ("rod", SharedShape::cuboid(0.01, 0.5, 0.01)),
        ("ball", SharedShape::ball(0.1)),
        ("cylinder", SharedShape::cylinder(0.1, 0.05)),
        ("needle", SharedShape::cylinder(1.0, 0.005)),
        ("cone", SharedShape::cone(0.1, 0.05)),
        ("capsule", SharedShape::capsule_y(0.1, 0.05)),
        ("rounded", SharedShape::round_cuboid(0.1, 0.02, 0.05, 0.01)),
    ];
    for (name, shape) in &shapes {
        assert_eq!(of_shape(shape).out_of_scope, [], "{name}");
    }
    let lens = Ellipsoid {
        semi_axes: Vector3::new(1.0, 0.6, 0.05),
    };
    for (name, surface) in [
        ("lens", Surface::ellipsoid(&lens, 8).unwrap()),
        ("cup", cup()),
        ("hemisphere", hemisphere()),
        ("cone", cone(60.0)),
        ("flat", bent(0.0)),
    ] {
        assert_eq!(of_surface(&surface).out_of_scope, [], "{name}");
    }
    let mut state = 7_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    for _ in 0..40 {
        let points: Vec<Vector> = (0..30)
            .map(|_| Vector::new(1.5 * random(), random(), random()))
            .collect();
        let pebble = SharedShape::convex_hull(&points).unwrap();
        assert_eq!(of_shape(&pebble).out_of_scope, [], "{points:?}");
    }
}

/// A cross of arms a third as wide as the whole is long fills (5/9)/(7/9) of the octagon around it; a ring of inner
/// radius .9 fills .19 of its disc, which it shows along its axis; one of .3 (.91) is a disc to the law.
#[test]
fn gaps_are_named() {
    let fill = |hydro: &HydroProperties| match hydro.out_of_scope[..] {
        [OutOfScope::Gaps { fill }] => fill,
        _ => panic!("{:?}", hydro.out_of_scope),
    };
    // The midpoint rule of 512 lines.
    let ours = fill(&of_shape(&cross(1.0 / 3.0)));
    assert!((ours / (5.0 / 7.0) - 1.0).abs() < 5e-3, "{ours}");
    assert_eq!(of_shape(&cross(0.5)).out_of_scope, []);
    let ring = |inner: f64, height: f64| {
        let profile = [
            [inner, 0.0],
            [1.0, 0.0],
            [1.0, height],
            [inner, height],
            [inner, 0.0],
        ];
        of_surface(&revolved(&profile, 48))
    };
    for height in [0.02, 2.0] {
        let ours = fill(&ring(0.9, height));
        assert!((ours / 0.19 - 1.0).abs() < 0.01, "{ours}");
        assert_eq!(ring(0.3, height).out_of_scope, []);
    }
}

/// The rise of a parabola over its chord; one that is bent as a leaf is, is not named.
#[test]
fn curved_plates_are_named() {
    for rise in [0.07, 0.15] {
        let reasons = of_surface(&bent(rise)).out_of_scope;
        let [OutOfScope::Curved { rise: ours }] = reasons[..] else {
            panic!("{reasons:?}");
        };
        // The facets of 32 chords.
        assert!((ours / rise - 1.0).abs() < 2e-3, "{ours} {rise}");
    }
    assert_eq!(of_surface(&bent(0.05)).out_of_scope, []);
}

/// Of a flat blade of width w and thickness t at a pitch β it is sin β cos β (w − t)/(w cos β + t sin β), either way
/// round; flat blades, and pitches that mirror each other, have none.
#[test]
fn pitched_faces_are_named() {
    let beta = 0.15_f64;
    let (sine, cosine) = beta.sin_cos();
    let exact = sine * cosine * (0.1 - 0.002) / (0.1 * cosine + 0.002 * sine);
    for pitch in [0.15, -0.15] {
        let reasons = of_shape(&propeller(pitch)).out_of_scope;
        let found = reasons.iter().find_map(|reason| match reason {
            OutOfScope::Pitched { sine } => Some(*sine),
            _ => None,
        });
        let ours = found.unwrap();
        assert!((ours / exact - 1.0).abs() < 5e-3, "{ours} {exact}");
    }
    assert_eq!(of_shape(&propeller(0.0)).out_of_scope, []);
    let pitched = |reason: &OutOfScope| matches!(reason, OutOfScope::Pitched { .. });
    // Pitched the same way as seen from one side, both blades are one tilted plate.
    let tilted = [1.0, -1.0].map(|side| {
        let place = Pose::from_translation(Vector::X * (0.55 * side))
            * Pose::from_rotation(Rotation::from_rotation_x(0.15));
        (place, SharedShape::cuboid(0.45, 0.001, 0.05))
    });
    let tilted = of_shape(&SharedShape::compound(tilted.to_vec()));
    assert!(!tilted.out_of_scope.iter().any(pitched));
    let turn = Rotation::from_rotation_y(TAU as f32 / 3.0);
    let flat = SharedShape::cuboid(0.45, 0.001, 0.05);
    let star = (0..3).map(|i| {
        let around = (0..i).fold(Rotation::IDENTITY, |sum, _| turn * sum);
        let place = Pose::from_rotation(around) * Pose::from_translation(Vector::X * 0.5);
        (place, flat.clone())
    });
    let star = of_shape(&SharedShape::compound(star.collect()));
    assert!(!star.out_of_scope.iter().any(pitched));
}

/// One warning for equal descriptions, however many bodies have them; none under a law of the user's own, for the
/// whole or for the part.
#[test]
fn it_is_said_once() {
    let mut world = PhysicsWorld::new();
    let mut add = || {
        let collider = ColliderBuilder::new(cross(0.2)).density(300.0);
        world.insert(RigidBodyBuilder::dynamic(), collider).0
    };
    let bodies = [add(), add(), add()];
    let cross = of_shape(&cross(0.2));
    let [reason] = cross.out_of_scope[..] else {
        panic!("{:?}", cross.out_of_scope);
    };
    let mut immersion = Immersion::new(Fluid::AIR);
    immersion.insert_all(bodies, cross.clone());
    immersion.insert(bodies[0], cross.clone());
    let body = bodies[0];
    let said = Warning::OutOfScope { body, reason };
    assert!(said.to_string().contains("53 %"), "{said}");
    assert_eq!(immersion.warnings(), [said]);
    let law = ViscousLaw::Stochastic(StochasticLaw::default());
    let other = ImmersedBody::new(cross.clone()).with_law(law).unwrap();
    immersion.insert(bodies[1], other.clone());
    let own = DragBox::new(Vector3::repeat(1.0), Vector3::repeat(1.0)).unwrap();
    let part = Part::new(cross.clone());
    let described = ImmersedBody::new(cross.clone());
    immersion.insert(
        bodies[1],
        described.clone().with_parts([part.clone().with_law(own)]),
    );
    assert_eq!(immersion.warnings().len(), 1);
    immersion.insert(
        bodies[1],
        described.with_parts([part.clone(), part.clone()]),
    );
    assert_eq!(immersion.warnings().len(), 2);
    let under_the_default = part.with_law(ViscousLaw::default());
    immersion.insert(bodies[1], other.with_parts([under_the_default]));
    assert_eq!(immersion.warnings().len(), 3);
}

/// A part in mm is named, with where it is; a sail a few lengths away, which has no collider, is not.
#[test]
fn a_part_far_from_the_colliders_is_named() {
    let plate = SharedShape::cuboid(0.3, 0.002, 0.1);
    let hydro = of_shape(&plate);
    let warned = |center: [f64; 3], repeated: usize| {
        let mut world = PhysicsWorld::new();
        let hull = ColliderBuilder::cuboid(0.5, 0.1, 0.2).density(500.0);
        let (body, _) = world.insert(RigidBodyBuilder::dynamic(), hull);
        let [x, y, z] = center;
        let sail = Part::new(hydro.clone()).at(Isometry3::translation(x, y, z));
        let parts = [Part::new(hydro.clone()), sail];
        let described = ImmersedBody::new(hydro.clone()).with_parts(parts);
        let mut immersion = Immersion::new(Fluid::AIR);
        for _ in 0..repeated {
            immersion.insert(body, described.clone());
            immersion.step(&mut world);
        }
        immersion.warnings().to_vec()
    };
    let size = 2.0 * (0.3_f64.hypot(0.1).hypot(0.002) + 0.5_f64.hypot(0.1).hypot(0.2));
    assert_eq!(warned([0.0, 0.1 + 9.99 * size, 0.0], 1), []);
    for center in [
        [0.5 + 10.01 * size, 0.0, 0.0],
        [0.0, 300.0, 0.0],
        [0.0, -300.0, 40.0],
    ] {
        let warnings = warned(center, 2);
        let [
            Warning::FarPart {
                part: 1,
                distance,
                size: ours,
                ..
            },
        ] = warnings[..]
        else {
            panic!("{warnings:?}");
        };
        let [x, y, z] = center.map(f64::abs);
        let exact = (x - 0.5)
            .max(0.0)
            .hypot((y - 0.1).max(0.0))
            .hypot((z - 0.2).max(0.0));
        assert!((distance / exact - 1.0).abs() < 1e-6, "{distance} {exact}");
        assert!((ours / size - 1.0).abs() < 1e-6, "{ours} {size}");
    }
}
