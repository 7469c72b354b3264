//! Recordings side by side as an animated GIF, for pages that play nothing else.

use super::raster::{Rgb, picture};
use super::recording::Recording;
use super::scene::Scene;
use super::sheet::Camera;
use color_quant::NeuQuant;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::collections::HashSet;

/// Size of one recording's picture, pixels.
const SIZE: [usize; 2] = [220, 300];
/// Pictures per second of the run, and the longest part of it that is shown, s.
const RATE: f64 = 12.0;
const LONGEST: f64 = 5.0;
/// The last picture stays, 1/100 s.
const PAUSE: u16 = 150;

/// The index of what is as in the picture before.
const SAME: u8 = 255;

/// The first seconds of the runs.
///
/// # Errors
/// Those of the encoder, for sizes beyond its format.
pub fn animation(scene: &Scene, runs: &[&Recording]) -> Result<Vec<u8>, EncodingError> {
    let camera = Camera::overview(runs);
    let until = runs.iter().filter_map(|run| run.times.last().copied());
    let until = until.fold(LONGEST, f64::min);
    let count = (until * RATE) as usize + 1;
    let pictures: Vec<Vec<Rgb>> = (0..count)
        .map(|index| {
            let time = index as f64 / RATE;
            let halves = runs.iter().map(|run| {
                let frame = run.times.partition_point(|t| *t < time - 1e-6);
                picture(scene, run, frame.min(run.times.len() - 1), &camera, SIZE)
            });
            beside(&halves.collect::<Vec<_>>())
        })
        .collect();
    let palette = Palette::of(&pictures);
    let (width, height) = (SIZE[0] * runs.len(), SIZE[1]);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width as u16, height as u16, &palette.colors)?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut before = vec![SAME; width * height];
    for (index, picture) in pictures.iter().enumerate() {
        let now: Vec<u8> = picture.iter().map(|color| palette.index(*color)).collect();
        let changed = now.iter().zip(&before);
        let changed = changed.map(|(now, before)| if now == before { SAME } else { *now });
        // Hundredths of a second, which add up to the run's time.
        let at = |index: usize| (100.0 * index as f64 / RATE).round() as u16;
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
    let rows = (0..SIZE[1]).map(|row| row * SIZE[0]..(row + 1) * SIZE[0]);
    rows.flat_map(|row| {
        pictures
            .iter()
            .flat_map(move |picture| &picture[row.clone()])
    })
    .copied()
    .collect()
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
    fn of(pictures: &[Vec<Rgb>]) -> Self {
        // Once each, so that small bright things count as much as the floor.
        let used: HashSet<usize> = pictures.iter().flatten().map(|c| coarse(*c)).collect();
        let full = |coarse: usize| {
            let channel = |shift: usize| ((coarse >> shift & 31) * 255 / 31) as u8;
            [channel(10), channel(5), channel(0), 255]
        };
        let mut used: Vec<usize> = used.into_iter().collect();
        used.sort_unstable();
        let seen: Vec<u8> = used.iter().flat_map(|c| full(*c)).collect();
        let network = NeuQuant::new(1, 255, &seen);
        let mut indices = vec![0; 1 << 15];
        for color in used {
            indices[color] = network.index_of(&full(color)) as u8;
        }
        let mut colors = network.color_map_rgb();
        colors.extend([0; 3]);
        Self { colors, indices }
    }

    fn index(&self, color: Rgb) -> u8 {
        self.indices[coarse(color)]
    }
}
