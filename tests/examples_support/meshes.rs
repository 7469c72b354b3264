//! A user's mesh is read as it is, or refused with a line that names the file.

use crate::support::Vec3;
use crate::support::mesh::{RawMesh, aligned, load};
use rand::{RngExt, SeedableRng};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

const CUBE_OBJ: &str = "o cube\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 2\nv 2 0 2\nv 2 2 2\nv 0 2 2\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

/// A file of its own for each call: tests run side by side.
fn file(name: &str, content: &[u8]) -> PathBuf {
    static CALLS: AtomicU32 = AtomicU32::new(0);
    let call = CALLS.fetch_add(1, Ordering::Relaxed);
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("meshes_{call}"));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    std::fs::write(&path, content).unwrap();
    path
}

fn facets(mesh: &RawMesh) -> impl Iterator<Item = [Vec3; 3]> + '_ {
    mesh.triangles
        .iter()
        .map(|t| t.map(|i| mesh.vertices[i as usize]))
}

fn ascii_stl(mesh: &RawMesh) -> Vec<u8> {
    let mut text = String::from("solid cube\n");
    for corners in facets(mesh) {
        text += "facet normal 0 0 0\nouter loop\n";
        for v in corners {
            text += &format!("vertex {} {} {}\n", v.x, v.y, v.z);
        }
        text += "endloop\nendfacet\n";
    }
    (text + "endsolid cube\n").into_bytes()
}

fn binary_stl(mesh: &RawMesh, header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, 0);
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for corners in facets(mesh) {
        bytes.extend([0; 12]);
        for v in corners {
            bytes.extend(v.iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn cube() -> RawMesh {
    load(&file("cube_source.obj", CUBE_OBJ.as_bytes())).unwrap()
}

#[test]
fn all_formats_give_the_same_solid() {
    let cube = cube();
    let files = [
        file("cube.obj", CUBE_OBJ.as_bytes()),
        file("cube_ascii.stl", &ascii_stl(&cube)),
        file("cube_binary.STL", &binary_stl(&cube, b"exported")),
        // A name is optional.
        file(
            "cube_nameless.stl",
            String::from_utf8(ascii_stl(&cube))
                .unwrap()
                .replacen("solid cube\n", "solid\n", 1)
                .as_bytes(),
        ),
        // Some programs start the header of binary files like that.
        file("cube_solid.stl", &binary_stl(&cube, b"solid cube")),
    ];
    for path in files {
        let solid = load(&path).unwrap().solid(1e-3).unwrap();
        assert_eq!(solid.vertices().len(), 8, "{path:?}");
        assert!((solid.volume_integrals().volume - 8.0).abs() < 1e-12);
    }
}

#[test]
fn an_open_sheet_gets_a_thickness() {
    // Two quads in the plane z = 0, wound alike.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n";
    let sheet = load(&file("sheet.obj", text.as_bytes())).unwrap();
    let integrals = sheet.solid(0.01).unwrap().volume_integrals();
    assert!((integrals.volume - 2.0 * 0.01).abs() < 1e-12);
    assert!((integrals.centroid - Vec3::new(1.0, 0.5, 0.0)).norm() < 1e-12);
}

#[test]
fn a_box_with_a_hole_is_neither_solid_nor_sheet() {
    let mut open = cube();
    open.triangles.pop();
    let problem = open.solid(1e-3).unwrap_err();
    assert!(problem.contains("neither a solid nor a sheet"), "{problem}");
}

#[test]
fn aligned_solids_have_diagonal_inertia() {
    // A box of 3 × 1 × 2, turned and moved.
    let turn = crate::support::Quat::from_euler_angles(0.4, 1.0, -0.3);
    let mut raw = cube();
    for v in &mut raw.vertices {
        *v = turn * v.component_mul(&Vec3::new(1.5, 0.5, 1.0)) + Vec3::new(4.0, 5.0, 6.0);
    }
    let integrals = aligned(&raw.solid(1e-3).unwrap()).volume_integrals();
    assert!(integrals.centroid.norm() < 1e-9);
    // ∫x² = V·a²/12, from the longest to the shortest.
    let exact = Vec3::new(9.0, 4.0, 1.0) * (6.0 / 12.0);
    let difference =
        integrals.second_moment - rapier3d_immersed::rapier3d::na::Matrix3::from_diagonal(&exact);
    assert!(difference.norm() < 1e-9, "{difference}");
}

#[test]
fn bad_files_are_refused_by_name() {
    let mut long = binary_stl(&cube(), b"");
    long.truncate(300);
    let mut lying = binary_stl(&cube(), b"");
    lying[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let cases: [(&str, Vec<u8>, &str); 9] = [
        ("empty.obj", Vec::new(), "no triangles"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), "no triangles"),
        ("index.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 9\n".to_vec(), "OBJ"),
        (
            "nan.obj",
            b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(),
            "not finite",
        ),
        (
            "infinite.obj",
            b"v 1e99 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(),
            "not finite",
        ),
        ("short.stl", b"abc".to_vec(), "shorter than its header"),
        ("truncated.stl", long, "not an STL file"),
        ("lying.stl", lying, "not an STL file"),
        ("leaf.ply", b"ply".to_vec(), ".obj or .stl"),
    ];
    for (name, content, expected) in cases {
        let problem = load(&file(name, &content)).unwrap_err();
        assert!(problem.contains(name), "{problem}");
        assert!(problem.contains(expected), "{name}: {problem}");
        assert!(!problem.contains('\n'), "{problem}");
    }
    let missing = load("no/such/leaf.obj".as_ref()).unwrap_err();
    assert!(missing.starts_with("no/such/leaf.obj: "), "{missing}");
}

#[test]
fn altered_files_never_panic() {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    let cube = cube();
    let sources = [
        ("fuzz.obj", CUBE_OBJ.as_bytes().to_vec()),
        ("fuzz_ascii.stl", ascii_stl(&cube)),
        ("fuzz_binary.stl", binary_stl(&cube, b"")),
    ];
    for (name, source) in sources {
        for _ in 0..150 {
            let mut bytes = source.clone();
            for _ in 0..random.random_range(1..6) {
                let at = random.random_range(0..bytes.len());
                bytes[at] = random.random();
            }
            if random.random_bool(0.3) {
                bytes.truncate(random.random_range(0..bytes.len()));
            }
            // Either is fine; so is a solid that cannot be made of what was read.
            if let Ok(mesh) = load(&file(name, &bytes)) {
                let _ = mesh.solid(1e-3);
            }
        }
    }
}
