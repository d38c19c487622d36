// Draws meshes in sun, shadow and fog, and the sky behind them. Colours are linear; the target is sRGB.

struct Globals {
    // View space is world space relative to the eye, without rotation.
    clip_from_view: mat4x4f,
    view_from_clip: mat4x4f,
    shadow_from_view: mat4x4f,
    to_sun: vec4f,
    // The share of light that a metre of air absorbs; the size of a texel of the shadow map, as a share of the map's
    // side; two unused numbers.
    air: vec4f,
}

struct Instance {
    view_from_model: mat4x4f,
}

@group(0) @binding(0) var<uniform> globals: Globals;
@group(0) @binding(1) var<storage, read> instances: array<Instance>;
@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

// Light of the sun. Above 1, since tone mapping compresses it.
const SUN = vec3f(4.2, 3.5, 2.6);
// Colour of the sky overhead.
const ZENITH = vec3f(0.14, 0.28, 0.60);
// Colour of the sky at the horizon.
const HORIZON = vec3f(0.80, 0.74, 0.62);
// Texels of the shadow map by which a face is lifted for its test. With less, the face shows bands of its own shadow.
const LIFT = 3.0;

// Texels by which a round face is also lifted along its smooth normal.
const LIFT_ROUND = 2.0;

// Cosines of the angle between a face and its smooth normal. At the first (37 degrees) the face counts as flat, at the
// second (18 degrees) as part of a round shape. Balls and capsules of two dozen sides have angles up to 15 degrees.
const ROUND = vec2f(0.80, 0.95);

// Cosines of the angle to the sun: at the second, a face of a round shape is fully lit, at the first it is dark.
const TURNED = vec2f(-0.3, -0.1);

// Light from below, reflected by the ground.
const BOUNCE = vec3f(0.13, 0.12, 0.08);

struct Vertex {
    @location(0) position: vec4f,
    @location(1) normal: vec4f,
    @location(2) rest: vec4f,
    @location(3) color: vec4f,
}

struct Seen {
    @builtin(position) clip: vec4f,
    @location(0) view: vec3f,
    @location(1) normal: vec3f,
    @location(2) rest: vec3f,
    @location(3) color: vec3f,
    @location(4) @interpolate(flat) look: f32,
}

@vertex
fn vertex(in: Vertex, @builtin(instance_index) index: u32) -> Seen {
    let model = instances[index].view_from_model;
    let view = model * vec4f(in.position.xyz, 1.0);
    var out: Seen;
    out.clip = globals.clip_from_view * view;
    out.view = view.xyz;
    out.normal = (model * vec4f(in.normal.xyz, 0.0)).xyz;
    out.rest = in.rest.xyz;
    out.color = in.color.rgb;
    out.look = in.color.a;
    return out;
}

@vertex
fn shadow_vertex(in: Vertex, @builtin(instance_index) index: u32) -> @builtin(position) vec4f {
    let view = instances[index].view_from_model * vec4f(in.position.xyz, 1.0);
    return globals.shadow_from_view * view;
}

fn hash(p: vec3f) -> f32 {
    var q = fract(p * vec3f(0.1031, 0.1030, 0.0973));
    q += dot(q, q.yxz + 33.33);
    return fract((q.x + q.y) * q.z);
}

// Smooth noise between 0 and 1.
fn noise(p: vec3f) -> f32 {
    let cell = floor(p);
    let f = fract(p);
    let u = f * f * (3.0 - 2.0 * f);
    let near = mix(
        mix(hash(cell), hash(cell + vec3f(1.0, 0.0, 0.0)), u.x),
        mix(hash(cell + vec3f(0.0, 1.0, 0.0)), hash(cell + vec3f(1.0, 1.0, 0.0)), u.x),
        u.y,
    );
    let far = mix(
        mix(hash(cell + vec3f(0.0, 0.0, 1.0)), hash(cell + vec3f(1.0, 0.0, 1.0)), u.x),
        mix(hash(cell + vec3f(0.0, 1.0, 1.0)), hash(cell + vec3f(1.0, 1.0, 1.0)), u.x),
        u.y,
    );
    return mix(near, far, u.z);
}

// The share of sunlight that reaches a point of a flat face: the mean over 3 x 3 texels around it.
//
// These texels and their filter reach 2 sqrt(2) texels to the side. There, the face is nearer to the sun by that length
// times the tangent of its slope. So the point is lifted along the face's normal by that length times the sine of the
// slope, in front of all these texels. A face of a round shape is lifted along its smooth normal as well, out of the
// shadow of the next face where the shape turns away. On fur, face and smooth normal are hardly related.
fn sunlit(view: vec3f, face: vec3f, smooth_normal: vec3f) -> f32 {
    let facing = dot(face, globals.to_sun.xyz);
    let slope = sqrt(max(1.0 - facing * facing, 0.0));
    let round = smoothstep(ROUND.x, ROUND.y, dot(face, smooth_normal));
    // A flat face that is turned away from the sun is dark, independent of its smooth normal.
    let flat = smoothstep(0.0, 0.1, facing);
    let turned = mix(flat, smoothstep(TURNED.x, TURNED.y, facing), round);
    if (turned <= 0.0) {
        return 0.0;
    }
    let across = vec3f(globals.shadow_from_view[0].x, globals.shadow_from_view[1].x, globals.shadow_from_view[2].x);
    let texel = 2.0 * globals.air.y / length(across);
    let lift = (face * (LIFT * slope) + smooth_normal * (LIFT_ROUND * round)) * texel;
    let lifted = globals.shadow_from_view * vec4f(view + lift, 1.0);
    let at = lifted.xy * vec2f(0.5, -0.5) + 0.5;
    if (any(at < vec2f(0.0)) || any(at > vec2f(1.0)) || lifted.z < 0.0 || lifted.z > 1.0) {
        return turned;
    }
    // Half a texel's size in the map is one texel in depth: depth covers four radii of the shadow region, the map's
    // side two.
    let depth = lifted.z - 0.5 * globals.air.y;
    var sum = 0.0;
    for (var x = -1; x <= 1; x++) {
        for (var y = -1; y <= 1; y++) {
            let aside = vec2f(f32(x), f32(y)) * globals.air.y;
            sum += textureSampleCompareLevel(shadow_map, shadow_sampler, at + aside, depth);
        }
    }
    return turned * sum / 9.0;
}

