//! The paper airplane weighs what its paper weighs, and its stored added mass is that of its sheet.

use crate::support::airplane::{SIDE, THICKNESS, flying, kind, stored_added_mass};
use approx::assert_relative_eq;
use rapier3d_immersed::geometry::Sheet;

#[test]
fn mass_of_the_folded_sheet() {
    let sheet = Sheet::paper_airplane(SIDE, THICKNESS, 6).unwrap();
    let airplane = kind(800.0).unwrap();
    // Mitred folds: the same paper on either side of the mid-surface. Rounding alone is left.
    assert_relative_eq!(
        airplane.dry.mass,
        800.0 * sheet.volume(),
        max_relative = 1e-9
    );
    // The folds' mitres are a thickness high: nothing against the size.
    assert!((airplane.dry.center - sheet.centroid()).norm() < 1e-2 * THICKNESS);
    // ∫x² dA and the like over triangles: the mean over the three edges' middles is exact.
    let mut second = rapier3d_immersed::rapier3d::na::Matrix3::zeros();
    for [a, b, c] in sheet.corners() {
        let area = (b - a).cross(&(c - a)).norm() / 2.0;
        for middle in [a + b, b + c, c + a] {
            let r = middle / 2.0 - sheet.centroid();
            second += r * r.transpose() * (area * THICKNESS * 800.0 / 3.0);
        }
    }
    let inertia = second.trace() * rapier3d_immersed::rapier3d::na::Matrix3::identity() - second;
    // The paper's own thickness adds t²/12 per mass, 10⁻⁵ of the least of them; mitres as much.
    assert!((inertia - airplane.dry.inertia).norm() < 1e-4 * inertia.norm());
}

/// As parts, which each see the air where they are, the airplane is one of the default law's bodies; as one folded
/// surface it would not be.
#[test]
fn the_airplane_that_flies_is_in_scope() {
    assert_eq!(flying(800.0).unwrap().body.out_of_scope(), []);
}

#[test]
fn collides_with_what_it_is() {
    let airplane = kind(800.0).unwrap();
    let bounds = airplane.collision.compute_local_aabb();
    for v in airplane.solid.vertices() {
        let v = [v.x, v.y, v.z].map(|x| x as f32);
        // The nose and the swept leading edge reach past boxes of the mean chord.
        assert!(v[1] > bounds.mins.y - 1e-3 && v[1] < bounds.maxs.y + 1e-3);
        assert!(v[2] > bounds.mins.z - 1e-3 && v[2] < bounds.maxs.z + 1e-3);
    }
    assert!((bounds.maxs.x - bounds.mins.x - SIDE as f32).abs() < 1e-3);
}

#[test]
fn stored_added_mass_is_of_this_sheet() {
    let (stored, error) = stored_added_mass();
    assert!(stored.is_physical() && error > 0.0 && error < 0.01);
    // Broadside and seen from above: between the strip (πc²/4 per length) of its planform, which no
    // plate of finite span exceeds, and half of it.
    let (mut strips, count) = (0.0, 1000);
    for i in 0..count {
        let s = (f64::from(i) + 0.5) / f64::from(count);
        let chord = SIDE * (1.0 - 0.6 * s);
        strips += std::f64::consts::PI / 4.0 * chord * chord * 0.8 * SIDE / f64::from(count);
    }
    let broadside = stored.linear[(2, 2)];
    assert!(
        broadside > 0.5 * strips && broadside < strips,
        "{broadside} of {strips}"
    );
}

#[cfg(feature = "bake")]
#[test]
fn stored_added_mass_agrees_with_a_fresh_solve() {
    let (stored, error) = stored_added_mass();
    let fresh = crate::support::airplane::solved_added_mass();
    let (linear, angular) = (stored.linear.norm(), stored.angular.norm());
    for (a, b, scale) in [
        (stored.linear, fresh.linear, linear),
        (stored.angular, fresh.angular, angular),
        (stored.coupling, fresh.coupling, (linear * angular).sqrt()),
    ] {
        let difference = (a - b).norm() / scale;
        // Two families of meshes, each within the solver's own estimate.
        assert!(difference < error, "{difference} of {error}");
    }
}

/// With a clip and bent edges, thrown at the speed of its glide, it glides under the default law: straight, level, and more than
/// twice as far as it sinks. As folded, without them, it does not come half as far.
#[test]
fn flies_under_the_default_law() {
    use crate::support::airplane::{flying, scene};
    use rapier3d_immersed::rapier3d::prelude::*;
    use rapier3d_immersed::{Fluid, Immersion, preset};
    let fly = |kind: crate::support::scene::Kind| {
        let mut world = PhysicsWorld::new();
        preset::leaf_scale(&mut world.integration_parameters);
        let mut scene = scene(world, std::slice::from_ref(&kind));
        let handle = scene.pieces[0].handle;
        let mut immersion = Immersion::new(Fluid::AIR);
        immersion.insert(handle, (*kind.body).clone());
        let start = scene.world.bodies[handle].center_of_mass();
        let mut turned = 0.0_f32;
        while scene.world.bodies[handle].translation().y > 0.05 && immersion.time() < 10.0 {
            immersion.step(&mut scene.world);
            let nose = *scene.world.bodies[handle].rotation() * Vector::X;
            turned = turned.max(nose.y.abs());
        }
        let way = scene.world.bodies[handle].center_of_mass() - start;
        (way, turned)
    };
    let (way, turned) = fly(flying(800.0).unwrap());
    assert!(-way.x / way.y > 2.0 && way.z.abs() < 0.2, "{way}");
    assert!(turned < 0.5, "{turned}");
    let (bare, _) = fly(kind(800.0).unwrap());
    assert!(bare.x < 0.5 * way.x, "{bare} {way}");
}
