// Gathers the light of the queued pixels. Several threads share the rays of a pixel; neighbouring threads
// take the same ray of different pixels.
#include "params.glsl"
#define READS_HISTORY
#include "gather/queue.glsl"
#include "gather/pixel.glsl"
#include "shade/demodulate.glsl"
#include "history/rounds.glsl"

const uint GATHER_THREADS = 4; // per pixel

layout(local_size_x = GATHER_PIXELS, local_size_y = GATHER_THREADS) in;

shared vec4 shared_hemisphere[GATHER_THREADS][GATHER_PIXELS];
shared vec3 shared_specular[GATHER_THREADS][GATHER_PIXELS];

ivec2 gathering = ivec2(0);

vec2 pixelCentre() {
    return vec2(gathering) + 0.5;
}

// All threads of a group call this together.
void gatherQueued(uint word, bool gathers) {
    uint part = gl_LocalInvocationID.y, lane = gl_LocalInvocationID.x, mode = queuedMode(word);
    gathering = queuedPixel(word);
    int rays = params.diffuse_cones, emitters = params.emitter_rays;
    if (mode == GATHER_FEW) {
        rays = min(rays, FEW_RAYS);
        emitters = min(emitters, 1);
    }
    if (mode == GATHER_MIRRORED) rays = emitters = 0; // the hemisphere keeps its history
    Gathered light = Gathered(vec4(0.0), vec3(0.0));
    if (gathers) {
        GBufferSurface seen = gbufferAt(gathering);
        seen.surface.multiple = vec3(1.0); // cancels in demodulation
        gatherShare = RayShare(rays, emitters, int(part), int(GATHER_THREADS));
        ConeOrigin origin = coneOrigin(seen.position, seen.face, seen.surface.normal);
        light = gather(origin, seen.surface, seen.face, seen.to_viewer);
        light.specular /= max(lobeReflectance(seen.surface, seen.to_viewer), MIN_REFLECTANCE);
    }
    shared_hemisphere[part][lane] = light.hemisphere;
    shared_specular[part][lane] = light.specular;
    barrier();
    if (part != 0 || !gathers) return;
    for (uint i = 1; i < GATHER_THREADS; i++) {
        light.hemisphere += shared_hemisphere[i][lane];
        light.specular += shared_specular[i][lane];
    }
    vec4 last = imageLoad(gatheredSpecular, gathering);
    float weight = mode == GATHER_ALL ? weightOfRound(uint(last.a) / AGES) : 1.0;
    if (weight < 1.0) light.hemisphere = mix(imageLoad(gatheredDiffuse, gathering), light.hemisphere, weight);
    // Reflections change with the view.
    if (weight < 1.0 && cameraIsStill()) light.specular = mix(last.rgb, light.specular, weight);
    if (rays > 0) imageStore(gatheredDiffuse, gathering, light.hemisphere);
    imageStore(gatheredSpecular, gathering, vec4(light.specular, last.a));
}

void main() {
    uint count = gatherCounter.count, stride = gl_NumWorkGroups.x * GATHER_PIXELS;
    for (uint start = gl_WorkGroupID.x * GATHER_PIXELS; start < count; start += stride) {
        uint i = start + gl_LocalInvocationID.x;
        gatherQueued(i < count ? gatherQueue.items[i] : 0, i < count);
        barrier();
    }
}
