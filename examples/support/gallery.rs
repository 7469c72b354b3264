//! The pictures of a run: moments of it, and trajectories beside those of plain rapier.

use super::picture::{self, Line, Panel};
use super::recording::Recording;
use super::scene::Scene;
use super::sheet::{Camera, UPRIGHT, contact_sheet};
use super::summary::Summary;
use super::{Vec3, cli};
use plotters::style::RGBColor;

/// Seven moments of the fall, and a close look at the end.
pub fn frames(scene: &Scene, recording: &Recording, summary: &Summary) -> String {
    let top = scene.pieces.iter().map(|p| p.release.y).fold(1.0, f64::max);
    let from = Vec3::new(0.75, 0.72, 1.9);
    let whole = Camera {
        eye: from * (0.65 + 0.6 * top).max(1.7),
        target: Vec3::new(0.05, 0.42 * top, 0.0),
        field_of_view: 0.66,
    };
    let close = Camera {
        eye: Vec3::new(0.55, 0.75, 1.6) * 1.15,
        target: Vec3::new(0.22, 0.12, 0.0),
        field_of_view: 0.75,
    };
    let end = recording.times.last().copied().unwrap_or(0.0);
    let until = (1.3 * summary.fall_time).min(end);
    let mut moments: Vec<(f64, Camera)> = (0..7)
        .map(|i| (until * f64::from(i) / 6.0, whole))
        .collect();
    moments.push((end, close));
    contact_sheet(scene, recording, &moments, 4, UPRIGHT)
        .unwrap_or_else(|problem| cli::cannot_write("frames.svg".as_ref(), problem))
}

/// Both runs from the side and from above: some trajectories, and where all pieces come to rest.
pub fn trajectories(scene: &Scene, immersed: &Recording, plain: Option<&Recording>) -> String {
    let side = |p: &Vec3| (p.x, p.y);
    let above = |p: &Vec3| (p.x, p.z);
    let deep = 1.3;
    // Wind carries the pieces off; the last few of them are not worth a picture ten times as wide.
    let ends_above = ends(scene, immersed, above);
    let mut along: Vec<f64> = ends_above.iter().map(|((x, _), _)| *x).collect();
    along.sort_by(f64::total_cmp);
    let at = |share: f64| along[(share * (along.len() - 1) as f64) as usize];
    let window = (at(0.02).min(-1.0) - 0.1, at(0.96).max(1.0) + 0.1);
    let top = scene.pieces.iter().map(|p| p.release.y).fold(0.0, f64::max);
    let panel = |title, recording, view: fn(&Vec3) -> (f64, f64), axes, vertical| Panel {
        title,
        axes,
        lines: paths(scene, recording, view),
        dots: ends(scene, recording, view),
        window: Some([window, vertical]),
    };
    let mut panels = vec![
        panel(
            "immersed, from the side",
            immersed,
            side,
            ["x, m", "height, m"],
            (0.0, top),
        ),
        panel(
            "immersed, from above",
            immersed,
            above,
            ["x, m", "z, m"],
            (-deep, deep),
        ),
    ];
    if let Some(plain) = plain {
        panels.push(panel(
            "plain rapier, from the side",
            plain,
            side,
            ["x, m", "height, m"],
            (0.0, top),
        ));
        panels.push(panel(
            "plain rapier, from above",
            plain,
            above,
            ["x, m", "z, m"],
            (-deep, deep),
        ));
    }
    let shown = SHOWN.min(scene.pieces.len());
    let title = format!(
        "{shown} of {} trajectories; dots: where all pieces are at the end",
        scene.pieces.len()
    );
    picture::panels(&title, &panels, 2, (560, 480))
        .unwrap_or_else(|problem| cli::cannot_write("trajectories.svg".as_ref(), problem))
}

/// Trajectories that are drawn.
const SHOWN: usize = 24;

fn display_color(color: [f32; 3]) -> RGBColor {
    let [r, g, b] = color.map(|x| (200.0 * x.powf(1.0 / 2.2)) as u8);
    RGBColor(r, g, b)
}

fn paths(scene: &Scene, recording: &Recording, view: fn(&Vec3) -> (f64, f64)) -> Vec<Line> {
    let every = (scene.pieces.len() / SHOWN).max(1);
    (0..scene.pieces.len())
        .step_by(every)
        .take(SHOWN)
        .map(|piece| Line {
            points: recording
                .frames
                .iter()
                .map(|frame| view(&frame[piece].0))
                .collect(),
            color: display_color(scene.colors[piece]),
            width: 1,
        })
        .collect()
}

fn ends(
    scene: &Scene,
    recording: &Recording,
    view: fn(&Vec3) -> (f64, f64),
) -> Vec<((f64, f64), RGBColor)> {
    let colors = scene.colors.iter().map(|color| display_color(*color));
    recording
        .fates
        .iter()
        .map(|fate| view(&fate.end))
        .zip(colors)
        .collect()
}
