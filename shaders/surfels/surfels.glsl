// Surfels as rays read them: a mean plane and a coverage mask for each side, in few words. Separate buffers
// hold the data of each side that changes with the light: outgoing radiance and gathered light.
#ifndef SURFELS_GLSL
#define SURFELS_GLSL
#include "voxels/voxels.glsl"
#include "surfels/coverage_mask.glsl"

layout(std430) buffer Surfels { uvec4 quads[]; } surfels;
layout(std430) buffer SideRadiance { uvec2 list[]; } sideRadiance;
layout(std430) buffer SideGathered { uvec2 list[]; } sideGathered;

// Words per surfel: one plane, two coverage mask words and one front layer word for each side. Stored in
// groups of four, because rays wait for every load.
const uint SURFEL_WORDS = 4 * SIDES;
const uint SURFEL_MASKS = SIDES; // first word that is merged directly instead of derived from sums

struct Plane {
    vec3 normal; // points towards side 0; scaled so that its axial component is 1
    float offset; // from the cell centre, along the axis [cells]
};

uint surfelBase(uint surfel) {
    return surfel * SURFEL_WORDS;
}

uint surfelData(uint word) {
    return surfels.quads[word >> 2][word & 3u];
}

void storeSurfelData(uint word, uint data) {
    surfels.quads[word >> 2][word & 3u] = data;
}

// Unit vector of an axis.
vec3 axisVector(uint axis) {
    return vec3(equal(uvec3(axis), uvec3(0, 1, 2)));
}

// Vector with the given axial and lateral coordinates.
vec3 axialVector(uint axis, float axial, vec2 lateral) {
    if (axis == 0) return vec3(axial, lateral);
    return axis == 1 ? vec3(lateral.y, axial, lateral.x) : vec3(lateral, axial);
}

uint planeWord(uint base, uint side) {
    return base + side;
}

// normal: its axial component is positive. present: bits 0 and 1 are set if side 0 and side 1 have surfaces.
// A side without surfaces mirrors the other.
void storePlane(uint word, vec3 normal, uint axis, float offset, uint present) {
    vec2 lateral = lateralOf(normal, axis);
    uvec2 s = uvec2(clamp(lateral / max(dot(normal, axisVector(axis)), 1e-6), -1.0, 1.0) * 511.0 + 512.5);
    storeSurfelData(word, s.x | s.y << 10 | storedOffset(offset) << 20 | present << 30);
}

Plane unpackPlane(uint w, uint axis) {
    vec2 lateral = (vec2(w & 0x3ffu, w >> 10 & 0x3ffu) - 512.0) / 511.0;
    return Plane(axialVector(axis, 1.0, lateral), offsetOfSum(float(w >> 20 & 0x3ffu), 1.0));
}

Plane planeOf(uint base, uint side, uint axis) {
    return unpackPlane(surfelData(planeWord(base, side)), axis);
}

uint coverageMaskWord(uint base, uint side) {
    return base + SURFEL_MASKS + 2 * side;
}

uint frontLayerWord(uint base, uint side) {
    return base + 3 * SIDES + side;
}

uvec2 coverageMaskOf(uint base, uint side) {
    uint word = coverageMaskWord(base, side);
    return uvec2(surfelData(word), surfelData(word + 1));
}

// Point on a side's plane at lateral coordinates, relative to the cell centre [cells].
vec3 onPlane(uint base, uint side, uint axis, vec2 lateral) {
    Plane plane = planeOf(base, side, axis);
    return axialVector(axis, plane.offset - dot(lateralOf(plane.normal, axis), lateral), lateral);
}

// Centroid of a side's surfaces, relative to the cell centre [cells].
vec3 planeMiddle(uint base, uint side, uint axis) {
    return onPlane(base, side, axis, middleOf(coverageMaskOf(base, side)));
}

// Index of a side in the light buffers.
uint sideIndex(uint surfel, uint side) {
    return surfel * SIDES + side;
}

// Packs light and a number: the updates of gathered light, or the emitted share of outgoing radiance.
uvec2 packLight(vec3 light, float number) {
    light = min(light, 65504.0);
    return uvec2(packHalf2x16(light.rg), packHalf2x16(vec2(light.b, number)));
}

vec3 lightOf(uvec2 packed) {
    return vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
}

float numberOf(uvec2 packed) {
    return unpackHalf2x16(packed.y).y;
}

#endif
