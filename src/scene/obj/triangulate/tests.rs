use super::*;
use crate::scene::splitmix;

/// The same for the same number.
fn random(number: u64) -> u64 {
    let mut state = number;
    splitmix(&mut state)
}

fn polygon(points: &[(f32, f32)]) -> Vec<[f32; 3]> {
    points.iter().map(|(x, y)| [*x, *y, 0.0]).collect()
}

fn area_of(points: &[[f32; 3]], corners: &[u32]) -> f64 {
    let at = |k: usize| points[corners[k % corners.len()] as usize].map(f64::from);
    (0..corners.len())
        .map(|k| at(k)[0] * at(k + 1)[1] - at(k)[1] * at(k + 1)[0])
        .sum::<f64>()
        * 0.5
}

/// Triangulates a polygon and checks winding and area.
#[track_caller]
fn cut(points: &[[f32; 3]]) -> Cut {
    let mut triangles = Vec::new();
    let cut = triangulate(points, &mut triangles);
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let (area, areas) = (
        area_of(points, &all),
        triangles.iter().map(|t| area_of(points, t)),
    );
    assert!(
        areas.clone().all(|a| a > 0.0),
        "a triangle is turned, {cut:?}"
    );
    let sum: f64 = areas.sum();
    assert!(
        (sum - area).abs() <= 1e-9 * area.max(1.0),
        "{sum} instead of {area}, {cut:?}"
    );
    assert!(!cut.rough, "{cut:?}");
    cut
}

/// A comb with pointed teeth.
fn comb(teeth: usize) -> Vec<[f32; 3]> {
    let tooth = |i: usize| {
        [
            (2.0 * i as f32, 1000.0),
            (2.0 * i as f32 + 1.0, 1.0 + (i % 7) as f32),
        ]
    };
    let mut points: Vec<(f32, f32)> = (0..teeth)
        .rev()
        .flat_map(|i| [tooth(i)[1], tooth(i)[0]])
        .collect();
    points.extend([(0.0, 0.0), (2.0 * teeth as f32, 0.0)]);
    polygon(&points)
}

fn spiral(corners: usize) -> Vec<[f32; 3]> {
    let half = corners / 2;
    let arm = |i: usize, wide: f64| {
        let angle = 0.3 * i as f64;
        let radius = 1.0 + angle + wide;
        ((radius * angle.cos()) as f32, (radius * angle.sin()) as f32)
    };
    let points: Vec<(f32, f32)> = (0..half)
        .map(|i| arm(i, 2.0))
        .chain((0..half).rev().map(|i| arm(i, 0.0)))
        .collect();
    polygon(&points)
}

fn star(corners: usize, seed: u64) -> Vec<[f32; 3]> {
    let radius = |i: usize| {
        0.1 + (random(seed.wrapping_mul(1 << 32) + i as u64) >> 40) as f64 / f64::from(1 << 24)
    };
    let point = |i: usize| {
        let (radius, angle) = (radius(i), i as f64 / corners as f64 * std::f64::consts::TAU);
        ((radius * angle.cos()) as f32, (radius * angle.sin()) as f32)
    };
    polygon(&(0..corners).map(point).collect::<Vec<_>>())
}

#[test]
fn polygons_of_many_corners_take_few_tests() {
    for count in [100, 1000, 10_000, 100_000] {
        for (name, points) in [
            ("comb", comb(count / 2)),
            ("spiral", spiral(count)),
            ("star", star(count, 1)),
        ] {
            let Cut { tests, .. } = cut(&points);
            assert!(
                tests < 400 * points.len(),
                "{name} of {count}: {} a corner",
                tests / points.len()
            );
        }
    }
}

#[test]
fn hostile_polygons_end_within_their_tests() {
    let coordinate = |i: u64| (random(i) >> 48) as f32;
    for count in [1000u64, 100_000] {
        let noise: Vec<(f32, f32)> = (0..count)
            .map(|i| (coordinate(2 * i), coordinate(2 * i + 1)))
            .collect();
        let zigzag: Vec<(f32, f32)> = (0..count)
            .map(|i| ((i % 2 * 1000) as f32, (i % 97) as f32))
            .collect();
        let mut same = vec![(0.0, 0.0); count as usize];
        same.extend([(1.0, 0.0), (1.0, 1.0), (0.2, 0.3)]);
        for points in [noise, zigzag, same] {
            let mut triangles = Vec::new();
            let cut = triangulate(&polygon(&points), &mut triangles);
            assert!(!triangles.is_empty() && triangles.len() < points.len());
            assert!(
                cut.tests <= (TESTS + LARGE_TESTS + 100) * points.len() + 1_000_000,
                "{cut:?}"
            );
        }
    }
}

