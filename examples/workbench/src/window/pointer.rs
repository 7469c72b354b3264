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
/// How far a line of sight may turn in a click, rad.
const CLICK: f32 = 0.01;

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

/// A drag that goes on.
#[derive(Clone, Debug, PartialEq)]
struct Drag {
    /// With which tool it began.
    tool: Tool,
    /// Where it began.
    sight: Sight,
    /// Where on the tool's plane it has been, m.
    points: Vec<Vector>,
}

/// The tool, what it holds, and how far a drag has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Pointer {
    /// What the left button does.
    pub tool: Tool,
    /// What is placed, thrown or rained: shape, size, tilt and heading of this, and its height where it is placed.
    pub body: Placement,
    /// How many bodies rain.
    pub rain: f64,
    drag: Option<Drag>,
}

impl Default for Pointer {
    fn default() -> Self {
        Self {
            tool: Tool::default(),
            body: Placement::default(),
            rain: 30.0,
            drag: None,
        }
    }
}

impl Pointer {
    /// Where on the tool's plane one points at: on the ground to place something, to throw or draw on the upright plane
    /// through the view's target that faces the eye.
    fn point(&self, sight: &Sight, view: &View) -> Option<Vector> {
        let point = match self.tool {
            Tool::Select => None,
            Tool::Place => sight.meets(Vector::ZERO, Vector::Y),
            Tool::Throw | Tool::Draw => {
                let (eye, target) = (Vector::from(view.eye), Vector::from(view.target));
                let toward = eye - target;
                let level = Vector::new(toward.x, 0.0, toward.z);
                let is_steep = level.length() <= 1e-3 * toward.length();
                sight.meets(target, if is_steep { toward } else { level })
            }
        }?;
        let (side, height) = (*ranges::PLACE.end() as f32, *ranges::HEIGHT.end() as f32);
        let low = Vector::new(-side, 0.0, -side);
        Some(point.clamp(low, Vector::new(side, height, side)))
    }

    /// The left button goes down.
    pub fn press(&mut self, sight: &Sight, view: &View) {
        self.drag = Some(Drag {
            tool: self.tool,
            sight: *sight,
            points: self.point(sight, view).into_iter().collect(),
        });
    }

    /// The mouse moves while it is down.
    pub fn drag(&mut self, sight: &Sight, view: &View) {
        let point = self.point(sight, view);
        let (Some(Drag { points, .. }), Some(point)) = (&mut self.drag, point) else {
            return;
        };
        let Some(last) = points.last() else {
            return;
        };
        if self.tool != Tool::Draw {
            points.truncate(1);
            points.push(point);
        } else if (point - last).length() >= SPACING {
            points.push(point);
        }
    }

    /// It comes up: what that asks for.
    pub fn release(&mut self, sight: &Sight, bench: &mut Bench) -> Option<Command> {
        self.drag(sight, &bench.view);
        let drag = self.drag.take().filter(|drag| drag.tool == self.tool)?;
        if self.tool == Tool::Select {
            if sight.direction.distance(drag.sight.direction) < CLICK {
                bench.view.selected = nearest(sight, bench);
            }
            return None;
        }
        let number = |v: Vector| v.to_array().map(f64::from);
        let (first, last) = (*drag.points.first()?, *drag.points.last()?);
        match self.tool {
            Tool::Select => None,
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
                let points = drag.points.into_iter().map(number).collect();
                Some(Command::Change(Change::Draw(points)))
            }
        }
    }

    /// Lets go of what was begun.
    pub fn let_go(&mut self) {
        self.drag = None;
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
        let Some(Drag { points, .. }) = &self.drag else {
            return Vec::new();
        };
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Vec::new();
        };
        match self.tool {
            Tool::Select => Vec::new(),
            Tool::Place => {
                let above = Vector::new(last.x, self.body.position[1] as f32, last.z);
                vec![[*last, above]]
            }
            Tool::Throw => vec![[*first, *last]],
            Tool::Draw => points.windows(2).map(|p| [p[0], p[1]]).collect(),
        }
    }

    /// Takes another thing, in its own size.
    pub fn take(&mut self, shape: Shape) {
        (self.body.shape, self.body.size) = (shape, 1.0);
    }
}

/// The body that a line of sight hits, or comes nearest to if it is near.
fn nearest(sight: &Sight, bench: &Bench) -> Option<usize> {
    let state = bench.state();
    let away = |body: usize| {
        let at = state.world().bodies[state.handle(body)?].center_of_mass();
        let along = (at - sight.origin).dot(sight.direction);
        let beside = (at - sight.origin - sight.direction * along).length();
        let near = state.bodies[body].reach().max(NEAR * along);
        (along > 0.0 && beside < near).then_some((body, beside / near))
    };
    let seen = (0..state.bodies.len()).filter(|body| state.is_seen(*body));
    let near = seen.filter_map(away);
    near.min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(body, _)| body)
}
