// Outgoing radiance of each voxel side: albedo / pi * E * mean cosine (meanCosine in surfels/sides.glsl) *
// visibility, summed over all lights, plus albedo times the gathered mean radiance, plus emission. Runs over
// the list of surfels, so each surface is lit once.
#include "params.glsl"
#include "common/math.glsl"
#include "volume/volume.glsl"
#include "surfels/sides.glsl"
#include "surfels/surfels.glsl"
#include "shadow/layers.glsl"
#include "common/scene.glsl"
#include "lights/emitters.glsl"
#include "lights/polygon.glsl"
#include "modules/shadow_lookup.glsl"

layout(local_size_x = 128) in;

// Sample points on a side's surfaces in each covered quarter, relative to the cell centre [cells]: on the
// mean plane and on the front layer. If a cell has two layers, the front layer is lit and shadows the mean
// plane.
struct Taps {
    vec3 middle;
    vec3 places[4];
    float lift[4]; // of the front layer over the mean plane, along the axis [cells]
    float share[4]; // covered by the front layer
    vec3 outwards;
    int count;
};

Taps tapsOf(uint surfel, uint side, uint base, uint axis) {
    uvec2 mask = coverageMaskOf(base, side);
    uint front_layers = surfelData(frontLayerWord(base, side));
    float mean = planeOf(base, side, axis).offset;
    Taps taps;
    taps.count = 0;
    taps.middle = planeMiddle(base, side, axis);
    taps.outwards = (side == 0 ? 1.0 : -1.0) * axisVector(axis);
    for (uint i = 0; i < 4; i++) {
        uvec2 quarter = quarterOf(mask, i);
        if (quarter == uvec2(0)) continue;
        FrontLayer o = frontLayerOf(front_layers, side, i);
        int k = taps.count++;
        taps.places[k] = onPlane(base, side, axis, middleOf(quarter));
        taps.lift[k] = side == 0 ? o.offset - mean : mean - o.offset;
        taps.share[k] = taps.lift[k] > LAYER ? o.covers : 0.0;
    }
    if (taps.count == 0) {
        taps.share[0] = 0.0;
        taps.places[taps.count++] = taps.middle;
    }
    return taps;
}

float lookUp(Light light, vec3 p) {
    int layer = shadowLayerOf(light, p);
    return shadowBlended(layer, shadowPosition(layer, p));
}

// Fraction of the surface around `center` that the light reaches. Lookups are biased off the surface.
float voxelVisibility(Light light, vec3 center, Taps taps, mat3 axes, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
    float cell = pow(abs(determinant(axes)), 1.0 / 3.0);
    float texel = shadowTexel(shadowLayerOf(light, center), light, center);
    vec3 extent = abs(n * axes);
    vec3 base = center + n * (params.light_bias * (extent.x + extent.y + extent.z) + texel)
              + to_light * (n == vec3(0.0) ? cell : 0.5 * params.light_bias * cell);
    float sum = 0.0;
    for (int i = 0; i < taps.count; i++) {
        float share = taps.share[i];
        if (share < 1.0) sum += (1.0 - share) * lookUp(light, base + axes * taps.places[i]);
        if (share > 0.0)
            sum += share * lookUp(light, base + axes * (taps.places[i] + taps.lift[i] * taps.outwards));
    }
    return sum / float(taps.count);
}

vec3 radianceOf(Side s, vec3 gathered, vec3 center, Taps taps, mat3 axes) {
    vec3 irradiance = vec3(0.0), middle = center + axes * taps.middle;
    for (uint i = 0; i < sceneInfo.light_count; i++) {
        Light light = lights.lights[i];
        Incident incident = arrivingLight(light, middle, s.normal);
        float cosine = meanCosine(s, incident.to_light);
        if (cosine > 0.0 && incident.irradiance != vec3(0.0))
            irradiance += incident.irradiance * cosine
                * voxelVisibility(light, center, taps, axes, s.normal, incident.to_light);
    }
    return s.color * (irradiance / PI + gathered) + s.emission;
}

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < voxelCounter.count * SIDES;
            i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        uint surfel = i / SIDES, side = i % SIDES;
        if (axisOfSurfel(surfel) < 0) continue;
        ivec3 cell = cellOfSurfel(surfel);
        VolumeMap map = volume.maps[cascadeOf(cell)];
        vec3 center = volumeToWorld(map, cellCentre(cell));
        mat3 axes = cellAxes(map, center);
        uint axis = uint(axisOfSurfel(surfel)), base = surfelBase(surfel);
        vec3 gathered = lightOf(sideGathered.list[i]);
        Side s = sideOfSurfel(surfel, side);
        vec3 radiance = radianceOf(s, gathered, center, tapsOf(surfel, side, base, axis), axes);
        float emitted = emitters.count > 0 ? luminance(s.emission) / max(luminance(radiance), 1e-20) : 0.0;
        sideRadiance.list[i] = packLight(radiance, emitted);
    }
}
