//! A scene: a rapier world with obstacles and many pieces that fall, and how each of them looks.

use super::{Quat, Vec3, from_rapier, to_rapier};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d_immersed::rapier3d::math::{Pose, Rotation};
use rapier3d_immersed::rapier3d::na::{Matrix3, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyBuilder, RigidBodyHandle};
use rapier3d_immersed::{DryMass, HydroProperties, ImmersedBody};
use std::sync::Arc;

/// Thinnest collision shape, m. Contacts between thinner ones cost more and overlap more; mass and
/// fluid forces are those of the true shape.
const COLLISION_THICKNESS: f64 = 1e-3;

/// Something to draw: a mesh in its body's frame and a colour.
#[derive(Clone, Debug)]
pub struct Look {
    /// The mesh.
    pub solid: Arc<Surface>,
    /// Linear RGB in [0, 1].
    pub color: [f32; 3],
    /// Polygons that stand for the mesh in pictures; none for a ball.
    pub faces: Arc<Vec<Vec<Vec3>>>,
    /// Radius of a ball, m.
    pub ball: Option<f64>,
}

impl Look {
    /// The polygons as triangles about their middles: few that do for shadows and in small pictures.
    pub fn outline(&self) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for polygon in self.faces.iter() {
            let (first, count) = (vertices.len() as u32 + 1, polygon.len() as u32);
            vertices.push(polygon.iter().sum::<Vec3>() / f64::from(count));
            vertices.extend(polygon);
            triangles.extend((0..count).map(|i| [first - 1, first + i, first + (i + 1) % count]));
        }
        (vertices, triangles)
    }
}

/// A kind of piece: everything that equal pieces share.
#[derive(Clone, Debug)]
pub struct Kind {
    /// What the fluid feels.
    pub body: Arc<ImmersedBody>,
    /// Mass properties.
    pub dry: DryMass,
    /// What it collides as.
    pub collision: SharedShape,
    /// Its mesh.
    pub solid: Arc<Surface>,
    /// Its outline, for pictures.
    pub outline: Arc<Vec<Vec<Vec3>>>,
}

impl Kind {
    /// A kind of thin piece of uniform density (kg/m³), under the default law. `outline` is what
    /// pictures show of it, in the frame of `solid`; without one they show its convex silhouette.
    ///
    /// # Errors
    /// What the mesh or the density lacks.
    pub fn new(solid: &Surface, density: f64, outline: Option<&[Vec3]>) -> Result<Self, String> {
        let (solid, place, half) = in_box_frame(solid);
        let integrals = solid.volume_integrals();
        let dry = DryMass {
            mass: density * integrals.volume,
            center: integrals.centroid,
            inertia: integrals.unit_inertia() * density,
        };
        dry.check().map_err(|error| error.to_string())?;
        let hydro = HydroProperties::from_surface(&solid, integrals.centroid);
        let outline = match outline {
            Some(outline) => outline.iter().map(place).collect(),
            None => {
                let flat = solid.vertices().iter().map(|v| [v.x, v.y]);
                let hull = convex_outline(flat.collect());
                hull.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect()
            }
        };
        let half = half.map(|x| x as f32);
        Ok(Self {
            body: Arc::new(ImmersedBody::new(hydro)),
            dry,
            collision: SharedShape::cuboid(half.x, half.y, half.z),
            solid: Arc::new(solid),
            outline: Arc::new(vec![outline]),
        })
    }

    /// A kind of piece to look at alone, of a mass in kg: in pictures it is as its solid.
    pub fn seen(solid: Surface, mass: f64) -> Self {
        let hydro = HydroProperties::from_surface(&solid, Vec3::zeros());
        Self {
            body: Arc::new(ImmersedBody::new(hydro)),
            dry: DryMass {
                mass,
                center: Vec3::zeros(),
                inertia: Matrix3::zeros(),
            },
            collision: SharedShape::ball(1.0),
            solid: Arc::new(solid),
            outline: Arc::new(Vec::new()),
        }
    }
}

/// A piece in the world.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Rapier's handle.
    pub handle: RigidBodyHandle,
    /// Index of its kind.
    pub kind: usize,
    /// Center of mass at the release, m.
    pub release: Vec3,
}

