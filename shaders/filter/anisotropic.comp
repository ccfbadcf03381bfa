#version 460
#extension GL_GOOGLE_include_directive : require
// Anisotropic filtering (Crassin et al. 2011, Section 6): each cell stores radiance and opacity for rays
// along +x, -x, +y, -y, +z and -z. Cells are composited front to back in pairs and averaged over four
// columns. The six directions are next to each other along x.
#include "params.glsl"
#include "voxels/directions.glsl"
#include "voxels/bricks.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;

uniform sampler3D src; // one level
uniform writeonly image3D dst;

// Texel of the finer level for rays along `direction`.
vec4 child(ivec3 cell, int direction, int dim) {
    cell.xy = min(cell.xy, ivec2(dim - 1)); // a level of one cell
    if (CASCADE_COUNT == 1) cell.z = min(cell.z, dim - 1);
    return texelFetch(src, ivec3(cell.x + direction * dim, cell.yz), 0);
}

// Whether a cell of level 1 belongs to a brick that is not stored. Its texels are empty and need not be read.
bool isEmpty(ivec3 cell, int fine) {
    if (params.light_in_bricks == 0 || fine != params.voxel_dim) return false;
    ivec3 stored = 2 * cell;
    int cascade = cascadeOf(stored);
    ivec3 first = cellOfStored(stored, cascade);
    return !isStored(voxelBlocks.list[blockIndex(first, cascade)], indexInBrick(first >> 2));
}

void main() {
    ivec3 size = imageSize(dst);
    ivec3 at = ivec3(gl_GlobalInvocationID);
    int dim = size.y;
    if (any(greaterThanEqual(at, size)) || at.x >= 6 * dim) return;
    int direction = at.x / dim, axis = direction / 2;
    ivec3 cell = ivec3(at.x - direction * dim, at.yz);
    vec3 dir = mipDirection(direction);
    int fine = textureSize(src, 0).y;
    if (isEmpty(cell, fine)) {
        imageStore(dst, at, vec4(0.0));
        return;
    }
    ivec3 along = ivec3(abs(dir)), u = along.yzx, v = along.zxy;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec3 column = 2 * cell + (i & 1) * u + (i >> 1) * v;
        vec4 first = child(column, direction, fine), second = child(column + along, direction, fine);
        sum += dir[axis] > 0.0 ? first + (1.0 - first.a) * second : second + (1.0 - second.a) * first;
    }
    imageStore(dst, at, 0.25 * sum);
}
