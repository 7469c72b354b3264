//! What the mouse does: a press, a drag and a release, seen as lines of sight into the world.

use crate::bench::{Bench, Command};
use crate::change::{Change, Placement};
use crate::kinds::Shape;
use crate::settings::ranges;
use crate::view::View;
use rapier3d_immersed::rapier3d::math::Vector;

/// Speed of a throw per length of its arrow, 1/s.
const SPEED_PER_LENGTH: f32 = 4.0;
/// Distance between two points of a drawn line, m.
const SPACING: f32 = 0.02;
/// How far from a body, in shares of the distance from the eye, a click still means it.
const NEAR: f32 = 0.03;

/// What the left button does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Selects a body, and turns the view.
    #[default]
    Select,
    /// Places a body over a point of the ground.
    Place,
    /// Throws a body along a drag.
    Throw,
    /// Draws a line that a leaf follows.
    Draw,
}

impl Tool {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Select, Self::Place, Self::Throw, Self::Draw];

    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Select => "select",
            Self::Place => "place",
            Self::Throw => "throw",
            Self::Draw => "draw a path",
        }
    }

    /// What to do with it.
    pub const fn help(self) -> &'static str {
        match self {
            Self::Select => "click a body; drag to turn the view",
            Self::Place => "click the ground under it",
            Self::Throw => "drag the way it shall fly: 1 m is 4 m/s",
            Self::Draw => "drag a line downward: a leaf follows it",
        }
    }
}

/// A line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Where it begins, m.
    pub origin: Vector,
    /// Where it goes, of length 1.
    pub direction: Vector,
}

impl Sight {
    /// Where it meets a plane, before the eye only.
    fn meets(&self, point: Vector, normal: Vector) -> Option<Vector> {
        let toward = self.direction.dot(normal);
        let along = (point - self.origin).dot(normal) / toward;
        (toward.abs() > 1e-6 && along > 0.0).then(|| self.origin + self.direction * along)
    }
}

/// The tool, what it holds, and how far a drag has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Hand {
    /// What the left button does.
    pub tool: Tool,
    /// What is placed, thrown or rained: shape, size, tilt and heading of this, and its height where it is placed.
    pub body: Placement,
    /// How many bodies rain.
    pub rain: f64,
    /// Where the drag began and has been, m.
    drag: Vec<Vector>,
}

impl Default for Hand {
    fn default() -> Self {
        Self {
            tool: Tool::default(),
            body: Placement::default(),
            rain: 30.0,
            drag: Vec::new(),
        }
    }
}

impl Hand {
    /// Where on the tool's plane one points at: on the ground to place something, else on the upright plane through the
    /// view's target that faces the eye.
    fn point(&self, sight: &Sight, view: &View) -> Option<Vector> {
        let point = if self.tool == Tool::Place {
            sight.meets(Vector::ZERO, Vector::Y)
        } else {
            let (eye, target) = (Vector::from(view.eye), Vector::from(view.target));
            let toward = eye - target;
            let level = Vector::new(toward.x, 0.0, toward.z);
            let normal = if level.length() > 1e-3 * toward.length() {
                level
            } else {
                toward
            };
            sight.meets(target, normal)
        }?;
        let (side, height) = (*ranges::PLACE.end() as f32, *ranges::HEIGHT.end() as f32);
        let (low, high) = (
            Vector::new(-side, 0.0, -side),
            Vector::new(side, height, side),
        );
        Some(point.clamp(low, high))
    }

    /// The left button goes down.
    pub fn press(&mut self, sight: &Sight, view: &View) {
        self.drag = self.point(sight, view).into_iter().collect();
    }

    /// The mouse moves while it is down.
    pub fn drag(&mut self, sight: &Sight, view: &View) {
        let Some(point) = self.point(sight, view).filter(|_| !self.drag.is_empty()) else {
            return;
        };
        match self.tool {
            Tool::Draw => {
                if (point - self.drag[self.drag.len() - 1]).length() >= SPACING {
                    self.drag.push(point);
                }
            }
            _ => {
                self.drag.truncate(1);
                self.drag.push(point);
            }
        }
    }

    /// It comes up: what that asks for.
    pub fn release(&mut self, sight: &Sight, bench: &mut Bench) -> Option<Command> {
        self.drag(sight, &bench.view);
        let drag = std::mem::take(&mut self.drag);
        let first = *drag.first()?;
        let last = *drag.last()?;
        let number = |v: Vector| v.to_array().map(f64::from);
        match self.tool {
            Tool::Select => {
                if (last - first).length() < NEAR * (first - sight.origin).length() {
                    bench.view.selected = nearest(sight, bench);
                }
                None
            }
            Tool::Place => {
                let [x, _, z] = number(last);
                let position = [x, self.body.position[1], z];
                Some(self.placed(position, [0.0; 3]))
            }
            Tool::Throw => {
                let velocity = (last - first) * SPEED_PER_LENGTH;
                Some(self.placed(number(first), number(velocity)))
            }
            Tool::Draw => {
                let points = drag.into_iter().map(number).collect();
                Some(Command::Change(Change::Draw(points)))
            }
        }
    }

    fn placed(&self, position: [f64; 3], velocity: [f64; 3]) -> Command {
        Command::Change(Change::Place(Placement {
            position,
            velocity,
            ..self.body
        }))
    }

    /// What a drag shows: the arrow of a throw, the line that is drawn, the way from the ground up to what is placed.
    pub fn lines(&self) -> Vec<[Vector; 2]> {
        let (Some(first), Some(last)) = (self.drag.first(), self.drag.last()) else {
            return Vec::new();
        };
        match self.tool {
            Tool::Select => Vec::new(),
            Tool::Place => {
                let above = Vector::new(last.x, self.body.position[1] as f32, last.z);
                vec![[*last, above]]
            }
            Tool::Throw => vec![[*first, *last]],
            Tool::Draw => self.drag.windows(2).map(|p| [p[0], p[1]]).collect(),
        }
    }

    /// Takes another thing into the hand, in its own size.
    pub fn take(&mut self, shape: Shape) {
        (self.body.shape, self.body.size) = (shape, 1.0);
    }
}

/// The body that a line of sight comes nearest to, if it is near.
fn nearest(sight: &Sight, bench: &Bench) -> Option<usize> {
    let state = bench.state();
    let away = |body: usize| {
        let at = state.world().bodies[state.handle(body)?].center_of_mass();
        let along = (at - sight.origin).dot(sight.direction);
        let beside = (at - sight.origin - sight.direction * along).length();
        (along > 0.0).then_some((body, beside / along))
    };
    let all = (0..state.bodies.len()).filter_map(away);
    let near = all.filter(|(_, share)| *share < NEAR);
    near.min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(body, _)| body)
}
