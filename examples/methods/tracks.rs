//! Short films of the way of a falling paper's center, measured or by a method, all drawn in the same way: the
//! cameras that measured the falls saw no attitude.

use crate::Failure;
use crate::fidelity::falls;
use crate::method::Method;
use crate::mover::empty;
use crate::picture::add_floor;
use crate::prepared::Prepared;
use crate::subject::RADIUS;
use crate::support::recording::Recording;
use crate::support::scene::{Kind, Scene};
use crate::support::sheet::Camera;
use crate::support::{Quat, Vec3, gif};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::SharedShape;
use std::sync::Arc;

/// Two measured falls of one circle: what is compared with, and its repeat.
const MEASURED: [&str; 2] = [
    include_str!("../../tests/data/paper/circle_24mm_edge_a.csv"),
    include_str!("../../tests/data/paper/circle_24mm_edge_b.csv"),
];
/// Pictures a second.
const RATE: f64 = 30.0;
/// Length of a film, s.
const SECONDS: f64 = 2.0;

/// A way of a center: times, s, and places, m, y up.
struct Way(Vec<(f64, Vec3)>);

impl Way {
    fn measured(text: &str) -> Result<Self, Failure> {
        let row = |line: &str| -> Result<(f64, Vec3), Failure> {
            let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
            match numbers?[..] {
                [t, x, y, z, ..] => Ok((t, Vec3::new(x, z, y))),
                _ => Err(format!("{line}: not a row of a track").into()),
            }
        };
        Ok(Self(
            text.lines().skip(1).map(row).collect::<Result<_, _>>()?,
        ))
    }

    /// From where it is first as high as `height`, moved to lie over the origin there and turned so that it ends in the
    /// direction +x.
    fn aligned(&self, height: f64) -> Self {
        let begin = self.0.iter().position(|(_, p)| p.y <= height).unwrap_or(0);
        let (time, first) = self.0[begin];
        let seen = self.0[begin..].iter().take_while(|(_, p)| p.y > RADIUS);
        let way: Vec<_> = seen.map(|(t, p)| (t - time, p - first)).collect();
        let end = way.last().map_or(Vec3::x(), |(_, p)| *p);
        let turn = Quat::from_axis_angle(&Vec3::y_axis(), end.z.atan2(end.x));
        let place = |p: &Vec3| turn * p + Vec3::y() * first.y;
        Self(way.iter().map(|(t, p)| (*t, place(p))).collect())
    }

    /// Where it is at a time, at its end afterwards.
    fn at(&self, time: f64) -> Vec3 {
        let after = self.0.partition_point(|(t, _)| *t < time);
        if after == 0 || after == self.0.len() {
            return self.0[after.min(self.0.len() - 1)].1;
        }
        let [(t, p), (u, q)] = [self.0[after - 1], self.0[after]];
        p + (q - p) * ((time - t) / (u - t).max(1e-9))
    }
}

/// A ball of the paper's size over a floor.
fn stage(prepared: &Prepared) -> Result<Scene, Failure> {
    let ball = SharedShape::ball((0.7 * RADIUS) as f32);
    let (points, triangles) = ball.as_ball().ok_or("a ball")?.to_trimesh(16, 12);
    let points: Vec<Vec3> = points
        .into_iter()
        .map(crate::support::from_rapier)
        .collect();
    let mut scene = empty(prepared, 1.0 / RATE);
    scene.kinds = vec![Kind {
        collision: ball,
        solid: Arc::new(Surface::new(&points, &triangles)?),
        outline: Arc::new(Vec::new()),
        ..prepared.subject.kind.clone()
    }];
    add_floor(&mut scene);
    let place = (Vec3::y(), Quat::identity());
    scene.add_piece(0, [0.75, 0.20, 0.05], place, Vec3::zeros(), |body| body);
    Ok(scene)
}

fn film(scene: &Scene, way: &Way) -> Result<Vec<u8>, Failure> {
    let times: Vec<f64> = (0..=(SECONDS * RATE) as usize)
        .map(|i| i as f64 / RATE)
        .collect();
    let frame = |time: &f64| vec![(way.at(*time), Quat::identity())];
    let recording = Recording {
        frames: times.iter().map(frame).collect(),
        times,
        ..Recording::default()
    };
    let camera = Camera::overview(&[Vec3::new(-0.3, 0.0, -0.3), Vec3::new(0.6, 0.95, 0.3)]);
    Ok(gif::side_by_side(&[(scene, &recording)], &camera, RATE)?)
}

/// Films as GIF.
pub struct Tracks {
    pub measured: Vec<u8>,
    /// What is shown beside it by key: its repeat, and the first fall by each method.
    pub beside: Vec<(&'static str, Vec<u8>)>,
}

/// All films of tracks.
pub fn films(paper: &Prepared) -> Result<Tracks, Failure> {
    let scene = stage(paper)?;
    let [one, other] = MEASURED.map(Way::measured);
    let (one, other) = (one?, other?);
    let height = one.0[0].1.y.min(other.0[0].1.y);
    let measured = film(&scene, &one.aligned(height))?;
    let mut beside = vec![("repeat", film(&scene, &other.aligned(height))?)];
    for method in Method::ALL {
        let fall = falls(paper, method, 1)?.swap_remove(0);
        // Let go 1.1 m over the floor, as by the robot.
        let places = fall.moments.iter().map(|m| m.position + Vec3::y() * 1.1);
        let way = Way(places
            .enumerate()
            .map(|(i, p)| (i as f64 * fall.interval, p))
            .collect());
        beside.push((method.key(), film(&scene, &way.aligned(height))?));
    }
    Ok(Tracks { measured, beside })
}
