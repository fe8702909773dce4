/* The scene graph: what evaluation leaves behind. Plain, immutable data with spans back into the text; the renderer reads it
 * and never changes it. Everything lives in the scene's arena. Transforms are already applied to what they follow in the
 * text: each node has one transform from its own space to that of its parent (objects in a union: the union's space).
 *
 * Lengths in scene units (metres), angles in degrees, colours linear. Left-handed, y up. */
#ifndef VTS_SCENE_SCENE_H
#define VTS_SCENE_SCENE_H

#include "base/hash.h"
#include "base/intern.h"
#include "base/source.h"
#include "base/strbuf.h"
#include "base/vec.h"
#include "scene/lamp.h"
#include "scene/solids.h"
#include "tape/tape.h"

typedef struct Color {
    double red, green, blue, filter, transmit;
} Color;

/* Something that the text asks for and this version does not draw (an interior, a normal, wind): it is inert, and named in one
 * warning when what holds it is used. */
typedef struct InertNote {
    const char *word;
    Span span;
    const struct InertNote *next;
} InertNote;

/* ---- looks ---- */

typedef enum PatternKind {
    PATTERN_SOLID,    /* no pattern: `color` */
    PATTERN_GRADIENT, /* frac of p · direction */
    PATTERN_CHECKER, PATTERN_BRICK, PATTERN_HEXAGON, /* block patterns: entry by index, not by value */
    PATTERN_BOZO, PATTERN_GRANITE, PATTERN_WRINKLES, PATTERN_AGATE, PATTERN_MARBLE, PATTERN_WOOD, PATTERN_CRACKLE,
    PATTERN_LEOPARD, PATTERN_ONION, PATTERN_RADIAL, PATTERN_SPOTTED, PATTERN_CELLS, PATTERN_BOXED, PATTERN_CYLINDRICAL,
    PATTERN_SPHERICAL, PATTERN_PLANAR, PATTERN_SLOPE,
    PATTERN_FUNCTION, /* value = tape(x, y, z) */
    PATTERN_CUBIC, PATTERN_SQUARE, PATTERN_TRIANGULAR, /* block patterns too */
    PATTERN_OBJECT,   /* block pattern: the function tells outside (0) from inside (1) */
    PATTERN_DENTS, PATTERN_QUILTED, PATTERN_RIPPLES, PATTERN_WAVES, PATTERN_SPIRAL1, PATTERN_SPIRAL2,
    PATTERN_MANDEL, PATTERN_JULIA, PATTERN_MAGNET_MANDEL, PATTERN_MAGNET_JULIA,
    PATTERN_PIGMENT,  /* the grey of a pigment */
    PATTERN_AVERAGE,  /* no value: all entries, weighted by their positions */
    PATTERN_DENSITY,  /* a grid of numbers in the unit cube */
    PATTERN_TILING,
    PATTERN_IMAGE_MAP, /* no value: the colours of `image` */
    PATTERN_IMAGE,     /* its grey */
    PATTERN_UV,        /* no value: its one entry, seen in the plane of the surface's u and v */
    PATTERN_MATERIAL,  /* entry by the index, or else the red, of `image` */
    PATTERN_AOI,       /* angle between the ray and the surface */
    PATTERN_PAVEMENT,
} PatternKind;

/* What becomes of a pattern's value, frequency and phase applied. */
typedef enum WaveKind { WAVE_OWN /* the pattern's */, WAVE_RAMP, WAVE_TRIANGLE, WAVE_SINE, WAVE_SCALLOP, WAVE_CUBIC, WAVE_POLY } WaveKind;

/* A change of place before the pattern looks at it. */
typedef enum WarpKind {
    WARP_TURBULENCE, WARP_REPEAT, WARP_BLACK_HOLE, WARP_CYLINDRICAL, WARP_SPHERICAL, WARP_TOROIDAL, WARP_PLANAR, WARP_CUBIC
} WarpKind;

typedef struct Warp {
    WarpKind kind;
    Transform inner;    /* from what the pattern, or the warp before this one, sees to what this warp gives */
    Vec3 turbulence;    /* amount; and of repeat: the offset */
    int octaves;
    double lambda, omega;
    int axis;           /* repeat: 0, 1, 2 */
    double width;
    Vec3 flip;          /* factors 1 or -1 */
    Vec3 center;        /* black hole */
    double radius, strength, falloff;
    bool inverse, repeated;
    Vec3 repeat, uncertainty; /* uncertainty: `turbulence` of the black hole */
    Vec3 orientation;   /* mappings; z */
    double exponent;    /* dist_exp; of planar: the distance */
    double major_radius;
} Warp;

/* `exterior` and `interior` of fractals: how the number comes about, and its factor. */
typedef struct FractalSettings {
    double re, im;      /* julia's constant */
    int iterations, exponent, magnet;
    int exterior, interior;
    double exterior_factor, interior_factor;
} FractalSettings;

typedef struct CrackleSettings {
    Vec3 form;          /* weights of the distances to the nearest three points; <-1, 1, 0> */
    double metric, offset; /* 2, 0 */
    bool solid;
} CrackleSettings;

