// The scene's triangles by number. Where several are seen at one depth the one with the largest number wins; numbers do not
// depend on the order in which a file lists its triangles.
#ifndef RASTER_TRIANGLES_GLSL
#define RASTER_TRIANGLES_GLSL

layout(std430) readonly buffer Triangles { uvec2 list[]; } triangles; // draw, first of its indices
layout(std430) readonly buffer Indices { uint indices[]; } indices;

#endif
