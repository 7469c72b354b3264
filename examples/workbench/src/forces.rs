//! What the fluid does, as lines: the crate's own debug renderer, with its colours as RGB.

use crate::state::State;
use crate::view::View;
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::pipeline::{DebugColor, DebugRenderBackend, DebugRenderObject};

/// A line to be drawn, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where it begins.
    pub from: Vector,
    /// Where it ends.
    pub to: Vector,
    /// Its colour, RGB as on a screen.
    pub color: [f32; 3],
}

#[derive(Default)]
struct Lines(Vec<Line>);

impl DebugRenderBackend for Lines {
    fn draw_line(&mut self, _: DebugRenderObject, from: Vector, to: Vector, color: DebugColor) {
        let color = rgb(color);
        self.0.push(Line { from, to, color });
    }
}

/// Forces, planforms, proxies and flow around the bodies, as far as the view shows them.
pub fn lines(state: &State, view: &View) -> Vec<Line> {
    let mut lines = Lines::default();
    let bodies = &state.world().bodies;
    view.debug_render()
        .render(&mut lines, bodies, &state.immersion);
    lines.0
}

/// From hue in degrees, saturation, lightness and alpha.
pub fn rgb([hue, saturation, lightness, _]: DebugColor) -> [f32; 3] {
    let chroma = (1.0 - (2.0 * lightness - 1.0).abs()) * saturation;
    [0.0, 120.0, 240.0].map(|middle: f32| {
        let away = ((hue - middle).rem_euclid(360.0)).min((middle - hue).rem_euclid(360.0));
        let share = (2.0 - away / 60.0).clamp(0.0, 1.0);
        lightness + chroma * (share - 0.5)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of the colour wheel, and a few colours known from elsewhere.
    #[test]
    fn hues_are_the_colours_they_are_called() {
        for (color, known) in [
            ([0.0, 1.0, 0.5, 1.0], [1.0, 0.0, 0.0]),
            ([60.0, 1.0, 0.5, 1.0], [1.0, 1.0, 0.0]),
            ([120.0, 1.0, 0.5, 1.0], [0.0, 1.0, 0.0]),
            ([240.0, 1.0, 0.5, 1.0], [0.0, 0.0, 1.0]),
            ([300.0, 1.0, 0.5, 1.0], [1.0, 0.0, 1.0]),
            ([30.0, 1.0, 0.5, 1.0], [1.0, 0.5, 0.0]),
            ([210.0, 0.5, 0.6, 1.0], [0.4, 0.6, 0.8]),
            ([77.0, 0.0, 0.6, 1.0], [0.6, 0.6, 0.6]),
        ] {
            for (ours, known) in rgb(color).into_iter().zip(known) {
                assert!((ours - known).abs() < 1e-6, "{color:?}: {:?}", rgb(color));
            }
        }
    }
}