enum { PAVEMENT_MOST_TILES = 6 };

/* pavement: POV-Ray's numbers; `pattern` from 1 to pavement_count(). Looks: 0 sharp, 1 bevelled, 2 round; form 3: squares' corners each by itself. */
typedef struct PavementSettings {
    int sides, tiles, pattern; /* 3, 1, 1 */
    int exterior, interior, form;
} PavementSettings;

/* How many pieces of so many triangles, squares or hexagons there are; 0: those sides and tiles make no pavement. */
int pavement_count(int sides, int tiles);

/* Numbers in [0, 1] at the cells of the unit cube, x fastest. */
typedef struct DensityGrid {
    Hash128 hash;
    int size[3];
    const float *values;
    bool placed;  /* the file says where it lies: */
    Affine place; /* the unit cube → there */
    size_t bad; /* 1 + the index of the first number of the file that is negative or none, and counts as 0; 0: there is no such */
} DensityGrid;

/* A picture in the unit square of pattern space, or wrapped about the origin. */
/* Where a picture lies that was taken of the ground. */
typedef struct PicturePlace PicturePlace;
struct PicturePlace {
    Hash128 hash;
    /* What the picture has at a point of the scene: u from its left to its right, v from its lower to its upper rim, 0 to 1; beyond them
     * outside. False where no such place is. Thread-safe. */
    bool (*find)(const PicturePlace *place, Vec3 p, double *u, double *v);
};

typedef struct ImageMap {
    Span span;
    Hash128 hash;
    const char *path;             /* of the file */
    const char *format;           /* POV-Ray's word for it, "png"; NULL: as the file's name and content tell */
    int map_type;                 /* 0 planar, 1 spherical, 2 cylindrical, 5 toroidal, 7 angular */
    int interpolate;              /* 0 nearest, 2 bilinear, 3 bicubic, 4 normalized distance */
    bool once;                    /* not repeated */
    bool use_alpha;               /* of a pattern: alpha counts, not grey */
    bool use_index;               /* of a bump_map, and always of a material_map: the number in the palette counts, not its colour */
    bool by_index;                /* the picture's colours are those numbers, over 255 */
    bool premultiplied, straight; /* alpha, if the text says so */
    double gamma;                 /* of the file; 0: the format's own; -1: sRGB */
    double assumed_gamma;         /* what light becomes in the scene's numbers (base/gamma.h) */
    double filter_all, transmit_all;
    double bump_size;             /* of a bump_map; 0: not given */
    const struct Picture *picture; /* image/picture.h; NULL: not drawn */
    bool georeferenced;
    const PicturePlace *place;    /* of what is georeferenced; else NULL */
    const struct Picture *shares; /* the same pixels: what their numbers in the palette filter (red) and transmit (green); or NULL */
    const double *palette_filter; /* triples: index, filter, transmit */
    size_t palette_count;
} ImageMap;

typedef struct Pigment Pigment;

typedef struct ColorMapEntry {
    double position;
    Color color;
    const Pigment *pigment; /* of a pigment_map (or block pattern with pigments); else NULL and `color` counts */
} ColorMapEntry;

enum { TILING_MOST = 24 }; /* those after it are read, and have the middle of the map everywhere */
enum { PIGMENT_DEEPEST = 100 }; /* pigments within maps and functions of each other: whoever evaluates one may call itself that often */
#define PIGMENT_MOST_WORK 1e8   /* steps of one evaluation */
struct Pigment {
    Span span;
    Hash128 hash;
    int depth;                       /* pigments within each other, this one included */
    double work;                     /* an estimate from above of one evaluation, in steps: pigments and operations of functions */
    PatternKind kind;
    Color color;                     /* PATTERN_SOLID */
    Vec3 direction;                  /* gradient, slope */
    const Tape *function;            /* PATTERN_FUNCTION */
    const ColorMapEntry *entries;    /* sorted by position; for block patterns the colours in order; NULL: the pattern's own */
    size_t entry_count;
    double frequency, phase;         /* 1, 0 */
    Vec3 turbulence;                 /* 0: none */
    int octaves;                     /* 6 */
    double lambda, omega;            /* 2, 0.5 */
    Color quick_color;
    Vec3 brick_size;                 /* <8, 3, 4.5> */
    double mortar;                   /* 0.5 */
    WaveKind wave;
    double wave_exponent;            /* poly_wave; 1 */
    int noise_generator;             /* 1, 2, 3; 0: 2 */
    const Warp *warps;               /* in the order of the text: a place goes through the last first */
    size_t warp_count;
    FractalSettings fractal;
    CrackleSettings crackle;
    PavementSettings pavement;
    double agate_turbulence;         /* 1 */
    double control0, control1;       /* quilted: 1, 1 */
    int number;                      /* arms of a spiral, kind of a tiling */
    int wave_count;                  /* ripples, waves: 10 */
    double slope_low, slope_high;    /* slope: low = high: all of [0, 1] */
    bool points_at;                  /* slope: `direction` is a place, and the way to it counts */
    Vec3 altitude;                   /* slope: 0: without; else its length is the altitude's share, `direction`'s the slope's */
    double altitude_low, altitude_high;
    const Pigment *source;           /* PATTERN_PIGMENT */
    const DensityGrid *density;      /* PATTERN_DENSITY */
    int interpolation;               /* density: 0, 1 linear, 2 cubic */
    const ImageMap *image;           /* PATTERN_IMAGE_MAP, PATTERN_IMAGE; of others: not drawn, or NULL */
    const struct EvalBlock *text;    /* the evaluator's: its text, which changes the pigment of a declared texture; or NULL */
    const InertNote *inert;
    Transform transform;             /* pattern space → space of the textured object */
};

