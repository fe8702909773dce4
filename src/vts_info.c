/* vts_info(): what is in a file of heights, voxels, densities, triangles or pixels. Each fact is told twice: as a line of text, or under its key as
 * JSON. */
#include "vts_session.h"

#include "image/oiio_module.h"
#include "shape/mesh_file.h"
#include "terrain/geoid.h"
#include "terrain/map_survey.h"
#include "texel/texel_file.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

typedef struct Info {
    StrBuf *out;
    bool json;
    Arena *arena;
} Info;

/* ---- telling ---- */

static void begin(Info *info, const char *path, const char *kind, const char *format) {
    if (info->json) {
        strbuf_adds(info->out, "{\"file\":");
        strbuf_add_json(info->out, path);
        strbuf_addf(info->out, ",\"kind\":\"%s\",\"format\":", kind);
        strbuf_add_json(info->out, format);
    } else {
        strbuf_addf(info->out, "%s: %s, %s\n", path, kind, format);
    }
}

static void end(Info *info) {
    if (info->json) strbuf_adds(info->out, "}\n");
}

/* A line of text: what it is about, and a format. */
static void say(Info *info, const char *about, const char *format, ...) VTS_PRINTF(3, 4);
static void say(Info *info, const char *about, const char *format, ...) {
    if (info->json) return;
    va_list args;
    va_start(args, format);
    strbuf_addf(info->out, "  %-12s", about);
    strbuf_vaddf(info->out, format, args);
    strbuf_adds(info->out, "\n");
    va_end(args);
}

static void give_text(Info *info, const char *key, const char *text) {
    if (!info->json) return;
    strbuf_addf(info->out, ",\"%s\":", key);
    strbuf_add_json(info->out, text);
}

/* JSON has neither infinities nor NaN. */
static void give_number(Info *info, const char *key, double value) {
    if (!info->json) return;
    if (isfinite(value))
        strbuf_addf(info->out, ",\"%s\":%.12g", key, value);
    else
        strbuf_addf(info->out, ",\"%s\":null", key);
}

static void give_bool(Info *info, const char *key, bool value) {
    if (info->json) strbuf_addf(info->out, ",\"%s\":%s", key, value ? "true" : "false");
}

static void give_numbers(Info *info, const char *key, const double *values, int count) {
    if (!info->json) return;
    strbuf_addf(info->out, ",\"%s\":[", key);
    for (int i = 0; i < count; i++) strbuf_addf(info->out, "%s%.12g", i ? "," : "", values[i]);
    strbuf_adds(info->out, "]");
}

/* ---- maps ---- */

static const char *const HEIGHTS[] = {"not told (above the sea, as a rule)", "above the geoid (the sea)", "above the ellipsoid"};
static const char *const HEIGHT_KEYS[] = {"unknown", "geoid", "ellipsoid"};

/* The place of the first post, and the steps of columns and rows, in the system's units. */
static void tell_native(Info *info, const Georeference *p) {
    bool rotated = p->x[2] != 0 || p->y[1] != 0;
    say(info, "first post", "%.10g, %.10g", p->x[0], p->y[0]);
    if (rotated)
        say(info, "step", "column (%.10g, %.10g), row (%.10g, %.10g)", p->x[1], p->y[1], p->x[2], p->y[2]);
    else
        say(info, "step", "%.10g, %.10g", p->x[1], p->y[2]);
    give_numbers(info, "affine", (double[]){p->x[0], p->x[1], p->x[2], p->y[0], p->y[1], p->y[2]}, 6);
}

static void tell_place(Info *info, const Georeference *place, const char *system, const HeightmapExtent *e) {
    give_bool(info, "placed", place->placed);
    if (!place->placed) return;
    say(info, "system", "%s", system ? system : "");
    give_text(info, "system", system ? system : "");
    say(info, "pixels", place->area ? "are areas; the extent is that of their outer edges" : "are points; the extent is that of the outer ones");
    give_text(info, "registration", place->area ? "area" : "point");
    say(info, "longitude", "%.7f to %.7f", e->west, e->east);
    say(info, "latitude", "%.7f to %.7f", e->south, e->north);
    give_number(info, "west", e->west);
    give_number(info, "east", e->east);
    give_number(info, "south", e->south);
    give_number(info, "north", e->north);
    tell_native(info, place);
    say(info, "spacing", "%.5g m along a row, %.5g m along a column, in the middle", e->column_spacing, e->row_spacing);
    give_numbers(info, "spacing", (double[]){e->column_spacing, e->row_spacing}, 2);
}

