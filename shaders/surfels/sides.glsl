// Mean surface properties of one side of a surfel.
#ifndef SIDES_GLSL
#define SIDES_GLSL
#include "volume/volume.glsl"
#include "surfels/surfels.glsl"
#include "modules/merge.glsl"

struct Side {
    vec3 color; // mean reflectance
    vec3 normal; // unit; 0: none
    float agreement; // of the normals, 1: all are the same
    vec3 emission; // radiance
    float count; // fragments
};

// Area of a side's surfaces for each area that rays meet of it, where the voxelizer measures both. More than one: a lamp before a
// ceiling, in one cell, hides it, and must not be dimmed by the mean of both. Less: the parts of a small lamp are larger than it.
float areaRatio(uint surfel, uint side) {
    bool measured = !WARPED && params.areas_measured != 0;
    uvec2 mask = coverageMaskOf(surfelBase(surfel), side);
    float covered = 16.0 * float(bitCount(mask.x) + bitCount(mask.y));
    return measured && covered > 0.0 ? float(surfelSums.words[sideBase(surfel, side) + 3]) / covered : 1.0;
}

// A side without surfaces of its own is the back of the other: a sheet reflects on both sides.
Side sideOfSurfel(uint surfel, uint side) {
    bool mirrored = SIDES > 1 && surfelSums.words[sideBase(surfel, side) + 3] == 0;
    if (mirrored) side = 1 - side;
    uint base = sideBase(surfel, side);
    Side s;
    vec3 mean;
    mergedMean(base, s.color, mean);
    s.agreement = min(length(mean), 1.0);
    s.normal = s.agreement > 1e-3 ? mean / s.agreement * (mirrored ? -1.0 : 1.0) : vec3(0.0);
    s.emission = meanEmission(base) * areaRatio(surfel, side);
    s.count = float(surfelSums.words[base + 3]);
    return s;
}

// Whether a side is of a lamp: three words where its emission would be many.
bool emits(uint surfel, uint side) {
    if (SIDES > 1 && surfelSums.words[sideBase(surfel, side) + 3] == 0) side = 1 - side;
    uint base = sideBase(surfel, side);
    return (surfelSums.words[base + 7] | surfelSums.words[base + 8] | surfelSums.words[base + 9]) != 0;
}

// Mean cosine between the surfaces' normals and the direction to something, none below 0. Where all normals lean towards it,
// that of their mean; normals that disagree are taken as spread over all directions, whose mean cosine is 1/4.
float meanCosine(Side s, vec3 to) {
    float cosine = dot(s.normal, to);
    return max(s.agreement * cosine, 0.25 * (1.0 - s.agreement) * clamp(1.0 + cosine, 0.0, 1.0));
}

#endif
