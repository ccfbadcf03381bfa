// A ray through cells of one size: crossings are exact (Amanatides and Woo 1987). Every voxel that the ray crosses hides as
// much of it as its opacity says for the length inside. Returns radiance premultiplied by opacity, and opacity.
vec4 traceVoxels(vec3 origin, vec3 d) {
    VolumeMap map = volume.maps[0];
    vec3 color = vec3(0.0);
    float through = 1.0;
    int dim = params.voxel_dim;
    vec3 at = (origin - map.minimum) / map.cell;
    vec3 speed = d / map.cell; // cells a metre
    ivec3 cell = ivec3(floor(at));
    ivec3 forward = ivec3(sign(speed));
    vec3 advance = 1.0 / max(abs(speed), 1e-20);
    vec3 next = (mix(at - vec3(cell), vec3(cell) + 1.0 - at, greaterThan(speed, vec3(0.0)))) * advance;
    float s = 0.0, per_cell = length(speed);
    for (int i = 0; i < 3 * dim && inGrid(cell); i++) {
        int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        vec4 texel = texelFetch(voxelRadiance, cell, 0);
        if (texel.a > 1e-5) {
            float a = through * (1.0 - pow(1.0 - min(texel.a, 1.0), (next[axis] - s) * per_cell));
            color += texel.rgb * (a / texel.a);
            through -= a;
            if (through < 1e-3) break;
        }
        s = next[axis];
        next[axis] += advance[axis];
        cell[axis] += forward[axis];
    }
    return vec4(color, 1.0 - through);
}
