//! Leaves in a browser: what the page calls, without generated glue.
//!
//! Numbers go in as arguments and come out of the module's memory, at addresses that functions return. There is one
//! scene; `start` makes it anew.
//!
//! The module has 2.9 MB; 80 bodies that fall take 1 ms per step of 1/240 s (on a busy machine of two cores, while the browser still
//! compiles), 500 bodies 3 ms.

mod scene;

pub use scene::{MOST, POSE, Scene};

use rapier3d_immersed::rapier3d::math::Vector;
use std::cell::RefCell;

/// The scene, and the meshes that the page reads once.
struct Page {
    scene: Scene,
    meshes: Vec<(Vec<f32>, Vec<u32>)>,
}

thread_local! {
    static PAGE: RefCell<Option<Page>> = const { RefCell::new(None) };
}

/// What `of` gets of the scene; nothing before `start`.
fn with<T: Default>(of: impl FnOnce(&mut Page) -> T) -> T {
    PAGE.with_borrow_mut(|page| page.as_mut().map(of).unwrap_or_default())
}

/// Makes the scene anew; `immersed` is 0 for plain rapier. How many kinds there are, 0 if it could not be made.
#[unsafe(no_mangle)]
pub extern "C" fn start(seed: u32, immersed: u32) -> u32 {
    let Ok(scene) = Scene::new(seed.into(), immersed != 0) else {
        return 0;
    };
    let meshes: Vec<_> = (0..4).map(|kind| scene.mesh(kind)).collect();
    let count = meshes.len() as u32;
    PAGE.set(Some(Page { scene, meshes }));
    count
}

/// How many bodies of a kind there are.
#[unsafe(no_mangle)]
pub extern "C" fn most() -> u32 {
    MOST as u32
}

/// Where the vertices of a kind are, three f32 each.
#[unsafe(no_mangle)]
pub extern "C" fn vertices(kind: u32) -> u32 {
    with(|page| page.meshes[kind as usize].0.as_ptr() as usize as u32)
}

/// How many.
#[unsafe(no_mangle)]
pub extern "C" fn vertex_count(kind: u32) -> u32 {
    with(|page| page.meshes[kind as usize].0.len() as u32 / 3)
}

/// Where the corners of the triangles of a kind are, one u32 each.
#[unsafe(no_mangle)]
pub extern "C" fn indices(kind: u32) -> u32 {
    with(|page| page.meshes[kind as usize].1.as_ptr() as usize as u32)
}

/// How many.
#[unsafe(no_mangle)]
pub extern "C" fn index_count(kind: u32) -> u32 {
    with(|page| page.meshes[kind as usize].1.len() as u32)
}

/// Where the poses of all bodies are, seven f32 each.
#[unsafe(no_mangle)]
pub extern "C" fn poses() -> u32 {
    with(|page| page.scene.poses().as_ptr() as usize as u32)
}

/// Drops some of a kind around a point, m.
#[unsafe(no_mangle)]
pub extern "C" fn release(kind: u32, x: f32, y: f32, z: f32, count: u32) {
    with(|page| {
        page.scene.release(
            kind as usize,
            Vector::new(x, y, z),
            count.min(MOST as u32) as usize,
        );
    });
}

/// Blows at a point (m) with a velocity (m/s).
#[unsafe(no_mangle)]
pub extern "C" fn blow(x: f32, y: f32, z: f32, u: f32, v: f32, w: f32) {
    with(|page| page.scene.blow(Vector::new(x, y, z), Vector::new(u, v, w)));
}

/// The wind over everything along x, and the air's fluctuations, m/s.
#[unsafe(no_mangle)]
pub extern "C" fn weather(wind: f32, fluctuation: f32) {
    with(|page| {
        page.scene.set_wind(Vector::X * wind);
        page.scene.set_turbulence(fluctuation);
    });
}

/// Steps of 1/240 s.
#[unsafe(no_mangle)]
pub extern "C" fn step(count: u32) {
    with(|page| {
        (0..count).for_each(|_| page.scene.step());
        page.scene.write_poses();
    });
}

/// A number that two runs share only if all poses are the same to the bit.
#[unsafe(no_mangle)]
pub extern "C" fn hash() -> u32 {
    with(|page| page.scene.hash())
}
