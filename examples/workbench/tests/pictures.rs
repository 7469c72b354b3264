//! What is drawn, where there is a driver that draws. On the main thread, to which the renderer's context belongs.

use image::RgbImage;
use immersed_workbench::window::{App, Pictures, can_draw};
use immersed_workbench::{Bench, Change, Command, Fluids, Placement, Rain, Setting, Shape, View};
use kiss3d::pollster::block_on;

const SIZE: [u32; 2] = [640, 400];

fn change(bench: &mut Bench, change: Change) {
    bench.apply(Command::Change(change)).unwrap();
}

/// How many pixels differ.
fn differ(a: &RgbImage, b: &RgbImage) -> usize {
    let far = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 24)
    };
    a.pixels().zip(b.pixels()).filter(|pair| far(*pair)).count()
}

fn plain() -> View {
    View {
        forces: false,
        panel: false,
        selected: None,
        ..View::default()
    }
}

fn main() {
    if !block_on(can_draw()) {
        println!("no picture: there is no graphics driver (mesa-vulkan-drivers is one)");
        return;
    }
    let mut pictures = block_on(Pictures::new(SIZE));
    what_there_is_is_drawn(&mut pictures);
    bodies_come_and_go(&mut pictures);
    println!("pictures are as they should be");
}

/// Bodies are drawn where they are, arrows and panel when they are wanted, and water when there is some.
fn what_there_is_is_drawn(pictures: &mut Pictures) {
    let mut shot = |bench: Bench| block_on(pictures.picture(&mut App::new(bench)));
    let with = |view: View, body: Option<Placement>| {
        let mut bench = Bench::default();
        bench.view = view;
        if let Some(body) = body {
            change(&mut bench, Change::Place(body));
            bench.apply(Command::Step(1)).unwrap();
        }
        bench
    };
    let empty = shot(with(plain(), None));
    assert_eq!(empty.dimensions(), (SIZE[0], SIZE[1]));
    // Ground below, sky above: neither black nor alike.
    let [sky, ground] = [10, SIZE[1] - 10].map(|y| empty.get_pixel(SIZE[0] / 2, y).0);
    assert!(
        sky[2] > sky[0] && ground[0] > ground[2],
        "{sky:?} {ground:?}"
    );

    // A card that fills much of the picture's middle, seen from above; a tenth of it at least is the card.
    let above = View {
        eye: [0.0, 2.0, 0.01],
        target: [0.0, 0.75, 0.0],
        ..plain()
    };
    let card = Placement {
        shape: Shape::Card,
        size: 4.0,
        position: [0.0, 0.75, 0.0],
        tilt: 0.0,
        ..Placement::default()
    };
    let (before, after) = (shot(with(above, None)), shot(with(above, Some(card))));
    let middle = |picture: &RgbImage| picture.get_pixel(SIZE[0] / 2, SIZE[1] / 2).0;
    let [red, green, blue] = middle(&after);
    assert!(red > 2 * green && red > 2 * blue, "{:?}", middle(&after));
    // 35 × 25 cm at 1.25 m in a view of .8 rad that is 1.06 m high: .83 m² per 400 × 400 pixels.
    let expected = 0.352 * 0.252 * (400.0f64 / (2.0 * 1.25 * 0.4f64.tan())).powi(2);
    let seen = differ(&before, &after) as f64;
    // Its shadow is beside it.
    assert!(
        seen > 0.95 * expected && seen < 2.5 * expected,
        "{seen} of {expected}"
    );

    let flies = Placement {
        velocity: [4.0, 0.0, 0.0],
        tilt: 30.0,
        ..card
    };
    let beside = View {
        eye: [0.0, 0.8, 1.5],
        ..above
    };
    let arrows = View {
        forces: true,
        ..beside
    };
    let [without, with_arrows] = [beside, arrows].map(|view| shot(with(view, Some(flies))));
    let seen = differ(&without, &with_arrows);
    assert!(seen > 100, "{seen}");
    let panel = View {
        panel: true,
        ..above
    };
    assert!(differ(&after, &shot(with(panel, Some(card)))) > 20_000);

    let mut pond = with(plain(), None);
    change(&mut pond, Change::Set(Setting::Fluids(Fluids::Pond)));
    let water = shot(pond);
    assert!(differ(&empty, &water) > 30_000);
    let mut high = with(plain(), None);
    change(&mut high, Change::Set(Setting::Fluids(Fluids::Pond)));
    change(&mut high, Change::Set(Setting::Level(1.0)));
    // Its far end is seen higher, before any step.
    assert!(differ(&water, &shot(high)) > 5000);
}

/// Many bodies of several kinds, in one picture after another: nodes come and go.
fn bodies_come_and_go(pictures: &mut Pictures) {
    let mut bench = Bench::default();
    bench.view = plain();
    let mut app = App::new(bench);
    let empty = block_on(pictures.picture(&mut app));
    for shape in Shape::ALL {
        change(
            &mut app.bench,
            Change::Rain(Rain {
                shape,
                count: 20.0,
                size: if shape == Shape::Airplane { 1.0 } else { 2.0 },
                ..Rain::default()
            }),
        );
    }
    let full = block_on(pictures.picture(&mut app));
    assert!(differ(&empty, &full) > 2000);
    change(&mut app.bench, Change::Clear);
    assert_eq!(differ(&empty, &block_on(pictures.picture(&mut app))), 0);
}
