// Exclusive prefix sum in three steps: within blocks, over the blocks' totals, and adding the two.

// No more than WebGPU's compatibility mode allows.
const THREADS: u32 = 128u;
// Values per thread.
const RUN: u32 = 8u;
// Values per block; twin of `SCAN_BLOCK` in src/ldi/layout.rs.
const BLOCK: u32 = 1024u;

@group(0) @binding(0) var<storage, read> values: array<u32>;
// One longer than `values`: the last element is the total.
@group(0) @binding(1) var<storage, read_write> sums: array<u32>;
// One per block, followed by the total.
@group(0) @binding(2) var<storage, read_write> totals: array<u32>;

var<workgroup> shared_sums: array<u32, THREADS>;

// The sum of the values of the threads before this one, and of all threads.
struct Share {
    before: u32,
    all: u32,
}

fn share(thread: u32, value: u32) -> Share {
    shared_sums[thread] = value;
    workgroupBarrier();
    for (var distance = 1u; distance < THREADS; distance *= 2u) {
        var sum = shared_sums[thread];
        if thread >= distance {
            sum += shared_sums[thread - distance];
        }
        workgroupBarrier();
        shared_sums[thread] = sum;
        workgroupBarrier();
    }
    let result = Share(shared_sums[thread] - value, shared_sums[THREADS - 1u]);
    workgroupBarrier();
    return result;
}

@compute @workgroup_size(THREADS)
fn scan_blocks(
    @builtin(workgroup_id) block: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let count = arrayLength(&values);
    let first = block.x * BLOCK + thread * RUN;
    var own = 0u;
    for (var i = first; i < min(first + RUN, count); i++) {
        own += values[i];
    }
    let others = share(thread, own);
    var sum = others.before;
    for (var i = first; i < min(first + RUN, count); i++) {
        sums[i] = sum;
        sum += values[i];
    }
    if thread == 0u {
        totals[block.x] = others.all;
    }
}

// One workgroup walks over all blocks.
@compute @workgroup_size(THREADS)
fn scan_totals(@builtin(local_invocation_index) thread: u32) {
    let blocks = arrayLength(&totals) - 1u;
    var carried = 0u;
    for (var first = 0u; first < blocks; first += THREADS) {
        let i = first + thread;
        var own = 0u;
        if i < blocks {
            own = totals[i];
        }
        let others = share(thread, own);
        if i < blocks {
            totals[i] = carried + others.before;
        }
        carried += others.all;
    }
    if thread == 0u {
        totals[blocks] = carried;
    }
}

@compute @workgroup_size(THREADS)
fn add_totals(
    @builtin(workgroup_id) block: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let count = arrayLength(&values);
    let first = block.x * BLOCK + thread * RUN;
    for (var i = first; i < min(first + RUN, count); i++) {
        sums[i] += totals[block.x];
    }
    if block.x == 0u && thread == 0u {
        sums[count] = totals[arrayLength(&totals) - 1u];
    }
}
