//! The boat and the sea around it, to look at.

use crate::righting::{Vessel, heeled};
use crate::seakeeping::{Record, Voyage};
use crate::support::recording::Recording;
use crate::support::scene::{Kind, Scene, convex_outline, pose_parts};
use crate::support::{Quat, Vec3};
use rapier3d_immersed::Error;
use rapier3d_immersed::free_surface::FreeSurface;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::prelude::*;

/// Samples of the record that are shown, and the sea's tiles along a side, and their size, m.
const FRAMES: usize = 400;
const TILES: usize = 24;
const TILE: f64 = 1.0;

const WATER: [f32; 3] = [0.05, 0.16, 0.22];
const PAINT: [f32; 3] = [0.60, 0.10, 0.06];

/// The first 40 s: what is seen, and how it moved. The sea is of tiles that go up and down and tilt with it.
///
/// # Errors
/// Those of [`Voyage::sea`].
pub fn animation(
    vessel: &Vessel,
    record: &Record,
    voyage: &Voyage,
) -> Result<(Scene, Recording), Error> {
    let tile = SharedShape::cuboid(0.5 * TILE as f32, 0.01, 0.5 * TILE as f32);
    let mut scene = Scene::new(PhysicsWorld::new());
    let hull = Kind::seen(vessel.hull.clone(), vessel.dry.mass);
    let tile = Kind::seen(Surface::from_shape(tile.as_ref())?, 1.0);
    scene.kinds.extend([hull, tile]);
    scene.add_seen(0, PAINT);
    for _ in 0..TILES * TILES {
        scene.add_seen(1, WATER);
    }

    let sea = voyage.sea()?;
    let shown = record.poses.len().min(FRAMES);
    let middle = record.poses[..shown]
        .iter()
        .map(|(at, _)| *at)
        .sum::<Vec3>()
        / shown.max(1) as f64;
    let frame = |(pose, time): (&(Vec3, Quat), &f64)| {
        let tiles = (0..TILES * TILES).map(|i| {
            let along = |i: usize| (i as f64 + 0.5 - 0.5 * TILES as f64) * TILE;
            let [x, z] = [middle.x + along(i % TILES), middle.z + along(i / TILES)];
            let here = sea.elevation(x, z, *time);
            let normal = Vec3::new(-here.slope[0], 1.0, -here.slope[1]);
            let tilt = Quat::rotation_between(&Vec3::y(), &normal).unwrap_or_default();
            (Vec3::new(x, here.height, z), tilt)
        });
        std::iter::once(*pose).chain(tiles).collect()
    };
    let start = record.times.first().copied().unwrap_or(0.0);
    let moments = record.poses.iter().zip(&record.times).take(shown);
    let recording = Recording {
        times: record.times[..shown].iter().map(|t| t - start).collect(),
        frames: moments.map(frame).collect(),
        ..Recording::default()
    };
    Ok((scene, recording))
}

/// The silhouette from ahead, z and y in m, of the vessel as high as it floats at this heel.
pub fn seen_from_ahead(vessel: &Vessel, heel: f64) -> Vec<[f64; 2]> {
    let (up, turn) = pose_parts(&heeled(heel, vessel.height(heel)));
    let corners = vessel.hull.vertices().iter().map(|v| up + turn * v);
    convex_outline(corners.map(|v| [v.z, v.y]).collect())
}
