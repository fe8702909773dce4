#include "vts_session.h"

#include "base/decimal.h"
#include "base/stopwatch.h"
#include "eval/block_setting.h"
#include "eval/eval.h"
#include "hooks.h"
#include "render/audit.h"
#include "render/exact_memo.h"
#include "render/preview.h"
#include "render/reference.h"
#include "render/report.h"
#include "render/verdict.h"
#include "render/volume_memo.h"
#include "scene/knobs.h"

#include <errno.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char *vts_version(void) { return VTS_VERSION; }

VtsOptions vts_options_default(void) { return (VtsOptions){.width = 768, .height = 576, .frame = 1, .first_frame = 1, .last_frame = 1, .last_clock = 1, .clock_delta = 1, .reference_samples = REFERENCE_DEFAULT_SAMPLES}; }

/* ---- sessions ---- */

static void memory_exhausted(void *context) {
    VtsSession *session = context;
    longjmp(session->out_of_memory, 1);
}

static void pass_progress(void *context, const char *stage, size_t done, size_t total) {
    VtsSession *session = context;
    snprintf(session->stage, sizeof session->stage, "%s", stage);
    if (session->options.on_progress) session->options.on_progress(session->options.context, stage, done, total);
}

static bool is_folder(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* The standard library: as told, beside the program (installed or in a build tree), or where it was to be installed. */
static void find_stdlib(VtsSession *session) {
    static const char *const beside[] = {"../share/vts/stdlib", "../stdlib", "stdlib", "../../stdlib"};
    if (session->options.stdlib_dir) {
        strbuf_adds(&session->stdlib, session->options.stdlib_dir);
        return;
    }
    for (size_t i = 0; session->options.program_dir && i < VTS_ARRAY_COUNT(beside); i++) {
        strbuf_clear(&session->stdlib);
        strbuf_addf(&session->stdlib, "%s/%s", session->options.program_dir, beside[i]);
        if (is_folder(session->stdlib.data)) return;
    }
    strbuf_clear(&session->stdlib);
#ifdef VTS_STDLIB_DIR
    if (is_folder(VTS_STDLIB_DIR)) strbuf_adds(&session->stdlib, VTS_STDLIB_DIR);
#endif
}

static const char *option_fault(const VtsOptions *o) {
    if (o->width < 1 || o->height < 1 || o->width > IMAGE_LARGEST_SIDE || o->height > IMAGE_LARGEST_SIDE)
        return "the picture's width and height must be 1 to 1048576 pixels";
    if ((double)o->width * o->height * 4 > IMAGE_LARGEST_SAMPLES) return "the picture is too large";
    if (o->threads < 0 || o->threads > 1024) return "the number of threads must be 0 (all) to 1024";
    if (!(o->max_error >= 0 && o->max_error <= 1)) return "max_error must be 0 to 1";
    if (o->samples < 0 || o->samples > 256) return "samples must be 0 to 256";
    if (o->reference_samples < 1 || o->reference_samples > REFERENCE_MOST_SAMPLES) return "reference_samples must be 1 to 65536";
    const int *r = o->region;
    if ((r[0] || r[1] || r[2] || r[3]) && (r[0] < 0 || r[1] < 0 || r[2] > o->width || r[3] > o->height || r[0] >= r[2] || r[1] >= r[3]))
        return "the region must lie in the picture and hold at least one pixel";
    if (!isfinite(o->clock) || !isfinite(o->exposure)) return "clock and exposure must be finite numbers";
    if (!isfinite(o->shutter_clock) || !isfinite(o->shutter_time)) return "shutter_clock and shutter_time must be finite numbers";
    if (!isfinite(o->time) || !(o->cycle >= 0 && isfinite(o->cycle))) return "time and cycle must be finite numbers";
    if (o->preview && !preview_address_valid(o->preview)) return "preview must be HOST:PORT, the port 1 to 65535";
    if (fabs(o->exposure) > 100) return "exposure must be -100 to 100 EV";
    return NULL;
}

/* Texts, what was found in them, and the names that stand there. */
static void begin_texts(VtsSession *session) {
    arena_init(&session->arena, &session->memory, 0);
    source_set_init(&session->sources, &session->arena);
    diag_init(&session->diags, &session->arena, &session->sources);
    interner_init(&session->names, &session->arena);
    session->last_printed = NULL;
}

/* False when memory or threads run out. */
static bool prepare(VtsSession *session) {
    if (setjmp(session->out_of_memory) != 0) return false;
    begin_texts(session);
    find_stdlib(session);
    session->texels = texel_cache_create(session->options.cache_dir, &session->memory);
    session->pool = pool_create(session->options.threads);
    return session->pool != NULL && session->texels != NULL;
}

VtsSession *vts_session_create(const VtsOptions *options, const char **error) {
    const char *fault = option_fault(options);
    VtsSession *session = fault ? NULL : calloc(1, sizeof *session);
    if (!session) {
        if (error) *error = fault ? fault : "out of memory";
        return NULL;
    }
    session->options = *options;
    session->memory = (MemoryBudget){.limit = options->memory_limit, .on_exhausted = memory_exhausted, .context = session};
    session->progress = (Progress){pass_progress, session};
    if (!prepare(session)) {
        vts_session_destroy(session);
        if (error) *error = "out of memory, or threads cannot be started";
        return NULL;
    }
    return session;
}

static void end_call(VtsSession *session) {
    preview_close(session->preview);
    tile_file_close(session->kept, false);
    session->preview = NULL;
    session->kept = NULL;
    session->kept_at = session->scene_name = NULL;
    compiled_scene_destroy(&session->compiled);
    image_free(&session->picture);
    moment_mean_free(&session->blurred);
    moment_mean_free(&session->scout);
    session->picture = (Image){0};
    arena_destroy(&session->parse);
    arena_destroy(&session->scene_arena);
    arena_destroy(&session->compiled_arena);
}

void vts_session_destroy(VtsSession *session) {
    if (!session) return;
    end_call(session);
    session_trim_nets(session, true);
    volume_memo_destroy(session->volume_memo);
    exact_memo_destroy(session->exact_memo);
    free(session->film_pilot.texels);
    free(session->last_error);
    texel_cache_destroy(session->texels);
    pool_destroy(session->pool);
    arena_destroy(&session->arena);
    strbuf_free(&session->stdlib);
    strbuf_free(&session->printed);
    strbuf_free(&session->report);
    strbuf_free(&session->frames);
    free(session);
}

void vts_interrupt(VtsSession *session) {
    session->interrupted = true;
    pool_cancel(session->pool);
}

const char *vts_diagnostics(const VtsSession *session) { return session->printed.data ? session->printed.data : ""; }
const char *vts_report(const VtsSession *session) { return session->report.data ? session->report.data : ""; }

/* In a film, what was told of another frame is not told again, with other numbers in it either. */
static bool is_news(const VtsSession *session, const Diagnostic *d, const StrBuf *text) {
    if (!session->in_film || d->severity == SEVERITY_ERROR || !session->printed.data) return true;
    const char *severity = strstr(text->data, "warning:");
    size_t size = severity ? (size_t)(severity - text->data) + strcspn(severity, " ") : 0;
    StrBuf begin = {0};
    strbuf_add(&begin, text->data, severity ? size + strcspn(text->data + size, "0123456789") : text->size);
    bool news = !strstr(session->printed.data, begin.data);
    strbuf_free(&begin);
    return news;
}

static void tell(VtsSession *session, const Diagnostic *d) {
    StrBuf text = {0};
    diag_format(&text, &session->sources, d, session->options.colour);
    if (is_news(session, d, &text)) {
        strbuf_adds(&session->printed, text.data);
        if (session->options.on_diagnostic) session->options.on_diagnostic(session->options.context, text.data, d->severity == SEVERITY_ERROR);
    }
    strbuf_free(&text);
}

/* Formats what was found since the last time. */
void session_print_diagnostics(VtsSession *session) {
    const Diagnostic *d = session->last_printed ? session->last_printed->next : session->diags.first;
    for (; d; d = d->next) {
        if (!session->probing && (!session->silent || d->severity == SEVERITY_ERROR)) tell(session, d);
        session->last_printed = d;
    }
}

/* ---- settings from outside ---- */

static bool parse_number(const char *text, double *out) {
    char *end;
    errno = 0;
    *out = decimal_strtod(text, &end);
    return end != text && *end == '\0' && errno == 0 && isfinite(*out);
}

/* --set KNOB=VALUE over the scene's global_settings. */
static VtsStatus apply_setting(VtsSession *session, const VtsPair *pair, GlobalSettings *settings) {
    StrBuf why = {0};
    bool valid = knob_set(pair->name, pair->value, settings, &why);
    if (!valid) diag_error(&session->diags, (Span){0}, "--set %s=%s: %s", pair->name, pair->value, why.data);
    strbuf_free(&why);
    return valid ? VTS_OK : VTS_ERROR_USAGE;
}

/* Told before the work begins, also by calls that draw nothing. */
static VtsStatus check_settings(VtsSession *session) {
    GlobalSettings unused = global_settings_default();
    VtsStatus status = VTS_OK;
    for (size_t i = 0; i < session->options.setting_count && status == VTS_OK; i++)
        status = apply_setting(session, &session->options.settings[i], &unused);
    return status;
}

static VtsStatus apply_settings(VtsSession *session) {
    session->scene_with_settings = *session->scene;
    GlobalSettings *settings = &session->scene_with_settings.settings;
    for (size_t i = 0; i < session->options.setting_count; i++) {
        VtsStatus status = apply_setting(session, &session->options.settings[i], settings);
        if (status != VTS_OK) return status;
    }
    if (session->options.samples) settings->samples = session->options.samples;
    if (session->options.max_error > 0) settings->max_error = session->options.max_error;
    session->scene = &session->scene_with_settings;
    return VTS_OK;
}

/* A whole number below 2⁶³, or false. */
static bool parse_count(const char *text, uint64_t *out) {
    double number;
    if (!parse_number(text, &number) || number < 1 || number != floor(number) || number > 9e18) return false;
    *out = (uint64_t)number;
    return true;
}

static VtsStatus apply_limits(VtsSession *session, EvalLimits *limits) {
    for (size_t i = 0; i < session->options.limit_count; i++) {
        const VtsPair *pair = &session->options.limits[i];
        uint64_t count;
        if (!parse_count(pair->value, &count)) {
            diag_error(&session->diags, (Span){0}, "--limit %s=%s: the limit must be a whole number from 1", pair->name, pair->value);
            return VTS_ERROR_USAGE;
        }
        uint32_t small = count > UINT32_MAX ? UINT32_MAX : (uint32_t)count;
        if (strcmp(pair->name, "loops") == 0) limits->loops = count;
        else if (strcmp(pair->name, "recursion") == 0) limits->recursion = small;
        else if (strcmp(pair->name, "includes") == 0) limits->include_depth = small;
        else if (strcmp(pair->name, "steps") == 0) limits->steps = count;
        else if (strcmp(pair->name, "mesh") == 0) limits->mesh_vertices = count;
        else if (strcmp(pair->name, "memory") == 0) limits->memory_bytes = count;
        else if (strcmp(pair->name, "written") == 0) limits->written_bytes = count;
        else if (strcmp(pair->name, "array") == 0) limits->array_elements = count;
        else if (strcmp(pair->name, "string") == 0) limits->string_bytes = count;
        else {
            diag_error(&session->diags, (Span){0}, "--limit %s: no such limit; there are loops, steps, recursion, includes, array, string, written, mesh, memory", pair->name);
            return VTS_ERROR_USAGE;
        }
    }
    return VTS_OK;
}

/* ---- stages ---- */

static void pass_text(void *context, EvalStream stream, const char *text) {
    VtsSession *session = context;
    static const VtsStream streams[] = {VTS_STREAM_DEBUG, VTS_STREAM_WARNING, VTS_STREAM_RENDER, VTS_STREAM_STATISTICS};
    if (session->options.on_text && !session->probing && !session->silent) session->options.on_text(session->options.context, streams[stream], text);
}

static bool session_is_film(const VtsOptions *o) { return o->last_frame > o->first_frame || o->frame > 1; }

/* Of a scene that stays as it is: the next frame of a film may have the block. */
static VtsStatus check_used(VtsSession *session, const struct EvalSetting *settings, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const char *name = settings[i].name, *dot = strchr(name, '.');
        if (*settings[i].used) continue;
        diag_error(&session->diags, (Span){0}, "--set %s=%s: the scene has no '%.*s' that takes the word '%s'", name, settings[i].value,
                   (int)(dot - name), name, dot + 1);
        return VTS_ERROR_USAGE;
    }
    return VTS_OK;
}

