/* A map looked at once from end to end, without keeping its heights: what `vts info` tells. */
#ifndef VTS_TERRAIN_MAP_SURVEY_H
#define VTS_TERRAIN_MAP_SURVEY_H

#include "terrain/heightmap.h"
#include "terrain/map_file.h"

typedef struct MapSurvey {
    const char *format, *samples;
    const char *remark; /* why it has no place, what was taken for granted, or NULL */
    bool is_picture;    /* neither format nor place make it a map: its samples are not looked at */
    int columns, rows;
    Georeference place;
    const char *system;     /* NULL without a place */
    HeightmapExtent extent; /* box, of areas to their outer edges, and spacing; with a place */
    double lowest, highest; /* metres; low > high: none */
    size_t voids;
} MapSurvey;

/* The place of a picture of that size, by its own word or that of a file beside it: sets `place`, `system` and `extent` where there is one. */
void map_survey_place(const char *path, int columns, int rows, MapSurvey *survey, Arena *arena);
/* False with a line in `error`. Texts lie in the arena. */
bool map_survey(const char *path, MapSurvey *survey, Arena *arena, StrBuf *error);

#endif
