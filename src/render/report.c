#include "render/report.h"

#include "render/report_errors.h"

static void add_text(StrBuf *out, const char *key, const char *text) {
    strbuf_addf(out, "\"%s\":", key);
    strbuf_add_json(out, text);
}

static void add_texels(StrBuf *out, const CompiledScene *compiled) {
    strbuf_adds(out, "\"texels\":[");
    for (size_t i = 0; i < compiled->texel_count; i++) {
        const BuiltTexel *t = compiled->texels[i];
        if (i) strbuf_addc(out, ',');
        strbuf_addc(out, '{');
        add_text(out, "name", t->def->name);
        if (t->asked) strbuf_addf(out, ",\"asked\":%d", t->asked);
        else strbuf_adds(out, ",\"asked\":\"auto\"");
        strbuf_addf(out, ",\"needed\":%d,\"built\":%d,\"voxels\":%zu,\"bytes\":%zu,\"build_s\":%.4f,\"cached\":%s}", t->needed,
                    t->built, t->voxel_count, t->bytes, t->build_seconds, t->cached ? "true" : "false");
    }
    strbuf_addc(out, ']');
}

static void add_terrains(StrBuf *out, const BuiltTerrains *terrains) {
    strbuf_adds(out, ",\"terrains\":[");
    for (size_t i = 0; i < terrains->count; i++) {
        const BuiltTerrain *t = &terrains->items[i];
        if (i) strbuf_addc(out, ',');
        strbuf_addc(out, '{');
        add_text(out, "name", t->terrain->file);
        strbuf_addf(out, ",\"posts\":[%d,%d],\"asked\":\"%s\",\"needed\":%zu,\"built\":%zu,\"bytes\":%zu,\"build_s\":%.4f}", t->columns, t->rows,
                    t->terrain->every_post ? "full" : "auto", t->needed, t->triangles, t->bytes, t->seconds);
    }
    strbuf_addc(out, ']');
}

/* Of each stage that trials were made of: the part of max_error that it is expected to make, the seconds of a pixel that it is thought to take (of an imagined
 * machine: only their ratios count), and how far it was let out or drawn in. */
static void add_budget(StrBuf *out, const CompiledScene *compiled) {
    static const char *const names[BUDGET_STAGES] = {"samples", "sky", "media"};
    const Budget *b = &compiled->budget;
    const char *comma = "";
    strbuf_adds(out, ",\"budget\":[");
    for (int i = 0; i < BUDGET_STAGES; i++) {
        if (!b->known[i]) continue;
        strbuf_addf(out, "%s{\"stage\":\"%s\",\"share\":%.4f,\"seconds\":%.3g,\"slack\":%.4g}", comma, names[i],
                    budget_error(&b->laws[i], b->slack[i]) / compiled->max_error, budget_seconds(&b->laws[i], b->slack[i]), b->slack[i]);
        comma = ",";
    }
    strbuf_addc(out, ']');
}

static void add_functions(StrBuf *out, const SolidWork *w) {
    strbuf_addf(out, "\"function_evaluations\":%llu,\"function_rays\":%llu,\"evaluations_per_ray\":%.4g,", (unsigned long long)w->evaluations,
                (unsigned long long)w->lines, w->lines ? (double)w->evaluations / (double)w->lines : 0);
    strbuf_addf(out, "\"missed_roots\":%llu,\"guaranteed\":%s,", (unsigned long long)w->unsettled, w->sampled ? "false" : "true");
}

void report_add_frame(StrBuf *out, const FrameReport *f) {
    const TraceCounters *c = &f->stats->counters;
    if (out->size) strbuf_addc(out, ',');
    strbuf_addf(out, "{\"frame\":%d,\"clock\":%.9g,", f->frame, f->clock);
    add_text(out, "output", f->output);
    strbuf_addf(out, ",\"wall_s\":%.4f,\"cpu_s\":%.4f,\"parse_s\":%.4f,\"build_s\":%.4f,\"render_s\":%.4f,", f->wall_s, f->cpu_s,
                f->parse_s, f->build_s, f->render_s);
    strbuf_addf(out, "\"peak_rss_bytes\":%zu,\"rays\":{\"camera\":%llu,\"shadow\":%llu},\"voxels_visited\":%llu,", f->peak_rss_bytes,
                (unsigned long long)c->camera_rays, (unsigned long long)c->shadow_rays, (unsigned long long)c->voxels_visited);
    add_functions(out, &c->functions);
    add_texels(out, f->compiled);
    add_budget(out, f->compiled);
    report_errors(out, f->compiled, f->stats);
    add_terrains(out, &f->compiled->terrains);
    if (f->stats->error_estimate >= 0) strbuf_addf(out, ",\"error_estimate\":%.6f", f->stats->error_estimate);
    else strbuf_adds(out, ",\"error_estimate\":null");
    strbuf_addf(out, ",\"error_noise\":%.6f", f->stats->noise_estimate);
    strbuf_addf(out, ",\"stages\":{\"parse_s\":%.4f,\"build_s\":%.4f,\"build_cpu_s\":%.4f,\"render_s\":%.4f,\"write_s\":%.4f,"
                     "\"march_steps\":%llu,\"texel_triangles\":%llu,\"split_pixels\":%llu,\"kept_tiles\":%llu,\"kept_moments\":%llu,\"moments\":%llu,\"trials\":%d,\"volume_light_kept\":%s}}",
                f->parse_s, f->build_s, f->build_cpu_s, f->render_s, f->write_s, (unsigned long long)c->steps, (unsigned long long)c->triangles,
                (unsigned long long)f->stats->split_pixels, (unsigned long long)f->stats->kept_tiles, (unsigned long long)f->stats->kept_moments, (unsigned long long)f->stats->moments, f->compiled->trials, f->compiled->volume_light_kept ? "true" : "false");
}

void report_write(StrBuf *out, const char *scene, const char *version, const StrBuf *frames) {
    strbuf_addc(out, '{');
    add_text(out, "scene", scene);
    strbuf_addc(out, ',');
    add_text(out, "version", version);
    strbuf_adds(out, ",\"frames\":[");
    strbuf_adds(out, frames->size ? frames->data : "");
    strbuf_adds(out, "]}\n");
}
