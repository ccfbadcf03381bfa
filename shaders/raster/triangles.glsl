// The scene's triangles by index. At equal depth the largest index wins. Indices do not depend on the order
// of triangles in a file.
#ifndef RASTER_TRIANGLES_GLSL
#define RASTER_TRIANGLES_GLSL

layout(std430) readonly buffer Triangles { uvec2 list[]; } triangles; // draw, first index
layout(std430) readonly buffer Indices { uint indices[]; } indices;

#endif
