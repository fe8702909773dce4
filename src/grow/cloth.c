#include "grow/cloth.h"

#include "base/random.h"
#include "grow/wind.h"

#include <string.h>

typedef struct Spring {
    uint32_t a, b;
    double rest, compliance; /* inverse stiffness; HUGE_VAL: none, the spring only bounds */
    double longest;          /* HUGE_VAL: no bound */
    double multiplier;       /* in a step: force · step² */
    double force, tick_force; /* in the last one; at the last tick */
} Spring;

typedef struct Mass {
    Vec3 place, speed, next;
    double mass, weight; /* weight: inverse mass; 0: pinned */
    Vec3 blown;          /* force of the wind in this tick */
} Mass;

struct Cloth {
    ClothSpec spec;
    Mass *masses, *ahead; /* ahead: for parts of a tick */
    size_t mass_count;
    Spring *springs;
    size_t spring_count;
    int steps; /* of a tick */
    uint64_t tick;
    double limit; /* of the energy */
};

ClothSpec cloth_default(void) {
    return (ClothSpec){.width = 1, .height = 1, .nu = 16, .nv = 16, .mass = 0.2, .stiffness = 50, .shear = 0.25, .bend = 0.02,
                       .damping = 0.5, .elongation = 0.1, .gravity = {0, -9.81, 0}, .unrest = 1e-3};
}

/* ---- the sheet at rest ---- */

static uint32_t mass_at(const ClothSpec *s, int i, int j) { return (uint32_t)i * ((uint32_t)s->nv + 1) + (uint32_t)j; }

static bool is_pinned(const ClothSpec *s, int i, int j) {
    bool side = i == 0 || i == s->nu, end = j == 0 || j == s->nv;
    return (s->pins & CLOTH_PIN_LEFT && i == 0) || (s->pins & CLOTH_PIN_RIGHT && i == s->nu) || (s->pins & CLOTH_PIN_BOTTOM && j == 0) ||
           (s->pins & CLOTH_PIN_TOP && j == s->nv) || (s->pins & CLOTH_PIN_CORNERS && side && end);
}

/* A mass has the cells' quarters around it: half of them at a side, one at a corner. */
static double side_share(int i, int count) { return i == 0 || i == count ? 0.5 : 1; }

static void lay_masses(Cloth *cloth) {
    const ClothSpec *s = &cloth->spec;
    double cell = s->mass / ((double)s->nu * s->nv), unrest = s->unrest * fmin(s->width, s->height);
    for (int i = 0; i <= s->nu; i++)
        for (int j = 0; j <= s->nv; j++) {
            uint32_t k = mass_at(s, i, j);
            Mass *m = &cloth->masses[k];
            *m = (Mass){.place = {s->width * ((double)i / s->nu - 0.5), s->height * ((double)j / s->nv - 0.5), 0},
                        .mass = cell * side_share(i, s->nu) * side_share(j, s->nv)};
            m->next = m->place;
            if (is_pinned(s, i, j)) continue;
            m->weight = 1 / m->mass;
            m->speed.z = unrest * (2 * random_unit(random_hash(k, 0, 0, 0)) - 1);
        }
}

static void add_spring(Cloth *cloth, uint32_t a, uint32_t b, double stiffness, bool bounded) {
    if (cloth->masses[a].weight == 0 && cloth->masses[b].weight == 0) return;
    double rest = vec3_length(vec3_sub(cloth->masses[b].place, cloth->masses[a].place));
    cloth->springs[cloth->spring_count++] =
        (Spring){.a = a, .b = b, .rest = rest, .compliance = stiffness > 0 ? 1 / stiffness : HUGE_VAL,
                 .longest = bounded ? rest * (1 + cloth->spec.elongation) : HUGE_VAL};
}

/* All springs whose first end is mass i, j. A spring stands for a strip as wide as a cell, at a side half as wide. */
static void lay_springs_at(Cloth *cloth, int i, int j) {
    const ClothSpec *s = &cloth->spec;
    uint32_t here = mass_at(s, i, j);
    double aspect = s->height / s->nv / (s->width / s->nu), along_u = s->stiffness * aspect * side_share(j, s->nv),
           along_v = s->stiffness / aspect * side_share(i, s->nu), shear = s->stiffness * s->shear;
    if (i < s->nu) add_spring(cloth, here, mass_at(s, i + 1, j), along_u, true);
    if (j < s->nv) add_spring(cloth, here, mass_at(s, i, j + 1), along_v, true);
    if (i < s->nu && j < s->nv) add_spring(cloth, here, mass_at(s, i + 1, j + 1), shear, true);
    if (i < s->nu && j > 0) add_spring(cloth, here, mass_at(s, i + 1, j - 1), shear, true);
    if (i + 2 <= s->nu) add_spring(cloth, here, mass_at(s, i + 2, j), along_u * s->bend / 2, false);
    if (j + 2 <= s->nv) add_spring(cloth, here, mass_at(s, i, j + 2), along_v * s->bend / 2, false);
}

