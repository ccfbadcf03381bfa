// Exact area-weighted mean: integer sums, which do not depend on the order.
void mergeInto(uint base, vec3 color, vec3 normal, uint weight) {
    uvec3 c = uvec3(color * COLOR_SCALE * float(weight) + 0.5);
    ivec3 n = ivec3(round(normal * NORMAL_SCALE * float(weight)));
    for (uint i = 0; i < 3; i++) {
        atomicAdd(surfelSums.words[base + i], c[i]);
        atomicAdd(surfelSums.words[base + 4 + i], uint(n[i])); // two's complement: wraps to the right sum
    }
}

// Mean of the fragments in a surfel.
void mergedMean(uint base, out vec3 color, out vec3 normal) {
    float weight = float(max(surfelSums.words[base + 3], 1u));
    color = vec3(surfelSums.words[base], surfelSums.words[base + 1], surfelSums.words[base + 2])
        / (COLOR_SCALE * weight);
    normal = vec3(int(surfelSums.words[base + 4]), int(surfelSums.words[base + 5]),
        int(surfelSums.words[base + 6])) / (NORMAL_SCALE * weight);
}
