// Variances → counts: one multiplier for all pixels, by which the picture's aim is met at the least cost. Pixels are sorted
// into bins by the multiplier at which they begin to gain samples; of pixels of equal counts in a bin all have nearly the same
// weight and variance, so that each bin needs numbers of samples alone, which are sums of integers and the same in any order.
// Twin: src/integrators/adaptive/allocate.rs, which says why.
#ifndef GOAL_ALLOCATION_GLSL
#define GOAL_ALLOCATION_GLSL

#include "batches.glsl"

const float BINS_AN_OCTAVE = 8.0;
const float MIDDLE = float(GOAL_MIDDLE_BIN);
const uint PIXELS_AT_ONCE = 16u; // of a thread

float exponent() { return uintBitsToFloat(OPAQUE(goal.exponent)); }

// The least factor by which a count grows.
float min_growth(uint count) { return count < 2u ? GOAL_MIN_GROWTH_OF_ONE : GOAL_MIN_GROWTH; }

// The ratio in which a pixel has its share of the samples.
float weight(float variance, float count) {
    float p = exponent();
    return variance > 0.0 ? pow(variance * pow(count, p), 1.0 / (1.0 + p)) : 0.0;
}

// Pixels of no weight are in the last bin.
uint bin_of(float weight, uint count) {
    if (!(weight > 0.0)) return GOAL_BINS - 1u;
    float octave = log2(min_growth(count) * float(count) / weight);
    return uint(clamp(octave * BINS_AN_OCTAVE + MIDDLE, 0.0, float(GOAL_BINS - 1u)));
}

// Adds to numbers of two words.
void add_long(uint low, uint high, uint more) {
    uint before = atomicAdd(totals[low], more);
    if (before + more < before) atomicAdd(totals[high], 1u);
}

// Sums, for each bin, the pixels of one sample and the samples of the others, whose least growth differs.
void fill_bins() {
    uint lane = gl_LocalInvocationIndex;
    for (uint k = lane; k < 3u * GOAL_BINS; k += GOAL_THREADS) counters[k] = 0u;
    barrier();
    for (uint k = 0u; k < PIXELS_AT_ONCE; k++) {
        uint pixel = (number_of_group() * PIXELS_AT_ONCE + k) * GOAL_THREADS + lane;
        if (pixel >= pixel_count()) continue;
        uint count = word_of(GOAL_COUNTS, pixel);
        uint bin = bin_of(weight(real_of(GOAL_VARIANCES, pixel), float(count)), count);
        // 4096 pixels of 65536 samples fit in a word.
        if (count == 1u) atomicAdd(counters[bin], 1u);
        else atomicAdd(counters[GOAL_BINS + bin], count);
    }
    barrier();
    for (uint k = lane; k < GOAL_BINS; k += GOAL_THREADS) {
        if (counters[k] > 0u) atomicAdd(totals[GOAL_BINS_AT + k], counters[k]);
        uint more = counters[GOAL_BINS + k];
        if (more > 0u) add_long(GOAL_BINS_AT + GOAL_BINS + k, GOAL_BINS_AT + 2u * GOAL_BINS + k, more);
    }
}

float multiplier_of(float bin) { return exp2((bin - MIDDLE) / BINS_AN_OCTAVE); }

// Variance, samples and weight of a bin's pixels: before they gain samples, and for a multiplier of 1 after.
vec3 bin_sums(uint bin) {
    float ones = float(totals[GOAL_BINS_AT + bin]);
    float others = float(totals[GOAL_BINS_AT + GOAL_BINS + bin]) + 4294967296.0 * float(totals[GOAL_BINS_AT + 2u * GOAL_BINS + bin]);
    float samples = 2.0 * (ones + others);
    if (samples == 0.0 || bin == GOAL_BINS - 1u) return vec3(0.0, samples, 0.0);
    float p = exponent();
    float octave = (float(bin) + 0.5 - MIDDLE) / BINS_AN_OCTAVE;
    // A pixel of n samples gains from the multiplier g n / w on: w = g n / m, and v = w^(1 + p) / n^p.
    float grown = pow(GOAL_MIN_GROWTH_OF_ONE, 1.0 + p) * ones + pow(GOAL_MIN_GROWTH, 1.0 + p) * others;
    float variance = grown * exp2(-(1.0 + p) * octave);
    return vec3(variance, samples, (GOAL_MIN_GROWTH_OF_ONE * ones + GOAL_MIN_GROWTH * others) * exp2(-octave));
}

const uint BINS_A_THREAD = GOAL_BINS / GOAL_THREADS;

// Returns true if the multiplier meets the aim; `kept` are variance and samples of pixels that gain none.
bool meets(float multiplier, vec2 kept, float gaining) {
    float aim = uintBitsToFloat(OPAQUE(goal.aim));
    if (goal.aims_at_error != 0u) return kept.x + gaining * pow(multiplier, -exponent()) <= aim;
    return kept.y + 2.0 * gaining * multiplier >= aim;
}

