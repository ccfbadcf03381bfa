// Reflectance of dielectrics by index: rgb at normal incidence, a at grazing angles. Nearly all use index 0.
// Materials and the G-buffer store the index, because the G-buffer has no room for the colour.
#ifndef DIELECTRICS_GLSL
#define DIELECTRICS_GLSL

layout(std430) readonly buffer Dielectrics { vec4 list[]; } dielectrics;

#endif
