// Samples of cones and rays, as the probe records them.
#ifndef CONE_SAMPLE_GLSL
#define CONE_SAMPLE_GLSL

// Hook of the probe for each sample: (number, along, sample, alpha that it adds, transmittance behind it).
#ifndef CONE_SAMPLED
#define CONE_SAMPLED(number, along, x, a, transmittance)
#endif

struct ConeSample {
    vec3 position; // world
    float radius; // of the cone there [m]
    float level;
    float voxel; // length of a level-0 cell along the cone [m]
    float cell; // length of a cell of the level [m]
    float advance; // to the next sample [m]
    vec4 texel; // radiance premultiplied by opacity, and opacity
    bool outside; // no sample: the position is outside the volume
    bool last; // the position is outside, and the border cells are repeated: the cone ends here
};

#endif
