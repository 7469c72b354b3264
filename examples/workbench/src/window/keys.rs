//! What each key asks for.

use super::pointer::{Pointer, Tool};
use crate::bench::{Bench, Command};
use crate::change::{Change, Rain, Setting};
use crate::methods::Method;
use kiss3d::event::Key;

/// All keys and what they do, to be read.
pub const HELP: [(&str, &str); 14] = [
    ("0", "the law that is set"),
    ("1 – 4", "the methods of the thesis, by chapters 4, 5, 3, 6"),
    ("5", "plain rapier"),
    ("space", "play, stop"),
    ("→", "a step"),
    ("←", "back by ¼ s, with shift by 2 s"),
    (", and .", "slower, faster"),
    ("Z", "undo"),
    ("S, B, T, N", "select, place, throw, draw a path"),
    ("O", "rain"),
    ("delete, C", "remove the selected body, all bodies"),
    ("R", "begin a film, or drop it"),
    ("F, L, P, X, W", "forces, trails, planforms, proxies, flow"),
    ("D, H", "phase diagram, panel"),
];

/// Whether a key that stays down goes on asking.
pub fn repeats(key: Key) -> bool {
    let repeat = [Key::Left, Key::Right, Key::Comma, Key::Period, Key::Z];
    repeat.contains(&key)
}

/// Times the speed that it was.
const FASTER: f64 = 1.25;

/// What a key asks for; what concerns the view alone is done at once.
pub fn pressed(key: Key, shift: bool, bench: &mut Bench, pointer: &mut Pointer) -> Option<Command> {
    let method = |index: usize| {
        let method = Method::ALL[index];
        Some(Command::Change(Change::Set(Setting::Method(method))))
    };
    let view = &mut bench.view;
    match key {
        Key::Key0 | Key::Numpad0 => return method(0),
        Key::Key1 | Key::Numpad1 => return method(1),
        Key::Key2 | Key::Numpad2 => return method(2),
        Key::Key3 | Key::Numpad3 => return method(3),
        Key::Key4 | Key::Numpad4 => return method(4),
        Key::Key5 | Key::Numpad5 => return method(5),
        Key::Space => return Some(Command::Play(!bench.is_playing())),
        Key::Right => return Some(Command::Step(1)),
        Key::Left => return Some(Command::Rewind(if shift { 2.0 } else { 0.25 })),
        Key::Comma => return Some(Command::Speed(bench.speed() / FASTER)),
        Key::Period => return Some(Command::Speed(bench.speed() * FASTER)),
        Key::Z => return Some(Command::Undo),
        Key::O => return Some(rain(bench, pointer)),
        Key::Delete => return remove(bench),
        Key::C => return Some(Command::Change(Change::Clear)),
        Key::R => return Some(Command::Record(bench.film_length().is_none())),
        Key::S => pointer.tool = Tool::Select,
        Key::B => pointer.tool = Tool::Place,
        Key::T => pointer.tool = Tool::Throw,
        Key::N => pointer.tool = Tool::Draw,
        Key::F => view.forces ^= true,
        Key::L => view.trails ^= true,
        Key::P => view.planforms ^= true,
        Key::X => view.proxies ^= true,
        Key::W => view.flow ^= true,
        Key::D => view.phase ^= true,
        Key::H => view.panel ^= true,
        _ => {}
    }
    None
}

/// Takes the selected body away.
pub fn remove(bench: &Bench) -> Option<Command> {
    let selected = bench.view.selected?;
    Some(Command::Change(Change::Remove(selected)))
}

/// A rain of what the tool holds; each falls otherwise than the one before.
pub fn rain(bench: &Bench, pointer: &Pointer) -> Command {
    Command::Change(Change::Rain(Rain {
        shape: pointer.body.shape,
        size: pointer.body.size,
        count: pointer.rain,
        seed: 1 + bench.changes().len() as u64,
        ..Rain::default()
    }))
}