/* A step sweeps over the springs once, which carries forces over the whole sheet, but not all of them: what is missing stretches
 * stiff springs by the square of the masses in a row and of the step. */
static int steps_for(const ClothSpec *s) { return int_min(int_max(2 * int_max(s->nu, s->nv) / 3, 16), 64); }

double cloth_work(const ClothSpec *s) { return 6.0 * (double)cloth_mass_count(s) * steps_for(s) * CLOTH_TICKS; }

Cloth *cloth_create(const ClothSpec *spec, Arena *arena) {
    Cloth *cloth = arena_new(arena, Cloth);
    *cloth = (Cloth){.spec = *spec, .mass_count = cloth_mass_count(spec), .steps = steps_for(spec)};
    cloth->masses = arena_new_array(arena, Mass, cloth->mass_count);
    cloth->ahead = arena_new_array(arena, Mass, cloth->mass_count);
    cloth->springs = arena_new_array(arena, Spring, 6 * cloth->mass_count);
    lay_masses(cloth);
    for (int i = 0; i <= spec->nu; i++)
        for (int j = 0; j <= spec->nv; j++) lay_springs_at(cloth, i, j);
    cloth->limit = cloth_energy(cloth);
    return cloth;
}

/* ---- energy ---- */

static double kinetic_energy(const Cloth *cloth) {
    double sum = 0;
    for (size_t i = 0; i < cloth->mass_count; i++) sum += cloth->masses[i].mass * vec3_length_squared(cloth->masses[i].speed);
    return sum / 2;
}

static double height_energy(const Cloth *cloth) {
    double sum = 0;
    for (size_t i = 0; i < cloth->mass_count; i++) sum -= cloth->masses[i].mass * vec3_dot(cloth->spec.gravity, cloth->masses[i].place);
    return sum;
}

/* By the forces, which stay what they must be where a spring is too stiff for its length to tell. */
static double spring_energy(const Cloth *cloth) {
    double sum = 0;
    for (size_t i = 0; i < cloth->spring_count; i++) {
        const Spring *s = &cloth->springs[i];
        if (isfinite(s->compliance)) sum += s->force * s->force * s->compliance / 2;
    }
    return sum;
}

double cloth_energy(const Cloth *cloth) { return kinetic_energy(cloth) + height_energy(cloth) + spring_energy(cloth); }
double cloth_energy_limit(const Cloth *cloth) { return cloth->limit; }
uint64_t cloth_tick(const Cloth *cloth) { return cloth->tick; }

static void keep_energy(Cloth *cloth) {
    double moving = kinetic_energy(cloth), stored = height_energy(cloth) + spring_energy(cloth);
    if (!(moving + stored > cloth->limit)) return;
    double factor = moving > 0 ? sqrt(fmax(0, cloth->limit - stored) / moving) : 0;
    for (size_t i = 0; i < cloth->mass_count; i++) cloth->masses[i].speed = vec3_scale(cloth->masses[i].speed, factor);
}

/* ---- one step ---- */

static void pull(Mass *a, Mass *b, Vec3 along, double push) {
    a->next = vec3_madd(a->next, along, -push * a->weight);
    b->next = vec3_madd(b->next, along, push * b->weight);
}

/* Macklin et al. 2016, equation 18: the change of the multiplier that makes length and force fit. */
static void relax(Spring *s, Mass *masses, double step) {
    Mass *a = &masses[s->a], *b = &masses[s->b];
    Vec3 d = vec3_sub(b->next, a->next);
    double length = vec3_length(d), soft = s->compliance / (step * step);
    if (!(length > 0) || !isfinite(soft)) return;
    double change = -(length - s->rest + soft * s->multiplier) / (a->weight + b->weight + soft);
    s->multiplier += change;
    pull(a, b, vec3_scale(d, 1 / length), change);
}

/* Whether it was longer than it may be. */
static bool shorten(const Spring *s, Mass *masses) {
    Mass *a = &masses[s->a], *b = &masses[s->b];
    Vec3 d = vec3_sub(b->next, a->next);
    double squared = vec3_length_squared(d);
    if (!(squared > s->longest * s->longest)) return false;
    double length = sqrt(squared);
    pull(a, b, vec3_scale(d, 1 / length), (s->longest - length) / (a->weight + b->weight));
    return length > s->longest * (1 + 1e-4);
}

