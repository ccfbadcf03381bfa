// How a side of a voxel gathers light.
#ifndef BOUNCE_GATHER_GLSL
#define BOUNCE_GATHER_GLSL
#include "common/sides.glsl"
#include "common/ggx.glsl"
#include "common/pattern.glsl"
#include "cones/light.glsl"

// Radiance and opacity along d: defined by the shader.
vec4 traceBounce(ConeOrigin o, vec3 d);

// One of 64 patterns, by the place in a block of 4x4x4 cells.
uint patternOf(uvec3 cell) {
    return ((cell.x & 3u | (cell.y & 3u) << 2 | (cell.z & 3u) << 4) * 37u) & 63u;
}

// What every `of`-th ray or cone gathers, from `first` on, of the mean of all.
vec3 gatherAt(vec3 p, vec3 n, uint pattern, int first, int of) {
    ConeOrigin o = coneOrigin(p, n, n);
    mat3 frame = frameOf(n);
    vec3 sum = vec3(0.0);
    for (int i = first; i < params.bounce_cones; i += of) {
        vec3 d = frame * cosineSample(evenPoint(uint(i) * 64u + pattern));
        sum += coneRadiance(traceBounce(o, d), d, PI / float(params.bounce_cones));
    }
    return sum / float(params.bounce_cones);
}

// Where the surfaces of a side of a slot are.
vec3 slotPosition(VolumeMap map, ivec3 cell, uint base, uint side, uint axis) {
    vec3 center = volumeToWorld(map, cellCentre(cell));
    return center + cellAxes(map, center) * planeMiddle(base, side, axis);
}

#endif
