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