/// A fixed thing.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// Where it stands.
    pub pose: Pose,
    /// How it looks.
    pub look: Look,
}

/// The world, what falls in it, and what stands in it.
pub struct Scene {
    /// Rapier's part.
    pub world: PhysicsWorld,
    /// Kinds of pieces.
    pub kinds: Vec<Kind>,
    /// What falls.
    pub pieces: Vec<Piece>,
    /// Colour of each piece.
    pub colors: Vec<[f32; 3]>,
    /// What stands, the floor or the water's surface first.
    pub obstacles: Vec<Obstacle>,
    /// Linear RGB of water whose surface is the floor at y = 0: what is under it is seen through it.
    pub water: Option<[f32; 3]>,
}

impl Scene {
    /// An empty scene in `world`.
    pub fn new(world: PhysicsWorld) -> Self {
        Self {
            world,
            kinds: Vec::new(),
            pieces: Vec::new(),
            colors: Vec::new(),
            obstacles: Vec::new(),
            water: None,
        }
    }

    /// Adds a piece of `kind`; its frame's origin is put at `position`. `prepare` may set rapier's
    /// switches of the body.
    pub fn add_piece(
        &mut self,
        kind: usize,
        color: [f32; 3],
        (position, orientation): (Vec3, Quat),
        spin: Vec3,
        prepare: impl Fn(RigidBodyBuilder) -> RigidBodyBuilder,
    ) {
        let description = &self.kinds[kind];
        let q = orientation.coords.map(|x| x as f32);
        let builder = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(
                to_rapier(&position),
                Rotation::from_xyzw(q.x, q.y, q.z, q.w),
            ))
            .angvel(to_rapier(&spin))
            .additional_mass_properties(description.dry.to_mass_properties());
        let collider = ColliderBuilder::new(description.collision.clone())
            .density(0.0)
            .friction(0.6)
            .restitution(0.0);
        let (handle, _) = self.world.insert(prepare(builder), collider);
        self.pieces.push(Piece {
            handle,
            kind,
            release: position + orientation * description.dry.center,
        });
        self.colors.push(color);
    }

    /// Adds a fixed box of full extents `size`, m.
    pub fn add_box(&mut self, pose: Pose, size: [f64; 3], color: [f32; 3]) {
        let half = size.map(|x| 0.5 * x as f32);
        self.add_obstacle(pose, SharedShape::cuboid(half[0], half[1], half[2]), color);
    }

    /// Adds a fixed ball, m.
    pub fn add_ball(&mut self, pose: Pose, radius: f64, color: [f32; 3]) {
        self.add_obstacle(pose, SharedShape::ball(radius as f32), color);
    }

    /// Adds the surface of water at y = 0 to look at, of `size` along x and z, m; before any obstacle.
    pub fn add_water(&mut self, size: [f64; 2], color: [f32; 3]) {
        let half = Vec3::new(0.5 * size[0], 0.01, 0.5 * size[1]);
        let shape = SharedShape::cuboid(half.x as f32, half.y as f32, half.z as f32);
        let solid = surface_of(shape.as_cuboid().expect("a box").to_trimesh());
        let look = Look {
            solid: Arc::new(solid),
            color,
            faces: Arc::new(box_faces(half)),
            ball: None,
        };
        let pose = Pose::from_translation(to_rapier(&Vec3::new(0.0, -half.y, 0.0)));
        self.obstacles.insert(0, Obstacle { pose, look });
        self.water = Some(color);
    }

    /// Adds a piece to look at alone; recordings say where it is.
    pub fn add_seen(&mut self, kind: usize, color: [f32; 3]) {
        self.pieces.push(Piece {
            handle: RigidBodyHandle::invalid(),
            kind,
            release: Vec3::zeros(),
        });
        self.colors.push(color);
    }

    fn add_obstacle(&mut self, pose: Pose, shape: SharedShape, color: [f32; 3]) {
        let solid = match shape.as_ball() {
            // Coarser than the one that the fluid would feel.
            Some(ball) => surface_of(ball.to_trimesh(32, 24)),
            None => surface_of(shape.as_cuboid().expect("a box or a ball").to_trimesh()),
        };
        let faces = match shape.as_cuboid() {
            Some(cuboid) => box_faces(from_rapier(cuboid.half_extents)),
            None => Vec::new(),
        };
        let look = Look {
            solid: Arc::new(solid),
            color,
            faces: Arc::new(faces),
            ball: shape.as_ball().map(|ball| ball.radius.into()),
        };
        self.obstacles.push(Obstacle { pose, look });
        self.world.insert(
            RigidBodyBuilder::fixed().pose(pose),
            ColliderBuilder::new(shape).friction(0.6),
        );
    }

    /// How a piece looks.
    pub fn look(&self, piece: usize) -> Look {
        let kind = &self.kinds[self.pieces[piece].kind];
        Look {
            solid: kind.solid.clone(),
            color: self.colors[piece],
            faces: kind.outline.clone(),
            ball: None,
        }
    }
}

