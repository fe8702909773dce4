/* What the rarer solids and sheets of the language consist of: the numbers of the text, unprepared. */
#ifndef VTS_SCENE_SOLIDS_H
#define VTS_SCENE_SOLIDS_H

#include "base/hash.h"
#include "base/vec.h"
#include "tape/tape.h"

typedef struct Object Object;

typedef enum SolidKind {
    SOLID_POLYNOMIAL, /* poly, cubic, quartic */
    SOLID_QUADRIC,
    SOLID_POLYGON,
    SOLID_SUPERELLIPSOID,
    SOLID_PATCH, /* bicubic_patch */
    SOLID_BLOB,
    SOLID_LATHE,
    SOLID_SOR,
    SOLID_PRISM,
    SOLID_SWEEP, /* sphere_sweep */
    SOLID_TEXT,
    SOLID_JULIA,
    SOLID_OVUS,
    SOLID_ISOSURFACE,
    SOLID_PARAMETRIC,
    SOLID_HEIGHT_FIELD,
} SolidKind;

/* Degrees about x, y and z by which POV-Ray turns every text before all else, against rays that run along its walls. */
#define SOLID_TEXT_TURN 0.001

typedef enum CurveKind { CURVE_LINEAR, CURVE_QUADRATIC, CURVE_CUBIC, CURVE_BEZIER, CURVE_B_SPLINE } CurveKind;

typedef struct Point2 {
    double x, y;
} Point2;

/* strength·(1 - (distance/radius)²)² where that is positive; a cylinder's distance is that from its segment's inside, its ends
 * are half spheres. */
typedef struct BlobPart {
    Vec3 base, cap; /* equal: a sphere */
    double radius, strength;
    Transform transform; /* of the part alone */
    const struct Texture *texture; /* in the part's space; NULL: the blob's */
} BlobPart;

typedef struct SweepSphere {
    Vec3 center;
    double radius;
} SweepSphere;

typedef enum JuliaFunction {
    JULIA_SQR,
    JULIA_CUBE,
    JULIA_EXP,
    JULIA_RECIPROCAL,
    JULIA_SIN,
    JULIA_ASIN,
    JULIA_SINH,
    JULIA_ASINH,
    JULIA_COS,
    JULIA_ACOS,
    JULIA_COSH,
    JULIA_ACOSH,
    JULIA_TAN,
    JULIA_ATAN,
    JULIA_TANH,
    JULIA_ATANH,
    JULIA_LOG,
    JULIA_PWR
} JuliaFunction;

/* How zeros of an isosurface's function are enclosed; see shape/line_roots.h. */
typedef enum IsosurfaceMethod {
    ISOSURFACE_AUTO,
    ISOSURFACE_INTERVAL,
    ISOSURFACE_AFFINE,
    ISOSURFACE_REDUCED,
    ISOSURFACE_OPTIMISED,
} IsosurfaceMethod;

typedef struct Solid {
    SolidKind kind;
    const char *word; /* the keyword that made it */
    Hash128 hash;
    union {
        /* Σ c·xⁱyʲzᵏ, in POV-Ray's order: i from the order down, then j, then k */
        struct {
            int order;
            const double *coefficients;
            size_t count;
        } polynomial;
        /* squares·<x²,y²,z²> + mixed·<xy,xz,yz> + linear·<x,y,z> + constant */
        struct {
            Vec3 squares, mixed, linear;
            double constant;
        } quadric;
        struct {
            const Vec3 *points;
            size_t count;
        } polygon; /* sub-polygons closed by repeating their first point */
        struct {
            double east_west, north_south;
        } superellipsoid;
        struct {
            Vec3 points[16];
        } patch;
        struct {
            double threshold;
            const BlobPart *parts;
            size_t count;
            bool textured; /* some part has a texture */
        } blob;
        struct {
            CurveKind curve;
            const Point2 *points;
            size_t count;
            bool open;
        } turned; /* lathe, sor: <radius, y> */
        struct {
            CurveKind curve;
            bool conic, open;
            double low, high;
            const Point2 *points;
            size_t count;
        } prism;
        struct {
            CurveKind curve;
            const SweepSphere *spheres;
            size_t count;
        } sweep;
        struct {
            const char *font_path, *font_name, *text;
            double thickness;
            Vec3 offset;
        } text; /* path NULL: no such font was found */
        struct {
            double c[4], slice[4], distance;
            bool hypercomplex;
            JuliaFunction function;
            double exponent[2];
            int iterations;
        } julia;
        struct {
            double bottom, top;
        } ovus;
        struct {
            const Tape *function;
            const Object *container;
            double threshold, accuracy, max_gradient;
            bool open, full_detail; /* full: no octave is left out */
            IsosurfaceMethod method;
        } isosurface;
        struct {
            const Tape *functions[3]; /* of u, v */
            double u0, v0, u1, v1, accuracy;
            const Object *container; /* NULL: none */
        } parametric;
        struct {
            const char *path; /* of the picture; NULL: `heights` */
            int columns, rows;
            const double *heights; /* in [0, 1], row after row from z = 0 on */
            double water_level;
            bool smooth;
            bool potential; /* the picture's left half has the high bytes of its numbers, the right half the low ones (Fractint's .pot) */
        } field;
    } as;
} Solid;

/* Computes `hash` from all else. */
void solid_rehash(Solid *solid);
/* The number of terms of a polynomial of that order: (n+1)(n+2)(n+3)/6. */
size_t solid_polynomial_terms(int order);

#endif
