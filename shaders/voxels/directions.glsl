// The six directions of anisotropic levels: +x, -x, +y, -y, +z, -z, as ray directions.
#ifndef DIRECTIONS_GLSL
#define DIRECTIONS_GLSL

vec3 mipDirection(int direction) {
    vec3 d = vec3(0.0);
    d[direction / 2] = (direction & 1) == 0 ? 1.0 : -1.0;
    return d;
}

// Samples one direction. Texel x of a direction in a level of `dim` cells is at direction * dim + x. The
// margin of half a cell of the coarser blended level keeps lookups out of the next direction. `u` in volume
// coordinates.
vec4 sampleDirection(sampler3D aniso, vec3 u, int direction, float level, float cells) {
    float margin = 0.5 * exp2(ceil(level)) / cells;
    return textureLod(aniso, vec3((float(direction) + clamp(u.x, margin, 1.0 - margin)) / 6.0, u.yz), level);
}

// Samples the three directions that a ray along d faces, with weights `w`. `cells`: along an edge of level 0.
vec4 sampleDirections(sampler3D aniso, vec3 u, vec3 d, vec3 w, float level, float cells) {
    return w.x * sampleDirection(aniso, u, d.x < 0.0 ? 1 : 0, level, cells)
         + w.y * sampleDirection(aniso, u, d.y < 0.0 ? 3 : 2, level, cells)
         + w.z * sampleDirection(aniso, u, d.z < 0.0 ? 5 : 4, level, cells);
}

#endif
