// Sums over all voxel sides, in a fixed order, so that runs agree to the bit.
#ifndef BOUNCE_SUMS_GLSL
#define BOUNCE_SUMS_GLSL

// Weighted sums of one group.
struct BounceSums {
    vec3 light;
    vec3 bounced; // without the light of the first update
    vec3 reflected;
};

layout(std430) buffer BouncePartials { BounceSums list[]; } bouncePartials;

shared BounceSums shared_sums[SUM_THREADS];

BounceSums plus(BounceSums a, BounceSums b) {
    return BounceSums(a.light + b.light, a.bounced + b.bounced, a.reflected + b.reflected);
}

// Sum of one value per thread. All threads of a group must call it.
BounceSums groupSum(BounceSums mine) {
    uint thread = gl_LocalInvocationIndex;
    shared_sums[thread] = mine;
    for (uint n = SUM_THREADS / 2; n > 0; n /= 2) {
        barrier();
        if (thread < n) shared_sums[thread] = plus(shared_sums[thread], shared_sums[thread + n]);
    }
    barrier();
    return shared_sums[0];
}

#endif
