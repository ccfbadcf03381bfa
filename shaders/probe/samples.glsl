// Record of the cone probe: one row for every sample of every cone of one pixel. passes/parts/probe.ron names
// the columns.
#ifndef CONE_SAMPLES_GLSL
#define CONE_SAMPLES_GLSL

// Vertices per sample: the line to it and the twelve edges of its cell, six vertices each.
const uint SAMPLE_VERTICES = 78;

struct RecordedSample {
    uint cone; // 0: specular; then diffuse. A cone along the normal, if the set has one, is 1
    uint number; // index in its cone
    float along; // distance from the cone's start [m]
    float advance; // to the next sample [m]
    vec3 position; // world
    float level;
    vec3 radiance; // contribution to the cone
    float cell; // length of a cell of that level along the cone [m]
    float opacity; // of the texel
    float alpha; // opacity added to the cone
    float transmittance; // of the cone after it
    float radius; // of the cone at the sample [m]
};

layout(std430) buffer ConeSamples {
    uvec4 draw; // VkDrawIndirectCommand: SAMPLE_VERTICES, rows, 0, 0
    vec3 surface; // the point under the pointer
    uint claimed; // 1: a fragment has recorded
    vec3 origin; // start of its cones
    uint pad;
    RecordedSample list[];
} coneSamples;

#endif
