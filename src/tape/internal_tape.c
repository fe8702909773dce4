#include "tape/internal_tape.h"

typedef struct Build {
    TapeBuilder *builder;
    Span span;
} Build;

typedef TapeRef InternalTape(const Build *b, const TapeRef *in);

static TapeRef one(const Build *b, TapeOp op, TapeRef a) { return tape_unary(b->builder, op, a, b->span); }
static TapeRef two(const Build *b, TapeOp op, TapeRef a, TapeRef c) {
    return tape_binary(b->builder, op, a, c, b->span);
}

/* sqrt(a² + c²) */
static TapeRef length_2(const Build *b, TapeRef a, TapeRef c) {
    return one(b, TAPE_SQRT, two(b, TAPE_ADD, one(b, TAPE_SQR, a), one(b, TAPE_SQR, c)));
}

static TapeRef length_3(const Build *b, const TapeRef v[3]) {
    TapeRef sum = two(b, TAPE_ADD, one(b, TAPE_SQR, v[0]), one(b, TAPE_SQR, v[1]));
    return one(b, TAPE_SQRT, two(b, TAPE_ADD, sum, one(b, TAPE_SQR, v[2])));
}

static TapeRef radius(const Build *b, const TapeRef *in) { return length_3(b, in); }

static TapeRef sphere(const Build *b, const TapeRef *in) { return two(b, TAPE_SUB, length_3(b, in), in[3]); }

static TapeRef ellipsoid(const Build *b, const TapeRef *in) {
    TapeRef v[3];
    for (int k = 0; k < 3; k++) v[k] = two(b, TAPE_MUL, in[k], in[3 + k]);
    return length_3(b, v);
}

static TapeRef torus(const Build *b, const TapeRef *in) {
    TapeRef ring = two(b, TAPE_SUB, length_2(b, in[0], in[2]), in[3]);
    return two(b, TAPE_SUB, length_2(b, ring, in[1]), in[4]);
}

static TapeRef rounded_box(const Build *b, const TapeRef *in) {
    TapeRef v[3], zero = tape_constant(b->builder, 0);
    for (int k = 0; k < 3; k++) {
        TapeRef half = two(b, TAPE_SUB, in[4 + k], in[3]);
        v[k] = two(b, TAPE_MAX, zero, two(b, TAPE_SUB, one(b, TAPE_ABS, in[k]), half));
    }
    TapeRef distance = two(b, TAPE_SUB, length_3(b, v), in[3]);
    return two(b, TAPE_SUB, distance, tape_constant(b->builder, 1e-6));
}

static const struct {
    InternalEval *eval;
    InternalTape *tape;
} tapes[] = {{internal_r, radius},
             {internal_sphere, sphere},
             {internal_ellipsoid, ellipsoid},
             {internal_torus, torus},
             {internal_rounded_box, rounded_box}};

bool internal_tape(TapeBuilder *builder, const InternalFunction *function, const TapeRef *in, TapeRef *out,
                   Span span) {
    const Build build = {builder, span};
    for (size_t k = 0; k < VTS_ARRAY_COUNT(tapes); k++)
        if (tapes[k].eval == function->eval) return *out = tapes[k].tape(&build, in), true;
    return false;
}
