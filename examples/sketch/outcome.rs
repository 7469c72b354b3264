//! How a leaf followed: numbers, and the picture.

use crate::draw::{self, Item, Panel, Point};
use crate::stage::{LEAVES, Stage};
use crate::support::Vec3;
use crate::support::recording::Fate;
use crate::support::sheet::display;
use plotters::style::RGBColor;
use rapier3d_immersed::motion::Sketch;
use std::f64::consts::TAU;
use std::fmt::{self, Display, Formatter};

const GREY: RGBColor = RGBColor(120, 120, 120);
const STONE: RGBColor = RGBColor(150, 152, 156);
const BLACK: RGBColor = RGBColor(0, 0, 0);

/// Height of its center under which a leaf is down, m.
const DOWN: f64 = 0.04;

/// What became of one leaf.
pub struct Outcome {
    sketch: Sketch,
    /// The flown path, until the leaf was down.
    path: Vec<Vec3>,
    distances: Vec<f64>,
    /// When it met an obstacle, s.
    met: Option<f64>,
    is_down: bool,
}

impl Outcome {
    pub fn new(sketch: Sketch, mut path: Vec<Vec3>, dt: f64, fate: &Fate) -> Self {
        let within = (sketch.duration() / dt) as usize + 1;
        let distance = |(i, at): (usize, &Vec3)| (at - sketch.at(i as f64 * dt)).norm();
        let distances = path.iter().take(within).enumerate().map(distance).collect();
        let down = path.iter().position(|at| at.y < DOWN);
        path.truncate(down.map_or(path.len(), |step| step + 1));
        Self {
            distances,
            // Edge first it touches the floor at a higher place.
            met: fate.landed.filter(|_| fate.landed_at.y > 2.0 * DOWN),
            is_down: down.is_some(),
            path,
            sketch,
        }
    }

    /// Mean distance from the sketch at equal times, m.
    pub fn mean(&self) -> f64 {
        self.distances.iter().sum::<f64>() / self.distances.len() as f64
    }

    fn target(&self) -> Vec3 {
        self.sketch.at(self.sketch.duration())
    }

    /// Where it came down, or where it stayed.
    fn end(&self) -> Vec3 {
        self.path[self.path.len() - 1]
    }

    /// Horizontal distance of that place from the sketch's end, m.
    fn landing_error(&self) -> f64 {
        let miss = self.end() - self.target();
        miss.x.hypot(miss.z)
    }
}

impl Display for Outcome {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let largest = self.distances.iter().copied().fold(0.0, f64::max);
        let [mean, largest, landing] =
            [self.mean(), largest, self.landing_error()].map(|x| 100.0 * x);
        write!(f, "{mean:8.1} {largest:9.1} {landing:12.1}")?;
        if let Some(time) = self.met {
            write!(f, "   met an obstacle after {time:.2} s")?;
        }
        if !self.is_down {
            write!(f, "   is not down yet")?;
        }
        Ok(())
    }
}

/// Where a point of the world is in a picture.
type View = fn(&Vec3) -> Point;

/// From the front, from the left and from above.
pub fn picture(stage: &Stage, outcomes: &[Outcome]) -> String {
    let views: [(&str, [&str; 2], View); 3] = [
        ("from the front", ["x, m", "y, m"], |p| (p.x, p.y)),
        ("from the left", ["z, m", "y, m"], |p| (p.z, p.y)),
        ("from above", ["x, m", "−z, m"], |p| (p.x, -p.z)),
    ];
    let panels: Vec<Panel> = views
        .into_iter()
        .map(|(title, [across, up], view)| {
            let mut panel = Panel::new(title, across, up).equal();
            panel.items = obstacles(stage, view);
            for (index, outcome) in outcomes.iter().enumerate() {
                let [r, g, b] = LEAVES[index % LEAVES.len()];
                panel
                    .items
                    .extend(leaf(outcome, view, display([r, g, b], 1.0)));
            }
            panel
        })
        .collect();
    let title = "Asked paths (dashed) and flown ones; rings: where to land, dots: where they did";
    draw::svg(title, &panels, 3, (430, 620)).expect("the picture is drawn into memory")
}

fn leaf(outcome: &Outcome, view: View, color: RGBColor) -> Vec<Item> {
    let end = outcome.sketch.duration();
    let asked = (0..=120).map(|i| view(&outcome.sketch.at(end * f64::from(i) / 120.0)));
    let flown = outcome.path.iter().step_by(4).map(view);
    let (x, y) = view(&outcome.target());
    let ring = (0..=24).map(|i| {
        let (sine, cosine) = (TAU * f64::from(i) / 24.0).sin_cos();
        (x + 0.03 * cosine, y + 0.03 * sine)
    });
    vec![
        Item::Dashed(asked.collect(), GREY),
        Item::Line(flown.collect(), color, 2),
        Item::Line(ring.collect(), BLACK, 2),
        Item::Dots(vec![view(&outcome.end())], color, 5),
    ]
}

/// Outlines of balls and boxes.
fn obstacles(stage: &Stage, view: View) -> Vec<Item> {
    let balls = stage.balls.iter().map(|[x, y, z, radius]| {
        let (x, y) = view(&Vec3::new(*x, *y, *z));
        let around = (0..=48).map(|i| {
            let (sine, cosine) = (TAU * f64::from(i) / 48.0).sin_cos();
            (x + radius * cosine, y + radius * sine)
        });
        Item::Line(around.collect(), STONE, 3)
    });
    let boxes = stage.boxes.iter().map(|[x, y, z, a, b, c]| {
        let half = Vec3::new(*a, *b, *c) * 0.5;
        let middle = Vec3::new(*x, *y, *z);
        let (low, high) = (view(&(middle - half)), view(&(middle + half)));
        let corners = [low, (high.0, low.1), high, (low.0, high.1), low];
        Item::Line(corners.to_vec(), STONE, 3)
    });
    balls.chain(boxes).collect()
}
