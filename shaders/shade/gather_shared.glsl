// A pixel's rays, dealt to GATHER_THREADS threads of a group, which the shader says. Threads beside each other take the same ray of
// different pixels.
#include "shade/gathered.glsl"

const uint GATHER_PIXELS = 32; // of a group

layout(local_size_x = GATHER_PIXELS, local_size_y = GATHER_THREADS) in;

shared vec4 shared_hemisphere[GATHER_THREADS][GATHER_PIXELS];
shared vec3 shared_specular[GATHER_THREADS][GATHER_PIXELS];

ivec2 gathering = ivec2(0);

vec2 pixelCentre() {
    return vec2(gathering) + 0.5;
}

// All threads of a group come here. `rays`: of the pixel, over the hemisphere; 0: its reflection alone, what it has gathered of the
// hemisphere stays. `lobe`: those of a surface that reflects by its lobe alone.
void gatherPixel(ivec2 pixel, bool gathers, int rays, int lobe, float age) {
    uint part = gl_LocalInvocationID.y, lane = gl_LocalInvocationID.x;
    gathers = gathers && all(lessThan(pixel, ivec2(camera.size)));
    gathering = pixel;
    GBufferSurface seen;
    seen.any = false;
    if (gathers) seen = gbufferAt(pixel);
    Gathered light = Gathered(vec4(0.0), vec3(0.0));
    if (seen.any) {
        gatherShare = RayShare(rays, lobe, int(part), int(GATHER_THREADS));
        light = gather(coneOrigin(seen.position, seen.face, seen.surface.normal), seen.surface, seen.face, seen.to_viewer);
    }
    shared_hemisphere[part][lane] = light.hemisphere;
    shared_specular[part][lane] = light.specular;
    barrier();
    if (part != 0 || !gathers) return;
    for (uint i = 1; i < GATHER_THREADS; i++) {
        light.hemisphere += shared_hemisphere[i][lane];
        light.specular += shared_specular[i][lane];
    }
    if (!seen.any) light = NOTHING_GATHERED;
    if (rays > 0) imageStore(gatheredDiffuse, pixel, light.hemisphere);
    imageStore(gatheredSpecular, pixel, vec4(light.specular, age));
}
