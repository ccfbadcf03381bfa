#version 460
#extension GL_GOOGLE_include_directive : require
// Projects a triangle along the dominant axis of its face normal, taken in cells (thesis, Section 4.1.1), and
// optionally dilates it by half a pixel (Hasselgren et al. 2005).
#include "params.glsl"
#include "voxel_raster.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

layout(location = 0) in vec3 in_position[];
layout(location = 1) in vec3 in_normal[];
layout(location = 2) in vec2 in_uv[];
layout(location = 3) flat in uint in_material[];

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;
layout(location = 3) flat out uint material;
layout(location = 4) flat out uint axis;
layout(location = 5) flat out vec3 corner[3]; // in cells

uint dominantAxis(Grid g) {
    vec3 face = cross(in_position[1] - in_position[0], in_position[2] - in_position[0]);
    vec3 middle = (in_position[0] + in_position[1] + in_position[2]) / 3.0;
    vec3 a = abs(face * cellAxes(g, middle));
    return a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u; // >=: triangles at 45 degrees belong somewhere
}

void emit(vec4 clip, vec3 b, uint flags, vec3 corners[3]) {
    position = mat3(in_position[0], in_position[1], in_position[2]) * b;
    normal = mat3(in_normal[0], in_normal[1], in_normal[2]) * b;
    uv = mat3x2(in_uv[0], in_uv[1], in_uv[2]) * b;
    material = in_material[0];
    axis = flags;
    corner = corners;
    gl_Position = clip;
    EmitVertex();
}

// Too thin to dilate: the bounding rectangle, half a pixel wider. The fragments are tested exactly.
void emitRectangle(Grid g, vec4 c[3], vec3 r[3], uint along, vec3 corners[3]) {
    ivec3 axes = planeAxes(along);
    float half_pixel = 0.505 / float(params.raster_size);
    vec3 lo = min(r[0], min(r[1], r[2])) - half_pixel, hi = max(r[0], max(r[1], r[2])) + half_pixel;
    vec3 middle = (r[0] + r[1] + r[2]) / 3.0;
    for (int i = 0; i < 4; i++) {
        vec3 at = clamp(middle, 0.0, 1.0);
        at[axes.x] = (i & 1) != 0 ? hi[axes.x] : lo[axes.x];
        at[axes.y] = (i & 2) != 0 ? hi[axes.y] : lo[axes.y];
        position = g.minimum + at * g.size;
        normal = (in_normal[0] + in_normal[1] + in_normal[2]) / 3.0;
        uv = (in_uv[0] + in_uv[1] + in_uv[2]) / 3.0;
        material = in_material[0];
        axis = along | SLIVER;
        corner = corners;
        gl_Position = project(at, along);
        EmitVertex();
    }
    EndPrimitive();
}

void main() {
    Grid g = volume.grids[rasterBlock()];
    float dim = float(params.voxel_dim);
    uint along = dominantAxis(g);
    vec4 clip[3];
    vec3 raster[3], corners[3];
    for (int i = 0; i < 3; i++) {
        raster[i] = toRasterSpace(g, in_position[i]);
        clip[i] = project(raster[i], along);
        corners[i] = worldToVolume(g, in_position[i]) * dim;
    }
    vec3 lo = min(corners[0], min(corners[1], corners[2])), hi = max(corners[0], max(corners[1], corners[2]));
    if (any(lessThan(hi, vec3(0.0))) || any(greaterThan(lo, vec3(dim)))) return;
    if (VOLUME_SCROLL && isKept(g, lo) && isKept(g, hi)) return;

    if (CONSERVATIVE != CONSERVATIVE_DILATE) {
        for (int i = 0; i < 3; i++) emit(clip[i], vec3(i == 0, i == 1, i == 2), along, corners);
        EndPrimitive();
        return;
    }

    // Edges as homogeneous lines, moved outwards by half a pixel's extent; their intersections are the new
    // corners, and barycentric coordinates put those back onto the triangle's plane.
    mat3 m = mat3(clip[0].xyw, clip[1].xyw, clip[2].xyw);
    float area = determinant(m);
    float half_pixel = 1.01 / float(params.raster_size);
    float longest = max(distance(m[0], m[1]), max(distance(m[1], m[2]), distance(m[2], m[0])));
    if (abs(area) < half_pixel * longest) {
        emitRectangle(g, clip, raster, along, corners);
        return;
    }
    vec3 line[3];
    for (int i = 0; i < 3; i++) {
        line[i] = cross(m[i], m[(i + 1) % 3]) * sign(area);
        line[i].z += half_pixel * (abs(line[i].x) + abs(line[i].y));
    }
    mat3 to_barycentric = inverse(m);
    for (int i = 0; i < 3; i++) {
        vec3 b = to_barycentric * cross(line[(i + 2) % 3], line[i]);
        b /= b.x + b.y + b.z;
        emit(mat3x4(clip[0], clip[1], clip[2]) * b, b, along, corners);
    }
    EndPrimitive();
}