/* Those settings that are words of blocks. */
static size_t find_block_settings(VtsSession *session, struct EvalSetting **out) {
    const VtsOptions *o = &session->options;
    size_t count = 0;
    *out = arena_new_array(&session->parse, struct EvalSetting, o->setting_count);
    bool *used = arena_new_array(&session->scene_arena, bool, o->setting_count);
    for (size_t i = 0; i < o->setting_count; i++)
        if (block_setting_is_name(o->settings[i].name)) (*out)[count++] = (struct EvalSetting){o->settings[i].name, o->settings[i].value, &used[i]};
    return count;
}

VtsStatus session_evaluate(VtsSession *session, const char *path, EvalMode mode) {
    const VtsOptions *o = &session->options;
    struct EvalDeclare *declares = arena_new_array(&session->parse, struct EvalDeclare, o->declare_count);
    for (size_t i = 0; i < o->declare_count; i++) declares[i] = (struct EvalDeclare){o->declares[i].name, o->declares[i].value};
    struct EvalSetting *settings;
    size_t setting_count = find_block_settings(session, &settings);
    EvalGeometry geometry = hooks_geometry(&session->scene_arena, session->texels);
    /* As in POV-Ray, what counts frames is 0 where there is no film; but a picture alone is the first of one, so that scenes which
     * take their part of a table by the frame's number can be read and drawn. */
    NetStates states = session_net_states(session);
    bool film = session_is_film(o), counted = film || !mode.is_program;
    EvalOptions options = {.geometry = &geometry, .net_states = &states, .include_dirs = o->include_dirs, .include_dir_count = o->include_dir_count,
                           .stdlib_dir = session->stdlib.size ? session->stdlib.data : NULL,
                           .declares = declares, .declare_count = o->declare_count, .settings = settings, .setting_count = setting_count, .clock = o->clock + session->moment * o->shutter_clock, .clock_on = film || o->clock_set,
                           .clock_delta = film ? o->clock_delta : 0, .initial_clock = film ? o->first_clock : 0,
                           .final_clock = film ? o->last_clock : 0, .frame_number = counted ? o->frame : 0,
                           .initial_frame = counted ? o->first_frame : 0, .final_frame = counted ? o->last_frame : 0,
                           .time = o->time_set ? o->time + session->moment * o->shutter_time : o->clock + session->moment * o->shutter_clock, .cycle = o->cycle, .ends_at_film = mode.ends_at_film,
                           .image_width = o->width, .image_height = o->height, .limits = eval_limits_default(),
                           .allow_read = o->allow_read, .allow_read_count = o->allow_read_count, .allow_write = o->allow_write,
                           .allow_write_count = o->allow_write_count, .keep_writes_in_memory = mode.writes_in_memory, .is_program = mode.is_program,
                           .on_text = pass_text, .context = session, .interrupted = &session->interrupted,
                           .print_tokens = mode.print_tokens, .print_ast = mode.print_ast};
    VtsStatus status = apply_limits(session, &options.limits);
    if (status != VTS_OK) return status;
    snprintf(session->stage, sizeof session->stage, "reading");
    EvalStatus result = eval_file(path, &options, &session->sources, &session->diags, &session->names, &session->parse,
                                  &session->scene_arena, &session->scene);
    VtsStatus used = result == EVAL_OK && session->scene && !film && !mode.ends_at_film ? check_used(session, settings, setting_count) : VTS_OK;
    session_print_diagnostics(session);
    arena_destroy(&session->parse); /* tokens and trees: of a large scene more than what is drawn */
    switch (result) {
    case EVAL_OK: return used;
    case EVAL_NO_FILE: return VTS_ERROR_FILE;
    case EVAL_INTERRUPTED: return VTS_INTERRUPTED;
    case EVAL_FAILED: break;
    }
    return VTS_ERROR_SCENE;
}