/* A step begins with the forces of the last one, as far as steps can tell the spring's swing: so that what hangs at rest stays
 * there. Beginning with all of them is unstable, for stiff springs; so is sweeping to and fro. */
static void begin_with_forces(Spring *s, Mass *masses, double step) {
    Mass *a = &masses[s->a], *b = &masses[s->b];
    Vec3 d = vec3_sub(b->next, a->next);
    double length = vec3_length(d), mobile = step * step * (a->weight + b->weight);
    s->multiplier = 0;
    if (!(length > 0) || !isfinite(s->compliance) || s->compliance == 0) return;
    s->multiplier = s->compliance / (s->compliance + mobile) * s->force * step * step;
    pull(a, b, vec3_scale(d, 1 / length), s->multiplier);
}

static void relax_all(Cloth *cloth, double step) {
    size_t count = cloth->spring_count;
    for (size_t i = 0; i < count; i++) begin_with_forces(&cloth->springs[i], cloth->masses, step);
    for (size_t i = 0; i < count; i++) relax(&cloth->springs[i], cloth->masses, step);
    for (size_t i = 0; i < count; i++) cloth->springs[i].force = cloth->springs[i].multiplier / (step * step);
}

enum { MOST_SHORTENINGS = 60 };

static void shorten_all(const Cloth *cloth) {
    bool again = true;
    for (int k = 0; k < MOST_SHORTENINGS && again; k++) {
        again = false;
        for (size_t i = 0; i < cloth->spring_count; i++)
            again |= shorten(&cloth->springs[k & 1 ? i : cloth->spring_count - 1 - i], cloth->masses);
    }
}

static void advance(Cloth *cloth, double step) {
    Mass *masses = cloth->masses;
    double kept = exp(-cloth->spec.damping * step);
    for (size_t i = 0; i < cloth->mass_count; i++) {
        Mass *m = &masses[i];
        if (m->weight == 0) continue;
        m->speed = vec3_scale(vec3_madd(vec3_madd(m->speed, cloth->spec.gravity, step), m->blown, step * m->weight), kept);
        m->next = vec3_madd(m->place, m->speed, step);
    }
    relax_all(cloth, step);
    shorten_all(cloth);
    for (size_t i = 0; i < cloth->mass_count; i++) {
        Mass *m = &masses[i];
        if (m->weight == 0) continue;
        Vec3 moved = vec3_sub(m->next, m->place);
        cloth->limit += vec3_dot(m->blown, moved);
        m->speed = vec3_scale(moved, 1 / step);
        m->place = m->next;
    }
    keep_energy(cloth);
}

/* ---- wind ---- */

/* Of a wind along a face, what rubs: this share of what it would press from the front. */
static const double FRICTION = 0.25;

static void blow_on_face(Cloth *cloth, int i, int j, double time) {
    const ClothSpec *s = &cloth->spec;
    Mass *corner[4] = {&cloth->masses[mass_at(s, i, j)], &cloth->masses[mass_at(s, i + 1, j)],
                       &cloth->masses[mass_at(s, i + 1, j + 1)], &cloth->masses[mass_at(s, i, j + 1)]};
    Vec3 middle = vec3_splat(0);
    for (int k = 0; k < 4; k++) middle = vec3_madd(middle, corner[k]->place, 0.25);
    Vec3 face = vec3_scale(vec3_cross(vec3_sub(corner[2]->place, corner[0]->place), vec3_sub(corner[3]->place, corner[1]->place)), 0.5);
    double area = vec3_length(face);
    Vec3 normal = vec3_normalize(face), wind = wind_force(s->wind, middle, time);
    Vec3 force = vec3_madd(vec3_scale(wind, FRICTION), normal, (1 - FRICTION) * vec3_dot(wind, normal));
    for (int k = 0; k < 4; k++) corner[k]->blown = vec3_madd(corner[k]->blown, force, area / 4);
}

static void blow(Cloth *cloth) {
    if (!cloth->spec.wind) return;
    for (size_t i = 0; i < cloth->mass_count; i++) cloth->masses[i].blown = vec3_splat(0);
    for (int i = 0; i < cloth->spec.nu; i++)
        for (int j = 0; j < cloth->spec.nv; j++) blow_on_face(cloth, i, j, (double)cloth->tick / CLOTH_TICKS);
}

/* ---- time ---- */

static void run_tick(Cloth *cloth) {
    blow(cloth);
    for (int k = 0; k < cloth->steps; k++) advance(cloth, 1.0 / CLOTH_TICKS / cloth->steps);
    cloth->tick++;
}

