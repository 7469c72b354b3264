//! A recorded scene in perspective, triangle by triangle, with a depth for every sample of the picture.

use super::recording::Recording;
use super::scene::{Look, Scene, pose_parts};
use super::sheet::{Camera, clipped, display, light, shadow};
use super::{Quat, Vec3};

/// Samples per pixel along each side.
const SAMPLES: usize = 2;

/// sRGB.
pub type Rgb = [u8; 3];

const SKY: Rgb = [236, 240, 243];

/// Places in space as samples of a picture.
struct View {
    size: [usize; 2],
    eye: Vec3,
    /// To the right, up and ahead, of lengths that make quotients by the last samples.
    axes: [Vec3; 3],
}

impl View {
    fn new(camera: &Camera, size: [usize; 2]) -> Self {
        let ahead = (camera.target - camera.eye).normalize();
        let right = ahead.cross(&Vec3::y()).normalize();
        let focal = 0.5 * size[1] as f64 / (0.5 * camera.field_of_view).tan();
        let axes = [right * focal, right.cross(&ahead) * focal, ahead];
        Self {
            size,
            eye: camera.eye,
            axes,
        }
    }

    /// Calls `paint` with the index of every sample that a triangle covers and the reciprocal of its depth there.
    fn cover(&self, corners: &[Vec3; 3], mut paint: impl FnMut(usize, f64)) {
        const NEAR: f64 = 0.01;
        let seen = corners.map(|p| {
            let [x, y, z] = self.axes.map(|axis| axis.dot(&(p - self.eye)));
            Vec3::new(x, y, z)
        });
        let [middle_x, middle_y] = self.size.map(|n| 0.5 * n as f64);
        let point = |p: &Vec3| Vec3::new(middle_x + p.x / p.z, middle_y - p.y / p.z, 1.0 / p.z);
        if seen.iter().all(|p| p.z > NEAR) {
            return self.fill(seen.map(|p| point(&p)), &mut paint);
        }
        let ahead = clipped(&seen, |p| p.z - NEAR, |a, b, s| a + (b - a) * s);
        for i in 2..ahead.len() {
            let corners = [0, i - 1, i].map(|k| point(&ahead[k]));
            self.fill(corners, &mut paint);
        }
    }

    fn fill(&self, [a, b, c]: [Vec3; 3], paint: &mut impl FnMut(usize, f64)) {
        // Twice the area of a triangle with an edge from p to q.
        let edge =
            |p: &Vec3, q: &Vec3, x: f64, y: f64| (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
        let area = edge(&a, &b, c.x, c.y);
        if area == 0.0 {
            return;
        }
        let range = |k: usize| {
            let low = a[k].min(b[k]).min(c[k]).max(0.0) as usize;
            let high = a[k].max(b[k]).max(c[k]).max(0.0) as usize;
            low..high.saturating_add(1).min(self.size[k])
        };
        for row in range(1) {
            for column in range(0) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let parts = [edge(&b, &c, x, y), edge(&c, &a, x, y), edge(&a, &b, x, y)];
                let [u, v, w] = parts.map(|part| part / area);
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    // Along a plane, the reciprocal of depth is linear in the picture.
                    paint(row * self.size[0] + column, u * a.z + v * b.z + w * c.z);
                }
            }
        }
    }
}

/// A picture that is being drawn.
struct Canvas {
    view: View,
    colors: Vec<Rgb>,
    /// Reciprocals of depth: 0 is infinitely far.
    near: Vec<f64>,
}

type Place = (Vec3, Quat);

