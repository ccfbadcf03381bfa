#version 460
#extension GL_GOOGLE_include_directive : require
// Tests the cells that a dilated triangle's fragment may touch, and stores a voxel in each that overlaps.
#include "params.glsl"
#include "voxels/tested.glsl"

void main() {
    int cascade = rasterCascade();
    float dim = float(params.voxel_dim);
    vec3 at = worldToVolume(volume.maps[cascade], position) * dim;
    int depth = int(axis & 3u);
    ivec3 axes = planeAxes(axis & 3u);
    bool whole = EVEN; // a pixel is exactly one column
    float pixels = footprintScale(at);
    vec4 uv_across = dFdx(uv), uv_down = dFdy(uv), color_across = dFdx(color), color_down = dFdy(color);
    vec3 normal_across = dFdx(normal), normal_down = dFdy(normal);
    Gradient g = Gradient(uv_across * pixels, uv_down * pixels);

    // A pixel that may span several cells evaluates the surface in each.
    bool each = !whole;
    Material m = materials.materials[material];
    vec4 base;
    vec3 reflected, n, light;
    if (!each) {
        Interpolants here = Interpolants(uv, color);
        base = baseColor(m, here, g);
        // Where coverage masks are exact, the merge cuts out holes instead.
        if (base.a < (EVEN ? min(m.alpha_cutoff, 0.01) : m.alpha_cutoff)) return;
        n = dot(normal, normal) > 0.0 ? normalize(normal) : vec3(0.0);
        reflected = reflectanceOf(m, base.rgb, here, g);
        light = emission(m, here, g);
    }

    vec3 lo = min(corner[0], min(corner[1], corner[2])),
        hi = max(corner[0], max(corner[1], corner[2]));
    vec3 inside = clamp(at, lo, hi);
    ivec3 from = ivec3(floor(inside)), to = from;
    vec3 c[3] = vec3[3](unwarped(corner[0]), unwarped(corner[1]), unwarped(corner[2]));
    // Attributes are extrapolated outside the triangle, and are noise for thin triangles. Columns therefore
    // come from the pixel, and depth from the triangle's plane over the pixel.
    vec3 face = cross(c[1] - c[0], c[2] - c[0]);
    vec2 slope = face[depth] != 0.0 ? -vec2(face[axes.x], face[axes.y]) / face[depth] :
        vec2(dim); // edge-on: any depth
    float pixel = 1.0 / float(params.raster_size);
    vec2 first = floor(gl_FragCoord.xy) * pixel;
    float middle = c[0][depth] + dot(slope, first + 0.5 * pixel - vec2(c[0][axes.x], c[0][axes.y]));
    float reach = 0.5 * pixel * (abs(slope.x) + abs(slope.y)) + 0.01 / dim;
    vec3 least = vec3(first, middle - reach), most = vec3(first + pixel, middle + reach);
    least.z = clamp(least.z, min(c[0][depth], min(c[1][depth], c[2][depth])),
        max(c[0][depth], max(c[1][depth], c[2][depth])));
    most.z = clamp(most.z, least.z, max(c[0][depth], max(c[1][depth], c[2][depth])));
    least = warp(clamp(least, 0.0, 1.0)) * dim;
    most = warp(clamp(most, 0.0, 1.0)) * dim;
    // A point exactly on a border belongs to both cells.
    from[depth] = int(floor(least.z - 1e-5));
    to[depth] = int(floor(most.z + 1e-5));
    from[axes.x] = whole ? int(gl_FragCoord.x) : int(floor(least.x));
    from[axes.y] = whole ? int(gl_FragCoord.y) : int(floor(least.y));
    to[axes.x] = whole ? from[axes.x] : int(floor(most.x));
    to[axes.y] = whole ? from[axes.y] : int(floor(most.y));
    if (!whole) { // small triangles touch few of the pixel's cells
        from = max(from, ivec3(floor(lo - 1e-3)));
        to = min(to, ivec3(floor(hi + 1e-3)));
    }
    if ((axis & SLIVER) != 0) {
        from[depth] = int(floor(lo[depth] - 1e-5));
        to[depth] = int(floor(hi[depth] + 1e-5));
    }
    from = max(from, ivec3(0));
    to = min(to, ivec3(params.voxel_dim - 1));
    vec3 low, high; // of a cell, before warping
    high.z = border(from.z);
    for (int z = from.z; z <= to.z; z++) {
        low.z = high.z;
        high.z = border(z + 1);
        high.y = border(from.y);
        for (int y = from.y; y <= to.y; y++) {
            low.y = high.y;
            high.y = border(y + 1);
            high.x = border(from.x);
            for (int x = from.x; x <= to.x; x++) {
                low.x = high.x;
                high.x = border(x + 1);
                if (!overlapsCell(ivec3(x, y, z), c, low, high)) continue;
                if (each) {
                    vec3 middle = 0.5 * (low + high);
                    vec2 shift = clamp(vec2(middle[axes.x], middle[axes.y]) * float(params.raster_size)
                        - gl_FragCoord.xy, -0.5, 0.5);
                    Interpolants there = Interpolants(uv + uv_across * shift.x + uv_down * shift.y,
                        color + color_across * shift.x + color_down * shift.y);
                    base = baseColor(m, there, g);
                    if (base.a < m.alpha_cutoff) continue;
                    reflected = reflectanceOf(m, base.rgb, there, g);
                    light = emission(m, there, g);
                    n = normal + normal_across * shift.x + normal_down * shift.y;
                    n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0);
                }
                storeVoxel(ivec3(x, y, z), cascade, reflected, n, light, pointNear(vec3(x, y, z) + 0.5, n),
                    EVEN ? triangle : NO_TRIANGLE);
            }
        }
    }
}
