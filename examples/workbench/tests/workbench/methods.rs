//! The four methods of the thesis move bodies, each in its way; a drawn path is followed; the phase diagram has its marker.

use immersed_workbench::{
    Bench, Body, Change, Command, Fluids, Method, Phase, Placement, Setting, Shape,
};
use rapier3d_immersed::motion::{DimensionlessNumbers, Outline, PhaseDiagram, Regime};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::{Fluid, ViscousLaw};

fn place(bench: &Bench, body: usize) -> Vector {
    let handle = bench.state().handle(body).unwrap();
    bench.state().world().bodies[handle].center_of_mass()
}

fn fall(method: Method, shape: Shape, steps: u64) -> Bench {
    let mut bench = Bench::default();
    let set = Change::Set(Setting::Method(method));
    bench.apply(Command::Change(set)).unwrap();
    let body = Placement {
        shape,
        position: [0.0, 2.5, 0.0],
        ..Placement::default()
    };
    bench.apply(Command::Change(Change::Place(body))).unwrap();
    bench.apply(Command::Step(steps)).unwrap();
    assert_eq!(bench.message, "", "{method:?}");
    bench
}

/// Plain rapier falls by gravity, bit for bit as without the crate but for its step; every method lets a leaf fall more slowly,
/// each another way; the reduced one as the default law, of which it is a table.
#[test]
fn each_method_moves_a_leaf_its_own_way() {
    let plain = place(&fall(Method::Plain, Shape::Leaf, 120), 0);
    let exact = 2.5 - 0.5 * 9.81 * 0.25;
    assert!((plain.y - exact).abs() < 0.02, "{plain}");
    let law = place(&fall(Method::Law, Shape::Leaf, 120), 0);
    let reduced = place(&fall(Method::Reduced, Shape::Leaf, 120), 0);
    let others = [Method::Stochastic, Method::Patterns, Method::Graph];
    let others = others.map(|method| place(&fall(method, Shape::Leaf, 120), 0));
    for at in others.iter().chain([&law, &reduced]) {
        assert!(at.y < 2.45 && at.y > plain.y + 0.1, "{at} {plain}");
    }
    assert!((reduced - law).length() < 0.05, "{reduced} {law}");
    let all = [law, others[0], others[1], others[2]];
    for (i, a) in all.iter().enumerate() {
        for b in &all[i + 1..] {
            assert!((a - b).length() > 0.02, "{all:?}");
        }
    }
}

/// What is under the method is what the crate calls it.
#[test]
fn methods_are_the_crate_s() {
    let law_of = |bench: &Bench| {
        let handle = bench.state().handle(0).unwrap();
        bench.state().immersion.get(handle).unwrap().clone()
    };
    let stochastic = fall(Method::Stochastic, Shape::Leaf, 2);
    assert!(matches!(law_of(&stochastic).law, ViscousLaw::Stochastic(_)));
    let layers = stochastic.state().immersion.medium().layers();
    assert!(
        layers[0].turbulence.is_some(),
        "it falls in its wake's turbulence"
    );
    let patterns = fall(Method::Patterns, Shape::Leaf, 24);
    let handle = patterns.state().handle(0).unwrap();
    let time = patterns.state().immersion.replay_time(handle).unwrap();
    assert!((time - 0.1).abs() < 1e-6, "{time}");
    let reduced = fall(Method::Reduced, Shape::Leaf, 2);
    assert_eq!(law_of(&reduced).parts.len(), 1);
    let plain = fall(Method::Plain, Shape::Leaf, 2);
    assert!(plain.state().forces(0).is_none());
}

/// Methods may be changed in the middle of a fall and back; what is not flat goes on by the law.
#[test]
fn methods_change_in_mid_air() {
    let mut bench = fall(Method::Law, Shape::Leaf, 40);
    let ball = Placement {
        shape: Shape::Ball,
        position: [0.5, 2.5, 0.0],
        ..Placement::default()
    };
    bench.apply(Command::Change(Change::Place(ball))).unwrap();
    for method in Method::ALL {
        let set = Change::Set(Setting::Method(method));
        bench.apply(Command::Change(set)).unwrap();
        let before = place(&bench, 0);
        bench.apply(Command::Step(20)).unwrap();
        let after = place(&bench, 0);
        let way = (after - before).length();
        assert!(way > 1e-3 && way < 0.4, "{method:?}: {way}");
        assert_eq!(bench.message, "", "{method:?}");
    }
    let set = Change::Set(Setting::Method(Method::Law));
    bench.apply(Command::Change(set)).unwrap();
    bench.apply(Command::Step(2)).unwrap();
    let forces = [0, 1].map(|body| bench.state().forces(body).is_some());
    assert_eq!(
        forces,
        [true; 2],
        "{:?}",
        bench.state().immersion.warnings()
    );
}