typedef struct Finish {
    Hash128 hash;
    Color ambient, emission;
    double diffuse, transmission;    /* second number of `diffuse a, b`: light from behind (leaves) */
    double brilliance;               /* 1 */
    double specular, roughness;      /* roughness 0.05 */
    double phong, phong_size;        /* 40 */
    double metallic;                 /* 0 */
    Color reflection_min, reflection_max;
    bool fresnel;
    double reflection_falloff, reflection_exponent, reflection_metallic; /* 1, 1, 0 */
    bool diffuse_albedo, specular_albedo, phong_albedo; /* the amount is what all of the lobe sends back */
    bool conserve_energy;
    double crand;                    /* 0 */
    double irid, irid_thickness, irid_turbulence; /* 0: none */
} Finish;

/* medium.h */
typedef struct Medium Medium;
typedef struct MediaList {
    const Medium *items; /* whose densities are told apart and effects added */
    size_t count;
} MediaList;

/* What is inside of an object. */
typedef struct Interior {
    Span span;
    Hash128 hash;
    double ior;                      /* 1 */
    double caustics;                 /* 0: shadows have none */
    double dispersion;               /* ior of violet over that of red; 1 */
    int dispersion_samples;          /* 7 */
    double fade_distance, fade_power; /* 0, 0: light is not taken away; power >= 1000: exponentially */
    Color fade_color;                /* black */
    MediaList media;                 /* in the space of the object that has the interior; of hollow ones alone they are seen */
    const InertNote *inert;
} Interior;

/* How a bump comes about. All but the last have vector fields of their own. */
typedef enum NormalForm {
    NORMAL_GRADIENT, /* the slope of the pattern's value */
    NORMAL_BUMPS, NORMAL_DENTS, NORMAL_RIPPLES, NORMAL_WAVES, NORMAL_WRINKLES, NORMAL_QUILTED, NORMAL_FACETS,
    NORMAL_PICTURE,  /* bump_map: of the pattern's image */
    NORMAL_MAP       /* several normals, blended by the pattern */
} NormalForm;

typedef struct SlopeEntry {
    double position, height, slope;
} SlopeEntry;

typedef struct Normal Normal;
struct Normal {
    Span span;
    Hash128 hash;
    NormalForm form;
    int depth;                     /* normals within each other, this one included; at most PIGMENT_DEEPEST */
    double work;                   /* as a pigment's */
    const Pigment *pattern;        /* never NULL: settings, warps and transform; of NORMAL_MAP, entries with positions alone */
    double amount;                 /* bump_size; 0.5 */
    double accuracy;               /* how far from each other values are compared; 0.02 */
    bool unscaled;                 /* no_bump_scale */
    double facet_coords;           /* of facets: how far they are turned; 0: they are those of a sphere, `facet_size` */
    double facet_size;
    const Normal *const *normals;  /* of NORMAL_MAP, one for each entry of the pattern */
    size_t normal_count;
    const SlopeEntry *slopes;      /* slope_map, sorted; NULL */
    size_t slope_count;
};

enum { TEXTURE_MOST_LAYERS = 1000 };
typedef struct Texture Texture;

/* texture_map and its like: a pattern chooses among whole textures, which stand in its space, turbulence included. */
typedef struct TextureMap {
    const Pigment *pattern; /* its entries have positions alone: entry i is that of textures[i] */
    const Texture *const *textures;
    size_t count; /* at least 1 */
    int depth;    /* maps within each other, this one included; at most PIGMENT_DEEPEST */
    double work;  /* as a pigment's */
} TextureMap;

struct LightGroup;
struct Texture {
    Span span;
    Hash128 hash;
    const Pigment *pigment; /* never NULL; of a map: the first texture's */
    const Finish *finish;   /* never NULL; the same */
    Transform transform;    /* texture space → object space */
    const Texture *under;   /* the layer below, seen through this one's filter and transmit; or NULL */
    const InertNote *inert;
    const Normal *normal;   /* or NULL */
    const TextureMap *map;  /* NULL: plain */
    const struct LightGroup *group; /* whose lights alone shine on it; NULL: all lights that belong to none */
};

/* ---- objects ---- */

