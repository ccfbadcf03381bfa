// Six directions that filtered levels are kept for: +x, -x, +y, -y, +z, -z, the ways that rays travel.
#ifndef DIRECTIONS_GLSL
#define DIRECTIONS_GLSL

vec3 mipDirection(int direction) {
    vec3 d = vec3(0.0);
    d[direction / 2] = (direction & 1) == 0 ? 1.0 : -1.0;
    return d;
}

// Texel x of a direction's part in a level of `dim` cells is at direction * dim + x. A lookup must not reach the next part:
// half a cell of the coarser of the levels that it blends stays between. `u` in volume coordinates.
vec4 sampleDirection(sampler3D aniso, vec3 u, int direction, float level, float cells) {
    float margin = 0.5 * exp2(ceil(level)) / cells;
    return textureLod(aniso, vec3((float(direction) + clamp(u.x, margin, 1.0 - margin)) / 6.0, u.yz), level);
}

// What a ray finds: the three directions that it crosses, by weights `w`. `cells` along an edge of level 0.
vec4 sampleDirections(sampler3D aniso, vec3 u, vec3 d, vec3 w, float level, float cells) {
    return w.x * sampleDirection(aniso, u, d.x < 0.0 ? 1 : 0, level, cells)
         + w.y * sampleDirection(aniso, u, d.y < 0.0 ? 3 : 2, level, cells)
         + w.z * sampleDirection(aniso, u, d.z < 0.0 ? 5 : 4, level, cells);
}

#endif
