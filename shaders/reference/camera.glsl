// Rays of the camera through a place on the screen (pixels), from the rasteriser's near plane.
Ray cameraRay(vec2 at) {
    vec2 q = (2.0 * at / vec2(camera.size) - 1.0) * tan(0.5 * camera.fov_y);
    vec3 right = cross(camera.direction, camera.up);
    vec3 d = normalize(camera.direction + q.x * float(camera.size.x) / float(camera.size.y) * right
        - q.y * camera.up);
    return Ray(camera.position + d * (camera.near / dot(d, camera.direction)), d, 1e30);
}
