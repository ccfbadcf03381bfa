#version 460
#extension GL_GOOGLE_include_directive : require
// Sets up the triangles in the lights' views, for all layers at once: all, or those that move.
#include "shadow/target.glsl"
#include "common/scene.glsl"

uvec2 targetTriangles() {
    return uvec2(params.still_maps == 1 ? sceneInfo.still_triangles : 0, sceneInfo.triangle_count);
}

#include "raster/setup.glsl"
