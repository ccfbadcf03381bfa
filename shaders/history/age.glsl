// Age of a pixel's gathered light, and when the pixel gathers again. Each of the 64 pixels of an 8x8 tile has
// an interleaving phase. A surface gathers once in params.phases frames, whichever pixels it moves through:
// light gets no older until it has converged, and rays only refresh light that is due. A still image
// converges to the bit.
#ifndef HISTORY_AGE_GLSL
#define HISTORY_AGE_GLSL
#include "common/ggx.glsl"
#include "gbuffer/read.glsl"
#include "common/pattern.glsl"
#include "history/rounds.glsl"

// Fraction of an age that marks disoccluded pixels, which have few samples. Other ages are whole frames.
const float FEW_RAYS_AGE = 0.5;

// Most rounds in the mean of a pixel under a moving camera: its history drifts.
const uint MOVING_ROUNDS = 4;

struct Age {
    float frames;
    bool due; // the pixel gathers with all its rays
};

// Frames since the pixel's phase was last due; params.phases if it is due in this frame. index: of the pixel
// in its 8x8 tile.
float ageInPhase(uint index) {
    uint phases = uint(params.phases), phase = index * phases / 64u;
    return float(phases - (phase + phases - camera.frame % phases) % phases);
}

// Most rounds that enter a pixel's mean after its first.
uint mostAveraged() {
    if (pixelRound() == 0) return 0;
    uint rounds = uint(params.accumulation_rounds);
    return (cameraIsStill() ? rounds : min(rounds, MOVING_ROUNDS)) - 1;
}

// Whether light ages in this frame. While the camera moves, converged light ages in one of gather_rest
// frames, or more often if the view direction turns fast relative to the surface's lobe.
bool ages(GBufferSurface seen, uint index, bool few_rays) {
    // One more round of all phases: by then each pixel has gathered the converged light.
    uint frames = CONVERGED_ROUNDS * uint(params.bounce_frames) + uint(params.phases);
    bool converged = camera.still_frames > frames;
    if (few_rays || !converged || cameraIsStill()) return true;
    vec3 previous_to_viewer = normalize(camera.previous_position - seen.position);
    float turned = distance(seen.to_viewer, previous_to_viewer) * float(params.phases);
    float alpha = ggxAlpha(seen.surface.roughness);
    uint interval = uint(clamp(alpha / max(turned, 1e-6), 1.0, float(params.gather_rest)));
    return (camera.frame + index) % interval == 0;
}

// Age of a disoccluded pixel. It gathers with all rays in its own phase.
Age newAge(uint index) {
    float frames = ageInPhase(index) + FEW_RAYS_AGE;
    return Age(frames, floor(frames) >= float(params.phases));
}

// Age of light with age `last` in the last frame.
Age nextAge(GBufferSurface seen, uint index, float last) {
    float frames = ages(seen, index, fract(last) != 0.0) ? last + 1.0 : last;
    return Age(frames, floor(frames) >= float(params.phases));
}

// Age of light that is gathered in this frame. When the camera approaches, many pixels inherit from one and
// would stay due together. Pixels slightly behind their own phase therefore return to it.
float gatheredAge(uint index) {
    float in_phase = ageInPhase(index);
    return in_phase <= 0.25 * float(params.phases) ? in_phase : 0.0;
}

#endif
