//! Names of files, and the buttons that write and read them.

use crate::bench::{Bench, Command};
use kiss3d::egui::{TextEdit, Ui};
use std::path::PathBuf;

/// Where a scene and a film go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// The scene's file.
    pub scene: String,
    /// The film's: `.html`, `.gif` or `.glb`.
    pub film: String,
}

impl Default for Files {
    fn default() -> Self {
        Self {
            scene: "scene.json".into(),
            film: "bench.html".into(),
        }
    }
}

impl Files {
    /// Shows them.
    pub fn show(&mut self, ui: &mut Ui, bench: &Bench, asked: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            ui.add(TextEdit::singleline(&mut self.scene).desired_width(130.0));
            if ui.button("save").clicked() {
                asked.push(Command::Save(PathBuf::from(&self.scene)));
            }
            if ui.button("load").clicked() {
                asked.push(Command::Load(PathBuf::from(&self.scene)));
            }
        });
        ui.horizontal(|ui| {
            ui.add(TextEdit::singleline(&mut self.film).desired_width(130.0));
            match bench.film_length() {
                None => {
                    if ui.button("record").clicked() {
                        asked.push(Command::Record(true));
                    }
                }
                Some(seconds) => {
                    if ui.button(format!("write {seconds:.1} s")).clicked() {
                        asked.push(Command::Film(PathBuf::from(&self.film)));
                    }
                    if ui.button("drop").clicked() {
                        asked.push(Command::Record(false));
                    }
                }
            }
        });
        ui.weak("scenes are .json files; films .html, .gif or .glb");
    }
}
