// What the cone probe records: every sample of every cone of one pixel, a row each. passes/parts/probe.ron names the
// columns.
#ifndef CONE_SAMPLES_GLSL
#define CONE_SAMPLES_GLSL

// A sample is drawn as the line that led to it and the twelve edges of its cell, six vertices each.
const uint SAMPLE_VERTICES = 78;

struct RecordedSample {
    uint cone; // 0 specular, then the diffuse ones; of a set that has one on the normal, it is 1
    uint number; // in its cone, from 0
    float along; // distance from the cone's start [m]
    float advance; // to the next sample [m]
    vec3 position; // world
    float level;
    vec3 radiance; // that it adds to its cone
    float cell; // length of a cell of that level along the cone [m]
    float opacity; // of the texel
    float alpha; // opacity that it adds to its cone
    float transmittance; // of the cone after it
    float radius; // of the cone there [m]
};

layout(std430) buffer ConeSamples {
    uvec4 draw; // VkDrawIndirectCommand: SAMPLE_VERTICES, rows, 0, 0
    vec3 surface; // the point under the pointer
    uint claimed; // 1: a fragment has recorded
    vec3 origin; // where its cones start
    uint pad;
    RecordedSample list[];
} coneSamples;

#endif
