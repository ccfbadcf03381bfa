// A ray that is not straight in cells, or crosses cascades: followed in quarters of a cell. Every voxel on the way hides as
// much of it as its opacity says for the length inside. Returns radiance premultiplied by opacity, and opacity.
vec4 traceVoxels(ConeOrigin o, vec3 d, RayUse use) {
    vec3 origin = o.position;
    vec3 color = vec3(0.0);
    float through = 1.0, s = 0.0;
    int dim = params.voxel_dim;
    for (int i = 0; i < 16 * dim && s < use.range; i++) {
        vec3 p = origin + s * d;
        int cascade = cascadeAt(p);
        vec3 u = worldToVolume(volume.maps[cascade], p);
        if (!inVolume(u)) break;
        float cell;
        vec3 direction;
        cellAlong(volume.maps[cascade], p, d, cell, direction);
        vec4 texel = texelAlong(storedCell(min(ivec3(u * float(dim)), ivec3(dim - 1)), cascade), direction);
        if (texel.a > 1e-5) {
            float a = min(0.25 * texel.a, through);
            color += texel.rgb * (a / texel.a);
            through -= a;
            if (through < 1e-3) break;
        }
        s += 0.25 * cell;
    }
    return vec4(color, 1.0 - through);
}
