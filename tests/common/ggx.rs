//! The lobe of glTF 2.0 (Appendix B) by numerical integration, apart from every shader: D is integrated by its own
//! distribution function, and nothing is drawn at random.

use std::f64::consts::PI;

/// Shares `(a, b)` of a uniform sky that a lobe of one scattering reflects: `f0 * a + f90 * b`. `cosine` is that of the
/// viewer, in (0, 1]; alpha is the roughness squared.
pub fn directional_albedo(cosine: f64, roughness: f64) -> (f64, f64) {
    const STEPS: usize = 400;
    let a2 = roughness.powi(4);
    let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
    let lambda = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
    let (mut a, mut b) = (0.0, 0.0);
    for i in 0..STEPS {
        // Steps shrink towards grazing facets, where the integrand grows.
        let left = 1.0 - (i as f64 + 0.5) / STEPS as f64;
        let (u, width) = (1.0 - left.powi(3), 3.0 * left * left);
        let n_h = ((1.0 - u) / (1.0 + (a2 - 1.0) * u)).sqrt();
        let sine = (1.0 - n_h * n_h).sqrt();
        for j in 0..STEPS {
            let angle = PI * (j as f64 + 0.5) / STEPS as f64; // the other half is the same
            let h = [sine * angle.cos(), sine * angle.sin(), n_h];
            let v_h: f64 = (0..3).map(|k| view[k] * h[k]).sum();
            let n_l = 2.0 * v_h * n_h - cosine;
            if v_h <= 0.0 || n_l <= 0.0 {
                continue;
            }
            let visibility = 0.5 / (n_l * lambda(cosine) + cosine * lambda(n_l));
            let share = width * visibility * n_l * 4.0 * v_h / n_h;
            let fresnel = (1.0 - v_h).powi(5);
            a += share * (1.0 - fresnel);
            b += share * fresnel;
        }
    }
    let count = (STEPS * STEPS) as f64;
    (a / count, b / count)
}