fn sky(direction: vec3f) -> vec3f {
    let up = max(direction.y, 0.0);
    var color = mix(HORIZON, ZENITH, 1.0 - exp(-up * 3.5));
    let along = max(dot(direction, globals.to_sun.xyz), 0.0);
    color += SUN * (0.10 * pow(along, 8.0) + 0.35 * pow(along, 64.0));
    return color + SUN * 6.0 * smoothstep(0.9994, 0.9997, along);
}

@fragment
fn fragment(in: Seen, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let distance = length(in.view);
    let toward = -in.view / max(distance, 1e-6);
    // Normal of the triangle itself, towards the eye.
    var face = normalize(cross(dpdx(in.view), dpdy(in.view)));
    face *= select(-1.0, 1.0, dot(face, toward) > 0.0);
    var n = normalize(in.normal);
    if (!front) {
        n = -n;
    }
    let smooth_normal = n;
    var albedo = in.color;
    var wrap = 0.0;
    var rim = 0.0;
    if (in.look > 2.5) {
        // Ground: grass where it is level, earth where it is steep.
        let coarse = noise(in.rest * 0.09) * 0.6 + noise(in.rest * 0.5) * 0.4;
        let fine = noise(in.rest * 3.0);
        let grass = mix(vec3f(0.10, 0.12, 0.045), vec3f(0.20, 0.19, 0.085), coarse);
        let earth = mix(vec3f(0.17, 0.14, 0.10), vec3f(0.26, 0.22, 0.165), coarse);
        let level = smoothstep(0.80, 0.97, n.y + 0.10 * (coarse - 0.5));
        albedo = mix(earth, grass, level) * (0.85 + 0.3 * mix(fine, 0.5, smoothstep(40.0, 160.0, distance)));
    } else if (in.look > 1.5) {
        // Fur: thin dark gaps between strands that hang down.
        let strand = noise(in.rest * vec3f(26.0, 3.0, 26.0));
        let tuft = noise(in.rest * vec3f(4.0, 1.2, 4.0));
        albedo *= 0.45 + 0.55 * strand + 0.45 * (tuft - 0.4);
        n = normalize(n + 0.45 * (vec3f(noise(in.rest * 9.0), 0.0, noise(in.rest.zyx * 9.0)) - vec3f(0.5, 0.0, 0.5)));
        wrap = 0.35;
        rim = 0.5;
    } else if (in.look > 0.5) {
        // Stone: smooth lighter and darker patches, and bumps.
        let patches = noise(in.rest * 0.9) * 0.5 + noise(in.rest * 3.1) * 0.3 + noise(in.rest * 11.0) * 0.2;
        albedo *= 0.70 + 0.6 * patches;
        n = normalize(n + 0.30 * (vec3f(noise(in.rest * 5.0), noise(in.rest.yzx * 5.0), noise(in.rest.zxy * 5.0)) - 0.5));
    }
    let facing = dot(n, globals.to_sun.xyz);
    let direct = max((facing + wrap) / (1.0 + wrap), 0.0);
    let lit = direct * sunlit(in.view, face, smooth_normal);
    let above = 0.5 + 0.5 * n.y;
    let ambient = mix(BOUNCE, mix(HORIZON, ZENITH, 0.7) * 0.62, above);
    let edge = pow(1.0 - max(dot(n, toward), 0.0), 3.0) * rim;
    var color = albedo * (SUN * lit + ambient) + edge * albedo * (ambient + SUN * max(facing + 0.5, 0.0) * 0.5);
    let clear = exp(-distance * globals.air.x);
    color = mix(sky(normalize(vec3f(in.view.x, max(in.view.y, 0.0) + 0.02 * distance, in.view.z))), color, clear);
    return vec4f(tone(color), 1.0);
}

// Tone mapping: compresses bright light instead of clipping it.
fn tone(color: vec3f) -> vec3f {
    let x = color * 0.92;
    return x * (2.2 * x + 0.10) / (x * (1.85 * x + 1.05) + 0.16);
}

struct Ray {
    @builtin(position) clip: vec4f,
    @location(0) ndc: vec2f,
}

@vertex
fn sky_vertex(@builtin(vertex_index) index: u32) -> Ray {
    let at = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    var out: Ray;
    out.clip = vec4f(at, 0.0, 1.0);
    out.ndc = at;
    return out;
}

@fragment
fn sky_fragment(in: Ray) -> @location(0) vec4f {
    // The pixel's point on the near plane, where depth is 1.
    let near = globals.view_from_clip * vec4f(in.ndc, 1.0, 1.0);
    return vec4f(tone(sky(normalize(near.xyz / near.w))), 1.0);
}