static void tell_heights(Info *info, const MapSurvey *s) {
    size_t count = (size_t)s->columns * (size_t)s->rows;
    const Georeference *p = &s->place;
    if (s->lowest <= s->highest) say(info, "heights", "%.7g to %.7g m, %s", s->lowest, s->highest, HEIGHTS[p->heights]);
    else say(info, "heights", "none");
    give_number(info, "lowest", s->lowest);
    give_number(info, "highest", s->highest);
    give_text(info, "above", HEIGHT_KEYS[p->heights]);
    if (p->scale != 1 || p->offset != 0 || p->unit != 1) say(info, "scale", "(sample * %.9g + %.9g) * %.9g m", p->scale, p->offset, p->unit);
    give_number(info, "scale", p->scale);
    give_number(info, "offset", p->offset);
    give_number(info, "unit", p->unit);
    double share = (double)s->voids / (double)count;
    if (p->has_nodata) say(info, "no data", "%zu posts (%.3g %%), by the sample %.10g", s->voids, 100 * share, p->nodata);
    else say(info, "no data", "%zu posts (%.3g %%)", s->voids, 100 * share);
    if (p->has_nodata) give_number(info, "nodata", p->nodata);
    give_number(info, "nodata_share", share);
}

static void tell_map(Info *info, const char *path, const MapSurvey *s) {
    begin(info, path, "map", s->format);
    say(info, "posts", "%d x %d, %s", s->columns, s->rows, s->samples);
    give_number(info, "columns", s->columns);
    give_number(info, "rows", s->rows);
    give_text(info, "samples", s->samples);
    tell_place(info, &s->place, s->system, &s->extent);
    tell_heights(info, s);
    if (s->remark) say(info, s->place.placed ? "remark" : "no place", "%s", s->remark);
    if (s->remark) give_text(info, "remark", s->remark);
    end(info);
}

static VtsStatus info_map(Info *info, const char *path, StrBuf *error) {
    MapSurvey survey;
    if (!map_survey(path, &survey, info->arena, error)) return VTS_ERROR_FILE;
    tell_map(info, path, &survey);
    return VTS_OK;
}

static VtsStatus info_geoid(Info *info, const char *path, StrBuf *error) {
    Geoid g;
    char *named = arena_printf(info->arena, "%s%s", strchr(path, '/') ? "" : "./", path);
    if (!geoid_load(&g, named, NULL, 0, info->arena, error)) return VTS_ERROR_FILE;
    double low = VTS_INFINITY, high = -VTS_INFINITY;
    for (size_t i = 0; i < (size_t)g.columns * (size_t)g.rows; i++) {
        low = isnan(g.nodes[i]) ? low : fmin(low, (double)g.nodes[i]);
        high = isnan(g.nodes[i]) ? high : fmax(high, (double)g.nodes[i]);
    }
    begin(info, path, "geoid", "GTX");
    say(info, "nodes", "%d x %d", g.columns, g.rows);
    say(info, "longitude", "%.7g to %.7g", g.west, g.west + g.step_east * (g.columns - 1));
    say(info, "latitude", "%.7g to %.7g", g.south, g.south + g.step_north * (g.rows - 1));
    say(info, "heights", "%.7g to %.7g m above the ellipsoid", low, high);
    give_number(info, "columns", g.columns);
    give_number(info, "rows", g.rows);
    give_number(info, "west", g.west);
    give_number(info, "south", g.south);
    give_numbers(info, "step", (double[]){g.step_east, g.step_north}, 2);
    give_number(info, "lowest", low);
    give_number(info, "highest", high);
    end(info);
    return VTS_OK;
}

/* ---- pictures ---- */

