#version 460
#extension GL_GOOGLE_include_directive : require
// Radiance leaving each voxel: albedo / pi * E * max(0, n.l) * visibility, summed over all lights, plus
// emission; premultiplied by opacity. Runs over the voxel list, so each voxel is lit once.
#include "params.glsl"
#include "common/volume.glsl"
#include "common/voxels.glsl"
#include "common/shadow_views.glsl"
#include "common/scene.glsl"

layout(local_size_x = 128) in;

uniform sampler3D voxelColor;
uniform sampler3D voxelNormal;
uniform sampler2DArrayShadow shadowCompare;
uniform writeonly image3D injected;

const float PI = 3.14159265359;

// Fraction of the voxel that sees the light: four lookups across the cell, moved off the surface by half a
// cell's extent (the surface passes anywhere through the cell) and a little towards the light.
float voxelVisibility(Light light, vec3 center, mat3 axes, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
    float side = dot(n, to_light) < 0.0 ? -1.0 : 1.0; // the lit side of a thin sheet
    float cell = pow(abs(determinant(axes)), 1.0 / 3.0);
    float texel = shadowTexel(shadowViewOf(light, center), light, center);
    vec3 extent = abs(n * axes);
    vec3 base = center + n * side * (0.5 * (extent.x + extent.y + extent.z) + texel)
              + to_light * (n == vec3(0.0) ? cell : 0.25 * cell);
    float sum = 0.0;
    for (int i = 0; i < 4; i++) {
        vec3 tap = vec3((i & 1) != 0 ? 0.25 : -0.25, (i & 2) != 0 ? 0.25 : -0.25, i == 0 || i == 3 ? 0.25 : -0.25);
        vec3 offset = axes * tap;
        vec3 p = base + offset - n * dot(n, offset);
        int view = shadowViewOf(light, p);
        vec3 q = shadowPosition(view, p);
        sum += texture(shadowCompare, vec4(q.xy, view, q.z));
    }
    return 0.25 * sum;
}

void main() {
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= voxelCounter.count) return;
    ivec3 cell = cellOfSlot(slot);
    vec4 color = texelFetch(voxelColor, cell, 0);
    vec4 packed = texelFetch(voxelNormal, cell, 0);
    vec3 n = packed.rgb * 2.0 - 1.0;
    n = dot(n, n) > 0.25 ? normalize(n) : vec3(0.0);
    float agreement = packed.a;

    VolumeMap map = volume.maps[cascadeOf(cell)];
    vec3 center = volumeToWorld(map, cellCentre(cell));
    mat3 axes = cellAxes(map, center);
    vec3 irradiance = vec3(0.0);
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        Incident incident = incidentLight(light, center);
        // Normals that disagree lie on a curved or two-sided surface: what the mean does not explain is
        // taken as spread over all directions, whose mean cosine is 1/4.
        float cosine = max(dot(n, incident.to_light), 0.0) * agreement + 0.25 * (1.0 - agreement);
        if (cosine > 0.0 && incident.irradiance != vec3(0.0))
            irradiance += incident.irradiance * cosine * voxelVisibility(light, center, axes, n, incident.to_light);
    }
    imageStore(injected, cell, vec4((color.rgb / PI * irradiance + meanEmission(slot)) * color.a, color.a));
}
