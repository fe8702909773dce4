#include "terrain/map_survey.h"

#include "terrain/heightmap_parts.h"
#include "terrain/map_place.h"

#include <stdlib.h>
#include <string.h>

static const char *text_in(Arena *arena, const StrBuf *text) { return text->size ? arena_strdup(arena, text->data) : NULL; }

/* What the map covers: of pixels that are areas, their outer edges, which are taken as posts. */
static void measure_place(MapSurvey *survey, const char *path, Arena *arena) {
    Heightmap map = {.layers = arena_new(arena, MapLayer), .layer_count = 1};
    StrBuf system = {0};
    Georeference p = survey->place;
    int more = p.area ? 1 : 0;
    projection_describe(&p.projection, &system);
    survey->system = text_in(arena, &system);
    strbuf_free(&system);
    p.x[0] -= more * 0.5 * (p.x[1] + p.x[2]);
    p.y[0] -= more * 0.5 * (p.y[1] + p.y[2]);
    bool placed = georeference_from_affine(&p, &p.projection, (double[3]){p.x[0], p.x[1], p.x[2]}, (double[3]){p.y[0], p.y[1], p.y[2]},
                                           survey->columns + more, survey->rows + more, p.area);
    if (!placed || !map_layer_add(&map.layers[0], path, &p, survey->columns + more, survey->rows + more, arena)) return;
    map_layer_close(&map.layers[0], arena);
    heightmap_make_lattice(&map, arena, NULL);
    survey->extent = map.extent;
}

static void take_row(MapSurvey *survey, const float *samples, const PostScale *scale) {
    for (int c = 0; c < survey->columns; c++) {
        double height = (double)post_scale_apply(scale, (double)samples[c]);
        if (!isfinite(height)) {
            survey->voids++;
            continue;
        }
        survey->lowest = fmin(survey->lowest, height);
        survey->highest = fmax(survey->highest, height);
    }
}

static bool measure_heights(MapSurvey *survey, MapFile *file, StrBuf *error) {
    PostScale scale = {file->place.scale, file->place.offset, file->place.unit};
    float *row = malloc((size_t)file->columns * sizeof *row);
    bool good = row || map_fail(error, "not enough memory");
    for (int r = 0; good && r < file->rows; r++) {
        good = map_file_read(file, 1, NULL, row, error);
        if (good) take_row(survey, row, &scale);
    }
    free(row);
    return good;
}

void map_survey_place(const char *path, int columns, int rows, MapSurvey *survey, Arena *arena) {
    MapFile file = {.path = path, .columns = columns, .rows = rows};
    georeference_init(&file.place);
    map_place_picture(&file);
    survey->columns = columns;
    survey->rows = rows;
    survey->place = file.place;
    survey->remark = text_in(arena, &file.misplaced);
    strbuf_free(&file.misplaced);
    if (survey->place.placed) measure_place(survey, path, arena);
}

bool map_survey(const char *path, MapSurvey *survey, Arena *arena, StrBuf *error) {
    MapFile file;
    *survey = (MapSurvey){.lowest = VTS_INFINITY, .highest = -VTS_INFINITY};
    if (!map_file_open(&file, path, error)) return false;
    survey->format = file.format;
    survey->samples = file.samples;
    survey->columns = file.columns;
    survey->rows = file.rows;
    survey->place = file.place;
    survey->remark = text_in(arena, &file.misplaced);
    survey->is_picture = !file.place.placed && (strcmp(file.format, "picture") == 0 || strcmp(file.format, "TIFF") == 0);
    bool good = survey->is_picture || measure_heights(survey, &file, error);
    map_file_close(&file);
    if (good && survey->place.placed) measure_place(survey, path, arena);
    return good;
}
