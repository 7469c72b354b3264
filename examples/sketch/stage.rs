//! The world in which leaves follow: floor, obstacles and wind.

use crate::asked::Asked;
use crate::guided::Guided;
use crate::options::Options;
use crate::support::leaf::{Blade, Outline};
use crate::support::scene::{Kind, Scene};
use crate::support::{Vec3, cli, to_rapier};
use rapier3d_immersed::flow::Uniform;
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyBuilder, RigidBodyHandle};
use rapier3d_immersed::training::{BodyState, Experiment, FollowParams, SketchFollower};
use rapier3d_immersed::{Fluid, Immersion, preset};

const SAND: [f32; 3] = [0.62, 0.58, 0.50];
const STONE: [f32; 3] = [0.42, 0.44, 0.47];
/// Linear RGB of the leaves, in turn.
pub const LEAVES: [[f32; 3]; 6] = [
    [0.55, 0.16, 0.02],
    [0.10, 0.25, 0.55],
    [0.20, 0.40, 0.08],
    [0.62, 0.42, 0.03],
    [0.40, 0.08, 0.35],
    [0.05, 0.40, 0.40],
];

/// Everything but the leaves.
pub struct Stage {
    pub kind: Kind,
    /// The leaf as plans and searches drop it.
    pub experiment: Experiment,
    pub balls: Vec<[f64; 4]>,
    pub boxes: Vec<[f64; 6]>,
    wind: Vec3,
}

impl Stage {
    pub fn new(options: &Options) -> Self {
        let blade = Blade {
            outline: Outline::Elliptic,
            length: 0.073,
            width: 0.042,
            thickness: 0.0003,
            camber: [0.0; 2],
        };
        let outline = Outline::Elliptic.points(blade.length, blade.width, 24);
        let outline: Vec<Vec3> = outline.iter().map(|p| Vec3::new(p[0], 0.0, p[1])).collect();
        let solid = blade.solid().expect("a blade with a thickness");
        let kind = Kind::new(&solid, 400.0, Some(&outline)).expect("a leaf");
        let mut experiment = Experiment::new((*kind.body).clone(), kind.dry, Fluid::AIR);
        experiment.release.tilt_axis = 80f64.to_radians();
        experiment.dt = preset::LEAF_DT.into();
        Self {
            kind,
            experiment,
            balls: options.obstacle.clone(),
            boxes: options.boxes.clone(),
            wind: options.uniform_wind,
        }
    }

    /// The air of the world, without any body.
    fn air(&self) -> Immersion {
        let mut immersion = Immersion::new(self.experiment.fluid);
        if self.wind != Vec3::zeros() {
            let [x, y, z] = [self.wind.x, self.wind.y, self.wind.z].map(|x| x as f32);
            immersion.set_flow(Uniform::new(x, y, z));
        }
        immersion
    }

    /// Floor, obstacles, and a leaf for each release.
    fn scene(&self, releases: &[BodyState]) -> Scene {
        let mut world = PhysicsWorld::new();
        preset::leaf_scale(&mut world.integration_parameters);
        let mut scene = Scene::new(world);
        let at = |x: f64, y: f64, z: f64| {
            Pose::from_translation(Vector::new(x as f32, y as f32, z as f32))
        };
        scene.add_box(at(0.0, -0.05, 0.0), [14.0, 0.1, 14.0], SAND);
        for [x, y, z, radius] in &self.balls {
            scene.add_ball(at(*x, *y, *z), *radius, STONE);
        }
        for [x, y, z, a, b, c] in &self.boxes {
            scene.add_box(at(*x, *y, *z), [*a, *b, *c], STONE);
        }
        scene.kinds.push(self.kind.clone());
        let awake = |body: RigidBodyBuilder| preset::leaf_body(body);
        for (index, release) in releases.iter().enumerate() {
            let origin = release.position - release.orientation * self.kind.dry.center;
            let color = LEAVES[index % LEAVES.len()];
            scene.add_piece(0, color, (origin, release.orientation), release.spin, awake);
            let handle = scene.pieces[index].handle;
            scene.world.bodies[handle].set_linvel(to_rapier(&release.velocity), true);
        }
        scene
    }

    /// The world with its leaves, and what steers them.
    pub fn set(&self, options: &Options, asked: Vec<Asked>) -> (Scene, Guided) {
        let mut immersion = self.air();
        let steer = |(index, asked): (usize, &Asked)| {
            let params = FollowParams {
                seed: options.seed.value + index as u64,
                ..FollowParams::default()
            };
            let follower =
                SketchFollower::new(&asked.sketch, &self.experiment, &immersion, &params);
            let follower = || follower.unwrap_or_else(|problem| cli::bad_value("sketch", problem));
            asked.known.is_none().then(follower)
        };
        let followers: Vec<_> = asked.iter().enumerate().map(steer).collect();
        let releases: Vec<BodyState> = asked
            .iter()
            .zip(&followers)
            .map(|(asked, follower)| match (&asked.known, follower) {
                (Some((release, _)), _) => *release,
                (None, follower) => follower.as_ref().expect("made above").release_state(),
            })
            .collect();
        let scene = self.scene(&releases);
        let handles: Vec<RigidBodyHandle> = scene.pieces.iter().map(|piece| piece.handle).collect();
        immersion.insert_all(handles.iter().copied(), (*self.kind.body).clone());
        for (asked, handle) in asked.iter().zip(&handles) {
            if let Some((_, series)) = &asked.known {
                immersion.replay(*handle, series, options.on_contact.into());
            }
        }
        let paths = releases
            .iter()
            .map(|release| vec![release.position])
            .collect();
        let guided = Guided {
            immersion,
            handles,
            asked,
            followers,
            releases,
            paths,
        };
        (scene, guided)
    }
}
