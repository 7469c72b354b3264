//! A scene and its recordings as files: a page that plays in a browser, a `.glb` for 3-D tools and, if asked for, a GIF.

use super::cli;
use super::options::Out;
use super::recording::Recording;
use super::scene::Scene;
use super::sheet::{Camera, bounds};
use super::{gif, glb, html};
use clap::Args;
use std::path::PathBuf;

/// How often an animation looks.
#[derive(Args, Clone, Copy, Debug)]
pub struct FrameRate {
    /// Frames per second of the animation
    #[arg(id = "frame_rate", long = "frame-rate", value_name = "HZ", default_value = "30", value_parser = cli::positive)]
    pub hertz: f64,
}

/// What becomes of an animation.
#[derive(Args, Clone, Copy, Debug)]
pub struct FilmArgs {
    /// Write the first seconds of the animation as a GIF, too
    #[arg(long)]
    pub gif: bool,
    /// Show the animation in the browser
    #[arg(long)]
    pub open: bool,
}

/// A scene, and runs of equal pieces in it by name: side by side on the page.
pub struct Film<'a> {
    /// Name of the files.
    pub name: &'a str,
    /// What the page says that it shows.
    pub title: &'a str,
    /// What stands and what moves.
    pub scene: &'a Scene,
    /// How it moved. The `.glb` file has the first.
    pub runs: &'a [(&'a str, &'a Recording)],
    /// Where it is seen from at first; an overview without one.
    pub camera: Option<Camera>,
    /// Whether the page follows the first body from near by, if it is too small to be seen.
    pub follow: bool,
}

impl Film<'_> {
    /// Writes the files and shows the page if that is asked for; returns where they are, the page first.
    pub fn write(&self, out: &Out, options: &FilmArgs) -> Vec<PathBuf> {
        let recordings: Vec<&Recording> = self.runs.iter().map(|(_, run)| *run).collect();
        let camera = self
            .camera
            .unwrap_or_else(|| Camera::overview(&bounds(self.scene, &recordings)));
        let name = |kind: &str| format!("{}.{kind}", self.name);
        let page = html::page_from(self.title, self.scene, self.runs, &camera, self.follow);
        let mut files = vec![out.write(&name("html"), page)];
        if let Some(first) = recordings.first() {
            files.push(out.write(&name("glb"), glb::animation(self.scene, first)));
        }
        if options.gif {
            let runs: Vec<_> = recordings.iter().map(|run| (self.scene, *run)).collect();
            let gif = gif::side_by_side(&runs, &camera, gif::RATE)
                .unwrap_or_else(|problem| cli::cannot_write(&out.path(&name("gif")), problem));
            files.push(out.write(&name("gif"), gif));
        }
        if options.open {
            cli::open(&files[0]);
        }
        files
    }
}
