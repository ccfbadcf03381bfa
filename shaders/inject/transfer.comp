#version 460
#extension GL_GOOGLE_include_directive : require
// Copies opacity and emission into the radiance texture (thesis, Section 4.3), before the lit voxels are
// written.
#include "params.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "inject/exposure.glsl"

layout(local_size_x = 128) in;

uniform sampler3D voxelColor;
uniform writeonly image3D injected;

void main() {
    uint surfel = gl_GlobalInvocationID.x;
    if (surfel >= voxelCounter.count || axisOfSurfel(surfel) < 0) return;
    ivec3 cell = cellOfSurfel(surfel);
    float opacity = texelFetch(voxelColor, cell, 0).a;
    vec3 emission = meanEmission(sideBase(surfel, 0)) / injectionExposure();
    imageStore(injected, cell, vec4(emission * opacity, opacity));
}
