//! The animation file is valid glTF 2.0 and says what was recorded.

use crate::support::leaf::{Blade, Outline};
use crate::support::recording::{Plain, RunOptions, run};
use crate::support::scene::{Kind, Scene};
use crate::support::{Quat, Vec3, glb};
use gltf::animation::Property;
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use std::collections::HashSet;

/// Three leaves of two colours that fall and turn for half a second.
pub fn scene() -> Scene {
    let mut scene = Scene::new(PhysicsWorld::new());
    let blade = Blade {
        outline: Outline::Ovate,
        length: 0.07,
        width: 0.04,
        thickness: 0.0003,
        camber: [0.001, 0.0],
    };
    scene
        .kinds
        .push(Kind::new(&blade.solid().unwrap(), 350.0, None).unwrap());
    let below = Pose::from_translation(Vector::new(0.0, -5.0, 0.0));
    scene.add_box(below, [1.0, 0.1, 1.0], [0.5; 3]);
    scene.add_ball(below, 0.5, [0.2; 3]);
    for i in 0..3 {
        let at = Vec3::new(f64::from(i), 1.0, 0.0);
        let color = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]][i as usize % 2];
        scene.add_piece(
            0,
            color,
            (at, Quat::identity()),
            Vec3::new(0.0, 0.0, 9.0),
            |b| b,
        );
    }
    scene
}

fn floats(blob: &[u8], accessor: &gltf::Accessor) -> Vec<f32> {
    let view = accessor.view().unwrap();
    let start = view.offset() + accessor.offset();
    let count = accessor.count() * accessor.dimensions().multiplicity();
    blob[start..start + 4 * count]
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect()
}

#[test]
fn the_file_is_valid_and_complete() {
    let mut scene = scene();
    let options = RunOptions {
        seconds: 0.5,
        frame_rate: 30.0,
        forces: false,
        message: "test",
    };
    let recording = run(&mut scene, &options, &mut Plain);
    assert_eq!(recording.times.len(), 16);
    let bytes = glb::animation(&scene, &recording);
    assert_eq!(
        u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize,
        bytes.len()
    );

    // An independent reader, which validates indices, types and required fields.
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = file.blob.as_deref().unwrap();
    assert_eq!(file.nodes().count(), 2 + 3);
    // A box, a ball, and the leaf in two colours that share their vertices.
    assert_eq!(file.meshes().count(), 4);
    let positions: HashSet<usize> = file
        .meshes()
        .flat_map(|mesh| mesh.primitives().collect::<Vec<_>>())
        .map(|primitive| primitive.get(&gltf::Semantic::Positions).unwrap().index())
        .collect();
    assert_eq!(positions.len(), 3);
    for view in file.views() {
        assert_eq!(view.offset() % 4, 0);
        assert!(view.offset() + view.length() <= blob.len());
    }
    for accessor in file.accessors() {
        assert!(accessor.size() * accessor.count() <= accessor.view().unwrap().length());
    }

    let animation = file.animations().next().unwrap();
    assert_eq!(animation.channels().count(), 2 * 3);
    let inputs: HashSet<usize> = animation.samplers().map(|s| s.input().index()).collect();
    assert_eq!(inputs.len(), 1, "the time accessor is shared");
    for channel in animation.channels() {
        let sampler = channel.sampler();
        let times = floats(blob, &sampler.input());
        assert!(times.windows(2).all(|t| t[1] > t[0]));
        assert_eq!(times.len(), recording.times.len());
        let piece = channel.target().node().index() - 2;
        let values = floats(blob, &sampler.output());
        for (k, frame) in recording.frames.iter().enumerate() {
            let (position, turn) = frame[piece];
            match channel.target().property() {
                Property::Translation => {
                    let key = Vec3::from_fn(|i, _| f64::from(values[3 * k + i]));
                    assert!((key - position).norm() < 1e-6);
                }
                Property::Rotation => {
                    let key = &values[4 * k..4 * k + 4];
                    let dot: f64 = (0..4).map(|i| f64::from(key[i]) * turn.coords[i]).sum();
                    assert!(
                        (dot.abs() - 1.0).abs() < 1e-6,
                        "unit length, and the same attitude"
                    );
                }
                other => panic!("{other:?} is not animated"),
            }
        }
    }
}

#[test]
fn quaternions_are_continuous() {
    // Two and a half turns; the sign convention of the input jumps.
    let turns = (0..100).map(|i| {
        let turn = Quat::from_euler_angles(0.0, 0.0, 0.157 * f64::from(i));
        if i % 3 == 0 {
            Quat::new_unchecked(-turn.into_inner())
        } else {
            turn
        }
    });
    let keys = glb::continuous(turns);
    for pair in keys.windows(2) {
        let dot: f32 = (0..4).map(|i| pair[0][i] * pair[1][i]).sum();
        assert!(dot > 0.99);
    }
}