typedef enum ObjectKind {
    OBJECT_SPHERE, OBJECT_BOX, OBJECT_CYLINDER, OBJECT_CONE, OBJECT_PLANE, OBJECT_DISC, OBJECT_TORUS,
    OBJECT_TRIANGLES, /* triangle, smooth_triangle, mesh, mesh2 */
    OBJECT_UNION,     /* children; also merge until CSG is complete */
    OBJECT_INTERSECTION, OBJECT_DIFFERENCE, OBJECT_MERGE,
    OBJECT_PARTICLES, /* blades, hairs: swept trajectories */
    OBJECT_BRANCHES,  /* of an L-system: chains of frusta */
    OBJECT_SURFACE,   /* the surface of a skin drawn itself */
    OBJECT_SOLID,     /* the rarer shapes: solids.h */
    OBJECT_TEXEL,     /* a texel placed once, without a surface */
    OBJECT_VOLUME,    /* a cloud: matter that scatters light, without a surface; volumes.h */
    OBJECT_UNMODELLED /* parses, is inert: `word` names it */
} ObjectKind;

typedef struct MeshData {
    Hash128 hash;
    bool single; /* a triangle or smooth_triangle */
    const Vec3 *vertices;
    size_t vertex_count;
    const Vec3 *normals;                    /* per index of normal_triangles; NULL: flat */
    size_t normal_count;
    const Vec3 *uvs;                        /* z unused; NULL: none */
    size_t uv_count;
    bool uvs_from_above;                    /* without uvs: they are x and z of the vertices */
    const uint32_t (*triangles)[3];
    size_t triangle_count;
    const uint32_t (*normal_triangles)[3];  /* NULL: same as triangles */
    const uint32_t (*uv_triangles)[3];      /* NULL: same as triangles */
    const struct Texture *const *textures;  /* texture_list */
    size_t texture_count;
    const uint32_t *triangle_textures;      /* index into textures for each triangle; NULL: the object's texture */
    const uint32_t (*corner_textures)[3];   /* the same for each corner, between which they blend; NULL: one for each triangle */
    Vec3 inside_vector;                     /* counts triangles along it to tell the inside; zero: none */
    const Vec3 *height_vectors;             /* per vertex; NULL: unit normals */
    const Vec3 *w_vectors;                  /* per vertex <w0, w1, 0>; NULL: the mapping's */
} MeshData;

typedef enum BladeProfile { BLADE_V, BLADE_ROUND, BLADE_FLAT } BladeProfile;

/* One trajectory: p(t) = position + velocity·t + acceleration·t²/2 for t in [0, life]. */
typedef struct Particle {
    Vec3 position, velocity, acceleration;
    double life;
    double width_foot, width_tip;
    BladeProfile profile;
    double twist; /* degrees from foot to tip */
} Particle;

/* A place on a branch, `radius` thick; a frustum joins it to the one before. Each is `previous` of one other at most, which stands later. */
typedef struct BranchNode {
    Vec3 position;
    double radius;
    uint32_t previous; /* BRANCH_FIRST: the branch begins here */
} BranchNode;
#define BRANCH_FIRST UINT32_MAX

/* What an L-system has grown: its word, and the objects made of it. */
typedef struct Plant {
    const char *letters;     /* of the word, each with parameters first[i] to first[i + 1] */
    const uint32_t *first;
    const double *parameters;
    size_t count;
    const Object *branches, *symbols; /* unions; what `parts` takes */
    const char *symbol_letters;       /* of each object in `symbols`, what it stands for; polygons: { */
} Plant;

typedef struct Surface Surface;
typedef struct TexelDef TexelDef;
typedef struct Volume Volume;
typedef struct Light Light;

typedef struct ObjectList {
    const Object *const *items;
    size_t count;
} ObjectList;

/* What a union and its like hold; shared by all copies. */
typedef struct ObjectGroup {
    const Object *const *items;
    size_t count;
    /* Copied to Scene.lights, transformed; here they only remember where they came from. */
    const Light *const *lights;
    size_t light_count;
    const Plant *plant; /* of the union that an L-system is; else NULL */
    bool light_group, global_lights; /* light_group { … } */
    /* Kept by scene_hash.c once they were asked for. */
    Hash128 shape_hash, hash;
    bool hashed;
    int unhashed_depth; /* groups within each other that are not hashed yet, this one included */
    bool plain;         /* it is known that there are neither lights nor texels in it, however deep */
} ObjectGroup;

/* What few objects have. */
typedef struct ObjectRest {
    ObjectList clipped_by, bounded_by; /* in object space */
    const Interior *interior;         /* NULL: that of what the object is part of */
    const Texture *interior_texture;  /* of surfaces seen from their inside; NULL: as outside */
    const InertNote *inert;
    bool hollow;
} ObjectRest;

enum { OBJECT_DEEPEST = 1000 }; /* whoever walks a tree of objects may call itself that often */

/* There may be millions of them, most of which are copies that differ in their place alone: what is rare or shared is behind pointers, and
 * objects in the scene's arena end behind the member of `as` that their kind uses (object_keep() makes them). So objects are not assigned
 * to each other, but copied with object_copy(). */
