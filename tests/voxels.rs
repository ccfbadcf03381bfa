//! Voxels against the exact cells: the oracle against what is known without it, then every voxelizer against the oracle.
//! Methods that miss cells are held to what was measured, so that neither loss nor gain goes unseen.

mod common;

use common::closed_meshes::{cube, placed, poses, torus};
use common::{assert_clean, conelab, experiment, fails, lab, prepare, root, scene, succeeds};
use conelab::lab::Session;
use conelab::measure::oracle::{
    Axes, Cell, Grid, Neighbours, Overlap, Score, Surfaces, clip, compare, exact, flood, read,
    triangles_of,
};
use conelab::scene::{Material, Mesh, Scene, Submesh, Vertex};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::sync::Arc;

const QUICK: (&str, &str) = ("shadow_dim", "512");

/// Edge and half edge of the cells that the oracle's own tests use.
const UNIT: (DVec3, DVec3) = (DVec3::splat(0.5), DVec3::splat(0.5));

fn even(low: f64, high: f64, cells: usize) -> Grid {
    let borders: Vec<f64> = (0..=cells)
        .map(|i| low + (high - low) * i as f64 / cells as f64)
        .collect();
    Grid::new([borders.clone(), borders.clone(), borders]).unwrap()
}

fn triangle(corners: [[f64; 3]; 3]) -> [DVec3; 3] {
    corners.map(DVec3::from_array)
}

#[test]
fn overlaps_that_are_known() {
    // Triangle; conservative; thin: against the cell from 0 to 1.
    use Overlap::{Borderline, Inside, Outside};
    let cases = [
        (
            "through the middle",
            [[-1.0, 0.5, -1.0], [3.0, 0.5, -1.0], [-1.0, 0.5, 3.0]],
            Inside,
            Inside,
        ),
        (
            "tiny, near a corner",
            [[0.1, 0.1, 0.1], [0.12, 0.1, 0.1], [0.1, 0.12, 0.1]],
            Inside,
            Outside,
        ),
        (
            "cuts a corner",
            [[0.2, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]],
            Inside,
            Outside,
        ),
        (
            "just past a corner",
            [[2.1, 1.0, 0.0], [1.0, 2.1, 0.0], [1.6, 1.6, 3.0]],
            Outside,
            Outside,
        ),
        (
            "lies in a face",
            [[-1.0, 1.0, -1.0], [3.0, 1.0, -1.0], [-1.0, 1.0, 3.0]],
            Borderline,
            Borderline,
        ),
        (
            "1e-4 below a face",
            [
                [-1.0, 0.9999, -1.0],
                [3.0, 0.9999, -1.0],
                [-1.0, 0.9999, 3.0],
            ],
            Inside,
            Inside,
        ),
        (
            "touches a corner",
            [[1.0, 1.0, 1.0], [2.0, 1.5, 1.5], [1.5, 2.0, 1.5]],
            Borderline,
            Outside,
        ),
        (
            "needle through",
            [[-5.0, 0.4, 0.4], [5.0, 0.6, 0.6], [5.0, 0.6, 0.600001]],
            Inside,
            Inside,
        ),
        (
            "line without area",
            [[-1.0, 0.5, 0.5], [0.5, 0.5, 0.5], [2.0, 0.5, 0.5]],
            Inside,
            Inside,
        ),
    ];
    for (what, corners, conservative, thin) in cases {
        let axes = Axes::new(triangle(corners));
        assert_eq!(axes.overlap(UNIT.0, UNIT.1), (conservative, thin), "{what}");
    }
}

