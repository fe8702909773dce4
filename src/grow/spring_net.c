#include "grow/spring_net.h"

#include <string.h>

void net_init(SpringNet *net, size_t mass_count, size_t most_springs, Arena *arena) {
    *net = (SpringNet){.mass_count = mass_count, .steps = 1};
    net->masses = arena_new_array(arena, NetMass, mass_count);
    net->ahead = arena_new_array(arena, NetMass, mass_count);
    net->springs = arena_new_array(arena, NetSpring, most_springs);
}

/* ---- energy ---- */

static double kinetic_energy(const SpringNet *net) {
    double sum = 0;
    for (size_t i = 0; i < net->mass_count; i++) sum += net->masses[i].mass * vec3_length_squared(net->masses[i].speed);
    return sum / 2;
}

static double height_energy(const SpringNet *net) {
    double sum = 0;
    for (size_t i = 0; i < net->mass_count; i++) sum -= net->masses[i].mass * vec3_dot(net->gravity, net->masses[i].place);
    return sum;
}

/* By the forces, which stay what they must be where a spring is too stiff for its length to tell. */
static double spring_energy(const SpringNet *net) {
    double sum = 0;
    for (size_t i = 0; i < net->spring_count; i++) {
        const NetSpring *s = &net->springs[i];
        if (isfinite(s->compliance)) sum += s->force * s->force * s->compliance / 2;
    }
    return sum;
}

double net_energy(const SpringNet *net) { return kinetic_energy(net) + height_energy(net) + spring_energy(net); }

static void keep_energy(SpringNet *net) {
    double moving = kinetic_energy(net), stored = height_energy(net) + spring_energy(net);
    if (!(moving + stored > net->limit)) return;
    double factor = moving > 0 ? sqrt(fmax(0, net->limit - stored) / moving) : 0;
    for (size_t i = 0; i < net->mass_count; i++) net->masses[i].speed = vec3_scale(net->masses[i].speed, factor);
}

/* ---- one step ---- */

static void pull(NetMass *a, NetMass *b, Vec3 along, double push) {
    a->next = vec3_madd(a->next, along, -push * a->weight);
    b->next = vec3_madd(b->next, along, push * b->weight);
}

/* Macklin et al. 2016, equation 18: the change of the multiplier that makes length and force fit. */
static void relax(NetSpring *s, NetMass *masses, double step) {
    NetMass *a = &masses[s->a], *b = &masses[s->b];
    Vec3 d = vec3_sub(b->next, a->next);
    double length = vec3_length(d), soft = s->compliance / (step * step);
    if (!(length > 0) || !isfinite(soft)) return;
    double change = -(length - s->rest + soft * s->multiplier) / (a->weight + b->weight + soft);
    s->multiplier += change;
    pull(a, b, vec3_scale(d, 1 / length), change);
}

/* Whether it was longer than it may be. */
static bool shorten(const NetSpring *s, NetMass *masses) {
    NetMass *a = &masses[s->a], *b = &masses[s->b];
    Vec3 d = vec3_sub(b->next, a->next);
    double squared = vec3_length_squared(d);
    if (!(squared > s->longest * s->longest)) return false;
    double length = sqrt(squared);
    pull(a, b, vec3_scale(d, 1 / length), (s->longest - length) / (a->weight + b->weight));
    return length > s->longest * (1 + 1e-4);
}

/* A step begins with the forces of the last one, as far as steps can tell the spring's swing: so that what hangs at rest stays
 * there. Beginning with all of them is unstable, for stiff springs; so is sweeping to and fro. */
static void begin_with_forces(NetSpring *s, NetMass *masses, double step) {
    NetMass *a = &masses[s->a], *b = &masses[s->b];
    Vec3 d = vec3_sub(b->next, a->next);
    double length = vec3_length(d), mobile = step * step * (a->weight + b->weight);
    s->multiplier = 0;
    if (!(length > 0) || !isfinite(s->compliance) || s->compliance == 0) return;
    s->multiplier = s->compliance / (s->compliance + mobile) * s->force * step * step;
    pull(a, b, vec3_scale(d, 1 / length), s->multiplier);
}

static void relax_all(SpringNet *net, double step) {
    size_t count = net->spring_count;
    for (size_t i = 0; i < count; i++) begin_with_forces(&net->springs[i], net->masses, step);
    for (size_t i = 0; i < count; i++) relax(&net->springs[i], net->masses, step);
    for (size_t i = 0; i < count; i++) net->springs[i].force = net->springs[i].multiplier / (step * step);
}

enum { MOST_SHORTENINGS = 60 };

static void shorten_all(const SpringNet *net) {
    bool again = true;
    for (int k = 0; k < MOST_SHORTENINGS && again; k++) {
        again = false;
        for (size_t i = 0; i < net->spring_count; i++)
            again |= shorten(&net->springs[k & 1 ? i : net->spring_count - 1 - i], net->masses);
    }
}

