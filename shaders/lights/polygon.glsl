// Integrals over rectangles and discs, a disc as a polygon of equal area (Lambert 1760; Heitz et al. 2016,
// "Real-Time Polygonal-Light Shading with Linearly Transformed Cosines").
#ifndef POLYGON_GLSL
#define POLYGON_GLSL
#include "lights/lights.glsl"

const int DISC_CORNERS = 16;
const float DISC_REACH = 1.013031; // of the corners [radii], for a polygon with the area of the disc

vec3 areaCorner(Light light, int i) {
    if (light.kind == LIGHT_RECTANGLE)
        return light.position + (i < 2 ? light.top : -light.top)
            + (i == 0 || i == 3 ? light.side : -light.side);
    float angle = 2.0 * PI / float(DISC_CORNERS) * float(i);
    return light.position + DISC_REACH * (cos(angle) * light.side + sin(angle) * light.top);
}

vec3 unit(vec3 v) {
    return v * inversesqrt(max(dot(v, v), 1e-30));
}

// The angle between a and b, along the normal of both.
vec3 edgeVector(vec3 a, vec3 b) {
    vec3 x = unit(a), n = cross(x, b - a); // of two unit vectors, it would be rounded away far from the light
    float sine = length(n);
    return sine > 0.0 ? n * (atan(sine, dot(x, b)) / sine) : vec3(0.0);
}

// Form factor of a light at p as a vector: its component along a normal is the share of the cosine-weighted
// hemisphere that the light covers. What lies below the horizon of n is cut off; n = 0: no horizon.
// Directions from p, and n, are in the space that `space` maps the world to. p is in front of the light.
vec3 formVector(Light light, vec3 p, mat3 space, vec3 n) {
    int count = light.kind == LIGHT_RECTANGLE ? 4 : DISC_CORNERS;
    vec3 sum = vec3(0.0), left = vec3(0.0), entered = vec3(0.0);
    vec3 first = space * (areaCorner(light, 0) - p), a = first;
    float height = dot(a, n);
    for (int i = 1; i <= count; i++) {
        vec3 b = i < count ? space * (areaCorner(light, i) - p) : first;
        float next = dot(b, n);
        if (height >= 0.0 || next >= 0.0) {
            bool enters = height < 0.0, leaves = next < 0.0;
            vec3 cut = enters || leaves ? a + (b - a) * (height / (height - next)) : a;
            if (enters) entered = cut;
            if (leaves) left = cut;
            sum += edgeVector(enters ? cut : a, leaves ? cut : b);
        }
        a = b;
        height = next;
    }
    if (left != vec3(0.0)) sum += edgeVector(left, entered); // along the horizon
    return sum / (2.0 * PI);
}

bool isInFront(Light light, vec3 p) {
    return dot(p - light.position, light.direction) > 0.0;
}

// Light that arrives at p above the horizon of n. Without AREA_LIGHTS, rectangles and discs count as points,
// which costs less than a loop over edges.
Incident arrivingLight(Light light, vec3 p, vec3 n) {
#ifdef AREA_LIGHTS
    if (isArea(light)) {
        vec3 form = isInFront(light, p) ? formVector(light, p, mat3(1.0), n) : vec3(0.0);
        return Incident(unit(form), light.color * (PI * length(form)));
    }
#endif
    return incidentLight(light, p);
}

#endif
