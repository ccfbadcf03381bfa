// Sky: a constant radiance, or a factor of an equirectangular image. The image's centre faces -z, with +x to
// its right and +y above.
#ifndef SKY_GLSL
#define SKY_GLSL
#include "common/math.glsl"
#include "common/scene.glsl"

uniform sampler2DArray skyTexture; // layer 0 excludes the sun if it is a light; the last layer includes it

// Image coordinates of direction d (unit length).
vec2 skyDirection(vec3 d) {
    float azimuth = d.xz == vec2(0.0) ? 0.0 : atan(d.x, -d.z); // undefined straight up and down
    return vec2(0.5 + azimuth / (2.0 * PI) + sceneInfo.sky_turn, acos(clamp(d.y, -1.0, 1.0)) / PI);
}

// The level with a lookup (a tent three texels in area) that covers `spread` [sr].
float skyLevel(vec3 d, float spread) {
    vec2 size = vec2(textureSize(skyTexture, 0).xy);
    // Texels narrow towards the poles, but the looked-up region does not become narrower than itself.
    float narrow = max(sqrt(max(1.0 - d.y * d.y, 0.0)), 0.67 * sqrt(spread / PI));
    float texel = 2.0 * PI * PI / (size.x * size.y) * max(narrow, 1e-6);
    return max(0.5 * log2(max(spread / (3.0 * texel), 1.0)), 0.0);
}

vec3 skyLookup(vec3 d, float spread, int layer) {
    if (sceneInfo.sky_turn < 0.0) return sceneInfo.sky;
    float level = skyLevel(d, spread);
    vec2 uv = skyDirection(d);
    // The image wraps in azimuth but ends at the poles. The level's size is computed, not queried: Mesa's
    // software device uses one invocation's level for all.
    float margin = 0.5 / float(max(textureSize(skyTexture, 0).y >> int(ceil(level)), 1));
    uv.y = clamp(uv.y, margin, 1.0 - margin);
    return sceneInfo.sky * textureLod(skyTexture, vec3(uv, float(layer)), level).rgb;
}

// Mean radiance over `spread` [sr] around d, for a ray or cone. Excludes the sun if it is one of the lights.
vec3 skyRadiance(vec3 d, float spread) {
    return skyLookup(d, spread, 0);
}

// Background radiance, including the sun.
vec3 skyBehind(vec3 d) {
    return skyLookup(d, 0.0, 1);
}

// Solid angle of a cone [sr] from the tangent of half its aperture.
float coneSolidAngle(float tan_half) {
    return 2.0 * PI * (1.0 - inversesqrt(1.0 + tan_half * tan_half));
}

#endif
