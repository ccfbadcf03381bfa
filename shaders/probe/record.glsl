// Records every sample of the traced cones.
#ifndef CONE_RECORD_GLSL
#define CONE_RECORD_GLSL
#include "probe/samples.glsl"

uint cone = 0;
uint rows = 0;

#define CONE_BEGINS(number) cone = number
#define CONE_SAMPLED(number, along, x, a, transmittance) recordSample(number, along, x, a, transmittance)

#include "cones/sample.glsl"

void recordSample(int number, float along, ConeSample x, float a, float transmittance) {
    if (rows >= coneSamples.list.length()) return;
    vec3 radiance = a > 0.0 ? x.texel.rgb * (a / x.texel.a) : vec3(0.0);
    coneSamples.list[rows] = RecordedSample(cone, uint(number), along, x.advance, x.position, x.level,
        radiance, x.cell, x.texel.a, a, transmittance, x.radius);
    rows++;
}

#include "modules/trace.glsl"

vec2 pixelCentre() {
    return floor(params.probe) + 0.5;
}

void recordCones(Surface s, vec3 p, vec3 face, vec3 v) {
    ConeOrigin o = coneOrigin(p, face, s.normal);
    gather(o, s, face, v);
    coneSamples.surface = p;
    coneSamples.origin = o.position;
    coneSamples.draw = uvec4(SAMPLE_VERTICES, rows, 0, 0);
}

#endif
