/* What the builders of the rarer solids share. */
#ifndef VTS_EVAL_BUILD_RARE_H
#define VTS_EVAL_BUILD_RARE_H

#include "eval/build_parts.h"

/* All that such a block may say. */
typedef struct RareDraft {
    Reader *reader;
    ObjectDraft common;
    Solid solid;
    struct {
        Argument *items;
        size_t count, capacity;
    } row;       /* numbers, strings and functions in the order of the text */
    size_t next; /* in the row */
    struct {
        BlobPart *items;
        size_t count, capacity;
    } parts;
    bool full_detail;
    IsosurfaceMethod method;
    bool takes_parts, open, conic, smooth, hypercomplex, potential;
    CurveKind curve;
    double threshold, accuracy, max_gradient, water_level, iterations;
    const Object *container;
    size_t slice_at; /* 1 + where in the row `slice` has its numbers; 0: none */
    JuliaFunction function;
    const char *picture;
    Span picture_span;
    Vec3 turned; /* degrees, before all transforms of the text */
} RareDraft;

/* Reads the block with all modifiers of objects; then the row can be read; then rare_end() makes the object of
 * draft->solid. False after a diagnostic. */
bool rare_begin(RareDraft *draft, Reader *reader);
bool rare_end(RareDraft *draft, Value *out);

/* The next value of the row; `what` names it in messages. False after a diagnostic. */
bool rare_float(RareDraft *draft, const char *what, double *out);
bool rare_vector(RareDraft *draft, const char *what, Vec3 *out);
bool rare_vector4(RareDraft *draft, const char *what, double out[4]);
bool rare_point2(RareDraft *draft, const char *what, Point2 *out);
bool rare_count(RareDraft *draft, const char *what, size_t least, size_t *out);
bool rare_numbers_left(const RareDraft *draft);

#endif
