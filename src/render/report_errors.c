#include "render/report_errors.h"

/* One stage; errors are RMSE of the picture. */
typedef struct Stage {
    const char *name, *unit;
    double allowed, made; /* negative: not known */
    double count;         /* of units that it took */
} Stage;

static void add_error(StrBuf *out, const char *key, double error) {
    if (error >= 0)
        strbuf_addf(out, ",\"%s\":%.6f", key, error);
    else
        strbuf_addf(out, ",\"%s\":null", key);
}

static void add_stage(StrBuf *out, const char **comma, const Stage *s) {
    strbuf_addf(out, "%s{\"stage\":\"%s\"", *comma, s->name);
    add_error(out, "allowed", s->allowed);
    add_error(out, "made", s->made);
    strbuf_addf(out, ",\"unit\":\"%s\",\"count\":%.6g}", s->unit, s->count);
    *comma = ",";
}

static double tried(const CompiledScene *compiled, BudgetStage stage) {
    const Budget *b = &compiled->budget;
    return b->known[stage] ? budget_error(&b->laws[stage], b->slack[stage]) : -1;
}

static size_t terrain_triangles(const BuiltTerrains *terrains) {
    size_t sum = 0;
    for (size_t i = 0; i < terrains->count; i++) sum += terrains->items[i].triangles;
    return sum;
}

void report_errors(StrBuf *out, const CompiledScene *compiled, const RenderStats *stats) {
    const TraceCounters *c = &stats->counters;
    const Scene *scene = compiled->scene;
    const double noise = compiled->max_error * compiled->budget.slack[BUDGET_NOISE];
    const bool shared = compiled->budget.known[BUDGET_NOISE];
    const double left =
        shared ? sqrt(fmax(compiled->max_error * compiled->max_error - noise * noise, 0)) : -1;
    const char *comma = "";
    strbuf_adds(out, ",\"errors\":[");
    add_stage(out, &comma,
              &(Stage){"samples", "lines of sight a pixel", scene->settings.samples > 0 ? -1 : noise,
                       stats->noise_estimate,
                       stats->pixels ? (double)c->camera_rays / (double)stats->pixels : 0});
    if (compiled->voxels && compiled->skin_count)
        add_stage(out, &comma,
                  &(Stage){"voxels", "voxels read", VOXELS_SHARE * compiled->max_error,
                           stats->voxels_estimate, (double)c->voxels_visited});
    if (compiled->volumes)
        add_stage(out, &comma,
                  &(Stage){"volumes", "rays of the light pass", compiled->max_error,
                           compiled->volume_rays > 0 ? compiled->volume_error : -1, compiled->volume_rays});
    if (scene->settings.sky_light)
        add_stage(out, &comma,
                  &(Stage){"sky", "rays to lights and sky", left, tried(compiled, BUDGET_SKY),
                           (double)c->shadow_rays});
    if (scene->has_media)
        add_stage(out, &comma,
                  &(Stage){"media", "places", left, tried(compiled, BUDGET_MEDIA), (double)c->places});
    if (compiled->terrains.count)
        add_stage(out, &comma,
                  &(Stage){"terrain", "triangles", TERRAIN_SHARE * compiled->max_error, -1,
                           (double)terrain_triangles(&compiled->terrains)});
    strbuf_addc(out, ']');
}
