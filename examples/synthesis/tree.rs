//! Fig. 3.18: leaves fall from a tree, here with collisions: twigs and each other, then the ground.

use super::Body;
use super::draw::{self, Item, Panel};
use super::figures::{color, legend};
use super::support::film::FilmArgs;
use super::support::options::Out;
use super::support::reel::Reel;
use plotters::prelude::RGBColor;
use rapier3d_immersed::motion::Regime;
use rapier3d_immersed::motion::path::{SynthesisParams, TrajectoryDatabase};
use rapier3d_immersed::playback::{AtContact, MotionPlayer, MotionPlayers, Playing};
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, HydroProperties, Immersion, RapierSets, preset};
use serde_json::{Value, json};
use std::error::Error;
use std::sync::Arc;

/// Where the leaves hang.
const CROWN: RGBColor = RGBColor(176, 214, 160);
const GROUND: RGBColor = RGBColor(120, 100, 70);
const FORCES: RGBColor = RGBColor(120, 120, 120);

/// Twigs: ends, m.
const TWIGS: [[[Real; 2]; 2]; 4] = [
    [[0.0, 1.55], [0.45, 1.75]],
    [[0.0, 1.25], [-0.5, 1.45]],
    [[0.0, 1.0], [0.4, 1.1]],
    [[0.0, 0.8], [-0.35, 0.9]],
];

pub fn draw(
    (out, film): (&Out, &FilmArgs),
    leaf: &Body,
    database: &Arc<TrajectoryDatabase>,
    leaves: u64,
    seed: u64,
) -> Result<Value, Box<dyn Error>> {
    let synthesizer = leaf.synthesizer(
        SynthesisParams {
            height: 2.6,
            main: Some(Regime::TransitionalHelix),
            ..SynthesisParams::default()
        },
        database,
    )?;
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / 120.0;
    world.insert(
        RigidBodyBuilder::fixed(),
        ColliderBuilder::cuboid(5.0, 0.1, 5.0).translation(Vector::Y * -0.1),
    );
    let twig = |[[ax, ay], [bx, by]]: [[Real; 2]; 2]| {
        let (a, b) = (Vector::new(ax, ay, 0.0), Vector::new(bx, by, 0.0));
        ColliderBuilder::capsule_from_endpoints(a, b, 0.012)
    };
    world.insert(RigidBodyBuilder::fixed(), twig([[0.0, 0.0], [0.0, 1.7]]));
    for ends in TWIGS {
        world.insert(RigidBodyBuilder::fixed(), twig(ends));
    }
    let mut players = MotionPlayers::new();
    let mut immersion = Immersion::new(Fluid::AIR);
    let mut handles = Vec::new();
    for i in 0..leaves {
        // Spread over the crown by the golden angle.
        let share = (i as Real + 0.5) / leaves as Real;
        let angle = 2.399_963 * i as Real;
        let radius = 0.5 * share.sqrt();
        let place = Vector::new(
            radius * angle.cos(),
            1.5 + 0.6 * ((i * 7) % 10) as Real / 10.0,
            0.3 * radius * angle.sin(),
        );
        let player = MotionPlayer {
            heading: angle,
            at_contact: AtContact::Resume { after: 0.25 },
            ..MotionPlayer::new(Arc::new(synthesizer.path(seed * 1000 + i)), place)
        };
        let body = RigidBodyBuilder::dynamic().pose(player.release(Vector::ZERO));
        let half = [0.5 * leaf.length, 0.000_5, 0.5 * leaf.numbers.length].map(|x| x as Real);
        let collider = ColliderBuilder::cuboid(half[0], half[1], half[2]).density(120.0);
        let (handle, _) = world.insert(preset::leaf_body(body), collider);
        let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handle)?;
        immersion.insert(handle, hydro);
        players.play(handle, &player)?;
        handles.push((handle, player));
    }
    let mut reel = Reel::new(&world, 30.0);
    reel.keep(&world, Some(&immersion));
    // Positions of each leaf, and what moved it: its regime, or forces.
    let mut trails: Vec<Vec<(draw::Point, Option<Regime>)>> = vec![Vec::new(); handles.len()];
    let released: Vec<_> = handles
        .iter()
        .map(|(_, player)| (f64::from(player.origin.x), f64::from(player.origin.y)))
        .collect();
    let mut met = vec![false; handles.len()];
    for _ in 0..720 {
        players.before_step(&mut RapierSets::of(&mut world), Some(&mut immersion));
        immersion.step(&mut world);
        reel.keep(&world, Some(&immersion));
        for (i, (handle, player)) in handles.iter().enumerate() {
            let p = world.bodies[*handle].translation();
            let regime = match players.playing(*handle) {
                Some(Playing::At(time)) => Some(player.path.regime_at(time)),
                _ => None,
            };
            met[i] |= regime.is_none() && p.y > 0.2;
            trails[i].push(((f64::from(p.x), f64::from(p.y)), regime));
        }
    }
    let mut panel = Panel::new(
        "on its path a leaf has the colour of the regime; after it has met something the force model moves it",
        "x, m",
        "y, m",
    )
    .equal();
    let xs = || trails.iter().flatten().map(|((x, _), _)| *x);
    let ends = [xs().fold(-1.0, f64::min), xs().fold(1.0, f64::max)];
    let ground = ends.map(|x| (1.05 * x, 0.0)).to_vec();
    panel.items.push(Item::Dots(released, CROWN, 7));
    panel.items.push(Item::Line(ground, GROUND, 4));
    for [[ax, ay], [bx, by]] in TWIGS.into_iter().chain([[[0.0, 0.0], [0.0, 1.7]]]) {
        let ends = [(ax, ay), (bx, by)].map(|(x, y)| (f64::from(x), f64::from(y)));
        panel.items.push(Item::Line(ends.to_vec(), GROUND, 6));
    }
    for trail in &trails {
        let mut last = None;
        for part in trail.chunk_by(|a, b| a.1 == b.1) {
            // From the last point of the part before: no gap.
            let line = last.into_iter().chain(part.iter().map(|(p, _)| *p));
            let color = part[0].1.map_or(FORCES, color);
            panel.items.push(Item::Line(line.collect(), color, 2));
            last = part.last().map(|(p, _)| *p);
        }
    }
    let rest = handles
        .iter()
        .map(|(handle, _)| world.bodies[*handle].translation());
    let rest: Vec<_> = rest.map(|p| (f64::from(p.x), f64::from(p.y))).collect();
    let resting = handles
        .iter()
        .filter(|(handle, _)| world.bodies[*handle].linvel().length() < 0.05)
        .count();
    panel.items.push(Item::Dots(rest, RGBColor(60, 120, 40), 4));
    reel.write(("synthesis_tree", "Leaves from a tree"), None, out, film);
    let path = out.path("synthesis_tree.svg");
    let title = "Leaves from a tree, with collisions (thesis Fig. 3.18)";
    let mut legend = legend();
    legend.push(("force model".into(), FORCES));
    draw::write_with_legend(&path, title, &legend, &[panel], 1, (1280, 760))?;
    Ok(json!({
        "leaves": leaves,
        "met_something_in_the_air": met.iter().filter(|m| **m).count(),
        "at_rest_after_6_s": resting,
    }))
}
