//! A run of `drop` is the same in rapier and in the crate's own free body, and tells a law that pumps
//! energy from one that does not.

use crate::specimens::specimen;
use crate::support::fall::{Fall, FallOptions, IntegratorName};
use crate::support::law::{LawName, law};
use crate::support::picture;
use crate::support::shape::ShapeName;
use crate::support::specimen::TiltAxis;
use crate::support::track::Track;
use rapier3d_immersed::motion::Sketch;
use rapier3d_immersed::training::BodyState;
use rapier3d_immersed::{Fluid, ImmersedBody, PhysicalLaw, ViscousLaw};

fn fall(
    shape: ShapeName,
    size: &[f64],
    density: f64,
    fluid: &Fluid,
    law: ViscousLaw,
    options: &FallOptions,
) -> Fall {
    let specimen = specimen(shape, size);
    let body = ImmersedBody::new(specimen.hydro.clone())
        .with_law(law)
        .unwrap();
    let release = BodyState {
        orientation: specimen.released_at(0.4, TiltAxis::Long),
        ..BodyState::default()
    };
    Fall::run(&body, &specimen.dry_mass(density), fluid, &release, options).unwrap()
}

const OPTIONS: FallOptions = FallOptions {
    gravity: 9.81,
    dt: 1.0 / 240.0,
    seconds: 2.0,
    integrator: IntegratorName::Free,
    forces: false,
};

#[test]
fn rapier_and_the_free_body_fall_alike() {
    let fall = |integrator| {
        let options = FallOptions {
            integrator,
            forces: true,
            ..OPTIONS
        };
        let size = [0.01134, 0.00081, 0.1];
        fall(
            ShapeName::Plate,
            &size,
            2700.0,
            &Fluid::WATER,
            ViscousLaw::default(),
            &options,
        )
    };
    let (free, rapier) = (fall(IntegratorName::Free), fall(IntegratorName::Rapier));
    assert_eq!(free.states.len(), 481);
    for (a, b) in free.states.iter().zip(&rapier.states) {
        // Velocities are the same up to single precision; positions by 0.125·Δv·dt besides. Both
        // add up over the flutter's swings.
        assert!((a.velocity - b.velocity).norm() < 2e-3, "{a:?}\n{b:?}");
        assert!((a.position - b.position).norm() < 2e-3, "{a:?}\n{b:?}");
    }
    let moments = free
        .trajectory
        .moments
        .iter()
        .zip(&rapier.trajectory.moments);
    for (a, b) in moments {
        assert!((a.normal - b.normal).norm() < 2e-2, "{a:?}\n{b:?}");
    }
    assert!(free.stable && rapier.stable);
    // Both components and columns: of the free body as of the immersed one, once it is in the fluid.
    assert!(free.forces.iter().all(Option::is_some));
    let (a, b) = (free.forces[1].unwrap(), rapier.forces[1].unwrap());
    assert!((a.weight.force - b.weight.force).length() < 1e-5 * a.weight.force.length());
    assert!((a.drag.force - b.drag.force).length() < 1e-2 * a.weight.force.length());
    let table = rapier.csv();
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 1 + 481);
    let columns = 14 + 8 * 6;
    assert!(lines.iter().all(|line| line.split(',').count() == columns));
    // What is written is read again: by the crate as a sketch, by the examples as a track.
    let sketch = Sketch::from_csv(&table).unwrap();
    let track = Track::read(&table).unwrap();
    for (i, state) in rapier.states.iter().enumerate() {
        let time = i as f64 / 240.0;
        assert!((sketch.points()[i].0 - time).abs() < 1e-12);
        assert_eq!(sketch.points()[i].1, state.position);
        assert!((track.times[i] - time).abs() < 1e-12);
        assert_eq!(track.places[i], state.position);
        assert!(track.turns[i].angle_to(&state.orientation) < 1e-7);
    }
    // As an animation it has fewer frames, of the same steps, with the forces of each.
    let film = rapier.recording(30.0);
    assert_eq!((film.times.len(), film.forces.len()), (61, 61));
    assert_eq!(film.frames[3][0].0, rapier.states[24].position);
    let drag = rapier.forces[24].unwrap().drag.force;
    assert_eq!(film.forces[3][0][0], [drag.x, drag.y, drag.z]);
    let picture = picture::fall(&rapier.trajectory, 0.01134).unwrap();
    assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"));
}

#[test]
fn a_light_sphere_rises_as_its_added_mass_lets_it() {
    let options = FallOptions {
        dt: 1e-3,
        seconds: 0.02,
        integrator: IntegratorName::Rapier,
        ..OPTIONS
    };
    let inviscid = ViscousLaw::Inviscid;
    let fall = fall(
        ShapeName::Ball,
        &[0.1],
        100.0,
        &Fluid::WATER,
        inviscid,
        &options,
    );
    // (ρ − ρ_s) g/(ρ_s + ρ/2), the exact acceleration in an ideal fluid.
    let exact = (997.0 - 100.0) * 9.81 / (100.0 + 997.0 / 2.0);
    let last = fall.states.last().unwrap();
    assert!((last.velocity.y / (exact * options.seconds) - 1.0).abs() < 2e-3);
    assert!(fall.stable, "rising is no gain out of nothing");
}

#[test]
fn a_law_that_pumps_energy_is_called_unstable() {
    // A card of 300 kg/m³ spins up without bound under the law as printed.
    let size = [0.073, 0.042, 0.0003];
    let options = FallOptions {
        seconds: 5.0,
        ..OPTIONS
    };
    let run = |name, coefficients| {
        let law = law(name, coefficients).unwrap();
        fall(ShapeName::Ellipse, &size, 300.0, &Fluid::AIR, law, &options).stable
    };
    assert!(run(LawName::Default, None));
    assert!(!run(LawName::ThesisPrinted, Some("ar")));
}

#[test]
fn coefficients_are_read_or_refused() {
    let thesis = law(LawName::Thesis, Some("1,2,-3")).unwrap();
    assert!(matches!(thesis, ViscousLaw::Thesis(t) if t.translational_lift == -3.0));
    let physical = law(LawName::Default, Some("munk=0.5,lift-slope=3")).unwrap();
    assert!(matches!(physical, ViscousLaw::Physical(p) if p.munk == 0.5 && p.lift_slope == 3.0));
    // Every coefficient of the default law can be given.
    for row in PhysicalLaw::COEFFICIENTS {
        let text = format!("{}=0.75", row.name);
        match law(LawName::Default, Some(&text)).unwrap() {
            ViscousLaw::Physical(law) => assert_eq!(row.of(&law), 0.75, "{text}"),
            other => panic!("{other:?}"),
        }
    }
    for (name, text) in [
        (LawName::Default, "0.5"),
        (LawName::Default, "mink=0.5"),
        (LawName::Default, "munk=nan"),
        (LawName::Thesis, "1,2"),
        (LawName::ThesisPrinted, "xx"),
        (LawName::Stochastic, "1"),
        (LawName::Inviscid, "1"),
    ] {
        assert!(law(name, Some(text)).is_err(), "{name:?} {text}");
    }
}

#[test]
fn runs_that_are_too_long_or_too_short_name_their_flag() {
    let check = |dt, seconds| {
        FallOptions {
            dt,
            seconds,
            ..OPTIONS
        }
        .check()
    };
    assert_eq!(check(1e-9, 10.0).unwrap_err().0, "--seconds");
    assert_eq!(check(1.0, 2.0).unwrap_err().0, "--dt");
    assert!(check(1e-3, 10.0).is_ok());
}