/// The triangles of a look: of its polygons where it has any.
fn corners(look: &Look, place: impl Fn(&Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
    let (vertices, triangles) = match look.faces.is_empty() {
        true => (
            look.solid.vertices().to_vec(),
            look.solid.triangles().to_vec(),
        ),
        false => look.outline(),
    };
    let places: Vec<Vec3> = vertices.iter().map(place).collect();
    let triangles = triangles.iter();
    triangles
        .map(|triangle| triangle.map(|i| places[i as usize]))
        .collect()
}

impl Canvas {
    fn solid(&mut self, look: &Look, (position, turn): Place) {
        for corners in corners(look, |v| position + turn * v) {
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            // Zero for a triangle without an area, which covers nothing.
            let mut normal = normal.try_normalize(0.0).unwrap_or_default();
            if normal.dot(&(self.view.eye - corners[0])) < 0.0 {
                normal = -normal;
            }
            // Most triangles of small things cover no sample: those need no colour.
            let mut shade = None;
            self.view.cover(&corners, |sample, near| {
                if near > self.near[sample] {
                    let lit = || 0.35 * normal.dot(&light()).max(0.0) + 0.2 * normal.y.abs();
                    let color = shade.get_or_insert_with(|| display(look.color, 0.45 + lit()));
                    self.colors[sample] = [color.0, color.1, color.2];
                    self.near[sample] = near;
                }
            });
        }
    }

    /// Darkens the floor, while nothing else is drawn, where the looks' shadows fall; each has a strength.
    fn shadows(&mut self, looks: impl Iterator<Item = (Look, Place, f64)>) {
        let mut dark = vec![0.0_f64; self.colors.len()];
        for (look, (position, turn), strength) in looks {
            for corners in corners(&look, |v| shadow(&(position + turn * v))) {
                self.view.cover(&corners, |sample, _| {
                    dark[sample] = dark[sample].max(strength);
                });
            }
        }
        for (color, dark) in self.colors.iter_mut().zip(dark) {
            *color = color.map(|x| (f64::from(x) * (1.0 - dark)) as u8);
        }
    }

    /// The mean of the samples of every pixel.
    fn pixels(&self) -> Vec<Rgb> {
        let [width, height] = self.view.size;
        let pixel = |row: usize, column: usize| {
            let mut sum = [0usize; 3];
            for i in 0..SAMPLES * SAMPLES {
                let sample = (row + i / SAMPLES) * width + column + i % SAMPLES;
                for (sum, x) in sum.iter_mut().zip(self.colors[sample]) {
                    *sum += usize::from(x);
                }
            }
            sum.map(|x| (x / (SAMPLES * SAMPLES)) as u8)
        };
        let rows = (0..height).step_by(SAMPLES);
        rows.flat_map(|row| {
            (0..width)
                .step_by(SAMPLES)
                .map(move |column| pixel(row, column))
        })
        .collect()
    }
}

/// One recorded frame, row by row.
pub fn picture(
    scene: &Scene,
    recording: &Recording,
    frame: usize,
    camera: &Camera,
    size: [usize; 2],
) -> Vec<Rgb> {
    let view = View::new(camera, size.map(|n| n * SAMPLES));
    let samples = view.size[0] * view.size[1];
    let mut canvas = Canvas {
        view,
        colors: vec![SKY; samples],
        near: vec![0.0; samples],
    };
    let obstacles = scene.obstacles.iter();
    let obstacles: Vec<_> = obstacles
        .map(|obstacle| (obstacle.look.clone(), pose_parts(&obstacle.pose)))
        .collect();
    let pieces = || {
        let places = recording.frames[frame].iter().enumerate();
        places.map(|(piece, place)| (scene.look(piece), *place))
    };
    if let Some((floor, place)) = obstacles.first() {
        canvas.solid(floor, *place);
        let standing = obstacles[1..].iter();
        let standing = standing.map(|(look, place)| (look.clone(), *place, 0.22));
        // Higher pieces cast fainter shadows, as under a wide sky.
        let falling = pieces().map(|(look, place)| {
            let strength = 0.3 / (1.0 + 4.0 * place.0.y.max(0.0));
            (look, place, strength)
        });
        canvas.shadows(standing.chain(falling));
    }
    for (look, place) in obstacles.iter().skip(1).cloned().chain(pieces()) {
        canvas.solid(&look, place);
    }
    canvas.pixels()
}
