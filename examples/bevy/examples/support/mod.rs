//! What the examples share: an app that steps by itself, and a window to see it.

#[cfg(feature = "window")]
mod window;

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::prelude::*;
use std::time::Duration;

#[cfg(feature = "window")]
pub use window::{dress, open};

/// Bevy_rapier and the fluid, `hz` times a second, on these plugins of bevy's.
#[cfg_attr(feature = "window", allow(dead_code))]
pub fn physics(app: &mut App, hz: f32) {
    app.add_plugins(RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule())
        .add_plugins(ImmersedPlugin::<NoUserData>::default())
        .insert_resource(TimestepMode::Fixed {
            dt: 1.0 / hz,
            substeps: 1,
        })
        .insert_resource(Time::<Fixed>::from_hz(hz.into()));
}

/// An app without a window, one step per update however fast the machine is.
#[cfg_attr(feature = "window", allow(dead_code))]
pub fn headless(hz: f32) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin));
    physics(&mut app, hz);
    let step = Duration::from_secs_f64(1.0 / f64::from(hz));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(step));
    app
}

/// Updates for so many seconds.
#[cfg_attr(feature = "window", allow(dead_code))]
pub fn advance(app: &mut App, hz: f32, seconds: f32) {
    (0..(seconds * hz).round() as usize).for_each(|_| app.update());
}

/// A floor whose top is at this height, m.
pub fn floor(height: f32) -> impl Bundle {
    let place = Transform::from_xyz(0.0, height - 0.5, 0.0);
    (Collider::cuboid(50.0, 0.5, 50.0), place)
}
