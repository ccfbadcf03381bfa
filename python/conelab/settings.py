"""Settings with their types, made by `python -m conelab.stubs`: parameters of all graphs."""

from __future__ import annotations

from typing import Any, Literal, TypedDict

from .ron import Camera

Vector2 = tuple[float, float]
Vector3 = tuple[float, float, float]
Vector4 = tuple[float, float, float, float]


class Parameters(TypedDict, total=False):
    """Parameters by name, as keywords."""

    accumulation_rounds: int
    bias: float
    bounce_directions: int
    bounce_emitter_rays: int
    bounce_frames: int
    bounces: Literal["all", "one"]
    cascades: int
    cone_count: int
    cone_height: float
    conservative: Literal["msaa", "off", "hardware", "dilate"]
    density: Literal["off", "surfaces", "voxels"]
    density_axis: int
    diffuse_aperture: float
    diffuse_steps: int
    emitter_rays: int
    exact_rays: int
    exposure: float
    fallback: bool
    first_sample: int
    fragment_capacity: int
    gather_frames: int
    gather_rest: int
    gbuffer: Literal["auto", "compute", "raster"]
    injection_exposure: float
    learning: int
    light_bias: float
    lobe_share: float
    lod_offset: float
    lpv_blocking: Literal["on", "off"]
    lpv_cascades: int
    lpv_dim: int
    lpv_steps: int
    merge: Literal["running_average", "average", "maximum"]
    mips: Literal["anisotropic", "isotropic"]
    opacity: Literal["coverage", "layers", "cell"]
    pixel: Literal["centre", "box"]
    pixel_rays: int
    probe: Vector2
    probe_bias: float
    probe_hysteresis: float
    probe_moves: Literal["on", "off"]
    probe_rays: int
    probe_rows: int
    radiance_format: Literal["rgba16f", "rgba8"]
    ray_bias: float
    reflections: Literal["ambient", "none"]
    rsm_dim: int
    rsm_radius: float
    rsm_samples: int
    rsm_spacing: int
    samples: int
    screen_miss: Literal["sky", "dark"]
    seed: int
    shading_model: Literal["gltf", "single_scattering", "cook_torrance", "blinn_phong"]
    shadow_bias: float
    shadow_dim: int
    shadow_filter: Literal["nearest", "pcf3", "pcf5"]
    shadow_map: Literal["auto", "compute", "raster"]
    shadow_maps: int
    slice: Vector2
    specular_steps: int
    ssgi_radius: float
    ssgi_slices: int
    ssgi_steps: int
    ssgi_thickness: float
    stop_transmittance: float
    temporal_cut: float
    temporal_factor: float
    tess_levels: Literal["thesis", "longest_edge"]
    tess_rate: float
    tone_map: Literal["reinhard", "aces", "agx", "pbr_neutral", "none"]
    trace: Literal["cones", "cone_rays", "lobe_rays"]
    triangle_rays: Literal["none", "mirrors", "all"]
    view: Literal["shaded", "direct", "diffuse", "specular", "occlusion", "normal", "depth", "voxels"]
    volume: Literal["scene", "box", "camera"]
    volume_ahead: float
    volume_center: Vector3
    volume_offset: Vector3
    volume_scroll: bool
    volume_size: Vector3
    volume_snap: Literal["off", "voxel", "level"]
    volume_turn: float
    voxel_capacity: int
    voxel_dim: int
    voxel_mips: int
    voxel_view: Literal["radiance", "color", "normal", "alpha"]
    voxel_view_cascade: int
    voxel_view_mip: int
    voxelizer: Literal["auto", "compute", "raster", "tessellated"]
    warp: Literal["none", "spline", "logistic", "perspective", "spherical"]
    warp_alpha: float
    warp_far: float
    warp_near: float
    warp_steepness: float
    warp_viewport: Literal["scaled", "grid"]

