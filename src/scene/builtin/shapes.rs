//! Shapes for the built-in scenes. All faces are counter-clockwise seen from outside.

use glam::{Mat4, Vec2, Vec3};
use indexmap::IndexMap;

use crate::scene::{Mesh, Submesh, Vertex};

/// Faces of a cuboid that stands on something: all but the bottom.
pub(in crate::scene) const STANDING: [bool; 6] = [true, true, false, true, true, true];

/// Collects triangles by material; everything is placed by `transform`.
pub(in crate::scene) struct MeshBuilder {
    name: String,
    vertices: Vec<Vertex>,
    triangles: IndexMap<u32, Vec<u32>>,
    pub transform: Mat4,
}

impl MeshBuilder {
    pub fn new(name: &str) -> Self {
        MeshBuilder { name: name.into(), vertices: Vec::new(), triangles: IndexMap::new(), transform: Mat4::IDENTITY }
    }

    pub fn finish(self) -> Mesh {
        let mut mesh = Mesh { name: self.name, vertices: self.vertices, ..Mesh::default() };
        for (material, indices) in self.triangles {
            let first_index = mesh.indices.len() as u32;
            mesh.submeshes.push(Submesh { first_index, index_count: indices.len() as u32, material });
            mesh.indices.extend(indices);
        }
        mesh
    }

