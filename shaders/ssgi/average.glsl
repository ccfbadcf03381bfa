// Mean of pixels around one that see its surface.
#include "params.glsl"
#include "gbuffer/read.glsl"
#include "shade/filter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D source;
uniform writeonly image2D averaged;

// `edge` x `edge` pixels, `spacing` apart, around the place between the middle ones.
void averageOver(int edge, int spacing) {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    GBufferSurface seen = gbufferAt(pixel);
    if (!seen.any) {
        imageStore(averaged, pixel, vec4(0.0, 0.0, 0.0, 1.0));
        return;
    }
    EdgeStop stop = edgeStopOf(pixel, seen);
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < edge * edge; i++) {
        ivec2 at = pixel + spacing * (ivec2(i % edge, i / edge) - edge / 2) + (spacing == 1 ? 1 : 0);
        float weight = filterWeights(at, stop).diffuse;
        if (weight == 0.0) continue;
        sum += weight * texelFetch(source, at, 0);
        weights += weight;
    }
    imageStore(averaged, pixel, sum / weights);
}
