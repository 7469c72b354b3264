//! A window: light, ground, camera, and a mesh for each box of rapier's.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use bevy_rapier3d_immersed::prelude::*;

/// Opens a window on a scene, seen from one point to another. F shows the forces, the space bar switches the fluid off and on.
pub fn open(hz: f32, eye: Vec3, target: Vec3, scene: impl FnOnce(&mut App)) {
    let mut app = App::new();
    app.add_plugins(DefaultPlugins);
    super::physics(&mut app, hz);
    app.add_plugins(ImmersedDebugRenderPlugin {
        shows: ImmersedDebugRender {
            enabled: false,
            planforms: false,
            ..default()
        },
    })
    .insert_resource(ClearColor(Color::srgb(0.87, 0.91, 0.94)))
    .insert_resource(GlobalAmbientLight {
        brightness: 1500.0,
        ..default()
    })
    .add_systems(Update, keys);
    let world = app.world_mut();
    world.spawn((
        Camera3d::default(),
        Transform::from_translation(eye).looking_at(target, Vec3::Y),
    ));
    world.spawn((
        DirectionalLight {
            illuminance: 6000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(2.0, 6.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let plane = Mesh::from(Plane3d::default().mesh().size(100.0, 100.0));
    let mesh = world.resource_mut::<Assets<Mesh>>().add(plane);
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    let material = materials.add(Color::srgb(0.75, 0.71, 0.64));
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material)));
    scene(&mut app);
    app.run();
}

fn keys(
    keys: Res<ButtonInput<KeyCode>>,
    mut shown: ResMut<ImmersedDebugRender>,
    mut contexts: Query<&mut RapierContextImmersion>,
) {
    if keys.just_pressed(KeyCode::KeyF) {
        shown.enabled = !shown.enabled;
    }
    for mut immersion in &mut contexts {
        if keys.just_pressed(KeyCode::Space) {
            let on = !immersion.is_enabled();
            immersion.set_enabled(on);
        }
    }
}

/// Gives every box that has none a mesh, of a color that goes with its number.
pub fn dress(
    undressed: Query<(Entity, &Collider), (Without<Mesh3d>, Without<Sensor>)>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (entity, collider) in &undressed {
        let Some(cuboid) = collider.as_cuboid() else {
            continue;
        };
        let size = cuboid.half_extents() * 2.0;
        // The ground has a plane of its own.
        if size.max_element() > 10.0 {
            continue;
        }
        let hue = (entity.index_u32() * 47 % 90) as f32;
        let material = StandardMaterial {
            base_color: Color::hsl(hue, 0.7, 0.4),
            perceptual_roughness: 0.9,
            ..default()
        };
        commands.entity(entity).insert((
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(materials.add(material)),
        ));
    }
}
