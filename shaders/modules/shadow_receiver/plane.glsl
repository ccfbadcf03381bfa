// Compares with the depth of the receiver's plane at each texel (Isidoro 2006), so an offset of a few
// hundredths of a texel suffices.
#include "common/frame.glsl"
#ifdef AREA_LIGHTS
#include "shadow/soft.glsl"
#endif

// Slope of depth over the plane through p [depth per map width]. It is constant over a plane, in perspective
// too, so distant points are used, which preserves digits. q: p in the map.
vec2 planeSlope(int layer, vec3 p, vec3 q, vec3 n, vec3 to_light, float reach) {
    mat3 frame = frameOf(n);
    vec3 a = shadowPositionBeyond(layer, p + reach * frame[0]) - q,
        b = shadowPositionBeyond(layer, p + reach * frame[1]) - q;
    float area = a.x * b.y - a.y * b.x;
    vec2 slope = vec2(a.z * b.y - b.z * a.y, b.z * a.x - a.z * b.x) / (abs(area) > 1e-20 ? area : 1e-20);
    // Limits the slope of a plane seen edge-on to a depth of 64 texels per texel.
    float towards = abs(shadowPositionBeyond(layer, p + reach * to_light).z - q.z) * 64.0;
    return slope * min(1.0, 64.0 * towards / max(length(slope), 1e-20));
}

// Curved surfaces shadow themselves along their edges, because the texel holds the face beyond the edge. One
// of the four texels around a point shows the point's own face. A blocker counts as the surface itself if one
// of the four is lit and the blocker is this close [texels]. Real blockers as close lose up to a texel of
// their shadow.
const float CLOSE = 4.0;

bool hiddenByItself(int layer, vec3 q, vec2 slope, float deep) {
    vec2 texel = vec2(1.0 / shadowEdge(layer));
    vec2 first = (floor(q.xy / texel - 0.5) + 0.5) * texel;
    vec4 depths = shadowDepthsAround(layer, first + 0.5 * texel);
    float depth = q.z + dot(slope, first - q.xy);
    vec2 steps = slope * texel;
    vec4 own = depth + vec4(steps.y, steps.x + steps.y, steps.x, 0.0); // in the order of the gather
    vec4 above = own - depths;
    vec2 beyond = step(first + 0.5 * texel, q.xy);
    vec2 row = mix(above.wx, above.zy, beyond.x);
    return any(lessThanEqual(above, vec4(0.0))) && mix(row.x, row.y, beyond.y) < CLOSE * deep;
}

float lightVisibility(Light light, vec3 p, vec3 n, vec3 to_light) {
    if (light.shadow_view < 0) return 1.0;
#ifdef AREA_LIGHTS
    if (isArea(light)) return visibleArea(light, p, n);
#endif
    int layer = shadowLayerOf(light, p);
    float texel = shadowTexel(layer, light, p);
    vec3 from = offSurface(p, n, to_light, params.shadow_bias * texel);
    vec3 q = shadowPositionBeyond(layer, from);
    // 1/64 of the map's width.
    vec2 slope = planeSlope(layer, from, q, n, to_light, texel * shadowEdge(layer) / 64.0);
    q.z = clamp(q.z, 0.0, 1.0) - params.shadow_rounding - shadowLayers.layers[layer].rounding;
    // Samples at texel centres, where a bilinear lookup returns a single texel.
    vec2 centre = (floor(q.xy * shadowEdge(layer)) + 0.5) * (1.0 / shadowEdge(layer));
    float lit = shadowTaps(layer, vec3(centre, q.z + dot(slope, centre - q.xy)), slope);
    if (lit == 1.0) return lit;
    float deep =
        abs(shadowPositionBeyond(layer, from + texel * to_light).z - shadowPositionBeyond(layer, from).z);
    return hiddenByItself(layer, q, slope, deep) ? 1.0 : lit;
}
