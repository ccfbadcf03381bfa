// The largest packed word wins; blue is the most significant channel.
void mergeInto(uint base, vec3 color, vec3 normal, uint weight) {
    atomicMax(surfelSums.words[base], packUnorm4x8(vec4(color, 1.0)));
    atomicMax(surfelSums.words[base + 4], packUnorm4x8(vec4(normal * 0.5 + 0.5, 1.0)));
}

void mergedMean(uint base, out vec3 color, out vec3 normal) {
    color = unpackUnorm4x8(surfelSums.words[base]).rgb;
    normal = unpackUnorm4x8(surfelSums.words[base + 4]).rgb * 2.0 - 1.0;
}
