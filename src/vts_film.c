/* A scene's film: what its `animation` says, and going on to another frame. */
#include "vts_session.h"

#include "image/film_file.h"
#include "render/exact_memo.h"
#include "render/volume_memo.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool mentions_film(VtsSession *session, const char *path);

/* Whether the file that an #include of `file` names, as far as it can be told without running anything, speaks of an animation. */
static bool include_mentions_film(VtsSession *session, const SourceFile *file, const char *name, int size) {
    const char *slash = strrchr(file->path, '/');
    StrBuf path = {0};
    strbuf_addf(&path, "%.*s%.*s", slash ? (int)(slash - file->path) + 1 : 0, file->path, size, name);
    bool found = mentions_film(session, path.data);
    for (size_t i = 0; i < session->options.include_dir_count && !found; i++) {
        strbuf_clear(&path);
        strbuf_addf(&path, "%s/%.*s", session->options.include_dirs[i], size, name);
        found = mentions_film(session, path.data);
    }
    strbuf_free(&path);
    return found;
}

/* Scenes without a film, which are most, are not to be read twice to find that out. */
static bool mentions_film(VtsSession *session, const char *path) {
    static const char include[] = "#include";
    size_t known = session->sources.count;
    const SourceFile *file;
    if (source_load(&session->sources, path, NULL, &file) != SOURCE_OK || session->sources.count == known)
        return false;
    if (strstr(file->text, "animation")) return true;
    for (const char *at = file->text; (at = strstr(at, include)) != NULL;) {
        at += sizeof include - 1;
        at += strspn(at, " \t");
        size_t size = *at == '"' ? strcspn(at + 1, "\"\n") : 0;
        if (size > 0 && size < 1024 && at[1] != '/' &&
            include_mentions_film(session, file, at + 1, (int)size))
            return true;
    }
    return false;
}

VtsStatus session_film(VtsSession *session, const char *scene_path, VtsFilm *out) {
    session->renew = true; /* what is found now is found again by who draws */
    if (!mentions_film(session, scene_path)) return VTS_OK;
    session->probing = true;
    VtsStatus status =
        session_evaluate(session, scene_path, (EvalMode){.writes_in_memory = true, .ends_at_film = true});
    session->probing = false;
    if (status == VTS_INTERRUPTED) return status;
    out->wrong = status != VTS_OK;
    const Film *film = status == VTS_OK ? session->scene->film : NULL;
    if (film)
        *out = (VtsFilm){.exists = true,
                         .frames = film->frames,
                         .fps = film->fps,
                         .first_clock = film->first_clock,
                         .last_clock = film->last_clock,
                         .cyclic = film->cyclic,
                         .shutter = film->shutter};
    return VTS_OK;
}

/* ---- what one frame tells of others ---- */

/* So many frames in a row are drawn by the trial pixels of the first of them, and their texels are no coarser than its: each for itself would differ
 * by chance, and take longer than all else that is built. Whichever of them are drawn, and by whom, it is the same frame. */
enum { FRAMES_ALIKE = 24 };

/* The options of the frame that tells. */
static VtsOptions telling_frame(const VtsOptions *o) {
    VtsOptions out = *o;
    int passed = o->frame - o->first_frame, back = passed % FRAMES_ALIKE;
    out.frame = o->frame - back;
    out.clock = o->first_clock + (passed - back) * o->clock_delta;
    if (o->time_set) out.time = (passed - back) / o->fps;
    return out;
}

/* It is compiled, and the session comes back as it was, but for that. */
static VtsStatus ask_frame(VtsSession *session, const VtsOptions *frame, const char *scene_path, bool exact) {
    VtsOptions own = session->options;
    session->options = *frame;
    session->pilot = (PilotResult){.known = false};
    VtsStatus status = session_repeat(session, scene_path, exact);
    session->options = own;
    return status;
}

/* What has just been compiled tells. */
static void keep_told(VtsSession *session, int frame) {
    struct FilmPilot *told = &session->film_pilot;
    const CompiledScene *compiled = &session->compiled;
    TexelFrame *texels = realloc(told->texels, size_max(1, compiled->texel_count) * sizeof *texels);
    if (!texels) memory_budget_fail(&session->memory);
    for (size_t i = 0; i < compiled->texel_count; i++) texels[i] = (TexelFrame){compiled->texels[i]->finest_seen, compiled->texels[i]->built};
    session->pilot.texels = texels, session->pilot.texel_count = compiled->texel_count;
    *told = (struct FilmPilot){true, frame, session->pilot, texels};
}

VtsStatus session_compile_frame(VtsSession *session, const char *scene_path, bool exact) {
    const VtsOptions frame = telling_frame(&session->options);
    struct FilmPilot *told = &session->film_pilot;
    if (!session->in_film || frame.last_frame <= frame.first_frame || (frame.time_set && !(frame.fps > 0)))
        return session_compile(session, exact, 0);
    if (told->told && told->frame != frame.frame) *told = (struct FilmPilot){.told = false, .texels = told->texels};
    bool tells = frame.frame == session->options.frame;
    session->pilot = tells ? (PilotResult){.known = false} : told->result;
    session->pilot.elsewhere = !tells && !told->told;
    VtsStatus status = session_compile(session, exact, 0);
    bool asked = status == VTS_OK && session->pilot.asked;
    if (asked) status = ask_frame(session, &frame, scene_path, exact);
    if (status == VTS_OK && (tells || asked)) keep_told(session, frame.frame);
    return asked && status == VTS_OK ? session_repeat(session, scene_path, exact) : status;
}

VtsStatus vts_make_gif(const char *const *picture_paths, size_t count, double fps, const char *output_path,
                       char *error, size_t error_size) {
    StrBuf why = {0};
    VtsStatus status = count > 0 && fps > 0 ? VTS_OK : VTS_ERROR_USAGE;
    if (status != VTS_OK)
        strbuf_adds(&why, count == 0 ? "no pictures given" : "the number of frames a second must be above 0");
    else if (!film_file_save_gif(picture_paths, count, fps, output_path, &why))
        status = VTS_ERROR_FILE;
    if (error && error_size) snprintf(error, error_size, "%s", status == VTS_OK || !why.data ? "" : why.data);
    strbuf_free(&why);
    return status;
}

void vts_set_frame(VtsSession *session, const VtsOptions *frame) {
    VtsOptions *o = &session->options;
    o->clock = frame->clock, o->clock_set = frame->clock_set, o->clock_delta = frame->clock_delta;
    o->frame = frame->frame, o->first_frame = frame->first_frame, o->last_frame = frame->last_frame;
    o->first_clock = frame->first_clock, o->last_clock = frame->last_clock;
    o->fps = frame->fps, o->time = frame->time, o->time_set = frame->time_set, o->cycle = frame->cycle;
    o->shutter_clock = frame->shutter_clock, o->shutter_time = frame->shutter_time;
    session->in_film = session->renew = true;
    if (!session->volume_memo) session->volume_memo = volume_memo_create();
    if (!session->exact_memo) session->exact_memo = exact_memo_create(&session->memory);
}
