#include "grow/cloth.h"

#include "base/random.h"
#include "grow/wind.h"


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

static void lay_masses(const ClothSpec *s, SpringNet *net) {
    double cell = s->mass / ((double)s->nu * s->nv), unrest = s->unrest * fmin(s->width, s->height);
    for (int i = 0; i <= s->nu; i++)
        for (int j = 0; j <= s->nv; j++) {
            uint32_t k = mass_at(s, i, j);
            NetMass *m = &net->masses[k];
            *m = (NetMass){.place = {s->width * ((double)i / s->nu - 0.5), s->height * ((double)j / s->nv - 0.5), 0},
                        .mass = cell * side_share(i, s->nu) * side_share(j, s->nv)};
            m->next = m->place;
            if (is_pinned(s, i, j)) continue;
            m->weight = 1 / m->mass;
            m->speed.z = unrest * (2 * random_unit(random_hash(k, 0, 0, 0)) - 1);
        }
}

static void add_spring(SpringNet *net, uint32_t a, uint32_t b, double stiffness, double elongation) {
    if (net->masses[a].weight == 0 && net->masses[b].weight == 0) return;
    double rest = vec3_length(vec3_sub(net->masses[b].place, net->masses[a].place));
    net->springs[net->spring_count++] =
        (NetSpring){.a = a, .b = b, .rest = rest, .compliance = stiffness > 0 ? 1 / stiffness : HUGE_VAL,
                 .longest = rest * (1 + elongation)};
}

/* All springs whose first end is mass i, j. A spring stands for a strip as wide as a cell, at a side half as wide. */
static void lay_springs_at(const ClothSpec *s, SpringNet *net, int i, int j) {
    uint32_t here = mass_at(s, i, j);
    double aspect = s->height / s->nv / (s->width / s->nu), along_u = s->stiffness * aspect * side_share(j, s->nv),
           along_v = s->stiffness / aspect * side_share(i, s->nu), shear = s->stiffness * s->shear;
    if (i < s->nu) add_spring(net, here, mass_at(s, i + 1, j), along_u, s->elongation);
    if (j < s->nv) add_spring(net, here, mass_at(s, i, j + 1), along_v, s->elongation);
    if (i < s->nu && j < s->nv) add_spring(net, here, mass_at(s, i + 1, j + 1), shear, s->elongation);
    if (i < s->nu && j > 0) add_spring(net, here, mass_at(s, i + 1, j - 1), shear, s->elongation);
    if (i + 2 <= s->nu) add_spring(net, here, mass_at(s, i + 2, j), along_u * s->bend / 2, HUGE_VAL);
    if (j + 2 <= s->nv) add_spring(net, here, mass_at(s, i, j + 2), along_v * s->bend / 2, HUGE_VAL);
}

/* A step sweeps over the springs once, which carries forces over the whole sheet, but not all of them: what is missing stretches
 * stiff springs by the square of the masses in a row and of the step. */
static int steps_for(const ClothSpec *s) { return int_min(int_max(2 * int_max(s->nu, s->nv) / 3, 16), 64); }

double cloth_work(const ClothSpec *s) { return 6.0 * (double)cloth_mass_count(s) * steps_for(s) * NET_TICKS; }

/* ---- wind ---- */

/* Of a wind along a face, what rubs: this share of what it would press from the front. */
static const double FRICTION = 0.25;

static void blow_on_face(const ClothSpec *s, SpringNet *net, int i, int j, double time) {
    NetMass *corner[4] = {&net->masses[mass_at(s, i, j)], &net->masses[mass_at(s, i + 1, j)],
                       &net->masses[mass_at(s, i + 1, j + 1)], &net->masses[mass_at(s, i, j + 1)]};
    Vec3 middle = vec3_splat(0);
    for (int k = 0; k < 4; k++) middle = vec3_madd(middle, corner[k]->place, 0.25);
    Vec3 face = vec3_scale(vec3_cross(vec3_sub(corner[2]->place, corner[0]->place), vec3_sub(corner[3]->place, corner[1]->place)), 0.5);
    double area = vec3_length(face);
    Vec3 normal = vec3_normalize(face), wind = wind_force(s->wind, middle, time);
    Vec3 force = vec3_madd(vec3_scale(wind, FRICTION), normal, (1 - FRICTION) * vec3_dot(wind, normal));
    for (int k = 0; k < 4; k++) corner[k]->blown = vec3_madd(corner[k]->blown, force, area / 4);
}

static void blow(SpringNet *net, double time) {
    const ClothSpec *s = net->context;
    for (size_t i = 0; i < net->mass_count; i++) net->masses[i].blown = vec3_splat(0);
    for (int i = 0; i < s->nu; i++)
        for (int j = 0; j < s->nv; j++) blow_on_face(s, net, i, j, time);
}

/* ---- the whole ---- */

SpringNet *cloth_create(const ClothSpec *spec, Arena *arena) {
    SpringNet *net = arena_new(arena, SpringNet);
    ClothSpec *own = arena_new(arena, ClothSpec);
    *own = *spec;
    net_init(net, cloth_mass_count(spec), 6 * cloth_mass_count(spec), arena);
    net->context = own;
    net->blow = spec->wind ? blow : NULL;
    net->gravity = spec->gravity;
    net->damping = spec->damping;
    net->bounded = true;
    net->steps = steps_for(spec);
    lay_masses(spec, net);
    for (int i = 0; i <= spec->nu; i++)
        for (int j = 0; j <= spec->nv; j++) lay_springs_at(spec, net, i, j);
    net->limit = net_energy(net);
    return net;
}

Hash128 cloth_spec_hash(const ClothSpec *s) {
    enum { RULES = 2 }; /* another number when the same sheet moves otherwise */
    Hash128 hash = hash_begin(RULES);
    const double numbers[] = {s->width, s->height, s->nu, s->nv, s->pins, s->mass, s->stiffness, s->shear, s->bend, s->damping, s->elongation,
                              s->gravity.x, s->gravity.y, s->gravity.z, s->unrest, s->wind != NULL};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&hash, numbers[i]);
    if (s->wind) hash_add_hash(&hash, s->wind->hash);
    return hash;
}

double cloth_longest(const SpringNet *net) {
    double longest = 0;
    for (size_t i = 0; i < net->spring_count; i++) {
        const NetSpring *s = &net->springs[i];
        if (!isfinite(s->longest)) continue;
        longest = fmax(longest, vec3_length(vec3_sub(net->masses[s->b].place, net->masses[s->a].place)) / s->rest);
    }
    return longest;
}
