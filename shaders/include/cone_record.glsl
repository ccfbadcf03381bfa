// Every sample of the cones that are traced, written down.
#ifndef CONE_RECORD_GLSL
#define CONE_RECORD_GLSL
#define SAMPLES_ACCESS
#define CONE_RECORD
#include "cone_samples.glsl"

uint cone = 0;
uint rows = 0;

void recordCone(uint number) {
    cone = number;
}

void recordSample(int number, vec3 p, float along, float advance, float radius, float level, float cell, vec4 texel, float taken, float transmittance) {
    if (rows >= coneSamples.list.length()) return;
    vec3 radiance = taken > 0.0 ? texel.rgb * (taken / texel.a) : vec3(0.0);
    coneSamples.list[rows] = ConeSample(cone, uint(number), along, advance, p, level, radiance, cell, texel.a, taken, transmittance, radius);
    rows++;
}

#include "gather.glsl"

vec2 pixelCentre() {
    return params.probe + 0.5;
}

void recordCones(Surface s, vec3 p, vec3 face, vec3 v) {
    ConeOrigin o = coneOrigin(p, face, s.normal);
    gather(o, s, face, v);
    coneSamples.surface = p;
    coneSamples.origin = o.position;
    coneSamples.draw = uvec4(SAMPLE_VERTICES, rows, 0, 0);
}

#endif
