/* Parts of a picture: what they say of themselves, and vts_stitch(). */
#include "vts_session.h"

#include "image/image_part.h"

#include <stdio.h>
#include <string.h>

static void add_text(Hash128 *hash, const char *text) {
    size_t size = text ? strlen(text) + 1 : 0;
    hash_add_u64(hash, size);
    if (size) hash_add(hash, text, size);
}

static void add_pairs(Hash128 *hash, const VtsPair *pairs, size_t count) {
    hash_add_u64(hash, count);
    for (size_t i = 0; i < count; i++) {
        add_text(hash, pairs[i].name);
        add_text(hash, pairs[i].value);
    }
}

/* Of the texts that were read and of every option that pixels depend on; of data files only the names stand in the texts. */
uint64_t session_key(const VtsSession *session, bool exact) {
    const VtsOptions *o = &session->options;
    Hash128 hash = hash_begin(exact);
    add_text(&hash, VTS_VERSION);
    hash_add_u64(&hash, session->sources.count);
    for (size_t i = 0; i < session->sources.count; i++) {
        const SourceFile *file = session->sources.items[i];
        hash_add_u64(&hash, file->size);
        hash_add(&hash, file->text, file->size);
    }
    const double numbers[] = {o->width, o->height, o->clock, o->frame, o->first_frame, o->last_frame, o->first_clock, o->last_clock, o->clock_delta,
                              o->time_set ? o->time : o->clock, o->cycle, o->shutter_clock, o->shutter_time, o->max_error, o->samples, exact ? o->reference_samples : 0, o->exposure,
                              o->alpha};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&hash, numbers[i]);
    hash_add_u64(&hash, o->seed);
    add_text(&hash, o->aovs);
    add_text(&hash, o->float_type);
    add_pairs(&hash, o->declares, o->declare_count);
    add_pairs(&hash, o->settings, o->setting_count);
    return hash.lo ^ hash.hi;
}

void session_mark_part(VtsSession *session) {
    const VtsOptions *o = &session->options;
    const int *r = o->region;
    if (r[2] == 0) return;
    image_part_set(&session->picture, &(ImagePart){.x = r[0], .y = r[1], .width = r[2] - r[0], .height = r[3] - r[1], .whole_width = o->width,
                                                   .whole_height = o->height, .key = session->key});
}

VtsStatus vts_stitch(const char *const *part_paths, size_t count, const char *output_path, char *error, size_t error_size) {
    static const VtsStatus statuses[] = {[STITCH_OK] = VTS_OK, [STITCH_FILE] = VTS_ERROR_FILE, [STITCH_MISFIT] = VTS_ERROR_USAGE};
    StrBuf why = {0};
    VtsStatus status = count > 0 ? statuses[image_stitch(part_paths, count, output_path, &why)] : VTS_ERROR_USAGE;
    if (count == 0) strbuf_adds(&why, "no parts given");
    if (error && error_size) snprintf(error, error_size, "%s", status == VTS_OK || !why.data ? "" : why.data);
    strbuf_free(&why);
    return status;
}
