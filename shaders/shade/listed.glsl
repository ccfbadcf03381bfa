// The pixels that gather in this frame. A pixel's rays are dealt to several threads; threads beside each other take the same ray of
// different pixels.
#include "params.glsl"
#define READS_AGE
#include "shade/kept.glsl"
#include "shade/gathered.glsl"
#include "shade/demodulate.glsl"

const uint GATHER_PIXELS = 32; // of a group
const uint GATHER_THREADS = 4; // of a pixel

layout(local_size_x = GATHER_PIXELS, local_size_y = GATHER_THREADS) in;

shared vec4 shared_hemisphere[GATHER_THREADS][GATHER_PIXELS];
shared vec3 shared_specular[GATHER_THREADS][GATHER_PIXELS];

ivec2 gathering = ivec2(0);

vec2 pixelCentre() {
    return vec2(gathering) + 0.5;
}

// All threads of a group come here.
void gatherListed(uint word, bool gathers) {
    uint part = gl_LocalInvocationID.y, lane = gl_LocalInvocationID.x, how = word >> 30;
    gathering = ivec2(word & 0x7fffu, word >> 15 & 0x7fffu);
    // Over the hemisphere, none where what it has gathered of that stays; into the lobe of a surface that reflects by its lobe alone.
    int rays = how == GATHER_ALL ? params.diffuse_cones : how == GATHER_FEW ? min(params.diffuse_cones, FEW_RAYS) : 0;
    int lobe = how == GATHER_LOBE ? params.diffuse_cones : rays;
    int emitters = how == GATHER_MIRRORED ? 0 : how == GATHER_FEW ? min(params.emitter_rays, 1) : params.emitter_rays;
    Gathered light = Gathered(vec4(0.0), vec3(0.0));
    if (gathers) {
        GBufferSurface seen = gbufferAt(gathering);
        seen.surface.multiple = vec3(1.0); // cancels between here and the shading
        gatherShare = RayShare(rays, lobe, emitters, int(part), int(GATHER_THREADS));
        light = gather(coneOrigin(seen.position, seen.face, seen.surface.normal), seen.surface, seen.face, seen.to_viewer);
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
    if (rays > 0) imageStore(gatheredDiffuse, gathering, light.hemisphere);
    imageStore(gatheredSpecular, gathering, vec4(light.specular, imageLoad(gatheredSpecular, gathering).a));
}

void main() {
    uint count = gatherCounter.count;
    for (uint start = gl_WorkGroupID.x * GATHER_PIXELS; start < count; start += gl_NumWorkGroups.x * GATHER_PIXELS) {
        uint i = start + gl_LocalInvocationID.x;
        gatherListed(i < count ? gatherList.pixels[i] : 0, i < count);
        barrier();
    }
}
