// A fragment of the compute rasteriser. voxels/pieces.glsl includes this after VoxelPiece.
#ifndef STORE_CELL_GLSL
#define STORE_CELL_GLSL

// Stores a triangle's fragment in a cell: the surface at the point closest to the cell centre, with a texture
// footprint of one cell.
void storeCell(VolumeMap map, VoxelPiece p, ivec3 cell) {
    if (!isFlat(map)) cell.x = (cell.x + params.voxel_dim) % params.voxel_dim;
    if (isReprojected(map, vec3(cell) + 0.5)) return;
    uvec2 t = triangles.list[p.triangle];
    Draw d = draws.draws[t.x];
    uvec3 vertex = uvec3(indices.indices[t.y], indices.indices[t.y + 1], indices.indices[t.y + 2]);
    vec3 a = toWorld(d.instance, loadPosition(vertex.x));
    vec3 e = toWorld(d.instance, loadPosition(vertex.y)) - a,
        f = toWorld(d.instance, loadPosition(vertex.z)) - a;
    vec3 face = cross(e, f),
        middle = volumeToWorld(map, (vec3(cell) + 0.5) / float(params.voxel_dim));
    float area = dot(face, face);
    mat2x3 weights = area > 0.0 ? mat2x3(cross(f, face) / area, cross(face, e) / area) : mat2x3(0.0);
    vec2 at = (middle - a) * weights;
    vec3 b = area > 0.0 ? max(vec3(1.0 - at.x - at.y, at), 0.0) : vec3(1.0);
    b /= b.x + b.y + b.z;

    VertexAttributes v[3] = VertexAttributes[3](loadAttributes(vertex.x), loadAttributes(vertex.y),
        loadAttributes(vertex.z));
    mat3 axes = cellAxes(map, middle);
    vec3 along = face * axes;
    int dominant = int(dominantAxis(along));
    int i = dominant == 0 ? 1 : 0,
        j = dominant == 2 ? 1 : 2;
    mat2x4 uv_of = mat2x4(v[1].uv - v[0].uv, v[2].uv - v[0].uv);
    float per = area > 0.0 ? 1.0 / along[dominant] : 0.0;
    Gradient g = Gradient(uv_of * ((axes[i] - axes[dominant] * (along[i] * per)) * weights),
        uv_of * ((axes[j] - axes[dominant] * (along[j] * per)) * weights));

    Material m = materials.materials[d.material];
    Interpolants here = Interpolants(mat3x4(v[0].uv, v[1].uv, v[2].uv) * b, vec4(1.0));
    if (isColored(m)) here.color = mat3x4(v[0].color, v[1].color, v[2].color) * b;
    vec4 base = baseColor(m, here, g);
    bool even = (!WARPED || CURVED) && map.curved == 0;
    // Where coverage masks are exact, the merge cuts out holes instead.
    if (base.a < (even ? min(m.alpha_cutoff, 0.01) : m.alpha_cutoff)) return;
    vec3 n = mat3(normalize(normalToWorld(d.instance, v[0].normal)),
        normalize(normalToWorld(d.instance, v[1].normal)),
        normalize(normalToWorld(d.instance, v[2].normal))) * b;
    // Face normal, oriented like the vertex normals. Mean vertex normals fit no plane, and a small ball would
    // be a quarter too bright.
    if (area > 0.0) n = face * (dot(face, n) < 0.0 ? -1.0 : 1.0);
    n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0);
    // Offset of the plane from the cell centre, along the axis that the surface faces.
    uint axis = axisOf(n);
    vec3 passes = vec3(cell) + 0.5;
    float slope = along[axis];
    passes[axis] += clamp(dot(face, a - middle) / (abs(slope) > 1e-30 ? slope : 1e-30), -0.5, 0.5);
    storeVoxel(cell, p.cascade, reflectanceOf(m, base.rgb, here, g), n, emission(m, here, g), passes,
        even ? t : NO_TRIANGLE);
}

#endif
