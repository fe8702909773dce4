#include "pattern/bump.h"

#include "pattern/colormap.h"
#include "pattern/pattern.h"
#include "pattern/pigment.h"
#include "pattern/values.h"

/* ---- between the spaces ---- */

static Vec3 normal_back(const Transform *t, Vec3 n) { return mat3_apply_transposed(&t->linear, n); }

/* POV-Ray's rule of bump sizes: unless they are unscaled, normals begin and end at unit length in pattern space. */
static Vec3 settled(const Normal *normal, Vec3 n) { return normal->unscaled ? n : vec3_normalize(n); }

static Vec3 normal_in_pattern(const Normal *normal, const BumpPlace *place, Vec3 n) {
    const Pigment *pattern = normal->pattern;
    for (int k = 0; k < 2; k++)
        if (place->outer[k]) n = normal_back(place->outer[k], n);
    n = normal_back(&pattern->transform, n);
    for (size_t i = pattern->warp_count; i-- > 0;) n = normal_back(&pattern->warps[i].inner, n);
    return settled(normal, n);
}

static Vec3 normal_out_of_pattern(const Normal *normal, const BumpPlace *place, Vec3 n) {
    const Pigment *pattern = normal->pattern;
    for (size_t i = 0; i < pattern->warp_count; i++) n = transform_normal(&pattern->warps[i].inner, n);
    n = transform_normal(&pattern->transform, n);
    for (int k = 2; k-- > 0;)
        if (place->outer[k]) n = transform_normal(place->outer[k], n);
    return settled(normal, n);
}

static Spot spot_at(const Pigment *pattern, const BumpPlace *place) {
    Spot spot = *place->spot;
    for (int k = 0; k < 2; k++)
        if (place->outer[k]) spot = spot_back(&spot, place->outer[k]);
    return spot_in_pattern(pattern, &spot, pattern_traits(pattern->kind).warps_itself);
}

/* ---- heights ---- */

/* Cubics between the entries, which give height and slope; as POV-Ray has it, slopes count per interval. */
static double slope_height(const Normal *normal, double value) {
    const SlopeEntry *e = normal->slopes;
    size_t last = normal->slope_count - 1, k = 0;
    if (value <= e[0].position) return e[0].height;
    if (value >= e[last].position) return e[last].height;
    while (value >= e[k + 1].position) k++;
    double width = e[k + 1].position - e[k].position, t = (value - e[k].position) / width;
    double rise = e[k + 1].height - e[k].height, s0 = e[k].slope, s1 = e[k + 1].slope;
    return e[k].height + t * (s0 + t * (3 * rise - 2 * s0 - s1 + t * (s0 + s1 - 2 * rise)));
}

static double height_of(const Normal *normal, double value) {
    return normal->slope_count ? slope_height(normal, value) : value;
}

typedef struct HeightSum {
    const Normal *normal;
    double sum;
} HeightSum;

static void add_height(void *target, size_t entry, double share) {
    HeightSum *h = target;
    const Pigment *pattern = h->normal->pattern;
    double value = pattern_traits(pattern->kind).blocks || entry >= pattern->entry_count ? (double)entry
                                                                                          : pattern->entries[entry].position;
    h->sum += share * height_of(h->normal, value);
}

/* Whether heights are the pattern's values, which are means over the footprint themselves. */
static bool heights_are_means(const Normal *normal) {
    const Pigment *pattern = normal->pattern;
    const bool plain = pigment_wave(pattern) == WAVE_RAMP && pattern->frequency == 1 && pattern->phase == 0;
    return pattern->kind == PATTERN_PIGMENT && !normal->slope_count && plain;
}

/* The mean height over a spot of pattern space. */
static double height_at(const Normal *normal, const Spot *spot) {
    if (spot_is_point(spot) || heights_are_means(normal)) return height_of(normal, pattern_number(normal->pattern, spot));
    HeightSum sum = {normal, 0};
    pattern_blend(normal->pattern, spot, add_height, &sum);
    return sum.sum;
}

/* Four places about the spot, on a regular tetrahedron. */
static Vec3 gradient_bump(const Normal *normal, const BumpPlace *place, Vec3 n) {
    static const Vec3 corners[4] = {{0.942809041, -0.333333333, 0},
                                    {-0.471404521, -0.333333333, 0.816496581},
                                    {-0.471404521, -0.333333333, -0.816496581},
                                    {0, 1, 0}};
    double amount = -0.1 * normal->amount / normal->accuracy; /* POV-Ray's */
    Spot middle = spot_at(normal->pattern, place), corner = middle;
    for (int k = 0; k < 4; k++) {
        corner.p = vec3_madd(middle.p, corners[k], normal->accuracy);
        n = vec3_madd(n, corners[k], amount * height_at(normal, &corner));
    }
    return n;
}

/* ---- several ---- */

typedef struct NormalSum {
    const Normal *normal;
    Spot spot;
    Vec3 n, sum;
} NormalSum;

static void add_normal(void *target, size_t entry, double share) {
    NormalSum *s = target;
    if (entry >= s->normal->normal_count) return;
    BumpPlace place = {.spot = &s->spot};
    s->sum = vec3_madd(s->sum, bump_normal(s->normal->normals[entry], &place, s->n), share);
}

static Vec3 blended(const Normal *normal, const BumpPlace *place, Vec3 n) {
    NormalSum sum = {.normal = normal, .spot = spot_at(normal->pattern, place), .n = n};
    pattern_blend(normal->pattern, &sum.spot, add_normal, &sum);
    return vec3_length_squared(sum.sum) > 0 ? sum.sum : n;
}

Vec3 bump_normal(const Normal *normal, const BumpPlace *place, Vec3 n) {
    Vec3 inside = normal_in_pattern(normal, place, n);
    if (normal->form == NORMAL_GRADIENT) {
        inside = gradient_bump(normal, place, inside);
    } else if (normal->form == NORMAL_MAP) {
        inside = blended(normal, place, inside);
    } else {
        Spot spot = spot_at(normal->pattern, place);
        bool sized = normal->form != NORMAL_FACETS && normal->form != NORMAL_PICTURE;
        inside = vec3_madd(inside, bump_field(normal, &spot, inside), sized ? normal->amount : 1);
    }
    Vec3 out = normal_out_of_pattern(normal, place, inside);
    return vec3_is_finite(out) && vec3_length_squared(out) > 0 ? out : n;
}
