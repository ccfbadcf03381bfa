#version 460
#extension GL_GOOGLE_include_directive : require
// Fits a linearly transformed cosine to the specular lobe, by roughness and cosine at the viewer. Half the
// integral of the absolute difference to GGX is 0.005 at roughness 0.1 and 60 degrees, 0.08 at 0.5 and 60,
// 0.27 at 0.5 and 87: as close as fits of the cubed difference (Heitz et al. 2016), without their search.
#include "params.glsl"
#include "common/ggx.glsl"

const uint THREADS = 64, PER_THREAD = 16;
// First the map under which directions sampled from the lobe are most likely, which converges from afar;
// then, from there, the least squared difference. Longer steps diverge.
const int ROUNDS = 32;
const float LIKELY_STEP = 0.3, SQUARES_STEP = 0.5;

layout(local_size_x = 64) in;

// x: root of 1 minus the cosine, nearly proportional to the angle, as the tilt of the lobe is; y: roughness
uniform writeonly image2D table;

shared vec4 sums[THREADS];
shared vec3 means[THREADS];

void addUp(uint thread) {
    for (uint half_way = THREADS / 2; half_way > 0; half_way /= 2) {
        barrier();
        if (thread < half_way) {
            sums[thread] += sums[thread + half_way];
            means[thread] += means[thread + half_way];
        }
    }
    barrier();
}

void main() {
    uvec2 at = gl_WorkGroupID.xy;
    uint thread = gl_LocalInvocationID.x;
    vec2 u = vec2(at) / vec2(imageSize(table) - 1);
    float cosine = max(1.0 - u.x * u.x, 1e-3);
    vec3 v = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine), n = vec3(0, 0, 1);
    Surface s = bareSurface(n, vec3(1.0), u.y, 1.0, PLAIN_DIELECTRIC); // f0 = 1

    vec3 directions[PER_THREAD];
    float weights[PER_THREAD], densities[PER_THREAD];
    sums[thread] = vec4(0.0);
    means[thread] = vec3(0.0);
    for (uint i = 0; i < PER_THREAD; i++) {
        // Roberts 2018, R2
        vec2 r = fract(0.5 + float(i * THREADS + thread) * vec2(0.7548776662, 0.5698402910));
        LobeSample one = specularSample(s, n, v, r);
        directions[i] = one.direction;
        weights[i] = one.weight.r;
        densities[i] = max(specularBrdf(s, v, one.direction).r * one.direction.z, 1e-20);
        means[thread] += one.weight.r * one.direction;
        sums[thread].xy += one.weight.r * vec2(1.0, densities[i]);
    }
    addUp(thread);
    vec2 total = max(sums[0].xy, 1e-20);
    float albedo = total.x / float(THREADS * PER_THREAD);
    vec3 mean = normalize(means[0] + vec3(0.0, 0.0, 1e-20));
    barrier();

    // Rows of the map from the lobe to the cosine, in the plane of x and z, and its scale of y. The start
    // turns the mean direction to z and widens the lobe.
    float wide = 1.0 / clamp(ggxAlpha(s.roughness), 1e-3, 1.0);
    vec2 x = wide * vec2(mean.z, -mean.x), z = vec2(mean.x, mean.z);
    float y = wide;
    for (int round = 0; round < 2 * ROUNDS; round++) {
        bool likely = round < ROUNDS;
        float scale = y * (x.x * z.y - x.y * z.x) * albedo / PI;
        vec4 sum = vec4(0.0);
        float pull = 0.0;
        for (uint i = 0; i < PER_THREAD; i++) {
            vec3 d = directions[i];
            vec3 q = vec3(dot(x, d.xz), y * d.y, dot(z, d.xz));
            float square = dot(q, q);
            // The fitted density over that of the lobe, divided by q.z.
            float ratio = scale / (square * square * densities[i]);
            float weight = weights[i], over_z;
            if (likely) {
                // The floor keeps directions in reach that a step has put below the horizon.
                over_z = weight / max(q.z, 0.02 * sqrt(square));
            } else {
                over_z = q.z > 0.0 ? weight * densities[i] * ratio * (1.0 - ratio * q.z) : 0.0;
                weight = over_z * q.z;
            }
            vec3 squares = q * q / square;
            sum += weight * (vec4(1.0, 1.0, 2.0, 0.0) - 4.0 * vec4(squares, q.x * q.z / square));
            pull += over_z * q.x;
        }
        sums[thread] = sum;
        means[thread] = vec3(pull, 0.0, 0.0);
        addUp(thread);
        // Gradient relative to the map: of xx, yy, zz, xz and zx.
        vec4 gradient = sums[0];
        float tilt = gradient.w + means[0].x;
        barrier();
        float norm = likely ? LIKELY_STEP / total.x : SQUARES_STEP / total.y, most = likely ? 0.15 : 0.25;
        gradient = clamp(norm * gradient, -most, most);
        tilt = clamp(norm * tilt, -most, most);
        vec2 before = x;
        x += gradient.x * x + gradient.w * z;
        z += gradient.z * z + tilt * before;
        y += gradient.y * y;
    }
    if (thread > 0) return;
    // The inverse, with 1 in its last place.
    imageStore(table, ivec2(at), vec4(z.y, (x.x * z.y - x.y * z.x) / y, -x.y, -z.x) / x.x);
}
