#include "render/aov.h"

#include <string.h>

typedef struct AovRow {
    const char *name;
    int channels;
    const char *channel_names[3];
} AovRow;

static const AovRow ROWS[AOV_KINDS] = {
    [AOV_DEPTH] = {"depth", 1, {"depth"}},
    [AOV_NORMAL] = {"normal", 3, {"normal.X", "normal.Y", "normal.Z"}},
    [AOV_ALBEDO] = {"albedo", 3, {"albedo.R", "albedo.G", "albedo.B"}},
    [AOV_ALPHA] = {"alpha", 1, {"alpha"}},
    [AOV_POSITION] = {"position", 3, {"position.X", "position.Y", "position.Z"}},
    [AOV_OBJECT] = {"object", 1, {"object"}},
    [AOV_UV] = {"uv", 2, {"uv.U", "uv.V"}},
    [AOV_TEXEL_LEVEL] = {"texel_level", 1, {"texel_level"}},
    [AOV_SAMPLES] = {"samples", 1, {"samples"}},
};

static bool refuse(const char *name, size_t size, StrBuf *why) {
    if (!why) return false;
    strbuf_addf(why, "there is no channel '%.*s'; there are", (int)(size > 40 ? 40 : size), name);
    for (int k = 0; k < AOV_KINDS; k++) strbuf_addf(why, "%s %s", k ? "," : "", ROWS[k].name);
    return false;
}

static int find_kind(const char *name, size_t size) {
    for (int k = 0; k < AOV_KINDS; k++)
        if (strlen(ROWS[k].name) == size && memcmp(ROWS[k].name, name, size) == 0) return k;
    return -1;
}

static bool has_kind(const AovPlan *plan, AovKind kind) {
    for (int i = 0; i < plan->count; i++)
        if (plan->kinds[i] == kind) return true;
    return false;
}

bool aov_plan_parse(const char *names, AovPlan *out, StrBuf *why) {
    *out = (AovPlan){.count = 0};
    for (const char *p = names;; p++) {
        size_t size = strcspn(p, ",");
        int kind = find_kind(p, size);
        if (kind < 0) return refuse(p, size, why);
        if (!has_kind(out, (AovKind)kind)) {
            out->kinds[out->count++] = (AovKind)kind;
            for (int c = 0; c < ROWS[kind].channels; c++) out->names[out->channels++] = ROWS[kind].channel_names[c];
        }
        p += size;
        if (!*p) return true;
    }
}

void aov_add(AovSum *sum, const AovSample *s, double weight) {
    double w = weight * (double)s->share;
    if (!(w > 0)) return;
    if (!sum->object) sum->object = s->object;
    sum->covered += w;
    sum->depth += w * s->depth;
    sum->position = vec3_madd(sum->position, s->position, w);
    sum->normal = vec3_madd(sum->normal, vec3_from_f(s->normal), w);
    sum->albedo = vec3_madd(sum->albedo, vec3_from_f(s->albedo), w);
    sum->u += w * (double)s->u;
    sum->v += w * (double)s->v;
    if (s->level < 0) return;
    sum->leveled += w;
    sum->level += w * (double)s->level;
}

static void write_vector(Vec3 v, double scale, float *channels) {
    Vec3f f = vec3f_from(vec3_scale(v, scale));
    channels[0] = f.x, channels[1] = f.y, channels[2] = f.z;
}

static void write_kind(AovKind kind, const AovSum *s, float alpha, float *out) {
    double per_met = s->covered > 0 ? 1 / s->covered : 0, per_sample = s->samples > 0 ? 1.0 / s->samples : 0;
    switch (kind) {
    case AOV_DEPTH: out[0] = s->covered > 0 ? (float)(s->depth * per_met) : INFINITY; break;
    case AOV_NORMAL: write_vector(s->normal, per_sample, out); break;
    case AOV_ALBEDO: write_vector(s->albedo, per_sample, out); break;
    case AOV_ALPHA: out[0] = alpha; break;
    case AOV_POSITION: write_vector(s->position, per_met, out); break;
    case AOV_OBJECT: out[0] = (float)s->object; break;
    case AOV_UV: out[0] = (float)(s->u * per_met), out[1] = (float)(s->v * per_met); break;
    case AOV_TEXEL_LEVEL: out[0] = s->leveled > 0 ? (float)(s->level / s->leveled) : -1; break;
    case AOV_SAMPLES: out[0] = (float)s->samples; break;
    case AOV_KINDS: break;
    }
}

void aov_write(const AovPlan *plan, const AovSum *sum, float alpha, float *channels) {
    for (int i = 0; i < plan->count; i++) {
        write_kind(plan->kinds[i], sum, alpha, channels);
        channels += ROWS[plan->kinds[i]].channels;
    }
}
