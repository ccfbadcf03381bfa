// The sky: one radiance, or that times a picture of all directions, equirectangular: its middle looks to -z, +x is to the right of it,
// +y is above.
#ifndef SKY_GLSL
#define SKY_GLSL
#include "common/math.glsl"
#include "common/scene.glsl"

uniform sampler2DArray skyTexture; // layer 0: without the sun that is among the lights; the last layer: with it

// Where the picture has direction d (unit length).
vec2 skyDirection(vec3 d) {
    float azimuth = d.xz == vec2(0.0) ? 0.0 : atan(d.x, -d.z); // not defined straight up and down
    return vec2(0.5 + azimuth / (2.0 * PI) + sceneInfo.sky_turn, acos(clamp(d.y, -1.0, 1.0)) / PI);
}

// The level whose lookup, a tent three texels in area, is as large as `spread` [sr].
float skyLevel(vec3 d, float spread) {
    vec2 size = vec2(textureSize(skyTexture, 0).xy);
    // Towards the poles texels are narrow; what is looked up is not narrower than itself.
    float narrow = max(sqrt(max(1.0 - d.y * d.y, 0.0)), 0.67 * sqrt(spread / PI));
    float texel = 2.0 * PI * PI / (size.x * size.y) * max(narrow, 1e-6);
    return max(0.5 * log2(max(spread / (3.0 * texel), 1.0)), 0.0);
}

vec3 skyLookup(vec3 d, float spread, int layer) {
    if (sceneInfo.sky_turn < 0.0) return sceneInfo.sky;
    float level = skyLevel(d, spread);
    vec2 place = skyDirection(d);
    // It goes round, but ends above and below. Not from textureSize: Mesa's software device takes one invocation's level for all.
    float margin = 0.5 / float(max(textureSize(skyTexture, 0).y >> int(ceil(level)), 1));
    place.y = clamp(place.y, margin, 1.0 - margin);
    return sceneInfo.sky * textureLod(skyTexture, vec3(place, float(layer)), level).rgb;
}

// Radiance from direction d, the mean over `spread` [sr]: what a ray or cone stands for. The sun is left out where it is among the
// lights.
vec3 skyRadiance(vec3 d, float spread) {
    return skyLookup(d, spread, 0);
}

// What lies behind everything, sun and all.
vec3 skyBehind(vec3 d) {
    return skyLookup(d, 0.0, 1);
}

// Solid angle of a cone by the tangent of half its aperture [sr].
float coneSolidAngle(float tan_half) {
    return 2.0 * PI * (1.0 - inversesqrt(1.0 + tan_half * tan_half));
}

#endif
