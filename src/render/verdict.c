#include "render/verdict.h"

#include "render/surface.h"

#include <string.h>

/* Estimates are within a factor of two, mostly within a quarter: only what is well above is told, and far above where nobody named an error. */
static const double WELL_ABOVE = 1.5, FAR_ABOVE = 3;
/* Of the square of the error, the part from which noise is the cause. */
static const double MOSTLY_NOISE = 0.5;

/* What makes most of the error, and what changes it. */
typedef struct Cause {
    const char *name, *knob;
} Cause;

static const Cause NOISE_UNASKED = {"samples are noisy", "name a max_error, in global_settings or by --max-error: pixels may then take four times as many samples"},
                   NOISE = {"samples are noisy", "what is much finer than a pixel takes more samples than a pixel may have, 256: a larger picture, or 'samples 256'"},
                   VOXELS = {"voxels are seen", "'detail exact' draws their triangles, which may take long; a finer 'resolution' helps where voxels are wider than pixels"},
                   DENSITIES = {"densities are seen as voxels", "a finer 'resolution' of their texels"},
                   VOLUMES = {"light in volumes is uncertain", "more 'rays' of the volume, or 'method path' with some"},
                   MEDIA = {"light in media is uncertain", "more 'samples' of the medium"};

static bool densities_alone(const CompiledScene *compiled) {
    for (size_t i = 0; i < compiled->texel_count; i++) {
        const TexelDef *def = compiled->texels[i]->def;
        if (def->file) continue;
        for (size_t k = 0; k < def->layer_count; k++)
            if (!def->layers[k].density) return false;
    }
    return true;
}

static Cause cause_of(const CompiledScene *compiled, const RenderStats *stats) {
    double error = stats->error_estimate, noise = stats->noise_estimate;
    if (noise * noise > MOSTLY_NOISE * error * error) return compiled->scene->settings.max_error > 0 ? NOISE : NOISE_UNASKED;
    if (compiled->voxels && compiled->skin_count) return densities_alone(compiled) ? DENSITIES : VOXELS;
    if (compiled->volumes) return VOLUMES;
    return compiled->scene->has_media ? MEDIA : NOISE;
}

static void tell_left_out(const RenderStats *stats, DiagList *diags) {
    if (!stats->counters.left_out) return;
    Diagnostic *d = diag_warning(diags, (Span){0}, "more than %d objects lie within each other: the media and interiors of the innermost are left out", MOST_ENCLOSURES);
    diag_hint(diags, d, "one object with a 'density' in the place of many");
}

void verdict_tell(const CompiledScene *compiled, const RenderStats *stats, DiagList *diags) {
    tell_left_out(stats, diags);
    const GlobalSettings *asked = &compiled->scene->settings;
    double accepted = compiled->accepted_error;
    bool named = asked->max_error > 0, chosen = asked->detail && (strcmp(asked->detail, "voxels") == 0 || strcmp(asked->detail, "slab") == 0);
    if (asked->samples > 0 || (chosen && !named) || !(stats->error_estimate > (named ? WELL_ABOVE : FAR_ABOVE) * accepted)) return;
    Cause cause = cause_of(compiled, stats);
    Diagnostic *d = diag_warning(diags, (Span){0}, "the picture is about %.2g from the truth where max_error accepts %.2g: %s", stats->error_estimate, accepted, cause.name);
    diag_hint(diags, d, "%s", cause.knob);
}