/// The bound that the example `sketch` states: a leaf's length, 7.3 cm, in the mean.
#[test]
fn a_drawn_path_is_followed() {
    let mut bench = Bench::default();
    let line = (0..=20).map(|k| {
        let s = f64::from(k) / 20.0;
        [0.3 * (5.0 * s).sin(), 1.8 - 1.5 * s, 0.1 * s]
    });
    bench
        .apply(Command::Change(Change::Draw(line.collect())))
        .unwrap();
    let path = |bench: &Bench| match &bench.state().bodies[0].drive {
        immersed_workbench::Drive::Path(path) => path.clone(),
        immersed_workbench::Drive::Method => panic!("it follows a path"),
    };
    let begin = path(&bench).sketch().at(0.0);
    assert!((f64::from(place(&bench, 0).y) - begin.y).abs() < 1e-3);
    let steps = (path(&bench).sketch().duration() * 240.0).ceil() as u64;
    bench.apply(Command::Step(steps)).unwrap();
    let [mean, largest] = path(&bench).distances().unwrap();
    println!(
        "{:.1} cm off in the mean, {:.1} cm at most",
        100.0 * mean,
        100.0 * largest
    );
    assert!(mean < 0.073, "{mean}");
    assert!(largest < 0.25, "{largest}");
    // A leaf that nobody steers is far from there.
    let end = path(&bench).sketch().at(steps as f64 / 240.0);
    let free = Placement {
        position: begin.into(),
        ..Placement::default()
    };
    let mut alone = Bench::default();
    alone.apply(Command::Change(Change::Place(free))).unwrap();
    alone.apply(Command::Step(steps)).unwrap();
    let off = |at: Vector| (f64::from(at.x) - end.x).hypot(f64::from(at.z) - end.z);
    assert!(off(place(&alone, 0)) > 2.0 * off(place(&bench, 0)));
}

/// The marker is where the closed forms put a coin, and moves with its descent.
#[test]
fn the_marker_is_where_the_body_belongs() {
    let mut bench = Bench::default();
    let water = Change::Set(Setting::Fluids(Fluids::Water));
    bench.apply(Command::Change(water)).unwrap();
    let coin = Placement {
        shape: Shape::Coin,
        ..Placement::default()
    };
    bench.apply(Command::Change(Change::Place(coin))).unwrap();
    let phase = Phase::default();
    let marker = phase.marker(bench.state(), 0).unwrap();
    let numbers =
        DimensionlessNumbers::new(Outline::Round, 0.02, 0.0015, 2700.0, &Fluid::WATER, 9.81);
    let numbers = numbers.unwrap();
    // The closed form is a thin disc's.
    assert!((marker.i_star / numbers.i_star - 1.0).abs() < 0.02);
    assert!((marker.expected / numbers.reynolds() - 1.0).abs() < 0.02);
    let regime: Regime = PhaseDiagram::default().regime(marker.expected, marker.i_star);
    assert_eq!(marker.regime, regime);
    assert_eq!(marker.now, 0.0);
    bench.apply(Command::Step(400)).unwrap();
    let falling = phase.marker(bench.state(), 0).unwrap();
    let ratio = falling.now / falling.expected;
    assert!((0.4..1.5).contains(&ratio), "{ratio}");
    // Curves and marker are within the square.
    for [reynolds, i_star] in phase.curves.iter().flat_map(|(points, _)| points) {
        let [x, y] = phase.place(*reynolds, *i_star);
        assert!((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y));
    }
    assert!(phase.place(1000.0, 1e-2)[0] > phase.place(100.0, 1e-2)[0]);
    let first: &Body = &bench.state().bodies[0];
    assert!(first.descent > 0.05);
}
