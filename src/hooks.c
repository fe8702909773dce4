#include "hooks.h"

#include "pattern/pattern_function.h"
#include "image/palette.h"
#include "image/picture.h"
#include "shape/extent.h"
#include "shape/mesh_file.h"
#include "terrain/sun.h"
#include "terrain/drape.h"
#include "terrain/ground.h"
#include "volume/grid_file.h"
#include "volume/nanovdb.h"

#include <string.h>

/* One picture stands in many pigments. */
typedef struct KnownPicture {
    const char *path;
    double gamma;
    bool use_index, by_index; /* wanted, and had */
    Picture picture;
    struct KnownPicture *next;
} KnownPicture;

typedef struct Hooks {
    ShapeTracer *tracer;
    TexelCache *texels;
    MemoryBudget *memory;
    KnownPicture *pictures;
} Hooks;

/* A ray that starts on a surface does not meet it there. */
static const double START = 1e-6;

static bool trace(void *context, const Object *object, Vec3 origin, Vec3 direction, Vec3 *point,
                  Vec3 *normal) {
    const Hooks *hooks = context;
    TraceHit hit;
    const Ray ray = {origin, vec3_normalize(direction)};
    if (!shape_trace(hooks->tracer, object, &ray, START, &hit)) return false;
    *point = hit.point;
    *normal = hit.normal;
    return true;
}

static bool inside(void *context, const Object *object, Vec3 point) {
    return shape_trace_inside(((const Hooks *)context)->tracer, object, point);
}

static bool pigment_function(void *context, Arena *arena, const Pigment *pigment, TapeExternal *out) {
    (void)context, (void)arena;
    *out = pigment_external(pigment);
    return true;
}

static bool pattern_function(void *context, Arena *arena, const Pigment *pattern, TapeExternal *out) {
    (void)context, (void)arena;
    *out = pattern_external(pattern);
    return true;
}

static Box3 extent(void *context, const Object *object) {
    return shape_extent(((const Hooks *)context)->tracer, object);
}

static bool texel_file(void *context, Arena *arena, const char *path, Span span, TexelDef *out, StrBuf *error) {
    const Hooks *hooks = context;
    TexelFileStatus status;
    const TexelFile *file = hooks->texels ? texel_cache_open(hooks->texels, path, &status, error) : NULL;
    if (file) texel_def_from_file(file, path, span, arena, out);
    else if (hooks->texels && status == TEXEL_FILE_NO_MEMORY && hooks->memory) memory_budget_fail(hooks->memory);
    return file != NULL;
}

static bool mesh_file(void *context, Arena *arena, const char *path, const EvalMeshRequest *request, EvalMeshFile *out, StrBuf *error) {
    (void)context;
    MeshFile file;
    MeshFileOptions options = {request->most_vertices, request->by_color, request->smooth};
    if (!mesh_file_read(path, &options, arena, &file, error)) return false;
    EvalMeshPart *parts = arena_new_array(arena, EvalMeshPart, file.part_count);
    for (size_t i = 0; i < file.part_count; i++)
        parts[i] = (EvalMeshPart){file.parts[i].mesh, file.parts[i].colored, file.parts[i].color};
    *out = (EvalMeshFile){parts, file.part_count};
    return true;
}

static const KnownPicture *find_picture(const Hooks *hooks, const ImageMap *image) {
    const KnownPicture *known = hooks->pictures;
    while (known && !(known->gamma == image->gamma && known->use_index == image->use_index && strcmp(known->path, image->path) == 0)) known = known->next;
    return known;
}

/* Numbers of palettes as light, 255 being 1. */
static bool load_numbers(const ImageMap *image, Arena *arena, Picture *out, StrBuf *error) {
    float entries[PALETTE_MOST][4];
    for (int i = 0; i < PALETTE_MOST; i++)
        for (int c = 0; c < 4; c++) entries[i][c] = c < 3 ? (float)i / (PALETTE_MOST - 1) : 1;
    return image->use_index && picture_load_entries(image->path, (const float(*)[4])entries, arena, out, error);
}

