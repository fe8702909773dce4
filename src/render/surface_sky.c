/* Ambient light as the light of an even sky: what of the hemisphere over a surface is open. */
#include "base/random.h"
#include "render/surface.h"
#include "texel/texel_sky.h"

/* So many directions at first, and where they do not all see the same, many; both for a whole pixel. */
enum { FEWEST = 8, MOST_OF_FEW = 64, MOST_OF_MANY = 256, FEWEST_CONES = 4, MOST_CONES = 16 };
/* Whoever asks more because few disagree gets another mean than who always asks: with fewer than so many it would be seen. */
static const double LEAST_TWICE = 5;
/* What few directions may miss, and what many are wrong by, in parts of the accepted error. */
static const double MISSED = 2, WRONG = 0.5;
/* Of a net of n directions over a hemisphere of which a border hides a part: about SCATTER·n^(-3/4). */
static const double SCATTER = 0.3;
/* Pieces of matter are many in a pixel, and each is asked: of the error that each alone may have this part. */
static const double OF_MATTER = 0.25;
/* Light that would make less than this part of the accepted error is taken as unshadowed. */
static const double WORTH = 0.25;

/* A net of directions over the hemisphere: a spiral of equal areas on the disc below, which is denser the higher by the cosine, or on the hemisphere. */
typedef struct SkyNet {
    Vec3 up, across, along;
    bool even;
    int count;
    double turn, shift;
} SkyNet;

static Vec3 net_direction(const SkyNet *net, int i) {
    double part = (i + net->shift) / net->count, area = net->even ? part * (2 - part) : part, r = sqrt(area);
    double turn = 2 * VTS_PI * (net->turn + 0.6180339887498949 * i);
    Vec3 flat = vec3_add(vec3_scale(net->across, r * cos(turn)), vec3_scale(net->along, r * sin(turn)));
    return vec3_madd(flat, net->up, sqrt(1 - area));
}

/* One line of sight alone in its pixel has the same net as its neighbours, and no noise; of several each has another, and all of them
 * together lie well if there is a `draw`. */
static SkyNet net_of(const Draw *draw, const SkyPlace *place, double part, double count, uint64_t seed) {
    SkyNet net = {.up = place->normal, .even = place->even, .count = int_max(1, double_to_int(ceil(count * part), 1, MOST_OF_MANY)), .shift = 0.5};
    vec3_frame(net.up, &net.across, &net.along);
    if (part < 1 && draw) draw_pair(draw, DRAW_SKY + (uint32_t)place->leg->level * DRAW_STEP, &net.turn, &net.shift);
    else if (part < 1) net.turn = random_unit(random_mix(seed)), net.shift = random_unit(random_mix(seed + 1));
    return net;
}

typedef struct SkySum {
    Vec3f open;
    int asked;
    bool mixed; /* not all see the same */
} SkySum;

static void ask_net(SurfaceTracer *tracer, const SkyPlace *place, const SkyNet *net, SkySum *sum) {
    Vec3f first = {0, 0, 0};
    for (int i = 0; i < net->count; i++) {
        Vec3 d = net_direction(net, i);
        if (!(vec3_dot(d, place->flat) > 0)) continue; /* the normal is not quite that of the surface */
        Vec3f one = surface_open(tracer, &(Ray){place->point, d}, VTS_INFINITY, place->leg, place->clear);
        if (tracer->exact && (one.x > 0 || one.y > 0 || one.z > 0))
            one = vec3f_scale(one, tracer->passing(tracer->skins, &(Cone){place->point, d, 0, 0}, VTS_INFINITY, vec3_negate(place->leg->cone.direction)));
        if (sum->asked == 0) first = one;
        else if (one.x != first.x || one.y != first.y || one.z != first.z) sum->mixed = true;
        sum->open = vec3f_add(sum->open, one);
        sum->asked++;
    }
}

/* Of what is open the share that passes skins: they are asked by a few wide cones, as they are coarse for them. */
static float through_skins(SurfaceTracer *tracer, const SkyPlace *place, const SkyNet *net) {
    double spread = sqrt(VTS_PI / net->count); /* of its part of the net */
    Vec3 to_eye = vec3_negate(place->leg->cone.direction);
    float sum = 0, asked = 0;
    for (int i = 0; i < net->count; i++) {
        Cone cone = {place->point, net_direction(net, i), 0, spread};
        if (!(vec3_dot(cone.direction, place->flat) > 0)) continue;
        Vec3f open = surface_open(tracer, &(Ray){cone.origin, cone.direction}, VTS_INFINITY, place->leg, place->clear);
        float weight = open.x + open.y + open.z;
        if (!(weight > 0)) continue;
        float passed = tracer->passing(tracer->skins, &cone, VTS_INFINITY, to_eye);
        sum += weight * (passed + (1 - passed) * sky_open_to_eye((float)vec3_dot(cone.direction, to_eye)));
        asked += weight;
    }
    return asked > 0 ? sum / asked : 1;
}

/* Whether all explicit objects lie under the place's horizon. */
static bool nothing_above(const SurfaceTracer *tracer, const SkyPlace *place) {
    Box3 box;
    if (!hierarchy_bounds(tracer->compiled->hierarchy, &box)) return false;
    if (box3_is_empty(box)) return true;
    Vec3 n = place->flat, highest = vec3(n.x > 0 ? box.max.x : box.min.x, n.y > 0 ? box.max.y : box.min.y, n.z > 0 ? box.max.z : box.min.z);
    return vec3_dot(vec3_sub(highest, place->point), n) <= 0;
}

/* Past explicit objects; and past skins, where these are asked by rays. */
static Vec3f past_objects(SurfaceTracer *tracer, const SkyPlace *place, double part, double few, double many, uint64_t seed) {
    SkySum sum = {{0, 0, 0}, 0, false};
    bool twice = few * part >= LEAST_TWICE;
    SkyNet net = net_of(tracer->draw, place, part, twice ? fmax(few, FEWEST / part) : many, seed);
    if (!tracer->exact && nothing_above(tracer, place)) return vec3f(1, 1, 1);
    ask_net(tracer, place, &net, &sum);
    if (twice && sum.mixed && many * part > net.count) {
        net = net_of(tracer->draw, place, part, many, seed + 2);
        ask_net(tracer, place, &net, &sum);
    }
    return sum.asked ? vec3f_scale(sum.open, 1 / (float)sum.asked) : vec3f(1, 1, 1);
}

Vec3f surface_sky(SurfaceTracer *tracer, const SkyPlace *place, float worth, uint64_t seed) {
    double part = tracer->part > 0 ? fmin(tracer->part, 1) : 1, error = tracer->compiled->max_error * tracer->compiled->budget.slack[BUDGET_SKY], contrast = (double)worth / error;
    if (!(contrast > WORTH)) return vec3f(1, 1, 1);
    if (place->even) contrast *= OF_MATTER;
    double few = double_clamp(contrast / MISSED, FEWEST, MOST_OF_FEW), many = double_clamp(pow(SCATTER * contrast / WRONG, 4.0 / 3), few, MOST_OF_MANY);
    Vec3f open = past_objects(tracer, place, part, few, many, seed);
    if (!tracer->passing || tracer->exact || !(open.x > 0 || open.y > 0 || open.z > 0)) return open;
    SkyNet net = net_of(NULL, place, part, double_clamp(few / 4, FEWEST_CONES, MOST_CONES), seed + 4);
    return vec3f_scale(open, through_skins(tracer, place, &net));
}