class Settings(Parameters, total=False):
    """Settings of an experiment: fields, and parameters of its graph."""

    graph: str
    """File of the graph."""
    scene: Any
    """A built-in scene's name, or a file."""
    camera: str | Camera
    """A camera of the scene, or one in numbers."""
    size: tuple[int, int]
    """Width and height, pixels."""
    time: float
    """Time of the animation, s."""
    sky: Vector3
    """Radiance of the sky."""
    environment: dict[str, Any]
    """Changes of the sky's picture: file, rotation (degrees), intensity."""
    lights: dict[str, dict[str, Any]]
    """Changes of the scene's lights, by name."""
    off: list[str]
    """Passes that are left out."""


class Attributes:
    """Parameters as attributes of `Experiment.params`, with their defaults and ranges."""

    accumulation_rounds: int
    """Averages N rounds of gathering, each with new directions, once light has converged and while the scene stands still. 1 repeats the same directions: no more frames change the picture (32 rounds, 1 to 32)."""
    bias: float
    """Start of cones above the surface. Below 1 surfaces shadow themselves; above 1 contact shadows fade (1.0 voxels, 0 to 8)."""
    bounce_directions: int
    """Directions from which a surfel gathers light; its neighbours use others. Fewer add bias and mottling; cost is proportional (8 directions, 1 to 64)."""
    bounce_emitter_rays: int
    """Rays of a surfel to points on emitting surfaces. At 0 only the other rays hit emitters, which is noisy (4 rays, 0 to 32)."""
    bounce_frames: int
    """Spreads the gathering of surfels over N frames: each frame costs 1/N, but bounced light lags by N frames (16 frames, 1 to 64)."""
    bounces: Literal["all", "one"]
    """Light that surfels reflect to each other (all)."""
    cascades: int
    """Number of nested boxes. Each has half the edge of the next one, and the last is the whole volume. Memory and voxelization time grow with the number. 0: as many as make the finest box 2.5 times as wide as the scene's camera sees (0 boxes, 0 to 5)."""
    cone_count: int
    """Diffuse cones that a pixel traces when it gathers; a block of 8x8 pixels has 64 times as many. Fewer add noise; cost is proportional (5 cones, 1 to 64)."""
    cone_height: float
    """Distance of the first sample along the cone (1.0 voxels, 0.05 to 8)."""
    conservative: Literal["msaa", "off", "hardware", "dilate"]
    """Coverage of the rasteriser (dilate)."""
    density: Literal["off", "surfaces", "voxels"]
    """Colours the picture by the density of cells: red below 0.5, green at 1, blue from 2 (off)."""
    density_axis: int
    """Axis along which density counts under a warp function: 0 x, 1 y, 2 z (0, 0 to 2)."""
    diffuse_aperture: float
    """Full angle of a diffuse cone. 0: 6 degrees in cones.ron, 45 in thesis.ron. Wider cones are blurrier and accumulate occlusion along walls; narrower ones take more samples. In cones.ron a cone is an exact ray while it is thinner than 2^-lod_offset voxels: on coarse grids small apertures give the same picture (0.0 deg, 0 to 120)."""
    diffuse_steps: int
    """Maximum samples of a diffuse cone, and of a specular one in cones.ron. A cone normally ends earlier, at the border of the volume or when it is blocked (256 samples, 1 to 512)."""
    emitter_rays: int
    """Rays of a pixel to points on emitting surfaces, chosen by their power. At 0 only the cones see emitters, which blurs their shadows (2 rays, 0 to 32)."""
    exact_rays: int
    """Rays in each cone or lobe. Noise falls as the square root of their number (64 rays, 1 to 4096)."""
    exposure: float
    """Multiplies radiance by 2^exposure before the tone map (0.0 stops, -10 to 10)."""
    fallback: bool
    """Perspective and spherical warp: a second, uniform grid of the same resolution serves lookups outside. If off, nothing outside contributes light (True)."""
    first_sample: int
    """Index of the frame's first sample. An index always gives the same path (0, 0 to 1e+09)."""
    fragment_capacity: int
    """Upper limit of fragments before merging, 24 bytes each; small grids and scenes allocate less. A frame that needs more drops voxels and prints a warning (8000000 fragments, 10000 to 6.4e+07)."""
    gather_frames: int
    """Spreads gathering over N frames: N times cheaper, but moving light lags by up to N frames. 1: every pixel gathers in every frame (16 frames, 1 to 64)."""
    gather_rest: int
    """Under a moving camera, gathers 1/N as often once the light of the voxels has converged. Pixels with sharp reflections gather more often. 1 disables the saving (4 times, 1 to 8)."""
    gbuffer: Literal["auto", "compute", "raster"]
    """Rasteriser of the visible triangles (auto)."""
    injection_exposure: float
    """Radiance of a texel value of 1, because injection writes base colours whatever the lights emit. 0: E / pi for the brightest sun of irradiance E, which was 1 in the published program; 1 without a sun (0.0, 0 to 1e+06)."""
    learning: int
    """Paths per pixel that learn where light comes from, before the first sample; the first one sets the scale. They change the noise and not the mean. 0 and 1: no learning (8 samples/pixel, 0 to 64)."""
    light_bias: float
    """Distance from a surfel to the point whose shadow is looked up. Lower values let rough surfaces shadow themselves; higher ones let light past thin walls (0.1 voxels, 0 to 1)."""
    lobe_share: float
    """Specular rays of a mirror, as a multiple of pixel_rays. Other surfaces trace the share of light that their lobe reflects, at least one ray; 0 traces one (1.0, 0 to 8)."""
    lod_offset: float
    """Added to the level of detail. Lower values read finer levels, with more samples; above 0 cones blur (-2.0 levels, -4 to 4)."""
    lpv_blocking: Literal["on", "off"]
    """Whether surfaces block light between cells (on)."""
    lpv_cascades: int
    """Nested grids; pixels read the finest one around them. The first is around the whole scene, each other one has half the edge and follows the camera. Light of a fine grid does not reach far: see lpv_steps (1 grids, 1 to 5)."""
    lpv_dim: int
    """Edge of each grid; memory and time grow with its cube, and light needs as many more steps (32 cells, 8 to 64)."""
    lpv_steps: int
    """Times that the cells of a grid pass their light on; as many cells far does it reach. Light spreads and loses its direction with each step (32 steps, 1 to 128)."""
    merge: Literal["running_average", "average", "maximum"]
    """How fragments in one cell become one voxel (running_average)."""
    mips: Literal["anisotropic", "isotropic"]
    """Filtered levels of radiance (anisotropic)."""
    opacity: Literal["coverage", "layers", "cell"]
    """Opacity that a step adds to a cone (coverage)."""
    pixel: Literal["centre", "box"]
    """Where a pixel samples the scene (centre)."""
    pixel_rays: int
    """Rays that a pixel traces when it gathers. 8x8 pixels share 64 patterns, so noise falls as the square root of this number; cost is proportional (11 rays, 1 to 64)."""
    probe: Vector2
    """Pixel with its cones drawn, from the top left corner. Click on the picture to set it; Esc clears it. Negative: none ((-1.0, -1.0) pixels, -1 to 16384)."""
    probe_bias: float
    """Distance from the surface to the point that looks up probes, as a share of 0.75 of their spacing. Low values shadow surfaces by themselves, high ones leak (0.3, 0 to 2)."""
    probe_hysteresis: float
    """Share of the last frame's light that a probe keeps. Low values flicker, high ones let light lag (0.97, 0 to 0.999)."""
    probe_moves: Literal["on", "off"]
    """Whether probes move out of walls and away from surfaces, by less than half their spacing (on)."""
    probe_rays: int
    """Rays of a probe in each frame, in directions that turn from frame to frame; cost is proportional (128 rays, 16 to 256)."""
    probe_rows: int
    """Probes along the longest edge of the scene. Few let light pass through walls and blur corners; cost grows with the cube (24 probes, 2 to 40)."""
    radiance_format: Literal["rgba16f", "rgba8"]
    """Format of the radiance texture (rgba8)."""
    ray_bias: float
    """Start of a ray above the surface. Lower values let a surface hit itself, higher ones miss contacts (0.05 voxels, 0 to 1)."""
    reflections: Literal["ambient", "none"]
    """Indirect light of the specular lobe, which methods for diffuse light do not trace (ambient)."""
    rsm_dim: int
    """Edge of a map of one view of a light; memory and fill cost grow with its square. Small ones miss small lit places (512 texels, 64 to 4096)."""
    rsm_radius: float
    """Radius of the points around a pixel's place in the map of a directional or spot light. Light from beyond is lost. Maps of other lights are sampled as a whole (0.3 maps, 0.01 to 1.5)."""
    rsm_samples: int
    """Points of a light's maps that a pixel gathers from; all pixels use one pattern. Few points show as copies of the lit shapes; cost is proportional (400 points, 8 to 4096)."""
    rsm_spacing: int
    """Distance of the pixels that gather first. The others interpolate between four of them that see the same surface, or gather too. 1: every pixel gathers (4 pixels, 1 to 16)."""
    samples: int
    """Samples per pixel and frame. Noise falls at least as the square root of their number (16 samples/pixel, 1 to 4096)."""
    screen_miss: Literal["sky", "dark"]
    """Light of directions that meet nothing in the picture (sky)."""
    seed: int
    """Seed of the random numbers (1, 0 to 1e+09)."""
    shading_model: Literal["gltf", "single_scattering", "cook_torrance", "blinn_phong"]
    """BRDF of surfaces (gltf)."""
    shadow_bias: float
    """Offset of the lookup above the surface. Lower values show acne, higher ones detach shadows (0.03 texels, 0 to 10)."""
    shadow_dim: int
    """Edge of each shadow map; memory and fill cost grow with its square (4096 texels, 256 to 8192)."""
    shadow_filter: Literal["nearest", "pcf3", "pcf5"]
    """Taps of a shadow lookup. The thesis graph blends four texels for each tap (nearest)."""
    shadow_map: Literal["auto", "compute", "raster"]
    """Rasteriser of the shadow maps (auto)."""
    shadow_maps: int
    """Maps of a directional light: one of the whole scene, the others around the camera, each finer than the last. 0: chosen by the size of the scene; one in most scenes (0 maps, 0 to 4)."""
    slice: Vector2
    """Slice of the volume that is drawn over the picture: axis (0 to 2) and position (0 to 1, along z through all cascades). Inspect > Show in the picture sets it. Negative: none ((-1.0, -1.0), -1 to 2)."""
    specular_steps: int
    """Maximum samples of a specular cone. Too few cut off sharp reflections near the surface (32 samples, 1 to 1024)."""
    ssgi_radius: float
    """Length of a side of a slice, in heights of the picture (1.0 heights, 0.01 to 4)."""
    ssgi_slices: int
    """Slices through the hemisphere of each pixel, two sides each; a block of 8x8 pixels has 64 times as many. Noise falls with their number; cost is proportional (2 slices, 1 to 32)."""
    ssgi_steps: int
    """Pixels that a side of a slice looks at, denser near its start. Few miss small or distant surfaces (12 samples, 1 to 128)."""
    ssgi_thickness: float
    """Assumed thickness of surfaces, as a share of their distance from the camera. Lower values leave gaps between samples, higher ones block light behind objects (0.1 distances, 0.001 to 10)."""
    stop_transmittance: float
    """A cone ends when its transmittance falls below this (0.05, 0.001 to 0.5)."""
    temporal_cut: float
    """A camera that moves farther in one frame discards the history (1.0 m, 0 to 1000)."""
    temporal_factor: float
    """Share of last frame's radiance; 0.8 takes 14 frames to 95 % of a change (0.8, 0 to 0.99)."""
    tess_levels: Literal["thesis", "longest_edge"]
    """Inner tessellation level (thesis)."""
    tess_rate: float
    """Points per cell along an edge. More fill holes; cost is quadratic (1.0 points/voxel, 0.25 to 4)."""
    tone_map: Literal["reinhard", "aces", "agx", "pbr_neutral", "none"]
    """Curve from radiance to the picture (reinhard)."""
    trace: Literal["cones", "cone_rays", "lobe_rays"]
    """Cones, or rays that measure the error of cones and are many times slower (cones)."""
    triangle_rays: Literal["none", "mirrors", "all"]
    """Rays of pixels that hit the scene's triangles instead of its voxels. They show objects thinner than a voxel, and take several times as long in large scenes (none)."""
    view: Literal["shaded", "direct", "diffuse", "specular", "occlusion", "normal", "depth", "voxels"]
    """Light component or inspection that the picture shows. Passes that it does not need are skipped (shaded)."""
    volume: Literal["scene", "box", "camera"]
    """Position of the volume (scene)."""
    volume_ahead: float
    """Share of a box's edge by which its centre is ahead of the camera (0.25, 0 to 0.5)."""
    volume_center: Vector3
    """Centre of the fixed box ((0.0, 0.0, 0.0) m, -1000 to 1000)."""
    volume_offset: Vector3
    """Offset of a volume from the camera that it follows. Moves voxels while the view stays the same ((0.0, 0.0, 0.0) m, -1000 to 1000)."""
    volume_scroll: bool
    """Reuses the voxels of a box that follows the camera: in a static scene, only newly covered cells are voxelized (False)."""
    volume_size: Vector3
    """Edge lengths of the box; cells need not be cubes ((32.0, 32.0, 32.0) m, 0.1 to 1000)."""
    volume_snap: Literal["off", "voxel", "level"]
    """Step size of a box that follows the camera (level)."""
    volume_turn: float
    """Turns a grid in the view frustum to the left while the view stays the same (0.0 deg, -360 to 360)."""
    voxel_capacity: int
    """Maximum number of surfels, 245 bytes each (65 in the thesis graph). Cells with surfaces along several axes need two or three. A frame that needs more drops voxels and prints a warning (1000000 voxels, 10000 to 5e+06)."""
    voxel_dim: int
    """Edge of the volume; memory grows with its cube. Anisotropic mips need one factor of two per level (160 voxels, 16 to 512)."""
    voxel_mips: int
    """Mip levels of the radiance texture. Too few under-filter wide cones (6 levels, 1 to 10)."""
    voxel_view: Literal["radiance", "color", "normal", "alpha"]
    """Quantity that colours the cubes of the voxel view (radiance)."""
    voxel_view_cascade: int
    """Cascade that the voxel view and the voxel oracle read; 0 is the finest (0, 0 to 5)."""
    voxel_view_mip: int
    """Level of the cubes in the voxel view, at most the coarsest. With anisotropic mips each face of a cube shows the radiance seen from that side; colour and normal are means over the cell (0 level, 0 to 9)."""
    voxelizer: Literal["auto", "compute", "raster", "tessellated"]
    """How triangles become voxels (auto)."""
    warp: Literal["none", "spline", "logistic", "perspective", "spherical"]
    """Distribution of the cells (spline)."""
    warp_alpha: float
    """Spline and logistic warp: density of cells at the borders, relative to a uniform grid. 1 is uniform; lower values move cells to the middle and cost voxelization time (1.0, 0.05 to 1)."""
    warp_far: float
    """Perspective and spherical warp: distance at which the cells end. A uniform grid serves lookups beyond (30.0 m, 0.2 to 1000)."""
    warp_near: float
    """Perspective and spherical warp: distance of the nearest cells. Small distances split triangles into many pieces, which costs time (0.5 m, 0.01 to 100)."""
    warp_steepness: float
    """Logistic warp: higher values move cells to the middle and leave almost none at the borders (8.0, 0.5 to 20)."""
    warp_viewport: Literal["scaled", "grid"]
    """Pixels that the rasteriser draws under a warp function. Hardware and dilated coverage need no more than grid (scaled)."""
