/* terrain { heightmap "dem.tif" … }: an object whose surface is the ground. */
#include "eval/build_parts.h"

#include <string.h>

enum { MOST_MAPS = 4096 };

typedef struct TerrainDraft {
    ObjectDraft common;
    EvalTerrainRequest request;
    EvalTerrainPlace place;
    const char **paths;
    Span *path_spans;
    size_t count;
    Span maps_span;
    bool curvature, curvature_given;
} TerrainDraft;

/* ---- words ---- */

static void read_heightmap(Reader *reader, const Word *word, void *target) {
    TerrainDraft *draft = target;
    if (!word_arguments(reader, word, 1, MOST_MAPS)) return;
    draft->paths = arena_new_array(reader->context->arena, const char *, word->count);
    draft->path_spans = arena_new_array(reader->context->arena, Span, word->count);
    draft->maps_span = word->whole;
    for (size_t i = 0; i < word->count; i++) {
        if (!word_string(reader, word, i, &draft->paths[i])) return;
        draft->path_spans[i] = word->arguments[i].span;
    }
    draft->count = word->count;
}

static bool read_corners(Reader *reader, const Word *word, EvalTerrainPlace *place) {
    Vec3 low, high;
    if (!word_arguments(reader, word, 2, 2) || !word_vector(reader, word, 0, &low) || !word_vector(reader, word, 1, &high)) return false;
    place->west_south[0] = low.x, place->west_south[1] = low.y;
    place->east_north[0] = high.x, place->east_north[1] = high.y;
    return true;
}

static void read_lonlat(Reader *reader, const Word *word, void *target) {
    EvalTerrainPlace *place = target;
    place->utm = false;
    if (!read_corners(reader, word, place)) return;
    if (!(fabs(place->west_south[1]) <= 90 && fabs(place->east_north[1]) <= 90))
        reader_error(reader, word->whole, "latitudes lie between -90 and 90; 'lonlat' takes <west, south>, <east, north>");
}

static void read_utm(Reader *reader, const Word *word, void *target) {
    EvalTerrainPlace *place = target;
    Word side;
    place->utm = true;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &place->zone)) return;
    if (place->zone < 0 || place->zone > 60) {
        reader_error(reader, word->arguments[0].span, "a zone of UTM is a number from 1 to 60 (0 near the poles), found %d", place->zone);
        place->zone = 0;
    }
    if (!reader_take_word(reader, "north", &side) && !reader_take_word(reader, "south", &side)) {
        reader_expect_word(reader, word, "north or south, and two corners");
        return;
    }
    place->north = strcmp(side.text, "north") == 0;
    read_corners(reader, &side, place);
}

static void read_registration(Reader *reader, const Word *word, void *target) {
    Word kind;
    bool point = word->count == 0 && reader_take_word(reader, "point", &kind);
    ((EvalTerrainPlace *)target)->area = !point;
    if (!point && !reader_take_word(reader, "area", &kind)) reader_expect_word(reader, word, "area or point");
}

static void read_georeference(Reader *reader, const Word *word, void *target) {
    static const WordRule rules[] = {
        {"lonlat", WORD_CUSTOM, 0, read_lonlat, true},
        {"utm", WORD_CUSTOM, 0, read_utm, true},
        {"registration", WORD_CUSTOM, 0, read_registration, true},
    };
    TerrainDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'georeference' needs { lonlat … } or { utm … }");
        return;
    }
    draft->place = (EvalTerrainPlace){.area = true};
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, rules, VTS_ARRAY_COUNT(rules), &draft->place);
    if (reader_run(&body) && (body.met & 3) == 0) reader_error(&body, word->span, "'georeference' needs 'lonlat' or 'utm'");
    if ((body.met & 3) == 3) reader_error(&body, word->span, "'georeference' is 'lonlat' or 'utm', not both");
    reader_end_nested(reader, &body);
    draft->request.place = &draft->place;
}

static void read_origin(Reader *reader, const Word *word, void *target) {
    EvalTerrainRequest *request = &((TerrainDraft *)target)->request;
    Word geo;
    Vec3 at;
    if (word->count || !reader_take_word(reader, "geo", &geo)) {
        reader_expect_word(reader, word, "geo <latitude, longitude, height>");
        return;
    }
    if (!word_arguments(reader, &geo, 1, 1) || !word_vector(reader, &geo, 0, &at)) return;
    if (fabs(at.x) > 90) reader_error(reader, geo.whole, "a latitude lies between -90 and 90, found %g", at.x);
    request->origin = (GeoOrigin){.span = geo.whole, .set = true, .place = at};
}