static void tell_picture(Info *info, const char *path, const OiioHeader *header, const Georeference *place, const MapSurvey *measured) {
    const char *dot = strrchr(path, '.');
    begin(info, path, "picture", dot ? dot + 1 : "");
    say(info, "pixels", "%d x %d, %d channel%s, %s", header->width, header->height, header->channels, header->channels == 1 ? "" : "s",
        image_sample_name(header->sample));
    give_number(info, "width", header->width);
    give_number(info, "height", header->height);
    give_number(info, "channels", header->channels);
    give_text(info, "samples", image_sample_name(header->sample));
    StrBuf names = {0};
    for (int i = 0; i < header->channels && i < 64; i++) strbuf_addf(&names, "%s%s", i ? ", " : "", header->names[i]);
    say(info, "channels", "%s", names.data ? names.data : "");
    give_text(info, "channel_names", names.data ? names.data : "");
    strbuf_free(&names);
    tell_place(info, place, measured->system, &measured->extent);
    end(info);
}

static VtsStatus info_picture(Info *info, const char *path, StrBuf *error) {
    char why[OIIO_ERROR_SIZE] = "";
    OiioReader *reader = NULL;
    OiioHeader header;
    MapSurvey survey = {0};
    const OiioShim *shim = oiio_module_load(error);
    if (!shim) return VTS_ERROR_FILE;
    if (!shim->open(path, &reader, &header, why)) {
        strbuf_adds(error, why);
        return VTS_ERROR_FILE;
    }
    map_survey_place(path, header.width, header.height, &survey, info->arena);
    tell_picture(info, path, &header, &survey.place, &survey);
    shim->close(reader);
    return VTS_OK;
}

/* A picture of one channel that lies somewhere is a map; one that lies nowhere, or is in colours, a picture. */
static VtsStatus info_map_or_picture(Info *info, const char *path, StrBuf *error) {
    MapSurvey survey;
    StrBuf why = {0}, other = {0};
    bool mapped = map_survey(path, &survey, info->arena, &why);
    VtsStatus status = VTS_OK;
    if (mapped && !survey.is_picture)
        tell_map(info, path, &survey);
    else if ((status = info_picture(info, path, &other)) != VTS_OK)
        strbuf_adds(error, why.size ? why.data : other.data);
    strbuf_free(&why);
    strbuf_free(&other);
    return status;
}

/* ---- texels and volumes ---- */

static void tell_levels(Info *info, const TexelFileLayer *layer, size_t number) {
    StrBuf text = {0};
    int size[3];
    for (int l = 0; l < voxel_layer_levels(layer->voxels); l++) {
        voxel_layer_size(layer->voxels, l, size);
        strbuf_addf(&text, "%s%dx%dx%d: %zu", l ? ", " : "", size[0], size[1], size[2], voxel_layer_voxels(layer->voxels, l));
    }
    char about[32];
    snprintf(about, sizeof about, "layer %zu", number);
    say(info, about, "voxels %s", text.data ? text.data : "none");
    strbuf_free(&text);
}

static void give_layers(Info *info, const TexelFile *file) {
    if (!info->json) return;
    strbuf_adds(info->out, ",\"layers\":[");
    for (size_t i = 0; i < file->layer_count; i++) {
        strbuf_adds(info->out, i ? ",[" : "[");
        for (int l = 0; l < voxel_layer_levels(file->layers[i].voxels); l++)
            strbuf_addf(info->out, "%s%zu", l ? "," : "", voxel_layer_voxels(file->layers[i].voxels, l));
        strbuf_adds(info->out, "]");
    }
    strbuf_adds(info->out, "]");
}

