//! What lines of sight ask for.

use immersed_workbench::window::{App, Pointer, Sight, Tool};
use immersed_workbench::{Bench, Change, Command, Placement, Shape};
use rapier3d_immersed::rapier3d::math::Vector;

/// From the eye of the view to a point.
fn toward(bench: &Bench, point: Vector) -> Sight {
    let origin = Vector::from(bench.view.eye);
    let direction = (point - origin).normalize();
    Sight { origin, direction }
}

fn drag(pointer: &mut Pointer, bench: &mut Bench, points: &[Vector]) -> Option<Command> {
    let [first, .., last] = points else {
        panic!("a drag has two points");
    };
    pointer.press(&toward(bench, *first), &bench.view);
    for point in points {
        pointer.drag(&toward(bench, *point), &bench.view);
    }
    pointer.release(&toward(bench, *last), bench)
}

/// A point of the upright plane through the view's target that faces the eye, so far aside and up.
fn facing(bench: &Bench, aside: f32, up: f32) -> Vector {
    let (eye, target) = (
        Vector::from(bench.view.eye),
        Vector::from(bench.view.target),
    );
    let toward = Vector::new(eye.x - target.x, 0.0, eye.z - target.z);
    let right = Vector::Y.cross(toward).normalize();
    target + right * aside + Vector::Y * up
}

fn near(a: [f64; 3], b: Vector) {
    let b = b.to_array().map(f64::from);
    assert!(
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4),
        "{a:?} {b:?}"
    );
}

#[test]
fn a_click_on_the_ground_places_over_it() {
    let mut bench = Bench::default();
    let mut pointer = Pointer::default();
    pointer.tool = Tool::Place;
    pointer.take(Shape::Coin);
    pointer.body.position[1] = 0.9;
    let point = Vector::new(0.4, 0.0, -0.7);
    let asked = drag(&mut pointer, &mut bench, &[point, point]);
    let Some(Command::Change(Change::Place(placed))) = asked else {
        panic!("{asked:?}");
    };
    assert_eq!((placed.shape, placed.velocity), (Shape::Coin, [0.0; 3]));
    near(placed.position, Vector::new(0.4, 0.9, -0.7));
    // The sky has no ground under it.
    let sky = Vector::new(0.0, 9.0, -3.0);
    assert_eq!(drag(&mut pointer, &mut bench, &[sky, sky]), None);
}

#[test]
fn a_drag_throws_along_itself() {
    let mut bench = Bench::default();
    let mut pointer = Pointer::default();
    pointer.tool = Tool::Throw;
    let (from, to) = (facing(&bench, -0.3, 0.1), facing(&bench, 0.2, 0.4));
    pointer.press(&toward(&bench, from), &bench.view);
    pointer.drag(&toward(&bench, to), &bench.view);
    assert_eq!(pointer.lines().len(), 1);
    let asked = pointer.release(&toward(&bench, to), &mut bench);
    assert!(pointer.lines().is_empty());
    let Some(Command::Change(Change::Place(thrown))) = asked else {
        panic!("{asked:?}");
    };
    near(thrown.position, from);
    near(thrown.velocity, (to - from) * 4.0);
}

#[test]
fn a_drawn_line_is_followed() {
    let mut app = App::new(Bench::default());
    app.pointer.tool = Tool::Draw;
    let line: Vec<Vector> = (0..40)
        .map(|i| {
            let share = i as f32 / 39.0;
            let aside = 0.15 * (6.0 * share).sin();
            facing(&app.bench, aside, 0.6 - 0.9 * share)
        })
        .collect();
    let asked = drag(&mut app.pointer, &mut app.bench, &line).unwrap();
    app.bench.apply(asked).unwrap();
    app.bench.apply(Command::Step(120)).unwrap();
    let body = &app.bench.state().bodies[0];
    let immersed_workbench::Drive::Path(path) = &body.drive else {
        panic!("it follows nothing");
    };
    // The thesis's leaf stays within a chord of its line (Fig. 5.14); half a second of it.
    let [mean, _] = path.distances().unwrap();
    assert!(mean < 0.042, "{mean} m from the line");
    // A line that climbs is refused with a reason.
    let climbs = [facing(&app.bench, 0.0, 0.0), facing(&app.bench, 0.1, 0.5)];
    let asked = drag(&mut app.pointer, &mut app.bench, &climbs).unwrap();
    assert!(app.bench.apply(asked).is_err());
    assert!(app.bench.message.contains("cannot climb"));
}

#[test]
fn a_click_selects_the_nearest_and_a_drag_turns() {
    let mut bench = Bench::default();
    for x in [-0.5, 0.0, 0.5] {
        let placed = Placement {
            position: [x, 1.0, 0.0],
            ..Placement::default()
        };
        bench.apply(Command::Change(Change::Place(placed))).unwrap();
    }
    let mut pointer = Pointer::default();
    let at = Vector::new(0.5, 1.0, 0.0);
    assert_eq!(drag(&mut pointer, &mut bench, &[at, at]), None);
    assert_eq!(bench.view.selected, Some(2));
    let beside = Vector::new(0.51, 1.02, 0.0);
    bench.view.selected = Some(0);
    drag(&mut pointer, &mut bench, &[beside, beside]);
    assert_eq!(bench.view.selected, Some(2));
    // A drag changes nothing, a click beside all of them selects none.
    drag(&mut pointer, &mut bench, &[Vector::new(-0.5, 1.0, 0.0), at]);
    assert_eq!(bench.view.selected, Some(2));
    let nothing = Vector::new(0.2, 0.3, 0.0);
    drag(&mut pointer, &mut bench, &[nothing, nothing]);
    assert_eq!(bench.view.selected, None);
}
