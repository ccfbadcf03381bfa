// Mean surface properties of one side of a surfel.
#ifndef SIDES_GLSL
#define SIDES_GLSL
#include "volume/volume.glsl"
#include "surfels/surfels.glsl"
#include "modules/merge.glsl"

struct Side {
    vec3 color; // mean reflectance
    vec3 normal; // unit length, or 0 if undefined
    float agreement; // length of the mean normal; 1 if all normals agree
    vec3 emission; // radiance
    float count; // sum of the fragments' area weights
};

// Ratio of surface area to the area that the coverage mask covers, if the voxelizer measures areas. Above 1:
// layers overlap, for example a lamp in front of a ceiling, and the mean would dim the lamp. Below 1: the
// mask is larger than a small lamp.
float areaRatio(uint surfel, uint side) {
    bool measured = !WARPED && params.areas_measured != 0;
    uvec2 mask = coverageMaskOf(surfelBase(surfel), side);
    float covered = 16.0 * float(coveredTexels(mask));
    return measured && covered > 0.0 ? float(surfelSums.words[sideBase(surfel, side) + 3]) / covered : 1.0;
}

// Mean properties of a side. A side without surfaces mirrors the other: a sheet reflects on both sides.
Side sideOfSurfel(uint surfel, uint side) {
    bool mirrored = SIDES > 1 && surfelSums.words[sideBase(surfel, side) + 3] == 0;
    if (mirrored) side = 1 - side;
    uint base = sideBase(surfel, side);
    Side s;
    vec3 mean;
    mergedMean(base, s.color, mean);
    s.agreement = min(length(mean), 1.0);
    s.normal = s.agreement > 1e-3 ?
        mean / s.agreement * (mirrored ? -1.0 : 1.0) : vec3(0.0);
    s.emission = meanEmission(base) * areaRatio(surfel, side);
    s.count = float(surfelSums.words[base + 3]);
    return s;
}

// Whether a side emits. Reads three words instead of a whole Side.
bool emits(uint surfel, uint side) {
    if (SIDES > 1 && surfelSums.words[sideBase(surfel, side) + 3] == 0) side = 1 - side;
    uint base = sideBase(surfel, side);
    return (surfelSums.words[base + 7] | surfelSums.words[base + 8] | surfelSums.words[base + 9]) != 0;
}

// Mean clamped cosine between the surface normals and a direction. Agreeing normals use their mean.
// Disagreeing normals count as uniformly distributed, with a mean clamped cosine of 1/4.
float meanCosine(Side s, vec3 to) {
    float cosine = dot(s.normal, to);
    return max(s.agreement * cosine, 0.25 * (1.0 - s.agreement) * clamp(1.0 + cosine, 0.0, 1.0));
}

#endif