fn any_triangle() -> impl Strategy<Value = [DVec3; 3]> {
    // Around a cell, and of every size from a hundredth of it to a hundred.
    let number = -1.0f64..1.0;
    let corner = move || {
        (number.clone(), -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    };
    (corner(), corner(), corner(), corner(), -2.0f64..2.0).prop_map(|(at, a, b, c, size)| {
        [a, b, c].map(|p| {
            DVec3::splat(0.5) + 1.2 * at + 10f64.powf(size) * (p - (a + b + c) / 3.0 * 0.9)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Separating axes and clipping are different ways to one answer.
    #[test]
    fn a_triangle_overlaps_a_cell_if_a_part_of_it_is_left_inside(t in any_triangle()) {
        let half = UNIT.1;
        let left = |grow: f64| !clip(t, UNIT.0 - half * (1.0 + grow), UNIT.0 + half * (1.0 + grow)).is_empty();
        match Axes::new(t).overlap(UNIT.0, half).0 {
            Overlap::Inside => prop_assert!(left(0.0)),
            Overlap::Outside => prop_assert!(!left(0.0)),
            Overlap::Borderline => prop_assert!(left(2.1e-5) && !left(-2.1e-5)),
        }
    }

    /// What goes through a segment between the middles of two faces must be in the thin set: else a path from face to
    /// face passes it by (Laine 2013, A Topological Approach to Voxelization).
    #[test]
    fn the_thin_set_has_every_crossing_of_a_cells_middle_lines(t in any_triangle()) {
        let (_, thin) = Axes::new(t).overlap(UNIT.0, UNIT.1);
        for axis in 0..3 {
            let mut across = DVec3::splat(1e-7);
            across[axis] = 0.4999;
            if !clip(t, UNIT.0 - across, UNIT.0 + across).is_empty() {
                prop_assert!(thin != Overlap::Outside, "axis {}", axis);
            }
        }
    }
}

#[test]
fn fills_tell_faces_from_corners() {
    let grid = even(0.0, 7.0, 7);
    let shell = |hole: Option<[u32; 3]>| -> Vec<bool> {
        let mut blocked = vec![false; grid.count()];
        for n in 0..grid.count() as u32 {
            let p = grid.place(n);
            blocked[n as usize] =
                p.iter().all(|i| (1..=5).contains(i)) && p.iter().any(|i| *i == 1 || *i == 5);
        }
        if let Some(hole) = hole {
            blocked[grid.number(hole) as usize] = false;
        }
        blocked
    };
    let inside = |blocked: &[bool], neighbours| {
        flood(&grid, blocked, neighbours)[grid.number([3, 3, 3]) as usize]
    };
    for (what, hole, six, twenty_six) in [
        ("closed", None, false, false),
        ("open in a face", Some([1, 3, 3]), true, true),
        ("open in an edge", Some([1, 1, 3]), false, true),
        ("open in a corner", Some([5, 5, 5]), false, true),
    ] {
        assert_eq!(
            inside(&shell(hole), Neighbours::Six),
            six,
            "{what}, through faces"
        );
        assert_eq!(
            inside(&shell(hole), Neighbours::TwentySix),
            twenty_six,
            "{what}, through corners"
        );
    }
}

fn cells_of(scene: &Scene, time: f64, grid: &Grid) -> Vec<Cell> {
    exact(&triangles_of(scene, time), &Surfaces::new(scene), grid)
}

#[test]
fn cells_hold_the_mean_of_what_is_in_them() {
    // A wall in the middle of a layer of cells, left half red and right half green, the border in the middle of cells.
    let vertex = |x: f32, y: f32| Vertex {
        position: [x, y, 0.5],
        normal: [0.0, 0.0, 1.0],
        ..Vertex::default()
    };
    let corners = [
        [-9.0, -9.0],
        [1.5, -9.0],
        [1.5, 9.0],
        [-9.0, 9.0],
        [9.0, -9.0],
        [9.0, 9.0],
    ];
    let mesh = Mesh {
        vertices: corners.map(|[x, y]| vertex(x, y)).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2],
        submeshes: vec![
            Submesh {
                first_index: 0,
                index_count: 6,
                material: 0,
            },
            Submesh {
                first_index: 6,
                index_count: 6,
                material: 1,
            },
        ],
        ..Mesh::default()
    };
    let paint = |color: [f32; 4]| Material {
        base_color: color.into(),
        ..Material::default()
    };
    let materials = vec![paint([0.8, 0.0, 0.2, 1.0]), paint([0.0, 0.6, 0.2, 1.0])];
    let wall = placed(mesh, materials, Vec::new());
    let grid = even(0.0, 4.0, 4);
    let cells = cells_of(&wall, 0.0, &grid);
    assert_eq!(cells.len(), 16, "one layer of 4 x 4 cells");
    for cell in cells {
        let [x, _, z] = grid.place(cell.number);
        let expected = [
            [0.8, 0.0, 0.2],
            [0.4, 0.3, 0.2],
            [0.0, 0.6, 0.2],
            [0.0, 0.6, 0.2],
        ][x as usize];
        assert_eq!(
            (z, cell.overlap, cell.thin),
            (0, Overlap::Inside, Overlap::Inside)
        );
        assert!(
            cell.color.abs_diff_eq(expected.into(), 1e-6),
            "column {x}: {}",
            cell.color
        );
        assert!(cell.normal.abs_diff_eq(Vec3::Z, 1e-6) && (cell.coverage - 1.0).abs() < 1e-6);
    }
}

/// Tiles a quarter of a cell above a floor, up to the middle of a column of cells: colours are of what can be seen.
#[test]
fn tiles_hide_the_floor_beneath_them() {
    let lab = lab(root());
    let (floor, tiles) = ([0.8, 0.0, 0.2], [0.0, 0.6, 0.2]);
    for (up, mode) in [1.0f32, -1.0]
        .into_iter()
        .flat_map(|up| [("conservative", "dilate"), ("voxelizer", "compute")].map(|m| (up, m)))
    {
        let sheet = |to: f32, height: f32| {
            [[-9.0, -9.0], [to, -9.0], [to, 9.0], [-9.0, 9.0]].map(|[x, z]| Vertex {
                position: [x, up * height, z],
                normal: [0.0, up, 0.0],
                ..Vertex::default()
            })
        };
        let part = |material: u32| Submesh {
            first_index: 6 * material,
            index_count: 6,
            material,
        };
        let mesh = Mesh {
            vertices: [sheet(9.0, 0.03), sheet(0.03125, 0.046)].concat(),
            indices: vec![0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7],
            submeshes: vec![part(0), part(1)],
            ..Mesh::default()
        };
        let paint = |[r, g, b]: [f32; 3]| Material {
            base_color: [r, g, b, 1.0].into(),
            ..Material::default()
        };
        let scene = Arc::new(placed(mesh, vec![paint(floor), paint(tiles)], Vec::new()));
        let settings = [
            ("voxel_dim", "32"),
            ("volume", "box"),
            ("volume_size", "(2, 2, 2)"),
            ("reflectance", "base"),
            QUICK,
            mode,
        ];
        let experiment = experiment("cornell", (16, 16), &settings);
        let wants = |g: &_| conelab::measure::oracle::wanted(g);
        let (mut session, _) = lab.prepare(&experiment, scene, wants).unwrap();
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        let (grid, voxels) = read(&mut session).unwrap();
        assert_eq!(voxels.len(), 32 * 32, "{mode:?}: one layer of cells");
        for voxel in voxels {
            let share = match grid.place(voxel.number)[0] {
                0..16 => 1.0,
                16 => 0.5,
                _ => 0.0,
            };
            let expected = Vec3::from(floor).lerp(tiles.into(), share);
            assert!(
                voxel.color.abs_diff_eq(expected, 0.02),
                "{mode:?}, side {up}, column {:?}: {} instead of {expected}",
                grid.place(voxel.number),
                voxel.color
            );
        }
    }
    assert_clean(&lab);
}

/// Sums over poses.
#[derive(Default)]
struct Sum {
    exact: u64,
    holes: u64,
    extras: u64,
    poses: u64,
    leaky_6: u64,
    leaky_26: u64,
}

impl Sum {
    fn add(&mut self, score: &Score) {
        self.exact += score.exact;
        self.holes += score.holes;
        self.extras += score.extras;
        self.poses += 1;
        self.leaky_6 += u64::from(score.leaked_6 > 0);
        self.leaky_26 += u64::from(score.leaked_26 > 0);
    }

    fn recall(&self) -> f64 {
        1.0 - self.holes as f64 / self.exact as f64
    }

    fn precision(&self) -> f64 {
        let found = self.exact - self.holes;
        found as f64 / (found + self.extras) as f64
    }
}

/// A way of making voxels and what it is known to do: least and largest recall, least precision, and how many of 102 poses
/// leak through faces and through corners, at least and at most.
struct Known {
    title: &'static str,
    set: &'static [(&'static str, &'static str)],
    recall: (f64, f64),
    precision: f64,
    leaky_6: (u64, u64),
    leaky_26: (u64, u64),
}

const POSES: usize = 34;

#[test]
fn closed_meshes_in_a_hundred_poses() {
    let lab = lab(root());
    let modes = [
        Known {
            title: "raster off",
            set: &[("voxelizer", "raster"), ("conservative", "off")],
            recall: (0.53, 0.57),
            precision: 1.0,
            leaky_6: (60, 102),
            leaky_26: (102, 102),
        },
        Known {
            title: "raster msaa",
            set: &[("voxelizer", "raster"), ("conservative", "msaa")],
            recall: (0.56, 0.61),
            precision: 0.999,
            leaky_6: (0, 0),
            leaky_26: (102, 102),
        },
        Known {
            title: "raster dilate",
            set: &[("voxelizer", "raster"), ("conservative", "dilate")],
            recall: (1.0, 1.0),
            precision: 1.0,
            leaky_6: (0, 0),
            leaky_26: (0, 0),
        },
        Known {
            title: "compute",
            set: &[("voxelizer", "compute")],
            recall: (1.0, 1.0),
            precision: 1.0,
            leaky_6: (0, 0),
            leaky_26: (0, 0),
        },
        Known {
            title: "tessellated",
            set: &[("voxelizer", "tessellated")],
            recall: (0.78, 0.82),
            precision: 1.0,
            leaky_6: (0, 0),
            leaky_26: (102, 102),
        },
        Known {
            title: "tessellated x2",
            set: &[("voxelizer", "tessellated"), ("tess_rate", "2.0")],
            recall: (0.88, 0.92),
            precision: 1.0,
            leaky_6: (0, 0),
            leaky_26: (102, 102),
        },
    ];
    let paint = vec![Material {
        base_color: [0.7, 0.4, 0.1, 1.0].into(),
        two_sided: true,
        ..Material::default()
    }];
    let meshes = [
        ("cube", cube(1, 0.0)),
        ("sphere", cube(8, 1.0)),
        ("torus", torus(24, 12)),
    ]
    .map(|(name, mesh)| (name, Arc::new(placed(mesh, paint.clone(), poses(POSES)))));
    let base = [
        ("voxel_dim", "32"),
        ("volume", "box"),
        ("volume_size", "(2, 2, 2)"),
        ("reflectance", "base"),
        QUICK,
    ];
    let mut wrong = Vec::new();
    let mut exact_cells: Vec<Vec<Vec<Cell>>> = Vec::new();
    for mode in &modes {
        let mut sum = Sum::default();
        for (b, (name, mesh)) in meshes.iter().enumerate() {
            let experiment = experiment("cornell", (16, 16), &[&base[..], mode.set].concat());
            let graph_wants = |g: &_| conelab::measure::oracle::wanted(g);
            let (mut session, _) = lab.prepare(&experiment, mesh.clone(), graph_wants).unwrap();
            for pose in 0..POSES {
                session.set_time(pose as f64);
                session.frame(0.0).unwrap();
                session.finish().unwrap();
                let (grid, voxels) = read(&mut session).unwrap();
                if exact_cells.len() == b {
                    exact_cells.push(
                        (0..POSES)
                            .map(|p| cells_of(mesh, p as f64, &grid))
                            .collect(),
                    );
                }
                let score = compare(&grid, &exact_cells[b][pose], &voxels).score;
                assert!(
                    score.enclosed > 500,
                    "{name}, pose {pose}: only {} cells are enclosed",
                    score.enclosed
                );
                assert!(
                    score.color_rms < 0.01,
                    "{name}, pose {pose}: one paint, colour error {}",
                    score.color_rms
                );
                sum.add(&score);
            }
        }
        println!(
            "{:<16} {} poses: recall {:.5}, precision {:.5}, {} leak through faces, {} through corners",
            mode.title,
            sum.poses,
            sum.recall(),
            sum.precision(),
            sum.leaky_6,
            sum.leaky_26
        );
        let known = (mode.recall.0..=mode.recall.1).contains(&sum.recall())
            && sum.precision() >= mode.precision
            && (mode.leaky_6.0..=mode.leaky_6.1).contains(&sum.leaky_6)
            && (mode.leaky_26.0..=mode.leaky_26.1).contains(&sum.leaky_26);
        if !known {
            wrong.push(mode.title);
        }
    }
    assert_clean(&lab);
    assert!(wrong.is_empty(), "not what was measured: {wrong:?}");
}

fn score_of(session: &mut Session, scene: &Scene) -> Score {
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_eq!(session.failed_checks().unwrap(), Vec::<String>::new());
    let (grid, voxels) = read(session).unwrap();
    compare(&grid, &cells_of(scene, 0.0, &grid), &voxels).score
}

const VOXELS: [&str; 4] = ["voxelIndex", "voxelColor", "voxelNormal", "voxelBorders"];

#[test]
fn uneven_cells_are_compared_too() {
    let lab = lab(root());
    // Least recall and precision.
    let modes = [
        ("msaa", "raster", ("conservative", "msaa"), 0.95, 0.999),
        ("dilate", "raster", ("conservative", "dilate"), 1.0, 1.0),
        ("compute", "compute", QUICK, 1.0, 1.0),
        ("tessellated", "tessellated", QUICK, 0.97, 0.999),
    ];
    for (warp, (title, voxelizer, mode, least, right)) in ["spline", "logistic"]
        .into_iter()
        .flat_map(|w| modes.map(|m| (w, m)))
    {
        let settings = [
            ("voxel_dim", "32"),
            ("warp", warp),
            ("voxelizer", voxelizer),
            mode,
            QUICK,
        ];
        let mut session = prepare(&lab, &experiment("cornell", (16, 16), &settings), &VOXELS);
        let score = score_of(&mut session, &scene("cornell"));
        let (recall, precision) = (score.recall.unwrap(), score.precision.unwrap());
        println!("{warp}, {title}: recall {recall:.4}, precision {precision:.4}");
        assert!(recall >= least && precision >= right, "{warp}, {title}");
    }
    assert_clean(&lab);
}

/// The oracle samples masks at four places of each piece in a cell, the method at 64 of the cell: some parts of leaves only one of them sees.
#[test]
fn leaves_fill_the_cells_that_their_masks_leave() {
    let lab = lab(root());
    for mode in [("voxelizer", "compute"), ("voxelizer", "raster")] {
        let mut session = prepare(
            &lab,
            &experiment("foliage", (16, 16), &[("voxel_dim", "64"), mode, QUICK]),
            &VOXELS,
        );
        let score = score_of(&mut session, &scene("foliage"));
        let (recall, precision) = (score.recall.unwrap(), score.precision.unwrap());
        println!("{}: recall {recall:.4}, precision {precision:.4}", mode.1);
        assert!(
            recall >= 0.999 && precision >= 0.97,
            "{}: recall {recall}, precision {precision}",
            mode.1
        );
    }
    assert_clean(&lab);
}

#[test]
fn the_command_tells_every_mode() {
    let folder = tempfile::tempdir().unwrap();
    let (json, cubes) = (
        folder.path().join("voxels.json"),
        folder.path().join("cubes"),
    );
    let mut command = conelab(root());
    command.args([
        "voxels",
        "configs/rays.ron",
        "--scene",
        "triangles",
        "--set",
        "voxel_dim=32",
        "--size",
        "64x48",
    ]);
    command
        .args(["--all", "--json"])
        .arg(&json)
        .arg("-o")
        .arg(&cubes);
    let out = succeeds(&mut command);
    println!("{out}");
    let report: serde_json::Value = serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
    let modes = report["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 7);
    let titled = |title: &str| modes.iter().find(|m| m["title"] == title).unwrap();
    for exact in ["raster dilate", "compute"] {
        assert_eq!(titled(exact)["score"]["holes"], 0);
        assert_eq!(titled(exact)["score"]["extras"], 0);
    }
    assert!(
        titled("raster off")["score"]["shapes"]["needle"]["recall"]
            .as_f64()
            .unwrap()
            < 0.2
    );
    let hardware = titled("raster hardware");
    assert!(
        hardware["score"].is_object()
            || hardware["skipped"]
                .as_str()
                .unwrap()
                .contains("conservative"),
        "{hardware}"
    );
    let red = |name: &str| {
        let image = image::open(cubes.join(name)).unwrap().to_rgb8();
        image
            .pixels()
            .filter(|p| p[0] > 60 && p[1] < p[0] / 3)
            .count()
    };
    assert!(
        red("raster-off.png") > 20 && red("raster-dilate.png") == 0,
        "holes are red, and only holes"
    );
    Scene::open(cubes.join("raster-off.glb").to_str().unwrap(), &|_, _| {
        std::ops::ControlFlow::Continue(())
    })
    .unwrap();
}

#[test]
fn what_cannot_be_compared_is_told() {
    let run = |experiment: &str, args: &[&str]| {
        let mut command = conelab(root());
        fails(
            command
                .args([
                    "voxels", experiment, "--scene", "cornell", "--size", "16x16",
                ])
                .args(args),
        )
    };
    let folder = tempfile::tempdir().unwrap();
    let warps = folder.path().join("warps.ron");
    std::fs::write(
        &warps,
        "(graph: \"warps.ron\", scene: \"cornell\", params: { \"warp\": \"perspective\" })",
    )
    .unwrap();
    let frusta = run(
        warps.to_str().unwrap(),
        &["--set", "voxel_dim=32", "--set", "fallback=false"],
    );
    assert!(
        frusta.contains("the cells are curved, no boxes"),
        "{frusta}"
    );
    let nothing = run("configs/rays.ron", &["--set", "voxelizer=points"]);
    assert!(
        nothing.contains("raster") && nothing.contains("points"),
        "{nothing}"
    );
}
