// Places the volume for this frame (thesis, Section 4.1). With VOLUME_FOLLOWS it reads the camera and last
// frame's volume, from which cells are reprojected. Without it neither is an input, so that passes can be
// skipped while they change.
#include "common/scene.glsl"
#include "volume/volume.glsl"
#include "voxels/voxels.glsl"
#include "modules/follow.glsl"

layout(local_size_x = 1) in;

#ifdef VOLUME_FOLLOWS
layout(std430) readonly buffer LastVolume {
    VolumeMap maps[MAX_CASCADES];
    uint signature;
} lastVolume;
#endif

// Coarsest level that cones read. If directions or cascades must not mix, the last level that halves evenly.
float coarsestLevel(bool moves) {
    int levels = params.even_levels != 0 ? findLSB(params.voxel_dim) : findMSB(params.voxel_dim);
    // A box that snaps to its coarsest level must not move in steps of half its own edge.
    if (moves && params.volume_snap == VOLUME_SNAP_LEVEL) levels = min(levels, findMSB(params.voxel_dim) - 2);
    return float(clamp(levels, 0, params.levels - 1));
}

// Box around the camera, moved in whole cells of a level. Steps of one voxel still change filtered levels.
VolumeMap boxAround(vec3 p, vec3 size, VolumeMap g) {
    g.size = size;
    g.cell = size / float(params.voxel_dim);
    g.last = coarsestLevel(true);
    if (params.volume_snap != VOLUME_SNAP_OFF) {
        vec3 unit = g.cell * (params.volume_snap == VOLUME_SNAP_LEVEL ? exp2(g.last) : 1.0);
        // Offset by half a cell: surfaces at round coordinates then cross the middle of cells instead of
        // following their borders, where rounding could change after each step.
        p = floor(p / unit + 0.5) * unit + 0.5 * g.cell;
    }
    g.minimum = p - 0.5 * size;
    return g;
}

// Sets the range of reprojected cells, which keep their content of the last frame. Empty if the volume does
// not scroll or if anything else has changed.
VolumeMap keep(VolumeMap g, VolumeMap last, bool still) {
    g.shift = g.history_from = g.history_to = ivec3(0);
    if (!still || g.curved != 0 || last.curved != 0 || any(notEqual(g.cell, last.cell))) return g;
    vec3 cells = (g.minimum - last.minimum) / g.cell;
    // Warped cells never coincide after a move.
    if (WARPED && !CURVED && cells != vec3(0.0)) return g;
    if (any(greaterThan(abs(cells), vec3(params.voxel_dim)))
        || any(greaterThan(abs(cells - round(cells)), vec3(1e-3)))) return g;
    g.shift = ivec3(round(cells));
    g.minimum = last.minimum + vec3(g.shift) * g.cell; // neglected fractions add up until they count
    g.history_from = max(ivec3(0), -g.shift);
    g.history_to = params.voxel_dim - max(ivec3(0), g.shift);
    return g;
}

bool sceneIsStill() {
    for (uint i = 0; i < sceneInfo.instance_count; i++)
        if (instances.instances[i].model != instances.instances[i].previous_model) return false;
    return true;
}

void main() {
    float dim = float(params.voxel_dim);
    VolumeMap g;
    g.curved = 0;
    g.eye = g.seen_from = g.axis_x = g.axis_y = g.axis_z = vec3(0.0);
    g.range = vec2(0.0);
    g.shift = g.history_from = g.history_to = ivec3(0);
    g.last = coarsestLevel(false);
#ifdef VOLUME_FOLLOWS
    vec3 position = followedPosition();
    g.eye = g.seen_from = position;
    aimCurved(g);
#endif

    // The last cascade is the volume itself.
    VolumeMap whole = g;
    whole.size = params.volume_size;
    vec3 center = params.volume_center;
    if (params.volume == VOLUME_SCENE) {
        // The smallest cube around the scene plus 2.5 voxels on each side. The outermost faces then cross the
        // middle of cells instead of following their borders, where rounding would decide.
        vec3 extent = sceneInfo.bounds_max - sceneInfo.bounds_min;
        center = 0.5 * (sceneInfo.bounds_min + sceneInfo.bounds_max);
        whole.size = vec3(max(max(extent.x, max(extent.y, extent.z)), 1e-3) * dim / (dim - 5.0));
    }
    whole.cell = whole.size / dim;
    whole.minimum = center - 0.5 * whole.size;
    volume.signature = params.voxel_signature;
#ifdef VOLUME_FOLLOWS
    if (params.volume == VOLUME_CAMERA) whole = boxAround(position, whole.size, g);
    // Scrolling needs the same settings, no overflow and no moving instance.
    bool still = SCROLLS && lastVolume.signature == params.voxel_signature && voxelCounter.overflow == 0
        && sceneIsStill();
    for (int k = 0; k < CASCADE_COUNT; k++) {
        VolumeMap map = whole;
        if (k < CASCADE_COUNT - 1) {
            vec3 size = whole.size * pow(params.cascade_step, float(k - CASCADE_COUNT + 1));
            vec3 middle = position + params.volume_ahead * size * camera.direction;
            // Boxes stay inside the scene's volume: beyond it they would be wasted.
            if (params.volume == VOLUME_SCENE)
                middle = clamp(middle, whole.minimum + 0.5 * size, whole.minimum + whole.size - 0.5 * size);
            map = boxAround(middle, size, g);
        }
        if (CURVED && k == 0) {
            map = g;
            map.curved = 1;
            map.size = whole.size;
            map.cell = whole.cell;
            map.minimum = whole.minimum;
            map.eye = curvedEye(position, whole.cell);
        }
        volume.maps[k] = keep(map, lastVolume.maps[k], still);
    }
#else
    volume.maps[0] = whole;
#endif
}