#[test]
fn random_polygons_are_covered_once() {
    for seed in 0..2000 {
        let points = star(4 + (random(seed) % 60) as usize, seed);
        cut(&points);
        let mut triangles = Vec::new();
        triangulate(&points, &mut triangles);
        assert_eq!(triangles.len(), points.len() - 2, "seed {seed}");
    }
}

#[test]
fn corners_on_edges_and_holes_behind_a_bridge_are_right() {
    // A square with midpoints on its sides: no triangle may be degenerate.
    cut(&polygon(&[
        (0., 0.),
        (1., 0.),
        (2., 0.),
        (2., 1.),
        (2., 2.),
        (1., 2.),
        (0., 2.),
        (0., 1.),
    ]));
    // Holes: one bridge, and two from the same corner.
    let hole = |x: f32| [(x, 1.), (x, 2.), (x + 1., 2.), (x + 1., 1.), (x, 1.)];
    let outer = [(0., 0.), (9., 0.), (9., 3.), (0., 3.)];
    let one: Vec<(f32, f32)> = [(0., 0.)]
        .into_iter()
        .chain(hole(1.))
        .chain(outer)
        .collect();
    cut(&polygon(&one));
    let two: Vec<(f32, f32)> = [(0., 0.)]
        .into_iter()
        .chain(hole(1.))
        .chain([(0., 0.)])
        .chain(hole(4.))
        .chain(outer)
        .collect();
    cut(&polygon(&two));
    // Duplicate corners and a returning edge.
    cut(&polygon(&[
        (0., 0.),
        (0., 0.),
        (2., 0.),
        (2., 1.),
        (1., 1.),
        (1., 1.),
        (1., 2.),
        (1., 1.),
        (0., 2.),
    ]));
    // Two squares that share a corner.
    cut(&polygon(&[
        (0., 0.),
        (1., 0.),
        (1., 1.),
        (2., 1.),
        (2., 2.),
        (1., 2.),
        (1., 1.),
        (0., 1.),
    ]));
}

#[test]
fn bent_polygons_are_cut_in_their_own_plane() {
    // The projected edges of these quads cross.
    for quad in [
        [
            [0.0, 0.0, 0.0],
            [0.83, -0.5, -0.46],
            [0.48, -0.5, 0.3],
            [1.0, 0.0, -0.07],
        ],
        [
            [0.0, 0.0, 0.0],
            [0.22, -0.16, 0.79],
            [0.01, 0.73, 0.82],
            [1.0, -0.17, 0.0],
        ],
        [
            [0.0, 0.0, 0.0],
            [0.38, -0.37, 0.33],
            [1.0, -0.18, -0.08],
            [1.0, -0.28, 0.83],
        ],
    ] {
        let mut planes = plane::project(&quad).unwrap();
        let exact = planes.next().unwrap();
        let mut first = Clipper::new(&exact);
        first.run(&mut Vec::new());
        let mut triangles = Vec::new();
        let cut = triangulate(&quad, &mut triangles);
        assert_eq!(
            (first.rough, cut.rough, triangles.len()),
            (true, false, 2),
            "{quad:?}"
        );
    }
    // A straight edge that rounding folds.
    let folded = [
        (0.0, 0.0),
        (1.0, 0.1),
        (0.999_999, 0.1),
        (2.0, 0.0),
        (2.0, -2.0),
        (0.0, -2.0),
    ];
    let mut triangles = Vec::new();
    let reversed: Vec<(f32, f32)> = folded.into_iter().rev().collect();
    assert!(!triangulate(&polygon(&reversed), &mut triangles).rough);
}

#[test]
fn crossed_polygons_are_cut_roughly() {
    for points in [
        vec![(0., 0.), (1., 1.), (1., 0.), (0., 1.)],
        vec![(0., 0.), (3., 1.), (3., 0.), (0., 2.)],
        vec![(0., 0.), (4., 4.), (4., 0.), (0., 3.), (2., 5.), (1., -1.)],
    ] {
        let mut triangles = Vec::new();
        let cut = triangulate(&polygon(&points), &mut triangles);
        assert!(cut.rough && !triangles.is_empty(), "{points:?} {cut:?}");
    }
    let flat = polygon(&[(0., 0.), (1., 1.), (2., 2.), (3., 3.)]);
    assert!(!triangulate(&flat, &mut Vec::new()).rough);
    triangulate(&[[f32::NAN; 3]; 5], &mut Vec::new());
    triangulate(
        &[
            [f32::MAX, f32::MIN, 0.0],
            [f32::MIN; 3],
            [f32::MAX; 3],
            [0.0; 3],
            [1.0; 3],
        ],
        &mut Vec::new(),
    );
}
