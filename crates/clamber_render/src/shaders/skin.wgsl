// Linear blend skinning, in the order of the collider's skinning: each row of a matrix times the position as
// ((m0 x + m1 y) + (m2 z + m3)), times the weight, summed by ascending joint. Devices may fuse and reorder
// operations.

struct Vertex {
    position: vec4f,
    normal: vec4f,
}

struct Influence {
    joint: u32,
    weight: f32,
}

@group(0) @binding(0) var<storage, read> rest: array<Vertex>;
@group(0) @binding(1) var<storage, read> ends: array<u32>;
@group(0) @binding(2) var<storage, read> influences: array<Influence>;
@group(0) @binding(3) var<storage, read> palette: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> posed: array<Vertex>;

// Number of vertices in a workgroup, as in `skinning.rs`.
const GROUP = 64u;
// Largest number of workgroups along the first axis, as in `skinning.rs`.
const ROW = 32768u;

@compute @workgroup_size(GROUP)
fn skin(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) local: u32) {
    let index = (group.y * ROW + group.x) * GROUP + local;
    if (index >= arrayLength(&posed)) {
        return;
    }
    let vertex = rest[index];
    let p = vertex.position;
    var first = 0u;
    if (index > 0u) {
        first = ends[index - 1u];
    }
    var position = vec3f(0.0);
    var rows = array<vec3f, 3>(vec3f(0.0), vec3f(0.0), vec3f(0.0));
    for (var at = first; at < ends[index]; at++) {
        let influence = influences[at];
        for (var row = 0u; row < 3u; row++) {
            let m = palette[influence.joint * 3u + row];
            let moved = (m.x * p.x + m.y * p.y) + (m.z * p.z + m.w);
            position[row] += influence.weight * moved;
            rows[row] += influence.weight * m.xyz;
        }
    }
    // Normals are transformed by the matrix of cofactors, which is right for stretched skin too.
    let n = vertex.normal.xyz;
    let normal = vec3f(
        dot(cross(rows[1], rows[2]), n),
        dot(cross(rows[2], rows[0]), n),
        dot(cross(rows[0], rows[1]), n),
    );
    posed[index].position = vec4f(position, 1.0);
    posed[index].normal = vec4f(normalize(normal + vec3f(0.0, 1e-30, 0.0)), 0.0);
}