static void load_shares(ImageMap *image, Arena *arena) {
    float entries[PALETTE_MOST][4] = {{0}};
    if (!image->palette_count) return;
    for (int i = 0; i < PALETTE_MOST; i++) entries[i][3] = 1;
    for (size_t k = 0; k < image->palette_count; k++) {
        const double *share = image->palette_filter + 3 * k;
        if (!(share[0] >= 0 && share[0] < PALETTE_MOST)) continue;
        entries[(int)share[0]][0] += (float)share[1];
        entries[(int)share[0]][1] += (float)share[2];
    }
    Picture *shares = arena_new(arena, Picture);
    if (picture_load_entries(image->path, (const float(*)[4])entries, arena, shares, NULL)) image->shares = shares;
}

static bool picture_file(void *context, Arena *arena, ImageMap *image, StrBuf *error) {
    Hooks *hooks = context;
    const KnownPicture *known = find_picture(hooks, image);
    if (!known) {
        KnownPicture *loaded = arena_new(arena, KnownPicture);
        PictureGamma curve = image->gamma > 0 ? PICTURE_GAMMA_POWER : image->gamma < 0 ? PICTURE_GAMMA_SRGB : PICTURE_GAMMA_FILE;
        loaded->by_index = load_numbers(image, arena, &loaded->picture, error);
        if (!loaded->by_index && !picture_load(image->path, curve, image->gamma, arena, &loaded->picture, error)) return false;
        loaded->path = image->path;
        loaded->gamma = image->gamma;
        loaded->use_index = image->use_index;
        loaded->next = hooks->pictures;
        known = hooks->pictures = loaded;
    }
    image->picture = &known->picture;
    image->by_index = known->by_index;
    load_shares(image, arena);
    hash_add_hash(&image->hash, known->picture.hash);
    return true;
}

/* Pixels become light that is multiplied by alpha, as picture_make() wants it. */
static bool picture_made(void *context, Arena *arena, int columns, int rows, const float (*pixels)[4], ImageMap *image) {
    (void)context;
    Image made;
    if (!image_init(&made, columns, rows, 4, NULL, arena->budget, NULL)) return false;
    for (size_t i = 0; i < (size_t)columns * (size_t)rows; i++)
        for (int c = 0; c < 4; c++) made.pixels[4 * i + (size_t)c] = c < 3 ? pixels[i][c] * pixels[i][3] : pixels[i][3];
    size_t need = (size_t)columns * (size_t)rows * 4 * sizeof(float) * 3 / 2;
    bool room = memory_budget_take(arena->budget, need); /* the arena may not return, and nothing else frees the image */
    if (room) {
        memory_budget_give_back(arena->budget, need);
        Picture *picture = arena_new(arena, Picture);
        picture_make(&made, arena, picture);
        image->picture = picture;
        hash_add_hash(&image->hash, picture->hash);
    }
    image_free(&made);
    return room;
}

static bool density_grid(void *context, Arena *arena, const char *path, const EvalDensityRequest *request, DensityGrid *out, StrBuf *error) {
    (void)context;
    if (request->fractal) return grid_fractal(request->size, request->dimension, request->threshold, request->seed, request->interrupted, arena, out);
    if (request->nanovdb) return nanovdb_load(path, request->grid, arena, out, error);
    GridRaw raw = {.sample = request->bytes == 1 ? GRID_UINT8 : request->bytes == 2 ? GRID_UINT16 : GRID_FLOAT, .big = request->big};
    memcpy(raw.size, request->size, sizeof raw.size);
    return grid_load(path, request->raw ? &raw : NULL, arena, out, error);
}

/* ---- places on the globe ---- */

static GeoPlace place_of(Vec3 v) { return (GeoPlace){v.x, v.y, v.z}; }

static bool sun_answer(const GeoFrame *frame, GeoPlace place, const char *time, Vec3 *answer, StrBuf *error) {
    double days;
    Vec3 there;
    if (!sun_parse_time(time, &days, error)) return false;
    return sun_direction(place, days, &there) && geo_direction_to_scene(frame, place, there, answer);
}

static bool geo_answer(const GeoFrame *frame, const EvalGeoRequest *request, Vec3 *answer, StrBuf *error) {
    GeoPlace place, a = place_of(request->a);
    GeodesicLine line;
    UtmPlace utm;
    switch (request->question) {
    case EVAL_GEO_TO_SCENE: return geo_to_scene(frame, a, answer);
    case EVAL_GEO_FROM_SCENE:
        if (!scene_to_geo(frame, request->a, &place)) return false;
        *answer = vec3(place.latitude, place.longitude, place.height);
        return true;
    case EVAL_GEODESIC:
        if (!geodesic_inverse(a, place_of(request->b), &line)) return false;
        *answer = vec3(line.distance, line.azimuth, line.azimuth_back);
        return true;
    case EVAL_UTM:
        if (!utm_from_geo(a, &utm)) return false;
        *answer = vec3(utm.easting, utm.northing, utm.north ? utm.zone : -utm.zone);
        return true;
    case EVAL_SUN_DIRECTION: return sun_answer(frame, a, request->time, answer, error);
    }
    return false;
}

