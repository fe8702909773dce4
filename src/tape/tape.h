/* Tapes: every function of the language as one small register program, to be run in several arithmetics.
 *
 * A tape is a list of instructions in topological order (no jumps); instruction i computes value i from earlier values.
 * tape_ops.def is the single truth about operations. Tapes are immutable once finished and may be shared by threads. */
#ifndef VTS_TAPE_TAPE_H
#define VTS_TAPE_TAPE_H

#include "base/arena.h"
#include "base/hash.h"
#include "base/source.h"
#include "base/strbuf.h"

typedef enum TapeOp {
#define TAPE_OP(name, arity, text) TAPE_##name,
#include "tape/tape_ops.def"
#undef TAPE_OP
    TAPE_OP_COUNT
} TapeOp;

#define TAPE_CALL_MAX   16        /* inputs and outputs of an external */
#define TAPE_LOOP_LIMIT 16777216. /* passes of one sum() or prod(); a longer loop gives NaN */

struct Interval;   /* tape/interval.h */
struct AffineForm; /* tape/affine.h */
struct NodeCache;  /* tape/node_cache.h */

typedef uint32_t TapeRef; /* a value of the tape under construction */
typedef struct Tape Tape;
typedef struct TapeBuilder TapeBuilder;

/* A function that is not made of tape operations: a pigment, a spline, a picture. `eval` must be pure and thread-safe. */
typedef struct TapeExternal {
    const char *name;
    int input_count, output_count; /* at most TAPE_CALL_MAX each */
    void (*eval)(const void *data, const double *in, double *out);
    const void *data; /* outlives the tape */
    Hash128 hash;     /* of the content */
    int depth;        /* 0, or how deep its evaluation nests that of others */
    double work;      /* an evaluation in steps of a tape; 0: as one */
    /* Intervals that hold the outputs for all inputs from theirs; NULL: nothing is known but values at points. */
    void (*bound)(const void *data, const struct Interval *in, struct Interval *out);
    /* Forms of the outputs on `count` pieces of a line at once, at most 8: output k of piece i is out[k·count + i], and so of the inputs.
     * NULL: those of the intervals. */
    void (*forms)(const void *data, int count, const struct AffineForm *in, struct AffineForm *out, struct NodeCache *cells);
    /* Appends operations that give out[0 .. output_count), whose values may round otherwise than `eval`; asked for whenever the call is built
     * or inlined, since constants among the inputs may tell what they are. False, or NULL: it stays a call. */
    bool (*expand)(const void *data, TapeBuilder *builder, const TapeRef *in, TapeRef *out, Span span);
    /* slopes[k·input_count + j], 0 before: the derivative of output k by input j. NULL: neighbouring places are compared. */
    void (*gradient)(const void *data, const double *in, double *slopes);
} TapeExternal;

/* The printed form of an operation, and how many operands it takes (0: structure, not for tape_unary() and its like). */
const char *tape_op_text(TapeOp op);
int tape_op_arity(TapeOp op);

/* The builder and the tape live in `arena`. */
TapeBuilder *tape_builder_create(Arena *arena, int input_count);
TapeRef tape_input(TapeBuilder *builder, int index);
TapeRef tape_constant(TapeBuilder *builder, double value);
/* Whether the value is known already; *value gets it (may be NaN). */
bool tape_is_constant(const TapeBuilder *builder, TapeRef ref, double *value);
/* `span` is the text that asked for the operation, for messages. Constants are folded, with the arithmetic of run time;
 * equal instructions are shared. `op` must have that arity. */
TapeRef tape_unary(TapeBuilder *builder, TapeOp op, TapeRef a, Span span);
TapeRef tape_binary(TapeBuilder *builder, TapeOp op, TapeRef a, TapeRef b, Span span);
TapeRef tape_ternary(TapeBuilder *builder, TapeOp op, TapeRef a, TapeRef b, TapeRef c, Span span);
/* Values made so far. */
size_t tape_builder_size(const TapeBuilder *builder);
/* Inserts a copy of `callee` with its inputs replaced; outputs[0 .. tape_output_count(callee)). */
void tape_inline(TapeBuilder *builder, const Tape *callee, const TapeRef *inputs, TapeRef *outputs);
void tape_call(TapeBuilder *builder, const TapeExternal *external, const TapeRef *inputs, TapeRef *outputs, Span span);
/* The language's sum() and prod(): body has the inputs of this tape's `captured` values and, last, the running index; the
 * loop runs i = from, from + 1, … while i ≤ to. No pass gives 0 or 1; more than TAPE_LOOP_LIMIT passes give NaN. */
TapeRef tape_loop(TapeBuilder *builder, bool product, TapeRef from, TapeRef to, const Tape *body, const TapeRef *captured,
                  int captured_count, Span span);
/* fbm(perlin, x, y, z, octaves, lacunarity, gain): noise_fbm() as operations. Constant octave counts (at most 64 are used)
 * unroll; others become a loop. place[3] = x, y, z. */
TapeRef tape_fbm(TapeBuilder *builder, const TapeRef place[3], TapeRef octaves, TapeRef lacunarity, TapeRef gain,
                 Span span);
/* Drops what no output needs. The builder must not be used afterwards. */
const Tape *tape_finish(TapeBuilder *builder, const TapeRef *outputs, int output_count);

int tape_input_count(const Tape *tape);
int tape_output_count(const Tape *tape);
/* Instructions that remain, constants and inputs among them. */
size_t tape_instruction_count(const Tape *tape);
/* The text that asked for instruction i. */
Span tape_instruction_span(const Tape *tape, size_t i);
Hash128 tape_hash(const Tape *tape);
/* How deep an evaluation calls itself: loops within each other, the depth of externals added. */
int tape_depth(const Tape *tape);
/* Steps of an evaluation, with those of externals and of loops, whose passes are counted where they are constant. */
double tape_work(const Tape *tape);
/* Doubles that tape_eval() needs as scratch. */
size_t tape_scratch_size(const Tape *tape);
/* The reference arithmetic: IEEE doubles. Domain errors give NaN or infinity, as C's functions do. `out` may be `in`. */
void tape_eval(const Tape *tape, const double *in, double *out, double *scratch);
/* Convenience for few evaluations: allocates scratch on the stack or heap itself (no memory: NaN). */
void tape_eval_once(const Tape *tape, const double *in, double *out);
/* n evaluations; in[i] and out[i] are arrays of n, which must not overlap. Equal to tape_eval bit for bit (which NaN it is
 * may differ). */
void tape_eval_batch(const Tape *tape, size_t n, const double *const *in, double *const *out);
/* One instruction a line: "%3 = mul %1 %2"; at last "return %3". */
void tape_print(const Tape *tape, StrBuf *out);

#endif