struct Object {
    Span span;
    uint8_t kind; /* ObjectKind */
    bool no_shadow : 1, no_image : 1, inverse : 1, no_reflection : 1, no_radiosity : 1, double_illuminate : 1;
    bool cutaway : 1; /* surfaces in it without a texture have those of what holds the place */
    uint16_t depth; /* objects within each other, this one included; at most OBJECT_DEEPEST */
    const Affine *place;    /* object space → parent's space; NULL: the same */
    const Texture *texture; /* NULL: the parent's, at last the default */
    const ObjectRest *rest; /* or NULL */
    union {
        struct { Vec3 center; double radius; double strength; /* in a blob */ } sphere;
        struct { Vec3 corner1, corner2; } box;
        struct { Vec3 base, cap; double base_radius, cap_radius; bool open; double strength; } cone; /* OBJECT_CYLINDER too */
        struct { Vec3 normal; double distance; } plane;                            /* p · normal = distance, unit normal */
        struct { Vec3 center, normal; double radius, hole_radius; } disc;
        struct { double major_radius, minor_radius; } torus;
        const MeshData *mesh;
        const Solid *solid;
        const ObjectGroup *group; /* of OBJECT_UNION, INTERSECTION, DIFFERENCE, MERGE */
        struct { const Particle *items; size_t count; } particles;
        struct { const BranchNode *items; size_t count; } branches;
        const Surface *surface;
        const TexelDef *texel;
        const Volume *volume;
        const char *word; /* of OBJECT_UNMODELLED */
    } as;
};

/* ---- scene_object.c ---- */

bool object_has_group(const Object *object);
/* The parts of a blob, *count of them, where some have textures of their own; else NULL. */
const BlobPart *object_textured_parts(const Object *object, size_t *count);
/* Object space → parent's space, with its inverse. */
Transform object_transform(const Object *object);
/* The keyword that makes such objects. */
const char *object_word(const Object *object);
/* Empty lists where there are none. */
ObjectList object_clipped_by(const Object *object);
ObjectList object_bounded_by(const Object *object);
const InertNote *object_inert(const Object *object);
/* The object as a whole struct, to be changed. */
Object object_copy(const Object *object);
/* Sets depth and work from the parts of the pigment. */
void pigment_measure(Pigment *pigment);
/* How deep an object is whose parts (of its group, what clips and bounds it, its surface, texel, container) are already there. */
int object_depth_by_parts(const Object *object);
/* Puts an object into the arena; its `place` becomes a copy of `transform` (NULL: as it is). */
const Object *object_keep(Arena *arena, const Object *object, const Transform *transform);

/* ---- volumetric textures ---- */

/* Matter as numbers of place: `value` below `low` is nothing, from `high` on 1. Where it is 1, a ray of the length of the bounds' longest
 * side meets matter of the optical depth `extinction`. */
typedef struct DensityField {
    Span span;
    Hash128 hash;
    const Pigment *pattern;       /* its value, before frequency and colours; PATTERN_DENSITY: between the centres of cells */
    bool in_bounds;               /* pattern space is the texel's bounds as the unit cube; else the scene's */
    double low, high, extinction; /* 0, 1, 64 */
    bool has_threshold;           /* low and high were given: of volumes, whose densities have no upper end else */
    const char *unmodelled;       /* a word that makes it inert, or NULL */
} DensityField;

typedef struct TexelLayer {
    Span span;
    Hash128 hash;                 /* of the contents' geometry alone, without colours */
    const Object *const *contents;
    size_t content_count;
    const DensityField *density;  /* instead of contents; or NULL */
    const Texture *texture;       /* NULL: the default texture */
} TexelLayer;

struct TexelDef {
    Span span;
    Hash128 hash;
    const char *name;             /* as declared, else "texel" */
    Box3 bounds;                  /* box of scene space that becomes the reference volume */
    int resolution;               /* along the longest axis; 0 = auto */
    unsigned cyclic;              /* bit 0 x, 1 y, 2 z */
    const TexelLayer *layers;
    size_t layer_count;
    const TexelDef *const *choices; /* texel { choose A, B } : then no layers of its own */
    size_t choice_count;
    const char *file;             /* texel { "forest.vtx" }: its path; the layers then have looks and no contents; else NULL */
    Hash128 file_content;
    int phase, phase_count;       /* whose layers these are, from 0; count 0: it has none */
    const InertNote *inert;
};

/* A landscape from maps of heights. Its points stand in the scene's frame, or in that of the object that it is. */
typedef struct Terrain {
    Span span;
    Hash128 hash;
    const char *file;       /* of its first map */
    bool every_post;        /* drawn with all of its posts, not as many as the view needs */
    Vec3 origin;            /* latitude, longitude and height of the frame's origin */
    Box3 bounds;
    const struct Ground *ground; /* terrain/ground.h */
    const struct TerrainOps *ops;
} Terrain;

