//! Recordings side by side as an animated GIF, for pages that play nothing else.

use super::raster::{Rgb, picture};
use super::recording::Recording;
use super::scene::Scene;
use super::sheet::{Camera, bounds};
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

/// Size of one recording's picture, pixels.
const SIZE: [usize; 2] = [236, 340];
/// Pictures per second of an [`animation`], and the longest part of it that is shown, s.
pub const RATE: f64 = 15.0;
const LONGEST: f64 = 5.0;
/// The last picture stays, 1/100 s.
const PAUSE: u16 = 150;

/// What is between two pictures.
const GAP: [Rgb; 4] = [[255; 3]; 4];

/// The index of what is as in the picture before.
const SAME: u8 = 255;

/// The first seconds of the runs.
///
/// # Errors
/// Those of the encoder, for sizes beyond its format.
pub fn animation(scene: &Scene, runs: &[&Recording]) -> Result<Vec<u8>, EncodingError> {
    let camera = Camera::overview(&bounds(scene, runs));
    let runs: Vec<_> = runs.iter().map(|run| (scene, *run)).collect();
    side_by_side(&runs, &camera, RATE)
}

/// The first seconds of runs of a scene each, seen from one place, in so many pictures per second.
///
/// # Errors
/// Those of the encoder, for sizes beyond its format.
pub fn side_by_side(
    runs: &[(&Scene, &Recording)],
    camera: &Camera,
    rate: f64,
) -> Result<Vec<u8>, EncodingError> {
    let until = runs.iter().filter_map(|(_, run)| run.times.last().copied());
    let until = until.fold(LONGEST, f64::min);
    let count = (until * rate) as usize + 1;
    let pictures: Vec<Vec<Rgb>> = (0..count)
        .map(|index| {
            let time = index as f64 / rate;
            let parts = runs.iter().map(|(scene, run)| {
                let frame = run.times.partition_point(|t| *t < time - 1e-6);
                picture(scene, run, frame.min(run.times.len() - 1), camera, SIZE)
            });
            beside(&parts.collect::<Vec<_>>())
        })
        .collect();
    let palette = Palette::of(&pictures);
    let (width, height) = (pictures[0].len() / SIZE[1], SIZE[1]);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width as u16, height as u16, &palette.colors)?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut before = vec![SAME; width * height];
    for (index, picture) in pictures.iter().enumerate() {
        let now: Vec<u8> = picture.iter().map(|color| palette.index(*color)).collect();
        let changed = now.iter().zip(&before);
        let changed = changed.map(|(now, before)| if now == before { SAME } else { *now });
        // Hundredths of a second, which add up to the run's time.
        let at = |index: usize| (100.0 * index as f64 / rate).round() as u16;
        encoder.write_frame(&Frame {
            width: width as u16,
            height: height as u16,
            buffer: changed.collect::<Vec<_>>().into(),
            transparent: Some(SAME),
            dispose: DisposalMethod::Keep,
            delay: if index + 1 == count {
                PAUSE
            } else {
                at(index + 1) - at(index)
            },
            ..Frame::default()
        })?;
        before = now;
    }
    drop(encoder);
    Ok(bytes)
}

/// Pictures of [`SIZE`], left to right.
fn beside(pictures: &[Vec<Rgb>]) -> Vec<Rgb> {
    let row = |row: usize| {
        let of = |picture: &Vec<Rgb>| picture[row * SIZE[0]..(row + 1) * SIZE[0]].to_vec();
        let parts: Vec<Vec<Rgb>> = pictures.iter().map(of).collect();
        parts.join(&GAP[..])
    };
    (0..SIZE[1]).flat_map(row).collect()
}

/// Five bits per channel: what pictures are told apart by.
fn coarse(color: Rgb) -> usize {
    let [r, g, b] = color.map(|x| usize::from(x >> 3));
    r << 10 | g << 5 | b
}

/// 255 colours, and which of them is next to a coarse colour.
struct Palette {
    colors: Vec<u8>,
    indices: Vec<u8>,
}

impl Palette {
    /// The means of the most frequent coarse colours: grounds and walls, which fill most of the pictures, are exact.
    fn of(pictures: &[Vec<Rgb>]) -> Self {
        let mut sums = vec![([0_u64; 3], 0_u64); 1 << 15];
        for color in pictures.iter().flatten() {
            let (sum, count) = &mut sums[coarse(*color)];
            for (sum, x) in sum.iter_mut().zip(color) {
                *sum += u64::from(*x);
            }
            *count += 1;
        }
        let used = (0..sums.len()).filter(|coarse| sums[*coarse].1 > 0);
        let mut means: Vec<(usize, Rgb)> = used
            .map(|coarse| (coarse, sums[coarse].0.map(|x| (x / sums[coarse].1) as u8)))
            .collect();
        means.sort_by_key(|(coarse, _)| std::cmp::Reverse(sums[*coarse].1));
        let chosen = &means[..means.len().min(usize::from(SAME))];
        let apart = |a: &Rgb, b: &Rgb| {
            (0..3)
                .map(|k| u32::from(a[k].abs_diff(b[k])).pow(2))
                .sum::<u32>()
        };
        let mut indices = vec![0; sums.len()];
        for (coarse, mean) in &means {
            let nearest = (0..chosen.len()).min_by_key(|i| apart(&chosen[*i].1, mean));
            indices[*coarse] = nearest.unwrap_or(0) as u8;
        }
        let mut colors: Vec<u8> = chosen.iter().flat_map(|(_, mean)| *mean).collect();
        colors.resize(3 * 256, 0);
        Self { colors, indices }
    }

    fn index(&self, color: Rgb) -> u8 {
        self.indices[coarse(color)]
    }
}
