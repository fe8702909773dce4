/* A few pixels of pictures without skins, drawn with each stage finer and coarser, tell what its error and its time are; by counts, not by clocks, so that
 * the same scene is the same picture anywhere. */
#include "base/random.h"
#include "render/integrate.h"

/* One pixel of so many is tried, at most so many; fewer than the least tell nothing. */
enum { PIXELS_A_TRIAL = 256, LEAST_TRIALS = 8, MOST_TRIALS = 64, NOISE_SAMPLES = 4 };
/* Slacks tried: as good as none, what stages do by themselves, and more. */
static const double FINE = 0.25, COARSE = 4;
static const double LEAST_SLACK = 0.25, MOST_SLACK = 8;
/* Of what is not seen to be wrong at all, so much of the accepted error is thought to be: chance may have missed it. */
static const double UNSEEN = 0.03;
/* How it falls with the samples, of edges and penumbras. */
static const double NOISE_POWER = 0.75;
/* Times of one ray, and of one place in a medium: their ratios count. */
static const double RAY = 0.6e-6, PLACE = 0.25e-6;
/* Stages that take their time in each sample make the samples dear, and samples make them dear: so often they are weighed in turn. */
enum { ROUNDS = 4 };

typedef struct Trial {
    CompiledScene *compiled;
    Tracer tracer;
    const Vec3f *fine; /* of each pixel */
    int count;
} Trial;

static void pixel_of(const Trial *t, int i, int *x, int *y) {
    const View *view = &t->compiled->view;
    uint64_t bits = random_hash((uint64_t)i, 0, 0, 37);
    *x = int_min((int)((i + random_unit(bits)) * view->width / t->count), view->width - 1);
    *y = int_min((int)(random_unit(random_mix(bits)) * view->height), view->height - 1);
}

/* What is no number is dark, too. */
static float shown(float light) { return light > 0 ? float_min(light, 1) : 0; }

static Vec3f see(Trial *t, double x, double y, double part, uint64_t seed) {
    const CompiledScene *compiled = t->compiled;
    Cone cone;
    SurfaceHit hit;
    float reaching;
    t->tracer.seed = random_hash(seed, 0, 0, 41);
    t->tracer.draw = (Draw){t->tracer.seed, 0};
    t->tracer.part = part;
    double u = 0.5, v = 0.5;
    if (part < 1 && view_has_lens(&compiled->view)) draw_pair(&t->tracer.draw, DRAW_LENS, &u, &v);
    if (!view_ray(&compiled->view, x, y, u, v, sqrt(part), &cone)) return vec3f(0, 0, 0);
    Ray ray = {cone.origin, cone.direction};
    bool found = hierarchy_meet_wide(compiled->hierarchy, RAY_SEES, &ray, cone_width(&cone), 1e-9, VTS_INFINITY, false, &hit);
    Vec3f c = trace_cone(&t->tracer, &cone, found ? &hit : NULL, &reaching).color;
    return vec3f(shown(c.x), shown(c.y), shown(c.z));
}

static double seconds_so_far(const Trial *t) {
    const TraceCounters *c = &t->tracer.counters;
    return RAY * (double)(c->camera_rays + c->shadow_rays) + PLACE * (double)c->places;
}

/* All trial pixels once, by lines of sight that are this part of a pixel's. Returns the time. */
static double see_all(Trial *t, double part, Vec3f *out) {
    double before = seconds_so_far(t);
    for (int i = 0; i < t->count; i++) {
        int x, y;
        pixel_of(t, i, &x, &y);
        out[i] = see(t, x + 0.5, y + 0.5, part, (uint64_t)i);
    }
    return seconds_so_far(t) - before;
}

static double rms_apart(const Trial *t, const Vec3f *colors) {
    double sum = 0;
    for (int i = 0; i < t->count; i++) {
        Vec3f off = vec3f_sub(colors[i], t->fine[i]);
        sum += (double)vec3f_dot(off, off) / 3;
    }
    return sqrt(sum / t->count);
}

/* Of one sample in the pixel, anywhere: its deviation. */
static double deviation(Trial *t) {
    double sum = 0;
    for (int i = 0; i < t->count; i++) {
        int x, y;
        pixel_of(t, i, &x, &y);
        Vec3f mean = {0, 0, 0};
        double squares = 0;
        for (int k = 0; k < NOISE_SAMPLES; k++) {
            Draw draw = {random_hash((uint64_t)i, 0, 0, 43), (uint32_t)k};
            double u, v;
            draw_pair(&draw, DRAW_PIXEL, &u, &v);
            Vec3f c = see(t, x + u, y + v, 1.0 / NOISE_SAMPLES, draw.pixel + (uint64_t)k);
            mean = vec3f_madd(mean, c, 1.0f / NOISE_SAMPLES);
            squares += (double)vec3f_dot(c, c) / NOISE_SAMPLES;
        }
        sum += fmax(squares - (double)vec3f_dot(mean, mean), 0) / 3 * NOISE_SAMPLES / (NOISE_SAMPLES - 1);
    }
    return sqrt(sum / t->count);
}

