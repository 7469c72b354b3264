//! Gives the fluid its motion, and each body what moves it.

use crate::kinds::{Shape, kind};
use crate::methods::{self, Method};
use crate::settings::{Settings, uniform};
use crate::state::{Drive, State};
use crate::support::from_rapier;
use crate::support::scene::{Kind, Scene};
use rapier3d_immersed::motion::path::WindResponse;
use rapier3d_immersed::playback::MotionPlayer;
use rapier3d_immersed::rapier3d::math::{Pose, Rotation};
use rapier3d_immersed::rapier3d::na::UnitQuaternion;
use rapier3d_immersed::rapier3d::parry::query::intersection_test;
use rapier3d_immersed::{ForceFactors, OnContact};
use std::sync::Arc;

/// Room that a body has above the ground at least, m.
const CLEARANCE: f32 = 1e-3;
/// How far a body is raised where there is no room, times its radius, and how often.
const RAISE: f64 = 0.5;
const RAISES: usize = 200;

impl Scene {
    /// Raises a place until a body has room there, above the ground and off all others.
    ///
    /// # Errors
    /// If there is none.
    pub(crate) fn find_room(
        &self,
        of: &Kind,
        at: &mut crate::support::Vec3,
        pose: impl Fn(&crate::support::Vec3) -> Pose,
    ) -> Result<(), String> {
        let shape = of.collision.as_ref();
        let under = CLEARANCE - shape.compute_aabb(&pose(at)).mins.y;
        at.y += f64::from(under.max(0.0));
        let radius = f64::from(shape.compute_local_bounding_sphere().radius);
        for _ in 0..RAISES {
            let here = pose(at);
            let taken = self.pieces.iter().any(|piece| {
                let other = &self.world.bodies[piece.handle];
                let kind = &self.kinds[piece.kind];
                other.is_enabled()
                    && intersection_test(&here, shape, other.position(), kind.collision.as_ref())
                        .is_ok_and(|found| found.intersecting)
            });
            if !taken {
                return Ok(());
            }
            at.y += RAISE * radius;
        }
        Err("there is no room".into())
    }
}

impl State {
    /// Gives the fluid its motion, where it differs from what it was.
    pub(crate) fn apply_medium(
        &mut self,
        before: Option<(Settings, Option<(Shape, u64)>)>,
        wake: Option<(Shape, u64)>,
    ) -> Result<(), String> {
        let settings = self.settings;
        let wake_of = |(shape, size): (Shape, u64)| {
            let kind = kind(shape, f64::from_bits(size)).ok()?;
            methods::wake(&kind, &settings)
        };
        let medium = settings
            .medium(wake.and_then(wake_of))
            .map_err(|error| error.to_string())?;
        let immersion = &mut self.immersion;
        let same = |same: fn(&Settings) -> [f64; 3]| {
            before.is_some_and(|(before, _)| same(&before) == same(&settings))
        };
        if !before.is_some_and(|(before, _)| before.same_fluids(&settings)) {
            immersion.set_medium(medium);
        } else {
            if !(same(|s| s.wind) && same(|s| s.current)) {
                immersion.clear_flow();
                for (layer, velocity) in [settings.wind, settings.current].into_iter().enumerate() {
                    if velocity != [0.0; 3] {
                        immersion.set_flow_of(layer, uniform(velocity));
                    }
                }
            }
            let unchanged = before.is_some_and(|(_, before)| before == wake);
            if !(unchanged && same(|s| [s.turbulence, s.eddy, 0.0])) {
                immersion.clear_turbulence();
                if let Some(turbulence) = &medium.layers()[0].turbulence {
                    immersion.set_turbulence(turbulence.clone());
                }
            }
        }
        let wind = self.immersion.medium().layers()[0].flow.clone();
        let wind = wind.map(|flow| (flow, WindResponse::default()));
        self.players
            .set_wind(wind)
            .map_err(|error| error.to_string())
    }