VtsStatus session_compile(VtsSession *session, bool exact, int texel_resolution) {
    VtsStatus status = apply_settings(session);
    if (status != VTS_OK) return status;
    snprintf(session->stage, sizeof session->stage, "objects");
    NetStates states = session_net_states(session);
    CompileOptions options = {.net_states = &states, .pool = session->pool, .memory = &session->memory, .texels = session->texels, .progress = &session->progress,
                              .width = session->options.width, .height = session->options.height,
                              .texel_resolution = texel_resolution,
                              .interrupted = &session->interrupted, .exact = exact, .pilot = &session->pilot, .volume_memo = session->volume_memo, .film = session_is_film(&session->options)};
    CompileStatus result = compile_scene(session->scene, &options, &session->compiled_arena, &session->diags, &session->compiled);
    session_print_diagnostics(session);
    return result == COMPILE_OK ? VTS_OK : result == COMPILE_INTERRUPTED ? VTS_INTERRUPTED : VTS_ERROR_SCENE;
}

/* What the picture says of itself. No time stamp: equal pictures are equal files. */
static void describe(VtsSession *session, const char *scene_path) {
    const VtsOptions *o = &session->options;
    const GlobalSettings *s = &session->scene->settings;
    Image *picture = &session->picture;
    const char *slash = strrchr(scene_path, '/');
    image_set_text(picture, "Software", "vts " VTS_VERSION);
    image_set_text(picture, "vts:scene", slash ? slash + 1 : scene_path);
    image_set_text(picture, "vts:version", VTS_VERSION);
    if (session_is_film(o)) image_set_number(picture, "vts:frame", o->frame);
    image_set_number(picture, "vts:clock", o->clock);
    image_set_number(picture, "vts:exposure", o->exposure);
    for (size_t i = 0; i < NAMED_KNOB_COUNT; i++) {
        StrBuf name = {0};
        strbuf_addf(&name, "vts:%s", named_knobs[i].name);
        image_set_text(picture, name.data, named_knob_get(&named_knobs[i], s));
        strbuf_free(&name);
    }
    image_set_number(picture, "vts:shadow_aperture", s->shadow_aperture);
    image_set_number(picture, "vts:samples", s->samples);
}