static void tell_texel(Info *info, const char *path, const TexelFile *file) {
    Vec3 a = file->bounds.min, b = file->bounds.max;
    int size[3] = {0}, levels = voxel_layer_levels(file->layers[0].voxels);
    size_t bytes = 0;
    voxel_layer_size(file->layers[0].voxels, 0, size);
    for (size_t i = 0; i < file->layer_count; i++) bytes += voxel_layer_bytes(file->layers[i].voxels);
    begin(info, path, "texel", ".vtx");
    say(info, "name", "%s", file->name);
    say(info, "bounds", "<%.6g, %.6g, %.6g>, <%.6g, %.6g, %.6g>", a.x, a.y, a.z, b.x, b.y, b.z);
    say(info, "resolution", "%d asked, %d built: %d x %d x %d voxels", file->asked, file->built, size[0], size[1], size[2]);
    say(info, "cyclic", "%s%s%s%s", file->cyclic & TEXEL_CYCLIC_X ? "x" : "", file->cyclic & TEXEL_CYCLIC_Y ? "y" : "",
        file->cyclic & TEXEL_CYCLIC_Z ? "z" : "", file->cyclic ? "" : "none");
    say(info, "levels", "%d", levels);
    for (size_t i = 0; i < file->layer_count; i++) tell_levels(info, &file->layers[i], i + 1);
    say(info, "memory", "%zu bytes", bytes);
    give_text(info, "name", file->name);
    give_numbers(info, "bounds", (double[]){a.x, a.y, a.z, b.x, b.y, b.z}, 6);
    give_number(info, "asked", file->asked);
    give_number(info, "built", file->built);
    give_numbers(info, "size", (double[]){size[0], size[1], size[2]}, 3);
    give_number(info, "levels", levels);
    give_layers(info, file);
    give_number(info, "bytes", (double)bytes);
    end(info);
}

static VtsStatus info_texel(Info *info, const char *path, MemoryBudget *memory, StrBuf *error) {
    TexelFile file;
    TexelFileStatus status = texel_file_load(path, memory, &file, error);
    if (status == TEXEL_FILE_NO_MEMORY) return VTS_ERROR_MEMORY;
    if (status != TEXEL_FILE_OK) return VTS_ERROR_FILE;
    tell_texel(info, path, &file);
    texel_file_release(&file);
    return VTS_OK;
}

static uint64_t number_at(const unsigned char *bytes, int width, bool big) {
    uint64_t value = 0;
    for (int k = 0; k < width; k++) value = value << 8 | bytes[big ? k : width - 1 - k];
    return value;
}

typedef struct Bytes {
    unsigned char head[1024];
    size_t read, size; /* of `head`; of the file */
} Bytes;

static VtsStatus info_df3(Info *info, const char *path, const Bytes *bytes, StrBuf *error) {
    double size[3], count = 1;
    for (int k = 0; k < 3; k++) count *= size[k] = (double)number_at(bytes->head + 2 * k, 2, true);
    double width = count > 0 ? (double)(bytes->size - 6) / count : 0;
    if (bytes->size < 7 || (width != 1 && width != 2 && width != 4)) {
        strbuf_adds(error, "its size is not what its header says: it is no df3 file, or cut short");
        return VTS_ERROR_FILE;
    }
    begin(info, path, "volume", "POV-Ray df3");
    say(info, "cells", "%.0f x %.0f x %.0f, %.0f-bit unsigned", size[0], size[1], size[2], 8 * width);
    give_numbers(info, "size", size, 3);
    give_number(info, "bits", 8 * width);
    end(info);
    return VTS_OK;
}

/* One grid's entry in a NanoVDB file: 176 bytes, and its name. */
static void tell_nanovdb_grid(Info *info, const unsigned char *entry, const char *name) {
    static const char *const types[] = {"unknown", "32-bit float", "64-bit float", "16-bit signed", "32-bit signed", "64-bit signed", "vectors of floats",
                                        "vectors of doubles", "mask", "16-bit float"};
    static const char *const codecs[] = {"not compressed", "ZIP", "Blosc"};
    uint64_t type = number_at(entry + 32, 4, false), codec = number_at(entry + 168, 2, false), voxels = number_at(entry + 24, 8, false);
    double box[6], voxel[3];
    for (int k = 0; k < 6; k++) box[k] = (double)(int32_t)(uint32_t)number_at(entry + 88 + 4 * k, 4, false);
    for (int k = 0; k < 3; k++) {
        uint64_t bits = number_at(entry + 112 + 8 * k, 8, false);
        memcpy(&voxel[k], &bits, sizeof voxel[k]);
    }
    const char *kind = types[type < VTS_ARRAY_COUNT(types) ? type : 0];
    say(info, "grid", "'%s', %s, %s", name, kind, codec < 3 ? codecs[codec] : "unknown compression");
    say(info, "cells", "%.0f x %.0f x %.0f, %llu of them active", box[3] - box[0] + 1, box[4] - box[1] + 1, box[5] - box[2] + 1, (unsigned long long)voxels);
    say(info, "voxel", "%.6g x %.6g x %.6g", voxel[0], voxel[1], voxel[2]);
    give_text(info, "grid", name);
    give_text(info, "samples", kind);
    give_numbers(info, "size", (double[]){box[3] - box[0] + 1, box[4] - box[1] + 1, box[5] - box[2] + 1}, 3);
    give_numbers(info, "voxel", voxel, 3);
    give_number(info, "active", (double)voxels);
}

