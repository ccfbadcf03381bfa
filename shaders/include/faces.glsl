// Six directions that filtered levels are kept for: +x, -x, +y, -y, +z, -z, the ways that rays travel.
#ifndef FACES_GLSL
#define FACES_GLSL

vec3 faceDirection(int face) {
    vec3 d = vec3(0.0);
    d[face / 2] = (face & 1) == 0 ? 1.0 : -1.0;
    return d;
}

// Texel x of a face's block in a level of `dim` cells is at face * dim + x. A lookup must not reach the next block:
// half a cell of the coarser of the levels that it blends stays between. `u` in volume coordinates.
vec4 sampleFace(sampler3D faces, vec3 u, int face, float level, float cells) {
    float margin = 0.5 * exp2(ceil(level)) / cells;
    return textureLod(faces, vec3((float(face) + clamp(u.x, margin, 1.0 - margin)) / 6.0, u.yz), level);
}

// What a ray finds: the three faces that it crosses, by weights `w`. `cells` along an edge of the first level.
vec4 sampleFaces(sampler3D faces, vec3 u, vec3 d, vec3 w, float level, float cells) {
    return w.x * sampleFace(faces, u, d.x < 0.0 ? 1 : 0, level, cells)
         + w.y * sampleFace(faces, u, d.y < 0.0 ? 3 : 2, level, cells)
         + w.z * sampleFace(faces, u, d.z < 0.0 ? 5 : 4, level, cells);
}

#endif
