#include "grow/tips.h"

#include "grow/wind.h"

/* Steps of a tick: a swing is right to a percent up to K of a thousand. */
enum { STEPS = 8 };

/* Where the tips' anchors and feet follow them. */
static uint32_t anchor_of(const TipsSpec *s, size_t tip) { return (uint32_t)(s->count + tip); }
static uint32_t foot_of(const TipsSpec *s, size_t tip) { return (uint32_t)(2 * s->count + tip); }

/* Beyond, the direction is the force's to six digits. */
static const double MOST_FORCE = 1e6;

/* F/s, in units of the spring's pull. */
static Vec3 force_at(const TipsSpec *s, size_t tip, double time) {
    Vec3 force = vec3_scale(wind_force(s->wind, s->feet[tip], time), 1 / s->wind->stiffness);
    double strength = vec3_length(force);
    if (!isfinite(strength)) return vec3_splat(0);
    return strength > MOST_FORCE ? vec3_scale(force, MOST_FORCE / strength) : force;
}

static void blow(SpringNet *net, double time) {
    const TipsSpec *s = net->context;
    for (size_t i = 0; i < s->count; i++)
        if (net->masses[i].weight != 0)
            net->masses[i].blown = vec3_scale(force_at(s, i, time + s->begins), s->stiffness * vec3_length(s->heights[i]));
}

static Vec3 start_of(const TipsSpec *s, size_t tip) {
    if (s->start) return s->start[tip];
    return s->wind ? wind_bend(s->heights[tip], force_at(s, tip, s->begins), 1) : s->heights[tip];
}

static void lay_tip(const TipsSpec *s, SpringNet *net, size_t i) {
    double length = vec3_length(s->heights[i]);
    bool moves = length > 0 && isfinite(length) && vec3_is_finite(s->feet[i]);
    Vec3 foot = s->feet[i], rest = vec3_add(foot, s->heights[i]), now = moves ? vec3_add(foot, start_of(s, i)) : rest;
    net->masses[i] = (NetMass){.place = now, .next = now, .mass = 1, .weight = moves};
    net->masses[anchor_of(s, i)] = (NetMass){.place = rest, .next = rest};
    net->masses[foot_of(s, i)] = (NetMass){.place = foot, .next = foot};
}

static void add_spring(SpringNet *net, uint32_t a, uint32_t b, double rest, double compliance) {
    double length = vec3_length(vec3_sub(net->masses[b].place, net->masses[a].place));
    net->springs[net->spring_count++] = (NetSpring){.a = a, .b = b, .rest = rest, .compliance = compliance, .longest = HUGE_VAL,
                                                    .force = compliance > 0 ? -(length - rest) / compliance : 0};
}

static void join_neighbours(const TipsSpec *s, SpringNet *net, uint32_t a, uint32_t b) {
    double edge = vec3_length(vec3_sub(s->feet[b], s->feet[a]));
    double height = (vec3_length(s->heights[a]) + vec3_length(s->heights[b])) / 2, stiffness = s->stiffness * (height / edge) * (height / edge);
    if (!(net->masses[a].weight + net->masses[b].weight > 0 && stiffness > 0 && isfinite(stiffness))) return;
    double rest = vec3_length(vec3_sub(net->masses[anchor_of(s, b)].place, net->masses[anchor_of(s, a)].place));
    add_spring(net, a, b, rest, 1 / stiffness);
}

static size_t spring_count(const TipsSpec *s) { return 2 * s->count + s->edge_count; }

double tips_work(const TipsSpec *s) { return (double)spring_count(s) * STEPS * NET_TICKS; }

SpringNet *tips_create(const TipsSpec *spec, Arena *arena) {
    SpringNet *net = arena_new(arena, SpringNet);
    TipsSpec *own = arena_new(arena, TipsSpec);
    *own = *spec;
    net_init(net, 3 * spec->count, spring_count(spec), arena);
    net->context = own;
    net->blow = spec->wind ? blow : NULL;
    net->damping = spec->damping;
    net->steps = STEPS;
    for (size_t i = 0; i < spec->count; i++) lay_tip(spec, net, i);
    for (size_t i = 0; i < spec->count; i++)
        if (net->masses[i].weight != 0) add_spring(net, (uint32_t)i, anchor_of(spec, i), 0, 1 / spec->stiffness);
    for (size_t i = 0; i < spec->edge_count; i++) join_neighbours(spec, net, spec->edges[i].a, spec->edges[i].b);
    for (size_t i = 0; i < spec->count; i++) /* last: lengths are kept, whatever pulls */
        if (net->masses[i].weight != 0) add_spring(net, (uint32_t)i, foot_of(spec, i), vec3_length(spec->heights[i]), 0);
    net->limit = net_energy(net);
    return net;
}

Hash128 tips_hash(const TipsSpec *s) {
    enum { KIND_TIPS = 0x74697073, RULES = 1 }; /* another number when the same tips move otherwise */
    Hash128 hash = hash_begin(KIND_TIPS + RULES);
    hash_add_u64(&hash, s->count);
    for (size_t i = 0; i < s->count; i++) {
        hash_add(&hash, &s->feet[i], sizeof s->feet[i]);
        hash_add(&hash, &s->heights[i], sizeof s->heights[i]);
        if (s->start) hash_add(&hash, &s->start[i], sizeof s->start[i]);
    }
    hash_add(&hash, s->edges, s->edge_count * sizeof *s->edges);
    const double numbers[] = {s->stiffness, s->damping, s->begins, s->wind != NULL, s->start != NULL};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&hash, numbers[i]);
    if (s->wind) hash_add_hash(&hash, s->wind->hash);
    return hash;
}

double tips_lead(const SkinSprings *springs, const WindField *wind) {
    static const double FORGOTTEN = 7 /* e⁻⁷ is a thousandth */, LONGEST = 60, MOST_ROUNDS = 16;
    if (!wind || !(wind->cycle > 0)) return 0;
    double half = springs->damping / 2, slow = springs->stiffness / springs->damping, rate = half * half > springs->stiffness ? slow : half;
    double rounds = ceil(FORGOTTEN / (rate * wind->cycle));
    return wind->cycle * double_clamp(rounds, 1, fmin(MOST_ROUNDS, fmax(1, floor(LONGEST / wind->cycle))));
}

/* Cosine of the angle to the rest at which a height vector lies. */
static const double FLAT = 0.05;

Vec3 tips_height(Vec3 foot, Vec3 height, Vec3 tip, Vec3 bent) {
    Vec3 now = vec3_sub(tip, foot), rest = vec3_normalize(height);
    double distance = vec3_length(now), length = vec3_length(height);
    if (!(distance > 0 && isfinite(distance) && length > 0)) return bent;
    now = vec3_scale(now, length / distance);
    double least = fmin(FLAT * length, vec3_dot(bent, rest)), along = vec3_dot(now, rest);
    if (!(along < least)) return now;
    Vec3 aside = vec3_madd(now, rest, -along);
    double reach = vec3_length(aside);
    if (!(reach > 0)) return bent;
    return vec3_madd(vec3_scale(aside, sqrt(fmax(0, length * length - least * least)) / reach), rest, least);
}