VtsStatus session_file_error(VtsSession *session, const StrBuf *why) {
    diag_error(&session->diags, (Span){0}, "no picture: %s", why->size ? why->data : "it could not be written");
    session_print_diagnostics(session);
    return VTS_ERROR_FILE;
}

VtsStatus session_save_picture(VtsSession *session, const char *scene_path, const char *output_path) {
    describe(session, scene_path);
    StrBuf error = {0};
    ImageSample sample = IMAGE_SAMPLE_AUTO;
    if (session->options.float_type && strcmp(session->options.float_type, "float") == 0) sample = IMAGE_SAMPLE_FLOAT;
    bool ok = image_save(&session->picture, output_path, sample, &error);
    VtsStatus status = ok ? VTS_OK : session_file_error(session, &error);
    strbuf_free(&error);
    return status;
}

/* A viewer is a help, not a result: without one the picture is made all the same. */
Preview *session_connect_preview(VtsSession *session) {
    StrBuf why = {0};
    Preview *preview = preview_connect(session->options.preview, &why);
    if (!preview) diag_warning(&session->diags, (Span){0}, "--preview %s: %s; rendering without", session->options.preview, why.data ? why.data : "");
    strbuf_free(&why);
    if (!preview) session_print_diagnostics(session);
    return preview;
}

