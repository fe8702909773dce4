/* What charts are made of: references with a known noise, and renderings measured against them. */
#include "vts_session.h"

#include "base/stopwatch.h"
#include "image/metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct VtsReference {
    Image picture;
    double noise; /* RMSE; negative: not known */
};

VtsReference *reference_create(void) { return calloc(1, sizeof(VtsReference)); }

void vts_reference_free(VtsReference *reference) {
    if (!reference) return;
    image_free(&reference->picture);
    free(reference);
}

double vts_reference_noise(const VtsReference *reference) { return reference->noise; }

/* ---- two halves ---- */

/* The picture becomes the mean of itself and `other`. Two pictures of variance v are 2v apart, their mean has v/2: it is off by half of what they
 * are apart. */
static bool add_half(VtsReference *reference, const Image *other, StrBuf *why) {
    Image *mean = &reference->picture;
    ImageDifference apart;
    if (!image_compare(mean, other, &apart, why)) return false;
    if (mean->channels != other->channels) {
        strbuf_adds(why, "the two pictures have different channels");
        return false;
    }
    size_t count = (size_t)mean->width * (size_t)mean->height * (size_t)mean->channels;
    for (size_t i = 0; i < count; i++) mean->pixels[i] = 0.5f * (mean->pixels[i] + other->pixels[i]);
    reference->noise = apart.rmse / 2;
    return true;
}

static VtsStatus load(VtsReference *reference, const char *const paths[2], StrBuf *why) {
    Image other = {0};
    reference->noise = -1;
    if (!image_load(&reference->picture, paths[0], IMAGE_AS_COLOUR, NULL, why)) return VTS_ERROR_FILE;
    if (!paths[1]) return VTS_OK;
    VtsStatus status = !image_load(&other, paths[1], IMAGE_AS_COLOUR, NULL, why) ? VTS_ERROR_FILE
                       : !add_half(reference, &other, why)                       ? VTS_ERROR_USAGE
                                                                                 : VTS_OK;
    image_free(&other);
    return status;
}

VtsStatus vts_reference_load(const char *const paths[2], VtsReference **out, char *error, size_t error_size) {
    StrBuf why = {0};
    *out = reference_create();
    VtsStatus status = *out ? load(*out, paths, &why) : VTS_ERROR_MEMORY;
    if (error && error_size) snprintf(error, error_size, "%s", why.data ? why.data : status == VTS_OK ? "" : "out of memory");
    strbuf_free(&why);
    if (status == VTS_OK) return status;
    vts_reference_free(*out);
    *out = NULL;
    return status;
}

/* Moves the session's picture into the reference, which outlives the session. */
static bool keep_half(VtsReference *reference, const Image *drawn, bool first, StrBuf *why) {
    if (!first) return add_half(reference, drawn, why);
    if (!image_init(&reference->picture, drawn->width, drawn->height, drawn->channels, drawn->names, NULL, why)) return false;
    memcpy(reference->picture.pixels, drawn->pixels,
           (size_t)drawn->width * (size_t)drawn->height * (size_t)drawn->channels * sizeof *drawn->pixels);
    return true;
}

static VtsStatus draw_half(VtsSession *session, const char *scene_path, const char *path, bool first, VtsReference *reference) {
    RenderStats stats;
    StrBuf why = {0};
    VtsStatus status = session_expose(session, scene_path, true, &stats);
    if (status == VTS_OK && path) status = session_save_picture(session, scene_path, path);
    if (status == VTS_OK && !keep_half(reference, &session->picture, first, &why)) status = session_file_error(session, &why);
    strbuf_free(&why);
    image_free(&session->picture);
    session->picture = (Image){0};
    return status;
}

VtsStatus session_make_reference(VtsSession *session, const char *scene_path, const char *const paths[2], VtsReference *reference) {
    static const unsigned long long OTHER_SEED = 0x9e3779b97f4a7c15u;
    static const unsigned long long NEXT_FRAME = 0xd1342543de82ef95u;
    VtsStatus status = session_evaluate(session, scene_path, (EvalMode){0});
    if (status == VTS_OK) status = session_compile(session, true, 0);
    const unsigned long long seed = session->options.seed;
    /* The noise of one frame tells nothing of the noise of another. */
    if (session->in_film) session->options.seed += NEXT_FRAME * (unsigned long long)(session->options.frame - session->options.first_frame);
    const int rays = session->options.reference_samples;
    session->options.reference_samples = (rays + 1) / 2;
    for (int half = 0; half < 2 && status == VTS_OK; half++) {
        status = draw_half(session, scene_path, paths ? paths[half] : NULL, half == 0, reference);
        session->options.seed ^= OTHER_SEED;
    }
    session->options.seed = seed;
    session->options.reference_samples = rays;
    return status;
}