// Finds the multiplier, in one workgroup. Both aims are monotonic in it.
void solve() {
    uint lane = gl_LocalInvocationIndex;
    vec3 own = vec3(0.0);
    for (uint k = 0u; k < BINS_A_THREAD; k++) own += bin_sums(lane * BINS_A_THREAD + k);
    lanes[lane] = vec4(own, 0.0);
    if (lane == 0u) counters[0] = GOAL_BINS;
    barrier();
    // Sums over all threads up to each one (Hillis & Steele 1986).
    for (uint reach = 1u; reach < GOAL_THREADS; reach *= 2u) {
        vec4 more = lane >= reach ? lanes[lane - reach] : vec4(0.0);
        barrier();
        lanes[lane] += more;
        barrier();
    }
    vec3 all = lanes[GOAL_THREADS - 1u].xyz;
    vec3 before = lanes[lane].xyz - own;
    uint found = GOAL_BINS;
    vec2 kept = vec2(0.0);
    float gaining = 0.0;
    for (uint k = 0u; k < BINS_A_THREAD; k++) {
        uint bin = lane * BINS_A_THREAD + k;
        vec2 rest = max(all.xy - before.xy, 0.0);
        if (found == GOAL_BINS && meets(multiplier_of(float(bin + 1u)), rest, before.z)) {
            found = bin;
            kept = rest;
            gaining = before.z;
        }
        before += bin_sums(bin);
    }
    atomicMin(counters[0], found);
    barrier();
    bool is_last = counters[0] == GOAL_BINS && lane == GOAL_THREADS - 1u;
    if (is_last) gaining = all.z;
    if (counters[0] == found && found < GOAL_BINS || is_last) {
        float multiplier = multiplier_of(float(found));
        float aim = uintBitsToFloat(OPAQUE(goal.aim));
        if (!is_last && !meets(multiplier, kept, gaining)) {
            float exact = (aim - kept.y) / (2.0 * gaining);
            if (goal.aims_at_error != 0u) exact = pow(gaining / (aim - kept.x), 1.0 / exponent());
            multiplier = clamp(exact, multiplier, multiplier_of(float(found + 1u)));
        }
        totals[GOAL_MULTIPLIER] = floatBitsToUint(multiplier);
        totals[GOAL_PLANNED_SAMPLES] = floatBitsToUint(kept.y + 2.0 * gaining * multiplier);
        totals[GOAL_GAINING] = 0u;
        totals[GOAL_PART_COUNT] = 0u;
    }
    barrier();
    for (uint k = lane; k < 3u * GOAL_BINS; k += GOAL_THREADS) totals[GOAL_BINS_AT + k] = 0u;
    if (lane < 2u * GOAL_CLASSES) totals[GOAL_CLASSES_AT + lane] = 0u;
}

// Rounds to the nearest number with two significant bits.
uint round_to_two_bits(float wanted) {
    float size = float(1u << (uint(findMSB(uint(max(wanted, 2.0)))) - 1u));
    return uint(floor(wanted / size + 0.5) * size);
}

// Returns the count of a visited pixel.
uint grown(uint count) { return count < GOAL_FEW_SAMPLES ? GOAL_VISIT_GROWTH * count : count + (1u << findMSB(count)) / 2u; }

uint pcg(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Returns true for one pixel of each run, drawn at random.
bool is_visited(uint pixel) {
    uint run = pixel / GOAL_RUN;
    uint length = min(GOAL_RUN, pixel_count() - run * GOAL_RUN);
    return pixel % GOAL_RUN == pcg(pcg(run) + OPAQUE(goal.pass)) % length;
}

// Chooses each pixel's next count, and counts the pixels that gain samples, in each class.
void choose_counts() {
    uint lane = gl_LocalInvocationIndex;
    uint pixel = number_of_thread();
    if (lane < GOAL_CLASSES + 1u) counters[lane] = 0u;
    barrier();
    if (pixel < pixel_count()) {
        uint count = word_of(GOAL_COUNTS, pixel);
        uint next = word_of(GOAL_NEXT, pixel);
        if (OPAQUE(goal.chooses) != 0u) {
            float multiplier = uintBitsToFloat(totals[GOAL_MULTIPLIER]);
            float wanted = weight(real_of(GOAL_VARIANCES, pixel), float(count)) * multiplier;
            wanted = min(min(wanted, float(count) * uintBitsToFloat(goal.growth)), float(goal.most));
            next = wanted < min_growth(count) * float(count) ? count : round_to_two_bits(wanted);
            if (next > count) atomicAdd(counters[GOAL_CLASSES], 1u);
            if (is_visited(pixel)) {
                next = max(next, min(grown(count), goal.most));
                keep_real(visits(true), pixel, real_of(GOAL_SPREADS, pixel));
            }
            pixel_words[at(GOAL_NEXT, pixel)] = next;
        }
        if (next > count) atomicAdd(counters[class_of(next - count)], 1u);
    }
    barrier();
    if (lane < GOAL_CLASSES && counters[lane] > 0u) atomicAdd(totals[GOAL_CLASSES_AT + lane], counters[lane]);
    if (lane == GOAL_CLASSES && counters[lane] > 0u) atomicAdd(totals[GOAL_GAINING], counters[lane]);
}

void plan_all() {
    uint pixel = number_of_thread();
    if (pixel < pixel_count()) pixel_words[at(GOAL_NEXT, pixel)] = goal.count;
}

#endif
