//! A comparison as a scene of cubes.

use super::compare::Comparison;
use super::grid::Grid;
use crate::scene::{Instance, Material, Mesh, Scene, Submesh, Vertex};
use glam::{DVec3, Mat4, Vec3, Vec4};

/// Maximum cells of a scene: their faces take less than 1 GB.
const MAX_CUBES: usize = 1_000_000;

/// The cells as cubes: correct ones grey, holes red, extras blue. Faces between cubes are omitted.
/// The cameras are those of `like`.
///
/// # Errors
/// More than a million cells.
pub fn cubes(grid: &Grid, found: &Comparison, like: &Scene) -> Result<Scene, String> {
    let groups = [
        ("right", Vec3::splat(0.45), &found.right),
        ("hole", Vec3::new(0.85, 0.02, 0.02), &found.holes),
        ("extra", Vec3::new(0.02, 0.08, 0.85), &found.extras),
    ];
    let total: usize = groups.iter().map(|g| g.2.len()).sum();
    if total > MAX_CUBES {
        return Err(format!(
            "{total} cells are too many to draw as cubes (at most {MAX_CUBES})"
        ));
    }
    let mut solid = vec![false; grid.count()];
    for number in groups.iter().flat_map(|g| g.2) {
        solid[*number as usize] = true;
    }
    let mut mesh = Mesh {
        name: "cells".into(),
        ..Mesh::default()
    };
    let mut materials = Vec::new();
    for (name, color, cells) in groups {
        let first_index = mesh.indices.len() as u32;
        for number in cells {
            add_cube(&mut mesh, grid, *number, &solid);
        }
        let index_count = mesh.indices.len() as u32 - first_index;
        if index_count > 0 {
            mesh.submeshes.push(Submesh {
                first_index,
                index_count,
                material: materials.len() as u32,
            });
            materials.push(Material {
                name: name.into(),
                base_color: Vec4::from((color, 1.0)),
                ..Material::default()
            });
        }
    }
    let instance = Instance {
        name: "cells".into(),
        mesh: 0,
        transform: Mat4::IDENTITY,
        mover: None,
    };
    Ok(Scene {
        name: format!("{}-voxels", like.name),
        meshes: vec![mesh],
        materials,
        instances: vec![instance],
        cameras: like.cameras.clone(),
        sky: Vec3::splat(0.02),
        ..Scene::default()
    })
}

fn add_cube(mesh: &mut Mesh, grid: &Grid, number: u32, solid: &[bool]) {
    let cell = grid.place(number);
    let (low, high) = grid.corners(cell);
    for axis in 0..3 {
        for (side, step) in [(0, -1), (1, 1)] {
            let beside = i64::from(cell[axis]) + step;
            let mut neighbour = cell;
            neighbour[axis] = beside.max(0) as u32;
            let inside = (0..i64::from(grid.size()[axis])).contains(&beside);
            if inside && solid[grid.number(neighbour) as usize] {
                continue;
            }
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |du: usize, dv: usize| {
                let mut at = DVec3::ZERO;
                at[axis] = if side == 1 { high[axis] } else { low[axis] };
                at[u] = if du == 1 { high[u] } else { low[u] };
                at[v] = if dv == 1 { high[v] } else { low[v] };
                at.as_vec3().to_array()
            };
            let mut normal = Vec3::ZERO;
            normal[axis] = step as f32;
            let mut tangent = [0.0, 0.0, 0.0, 1.0];
            tangent[u] = 1.0;
            let first = mesh.vertices.len() as u32;
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let vertex = |position| Vertex {
                position,
                normal: normal.to_array(),
                tangent,
                ..Vertex::default()
            };
            mesh.vertices.extend(corners.map(vertex));
            let order = if side == 1 {
                [0, 1, 2, 0, 2, 3]
            } else {
                [0, 2, 1, 0, 3, 2]
            };
            mesh.indices.extend(order.map(|i| first + i));
        }
    }
}