static VtsStatus info_nanovdb(Info *info, const char *path, const Bytes *bytes, StrBuf *error) {
    enum { HEADER = 16, ENTRY = 176, NAME = HEADER + ENTRY };
    uint64_t name_size = bytes->read >= NAME ? number_at(bytes->head + HEADER + 136, 4, false) : 0;
    if (bytes->read < NAME + 1 || name_size < 1 || NAME + name_size > bytes->read || number_at(bytes->head + HEADER, 8, false) > UINT64_MAX / 2) {
        strbuf_adds(error, "it ends within its header, or that is damaged");
        return VTS_ERROR_FILE;
    }
    char *name = arena_printf(info->arena, "%.*s", (int)name_size, (const char *)bytes->head + NAME);
    begin(info, path, "volume", "NanoVDB");
    say(info, "grids", "%u", (unsigned)number_at(bytes->head + 12, 2, false));
    give_number(info, "grids", (double)number_at(bytes->head + 12, 2, false));
    tell_nanovdb_grid(info, bytes->head + HEADER, name);
    end(info);
    return VTS_OK;
}

/* A raw volume does not say its size: cubes of the usual samples that it would be. */
static VtsStatus info_raw(Info *info, const char *path, const Bytes *bytes) {
    static const struct {
        size_t width;
        const char *name;
    } samples[] = {{1, "8-bit"}, {2, "16-bit"}, {4, "32-bit"}};
    begin(info, path, "volume", "raw numbers");
    say(info, "size", "%zu bytes; the scene must say how many cells of which samples", bytes->size);
    give_number(info, "bytes", (double)bytes->size);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(samples); i++) {
        double side = round(cbrt((double)(bytes->size / samples[i].width)));
        if (side >= 2 && side * side * side * (double)samples[i].width == (double)bytes->size)
            say(info, "perhaps", "%.0f x %.0f x %.0f, %s", side, side, side, samples[i].name);
    }
    end(info);
    return VTS_OK;
}

/* ---- meshes ---- */

typedef struct MeshFacts {
    Box3 bounds;
    double area;
    size_t vertices, triangles, normals, uvs, colors; /* the last three: parts that have them */
} MeshFacts;

static void add_part(MeshFacts *facts, const MeshFilePart *part) {
    const MeshData *mesh = part->mesh;
    facts->vertices += mesh->vertex_count;
    facts->triangles += mesh->triangle_count;
    facts->normals += mesh->normals != NULL;
    facts->uvs += mesh->uvs != NULL;
    facts->colors += part->colored;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const Vec3 *a = &mesh->vertices[mesh->triangles[i][0]], *b = &mesh->vertices[mesh->triangles[i][1]], *c = &mesh->vertices[mesh->triangles[i][2]];
        facts->area += vec3_length(vec3_cross(vec3_sub(*b, *a), vec3_sub(*c, *a))) / 2;
        facts->bounds.min = vec3_min(facts->bounds.min, vec3_min(*a, vec3_min(*b, *c)));
        facts->bounds.max = vec3_max(facts->bounds.max, vec3_max(*a, vec3_max(*b, *c)));
    }
}

static const char *which_parts(const Info *info, size_t some, size_t all) {
    if (some == 0 || some == all) return some ? "yes" : "none";
    return arena_printf(info->arena, "of %zu of %zu parts", some, all);
}