/* What others ask of a ground; thread-safe. */
typedef struct TerrainOps {
    /* The y of the ground over or under p; false outside of the map and in a hole. */
    bool (*height)(const struct Ground *ground, Vec3 p, double *y);
    /* The first crossing of the ray with t_min < t < t_max, from above or below; t in lengths of its direction. */
    bool (*meet)(const struct Ground *ground, const Ray *ray, double t_min, double t_max, double *t);
    /* The unit normal, upwards, of the ground at a point of it. */
    Vec3 (*normal)(const struct Ground *ground, Vec3 p);
    /* All of the ground as triangles, nowhere further than `tolerance` from it. False where these would be more than `most`. */
    bool (*mesh)(const struct Ground *ground, double tolerance, size_t most_vertices, Arena *arena, MeshData *out);
} TerrainOps;

typedef enum SurfaceKind { SURFACE_PATCHES, SURFACE_OBJECT, SURFACE_TERRAIN } SurfaceKind;
typedef enum SurfaceUv { SURFACE_UV_MESH, SURFACE_UV_PLANAR, SURFACE_UV_CYLINDRICAL, SURFACE_UV_SPHERICAL } SurfaceUv;

struct Surface {
    Span span;
    Hash128 hash;
    SurfaceKind kind;
    /* SURFACE_PATCHES: (nu + 1) × (nv + 1) vertices of bilinear patches, index i·(nv + 1) + j, u = i/nu, v = j/nv */
    int nu, nv;
    const Vec3 *points;
    const Vec3 *height_vectors;    /* NULL: unit normals */
    /* SURFACE_OBJECT */
    const Object *object;
    SurfaceUv uv;
    Vec3 uv_axis;                  /* planar: the axis looked along; cylindrical: the cylinder's */
    int subdivide;                 /* 0 = auto */
    const Tape *deform;            /* (x, y, z) → 3 outputs; NULL: none */
    const Vec3 *object_height_vectors; /* one for each vertex of an OBJECT_TRIANGLES mesh; NULL */
    const Terrain *terrain;        /* SURFACE_TERRAIN */
    /* > 0: (u, v) are lengths, the surface reaches so far along them; else they go from 0 to 1 */
    double length_u, length_v;
    const Texture *texture;        /* NULL: default */
    const InertNote *inert;
    Transform transform;           /* surface space → scene; an object { SURFACE transform } folds into the object's own */
};

typedef struct SkinTexel {
    Span span;
    const TexelDef *texel;
    const Texture *texture;        /* over the layers' own; NULL: theirs */
    double density;                /* share of the tiles that hold a copy; 1 */
} SkinTexel;

typedef struct SkinMapping {
    bool by_tile_size;             /* `tile s`: tile_size counts; else `repeat` */
    double repeat_u, repeat_v;     /* texels along u and v of the surface; 1 */
    double tile_size;              /* scene units */
    double height;                 /* length of the height vectors, multiplies their own length for explicit ones; 1 */
    const Tape *height_function;   /* (x, y, z) → 1; NULL */
    const Pigment *height_pigment; /* its grey multiplies; NULL */
    Vec3 comb;                     /* added to the unit normal before the length is applied */
    const Tape *comb_function;     /* (x, y, z) → 3; NULL */
    double w_foot, w_tip;          /* 0, 1 */
    const Tape *w_function;        /* (x, y, z) → 3 outputs <w0, w1, 0>; NULL */
} SkinMapping;

typedef struct NoiseJitter {
    double amplitude; /* 0: none */
    double scale;     /* wavelength in scene units; 1 */
} NoiseJitter;

typedef struct InstanceJitter {
    bool present;
    double displace;      /* tiles, ± half */
    double rotate;        /* degrees about the height vector, ± half */
    double scale;         /* relative, ± half */
    bool mirror, turned;  /* turned: `rotate` was given */
    double density;       /* share of the tiles that keep their copy; 1 */
    bool tinted;
    Color tint_a, tint_b; /* filters; each copy gets one between */
} InstanceJitter;

typedef struct SkinJitter {
    NoiseJitter coordinates; /* shift of (u, v) in tiles */
    NoiseJitter height;      /* relative change of length */
    NoiseJitter direction;   /* sideways, relative to the length */
    InstanceJitter instance;
    uint32_t seed;
} SkinJitter;

/* See grow/wind.h for the formula. */
typedef struct WindField {
    Span span;
    Hash128 hash;
    Vec3 direction;              /* unit */
    double speed, strength;      /* scene units a second; 1 */
    double gust_wavelength, gust_amplitude, gust_sharpness;
    double gust_mean; /* added to gusts: what is left of those that wind_smooth() took */
    double turbulence_amplitude, turbulence_scale;
    int turbulence_octaves;
    uint32_t turbulence_seed;
    double stiffness;            /* of what is blown at; 1 */
    double cycle;                /* seconds after which gusts and turbulence come again; 0: never */
    const Tape *function;        /* (x, y, z, t) → 3; NULL */
} WindField;

/* Hold the tips of height vectors while the wind blows: grow/tips.h. */
typedef struct SkinSprings {
    bool present;
    double stiffness, damping; /* > 0, >= 0 */
} SkinSprings;

