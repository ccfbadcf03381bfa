// Camera, scene and geometry: fixed resources that every pass may read. World units are metres; the world is
// right-handed with y up. Clip space is Vulkan's: y down, reversed depth (1 at the near plane, 0 at
// infinity).
#ifndef SCENE_GLSL
#define SCENE_GLSL

layout(std140) uniform Camera {
    mat4 view;
    mat4 projection;
    mat4 view_projection;
    mat4 inverse_view_projection;
    mat4 previous_view_projection;
    vec3 position;
    float near;
    vec3 direction;
    float far; // clips nothing; may be infinite
    vec3 up;
    float fov_y; // radians
    vec3 previous_position;
    float time; // seconds
    uvec2 size; // pixels
    uint frame;
    uint still_frames; // since anything except the camera changed
    uint changing_frames; // length of the last run of frames that each changed something
    float delta_time;
} camera;

layout(std140) uniform SceneInfo {
    vec3 bounds_min;
    uint light_count;
    vec3 bounds_max;
    uint shadow_views;
    vec3 sky; // radiance, or factor of the sky image
    uint triangle_count;
    uint draw_count;
    uint vertex_count;
    uint instance_count;
    float sky_turn; // rotation of the sky image about y [turns], 0 to 1; negative: no image
    uint still_triangles; // they come first and never move
} sceneInfo;

struct Instance {
    mat4 model;
    mat4 previous_model;
    mat4 normal_matrix; // inverse transpose of the model's 3x3
};

struct Draw {
    uint instance;
    uint material;
    uint first_index;
    uint index_count;
};

// Whether any vertex has a colour, and whether any texture needs its own wrap mode, filter or second set of
// coordinates. Set by the program.
layout(constant_id = 2040) const bool COLORS = true;
layout(constant_id = 2041) const bool LOOKUPS = true;

struct VertexAttributes {
    vec3 normal;
    vec4 tangent; // w: sign of the bitangent
    vec4 uv; // two sets
    vec4 color; // linear
};

layout(std430) readonly buffer Instances { Instance instances[]; } instances;
layout(std430) readonly buffer Draws { Draw draws[]; } draws;
layout(std430) readonly buffer Positions { float positions[]; } positions;
layout(std430) readonly buffer Attributes { vec4 attributes[]; } attributes;

vec3 loadPosition(uint vertex) {
    uint i = 3 * vertex;
    return vec3(positions.positions[i], positions.positions[i + 1], positions.positions[i + 2]);
}

VertexAttributes loadAttributes(uint vertex) {
    vec4 a = attributes.attributes[3 * vertex];
    vec4 b = attributes.attributes[3 * vertex + 1];
    vec4 c = attributes.attributes[3 * vertex + 2];
    // Square roots of red, green and blue.
    vec4 root = COLORS ? unpackUnorm4x8(floatBitsToUint(c.y)) : vec4(1.0);
    return VertexAttributes(a.xyz, b, vec4(a.w, c.x, LOOKUPS ? c.zw : vec2(0.0)),
        vec4(root.rgb * root.rgb, root.a));
}

vec3 toWorld(uint instance, vec3 position) {
    return (instances.instances[instance].model * vec4(position, 1.0)).xyz;
}

// Displacement of a point of an instance since the last frame [m]. Deforming meshes have no previous pose.
vec3 displacement(uint instance, vec3 position) {
    mat4 before = instances.instances[instance].previous_model;
    if (before[3][3] == 0.0) return vec3(0.0);
    return ((instances.instances[instance].model - before) * vec4(position, 1.0)).xyz;
}

vec3 normalToWorld(uint instance, vec3 normal) {
    return mat3(instances.instances[instance].normal_matrix) * normal;
}

// A mirrored instance flips cross(normal, tangent), and therefore the sign of the bitangent.
vec4 tangentToWorld(uint instance, vec4 tangent) {
    mat3 model = mat3(instances.instances[instance].model);
    return vec4(model * tangent.xyz, determinant(model) < 0.0 ? -tangent.w : tangent.w);
}

#endif
