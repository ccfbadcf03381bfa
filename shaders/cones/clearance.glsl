// The level that a cone may read near the surface that it leaves.
#ifndef CONE_CLEARANCE_GLSL
#define CONE_CLEARANCE_GLSL

// A level, made not so coarse that it reads the surface which the cone leaves. `height` above its plane, `reach` of a cell across
// it [m]. A trilinear lookup reads 1.5 cells to each side. Coarser levels than fit above the surface would read the surface
// itself, and an open plane would shadow itself. Whole levels, because a fraction would blend in the coarser one.
float clearLevel(float level, float height, float reach, float last) {
    level = min(level, floor(log2(max(height / (3.0 * reach), 1.0)) + 1e-3));
    return clamp(level, 0.0, last);
}

#endif