typedef struct Skin {
    Span span;
    Hash128 hash;
    const Surface *surface;
    const SkinTexel *texels;
    size_t texel_count;
    SkinMapping mapping;
    SkinJitter jitter;
    const WindField *wind;  /* bends the height vectors; NULL */
    SkinSprings springs;
    bool wang;              /* tiling: cyclic texels are laid without period; else side by side */
    const Texture *texture; /* over the layers' own; NULL */
    const InertNote *inert;
} Skin;

/* ---- the scene ---- */

typedef enum CameraKind {
    CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC, CAMERA_FISHEYE, CAMERA_ULTRA_WIDE, CAMERA_OMNIMAX, CAMERA_PANORAMIC, CAMERA_SPHERICAL,
    CAMERA_CYLINDER_1, CAMERA_CYLINDER_2, CAMERA_CYLINDER_3, CAMERA_CYLINDER_4, CAMERA_MESH
} CameraKind;

/* mesh_camera: a ray along the normal of each triangle. */
typedef struct CameraMesh {
    const MeshData *mesh;
    Transform place; /* → scene */
} CameraMesh;

typedef enum MeshSpread {
    MESH_SPREAD_RAYS,  /* triangle n is pixel n's; each of a pixel's rays has a mesh of its own */
    MESH_SPREAD_SUM,   /* the same of all meshes in a row, a picture's pixels for each ray */
    MESH_SPREAD_ASIDE, /* as the first, the meshes' pictures side by side */
    MESH_SPREAD_UV     /* the picture is the plane of the first mesh's u and v */
} MeshSpread;

typedef struct MeshCamera {
    int rays; /* a pixel; 1 of the last two */
    MeshSpread spread;
    bool smooth;    /* of MESH_SPREAD_UV: along interpolated normals */
    const CameraMesh *meshes;
    size_t mesh_count;
    double ahead;   /* so far along its normal before the triangle rays begin */
    bool backwards; /* they go against the normal */
} MeshCamera;

/* As POV-Ray's after `look_at`, `angle` and transforms are applied: a ray of image position (s, t), both in [-1/2, 1/2] from
 * left to right and from bottom to top, starts at `location` (orthographic: + s·right + t·up) along
 * direction + s·right + t·up (orthographic: direction). Of the other kinds see render/view.h. */
typedef struct Camera {
    Span span;
    CameraKind kind;
    Vec3 location, direction, right, up;
    double angle, angle_v;        /* degrees, of the kinds that are not flat: across, and of CAMERA_SPHERICAL upwards */
    double aperture;              /* of the lens: four times its radius; 0: a point */
    double focal_distance;        /* 0: none */
    int least_blur_samples, most_blur_samples; /* 0: not given */
    const MeshCamera *mesh;       /* CAMERA_MESH; else NULL */
    const Normal *normal;         /* bends lines of sight, at the image position <s, t, 0>; or NULL */
    double confidence, variance;  /* when blur is smooth enough; 0: not given */
    const InertNote *inert;
} Camera;

typedef enum LightKind { LIGHT_POINT, LIGHT_PARALLEL, LIGHT_SPOT, LIGHT_CYLINDER } LightKind;

/* light_group { … }: its lights shine on what stands in it alone, and others on that only with `global_lights`. */
typedef struct LightGroup {
    const struct LightGroup *outer; /* the group around it, or NULL */
    uint32_t number;                /* in the scene, from 1 */
    bool global_lights;
} LightGroup;

struct Light {
    Span span;
    LightKind kind;
    Vec3 location;
    Vec3 to_light;        /* unit vector from point_at towards the light */
    bool parallel;        /* of spots and cylinders: its rays are; see light_is_parallel() */
    Color color;
    bool shadowless;
    double fade_distance, fade_power; /* 0: no fading */
    Vec3 point_at;
    double radius, falloff, tightness; /* spot, degrees; 30, 45, 0; cylinder: lengths */
    Vec3 axis_u, axis_v;   /* area_light: its sides */
    int size_u, size_v;    /* rows of lights along both; 0: no area */
    bool jitter, circular, orient;
    bool area_illumination; /* shading, too, is that by all of the area, not by its middle alone */
    const Object *looks_like, *projected_through; /* in the scene; or NULL */
    const LightGroup *group; /* shines on nothing else; NULL: on all */
    bool aimed;              /* point_at was given */
    const Tape *goniometric; /* (angle to the way from its place to point_at, radians) → factor of its colour, and what does not count; NULL: 1 */
    const LampTable *lamp;   /* a further factor, of what leaves its place along -to_light at height 0; NULL: 1 */
    Vec3 lamp_turns[2];      /* unit vectors across that, where it turns by 0 and by 90 degrees */
    bool unscattered;        /* media do not scatter it */
    bool through_air;        /* media that are nowhere in particular weaken it */
};

enum { LIGHT_GONIOMETRIC_OUTPUTS = 5 }; /* at most */
static inline bool light_is_parallel(const Light *light) { return light->kind == LIGHT_PARALLEL || light->parallel; }

