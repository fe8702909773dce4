/* Where files are looked for, and which a scene may touch: scenes come from strangers. */
#define _XOPEN_SOURCE 700 /* realpath */

#include "eval/build_parts.h"
#include "eval/eval_files.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *folder_of(Eval *ev, const char *path) {
    const char *slash = strrchr(path, '/');
    if (!slash) return ".";
    return arena_printf(ev->parse, "%.*s", (int)(slash == path ? 1 : slash - path), path);
}

/* `path`, once all links are followed, lies in `folder`. */
static bool lies_in(const char *path, const char *folder) {
    char *real = realpath(folder, NULL);
    if (!real) return false;
    size_t n = strlen(real);
    bool in =
        strncmp(path, real, n) == 0 && (path[n] == '/' || path[n] == '\0' || (n == 1 && real[0] == '/'));
    free(real);
    return in;
}

static bool lies_in_any(const char *path, const char *const *folders, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (lies_in(path, folders[i])) return true;
    return false;
}

/* The system's fonts are no secret, and POV-Ray's include folder only links to them. */
static const char *const font_folders[] = {"/usr/share/fonts", "/usr/local/share/fonts"};

bool path_may_read(const Eval *ev, const char *path) {
    const EvalOptions *o = ev->options;
    char *real = realpath(path, NULL);
    if (!real) return false;
    bool may = lies_in(real, ev->scene_folder) || lies_in_any(real, o->include_dirs, o->include_dir_count) ||
               lies_in_any(real, o->allow_read, o->allow_read_count) ||
               (o->stdlib_dir && lies_in(real, o->stdlib_dir)) || lies_in_any(real, font_folders, VTS_ARRAY_COUNT(font_folders));
    free(real);
    return may;
}

/* A file that does not exist yet is judged by its folder. */
bool path_may_write(Eval *ev, const char *path) {
    char *real = realpath(folder_of(ev, path), NULL);
    if (!real) return false;
    bool may = lies_in_any(real, ev->options->allow_write, ev->options->allow_write_count);
    free(real);
    struct stat info;
    if (may && lstat(path, &info) == 0 && !S_ISREG(info.st_mode)) return false;
    return may;
}

static bool is_file(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode); /* reading others may never end */
}

static const char *join(Eval *ev, const char *folder, const char *name) {
    return strcmp(folder, ".") == 0 ? arena_strdup(ev->parse, name)
                                    : arena_printf(ev->parse, "%s/%s", folder, name);
}

const char *path_find(Eval *ev, const char *name, Span from, Diagnostic **refused, StrBuf *looked_in) {
    const EvalOptions *o = ev->options;
    const char *folders[64];
    size_t count = 0;
    SourcePlace place = source_locate(ev->sources, from);
    if (place.file) folders[count++] = folder_of(ev, place.file->path);
    folders[count++] = ev->scene_folder;
    for (size_t i = 0; i < o->include_dir_count && count < VTS_ARRAY_COUNT(folders) - 1; i++)
        folders[count++] = o->include_dirs[i];
    if (o->stdlib_dir) folders[count++] = o->stdlib_dir;
    if (name[0] == '/') {
        folders[0] = "";
        count = 1;
    }
    for (size_t i = 0; i < count; i++) {
        bool seen = false;
        for (size_t k = 0; k < i && !seen; k++) seen = strcmp(folders[i], folders[k]) == 0;
        if (seen) continue;
        const char *path = name[0] == '/' ? name : join(ev, folders[i], name);
        if (!is_file(path)) {
            if (looked_in)
                strbuf_addf(looked_in, "%s%s", looked_in->size ? ", " : "",
                            name[0] == '/' ? "/" : folders[i]);
            continue;
        }
        if (path_may_read(ev, path)) return path;
        if (refused) {
            *refused = diag_error(ev->diags, from, "the scene may not read '%s'", path);
            diag_hint(ev->diags, *refused, "--allow-read gives it another folder");
            return NULL;
        }
    }
    return NULL;
}

bool file_exists_for(Eval *ev, const char *name, Span span) {
    return files_in_memory(ev, name) != NULL || path_find(ev, name, span, NULL, NULL) != NULL;
}

void eval_set_scene_path(Eval *ev, const char *path) {
    ev->scene_path = path;
    ev->scene_folder = folder_of(ev, path);
}

/* The endings that POV-Ray tries. */
static const char *const endings[][3] = {
    {"gif", ".gif", ".GIF"}, {"tga", ".tga", ".TGA"},   {"png", ".png", ".PNG"},   {"ppm", ".ppm", ".PPM"},
    {"pgm", ".pgm", ".PGM"}, {"jpeg", ".jpg", ".jpeg"}, {"tiff", ".tif", ".tiff"}, {"iff", ".iff", ".IFF"},
    {"exr", ".exr", ".EXR"}, {"hdr", ".hdr", ".HDR"},
};

