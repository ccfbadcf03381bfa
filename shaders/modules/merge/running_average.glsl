// Running mean in eight bits with the count in the top byte (Crassin and Green 2012). Kept to show its
// errors: it truncates at each step, wraps after 255 fragments and depends on their order.
void runningAverage(uint word, vec3 value) {
    vec4 added = vec4(value * 255.0, 1.0);
    uvec4 v = uvec4(added);
    uint next = v.x | v.y << 8 | v.z << 16 | v.w << 24;
    uint expected = 0;
    for (int i = 0; i < 1024; i++) {
        uint seen = atomicCompSwap(surfelSums.words[word], expected, next);
        if (seen == expected) return;
        expected = seen;
        vec4 mean = vec4(seen & 255u, seen >> 8 & 255u, seen >> 16 & 255u, seen >> 24);
        vec4 sum = vec4(mean.rgb * mean.a, mean.a) + added;
        v = uvec4(vec4(sum.rgb / sum.a, sum.a)) & 255u;
        next = v.x | v.y << 8 | v.z << 16 | v.w << 24;
    }
}

void mergeInto(uint base, vec3 color, vec3 normal, uint weight) {
    runningAverage(base, color);
    runningAverage(base + 4, normal * 0.5 + 0.5);
}

void mergedMean(uint base, out vec3 color, out vec3 normal) {
    color = unpackUnorm4x8(surfelSums.words[base]).rgb;
    normal = unpackUnorm4x8(surfelSums.words[base + 4]).rgb * 2.0 - 1.0;
}