static bool geo(void *context, const GeoOrigin *origin, const EvalGeoRequest *request, Vec3 *answer, StrBuf *error) {
    GeoFrame frame;
    (void)context;
    if (geo_frame_init(&frame, place_of(origin->place), origin->flat) && geo_answer(&frame, request, answer, error)) return true;
    if (error->size == 0) strbuf_adds(error, "this is no place on the globe");
    return false;
}

static bool picture_place(void *context, Arena *arena, const GeoOrigin *origin, ImageMap *image, StrBuf *error) {
    GeoFrame frame;
    (void)context;
    if (!image->picture || !geo_frame_init(&frame, place_of(origin->place), origin->flat)) return false;
    const PictureLevel *level = &image->picture->levels[0];
    image->place = drape_open(image->path, level->width, level->height, &frame, arena, error);
    if (image->place) hash_add_hash(&image->hash, image->place->hash);
    return image->place != NULL;
}

/* ---- terrains ---- */

static bool map_place(const EvalTerrainPlace *in, HeightmapPlace *out) {
    *out = (HeightmapPlace){.west_south = {in->west_south[0], in->west_south[1]}, .east_north = {in->east_north[0], in->east_north[1]}, .area = in->area};
    if (in->utm) return projection_utm(&out->projection, in->zone, in->north);
    projection_lonlat(&out->projection);
    return true;
}

/* The middle of the map, where its posts have places. */
static bool middle_of(const Heightmap *map, Vec3 *out) {
    const HeightmapExtent *extent = heightmap_extent(map);
    GeoPlace place;
    if (!heightmap_to_geo(map, 0.5 * (extent->columns - 1), 0.5 * (extent->rows - 1), &place)) return false;
    *out = vec3(place.latitude, place.longitude, 0);
    return true;
}

static const Ground *make_ground(const Heightmap *map, EvalTerrainRequest *request, Arena *arena) {
    GeoOrigin *origin = &request->origin;
    GeoFrame frame;
    if (!origin->set && !middle_of(map, &origin->place)) return NULL;
    origin->set = true;
    const GeoPlace at = {origin->place.x, origin->place.y, origin->place.z};
    return geo_frame_init(&frame, at, origin->flat) ? ground_create(map, &frame, request->exaggeration, arena) : NULL;
}

static bool terrain(void *context, Arena *arena, EvalTerrainRequest *request, DiagList *diags, Span span, Terrain *out) {
    (void)context;
    HeightmapPlace place;
    HeightmapOptions options = {.voids = request->holes ? HEIGHTMAP_HOLES : HEIGHTMAP_FILL, .has_nodata = request->has_nodata,
                                .nodata = request->nodata, .geoid = request->geoid};
    bool placed = true;
    if (request->place) {
        placed = map_place(request->place, &place);
        options.place = &place;
    }
    const Heightmap *map = !placed ? NULL : heightmap_open(request->paths, request->count, &options, arena, diags, span);
    const Ground *ground = map ? make_ground(map, request, arena) : NULL;
    if ((map || !placed) && !ground) diag_error(diags, span, "the map has no place in the scene's frame");
    if (!ground) return false;
    *out = (Terrain){.hash = ground_hash(ground), .origin = request->origin.place, .bounds = ground->bounds, .ground = ground, .ops = &ground_ops};
    return true;
}

EvalGeometry hooks_geometry(Arena *arena, TexelCache *texels) {
    Hooks *hooks = arena_new(arena, Hooks);
    *hooks = (Hooks){.tracer = shape_tracer_create(arena), .texels = texels, .memory = arena->budget};
    return (EvalGeometry){
        .context = hooks,
        .trace = trace,
        .inside = inside,
        .extent = extent,
        .pigment_function = pigment_function,
        .pattern_function = pattern_function,
        .texel_file = texel_file,
        .mesh_file = mesh_file,
        .picture_file = picture_file,
        .picture_made = picture_made,
        .picture_place = picture_place,
        .density_grid = density_grid,
        .geo = geo,
        .terrain = terrain,
    };
}
