// What escapes a cone sees the sky.
vec3 coneRadiance(vec4 cone) {
    return cone.rgb + (1.0 - cone.a) * sceneInfo.sky;
}
