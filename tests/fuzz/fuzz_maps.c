/* Maps of all formats that are read here: whatever the bytes are, they are refused with a reason or become ground that can be asked for.
 * The first byte says what the rest is. */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "fuzz.h"

#include "terrain/geoid.h"
#include "terrain/heightmap.h"
#include "terrain/map_place.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>

static void on_exhausted(void *context) { longjmp(*(jmp_buf *)context, 1); }

static const char *own_folder(void) {
    static char folder[] = "/tmp/vts-fuzz-XXXXXX"; /* one for all maps of a process */
    static bool made;
    if (!made) made = mkdtemp(folder) != NULL;
    return folder;
}

static void write_file(const char *path, const uint8_t *data, size_t size) {
    FILE *f = fopen(path, "wb");
    if (!f) return;
    fwrite(data, 1, size, f);
    fclose(f);
}

/* Every height that is given is finite, and within the bounds that are told. */
static void ask(const Heightmap *map) {
    const HeightmapExtent *e = heightmap_extent(map);
    for (int k = 0; k < 200; k++) {
        double column = (e->columns - 1) * (k % 20 / 19.0), row = (e->rows - 1) * (k / 20 / 9.0), height, ground;
        GeoPlace place;
        if (!heightmap_at(map, column, row, &height)) continue;
        if (!isfinite(height) || height < e->lowest - 1e-3 * (1 + fabs(e->lowest)) || height > e->highest + 1e-3 * (1 + fabs(e->highest))) abort();
        if (heightmap_to_geo(map, column, row, &place) && heightmap_height(map, place, &ground) && !isfinite(ground)) abort();
    }
}

static void open_map(const char *path, HeightmapVoids voids, Arena *arena, DiagList *diags) {
    HeightmapPlace place = {.west_south = {10, 50}, .east_north = {11, 51}, .area = true};
    projection_lonlat(&place.projection);
    for (int placed = 0; placed < 2; placed++) {
        HeightmapOptions options = {.voids = voids, .place = placed ? &place : NULL};
        size_t errors = diags->failures;
        const Heightmap *map = heightmap_open(&path, 1, &options, arena, diags, (Span){0});
        if (map) ask(map);
        else if (diags->failures == errors) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const names[] = {"map.asc", "map.dem", "N10E020.hgt", "map.gtx", "map.prj"};
    char path[64];
    if (size < 1) return 0;
    unsigned kind = data[0] % 5;
    snprintf(path, sizeof path, "%s/%s", own_folder(), names[kind]);
    write_file(path, data + 1, size - 1);
    jmp_buf jump;
    MemoryBudget budget = {.limit = 256u << 20, .on_exhausted = on_exhausted, .context = &jump};
    Arena arena, texts;
    StrBuf error = {0};
    arena_init(&arena, &budget, 0);
    arena_init(&texts, NULL, 0);
    if (setjmp(jump) == 0) {
        SourceSet sources;
        DiagList diags;
        Geoid geoid;
        Projection projection;
        double n;
        source_set_init(&sources, &texts);
        diag_init(&diags, &texts, &sources);
        if (kind == 4)
            map_parse_system((const char *)data + 1, size - 1, &projection, &error);
        else if (kind == 3 && geoid_load(&geoid, path, NULL, 0, &arena, &error))
            geoid_undulation(&geoid, 10, 20, &n);
        else if (kind < 3)
            open_map(path, size % 2 ? HEIGHTMAP_FILL : HEIGHTMAP_HOLES, &arena, &diags);
    }
    remove(path);
    strbuf_free(&error);
    arena_destroy(&arena);
    arena_destroy(&texts);
    return 0;
}
