// Prefix sums over brick words. They make the order of surfels deterministic.
#ifndef VOXELIZE_CHUNKS_GLSL
#define VOXELIZE_CHUNKS_GLSL

layout(std430) buffer VoxelChunks { uint surfels[]; } voxelChunks; // per chunk
layout(std430) buffer VoxelStarts { uint surfels[]; } voxelStarts; // in all chunks before

const uint CHUNK_THREADS = 256;
const uint THREAD_WORDS = 4;
const uint CHUNK_WORDS = CHUNK_THREADS * THREAD_WORDS;

#ifdef SUMS_CHUNKS
layout(local_size_x = CHUNK_THREADS) in;
#define SCAN_THREADS CHUNK_THREADS
#include "common/scan.glsl"
#endif

#endif