static const char *with_ending(Eval *ev, const char *name, const char *format, Span span) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(endings); i++)
        for (int k = 1; k < 3 && (!format || strcmp(endings[i][0], format) == 0); k++) {
            const char *path =
                path_find(ev, arena_printf(ev->build.arena, "%s%s", name, endings[i][k]), span, NULL, NULL);
            if (path) return path;
        }
    return NULL;
}

const char *picture_find(const BuildContext *context, const char *name, const char *format, Span span) {
    Eval *ev = context->eval;
    StrBuf looked_in = {0};
    Diagnostic *refused = NULL;
    const char *path = ev ? path_find(ev, name, span, &refused, &looked_in) : name;
    if (!path && !refused) path = with_ending(ev, name, format, span);
    if (!path && !refused) {
        Diagnostic *d = diag_error(context->diags, span, "there is no picture '%s'", name);
        diag_hint(context->diags, d, "looked in %s", looked_in.data ? looked_in.data : "nowhere");
    }
    if (path) path = arena_strdup(context->arena, path);
    strbuf_free(&looked_in);
    return path;
}

const char *data_file_find(const BuildContext *context, const char *what, const char *name, Span span) {
    StrBuf looked_in = {0};
    Diagnostic *refused = NULL;
    const char *path = context->eval ? path_find(context->eval, name, span, &refused, &looked_in) : NULL;
    if (!path && !refused) {
        Diagnostic *d = diag_error(context->diags, span, "there is no %s '%s'", what, name);
        diag_hint(context->diags, d, "looked in %s", looked_in.data ? looked_in.data : "nowhere");
    }
    strbuf_free(&looked_in);
    return path ? arena_strdup(context->arena, path) : NULL;
}

static const EvalGeometry *geometry_of(const BuildContext *context) {
    return context->eval ? ((const Eval *)context->eval)->options->geometry : NULL;
}

static void refuse_file(const BuildContext *context, const char *what, const char *path, Span span, StrBuf *why) {
    diag_error(context->diags, span, "the %s '%s' is refused: %s", what, path, why->size ? why->data : "such files are not read here");
    strbuf_free(why);
}

bool texel_file_read(const BuildContext *context, const char *name, Span span, TexelDef *out) {
    const char *path = data_file_find(context, "texel file", name, span);
    const EvalGeometry *geometry = geometry_of(context);
    StrBuf error = {0};
    if (!path) return false;
    if (geometry && geometry->texel_file && geometry->texel_file(geometry->context, context->arena, path, span, out, &error)) return true;
    refuse_file(context, "texel file", path, span, &error);
    return false;
}

bool mesh_file_load(const BuildContext *context, const char *name, Span span, const EvalMeshRequest *request, EvalMeshFile *out) {
    const char *path = data_file_find(context, "mesh file", name, span);
    const EvalGeometry *geometry = geometry_of(context);
    StrBuf error = {0};
    if (!path) return false;
    if (geometry && geometry->mesh_file && geometry->mesh_file(geometry->context, context->arena, path, request, out, &error)) return true;
    refuse_file(context, "mesh file", path, span, &error);
    return false;
}

bool picture_from_pixels(const BuildContext *context, int columns, int rows, const float (*pixels)[4], ImageMap *image) {
    const EvalGeometry *geometry = geometry_of(context);
    return !geometry || !geometry->picture_made || geometry->picture_made(geometry->context, context->arena, columns, rows, pixels, image);
}

bool picture_file_load(const BuildContext *context, ImageMap *image, Span span) {
    const EvalGeometry *geometry = geometry_of(context);
    StrBuf error = {0};
    if (!geometry || !geometry->picture_file) return true;
    bool good = geometry->picture_file(geometry->context, context->arena, image, &error);
    if (good && (!image->georeferenced || geometry->picture_place(geometry->context, context->arena, &context->geo_origin, image, &error))) return true;
    refuse_file(context, "picture", image->path, span, &error);
    return false;
}

/* Beside the scene and where includes are, with or without its ending; names of PROJ's grids are left as they are. */
static bool find_geoid(const BuildContext *context, const char **name, Span span) {
    if (!context->eval) return true;
    const char *path = path_find(context->eval, *name, span, NULL, NULL);
    if (!path) path = path_find(context->eval, arena_printf(context->arena, "%s.gtx", *name), span, NULL, NULL);
    if (path) *name = arena_printf(context->arena, "%s%s", strchr(path, '/') ? "" : "./", path);
    else if (strchr(*name, '/')) return data_file_find(context, "geoid", *name, span) != NULL;
    return true;
}

bool terrain_load(const BuildContext *context, EvalTerrainRequest *request, const Span *spans, Span span, Terrain *out) {
    const EvalGeometry *geometry = geometry_of(context);
    for (size_t i = 0; i < request->count; i++)
        if (!(request->paths[i] = data_file_find(context, "heightmap", request->paths[i], spans[i]))) return false;
    if (request->geoid && !find_geoid(context, &request->geoid, span)) return false;
    if (geometry && geometry->terrain) return geometry->terrain(geometry->context, context->arena, request, context->diags, span, out);
    diag_error(context->diags, span, "maps are not read here");
    return false;
}
