//! Blades are closed solids of the size that they say, and pieces of a scene weigh what they should.

use crate::support::leaf::{Blade, Outline};
use crate::support::scene::{Kind, Scene};
use crate::support::{Quat, Vec3};
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::{DryMass, HydroProperties};

const OUTLINES: [Outline; 5] = [
    Outline::Elliptic,
    Outline::Ovate,
    Outline::Lanceolate,
    Outline::Maple,
    Outline::Rectangle,
];

fn blade(outline: Outline) -> Blade {
    Blade {
        outline,
        length: 0.073,
        width: 0.042,
        thickness: 0.0003,
        camber: [0.001, 0.002],
    }
}

/// Lobes and a camber of five hundredths are a leaf's: the default law is for them.
#[test]
fn leaves_are_in_scope() {
    for outline in OUTLINES {
        let solid = blade(outline).solid().unwrap();
        let hydro = HydroProperties::from_surface(&solid, Vec3::zeros());
        assert_eq!(hydro.out_of_scope, [], "{outline:?}");
    }
}

#[test]
fn every_outline_fills_its_box() {
    for outline in OUTLINES {
        let blade = blade(outline);
        let solid = blade.solid().unwrap();
        let low = solid
            .vertices()
            .iter()
            .fold(Vec3::repeat(1.0), |m, v| m.inf(v));
        let high = solid
            .vertices()
            .iter()
            .fold(Vec3::repeat(-1.0), |m, v| m.sup(v));
        let size = high - low;
        assert!((size.x - 0.073).abs() < 1e-12, "{outline:?}: {size}");
        assert!((size.z - 0.042).abs() < 1e-12, "{outline:?}: {size}");
        // Thickness and camber, no more.
        assert!(size.y > 0.0003 && size.y <= 0.0003 + 0.003 + 1e-12);
        let fill = solid.volume_integrals().volume / (0.073 * 0.042 * 0.0003);
        assert!(fill > 0.3 && fill <= 1.0 + 1e-9, "{outline:?} fills {fill}");
    }
}

#[test]
fn volumes_of_the_simple_outlines() {
    let volume = |outline| blade(outline).solid().unwrap().volume_integrals().volume;
    let whole = 0.073 * 0.042 * 0.0003;
    // The two sides of a cambered blade are the same surface moved along y: volume is area times
    // thickness, exactly.
    assert!((volume(Outline::Rectangle) / whole - 1.0).abs() < 1e-9);
    // A polygon of 40 corners has sin(2π/40)/(2π/40) of the ellipse's area.
    let step = std::f64::consts::TAU / 40.0;
    let ellipse = std::f64::consts::PI / 4.0 * step.sin() / step;
    assert!((volume(Outline::Elliptic) / whole - ellipse).abs() < 1e-9);
}

#[test]
fn a_piece_has_the_mass_of_its_true_shape() {
    for outline in OUTLINES {
        let solid = blade(outline).solid().unwrap();
        let volume = solid.volume_integrals().volume;
        let kind = Kind::new(&solid, 350.0, None).unwrap();
        // The same solid in the piece's own frame.
        let exact = kind.solid.volume_integrals();
        assert!((exact.volume / volume - 1.0).abs() < 1e-9);
        let mut scene = Scene::new(PhysicsWorld::new());
        scene.kinds.push(kind);
        let at = (Vec3::new(0.0, 2.0, 0.0), Quat::identity());
        scene.add_piece(0, [1.0; 3], at, Vec3::zeros(), |builder| builder);
        scene.world.step();
        let mass = DryMass::of_body(
            &scene.world.bodies,
            &scene.world.colliders,
            scene.pieces[0].handle,
        )
        .unwrap();
        // Rapier keeps single precision.
        assert!((mass.mass / (350.0 * exact.volume) - 1.0).abs() < 1e-6);
        let inertia = exact.unit_inertia() * 350.0;
        assert!(
            (mass.inertia - inertia).norm() < 1e-5 * inertia.norm(),
            "{outline:?}"
        );
        assert!((mass.center - exact.centroid).norm() < 1e-7 * 0.073);
    }
}