void session_region(const VtsSession *session, int out[4]) {
    const VtsOptions *o = &session->options;
    memcpy(out, o->region, sizeof o->region);
    if (out[2] == 0) out[2] = o->width, out[3] = o->height;
}

VtsStatus session_draw(VtsSession *session, bool exact, const MomentPlan *plan, RenderStats *stats) {
    const VtsOptions *o = &session->options;
    RenderOptions options = {.pool = session->pool, .progress = &session->progress, .interrupted = &session->interrupted,
                             .samples = exact ? o->reference_samples : session->scene->settings.samples,
                             .seed = o->seed ^ plan->seed, .noise = plan->noise, .tiles = plan->tiles, .tile_noise = plan->tile_noise, .kept = plan->apart ? NULL : session->kept, .exposure = o->exposure, .alpha = o->alpha};
    if (plan->samples) options.samples = plan->samples;
    snprintf(session->stage, sizeof session->stage, "picture");
    if (o->aovs && !plan->unseen) options.aovs = &session->aovs;
    if (plan->region) memcpy(options.region, plan->region, sizeof options.region);
    else session_region(session, options.region);
    if (!session->interrupted && o->preview && !plan->unseen) options.preview = session->preview = session_connect_preview(session);
    options.name = session->scene_name ? session->scene_name : "vts";
    bool done = !session->interrupted && (exact ? reference_picture : render_picture)(&session->compiled, &options, &session->memory,
                                                                                      &session->picture, stats, NULL);
    preview_close(session->preview);
    session->preview = NULL;
    if (session->interrupted) return VTS_INTERRUPTED;
    if (!done) memory_budget_fail(&session->memory);
    if (session->audits && !plan->unseen) {
        const CompileOptions how = {.pool = session->pool, .memory = &session->memory, .interrupted = &session->interrupted, .exact_memo = session->exact_memo};
        audit_picture(&session->compiled, &how, &options, &session->picture, stats);
    }
    return VTS_OK;
}

