// Looks into a running shader: show("name", value) lists a value of the pixel that was clicked on, and
// check("name", condition) counts failures. docs/graph.md describes both.
#ifndef DEBUG_GLSL
#define DEBUG_GLSL
#include "common/debug_pixel.glsl"

struct DebugValue {
    uint name;
    uint type; // components - 1, and from bit 2: 0 float, 1 int, 2 uint, 3 bool
    uint bits[4];
};

struct DebugCheck {
    uint failed;
    uint first; // complement of the smallest debugKey; 0: none
};

layout(std430) buffer DebugRecord {
    uint count; // values, including those beyond the capacity
    DebugValue values[256];
    DebugCheck checks[16384];
} debugRecord;

bool debug_selected = false, debug_selection = false;

#if DEBUG_STAGE == 5
uvec3 debugPlace() {
    return gl_GlobalInvocationID;
}
#elif DEBUG_STAGE == 4
uvec3 debugPlace() {
    return uvec3(gl_FragCoord.xy, 0);
}
#else
#error debug.glsl serves fragment and compute shaders
#endif

// Selects the invocations of which show lists values, in place of the clicked pixel's.
void debugIf(bool here) {
    debug_selected = true;
    debug_selection = here;
}

// Selects the invocations that work for the clicked pixel, if these are not those at its coordinates.
void debugPixel(ivec2 pixel) {
    debugIf(pixel == clickedPixel());
}

bool debugHere() {
    return debug_selected ? debug_selection : ivec3(debugPlace()) == ivec3(clickedPixel(), 0);
}

// Orders places: those of pictures and lists first, by row, then those of volumes.
uint debugKey(uvec3 at) {
    if (at.z > 0) return 0xc0000000u | min(at.z, 1023u) << 20 | min(at.y, 1023u) << 10 | min(at.x, 1023u);
    if (at.x < 65536u) return min(at.y, 32767u) << 16 | at.x;
    return 0x80000000u | min(at.x, 0x3fffffffu);
}

void check(uint name, bool holds) {
    if (holds) return;
    atomicAdd(debugRecord.checks[name & 16383u].failed, 1u);
    atomicMax(debugRecord.checks[name & 16383u].first, ~debugKey(debugPlace()));
}

void debugStore(uint name, uint type, uvec4 bits) {
    if (!debugHere()) return;
    uint i = atomicAdd(debugRecord.count, 1u);
    if (i < 256u) debugRecord.values[i] = DebugValue(name, type, uint[4](bits.x, bits.y, bits.z, bits.w));
}

void show(uint name, float v) { debugStore(name, 0u, uvec4(floatBitsToUint(v), 0, 0, 0)); }
void show(uint name, vec2 v) { debugStore(name, 1u, uvec4(floatBitsToUint(v), 0, 0)); }
void show(uint name, vec3 v) { debugStore(name, 2u, uvec4(floatBitsToUint(v), 0)); }
void show(uint name, vec4 v) { debugStore(name, 3u, floatBitsToUint(v)); }
void show(uint name, int v) { debugStore(name, 4u, uvec4(uint(v), 0, 0, 0)); }
void show(uint name, ivec2 v) { debugStore(name, 5u, uvec4(uvec2(v), 0, 0)); }
void show(uint name, ivec3 v) { debugStore(name, 6u, uvec4(uvec3(v), 0)); }
void show(uint name, ivec4 v) { debugStore(name, 7u, uvec4(v)); }
void show(uint name, uint v) { debugStore(name, 8u, uvec4(v, 0, 0, 0)); }
void show(uint name, uvec2 v) { debugStore(name, 9u, uvec4(v, 0, 0)); }
void show(uint name, uvec3 v) { debugStore(name, 10u, uvec4(v, 0)); }
void show(uint name, uvec4 v) { debugStore(name, 11u, v); }
void show(uint name, bool v) { debugStore(name, 12u, uvec4(v ? 1u : 0u, 0, 0, 0)); }

#endif
