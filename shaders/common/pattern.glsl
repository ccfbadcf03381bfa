// Points and patterns that are the same in every run.
#ifndef PATTERN_GLSL
#define PATTERN_GLSL

// Point i of an additive recurrence that fills the square evenly (Roberts 2018, R2).
vec2 evenPoint(uint i) {
    return fract(vec2(0.5) + float(i) * vec2(0.7548776662, 0.5698402910));
}

#endif
