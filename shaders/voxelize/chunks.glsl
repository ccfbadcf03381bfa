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
#define SCAN_THREADS CHUNK_THREADS
#include "common/scan.glsl"
#endif

#endif
