#version 460
#extension GL_GOOGLE_include_directive : require
// Temporal anti-aliasing (Karis 2014). Each frame samples another place of a pixel. While the camera stands
// still their mean is that of a box filter. Under a moving camera older frames are reprojected, which blurs
// edges of one pixel, and clipped to the colours around the pixel (Salvi 2016) against ghosts.
#include "params.glsl"
#include "gbuffer/motion.glsl"
#include "gbuffer/read.glsl"
#include "history/still.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform sampler2D samples; // of this frame
uniform sampler2D lastMean; // a: frames in it
uniform writeonly image2D mean;
uniform writeonly image2D resolved;

// Frames in the mean under a moving camera: a new frame weighs a tenth. Standing still, at most MOST_FRAMES:
// rays go on converging.
const float MOVING_FRAMES = 27.0;
const float MOST_FRAMES = 256.0;

// Standard deviations around the mean of 3x3 pixels that older frames may reach.
const float CLIP_WIDTH = 1.25;

ivec2 inImage(ivec2 at) {
    return clamp(at, ivec2(0), ivec2(camera.size) - 1);
}

// The nearest surface of 3x3 pixels. Edges move with the surface in front.
ivec2 nearestAround(ivec2 pixel) {
    ivec2 nearest = pixel;
    float least = 1e30;
    for (int i = 0; i < 9; i++) {
        ivec2 at = inImage(pixel + ivec2(i % 3, i / 3) - 1);
        float range = texelFetch(gbufferDistance, at, 0).r;
        if (range > 0.0 && range < least) {
            least = range;
            nearest = at;
        }
    }
    return nearest;
}

// Displacement of the surface in a pixel since the last frame [m]; 0 for the sky.
vec3 motionOf(ivec2 pixel) {
    return texelFetch(gbufferDistance, pixel, 0).r > 0.0 ? motionAt(pixel) : vec3(0.0);
}

// Where the pixel's centre was in the last frame [pixels]; `at` is the pixel that it moves with. The sky is
// infinitely far away.
bool lastPlace(ivec2 pixel, ivec2 at, out vec2 place) {
    float range = texelFetch(gbufferDistance, at, 0).r;
    vec3 ray = pixelRay(at);
    vec4 point = range > 0.0 ? vec4(camera.position + range * ray - motionAt(at), 1.0) : vec4(ray, 0.0);
    vec4 clip = camera.previous_view_projection * point;
    place = (clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size) - vec2(at - pixel) - pixelOffset();
    return clip.w > 0.0 && all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(camera.size)));
}

// Catmull-Rom lookup: a bilinear one blurs more in every frame.
vec4 lastMeanAt(vec2 place) {
    vec2 corner = floor(place - 0.5), f = place - 0.5 - corner;
    vec2 w[4] = vec2[4](f * (-0.5 + f * (1.0 - 0.5 * f)), 1.0 + f * f * (1.5 * f - 2.5),
        f * (0.5 + f * (2.0 - 1.5 * f)), f * f * (0.5 * f - 0.5));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; i++)
        sum += w[i & 3].x * w[i >> 2].y
            * texelFetch(lastMean, inImage(ivec2(corner) + ivec2(i & 3, i >> 2) - 1), 0);
    return max(sum, vec4(0.0));
}

// `last`, moved towards the mean colour of 3x3 pixels until it is in their box.
vec3 clipped(vec3 last, ivec2 pixel) {
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    for (int i = 0; i < 9; i++) {
        vec3 c = texelFetch(samples, inImage(pixel + ivec2(i % 3, i / 3) - 1), 0).rgb;
        sum += c;
        squares += c * c;
    }
    vec3 middle = sum / 9.0, width = CLIP_WIDTH * sqrt(max(squares / 9.0 - middle * middle, 0.0));
    vec3 off = last - middle, times = abs(off) / max(width, 1e-6);
    return middle + off / max(max(max(times.x, times.y), times.z), 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    vec4 now = texelFetch(samples, pixel, 0), last = vec4(0.0);
    vec2 place;
    ivec2 nearest = cameraIsStill() && params.moves == 0 ? pixel : nearestAround(pixel);
    bool still = cameraIsStill() && motionOf(nearest) == vec3(0.0);
    // Exact: a lookup between pixels would blur.
    if (still) last = texelFetch(lastMean, pixel, 0);
    else if (lastPlace(pixel, nearest, place)) last = lastMeanAt(place);
    if (!still || camera.still_frames <= uint(params.phases)) {
        last.rgb = clipped(last.rgb, pixel);
        last.a = min(last.a, MOVING_FRAMES);
    }
    // Sums of weights grow with the cube of the frames, as in weightOfRound: early frames lack light.
    vec3 light = mix(last.rgb, now.rgb, 3.0 / (last.a + 3.0));
    imageStore(mean, pixel, vec4(light, min(last.a + 1.0, MOST_FRAMES)));
    imageStore(resolved, pixel, vec4(light, now.a));
}
