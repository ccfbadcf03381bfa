#version 460
#extension GL_GOOGLE_include_directive : require
// Every pixel gathers in every frame.
#include "params.glsl"
#include "shade/gather.glsl"

uint firstNumber() {
    return 0;
}

Gathered gatherOrKeep(ivec2 pixel, GBufferSurface seen, ConeOrigin o, out float age) {
    age = 0.0;
    return gather(o, seen.surface, seen.face, seen.to_viewer);
}