/* A part of a tick, as its end would be seen from there; the cloth itself stays at the tick. */
static void look_ahead(Cloth *cloth, double part, Vec3 *places) {
    Mass *now = cloth->masses;
    double limit = cloth->limit;
    memcpy(cloth->ahead, now, cloth->mass_count * sizeof *now);
    for (size_t i = 0; i < cloth->spring_count; i++) cloth->springs[i].tick_force = cloth->springs[i].force;
    cloth->masses = cloth->ahead;
    blow(cloth);
    int steps = (int)ceil(part * cloth->steps);
    for (int k = 0; k < steps; k++) advance(cloth, part / CLOTH_TICKS / steps);
    for (size_t i = 0; i < cloth->mass_count; i++) places[i] = cloth->ahead[i].place;
    for (size_t i = 0; i < cloth->spring_count; i++) cloth->springs[i].force = cloth->springs[i].tick_force;
    cloth->masses = now;
    cloth->limit = limit;
}

/* Times of frames are rounded: a hair before a tick is the tick. */
static double whole_ticks(double ticks) { return floor(ticks + 1e-6); }

uint64_t cloth_tick_of(double time) { return (uint64_t)double_clamp(whole_ticks(time * CLOTH_TICKS), 0, 1e15); }

/* ---- state ---- */

enum { STATE_HEAD = 2, STATE_OF_MASS = 9, STATE_OF_SPRING = 2 };

size_t cloth_state_count(const Cloth *cloth) {
    return STATE_HEAD + STATE_OF_MASS * cloth->mass_count + STATE_OF_SPRING * cloth->spring_count;
}

void cloth_save_state(const Cloth *cloth, double *state) {
    *state++ = (double)cloth->tick;
    *state++ = cloth->limit;
    for (size_t i = 0; i < cloth->mass_count; i++) {
        const Mass *m = &cloth->masses[i];
        const double numbers[STATE_OF_MASS] = {m->place.x, m->place.y, m->place.z, m->speed.x, m->speed.y, m->speed.z, m->next.x, m->next.y, m->next.z};
        memcpy(state, numbers, sizeof numbers);
        state += STATE_OF_MASS;
    }
    for (size_t i = 0; i < cloth->spring_count; i++) {
        *state++ = cloth->springs[i].multiplier;
        *state++ = cloth->springs[i].force;
    }
}

bool cloth_load_state(Cloth *cloth, const double *state) {
    for (size_t i = 0; i < cloth_state_count(cloth); i++)
        if (!isfinite(state[i])) return false;
    if (!(state[0] >= 0 && state[0] < 1e15 && state[0] == floor(state[0]))) return false;
    cloth->tick = (uint64_t)*state++;
    cloth->limit = *state++;
    for (size_t i = 0; i < cloth->mass_count; i++, state += STATE_OF_MASS) {
        Mass *m = &cloth->masses[i];
        m->place = vec3(state[0], state[1], state[2]);
        m->speed = vec3(state[3], state[4], state[5]);
        m->next = vec3(state[6], state[7], state[8]);
    }
    for (size_t i = 0; i < cloth->spring_count; i++) {
        cloth->springs[i].multiplier = *state++;
        cloth->springs[i].force = *state++;
    }
    return true;
}

Hash128 cloth_spec_hash(const ClothSpec *s) {
    enum { RULES = 1 }; /* another number when the same sheet moves otherwise */
    Hash128 hash = hash_begin(RULES);
    const double numbers[] = {s->width, s->height, s->nu, s->nv, s->pins, s->mass, s->stiffness, s->shear, s->bend, s->damping, s->elongation,
                              s->gravity.x, s->gravity.y, s->gravity.z, s->unrest, s->wind != NULL};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&hash, numbers[i]);
    if (s->wind) hash_add_hash(&hash, s->wind->hash);
    return hash;
}

bool cloth_follow(Cloth *cloth, double time, const atomic_bool *interrupted, Vec3 *places) {
    double ticks = fmax(0, time * CLOTH_TICKS), whole = whole_ticks(ticks);
    while ((double)cloth->tick < whole) {
        if (interrupted && *interrupted) return false;
        run_tick(cloth);
    }
    if (ticks - whole > 1e-6) {
        look_ahead(cloth, ticks - whole, places);
        return true;
    }
    for (size_t i = 0; i < cloth->mass_count; i++) places[i] = cloth->masses[i].place;
    return true;
}

double cloth_longest(const Cloth *cloth) {
    double longest = 0;
    for (size_t i = 0; i < cloth->spring_count; i++) {
        const Spring *s = &cloth->springs[i];
        if (!isfinite(s->longest)) continue;
        longest = fmax(longest, vec3_length(vec3_sub(cloth->masses[s->b].place, cloth->masses[s->a].place)) / s->rest);
    }
    return longest;
}