/* ---- a rendering ---- */

typedef struct Watch {
    double wall, user;
} Watch;
static Watch watch_now(void) { return (Watch){stopwatch_wall(), stopwatch_user()}; }

static void lap(Watch *since, double *wall, double *user) {
    Watch now = watch_now();
    *wall = now.wall - since->wall;
    *user = now.user - since->user;
    *since = now;
}

static VtsStatus check_size(VtsSession *session, const VtsReference *reference) {
    const Image *r = &reference->picture;
    if (r->width == session->options.width && r->height == session->options.height) return VTS_OK;
    diag_error(&session->diags, (Span){0}, "the reference has %d x %d pixels, the picture %d x %d", r->width, r->height,
               session->options.width, session->options.height);
    return VTS_ERROR_USAGE;
}

static VtsStatus compare(VtsSession *session, const VtsReference *reference, VtsMeasure *out) {
    StrBuf why = {0};
    float *map = difference_map(&reference->picture, &session->picture, &out->difference, &why);
    VtsStatus status = map ? VTS_OK : session_file_error(session, &why);
    free(map);
    strbuf_free(&why);
    if (status != VTS_OK) return status;
    double noise = fmax(reference->noise, 0);
    out->rmse = sqrt(fmax(out->difference.rmse * out->difference.rmse - noise * noise, 0));
    return VTS_OK;
}

/* How much the error has changed since the frame before, which it then takes the place of. */
static VtsStatus find_flicker(VtsSession *session, const VtsReference *reference, VtsMeasure *out) {
    const Image *picture = &session->picture;
    size_t samples = 3 * (size_t)picture->width * (size_t)picture->height;
    float *error = malloc(samples * sizeof *error), *before = session->last_error;
    if (!error) return VTS_ERROR_MEMORY;
    image_subtract(&reference->picture, picture, error);
    out->flicker = -1;
    if (before && session->last_error_size[0] == picture->width && session->last_error_size[1] == picture->height) {
        double sum = 0;
        for (size_t i = 0; i < samples; i++) {
            double change = (double)error[i] - (double)before[i];
            sum += change * change;
        }
        out->flicker = sqrt(sum / (double)samples);
    }
    free(before);
    session->last_error = error;
    session->last_error_size[0] = picture->width, session->last_error_size[1] = picture->height;
    return VTS_OK;
}

static void count(const VtsSession *session, const RenderStats *stats, VtsMeasure *out) {
    out->camera_rays = stats->counters.camera_rays;
    out->shadow_rays = stats->counters.shadow_rays;
    out->steps = stats->counters.steps;
    out->voxels_visited = stats->counters.voxels_visited;
    for (size_t i = 0; i < session->compiled.texel_count; i++) out->texel_bytes += session->compiled.texels[i]->bytes;
}

VtsStatus session_measure(VtsSession *session, const char *scene_path, const VtsReference *reference, const char *picture_path,
                          VtsMeasure *out) {
    VtsStatus status = check_size(session, reference);
    if (status != VTS_OK) return status;
    out->flicker = -1;
    RenderStats stats;
    Watch watch = watch_now();
    if ((status = session_evaluate(session, scene_path, (EvalMode){0})) != VTS_OK) return status;
    lap(&watch, &out->parse_wall_s, &out->parse_user_s);
    if ((status = session_compile_frame(session, scene_path, false)) != VTS_OK) return status;
    lap(&watch, &out->build_wall_s, &out->build_user_s);
    if ((status = session_expose(session, scene_path, false, &stats)) != VTS_OK) return status;
    lap(&watch, &out->render_wall_s, &out->render_user_s);
    count(session, &stats, out);
    if ((status = compare(session, reference, out)) == VTS_OK && session->in_film) status = find_flicker(session, reference, out);
    if (status != VTS_OK || !picture_path) return status;
    return session_save_picture(session, scene_path, picture_path);
}
