// Coverage of a fragment as the merge needs it, and the share of it that other surfaces of its side hide.
#ifndef FRAGMENT_LAYERS_GLSL
#define FRAGMENT_LAYERS_GLSL
#include "voxels/packing.glsl"
#include "surfels/cover.glsl"

// Surfaces farther beneath the front layer can be seen past its edges, as from one slat of a blind to the
// next [cells].
const float HIDDEN_DEPTH = 0.3;

// One fragment's surface, alone.
struct Layer {
    uint weight; // as of Coverage; 0 if nothing is left
    int covered[4]; // mask texels in each quarter of the cell, 0 to 16
    float offset; // from the cell centre, along the axis [cells]
};

Layer layerOf(Coverage coverage) {
    Layer layer;
    layer.weight = coverage.weight;
    for (uint i = 0; i < 4; i++) layer.covered[i] = coveredTexels(quarterOf(coverage.mask, i));
    layer.offset = coverage.offset;
    return layer;
}

uvec2 packLayer(Layer layer) {
    uint word = min(layer.weight, 0x7ffu);
    for (uint i = 0; i < 4; i++) word |= uint(layer.covered[i]) << 11 + 5 * i;
    return uvec2(word, floatBitsToUint(layer.offset));
}

Layer unpackLayer(uvec2 packed) {
    Layer layer;
    layer.weight = packed.x & 0x7ffu;
    for (uint i = 0; i < 4; i++) layer.covered[i] = int(packed.x >> 11 + 5 * i & 31u);
    layer.offset = uintBitsToFloat(packed.y);
    return layer;
}

// Weight of the part that the front layer does not hide. With the whole weight, the floor under tiles would
// reflect too.
// A layer and the front layer are taken to overlap as little as their areas allow: where they do not fill the
// quarter together, as two faces of a convex surface do not, nothing is hidden.
uint visibleWeight(Layer layer, uint front, uint side) {
    int covered = 0, hidden = 0;
    float offset = clamp(layer.offset, -0.5, 0.5); // front layers are stored as such
    for (uint i = 0; i < 4; i++) {
        FrontLayer before = frontLayerOf(front, side, i);
        float lift = side == 0 ? before.offset - offset : offset - before.offset;
        covered += layer.covered[i];
        if (lift > LAYER && lift < HIDDEN_DEPTH)
            hidden += max(layer.covered[i] + texelsOfFront(before) - 16, 0);
    }
    return layer.weight - layer.weight * uint(hidden) / uint(max(covered, 1));
}

#endif
