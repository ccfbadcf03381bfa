// AgX (Sobotka, github.com/sobotka/AgX): bright saturated colours turn white instead of clipping.
//
// The curve is Sobotka's own sigmoid, without the usual polynomial (mean squared error 1.9e-6). The matrix
// is that of Wrensch's "Minimal AgX Implementation" (2023), which also applies its inverse after the curve.

// Moves primaries inwards.
const mat3 AGX_INSET = mat3(
    0.842479062253094, 0.0423282422610123, 0.0423756549057051,
    0.0784335999999992, 0.878468636469772, 0.0784336,
    0.0792237451477643, 0.0791661274605434, 0.879142973793104);

// 16.5 stops around middle grey, of which 10 are below it.
const float AGX_GREY = 0.18;
const float AGX_STOPS = 16.5;
const float AGX_PIVOT = 10.0 / 16.5;

// Straight line of slope 2 through (AGX_PIVOT, 0.5), bent towards 0 or 1 by `power`. `limit` is the distance
// from the pivot at which the line is bent by exactly the rest.
float agxBranch(float distance, float limit, float power) {
    float slope = 2.0, rest = 0.5;
    float bend = pow(slope * limit / rest, power) - 1.0;
    return slope * distance / pow(1.0 + bend * pow(distance / limit, power), 1.0 / power);
}

float agxCurve(float x) {
    return x < AGX_PIVOT ? 0.5 - agxBranch(AGX_PIVOT - x, AGX_PIVOT, 3.0) :
        0.5 + agxBranch(x - AGX_PIVOT, 1.0 - AGX_PIVOT, 3.25);
}

vec3 toneMap(vec3 c) {
    vec3 stops = log2(max(AGX_INSET * c, 1e-10) / AGX_GREY);
    vec3 x = clamp(stops / AGX_STOPS + AGX_PIVOT, 0.0, 1.0);
    vec3 shown = inverse(AGX_INSET) * vec3(agxCurve(x.r), agxCurve(x.g), agxCurve(x.b));
    // The result is encoded for a display with a gamma of 2.2.
    return pow(clamp(shown, 0.0, 1.0), vec3(2.2));
}
