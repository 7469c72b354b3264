//! Forces, planforms, proxy ellipsoids and flow as gizmos.

use crate::context::RapierContextImmersion;
use bevy::gizmos::config::GizmoConfigGroup;
use bevy::gizmos::gizmos::GizmoBuffer;
use bevy::prelude::*;
use bevy::transform::TransformSystems;
use bevy_rapier3d::prelude::RapierRigidBodySet;
use bevy_rapier3d::rapier::math::Vector;
use bevy_rapier3d::rapier::pipeline::{DebugColor, DebugRenderBackend, DebugRenderObject};
use rapier3d_immersed::DebugRender;

/// Draws what the fluid does to bodies, as `RapierDebugRenderPlugin` draws what rapier sees. Colors are those of
/// [`DebugRender::FORCES`].
#[derive(Default)]
pub struct ImmersedDebugRenderPlugin {
    /// What is drawn at first.
    pub shows: ImmersedDebugRender,
}

/// What is drawn; see [`DebugRender`], whose fields these are.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct ImmersedDebugRender {
    /// Whether anything is (default true).
    pub enabled: bool,
    /// Arrows of the components of the force (default true).
    pub forces: bool,
    /// Outlines of planforms (default true).
    pub planforms: bool,
    /// Sections of the proxy ellipsoids (default false).
    pub proxies: bool,
    /// Arrows of the flow (default true).
    pub flow: bool,
    /// Length of an arrow for a force as large as the body's weight, in longest extents of the body (default 1).
    pub force_length: f32,
    /// Length of a flow's arrow per speed, s (default 0.1).
    pub flow_time: f32,
}

impl Default for ImmersedDebugRender {
    fn default() -> Self {
        let DebugRender {
            forces,
            planforms,
            proxies,
            flow,
            force_length,
            flow_time,
        } = DebugRender::default();
        Self {
            enabled: true,
            forces,
            planforms,
            proxies,
            flow,
            force_length,
            flow_time,
        }
    }
}

impl From<&ImmersedDebugRender> for DebugRender {
    fn from(shown: &ImmersedDebugRender) -> Self {
        Self {
            forces: shown.forces,
            planforms: shown.planforms,
            proxies: shown.proxies,
            flow: shown.flow,
            force_length: shown.force_length,
            flow_time: shown.flow_time,
        }
    }
}

impl Plugin for ImmersedDebugRenderPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ImmersedDebugRender>()
            .insert_resource(self.shows.clone())
            .add_systems(PostUpdate, draw.after(TransformSystems::Propagate));
    }
}

fn draw(
    shown: Res<ImmersedDebugRender>,
    contexts: Query<(&RapierContextImmersion, &RapierRigidBodySet)>,
    mut gizmos: Gizmos,
) {
    if !shown.enabled {
        return;
    }
    for (immersion, bodies) in &contexts {
        DebugRender::from(&*shown).render(&mut Lines(&mut *gizmos), &bodies.bodies, immersion);
    }
}

/// Gizmos as rapier's backend.
struct Lines<'a, C: GizmoConfigGroup>(&'a mut GizmoBuffer<C, ()>);

impl<C: GizmoConfigGroup> DebugRenderBackend for Lines<'_, C> {
    fn draw_line(
        &mut self,
        _: DebugRenderObject,
        from: Vector,
        to: Vector,
        [hue, saturation, lightness, alpha]: DebugColor,
    ) {
        let color = Color::hsla(hue, saturation, lightness, alpha);
        self.0.line(from, to, color);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prelude::*;
    use bevy::asset::AssetPlugin;
    use bevy::gizmos::config::DefaultGizmoConfigGroup;
    use bevy::gizmos::{AppGizmoBuilder, GizmoAsset, GizmoHandles};
    use bevy_rapier3d::prelude::*;
    use std::any::TypeId;

    /// Ends and colors of the lines that bevy would render.
    fn lines(app: &App) -> (Vec<Vec3>, Vec<LinearRgba>) {
        let group = TypeId::of::<DefaultGizmoConfigGroup>();
        let handle = app.world().resource::<GizmoHandles>().handles().get(&group);
        let Some(Some(handle)) = handle else {
            return default();
        };
        let assets = app.world().resource::<Assets<GizmoAsset>>();
        let buffer = assets.get(handle).unwrap().buffer();
        (buffer.list_positions.clone(), buffer.list_colors.clone())
    }

    /// A cube that sinks: an arrow of its weight as long as the cube is, and nothing when all is switched off.
    #[test]
    fn forces_are_lines() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default()))
            .add_plugins(RapierPhysicsPlugin::<NoUserData>::default())
            .add_plugins(ImmersedPlugin::<NoUserData>::default())
            .add_plugins(ImmersedDebugRenderPlugin::default())
            .init_asset::<GizmoAsset>()
            .init_gizmo_group::<DefaultGizmoConfigGroup>()
            .insert_resource(Medium::from(Fluid::WATER))
            .insert_resource(TimestepMode::Fixed {
                dt: 1.0 / 60.0,
                substeps: 1,
            });
        app.world_mut().spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.1, 0.1, 0.1),
            ColliderMassProperties::Density(2000.0),
            Transform::default(),
            Immersed::default(),
        ));
        (0..30).for_each(|_| app.update());
        let (ends, colors) = lines(&app);
        assert!(ends.len() > 20, "{} ends", ends.len());
        let mut forces = DebugRender::FORCES.iter();
        let weight = forces.find(|(name, _)| *name == "weight").unwrap().1;
        let [hue, saturation, lightness, alpha] = weight;
        let weight = LinearRgba::from(Color::hsla(hue, saturation, lightness, alpha));
        let at = colors.iter().position(|color| *color == weight).unwrap();
        let arrow = ends[at + 1] - ends[at];
        assert!((arrow - Vec3::NEG_Y * 0.2).length() < 1e-3, "{arrow}");
        let mut shown = app.world_mut().resource_mut::<ImmersedDebugRender>();
        (shown.forces, shown.planforms, shown.flow) = (false, false, false);
        app.update();
        assert!(lines(&app).0.is_empty());
        let mut shown = app.world_mut().resource_mut::<ImmersedDebugRender>();
        (shown.enabled, shown.forces) = (false, true);
        app.update();
        assert!(lines(&app).0.is_empty());
    }
}
