/* From syntax tree to scene graph: runs a program of the language. */
#ifndef VTS_EVAL_EVAL_H
#define VTS_EVAL_EVAL_H

#include "base/diag.h"
#include "scene/scene.h"

typedef enum EvalStream { EVAL_STREAM_DEBUG, EVAL_STREAM_WARNING, EVAL_STREAM_RENDER, EVAL_STREAM_STATISTICS } EvalStream;

typedef struct EvalLimits {
    uint64_t loops;          /* passes of one loop: 100 million */
    uint32_t recursion;      /* nested macro calls: 200 */
    uint32_t include_depth;  /* 32 */
    uint64_t steps;          /* passes of all loops and calls of all macros together: 1000 million */
    uint64_t array_elements; /* of all arrays together, their copies counted: 64 million */
    uint64_t string_bytes;   /* 64 MiB */
    uint64_t memory_bytes;   /* taken while the scene is read: 2 GiB */
    uint64_t written_bytes;  /* by #write, to all files together: 256 MiB */
    uint64_t mesh_vertices;  /* of one mesh, grid or field of heights: 64 million */
} EvalLimits;

typedef struct EvalMeshRequest {
    uint64_t most_vertices; /* 0: no limit */
    bool by_color, smooth;
} EvalMeshRequest;

/* A grid of densities: a file (df3, or `raw` as the rest says), or a fractal. */
typedef struct EvalDensityRequest {
    bool raw, fractal, nanovdb;
    const char *grid; /* of a NanoVDB file; NULL: the first */
    const atomic_bool *interrupted; /* polled; may be NULL */
    int size[3];
    int bytes; /* of a number: 1, 2, 4 (a float) */
    bool big;  /* endian */
    double dimension, threshold;
    uint32_t seed;
} EvalDensityRequest;

/* Where a map lies, by the scene's word: the corners of the outer edges of its pixels (area), or its outer posts. */
typedef struct EvalTerrainPlace {
    bool utm; /* else longitude and latitude */
    int zone; /* 1 to 60; 0: polar */
    bool north;
    double west_south[2], east_north[2];
    bool area;
} EvalTerrainPlace;

typedef struct EvalTerrainRequest {
    const char **paths;
    size_t count;
    const EvalTerrainPlace *place; /* NULL: as the files say */
    GeoOrigin origin;              /* of the scene's frame; not set: the middle of the map, height 0 */
    double exaggeration;
    const char *geoid;             /* or NULL */
    bool holes, has_nodata, every_post;
    double nodata;
} EvalTerrainRequest;

typedef struct EvalMeshPart {
    const MeshData *mesh;
    bool colored; /* the file gives it `color` */
    Color color;
} EvalMeshPart;

typedef struct EvalMeshFile {
    const EvalMeshPart *parts;
    size_t count; /* at least 1 */
} EvalMeshFile;

typedef enum EvalGeoQuestion {
    EVAL_GEO_TO_SCENE,   /* a: latitude, longitude (degrees), height */
    EVAL_GEO_FROM_SCENE, /* a: point of the scene */
    EVAL_GEODESIC,       /* a and b: places; answer: distance, azimuth at a, azimuth back at b */
    EVAL_UTM,            /* a: place; answer: easting, northing, zone (negative: south; 0: UPS, near the poles) */
    EVAL_SUN_DIRECTION,  /* a: place; time; answer: unit vector of the scene */
} EvalGeoQuestion;

typedef struct EvalGeoRequest {
    EvalGeoQuestion question;
    Vec3 a, b;
    const char *time; /* ISO 8601 */
} EvalGeoRequest;