/* A scene is a user's work: no picture takes its place, nor that of a file that it includes. */
VtsStatus session_spare_sources(VtsSession *session, const char *output_path) {
    if (!source_holds(&session->sources, output_path)) return VTS_OK;
    StrBuf why = {0};
    strbuf_addf(&why, "'%s' is a text that the scene is made of", output_path);
    VtsStatus status = session_file_error(session, &why);
    strbuf_free(&why);
    return status;
}

/* Which further channels there are to be, in a picture that can hold them. */
static VtsStatus plan_aovs(VtsSession *session, const char *output_path) {
    StrBuf why = {0};
    bool valid = !session->options.aovs || aov_plan_parse(session->options.aovs, &session->aovs, &why);
    if (valid && session->options.aovs && image_format_of(output_path) != IMAGE_FORMAT_EXR) {
        strbuf_addf(&why, "'%s' cannot hold further channels: only .exr can", output_path);
        valid = false;
    }
    if (!valid) diag_error(&session->diags, (Span){0}, "--aov: %s", why.data);
    strbuf_free(&why);
    return valid ? VTS_OK : VTS_ERROR_USAGE;
}

/* The picture as users see it, or the reference. */
static VtsStatus render(VtsSession *session, const char *scene_path, const char *output_path, bool exact) {
    const VtsOptions *o = &session->options;
    session->scene_name = scene_path;
    VtsStatus planned = plan_aovs(session, output_path);
    if (planned != VTS_OK) return planned;
    StrBuf error = {0};
    bool writable = image_can_write(output_path, &error);
    VtsStatus status = writable ? session_evaluate(session, scene_path, (EvalMode){0}) : session_file_error(session, &error);
    strbuf_free(&error);
    if (status == VTS_OK) status = session_spare_sources(session, output_path);
    if (status != VTS_OK) return status;
    session->key = session_key(session, exact);
    double parsed = stopwatch_wall(), parsed_cpu = stopwatch_cpu();
    if ((status = session_compile_frame(session, scene_path, exact)) != VTS_OK) return status;
    double built = stopwatch_wall(), built_cpu = stopwatch_cpu();
    RenderStats stats;
    session_keep_tiles(session, output_path);
    session->audits = !exact && !o->unreported;
    if ((status = session_expose(session, scene_path, exact, &stats)) != VTS_OK) return status;
    stats.kept_tiles = session->tiles_taken + tile_file_taken(session->kept);
    verdict_tell(&session->compiled, &stats, &session->diags);
    double rendered = stopwatch_wall();
    session_mark_part(session);
    if ((status = session_save_picture(session, scene_path, output_path)) != VTS_OK) return status;
    session_forget_tiles(session);
    double written = stopwatch_wall();
    FrameReport report = {.frame = o->frame, .clock = o->clock, .output = output_path, .wall_s = written - session->started_wall,
                          .cpu_s = stopwatch_cpu() - session->started_cpu, .parse_s = parsed - session->started_wall,
                          .build_s = built - parsed, .build_cpu_s = built_cpu - parsed_cpu, .render_s = rendered - built, .write_s = written - rendered,
                          .peak_rss_bytes = peak_resident_bytes(), .compiled = &session->compiled, .stats = &stats};
    if (!session->in_film) strbuf_clear(&session->frames);
    report_add_frame(&session->frames, &report);
    strbuf_clear(&session->report);
    report_write(&session->report, scene_path, VTS_VERSION, &session->frames);
    return VTS_OK;
}

