#version 460
#extension GL_GOOGLE_include_directive : require
// Projects triangles along their dominant axis, without dilation (thesis, Section 4.1.1).
#include "params.glsl"
#include "voxels/project.glsl"

void main() {
    Projected t;
    if (!projectTriangle(volume.maps[rasterCascade()], t)) return;
    for (int i = 0; i < 3; i++) emit(t.clip[i], vec3(i == 0, i == 1, i == 2), t.along, t.corners);
    EndPrimitive();
}
