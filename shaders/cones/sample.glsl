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

#endif