static void tell_mesh(Info *info, const char *path, const MeshFile *file) {
    MeshFacts f = {.bounds = box3_empty()};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; i < file->part_count; i++) add_part(&f, &file->parts[i]);
    Vec3 a = f.bounds.min, b = f.bounds.max;
    begin(info, path, "mesh", dot ? dot + 1 : "");
    say(info, "triangles", "%zu; %zu vertices", f.triangles, f.vertices);
    if (f.triangles) say(info, "bounds", "<%.6g, %.6g, %.6g>, <%.6g, %.6g, %.6g>", a.x, a.y, a.z, b.x, b.y, b.z);
    say(info, "area", "%.6g", f.area);
    say(info, "normals", "%s", which_parts(info, f.normals, file->part_count));
    say(info, "uv", "%s", which_parts(info, f.uvs, file->part_count));
    if (f.colors) say(info, "colors", "%zu", f.colors);
    give_number(info, "triangles", (double)f.triangles);
    give_number(info, "vertices", (double)f.vertices);
    if (f.triangles) give_numbers(info, "bounds", (double[]){a.x, a.y, a.z, b.x, b.y, b.z}, 6);
    give_number(info, "area", f.area);
    give_number(info, "parts", (double)file->part_count);
    give_number(info, "parts_with_normals", (double)f.normals);
    give_number(info, "parts_with_uv", (double)f.uvs);
    give_number(info, "colors", (double)f.colors);
    end(info);
}

static VtsStatus info_mesh(Info *info, const char *path, StrBuf *error) {
    MeshFile file;
    const MeshFileOptions options = {.by_color = true};
    if (!mesh_file_read(path, &options, info->arena, &file, error)) return VTS_ERROR_FILE;
    tell_mesh(info, path, &file);
    return VTS_OK;
}

/* ---- which ---- */

static bool has_suffix(const char *path, const char *suffix) {
    size_t size = strlen(path), tail = strlen(suffix);
    if (size < tail) return false;
    for (size_t i = 0; i < tail; i++) {
        char c = path[size - tail + i];
        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != suffix[i]) return false;
    }
    return true;
}

static bool read_head(const char *path, Bytes *bytes) {
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode)) return false;
    FILE *file = fopen(path, "rb");
    if (!file) return false;
    bytes->size = (size_t)about.st_size;
    bytes->read = fread(bytes->head, 1, sizeof bytes->head, file);
    fclose(file);
    return true;
}

static VtsStatus info_of(Info *info, const char *path, const Bytes *bytes, MemoryBudget *memory, StrBuf *error) {
    if (bytes->read >= 4 && memcmp(bytes->head + 1, "VTX", 3) == 0) return info_texel(info, path, memory, error);
    if (bytes->read >= 8 && memcmp(bytes->head, "NanoVDB", 7) == 0) return info_nanovdb(info, path, bytes, error);
    if (has_suffix(path, ".df3")) return info_df3(info, path, bytes, error);
    if (has_suffix(path, ".raw") || has_suffix(path, ".vol")) return info_raw(info, path, bytes);
    if (has_suffix(path, ".gtx")) return info_geoid(info, path, error);
    if (has_suffix(path, ".vts") || has_suffix(path, ".pov") || has_suffix(path, ".inc")) {
        strbuf_adds(error, "it is a scene: 'vts check' and 'vts run --dump' tell of scenes");
        return VTS_ERROR_FILE;
    }
    static const char *const meshes[] = {".obj", ".ply", ".gltf", ".glb", ".stl", ".off"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(meshes); i++)
        if (has_suffix(path, meshes[i])) return info_mesh(info, path, error);
    if (has_suffix(path, ".hgt") || has_suffix(path, ".dem") || has_suffix(path, ".asc")) return info_map(info, path, error);
    return info_map_or_picture(info, path, error);
}

VtsStatus session_info(VtsSession *session, const char *path, bool json) {
    Info info = {&session->report, json, &session->parse};
    Bytes bytes = {.read = 0};
    StrBuf error = {0};
    strbuf_clear(&session->report);
    bool readable = read_head(path, &bytes);
    MapFile none;
    VtsStatus status = VTS_ERROR_FILE;
    if (readable && bytes.read > 0) status = info_of(&info, path, &bytes, &session->memory, &error);
    else map_file_open(&none, path, &error); /* to hear why not */
    if (status == VTS_ERROR_FILE) diag_error(&session->diags, (Span){0}, "'%s': %s", path, error.data ? error.data : "it cannot be read");
    strbuf_free(&error);
    if (status == VTS_ERROR_MEMORY) memory_budget_fail(&session->memory);
    return status;
}
