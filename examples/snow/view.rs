//! The scene at dusk, as a film: what stands by one ray per pixel, flakes as dots that are the brighter the nearer they are.

use gif::{Encoder, Frame, Repeat};
use rapier3d_immersed::rapier3d::prelude::*;

const SIZE: [usize; 2] = [480, 300];
const EYE: Vector = Vector::new(0.0, 1.5, 7.5);
/// Pixels per unit of the slope of a ray.
const FOCAL: f32 = 420.0;
const HORIZON: f32 = 165.0;
/// Colours at both ends of the palette: night, and snow.
const ENDS: [[f32; 3]; 2] = [[18.0, 24.0, 44.0], [246.0, 249.0, 255.0]];

pub struct Film {
    /// Brightness and distance along the view of what stands, pixel by pixel.
    ground: Vec<(f32, f32)>,
    frames: Vec<Vec<u8>>,
}

impl Film {
    pub fn new(world: &PhysicsWorld) -> Self {
        let light = Vector::new(-0.5, 0.7, 0.5).normalize();
        let ground = (0..SIZE[0] * SIZE[1]).map(|pixel| {
            let (x, y) = ((pixel % SIZE[0]) as f32, (pixel / SIZE[0]) as f32);
            let ahead = Vector::new(
                (x + 0.5 - 0.5 * SIZE[0] as f32) / FOCAL,
                (HORIZON - y - 0.5) / FOCAL,
                -1.0,
            );
            let filter = QueryFilter::default();
            let hit = world.cast_ray_and_get_normal(&Ray::new(EYE, ahead), 60.0, true, filter);
            match hit {
                Some((_, hit)) => {
                    let lit = hit.normal.dot(light).max(0.0);
                    // Far ground fades into the sky.
                    let near = (-hit.time_of_impact / 18.0).exp();
                    (46.0 + near * (95.0 * lit - 22.0), hit.time_of_impact)
                }
                None => (46.0 - 0.16 * (HORIZON - y), f32::INFINITY),
            }
        });
        Self {
            ground: ground.collect(),
            frames: Vec::new(),
        }
    }

    /// Takes a picture of flakes at these places.
    pub fn expose(&mut self, flakes: Vec<Vector>) {
        let mut light: Vec<f32> = self.ground.iter().map(|(shade, _)| *shade).collect();
        for flake in flakes {
            let from = flake - EYE;
            let depth = -from.z;
            if depth < 0.4 {
                continue;
            }
            let x = 0.5 * SIZE[0] as f32 + FOCAL * from.x / depth;
            let y = HORIZON - FOCAL * from.y / depth;
            // What a flake adds is shared out over what it covers: one pixel, or, nearby, some.
            let size = (3.0 / depth).ceil() as i32;
            let bright = (900.0 / (depth * depth)).clamp(4.0, 190.0) / size as f32;
            for (row, column) in (0..size * size).map(|i| (i / size, i % size)) {
                let (x, y) = (x.floor() as i32 + column, y.floor() as i32 + row);
                let inside = (0..SIZE[0] as i32).contains(&x) && (0..SIZE[1] as i32).contains(&y);
                let pixel = y.max(0) as usize * SIZE[0] + x.max(0) as usize;
                // A flake that has settled lies on what it is seen against.
                if inside && depth < self.ground[pixel].1 + 0.05 {
                    light[pixel] += bright;
                }
            }
        }
        self.frames.push(
            light
                .into_iter()
                .map(|x| x.clamp(0.0, 255.0) as u8)
                .collect(),
        );
    }

    /// The film as a GIF with one picture per `interval`, s.
    pub fn developed(self, interval: f32) -> Vec<u8> {
        let color = |i: u32| {
            let share = i as f32 / 255.0;
            [0, 1, 2].map(|k| (ENDS[0][k] + (ENDS[1][k] - ENDS[0][k]) * share) as u8)
        };
        let palette: Vec<u8> = (0..256).flat_map(color).collect();
        let [width, height] = SIZE.map(|n| n as u16);
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, width, height, &palette).expect("a fixed size");
        encoder
            .set_repeat(Repeat::Infinite)
            .expect("written into memory");
        for buffer in self.frames {
            let frame = Frame {
                width,
                height,
                buffer: buffer.into(),
                delay: (100.0 * interval).round() as u16,
                ..Frame::default()
            };
            encoder.write_frame(&frame).expect("written into memory");
        }
        drop(encoder);
        bytes
    }
}
