// Prefix sums over the invocations of a group, in order. The including file defines SCAN_THREADS, the group
// size. All invocations of the group call these functions together.
#ifndef SCAN_GLSL
#define SCAN_GLSL

shared uint scan_sums[SCAN_THREADS];

// Sum over the invocations up to and including this one.
uint inclusiveSum(uint value) {
    uint thread = gl_LocalInvocationIndex, sum = value;
    for (uint distance = 1; distance < SCAN_THREADS; distance *= 2) {
        scan_sums[thread] = sum;
        barrier();
        if (thread >= distance) sum += scan_sums[thread - distance];
        barrier();
    }
    return sum;
}

// Sum over all invocations of the group.
uint groupSum(uint value) {
    uint thread = gl_LocalInvocationIndex, sum = inclusiveSum(value);
    if (thread == SCAN_THREADS - 1) scan_sums[0] = sum;
    barrier();
    sum = scan_sums[0];
    barrier();
    return sum;
}

#endif
