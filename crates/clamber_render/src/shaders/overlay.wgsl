// Draws lines, whose width is in pixels, and triangles over the picture. The opacity is a uniform, so that a second
// pass draws the parts behind a mesh faintly.

struct Globals {
    clip_from_view: mat4x4f,
    // Size of the picture in pixels; opacity; unused.
    size: vec4f,
}

@group(0) @binding(0) var<uniform> globals: Globals;

struct Vertex {
    // The position relative to the eye, and the width of the line; 0 for triangles.
    @location(0) position: vec4f,
    // The line's other end, and the side of the line: -1 or 1.
    @location(1) other: vec4f,
    @location(2) color: vec4f,
}

struct Seen {
    @builtin(position) clip: vec4f,
    @location(0) color: vec4f,
}

// Factor that moves depth towards the eye, so that overlays on a surface are in front of it.
const NEARER = 1.002;

fn project(position: vec3f) -> vec4f {
    var clip = globals.clip_from_view * vec4f(position, 1.0);
    clip.z *= NEARER;
    return clip;
}

@vertex
fn vertex(in: Vertex) -> Seen {
    var out: Seen;
    out.color = vec4f(in.color.rgb, in.color.a * globals.size.z);
    var here = project(in.position.xyz);
    if (in.position.w > 0.0) {
        var there = project(in.other.xyz);
        // The part of a line behind the eye is cut off at the near plane, metres, as in `camera.rs`.
        let near = 0.1;
        if (here.w < near && there.w > near) {
            here = mix(here, there, (near - here.w) / (there.w - here.w));
        } else if (there.w < near && here.w > near) {
            there = mix(there, here, (near - there.w) / (here.w - there.w));
        }
        let a = here.xy / here.w * globals.size.xy;
        let b = there.xy / there.w * globals.size.xy;
        let along = b - a;
        let length = max(length(along), 1e-6);
        let across = vec2f(-along.y, along.x) / length * in.other.w * in.position.w;
        here += vec4f(across / globals.size.xy * here.w, 0.0, 0.0);
    }
    out.clip = here;
    return out;
}

@fragment
fn fragment(in: Seen) -> @location(0) vec4f {
    return in.color;
}
