// A sample of a cone, and the level that it reads.
#ifndef CONE_SAMPLE_GLSL
#define CONE_SAMPLE_GLSL

// What the probe does with each sample: (number, along, sample, alpha that it adds, transmittance behind it).
#ifndef CONE_SAMPLED
#define CONE_SAMPLED(number, along, x, a, transmittance)
#endif

struct ConeSample {
    vec3 position; // world
    float radius; // of the cone there [m]
    float level;
    float voxel; // length of a level-0 cell along the cone [m]
    float cell; // of a cell of the level [m]
    float advance; // to the next sample [m]
    vec4 texel; // radiance premultiplied by opacity, and opacity
    bool outside; // of the volume: there is no sample
    bool last; // the next one would be
};

// The level whose cells are as wide as the cone.
float coneLevel(float voxel, float radius) {
    return log2(max(2.0 * radius / voxel, 1.0)) + params.lod_offset;
}

// The same, not so coarse that it reads the surface which the cone leaves. `height` above its plane, `reach` of a cell across
// it [m]. A trilinear lookup reads 1.5 cells to each side. Coarser levels than fit above the surface would read the surface
// itself, and an open plane would shadow itself. Whole levels, because a fraction would blend in the coarser one.
float clearLevel(float level, float height, float reach, float last) {
    if (params.lod_clearance) level = min(level, floor(log2(max(height / (3.0 * reach), 1.0)) + 1e-3));
    return clamp(level, 0.0, last);
}

#endif