/// The lowest and the highest of each coordinate of a surface, m.
pub fn corners(solid: &Surface) -> [Vec3; 2] {
    let start = Vec3::repeat(f64::INFINITY);
    let fold = |[low, high]: [Vec3; 2], v: &Vec3| [low.inf(v), high.sup(v)];
    solid.vertices().iter().fold([start, -start], fold)
}

/// A mesh of rapier's of one of its solids.
pub fn surface_of(
    (vertices, triangles): (
        Vec<rapier3d_immersed::rapier3d::math::Vector>,
        Vec<[u32; 3]>,
    ),
) -> Surface {
    let vertices: Vec<Vec3> = vertices.into_iter().map(from_rapier).collect();
    Surface::new(&vertices, &triangles).expect("rapier's own mesh of a solid is closed")
}

fn box_faces(half: Vec3) -> Vec<Vec<Vec3>> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |a: f64, b: f64| {
                let mut v = Vector3::zeros();
                v[axis] = side * half[axis];
                v[(axis + 1) % 3] = side * a * half[(axis + 1) % 3];
                v[(axis + 2) % 3] = b * half[(axis + 2) % 3];
                v
            };
            faces.push(
                [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
                    .map(|(a, b)| corner(a, b))
                    .to_vec(),
            );
        }
    }
    faces
}

/// A thin solid in the frame of the box that it collides as (x along it, z its normal), the way from
/// its own frame to that one, and the half extents of the box: as wide as makes its area that of the
/// planform, as high as the solid.
///
/// The box sits at the frame's origin, unturned: for a collider that does not, rapier sums up mass
/// properties (even with a mass of zero), and that sum is wrong for bodies as light as these.
///
/// Of hulls with 6 to 10 corners instead of boxes, a tenth of the pieces never came to rest, and a step
/// with all pieces down took ten times as long.
fn in_box_frame(solid: &Surface) -> (Surface, impl Fn(&Vec3) -> Vec3 + use<>, Vec3) {
    let planform = HydroProperties::from_surface(solid, Vec3::zeros()).planform;
    let to_plate = planform.axes.inverse();
    let heights = solid.vertices().iter().map(|v| (to_plate * v).z);
    let low = heights.clone().fold(f64::INFINITY, f64::min);
    let high = heights.fold(f64::NEG_INFINITY, f64::max);
    let mut middle = to_plate * planform.center;
    middle.z = 0.5 * (low + high);
    let place = move |v: &Vec3| to_plate * v - middle;

    let extents = planform.half_extents;
    let share = (planform.area / (4.0 * extents.x * extents.y)).sqrt();
    let height = (high - low).max(COLLISION_THICKNESS);
    let half = Vec3::new(extents.x * share, extents.y * share, 0.5 * height);
    (solid.map(|v| place(&v)), place, half)
}

/// Convex hull of points in a plane, counter-clockwise (Andrew's monotone chain).
pub fn convex_outline(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1
                && corner(&chain[chain.len() - 2], &chain[chain.len() - 1], &p) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

/// Twice the signed area of a triangle.
fn corner(a: &[f64; 2], b: &[f64; 2], c: &[f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Rapier's pose of a body as position and unit quaternion (x, y, z, w).
pub fn pose_parts(pose: &Pose) -> (Vec3, Quat) {
    let q = pose.rotation;
    let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(f64::from);
    let raw = rapier3d_immersed::rapier3d::na::Quaternion::new(w, x, y, z);
    (
        from_rapier(pose.translation),
        UnitQuaternion::new_normalize(raw),
    )
}
