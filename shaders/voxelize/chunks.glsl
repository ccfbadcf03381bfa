// Sums over the words of bricks, in the order of the words: slots lie where they lie in every frame, whoever was first.
#ifndef VOXELIZE_CHUNKS_GLSL
#define VOXELIZE_CHUNKS_GLSL

layout(std430) buffer VoxelChunks { uint slots[]; } voxelChunks; // of each chunk
layout(std430) buffer VoxelStarts { uint slots[]; } voxelStarts; // of all before it

const uint CHUNK_THREADS = 256;
const uint THREAD_WORDS = 4;
const uint CHUNK_WORDS = CHUNK_THREADS * THREAD_WORDS;

#ifdef SUMS_CHUNKS
layout(local_size_x = CHUNK_THREADS) in;

shared uint sums[CHUNK_THREADS];

// The sum over the threads of a group up to this one. All of them come here.
uint sumUpTo(uint thread, uint sum) {
    for (uint distance = 1; distance < CHUNK_THREADS; distance *= 2) {
        sums[thread] = sum;
        barrier();
        if (thread >= distance) sum += sums[thread - distance];
        barrier();
    }
    return sum;
}

// The sum over all threads of a group.
uint sumOfAll(uint thread, uint sum) {
    sum = sumUpTo(thread, sum);
    if (thread == CHUNK_THREADS - 1) sums[0] = sum;
    barrier();
    sum = sums[0];
    barrier();
    return sum;
}
#endif

#endif