    pub fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        let position = self.transform.transform_point3(position);
        // Normals go by the inverse transpose, for placements that scale unevenly.
        let normal = self.transform.inverse().transpose().transform_vector3(normal);
        self.vertices.push(Vertex {
            position: position.to_array(),
            normal: normal.normalize_or(Vec3::Y).to_array(),
            tangent: [0.0; 4],
            uv: uv.to_array(),
        });
        self.vertices.len() as u32 - 1
    }

    pub fn triangle(&mut self, material: u32, corners: [u32; 3]) {
        self.triangles.entry(material).or_default().extend(corners);
    }

    /// Flat quad, corners counter-clockwise from its front, divided `n` by `n`; uv in metres over `tile`.
    pub fn quad(&mut self, material: u32, corners: [Vec3; 4], n: u32, tile: f32) {
        let [a, b, c, d] = corners;
        let normal = (c - a).cross(d - b).normalize_or(Vec3::Y);
        let size = Vec2::new(a.distance(b), a.distance(d)) / tile;
        self.grid(material, n, n, |u, v| {
            let position = a.lerp(b, u).lerp(d.lerp(c, u), v);
            (position, normal, Vec2::new(u, 1.0 - v) * size)
        });
    }

    /// Grid over u and v in 0..1 of given positions, normals and texture coordinates.
    /// The front is where u goes right and v goes up.
    pub fn grid(&mut self, material: u32, nu: u32, nv: u32, point: impl Fn(f32, f32) -> (Vec3, Vec3, Vec2)) {
        let first = self.vertices.len() as u32;
        for j in 0..=nv {
            for i in 0..=nu {
                let (position, normal, uv) = point(i as f32 / nu as f32, j as f32 / nv as f32);
                self.vertex(position, normal, uv);
            }
        }
        for j in 0..nv {
            for i in 0..nu {
                let a = first + j * (nu + 1) + i;
                let (b, c, d) = (a + 1, a + nu + 2, a + nu + 1);
                self.triangle(material, [a, b, c]);
                self.triangle(material, [a, c, d]);
            }
        }
    }

    /// Smooth parametric surface over u and v in 0..1; normals come from its derivatives.
    pub fn surface(&mut self, material: u32, nu: u32, nv: u32, uv_scale: Vec2, point: impl Fn(f32, f32) -> Vec3) {
        const STEP: f32 = 1e-3;
        let normal_at = |u: f32, v: f32| {
            let du = point(u + STEP, v) - point(u - STEP, v);
            let dv = point(u, v + STEP) - point(u, v - STEP);
            du.cross(dv)
        };
        self.grid(material, nu, nv, |u, v| {
            // At a pole the derivative vanishes; a point beside it has nearly the same normal.
            let inner = v.clamp(5e-3, 1.0 - 5e-3);
            let normal = normal_at(u, v);
            let normal = if normal.length_squared() > 1e-14 { normal } else { normal_at(u, inner) };
            (point(u, v), normal.normalize_or(Vec3::Y), Vec2::new(u, 1.0 - v) * uv_scale)
        });
    }

    /// Surface of revolution around y: `profile` holds (radius, height) from bottom to top, `nv` rows follow it.
    /// uv is in turns and in metres over `tile`.
    pub fn lathe(&mut self, material: u32, nu: u32, nv: u32, tile: f32, profile: &[Vec2]) {
        let spans = (profile.len() - 1) as f32;
        let length: f32 = profile.windows(2).map(|w| w[0].distance(w[1])).sum();
        let widest = profile.iter().map(|p| p.x).fold(0.0, f32::max);
        let turns = (std::f32::consts::TAU * widest / tile).round().max(1.0);
        self.surface(material, nu, nv, Vec2::new(turns, length / tile), |u, v| {
            let x = (v * spans).clamp(0.0, spans);
            let i = (x as usize).min(profile.len() - 2);
            let p = profile[i].lerp(profile[i + 1], x - i as f32);
            let angle = -u * std::f32::consts::TAU;
            Vec3::new(p.x * angle.cos(), p.y, p.x * angle.sin())
        });
    }

    /// Closed cylinder that stands on the origin around y: so many sides, and rows between its two flat ends. The seam's
    /// corners are the same to the bit.
    pub fn cylinder(&mut self, material: u32, radius: f32, height: f32, [sides, rows]: [u32; 2]) {
        let out = |u: f32| {
            let side = (u * sides as f32).round() as u32 % sides;
            let (s, c) = (side as f32 / sides as f32 * -std::f32::consts::TAU).sin_cos();
            Vec3::new(c, 0.0, s)
        };
        self.grid(material, sides, rows, |u, v| {
            (out(u) * radius + Vec3::Y * (v * height), out(u), Vec2::new(u, 1.0 - v))
        });
        for (y, normal) in [(0.0, Vec3::NEG_Y), (height, Vec3::Y)] {
            let middle = self.vertex(Vec3::Y * y, normal, Vec2::splat(0.5));
            for i in 0..sides {
                let [a, b] = [i, i + 1].map(|i| {
                    let out = out(i as f32 / sides as f32);
                    self.vertex(out * radius + Vec3::Y * y, normal, 0.5 + 0.5 * Vec2::new(out.x, out.z))
                });
                self.triangle(material, if y > 0.0 { [middle, a, b] } else { [middle, b, a] });
            }
        }
    }

    /// Ring around `axis`: a circle of radius `tube` swept along an ellipse spanned by `major` and `minor`.
    pub fn ring(&mut self, material: u32, centre: Vec3, major: Vec3, minor: Vec3, tube: f32, segments: [u32; 2]) {
        let axis = major.cross(minor).normalize_or(Vec3::Y);
        let turn = std::f32::consts::TAU;
        self.surface(material, segments[0], segments[1], Vec2::new(4.0, 1.0), |u, v| {
            let (s, c) = (u * turn).sin_cos();
            // The ellipse's own normal, so that thin links do not fold into themselves.
            let out = (major * (c / major.length_squared()) + minor * (s / minor.length_squared())).normalize();
            let (height, width) = (v * turn).sin_cos();
            centre + major * c + minor * s + out * (tube * width) + axis * (tube * height)
        });
    }

    /// Box with uv in metres over `tile`; `faces` says which of -x, +x, -y, +y, -z, +z to build.
    pub fn cuboid(&mut self, material: u32, low: Vec3, high: Vec3, tile: f32, faces: [bool; 6]) {
        let p = |x: u8, y: u8, z: u8| {
            let pick = |i: u8, l: f32, h: f32| if i == 0 { l } else { h };
            Vec3::new(pick(x, low.x, high.x), pick(y, low.y, high.y), pick(z, low.z, high.z))
        };
        let quads = [
            [p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)],
            [p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1)],
            [p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)],
            [p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0)],
            [p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0)],
            [p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)],
        ];
        for (quad, _) in quads.into_iter().zip(faces).filter(|(_, wanted)| *wanted) {
            self.quad(material, quad, 1, tile);
        }
    }

    /// The four upright faces of a box, seen from inside.
    pub fn cuboid_inside(&mut self, material: u32, low: Vec3, high: Vec3, tile: f32) {
        let ring = [(low.x, low.z), (high.x, low.z), (high.x, high.z), (low.x, high.z)];
        for i in 0..4 {
            let ((ax, az), (bx, bz)) = (ring[i], ring[(i + 1) % 4]);
            let corners = [(ax, low.y, az), (bx, low.y, bz), (bx, high.y, bz), (ax, high.y, az)]
                .map(|(x, y, z)| Vec3::new(x, y, z));
            self.quad(material, corners, 8, tile);
        }
    }

    /// Sphere as a subdivided icosahedron: 20 * 4^level triangles of nearly equal size.
    pub fn icosphere(&mut self, material: u32, centre: Vec3, radius: f32, level: u32) {
        for face in icosahedron() {
            self.sphere_face(material, centre, radius, face, level);
        }
    }

    fn sphere_face(&mut self, material: u32, centre: Vec3, radius: f32, face: [Vec3; 3], level: u32) {
        let [a, b, c] = face;
        if level == 0 {
            let corners = face.map(|n| self.vertex(centre + n * radius, n, sphere_uv(n)));
            return self.triangle(material, corners);
        }
        let (ab, bc, ca) = ((a + b).normalize(), (b + c).normalize(), (c + a).normalize());
        for face in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            self.sphere_face(material, centre, radius, face, level - 1);
        }
    }
}

fn sphere_uv(n: Vec3) -> Vec2 {
    let turn = std::f32::consts::TAU;
    Vec2::new(n.z.atan2(n.x) / turn + 0.5, n.y.clamp(-1.0, 1.0).acos() / (0.5 * turn))
}

fn icosahedron() -> Vec<[Vec3; 3]> {
    let g = (1.0 + 5.0f32.sqrt()) / 2.0;
    let p = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ]
    .map(|(x, y, z)| Vec3::new(x, y, z).normalize());
    const FACES: [[usize; 3]; 20] = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    FACES.iter().map(|face| face.map(|i| p[i])).collect()
}
