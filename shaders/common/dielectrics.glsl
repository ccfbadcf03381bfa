// What surfaces reflect that are no metals, by number: rgb at normal incidence, a at grazing angles. 0 is nearly all of them. A
// material names its number, and so does the G-buffer: there is no room for the colour itself.
#ifndef DIELECTRICS_GLSL
#define DIELECTRICS_GLSL

layout(std430) readonly buffer Dielectrics { vec4 list[]; } dielectrics;

#endif
