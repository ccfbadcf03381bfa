#version 460
#extension GL_GOOGLE_include_directive : require
// Sets up the triangles that never move in the lights' views, for all layers at once.
#include "shadow/target.glsl"
#include "common/scene.glsl"

uvec2 targetTriangles() {
    return uvec2(0, sceneInfo.still_triangles);
}

#include "raster/setup.glsl"
