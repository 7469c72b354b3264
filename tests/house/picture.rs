//! The rooms as boxes, layer on layer, and their imports as arrows.

use super::imports::House;
use std::collections::BTreeSet;
use std::fmt::Write;

const WIDTH: f64 = 810.0;
const ROW: f64 = 76.0;
const BOX: (f64, f64) = (146.0, 44.0);
const TOP: f64 = 16.0;

/// Where the middle of each room is, from the left, so that arrows pass beside rooms.
const COLUMNS: &[(&str, f64)] = &[
    ("error", 130.0),
    ("math", 250.0),
    ("file", 410.0),
    ("fluid", 570.0),
    ("preset", 726.0),
    ("geometry", 90.0),
    ("free_surface", 290.0),
    ("flow", 500.0),
    ("reduced", 726.0),
    ("hydro", 180.0),
    ("turbulence", 640.0),
    ("body", 150.0),
    ("medium", 405.0),
    ("dynamics", 300.0),
    ("motion", 450.0),
    ("interning", 530.0),
    ("coupling", 400.0),
    ("guide", 90.0),
    ("playback", 290.0),
    ("training", 490.0),
    ("debug_render", 690.0),
];

/// What each room is for, in a few words.
const PURPOSES: &[(&str, &str)] = &[
    ("error", "the one error type"),
    ("math", "scalars, lanes, twists"),
    ("file", "sealed tables"),
    ("fluid", "density, viscosity"),
    ("preset", "leaf-sized worlds"),
    ("geometry", "closed surfaces, sheets"),
    ("free_surface", "waves, seas"),
    ("flow", "how the fluid moves"),
    ("reduced", "separated models"),
    ("hydro", "added mass, viscous laws"),
    ("turbulence", "k–ε, Langevin"),
    ("body", "shape, law, own mass"),
    ("medium", "fluids in layers"),
    ("dynamics", "equations of motion"),
    ("motion", "patterns, paths, graphs"),
    ("interning", "equal values once"),
    ("coupling", "the bridge to rapier"),
    ("playback", "bodies on paths"),
    ("training", "sweeps, plans, fits"),
    ("guide", "a page for each thing"),
    ("debug_render", "forces as lines"),
];

/// The picture as SVG.
pub fn svg(house: &House, layers: &[&[&str]]) -> String {
    let height = TOP * 2.0 + ROW * (layers.len() - 1) as f64 + BOX.1;
    let place = |room: &str| {
        let row = layers
            .iter()
            .position(|rooms| rooms.contains(&room))
            .expect("every room has a layer");
        let column = COLUMNS.iter().find(|(name, _)| *name == room);
        let x = column.map_or(0.5 * WIDTH, |(_, x)| *x);
        // The ground is at the bottom.
        let y = TOP + ROW * (layers.len() - 1 - row) as f64 + 0.5 * BOX.1;
        (x, y)
    };
    let rooms: BTreeSet<(String, String)> = house
        .imports
        .iter()
        .map(|(from, to)| (House::room(from), House::room(to)))
        .filter(|(from, to)| from != to)
        .collect();
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" text-anchor=\"middle\">\n\
         <defs><marker id=\"a\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" \
         markerHeight=\"7\" orient=\"auto\"><path d=\"M0 1L7 4L0 7\" fill=\"none\" \
         stroke=\"#567\"/></marker></defs>\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    for (from, to) in &rooms {
        // What follows from other arrows is left out.
        let follows = rooms.iter().any(|(other, via)| {
            other == from && via != to && rooms.contains(&(via.clone(), to.clone()))
        });
        if follows {
            continue;
        }
        let ((x1, y1), (x2, y2)) = (place(from), place(to));
        let (y1, y2) = (y1 + 0.5 * BOX.1, y2 - 0.5 * BOX.1 - 1.0);
        let bend = 0.45 * (y2 - y1);
        let (c1, c2) = (y1 + bend, y2 - bend);
        writeln!(
            out,
            "<path d=\"M{x1:.0} {y1:.0}C{x1:.0} {c1:.0} {x2:.0} {c2:.0} {x2:.0} {y2:.0}\" \
             fill=\"none\" stroke=\"#89a\" stroke-width=\"1.2\" marker-end=\"url(#a)\"/>"
        )
        .expect("a string takes anything");
    }
    for room in layers.iter().flat_map(|rooms| rooms.iter()) {
        let (x, y) = place(room);
        let (left, top) = (x - 0.5 * BOX.0, y - 0.5 * BOX.1);
        let purpose = PURPOSES.iter().find(|(name, _)| name == room);
        let purpose = purpose.map_or("", |(_, purpose)| purpose);
        writeln!(
            out,
            "<rect x=\"{left:.0}\" y=\"{top:.0}\" width=\"{}\" height=\"{}\" rx=\"5\" \
             fill=\"#eef3f7\" stroke=\"#456\"/>\n\
             <text x=\"{x:.0}\" y=\"{:.0}\" font-size=\"14\" fill=\"#123\">{room}</text>\n\
             <text x=\"{x:.0}\" y=\"{:.0}\" font-size=\"10\" fill=\"#456\">{purpose}</text>",
            BOX.0,
            BOX.1,
            y - 2.0,
            y + 14.0,
        )
        .expect("a string takes anything");
    }
    out + "</svg>\n"
}
