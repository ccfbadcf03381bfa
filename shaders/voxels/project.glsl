// Shared by the geometry shaders of the raster voxelizer: attributes, and the projection of a triangle along
// the dominant axis of its face normal in cells (thesis, Section 4.1.1).
#ifndef VOXELIZE_PROJECT_GLSL
#define VOXELIZE_PROJECT_GLSL
#include "voxels/raster.glsl"
#include "common/math.glsl"
#include "common/scene.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) in vec3 in_position[];
layout(location = 1) in vec3 in_normal[];
layout(location = 2) in vec4 in_uv[];
layout(location = 3) flat in uint in_material[];
layout(location = 4) flat in uint in_drawn[];
layout(location = 5) in vec4 in_color[];

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 uv;
layout(location = 3) flat out uint material;
layout(location = 4) flat out uint axis;
layout(location = 5) flat out uvec2 triangle; // draw, first index
layout(location = 6) flat out vec3 corner[3]; // in cells
layout(location = 9) out vec4 color;

uint triangleAxis(VolumeMap map) {
    vec3 face = cross(in_position[1] - in_position[0], in_position[2] - in_position[0]);
    vec3 middle = (in_position[0] + in_position[1] + in_position[2]) / 3.0;
    return dominantAxis(face * cellAxes(map, middle));
}

// Writes the attributes that identify the triangle.
void nameTriangle() {
    material = in_material[0];
    triangle = uvec2(in_drawn[0], draws.draws[in_drawn[0]].first_index + 3 * gl_PrimitiveIDIn);
}

void emit(vec4 clip, vec3 b, uint flags, vec3 corners[3]) {
    position = mat3(in_position[0], in_position[1], in_position[2]) * b;
    normal = mat3(in_normal[0], in_normal[1], in_normal[2]) * b;
    uv = mat3x4(in_uv[0], in_uv[1], in_uv[2]) * b;
    color = mat3x4(in_color[0], in_color[1], in_color[2]) * b;
    nameTriangle();
    axis = flags;
    corner = corners;
    gl_Position = clip;
    EmitVertex();
}

// A projected triangle.
struct Projected {
    uint along; // axis
    vec4 clip[3];
    vec3 raster[3]; // [0,1], before warping
    vec3 corners[3]; // in cells
};

// Projects a triangle. False if it is outside the volume or all its cells are reprojected.
bool projectTriangle(VolumeMap map, out Projected t) {
    float dim = float(params.voxel_dim);
    t.along = triangleAxis(map);
    for (int i = 0; i < 3; i++) {
        t.raster[i] = toRasterSpace(map, in_position[i]);
        t.clip[i] = project(t.raster[i], t.along);
        t.corners[i] = worldToVolume(map, in_position[i]) * dim;
    }
    vec3 lo = min(t.corners[0], min(t.corners[1], t.corners[2])),
        hi = max(t.corners[0], max(t.corners[1], t.corners[2]));
    if (any(lessThan(hi, vec3(0.0))) || any(greaterThan(lo, vec3(dim)))) return false;
    return !(isReprojected(map, lo) && isReprojected(map, hi));
}

#endif
