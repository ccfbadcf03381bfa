#version 460
#extension GL_GOOGLE_include_directive : require
// Dilates triangles by half a pixel (Hasselgren et al. 2005) and projects them along their dominant axis.
// Every touched cell gets a fragment, which runs the exact overlap test.
#include "params.glsl"
#include "voxels/project.glsl"

// Bounding rectangle plus half a pixel, for triangles too thin to dilate.
void emitRectangle(VolumeMap map, Projected t) {
    ivec3 axes = planeAxes(t.along);
    float half_pixel = 0.505 / float(params.raster_size);
    vec3 lo = min(t.raster[0], min(t.raster[1], t.raster[2])) - half_pixel,
        hi = max(t.raster[0], max(t.raster[1], t.raster[2])) + half_pixel;
    vec3 middle = (t.raster[0] + t.raster[1] + t.raster[2]) / 3.0;
    for (int i = 0; i < 4; i++) {
        vec3 at = clamp(middle, 0.0, 1.0);
        at[axes.x] = (i & 1) != 0 ? hi[axes.x] : lo[axes.x];
        at[axes.y] = (i & 2) != 0 ? hi[axes.y] : lo[axes.y];
        position = map.minimum + at * map.size;
        normal = (in_normal[0] + in_normal[1] + in_normal[2]) / 3.0;
        uv = (in_uv[0] + in_uv[1] + in_uv[2]) / 3.0;
        color = (in_color[0] + in_color[1] + in_color[2]) / 3.0;
        nameTriangle();
        axis = t.along | SLIVER;
        corner = t.corners;
        gl_Position = project(at, t.along);
        EmitVertex();
    }
    EndPrimitive();
}

void main() {
    VolumeMap map = volume.maps[rasterCascade()];
    Projected t;
    if (!projectTriangle(map, t)) return;

    // Moves the edges, as homogeneous lines, outwards by half a pixel's extent. Their intersections are the
    // new corners. Barycentric coordinates put these back on the triangle's plane.
    mat3 m = mat3(t.clip[0].xyw, t.clip[1].xyw, t.clip[2].xyw);
    float area = determinant(m);
    float half_pixel = 1.01 / float(params.raster_size);
    float longest = max(distance(m[0], m[1]), max(distance(m[1], m[2]), distance(m[2], m[0])));
    if (abs(area) < half_pixel * longest) {
        emitRectangle(map, t);
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
        emit(mat3x4(t.clip[0], t.clip[1], t.clip[2]) * b, b, t.along, t.corners);
    }
    EndPrimitive();
}