/* What the evaluator cannot know by itself, supplied by whoever links the folders that can. */
typedef struct EvalGeometry {
    void *context;
    bool (*trace)(void *context, const Object *object, Vec3 origin, Vec3 direction, Vec3 *hit, Vec3 *normal);
    bool (*inside)(void *context, const Object *object, Vec3 point);
    Box3 (*extent)(void *context, const Object *object); /* min_extent(), max_extent() */
    /* A pigment as a function of place: 3 inputs, 5 outputs. `out` and its data live in `arena`; false: it cannot be one. */
    bool (*pigment_function)(void *context, Arena *arena, const Pigment *pigment, TapeExternal *out);
    /* The texel in a file, in `arena`. False, with a line of text in `error` that says why the file is refused. */
    bool (*texel_file)(void *context, Arena *arena, const char *path, Span span, TexelDef *out, StrBuf *error);
    /* The parts of a file of meshes, in `arena`: one for each colour in it, or (by_color false) one for all; `smooth`: normals where it
     * has none. False, with a line of text in `error` that says why the file is refused. */
    bool (*mesh_file)(void *context, Arena *arena, const char *path, const EvalMeshRequest *request, EvalMeshFile *out, StrBuf *error);
    /* path NULL: a fractal. False with a line of text in `error`. */
    bool (*density_grid)(void *context, Arena *arena, const char *path, const EvalDensityRequest *request, DensityGrid *out, StrBuf *error);
    /* Loads the picture at image->path into `arena`, as image->gamma says, and adds its content to image->hash. False with a line of text in `error`. */
    /* Sets image->place, of a picture that was read; false with a line in `error`. */
    bool (*picture_place)(void *context, Arena *arena, const GeoOrigin *origin, ImageMap *image, StrBuf *error);
    bool (*picture_file)(void *context, Arena *arena, ImageMap *image, StrBuf *error);
    /* The same from colours: rows from the top, red, green, blue and alpha of each pixel, which are not multiplied by alpha. */
    bool (*picture_made)(void *context, Arena *arena, int columns, int rows, const float (*pixels)[4], ImageMap *image);
    /* The ground of maps, in `arena`; sets request->origin. False after a report at `span`. */
    bool (*terrain)(void *context, Arena *arena, EvalTerrainRequest *request, DiagList *diags, Span span, Terrain *out);
    /* A pattern as a function of place: 3 inputs, 1 output; otherwise the same. */
    bool (*pattern_function)(void *context, Arena *arena, const Pigment *pattern, TapeExternal *out);
    /* Geography, with the scene's origin on the globe. False with a line of text in `error`. */
    bool (*geo)(void *context, const GeoOrigin *origin, const EvalGeoRequest *request, Vec3 *answer, StrBuf *error);
} EvalGeometry;

typedef struct EvalOptions {
    const struct NetStates *net_states; /* grow/spring_net.h; NULL: cloths are followed from their beginning */
    const char *const *include_dirs;  /* after the including file's folder and the scene's folder */
    size_t include_dir_count;
    const char *stdlib_dir;           /* last; may be NULL */
    const struct EvalDeclare { const char *name, *value; } *declares; /* numbers become floats, the rest strings */
    size_t declare_count;
    const struct EvalSetting { const char *name, *value; bool *used; } *settings; /* block_setting.h: "volume.rays"; *used is set when a block takes it */
    size_t setting_count;
    double clock;
    bool clock_on;
    double clock_delta, initial_clock, final_clock;
    double time, cycle;               /* of the scene, in seconds */
    bool ends_at_film;                /* only what 'animation' says is wanted: the scene is not read further than to there */
    int frame_number, initial_frame, final_frame;
    int image_width, image_height;
    EvalLimits limits;
    const char *const *allow_read;
    size_t allow_read_count;
    const char *const *allow_write;
    size_t allow_write_count;
    bool is_program;                  /* run for what it prints: no warning of an empty scene */
    bool keep_writes_in_memory;       /* check: #write goes to memory, where #read finds it */
    /* Geometry of objects, for the functions of the language that ask for it; NULL: those functions are errors. `in` is the context
     * below. trace: the first hit of the ray and the unit normal there; false for a miss. */
    const struct EvalGeometry *geometry;
    void (*on_text)(void *context, EvalStream stream, const char *text);
    void *context;
    const atomic_bool *interrupted; /* polled in loops; may be NULL */
    bool expand_always;               /* for tests: every statement takes the road of those that must be expanded first */
    bool print_tokens, print_ast;     /* dump to on_text(STATISTICS) instead of evaluating */
} EvalOptions;

typedef enum EvalStatus { EVAL_OK, EVAL_FAILED /* see diags */, EVAL_NO_FILE /* the scene file itself */, EVAL_INTERRUPTED } EvalStatus;

/* Evaluates the file. `scene_arena` owns the graph; `parse_arena` may be destroyed after the call except that spans refer
 * to `sources`. *scene is set when EVAL_OK. */
EvalStatus eval_file(const char *path, const EvalOptions *options, SourceSet *sources, DiagList *diags, Interner *names,
                     Arena *parse_arena, Arena *scene_arena, const Scene **scene);
EvalLimits eval_limits_default(void);

#endif