    /// Gives a fluid that was read from a snapshot what snapshots leave out: its flows, its turbulence, and its waves.
    pub(crate) fn restore_flows(&mut self) -> Result<(), String> {
        let Some((settings, wake)) = self.applied else {
            return Ok(());
        };
        let wake = wake.and_then(|(shape, size)| {
            let kind = kind(shape, f64::from_bits(size)).ok()?;
            methods::wake(&kind, &settings)
        });
        let medium = settings.medium(wake).map_err(|error| error.to_string())?;
        let waves = settings.surface().map_err(|error| error.to_string())?;
        if let Some(waves) = waves {
            self.immersion.set_surface(waves);
        }
        for (layer, velocity) in [settings.wind, settings.current].into_iter().enumerate() {
            if velocity != [0.0; 3] {
                self.immersion.set_flow_of(layer, uniform(velocity));
            }
        }
        if let Some(turbulence) = &medium.layers()[0].turbulence {
            self.immersion.set_turbulence(turbulence.clone());
        }
        Ok(())
    }

    /// Gives a body its law, or what else moves it.
    pub(crate) fn dress(&mut self, index: usize) -> Result<(), String> {
        let Some(handle) = self.handle(index) else {
            return Ok(());
        };
        let (settings, body) = (self.settings, self.bodies[index].clone());
        let of = kind(body.shape, body.size)?;
        if !self.scene.world.bodies[handle].is_enabled() {
            return Ok(());
        }
        if matches!(body.drive, Drive::Path(_)) {
            if !self.immersion.contains(handle) {
                self.immersion.insert(handle, (*of.body).clone());
            }
            return Ok(());
        }
        let method = match settings.method {
            method if method.is_for_flat() && !body.shape.is_flat() => Method::Law,
            method => method,
        };
        self.players.stop(handle, Some(&mut self.immersion));
        self.immersion.stop_replay(handle);
        // What cannot be prepared falls by the law, which is therefore put on first.
        let law = (*of.body).clone().with_law(settings.law());
        let law = law.map_err(|error| error.to_string())?;
        self.immersion.insert(handle, law);
        self.immersion.set_control(handle, settings.factors());
        self.immersion
            .set_body_enabled(handle, method != Method::Plain);
        match method {
            Method::Law | Method::Plain => (),
            Method::Stochastic => self.immersion.insert(handle, methods::stochastic(&of)),
            Method::Reduced => {
                let reduced = methods::reduced(body.shape, body.size)?;
                self.immersion.insert(handle, reduced);
            }
            Method::Patterns => {
                let book = methods::codebook(body.shape, body.size, &settings)?;
                let all = book.series();
                let series = &all[body.id as usize % all.len()];
                self.immersion.insert(handle, (*of.body).clone());
                self.immersion.set_control(handle, ForceFactors::ONE);
                self.immersion.replay(handle, series, OnContact::Restart);
            }
            Method::Graph => self.play(index, &of)?,
        }
        Ok(())
    }

    /// Lets a body play a fall from where it is.
    fn play(&mut self, index: usize, of: &Kind) -> Result<(), String> {
        let handle = self.scene.pieces[index].handle;
        let (id, fresh) = (self.bodies[index].id, self.bodies[index].is_fresh());
        let rapier = &mut self.scene.world.bodies[handle];
        let at = if fresh {
            self.scene.pieces[index].release
        } else {
            from_rapier(rapier.center_of_mass())
        };
        let length = 2.0 * of.body.hydro.planform.half_extents.x;
        if at.y < 2.0 * length {
            return Err("it is too low to play a fall".into());
        }
        let path = methods::synthesizer(of, &self.settings, at.y)?.path(id);
        let axes = UnitQuaternion::from_rotation_matrix(&of.body.hydro.planform.axes);
        let [x, y, z, w] = axes.coords.map(|x| x as f32).into();
        let player = MotionPlayer {
            heading: (2.4 * id as f64 % std::f64::consts::TAU) as f32,
            axes: Rotation::from_xyzw(x, y, z, w),
            ..MotionPlayer::new(Arc::new(path), crate::support::to_rapier(&at))
        };
        if fresh {
            let center = crate::support::to_rapier(&of.dry.center);
            rapier.set_position(player.release(center), true);
        }
        self.players
            .play(handle, &player)
            .map_err(|error| error.to_string())
    }
}
