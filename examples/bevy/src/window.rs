//! The leaves in a window.

use crate::immersed::{Immersed, Surroundings};
use crate::{LEAF, leaf};
use bevy::prelude::*;
use rapier3d_immersed::turbulence::NoiseStream;
use std::collections::VecDeque;
use std::f32::consts::FRAC_PI_2;

/// Leaves fall all the time; the space bar switches the air off and on.
pub struct WindowPlugin;

impl Plugin for WindowPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(ClearColor(Color::srgb(0.87, 0.91, 0.94)))
            .add_systems(Startup, set_up)
            .add_systems(FixedUpdate, shed)
            .add_systems(Update, switch);
    }
}

/// Most leaves at a time; the oldest go.
const MOST: usize = 1000;

#[derive(Resource)]
struct Look {
    outline: Handle<Mesh>,
    colors: Vec<Handle<StandardMaterial>>,
}

fn set_up(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Camera3d::default(),
        Transform::from_xyz(0.0, 1.5, 3.4).looking_at(Vec3::new(0.0, 0.8, 0.0), Vec3::Y),
    ));
    commands.insert_resource(GlobalAmbientLight {
        brightness: 1500.0,
        ..default()
    });
    commands.spawn((
        DirectionalLight {
            illuminance: 6000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(2.0, 6.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(100.0, 100.0))),
        MeshMaterial3d(materials.add(Color::srgb(0.75, 0.71, 0.64))),
    ));
    let outline =
        Mesh::from(Ellipse::new(LEAF[0], LEAF[2])).rotated_by(Quat::from_rotation_x(-FRAC_PI_2));
    let mut color = |red, green, blue| {
        materials.add(StandardMaterial {
            base_color: Color::srgb(red, green, blue),
            double_sided: true,
            cull_mode: None,
            perceptual_roughness: 0.9,
            ..default()
        })
    };
    commands.insert_resource(Look {
        outline: meshes.add(outline),
        colors: vec![
            color(0.76, 0.35, 0.08),
            color(0.62, 0.14, 0.10),
            color(0.83, 0.62, 0.13),
            color(0.45, 0.47, 0.14),
        ],
    });
}

/// A leaf every tenth of a second, here and there.
fn shed(
    mut commands: Commands,
    look: Res<Look>,
    mut alive: Local<VecDeque<Entity>>,
    mut tick: Local<u32>,
) {
    *tick += 1;
    if !tick.is_multiple_of(6) {
        return;
    }
    let number = u64::from(*tick / 6);
    let noise = NoiseStream::new(1, 0).vector(number, 0);
    let at = Vec3::new(0.5 * noise.x, 2.4, 0.5 * noise.z);
    // Turned anyhow about the vertical, tilted a little.
    let rotation =
        Quat::from_rotation_y(9.0 * noise.y) * Quat::from_rotation_x(0.5 + 0.3 * noise.x);
    let color = look.colors[number as usize % look.colors.len()].clone();
    let entity = commands
        .spawn((leaf(at, rotation), Immersed))
        .insert((Mesh3d(look.outline.clone()), MeshMaterial3d(color)))
        .id();
    alive.push_back(entity);
    if alive.len() > MOST
        && let Some(oldest) = alive.pop_front()
    {
        commands.entity(oldest).despawn();
    }
}

fn switch(keys: Res<ButtonInput<KeyCode>>, mut surroundings: ResMut<Surroundings>) {
    if keys.just_pressed(KeyCode::Space) {
        let on = !surroundings.is_enabled();
        surroundings.set_enabled(on);
    }
}
