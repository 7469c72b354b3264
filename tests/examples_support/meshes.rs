//! A user's mesh is read as it is, or refused with a line that names the file.

use crate::support::Vec3;
use crate::support::mesh::{RawMesh, aligned, load, load_scaled};
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

/// What programs write that is not in the book: byte-order marks, comments in Latin-1, lines that end as on
/// Windows, negative indices, faces of many corners, vertices that are there twice, corners on a line that
/// close a gap between faces of different divisions, and a mesh that is inside out.
#[test]
fn obj_files_as_they_are_found() {
    let windows = CUBE_OBJ.replace('\n', "\r\n");
    let mut latin = b"# Gro\xdfe W\xfcrfel \xb5m\no W\xfcrfel\n".to_vec();
    latin.extend(CUBE_OBJ.as_bytes());
    let mut marked = b"\xef\xbb\xbf".to_vec();
    marked.extend(CUBE_OBJ.replacen("o cube\n", "", 1).as_bytes());
    let negative: String = CUBE_OBJ
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(face) => {
                let corners = face.split(' ').map(|i| i.parse::<i32>().unwrap() - 9);
                let corners: Vec<String> = corners.map(|i| i.to_string()).collect();
                format!("f {}\n", corners.join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    let mut twice = String::new();
    for (count, face) in CUBE_OBJ
        .lines()
        .filter_map(|l| l.strip_prefix("f "))
        .enumerate()
    {
        let vertex = |i: &str| CUBE_OBJ.lines().nth(i.parse::<usize>().unwrap()).unwrap();
        face.split(' ')
            .for_each(|i| twice += &format!("{}\n", vertex(i)));
        let first = 4 * count;
        twice += &format!(
            "f {} {} {} {}\n",
            first + 1,
            first + 2,
            first + 3,
            first + 4
        );
    }
    // Vertex 9 halves the edge from 1 to 2 of the bottom, whose other face knows nothing of it.
    let collinear = CUBE_OBJ.replacen("f 4 3 2 1", "v 1 0 0\nf 4 3 2 9 1\nf 1 9 2", 1);
    let reversed: String = CUBE_OBJ
        .lines()
        .map(|line| match line.strip_prefix("f ") {
            Some(face) => {
                let corners: Vec<&str> = face.split(' ').rev().collect();
                format!("f {}\n", corners.join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    for (name, content) in [
        ("windows.obj", windows.into_bytes()),
        ("latin.obj", latin),
        ("marked.obj", marked),
        ("negative.obj", negative.into_bytes()),
        ("twice.obj", twice.into_bytes()),
        ("collinear.obj", collinear.into_bytes()),
        ("reversed.obj", reversed.into_bytes()),
    ] {
        let mesh = load(&file(name, &content)).unwrap_or_else(|problem| panic!("{problem}"));
        let solid = mesh
            .solid(1e-3)
            .unwrap_or_else(|problem| panic!("{name}: {problem}"));
        let volume = solid.volume_integrals().volume;
        assert!((volume - 8.0).abs() < 1e-12, "{name}: {volume}");
    }
    // A prism over a hexagon of side 1: 3√3/2.
    let mut prism = String::new();
    for z in [0.0, 1.0] {
        for i in 0..6 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 6.0).sin_cos();
            prism += &format!("v {cos} {sin} {z}\n");
        }
    }
    prism += "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n";
    for i in 1..=6 {
        let next = i % 6 + 1;
        prism += &format!("f {i} {next} {} {}\n", next + 6, i + 6);
    }
    let solid = load(&file("prism.obj", prism.as_bytes()))
        .unwrap()
        .solid(1e-3)
        .unwrap();
    let volume = solid.volume_integrals().volume;
    assert!(
        (volume / (1.5 * 3f64.sqrt()) - 1.0).abs() < 1e-6,
        "{volume}"
    );
}

/// A leaf of 80 × 50 mm in millimetres is not dropped as a plate of 80 × 50 m: the message names the size and
/// what to say.
#[test]
fn millimetres_are_not_taken_for_metres() {
    let text = "v 0 0 0\nv 80 0 0\nv 80 50 0\nv 0 50 0\nf 1 2 3 4\n";
    let path = file("leaf_in_mm.obj", text.as_bytes());
    let problem = load_scaled(&path, None).unwrap_err();
    for part in [
        "leaf_in_mm.obj: 80 × 50 × 0 m",
        "--scale 0.001",
        "--scale 1",
    ] {
        assert!(problem.contains(part), "{problem}");
    }
    let leaf = load_scaled(&path, Some(1e-3)).unwrap();
    assert!((leaf.extents() - Vec3::new(0.08, 0.05, 0.0)).norm() < 1e-9);
    let field = load_scaled(&path, Some(1.0)).unwrap();
    assert_eq!(field.extents().x, 80.0);
    let small = file(
        "leaf_in_m.obj",
        text.replace("80", ".08").replace("50", ".05").as_bytes(),
    );
    assert!((load_scaled(&small, None).unwrap().extents().x - 0.08).abs() < 1e-8);
}

/// A cube of which one face is wound the other way says so, and where.
#[test]
fn faces_wound_both_ways_are_named() {
    let text = CUBE_OBJ.replacen("f 5 6 7 8", "f 8 7 6 5", 1);
    let problem = load(&file("wound.obj", text.as_bytes()))
        .unwrap()
        .solid(1e-3)
        .unwrap_err();
    for part in [
        "not closed: 4 edges",
        "face opposite ways",
        "[2.0, 2.0, 2.0]",
    ] {
        assert!(problem.contains(part), "{problem}");
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
    for part in [
        "neither a solid (the mesh is not closed: 3 edges",
        "nor a sheet",
    ] {
        assert!(problem.contains(part), "{problem}");
    }
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
    let cases: [(&str, Vec<u8>, &str); 10] = [
        ("wide.obj", b"\xff\xfev\x000\x00".to_vec(), "UTF-16"),
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
