//! A drawn path: the first `<path>` of an SVG file, or the path data alone, as a polyline of points.

use svg::node::element::path::{Command, Data, Parameters, Position};
use svg::parser::Event;

/// Straight pieces that a curve is drawn in.
const PIECES: u32 = 24;

/// A point of the drawing: x to the right and y **down**, in its own units.
pub type Point = [f64; 2];

/// The path data of the first `<path>`; the text itself if it is no SVG.
///
/// # Errors
/// What is missing.
pub fn path_data(text: &str) -> Result<String, String> {
    if !text.trim_start().starts_with('<') {
        return Ok(text.into());
    }
    let events = svg::read(text).map_err(|problem| format!("no SVG: {problem}"))?;
    for event in events {
        match event {
            Event::Error(problem) => return Err(format!("no SVG: {problem}")),
            Event::Tag("path", _, attributes) => {
                if attributes.contains_key("transform") {
                    return Err("the path has a transform: apply it to its points first".into());
                }
                let data = attributes.get("d").ok_or("the path has no attribute d")?;
                return Ok(data.to_string());
            }
            _ => {}
        }
    }
    Err("it has no <path>".into())
}

/// The points of a path of lines and Bézier curves (M, L, H, V, C, S, Q, T, Z, absolute and relative).
///
/// # Errors
/// The command that is not known, incomplete, or begins a second line.
pub fn points(data: &str) -> Result<Vec<Point>, String> {
    let commands = Data::parse(data).map_err(|problem| format!("path data: {problem}"))?;
    let mut pen = Pen::default();
    for (index, command) in commands.iter().enumerate() {
        pen.draw(command)
            .map_err(|problem| format!("command {} of the path: {problem}", index + 1))?;
    }
    let known = |p: &Point| p[0].is_finite() && p[1].is_finite();
    match pen.points.iter().position(|p| !known(p)) {
        Some(index) => Err(format!("point {} of the path is not finite", index + 1)),
        None if pen.points.len() < 2 => Err("the path has no second point".into()),
        None => Ok(pen.points),
    }
}

#[derive(Default)]
struct Pen {
    points: Vec<Point>,
    /// The last control point of a curve, for smooth ones.
    control: Option<(usize, Point)>,
}

impl Pen {
    fn at(&self) -> Point {
        self.points.last().copied().unwrap_or_default()
    }

    fn draw(&mut self, command: &Command) -> Result<(), String> {
        use Command::*;
        if self.points.is_empty() && !matches!(command, Move(..)) {
            return Err("must be M: a path begins with a move".into());
        }
        match command {
            Move(position, parameters) => {
                if !self.points.is_empty() {
                    return Err("a second M: a body cannot jump".into());
                }
                // Further pairs are lines.
                self.lines(position, &pairs(parameters, 1)?);
            }
            Line(position, parameters) => self.lines(position, &pairs(parameters, 1)?),
            HorizontalLine(position, parameters) => self.along(0, position, parameters),
            VerticalLine(position, parameters) => self.along(1, position, parameters),
            CubicCurve(position, parameters) => self.curves(position, parameters, [3, 0])?,
            SmoothCubicCurve(position, parameters) => self.curves(position, parameters, [2, 3])?,
            QuadraticCurve(position, parameters) => self.curves(position, parameters, [2, 0])?,
            SmoothQuadraticCurve(position, parameters) => {
                self.curves(position, parameters, [1, 2])?;
            }
            EllipticalArc(..) => return Err("arcs (A) are not read: use curves (C, Q)".into()),
            Close => self.points.push(self.points[0]),
        }
        Ok(())
    }

    fn place(&self, position: &Position, [x, y]: Point) -> Point {
        let [at_x, at_y] = self.at();
        match position {
            Position::Absolute => [x, y],
            Position::Relative => [at_x + x, at_y + y],
        }
    }

    fn lines(&mut self, position: &Position, to: &[Point]) {
        for point in to {
            self.points.push(self.place(position, *point));
        }
        self.control = None;
    }

    /// Lines along one axis.
    fn along(&mut self, axis: usize, position: &Position, parameters: &Parameters) {
        for value in parameters.iter() {
            let mut to = self.at();
            match position {
                Position::Absolute => to[axis] = f64::from(*value),
                Position::Relative => to[axis] += f64::from(*value),
            }
            self.points.push(to);
        }
        self.control = None;
    }

    /// Bézier curves of `given` points each, the first of them mirrored where the curve is smooth, of degree `smooth`.
    fn curves(
        &mut self,
        position: &Position,
        parameters: &Parameters,
        [given, smooth]: [usize; 2],
    ) -> Result<(), String> {
        for group in pairs(parameters, given)?.chunks(given) {
            let from = self.at();
            let mut polygon = vec![from];
            if smooth > 0 {
                // The control point before, mirrored; the pen's place if the curve before was of another kind.
                let before = self.control.filter(|(degree, _)| *degree == smooth);
                let [x, y] = before.map_or(from, |(_, control)| control);
                polygon.push([2.0 * from[0] - x, 2.0 * from[1] - y]);
            }
            polygon.extend(group.iter().map(|p| self.place(position, *p)));
            self.control = Some((polygon.len() - 1, polygon[polygon.len() - 2]));
            let shares = (1..=PIECES).map(|i| f64::from(i) / f64::from(PIECES));
            self.points.extend(shares.map(|s| casteljau(&polygon, s)));
        }
        Ok(())
    }
}

/// A point of the Bézier curve of a polygon (de Casteljau's algorithm).
fn casteljau(polygon: &[Point], share: f64) -> Point {
    let mut points = polygon.to_vec();
    while points.len() > 1 {
        let between = |a: f64, b: f64| a + (b - a) * share;
        points = points
            .windows(2)
            .map(|w| [0, 1].map(|axis| between(w[0][axis], w[1][axis])))
            .collect();
    }
    points[0]
}

/// Numbers two by two, in whole groups of so many pairs.
fn pairs(parameters: &Parameters, group: usize) -> Result<Vec<Point>, String> {
    let numbers: &[f32] = parameters;
    if numbers.is_empty() || !numbers.len().is_multiple_of(2 * group) {
        return Err(format!("{} numbers, not {} each", numbers.len(), 2 * group));
    }
    let pairs = numbers.chunks_exact(2);
    Ok(pairs
        .map(|pair| [pair[0], pair[1]].map(f64::from))
        .collect())
}