static void advance(SpringNet *net, double step) {
    NetMass *masses = net->masses;
    double kept = exp(-net->damping * step);
    for (size_t i = 0; i < net->mass_count; i++) {
        NetMass *m = &masses[i];
        if (m->weight == 0) continue;
        m->speed = vec3_madd(vec3_madd(vec3_scale(m->speed, kept), net->gravity, step), m->blown, step * m->weight);
        m->next = vec3_madd(m->place, m->speed, step);
    }
    relax_all(net, step);
    if (net->bounded) shorten_all(net);
    for (size_t i = 0; i < net->mass_count; i++) {
        NetMass *m = &masses[i];
        if (m->weight == 0) continue;
        Vec3 moved = vec3_sub(m->next, m->place);
        net->limit += vec3_dot(m->blown, moved);
        m->speed = vec3_scale(moved, 1 / step);
        m->place = m->next;
    }
    keep_energy(net);
}

/* ---- time ---- */

static void blow_now(SpringNet *net) {
    if (net->blow) net->blow(net, (double)net->tick / NET_TICKS);
}

static void run_tick(SpringNet *net) {
    blow_now(net);
    for (int k = 0; k < net->steps; k++) advance(net, 1.0 / NET_TICKS / net->steps);
    net->tick++;
}

/* A part of a tick, as its end would be seen from there; the net itself stays at the tick. */
static void look_ahead(SpringNet *net, double part, size_t count, Vec3 *places) {
    NetMass *now = net->masses;
    double limit = net->limit;
    memcpy(net->ahead, now, net->mass_count * sizeof *now);
    for (size_t i = 0; i < net->spring_count; i++) net->springs[i].tick_force = net->springs[i].force;
    net->masses = net->ahead;
    blow_now(net);
    int steps = (int)ceil(part * net->steps);
    for (int k = 0; k < steps; k++) advance(net, part / NET_TICKS / steps);
    for (size_t i = 0; i < count; i++) places[i] = net->ahead[i].place;
    for (size_t i = 0; i < net->spring_count; i++) net->springs[i].force = net->springs[i].tick_force;
    net->masses = now;
    net->limit = limit;
}

/* Times of frames are rounded: a hair before a tick is the tick. */
static double whole_ticks(double ticks) { return floor(ticks + 1e-6); }

uint64_t net_tick_of(double time) { return (uint64_t)double_clamp(whole_ticks(time * NET_TICKS), 0, 1e15); }

bool net_follow(SpringNet *net, double time, const atomic_bool *interrupted, size_t count, Vec3 *places) {
    double ticks = fmax(0, time * NET_TICKS), whole = whole_ticks(ticks);
    while ((double)net->tick < whole) {
        if (interrupted && *interrupted) return false;
        run_tick(net);
    }
    if (ticks - whole > 1e-6) {
        look_ahead(net, ticks - whole, count, places);
        return true;
    }
    for (size_t i = 0; i < count; i++) places[i] = net->masses[i].place;
    return true;
}

/* ---- state ---- */

enum { STATE_HEAD = 2, STATE_OF_MASS = 6 };

static size_t moving_masses(const SpringNet *net) {
    size_t count = 0;
    for (size_t i = 0; i < net->mass_count; i++) count += net->masses[i].weight != 0;
    return count;
}

size_t net_state_count(const SpringNet *net) { return STATE_HEAD + STATE_OF_MASS * moving_masses(net) + net->spring_count; }

void net_save_state(const SpringNet *net, double *state) {
    *state++ = (double)net->tick;
    *state++ = net->limit;
    for (size_t i = 0; i < net->mass_count; i++) {
        const NetMass *m = &net->masses[i];
        if (m->weight == 0) continue;
        const double numbers[STATE_OF_MASS] = {m->place.x, m->place.y, m->place.z, m->speed.x, m->speed.y, m->speed.z};
        memcpy(state, numbers, sizeof numbers);
        state += STATE_OF_MASS;
    }
    for (size_t i = 0; i < net->spring_count; i++) *state++ = net->springs[i].force;
}

bool net_load_state(SpringNet *net, const double *state) {
    size_t count = net_state_count(net);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(state[i])) return false;
    if (!(state[0] >= 0 && state[0] < 1e15 && state[0] == floor(state[0]))) return false;
    net->tick = (uint64_t)*state++;
    net->limit = *state++;
    for (size_t i = 0; i < net->mass_count; i++) {
        NetMass *m = &net->masses[i];
        if (m->weight == 0) continue;
        m->place = m->next = vec3(state[0], state[1], state[2]);
        m->speed = vec3(state[3], state[4], state[5]);
        state += STATE_OF_MASS;
    }
    for (size_t i = 0; i < net->spring_count; i++) net->springs[i].force = *state++;
    return true;
}

/* Seconds from one state that is kept on the way to the next. */
enum { STATE_SECONDS = 1 };

bool net_follow_by_states(SpringNet *net, Hash128 key, const NetStates *states, double time, const atomic_bool *interrupted, size_t count,
                          Vec3 *places) {
    if (!states) return net_follow(net, time, interrupted, count, places);
    uint64_t last = net_tick_of(time), second = STATE_SECONDS * NET_TICKS;
    states->find(states->context, key, last, net);
    for (uint64_t next = (net->tick / second + 1) * second; next <= last; next += second) {
        if (!net_follow(net, (double)next / NET_TICKS, interrupted, 0, places)) return false;
        states->keep(states->context, key, net, false);
    }
    if (!net_follow(net, time, interrupted, count, places)) return false;
    states->keep(states->context, key, net, true);
    return true;
}
