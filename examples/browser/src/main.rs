//! Builds the page: the module for the browser, then one file with it, the renderer and the controls.
//!
//! ```text
//! rustup target add wasm32-unknown-unknown
//! cargo run --manifest-path examples/browser/Cargo.toml
//! ```

use base64::{Engine, prelude::BASE64_STANDARD};
use clap::Parser;
use immersed_leaves_in_a_browser::Scene;
use rapier3d_immersed::rapier3d::math::Vector;
use std::path::Path;
use std::process::{Command, exit};

const TARGET: &str = "wasm32-unknown-unknown";

/// Make one page with leaves, cards, confetti and coins to drop and to blow.
#[derive(Parser)]
struct Arguments {
    /// Print the number that the page's test must find, instead: the hash of a fall on this machine.
    #[arg(long)]
    hash: bool,
}

fn main() {
    if Arguments::parse().hash {
        println!("{:08x}", fall());
        return;
    }
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let built = package.join("target/page");
    let status = Command::new(env!("CARGO"))
        .args([
            "build",
            "--release",
            "--lib",
            "--target",
            TARGET,
            "--target-dir",
        ])
        .arg(&built)
        .current_dir(package)
        .env("RUSTFLAGS", "-C target-feature=+simd128")
        .status();
    if !status.is_ok_and(|status| status.success()) {
        eprintln!(
            "error: no module for the browser: is the target there? rustup target add {TARGET}"
        );
        exit(1);
    }
    let module = built
        .join(TARGET)
        .join("release/immersed_leaves_in_a_browser.wasm");
    let bytes = std::fs::read(&module).unwrap_or_else(|error| fail(&module, error));
    let scripts = [
        include_str!("../page/physics.js"),
        include_str!("../../support/viewer/vectors.js"),
        include_str!("../../support/viewer/camera.js"),
        include_str!("../../support/viewer/solids.js"),
        include_str!("../page/controls.js"),
    ];
    let page = include_str!("../page/page.html")
        .replace("{{script}}", &scripts.join("\n"))
        .replace("{{module}}", &BASE64_STANDARD.encode(&bytes));
    let out = package.join("target/leaves.html");
    std::fs::write(&out, &page).unwrap_or_else(|error| fail(&out, error));
    println!(
        "{} ({} kB, of which the module {} kB)",
        out.display(),
        page.len() / 1000,
        bytes.len() / 1000
    );
}

fn fail(path: &Path, error: std::io::Error) -> ! {
    eprintln!("error: {}: {error}", path.display());
    exit(1)
}

/// Leaves, cards, confetti and coins that fall for two seconds into a gust; the page does the same in its test.
fn fall() -> u32 {
    let Ok(mut scene) = Scene::new(7, true) else {
        eprintln!("error: no scene");
        exit(1);
    };
    scene.set_wind(Vector::X * 0.5);
    scene.set_turbulence(0.3);
    for kind in 0..4 {
        scene.release(kind, Vector::new(0.1 * kind as f32, 0.8, 0.0), 20);
    }
    for _ in 0..240 {
        scene.step();
    }
    scene.blow(Vector::new(0.0, 0.2, 0.0), Vector::new(2.0, 1.0, 0.0));
    for _ in 0..240 {
        scene.step();
    }
    scene.write_poses();
    scene.hash()
}
