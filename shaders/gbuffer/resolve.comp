#version 460
#extension GL_GOOGLE_include_directive : require
// Resolves the visibility buffer into the G-buffer. Rays of a pixel and its neighbours intersect the
// triangle's plane (Moller and Trumbore 1997), which gives attributes and texture gradients (Schied and
// Dachsbacher 2015).
#include "params.glsl"
#include "common/pixel.glsl"
#include "materials/materials.glsl"
#include "gbuffer/packing.glsl"
#include "materials/normals.glsl"
#include "raster/triangles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430) readonly buffer Visibility { uvec2 words[]; } visibility; // triangle, depth
uniform writeonly image2D gbufferBase;
uniform writeonly image2D gbufferNormals;
uniform writeonly image2D gbufferEmission;
uniform writeonly image2D gbufferDistance;
uniform writeonly image2D gbufferMotion;
uniform writeonly image2D visibleDepth;

// Ray through a point of the image; not unit length.
vec3 rayThrough(vec2 pixel) {
    vec2 clip = pixel / vec2(camera.size) * 2.0 - 1.0;
    return transpose(mat3(camera.view))
        * vec3(clip.x / camera.projection[0][0], clip.y / camera.projection[1][1], -1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(camera.size)))) return;
    uvec2 word = visibility.words[uint(pixel.y) * camera.size.x + uint(pixel.x)];
    imageStore(visibleDepth, pixel, vec4(uintBitsToFloat(word.y)));
    if (word.y == 0) {
        imageStore(gbufferBase, pixel, vec4(0.0));
        imageStore(gbufferNormals, pixel, vec4(0.0));
        imageStore(gbufferEmission, pixel, vec4(0.0));
        imageStore(gbufferDistance, pixel, vec4(0.0));
        return;
    }
    uvec2 t = triangles.list[word.x];
    Draw draw = draws.draws[t.x];
    uvec3 vertex = uvec3(indices.indices[t.y], indices.indices[t.y + 1], indices.indices[t.y + 2]);
    mat3 local = mat3(loadPosition(vertex.x), loadPosition(vertex.y), loadPosition(vertex.z));
    vec3 a = toWorld(draw.instance, local[0]);
    vec3 e = toWorld(draw.instance, local[1]) - a, f = toWorld(draw.instance, local[2]) - a;
    VertexAttributes at[3] =
        VertexAttributes[3](loadAttributes(vertex.x), loadAttributes(vertex.y), loadAttributes(vertex.z));

    // Per ray: distance to the plane, and the barycentric weights of the second and third corner there.
    vec3 from = camera.position - a, plane = cross(e, f);
    mat3 meet = mat3(cross(from, f), cross(e, from), plane);
    vec2 at_pixel = vec2(pixel) + 0.5 + pixelOffset();
    vec3 ray = rayThrough(at_pixel);
    vec3 across = ray * meet,
        across_x = rayThrough(at_pixel + vec2(1.0, 0.0)) * meet,
        across_y = rayThrough(at_pixel + vec2(0.0, 1.0)) * meet;
    // Rounding dominates for triangles seen edge-on: clamp to the corners and to the rasterised depth.
    vec2 weights = clamp(across.xy / (across.z == 0.0 ? 1e-30 : across.z), 0.0, 1.0);
    float raster_depth = camera.near / uintBitsToFloat(word.y);
    float depth = clamp(-dot(from, plane) / (across.z == 0.0 ? 1e-30 : across.z),
        0.99 * raster_depth, 1.01 * raster_depth);
    mat2x4 uv_of = mat2x4(at[1].uv - at[0].uv, at[2].uv - at[0].uv);
    Gradient g = Gradient(
        PIXEL_FOOTPRINT * uv_of * (across_x.xy / across_x.z - weights),
        PIXEL_FOOTPRINT * uv_of * (across_y.xy / across_y.z - weights));

    Material m = materials.materials[draw.material];
    vec3 b = vec3(1.0 - weights.x - weights.y, weights);
    Interpolants here = Interpolants(at[0].uv + uv_of * weights, vec4(1.0));
    if (isColored(m)) here.color = mat3x4(at[0].color, at[1].color, at[2].color) * b;
    vec3 normal = normalToWorld(draw.instance, mat3(at[0].normal, at[1].normal, at[2].normal) * b);
    vec4 tangent = tangentToWorld(draw.instance, mat3x4(at[0].tangent, at[1].tangent, at[2].tangent) * b);
    vec3 face = dot(plane, plane) > 0.0 ? normalize(plane) : normalize(normal);
    if (dot(face, ray) > 0.0) face = -face;
    vec2 rm = roughnessMetallic(m, here, g);
    imageStore(gbufferBase, pixel, vec4(baseColor(m, here, g).rgb, rm.x));
    imageStore(gbufferNormals, pixel,
        vec4(packNormal(mappedNormal(m, here, g, normal, tangent, face)), packNormal(face)));
    imageStore(gbufferEmission, pixel, vec4(emission(m, here, g), packMetallic(rm.y, dielectricIndex(m))));
    imageStore(gbufferDistance, pixel, vec4(depth * length(ray)));
    if (params.moves == 1)
        imageStore(gbufferMotion, pixel, vec4(displacement(draw.instance, local * b), 0.0));
}
