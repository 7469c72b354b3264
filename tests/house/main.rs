//! The house: which file of `src` imports which. No two files import each other in a circle, no import runs
//! up a layer, and the picture in `docs/house.svg` is that of the code.

mod imports;
mod options;
mod picture;

use imports::House;
use std::collections::BTreeMap;
use std::path::Path;

/// The rooms from the ground up. A room may import those before it. `reduced` needs errors and the
/// scalars only, and nothing needs it.
const LAYERS: &[&[&str]] = &[
    &["error"],
    &["math", "file", "fluid", "preset"],
    &["geometry", "flow", "free_surface", "reduced"],
    &["hydro", "turbulence"],
    &["body", "medium"],
    &["dynamics"],
    &["motion"],
    &["interning"],
    &["coupling"],
    &["playback", "training", "debug_render", "guide"],
];

/// Lines of code, unit tests aside, that the bridge to rapier may have: some 3,000 for bodies that fly, 1,500
/// for what holds them, 1,000 for what their users change, 600 for bodies of parts and engines, 1,120 for those between
/// fluids, 50 that compare a body with what a codebook was planned for.
const MOST_LINES_OF_COUPLING: usize = 7370;

fn house() -> House {
    House::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

fn layers() -> BTreeMap<&'static str, usize> {
    let rooms = LAYERS.iter().enumerate();
    rooms
        .flat_map(|(layer, rooms)| rooms.iter().map(move |room| (*room, layer)))
        .collect()
}

/// Every room of the source has its place in the list of layers, and the list has no others.
#[test]
fn every_room_has_a_layer() {
    let found: Vec<String> = house().rooms();
    let mut known: Vec<&str> = layers().into_keys().collect();
    known.sort_unstable();
    assert_eq!(found, known);
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let house = house();
    assert!(house.imports.len() > 100, "imports were not read");
    assert_eq!(house.circle(), None);
}

#[test]
fn no_import_runs_up() {
    let layers = layers();
    let house = house();
    let up: Vec<_> = house
        .imports
        .iter()
        .filter(|(from, to)| {
            let (from, to) = (House::room(from), House::room(to));
            from != to && layers[from.as_str()] <= layers[to.as_str()]
        })
        .collect();
    assert!(up.is_empty(), "{up:#?}");
}

#[test]
fn the_bridge_stays_small() {
    let lines = house().lines["coupling"];
    println!("coupling has {lines} lines of code");
    assert!(lines <= MOST_LINES_OF_COUPLING, "{lines}");
}

/// `UPDATE_HOUSE=1 cargo test --test house` draws it anew.
#[test]
fn the_picture_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/house.svg");
    let drawn = picture::svg(&house(), LAYERS);
    if std::env::var_os("UPDATE_HOUSE").is_some() {
        std::fs::write(&path, drawn).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(&path).unwrap();
    assert!(
        kept == drawn,
        "docs/house.svg is old: UPDATE_HOUSE=1 cargo test --test house"
    );
}
