// The grid of probes, one in the middle of each of its cells, and their tiles in the atlases.
#ifndef DDGI_PROBES_GLSL
#define DDGI_PROBES_GLSL
#include "common/math.glsl"
#include "common/scene.glsl"

struct Probe {
    vec3 offset; // from its place on the grid [m]
    uint off; // 1: inside a wall, or next to no surface; it is not looked up
};

ivec3 probeGrid() {
    return ivec3(params.probes_x, params.probes_y, params.probes_z);
}

uint probeIndex(ivec3 at) {
    return uint(at.x + params.probes_x * (at.y + params.probes_y * at.z));
}

// Place on the grid [m].
vec3 gridPoint(uint probe) {
    ivec3 n = probeGrid(), at = ivec3(probe % n.x, probe / n.x % n.y, probe / (n.x * n.y));
    return sceneInfo.bounds_min + (vec3(at) + 0.5) * params.probe_spacing;
}

// Position in the grid, in probes.
vec3 inProbes(vec3 p) {
    return (p - sceneInfo.bounds_min) / params.probe_spacing - 0.5;
}

// First texel of a probe's tile, whose border is one texel wide; edge: texels without the border.
ivec2 tileOf(uint probe, int edge) {
    return ivec2(probe % params.probe_tiles, probe / params.probe_tiles) * (edge + 2);
}

// Direction of a texel of a tile. Those of the border continue the octahedral map beyond its edges.
vec3 directionOf(ivec2 texel, int edge) {
    vec2 p = (vec2(texel) - 0.5) / float(edge) * 2.0 - 1.0; // the border is -1 and beyond
    bvec2 beyond = greaterThan(abs(p), vec2(1.0));
    if (beyond.x) p = vec2(sign(p.x) * (2.0 - abs(p.x)), -p.y);
    if (beyond.y) p = vec2(-p.x, sign(p.y) * (2.0 - abs(p.y)));
    return fromOctahedral(p);
}

// Place of a direction in an atlas, 0 to 1.
vec2 placeInAtlas(uint probe, int edge, vec3 d) {
    vec2 texel = vec2(tileOf(probe, edge)) + 1.0 + (octahedral(d) * 0.5 + 0.5) * float(edge);
    return texel / float(params.probe_tiles * (edge + 2));
}

const int LIGHT_EDGE = 8, DEPTH_EDGE = 16;

// Distance from a surface to the point that looks up probes [m].
float lookupOffset() {
    return 0.75 * params.probe_spacing * params.probe_bias;
}

// Farther surfaces do not matter to the visibility of points between neighbouring probes [m].
float depthLimit() {
    return 1.5 * sqrt(3.0) * params.probe_spacing;
}

#endif