/* ---- calls ---- */

typedef enum CallKind { CALL_CHECK, CALL_RUN, CALL_RENDER, CALL_REFERENCE, CALL_DUMP, CALL_TEXEL, CALL_HALVES, CALL_MEASURE, CALL_INFO, CALL_FILM } CallKind;

typedef struct Call {
    CallKind kind;
    const char *scene_path, *output_path;
    VtsDump dump;
    const char *texel_name, *save_path; /* CALL_TEXEL */
    const char *const *paths;           /* CALL_HALVES */
    const VtsReference *reference;      /* CALL_MEASURE */
    VtsReference *halves;               /* CALL_HALVES */
    VtsMeasure *measure;
    VtsFilm *film;                      /* CALL_FILM */
    bool json;                          /* CALL_INFO */
} Call;

static VtsStatus dump(VtsSession *session, const Call *call) {
    EvalMode mode = {.writes_in_memory = true, .print_tokens = call->dump == VTS_DUMP_TOKENS, .print_ast = call->dump == VTS_DUMP_AST};
    VtsStatus status = session_evaluate(session, call->scene_path, mode);
    if (status != VTS_OK || mode.print_tokens || mode.print_ast) return status;
    StrBuf text = {0};
    if (call->dump == VTS_DUMP_COMPILED) {
        if ((status = session_compile(session, false, 0)) == VTS_OK) compiled_scene_print(&session->compiled, &text);
    } else {
        scene_print(session->scene, &text);
    }
    if (text.size) pass_text(session, EVAL_STREAM_STATISTICS, text.data);
    strbuf_free(&text);
    return status;
}

static VtsStatus perform(VtsSession *session, const Call *call) {
    VtsStatus settings = check_settings(session);
    if (settings != VTS_OK) return settings;
    switch (call->kind) {
    case CALL_CHECK: return session_evaluate(session, call->scene_path, (EvalMode){.writes_in_memory = true});
    case CALL_RUN: return session_evaluate(session, call->scene_path, (EvalMode){.is_program = true});
    case CALL_RENDER: return render(session, call->scene_path, call->output_path, false);
    case CALL_REFERENCE: return render(session, call->scene_path, call->output_path, true);
    case CALL_DUMP: return dump(session, call);
    case CALL_FILM: return session_film(session, call->scene_path, call->film);
    case CALL_INFO: return session_info(session, call->scene_path, call->json);
    case CALL_TEXEL: return session_texel(session, call->scene_path, call->texel_name, call->save_path, call->output_path);
    case CALL_HALVES: return session_make_reference(session, call->scene_path, call->paths, call->halves);
    case CALL_MEASURE: return session_measure(session, call->scene_path, call->reference, call->output_path, call->measure);
    }
    return VTS_ERROR_USAGE;
}