static double samples_for(double one, double accepted) { return pow(one / accepted, 1 / NOISE_POWER); }

/* Media are asked in every sample; the sky by all of a pixel together, each a part of its directions. */
static double lines_together(BudgetStage stage, double samples) { return stage == BUDGET_SKY ? fmax(samples, 1) : 1; }

static BudgetLaw law_of(Trial *t, BudgetStage stage, double samples, Vec3f *colors) {
    double errors[2], seconds[2], lines = lines_together(stage, samples), *slack = &t->compiled->budget.slack[stage];
    for (int k = 0; k < 2; k++) {
        *slack = k ? COARSE : 1;
        seconds[k] = see_all(t, 1, colors) / t->count;
        errors[k] = fmax(rms_apart(t, colors), UNSEEN * t->compiled->max_error);
        if (lines > 1) seconds[k] = lines * see_all(t, 1 / lines, colors) / t->count;
    }
    *slack = FINE;
    BudgetLaw law = budget_law(errors, seconds, COARSE);
    if (law.fall > 0) law.least = LEAST_SLACK, law.most = MOST_SLACK; /* else nothing is to be saved */
    return law;
}

/* Of the samples: their error is what is accepted of them, and time goes as their number, which falls with it. */
static BudgetLaw law_of_noise(double accepted, double one, double seconds) {
    double samples = samples_for(one, accepted);
    return (BudgetLaw){accepted, 1, seconds * fmax(samples, 1), samples > 1 ? 1 / NOISE_POWER : 0, BUDGET_LEAST_NOISE, 1};
}

static void weigh(Budget *b, double accepted, double one, double seconds) {
    double slack[BUDGET_STAGES];
    BudgetLaw laws[BUDGET_STAGES];
    for (int round = 0; round < ROUNDS; round++) {
        double samples = samples_for(one, accepted * b->slack[BUDGET_NOISE]), each = seconds;
        for (int i = 0; i < BUDGET_STAGES; i++) {
            laws[i] = b->laws[i];
            if (i == BUDGET_NOISE || !b->known[i]) continue;
            if (i == BUDGET_SKY) continue;
            each += budget_seconds(&b->laws[i], b->slack[i]) - b->laws[i].seconds;
            laws[i].seconds *= fmax(samples, 1);
        }
        laws[BUDGET_NOISE] = b->laws[BUDGET_NOISE] = law_of_noise(accepted, one, fmax(each, 0.1 * seconds));
        budget_split(laws, BUDGET_STAGES, accepted, slack);
        for (int i = 0; i < BUDGET_STAGES; i++)
            if (b->known[i]) b->slack[i] = slack[i];
    }
}

static void try_stages(Trial *t, const bool *wanted) {
    CompiledScene *compiled = t->compiled;
    Budget *b = &compiled->budget, found = *b;
    Vec3f *fine = arena_new_array(&compiled->scratch, Vec3f, (size_t)t->count), *colors = arena_new_array(&compiled->scratch, Vec3f, (size_t)t->count);
    for (int i = 0; i < BUDGET_STAGES; i++) b->slack[i] = wanted[i] ? FINE : 1;
    double each = see_all(t, 1, fine) / t->count, one = deviation(t), samples = samples_for(one, compiled->max_error);
    t->fine = fine;
    for (int i = 0; i < BUDGET_STAGES; i++) {
        found.known[i] = wanted[i];
        if (!wanted[i] || i == BUDGET_NOISE) continue;
        found.laws[i] = law_of(t, (BudgetStage)i, samples, colors);
        if (i == BUDGET_MEDIA) each = fmin(each, found.laws[i].seconds);
    }
    *b = found;
    weigh(b, compiled->max_error, one, fmax(each, RAY));
    b->slack[BUDGET_NOISE] = budget_left(b, compiled->max_error);
}

void budget_trial(CompiledScene *compiled) {
    const Scene *scene = compiled->scene;
    const View *view = &compiled->view;
    bool wanted[BUDGET_STAGES] = {[BUDGET_NOISE] = true, [BUDGET_MEDIA] = scene->has_media, [BUDGET_SKY] = scene->settings.sky_light};
    int64_t pixels = (int64_t)view->width * view->height;
    if (compiled->exact_paths || compiled->skin_count || compiled->volumes || !(wanted[BUDGET_MEDIA] || wanted[BUDGET_SKY])) return;
    if (pixels < LEAST_TRIALS * PIXELS_A_TRIAL) return;
    ArenaMark mark = arena_mark(&compiled->scratch);
    Trial t = {.compiled = compiled, .count = (int)(pixels < MOST_TRIALS * PIXELS_A_TRIAL ? pixels / PIXELS_A_TRIAL : MOST_TRIALS)};
    tracer_init(&t.tracer, compiled, &compiled->scratch);
    try_stages(&t, wanted);
    compiled->trials += t.count;
    arena_reset_to(&compiled->scratch, mark);
}