static void read_nodata(Reader *reader, const Word *word, void *target) {
    EvalTerrainRequest *request = &((TerrainDraft *)target)->request;
    Word mode;
    if (word->count == 0 && reader_take_word(reader, "hole", &mode)) request->holes = true;
    else if (word->count == 0 && reader_take_word(reader, "fill", &mode)) request->holes = false;
    else if (word->count == 0) reader_expect_word(reader, word, "fill, hole or a number");
    else if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, &request->nodata)) request->has_nodata = true;
}

static void read_detail(Reader *reader, const Word *word, void *target) {
    EvalTerrainRequest *request = &((TerrainDraft *)target)->request;
    Word mode;
    request->every_post = word->count == 0 && reader_take_word(reader, "full", &mode);
    if (!request->every_post && (word->count || !reader_take_word(reader, "auto", &mode))) reader_expect_word(reader, word, "auto or full");
}

static void read_geoid(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 1, 1)) word_string(reader, word, 0, &((TerrainDraft *)target)->request.geoid);
}

#define FIELD(name) offsetof(TerrainDraft, name)
enum { CURVATURE = 4 }; /* of the rules */
static const WordRule rules[] = {
    {"heightmap", WORD_CUSTOM, 0, read_heightmap, true},
    {"georeference", WORD_CUSTOM, 0, read_georeference, true},
    {"origin", WORD_CUSTOM, 0, read_origin, true},
    {"exaggeration", WORD_FLOAT, FIELD(request.exaggeration), NULL, true},
    {"curvature", WORD_FLAG, FIELD(curvature), NULL, true},
    {"geoid", WORD_CUSTOM, 0, read_geoid, true},
    {"nodata", WORD_CUSTOM, 0, read_nodata, false}, /* a number, and what becomes of it */
    {"detail", WORD_CUSTOM, 0, read_detail, true},
};

/* ---- building ---- */

/* The scene is round or flat as its first terrain is, or what was asked before it; later ones cannot change that. */
static void choose_curvature(BuildContext *context, TerrainDraft *draft) {
    GeoOrigin *origin = &context->geo_origin;
    const bool flat = draft->curvature_given ? !draft->curvature : context->has_terrain && origin->flat;
    if (origin->set && flat != origin->flat && (context->has_terrain || context->is_geo_asked)) {
        Diagnostic *d = diag_error(context->diags, draft->common.object.span, "this terrain is %s, but the scene's earth is %s already", flat ? "flat" : "round", flat ? "round" : "flat");
        if (context->is_geo_asked) diag_note(context->diags, d, context->geo_asked, "it was asked for here");
        diag_hint(context->diags, d, "'curvature' of the scene's first terrain tells; write that terrain before what asks for places");
    } else if (origin->set) {
        origin->flat = flat;
    }
    draft->curvature = !flat;
}

/* The scene's origin stands, where it has one; else the terrain's own. */
static void choose_origin(BuildContext *context, TerrainDraft *draft) {
    GeoOrigin *origin = &draft->request.origin;
    choose_curvature(context, draft);
    if (context->geo_origin.set) *origin = context->geo_origin;
    origin->flat = !draft->curvature;
    if (!origin->set) origin->span = draft->common.object.span;
    context->has_terrain = true;
}

static bool load(Reader *reader, TerrainDraft *draft) {
    BuildContext *context = reader->context;
    EvalTerrainRequest *request = &draft->request;
    Terrain *terrain = arena_new(context->arena, Terrain);
    Surface *surface = arena_new(context->arena, Surface);
    request->paths = draft->paths;
    request->count = draft->count;
    choose_origin(context, draft);
    const char *name = draft->paths[0];
    if (!terrain_load(context, request, draft->path_spans, draft->maps_span, terrain)) return false;
    if (!context->geo_origin.set && !geo_origin_set(context, &request->origin)) return false;
    terrain->span = reader->block->span;
    terrain->file = name;
    terrain->every_post = request->every_post;
    *surface = (Surface){.span = reader->block->span, .kind = SURFACE_TERRAIN, .terrain = terrain, .transform = transform_identity(),
                         .texture = draft->common.object.texture};
    Vec3 size = vec3_sub(terrain->bounds.max, terrain->bounds.min);
    surface->length_u = size.x, surface->length_v = size.z;
    surface_rehash(surface);
    draft->common.object.as.surface = surface;
    return true;
}

bool build_terrain(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    TerrainDraft draft = {.common = object_begin(block, OBJECT_SURFACE), .curvature = true, .request = {.exaggeration = 1}};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader.on_value = object_on_value;
    reader.value_target = &draft.common;
    if (!object_read(&reader, &draft.common)) return false;
    if (!draft.count) {
        reader_error(&reader, block->word_span, "'terrain' needs a heightmap");
        return false;
    }
    draft.curvature_given = reader.met >> CURVATURE & 1;
    return load(&reader, &draft) && object_make(&reader, &draft.common, out);
}