/* Without the arenas: they may be what is full. */
static void report_memory(VtsSession *session) {
    StrBuf text = {0};
    strbuf_adds(&text, "vts: error: ");
    if (session->memory.limit) strbuf_addf(&text, "the memory limit of %zu bytes was reached (--memory-limit)", session->memory.limit);
    else strbuf_adds(&text, "out of memory");
    if (session->stage[0]) strbuf_addf(&text, ", at the stage '%s'", session->stage);
    strbuf_adds(&text, "\n");
    strbuf_adds(&session->printed, text.data);
    if (session->options.on_diagnostic) session->options.on_diagnostic(session->options.context, text.data, true);
    strbuf_free(&text);
}

/* Runs a call with its own arenas; memory exhaustion anywhere below comes back here. */
static VtsStatus guarded(VtsSession *session, const Call *call) {
    session->started_wall = stopwatch_wall();
    session->started_cpu = stopwatch_cpu();
    session->probing = session->silent = session->audits = false;
    session->moment = 0;
    session->tiles_taken = 0;
    session->pilot = (PilotResult){.known = false};
    if (session->interrupted) return VTS_INTERRUPTED;
    arena_init(&session->parse, &session->memory, 0);
    arena_init(&session->scene_arena, &session->memory, 0);
    arena_init(&session->compiled_arena, &session->memory, 0);
    VtsStatus status;
    if (setjmp(session->out_of_memory) == 0) {
        if (session->renew) {
            session->renew = false;
            arena_destroy(&session->arena);
            begin_texts(session);
        }
        status = perform(session, call);
        session_print_diagnostics(session);
    } else {
        status = VTS_ERROR_MEMORY;
        report_memory(session);
        texel_cache_clear(session->texels);
        exact_memo_clear(session->exact_memo);
    }
    end_call(session);
    session_trim_nets(session, false);
    texel_cache_trim(session->texels);
    return status;
}

VtsStatus vts_check(VtsSession *session, const char *scene_path) {
    return guarded(session, &(Call){.kind = CALL_CHECK, .scene_path = scene_path});
}
VtsStatus vts_run(VtsSession *session, const char *scene_path) {
    return guarded(session, &(Call){.kind = CALL_RUN, .scene_path = scene_path});
}
VtsStatus vts_render(VtsSession *session, const char *scene_path, const char *output_path) {
    return guarded(session, &(Call){.kind = CALL_RENDER, .scene_path = scene_path, .output_path = output_path});
}
VtsStatus vts_reference(VtsSession *session, const char *scene_path, const char *output_path) {
    return guarded(session, &(Call){.kind = CALL_REFERENCE, .scene_path = scene_path, .output_path = output_path});
}
VtsStatus vts_reference_make(VtsSession *session, const char *scene_path, const char *const paths[2], VtsReference **out) {
    *out = reference_create();
    VtsStatus status = *out ? guarded(session, &(Call){.kind = CALL_HALVES, .scene_path = scene_path, .paths = paths, .halves = *out}) : VTS_ERROR_MEMORY;
    if (status == VTS_OK) return status;
    vts_reference_free(*out);
    *out = NULL;
    return status;
}
VtsStatus vts_measure(VtsSession *session, const char *scene_path, const VtsReference *reference, const char *picture_path, VtsMeasure *out) {
    *out = (VtsMeasure){0};
    return guarded(session, &(Call){.kind = CALL_MEASURE, .scene_path = scene_path, .reference = reference, .output_path = picture_path, .measure = out});
}
VtsStatus vts_dump(VtsSession *session, const char *scene_path, VtsDump stage) {
    return guarded(session, &(Call){.kind = CALL_DUMP, .scene_path = scene_path, .dump = stage});
}
VtsStatus vts_info(VtsSession *session, const char *path, bool json) {
    return guarded(session, &(Call){.kind = CALL_INFO, .scene_path = path, .json = json});
}
VtsStatus vts_film(VtsSession *session, const char *scene_path, VtsFilm *out) {
    *out = (VtsFilm){0};
    return guarded(session, &(Call){.kind = CALL_FILM, .scene_path = scene_path, .film = out});
}
VtsStatus vts_texel(VtsSession *session, const char *scene_path, const char *name, const char *save_path, const char *picture_path) {
    return guarded(session, &(Call){.kind = CALL_TEXEL, .scene_path = scene_path, .output_path = picture_path,
                                    .texel_name = name, .save_path = save_path});
}
