//! The phase diagram, painted.

use crate::phase::{Marker, Phase};
use kiss3d::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Ui, pos2, vec2};

const SIZE: [f32; 2] = [330.0, 230.0];
const INK: Color32 = Color32::from_gray(200);
const FAINT: Color32 = Color32::from_gray(70);
const MARKER: Color32 = Color32::from_rgb(255, 170, 40);

/// Paints it, with a body's marker: a ring where the body is expected, a dot where it is now.
pub fn show(ui: &mut Ui, phase: &Phase, marker: Option<&Marker>) {
    let [width, height] = SIZE;
    let (response, painter) = ui.allocate_painter(
        vec2(width + 46.0, height + 34.0),
        kiss3d::egui::Sense::hover(),
    );
    let corner = response.rect.min + vec2(40.0, 4.0);
    let plot = Rect::from_min_size(corner, vec2(width, height));
    painter.rect_stroke(
        plot,
        0.0,
        Stroke::new(1.0, FAINT),
        kiss3d::egui::StrokeKind::Inside,
    );
    let at = |reynolds: f64, i_star: f64| {
        let [x, y] = phase.place(reynolds, i_star);
        pos2(
            plot.left() + x as f32 * plot.width(),
            plot.bottom() - y as f32 * plot.height(),
        )
    };
    axes(&painter, plot, &at);
    for (points, measured) in &phase.curves {
        let points: Vec<Pos2> = points.iter().map(|[re, i]| at(*re, *i)).collect();
        let stroke = Stroke::new(1.5, INK);
        if *measured {
            painter.add(Shape::line(points, stroke));
        } else {
            painter.extend(Shape::dashed_line(&points, stroke, 5.0, 4.0));
        }
    }
    for (name, [re, i]) in Phase::NAMES {
        text(&painter, at(re, i), Align2::CENTER_CENTER, name, INK);
    }
    if let Some(marker) = marker {
        let ring = at(marker.expected, marker.i_star);
        painter.circle_stroke(ring, 7.0, Stroke::new(2.0, MARKER));
        painter.circle_filled(at(marker.now, marker.i_star), 3.5, MARKER);
    }
}

fn axes(painter: &Painter, plot: Rect, at: &impl Fn(f64, f64) -> Pos2) {
    let (low_re, low_i) = (*Phase::REYNOLDS.start(), *Phase::I_STAR.start());
    for power in 2..=4 {
        let x = at(10f64.powi(power), low_i).x;
        let line = [pos2(x, plot.bottom() - 4.0), pos2(x, plot.bottom())];
        painter.line_segment(line, Stroke::new(1.0, INK));
        let label = ["100", "1000", "10 000"][power as usize - 2];
        text(
            painter,
            pos2(x, plot.bottom() + 3.0),
            Align2::CENTER_TOP,
            label,
            INK,
        );
    }
    for power in -3..=-1 {
        let y = at(low_re, 10f64.powi(power)).y;
        let line = [pos2(plot.left(), y), pos2(plot.left() + 4.0, y)];
        painter.line_segment(line, Stroke::new(1.0, INK));
        let label = [".001", ".01", ".1"][(power + 3) as usize];
        text(
            painter,
            pos2(plot.left() - 4.0, y),
            Align2::RIGHT_CENTER,
            label,
            INK,
        );
    }
    let below = pos2(plot.center().x, plot.bottom() + 16.0);
    text(painter, below, Align2::CENTER_TOP, "Re", INK);
    let beside = pos2(plot.left() - 4.0, plot.top() + 2.0);
    text(painter, beside, Align2::RIGHT_TOP, "I*", INK);
}

fn text(painter: &Painter, at: Pos2, align: Align2, text: &str, color: Color32) {
    painter.text(at, align, text, FontId::proportional(12.0), color);
}
