/* What a finished tape is made of: for the builder, the printer and the arithmetics, not for users of tapes. */
#ifndef VTS_TAPE_TAPE_PROGRAM_H
#define VTS_TAPE_TAPE_PROGRAM_H

#include "tape/tape.h"

/* An instruction in single-assignment form. Operands are indices of earlier nodes, but:
 *   INPUT a = index; CONSTANT a, b = low and high half of the double; CALL c = index into calls;
 *   RESULT a = the CALL's node, b = which; SUM and PROD a, b = from, to, c = index into loops. */
typedef struct TapeNode {
    uint32_t op, a, b, c;
} TapeNode;

/* An instruction on slots, as the walk executes it. CALL: c = index into calls; SUM, PROD: a, b, c as above. */
typedef struct TapeStep {
    uint32_t op, dst, a, b, c;
} TapeStep;

#define TAPE_NO_SLOT UINT32_MAX

typedef struct TapeCall {
    const TapeExternal *external;
    TapeRef args[TAPE_CALL_MAX];          /* nodes */
    uint32_t arg_slots[TAPE_CALL_MAX];    /* of a finished tape, as the next one */
    uint32_t result_slots[TAPE_CALL_MAX]; /* TAPE_NO_SLOT: nobody wants it */
} TapeCall;

typedef struct TapeLoop {
    const Tape *body;
    uint32_t captured_count;
    TapeRef *captured; /* nodes */
    uint32_t *captured_slots;
} TapeLoop;

/* Slots: the inputs, then the constants, then values that change during the walk. Inputs and constants keep their slots
 * throughout; no step writes a slot that it reads. Behind the slots the scratch holds that of a loop's body. */
struct Tape {
    uint32_t input_count, output_count, constant_count, slot_count;
    size_t node_count, step_count, call_count, loop_count;
    size_t scratch_size; /* slots in all, loops' bodies included */
    int depth;
    double work;
    const TapeNode *nodes;
    const Span *spans; /* of nodes */
    const TapeStep *steps;
    const double *constants;
    const TapeCall *calls;
    const TapeLoop *loops;
    const TapeRef *outputs; /* nodes */
    const uint32_t *output_slots;
    Hash128 hash;
};

static inline double tape_node_constant(const TapeNode *node) {
    union {
        uint64_t bits;
        double value;
    } u = {.bits = (uint64_t)node->b << 32 | node->a};
    return u.value;
}

/* The value of an operation of arity 1 to 3 in the reference arithmetic; unused operands are ignored. */
double tape_apply(TapeOp op, double a, double b, double c);
/* Runs a loop whose captured values are already the first of `scratch` (the body's scratch). */
double tape_loop_value(const Tape *body, bool product, double from, double to, double *scratch);

#endif
