// Progressive accumulation: once light has converged, and while nothing but the camera changes, each round of
// gathering takes new directions and enters a running mean.
#ifndef HISTORY_ROUNDS_GLSL
#define HISTORY_ROUNDS_GLSL
#include "common/scene.glsl"
#include "history/still.glsl"

// Short rounds of all voxels after a change, extrapolated (bounce/acceleration.glsl). If 98 % of the light is
// reflected, a twentieth of it is missing after them.
const uint SHORT_ROUNDS = 12;

// Long rounds until pixels under a moving camera take light as converged. If half of it is reflected, less
// than 1% is missing.
const uint CONVERGED_ROUNDS = 8;

// A pixel stores its age and the rounds of its mean after the first as age + AGES * rounds, exact in a half
// float.
const uint AGES = 64;

// Frames in which all voxels gather in a short round: a quarter of a long one, so that no frame gathers from
// more than a quarter of the voxels.
uint shortRound() {
    return (uint(params.bounce_frames) + 3) / 4;
}

// Frames from a change of voxels' light until rays hit it.
uint lightDelay() {
    return 1u + uint(params.filter_frames);
}

// Frames of a short round: at its start light is extrapolated, and no voxel gathers before rays hit it.
uint shortRoundFrames() {
    return lightDelay() + shortRound();
}

uint shortRoundsEnd() {
    return lightDelay() + SHORT_ROUNDS * shortRoundFrames();
}

// Whether the frame belongs to a short round. Its number, and its frame's, count from 0.
bool inShortRound() {
    return camera.still_frames >= lightDelay() && camera.still_frames < shortRoundsEnd();
}

uint shortRoundNumber() {
    return (camera.still_frames - lightDelay()) / shortRoundFrames();
}

uint frameOfShortRound() {
    return (camera.still_frames - lightDelay()) % shortRoundFrames();
}

// Frames in which each voxel gathers once.
uint bounceRoundFrames() {
    return camera.still_frames < shortRoundsEnd() ? shortRound() : uint(params.bounce_frames);
}

// Frames without a change from which voxels average, and pixels, which see their light one round later. A
// mean that begins too early keeps too little light for long.
uint bounceMeanStart() {
    return shortRoundsEnd() + uint(params.bounce_frames + params.filter_frames);
}

uint pixelMeanStart() {
    return bounceMeanStart() + uint(params.phases);
}

// Number of the directions of a round; 0 before light has converged.
uint roundSince(uint start, uint frames) {
    if (params.accumulation_rounds == 1 || camera.still_frames < start) return 0;
    return (camera.still_frames - start) / frames + 1;
}

uint bounceRound() {
    return roundSince(bounceMeanStart(), uint(params.bounce_frames));
}

uint pixelRound() {
    return roundSince(pixelMeanStart(), uint(params.phases));
}

// Weight of a round after `averaged` others since the first. The sums of weights grow with the cube of the
// rounds: what bounces still lacked when the mean began fades sooner than from an even mean, at 1.8 times the
// variance.
float weightOfRound(uint averaged) {
    return 3.0 / float(averaged + 3);
}

#endif
