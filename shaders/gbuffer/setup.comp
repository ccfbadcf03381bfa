#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// Sets up the triangles in the camera's view.
#include "gbuffer/visibility.glsl"
#include "common/scene.glsl"

uvec2 targetTriangles() {
    return uvec2(0, sceneInfo.triangle_count);
}

#include "raster/setup.glsl"