typedef struct Fog {
    Span span;
    double distance;
    Color color;         /* filter: the share of what passes that it tints; transmit: the least that passes */
    bool ground;         /* fog_type 2: thins out upwards from `offset` on; half as dense `altitude` higher */
    double offset, altitude;
    Vec3 up;             /* unit */
    const Pigment *turbulence; /* whose turbulence thins it; NULL: none */
    double turbulence_depth;   /* how much; 0.5 */
    const InertNote *inert;
} Fog;

typedef struct Rainbow {
    Span span;
    Vec3 direction, right, up; /* unit: to the middle of the bow, and across it */
    double angle, width;       /* degrees: between the bow's middle and `direction`, and across the bow */
    double distance;           /* after which 1 - 1/e of the bow stands before what is seen */
    double jitter;             /* degrees */
    double arc, falloff;       /* degrees on both sides of `up`: to where it reaches, and is full; arc < 0: all around */
    const Pigment *colors;     /* from the inner rim, x = 0, to the outer, x = 1 */
} Rainbow;

/* The scene's place on the globe: x is east, y up, z north there. */
typedef struct GeoOrigin {
    Span span;
    bool set;
    bool flat;  /* places lie on the map that keeps distances and directions from the origin, heights straight up; else on the round earth */
    Vec3 place; /* latitude, longitude (degrees), height above the ellipsoid WGS84 */
} GeoOrigin;

/* Light that surfaces send each other. */
typedef struct Radiosity {
    bool on;
    bool bumps;             /* by perturbed normals */
    bool media;             /* and fogs are before what sends it */
    bool with_ambient;      /* #version is below 3.7: finishes' ambient light is there, too */
    double brightness, gray_threshold; /* 1, 0 */
    double max_sample;      /* the most that comes from one direction; 0: any */
    int bounces;            /* recursion_limit; 2 */
} Radiosity;

typedef struct GlobalSettings {
    double max_error;      /* 0: not given */
    Color ambient_light;   /* 1 */
    double assumed_gamma;  /* 1: colours are light; else light to the power of 1 through it, or GAMMA_SRGB */
    int max_trace_level;   /* 5 */
    double adc_bailout;    /* 1/255: what would add less is not traced */
    Vec3 irid_wavelength;  /* of red, green and blue; 0.70, 0.52, 0.48 */
    int samples;           /* 0: by max_error */
    double shadow_aperture;/* 2: shadow cones are this much wider (Neyret 1998 sec. IV-B) */
    const char *opacity_model; /* NULL: correlated */
    const char *quadrature;    /* NULL: ring8 */
    const char *ray_path;      /* NULL: box */
    const char *filtering;     /* NULL: linear */
    const char *detail;        /* NULL: auto */
    bool sky_light;            /* ambient light comes from the sky that a place sees */
    Radiosity radiosity;
    GeoOrigin geo_origin;      /* geo_origin, else the first terrain's */
} GlobalSettings;

/* A texel that a name stands for when the scene's text ends: "Grass", "Trees[2]". */
typedef struct NamedTexel {
    const char *name;
    const TexelDef *texel;
} NamedTexel;

enum { FILM_MOST_FRAMES = 1000000000 };

/* What animation { … } says. */
typedef struct Film {
    Span span; /* of the word */
    int frames; /* counted from 1 */
    double fps;
    double first_clock, last_clock;
    bool cyclic;    /* last_clock is that of the frame after the last, which is the first again */
    double shutter; /* the part of a frame's time that it is open, 0 to 1 */
} Film;

typedef struct Scene {
    const char *name;
    Camera camera;
    bool has_camera;
    const Light *lights;
    size_t light_count;
    const Object *const *objects;
    size_t object_count;
    const Skin *const *skins;
    size_t skin_count;
    const Pigment *const *sky_layers; /* of sky_sphere, first below; pattern space: unit direction */
    size_t sky_layer_count;
    Color sky_emission;               /* times which they are bright */
    bool old_sky;                     /* #version is below 3.7: layers are laid over each other as then */
    Color background;
    const Fog *fogs;
    size_t fog_count;
    const Rainbow *rainbows;
    size_t rainbow_count;
    MediaList media;                  /* between all objects; and in those that are hollow */
    bool has_media;                   /* these, or some interior's */
    const Texture *default_texture;
    GlobalSettings settings;
    double clock;
    double time;                      /* seconds: what winds run by */
    double cycle;                     /* seconds after which a film begins again; 0: it does not */
    const Film *film;                 /* NULL: the scene has no animation */
    bool has_terrain;                 /* some object or skin is one, or may hold one */
    const NamedTexel *named_texels; /* by name */
    size_t named_texel_count;
} Scene;

/* The graph as indented text, one node a line: for --dump=scene and tests. */
void scene_print(const Scene *scene, StrBuf *out);
/* Defaults of POV-Ray 3.7 where it has them. */
Finish finish_default(void);
Interior interior_default(void);
Pigment pigment_default(void);
GlobalSettings global_settings_default(void);
Camera camera_default(double aspect);

#endif
