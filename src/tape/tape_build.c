/* Building a tape: constants are folded and equal instructions shared as they are asked for, so that a value costs what
 * it says however it was written. */
#include "tape/tape_builder.h"

#include <math.h>
#include <string.h>

/* ---- the operations' names ---- */

static const struct {
    const char *text;
    int arity;
} op_table[] = {
#define TAPE_OP(name, arity, text) {text, arity},
#include "tape/tape_ops.def"
#undef TAPE_OP
};

const char *tape_op_text(TapeOp op) { return op_table[op].text; }
int tape_op_arity(TapeOp op) { return op_table[op].arity; }

/* ---- sharing ---- */

static uint64_t node_hash(const TapeBuilder *builder, const TapeNode *node) {
    Hash128 hash = hash_begin(node->op);
    uint64_t operands[2] = {(uint64_t)node->a << 32 | node->b, node->c};
    if (node->op == TAPE_CALL) {
        const TapeCall *call = &builder->calls.items[node->c];
        operands[1] = call->external->hash.lo;
        hash_add(&hash, call->args, (size_t)call->external->input_count * sizeof *call->args);
    } else if (node->op == TAPE_SUM || node->op == TAPE_PROD) {
        const TapeLoop *loop = &builder->loops.items[node->c];
        operands[1] = loop->body->hash.lo;
        hash_add(&hash, loop->captured, loop->captured_count * sizeof *loop->captured);
    }
    hash_add(&hash, operands, sizeof operands);
    return hash.lo;
}

static bool same_call(const TapeCall *a, const TapeCall *b) {
    return hash_equal(a->external->hash, b->external->hash) && a->external->eval == b->external->eval &&
           a->external->input_count == b->external->input_count &&
           memcmp(a->args, b->args, (size_t)a->external->input_count * sizeof *a->args) == 0;
}

static bool same_loop(const TapeLoop *a, const TapeLoop *b) {
    return hash_equal(a->body->hash, b->body->hash) && a->captured_count == b->captured_count &&
           memcmp(a->captured, b->captured, a->captured_count * sizeof *a->captured) == 0;
}

static bool same_node(const TapeBuilder *builder, const TapeNode *x, const TapeNode *y) {
    if (x->op != y->op || x->a != y->a || x->b != y->b) return false;
    if (x->op == TAPE_CALL) return same_call(&builder->calls.items[x->c], &builder->calls.items[y->c]);
    if (x->op == TAPE_SUM || x->op == TAPE_PROD)
        return same_loop(&builder->loops.items[x->c], &builder->loops.items[y->c]);
    return x->c == y->c;
}

/* Where `node` is, or the empty place where it belongs. */
static uint32_t *share_place(const TapeBuilder *builder, const TapeNode *node) {
    size_t mask = builder->share_size - 1, i = (size_t)node_hash(builder, node) & mask;
    while (builder->share[i] && !same_node(builder, node, &builder->nodes.items[builder->share[i] - 1]))
        i = (i + 1) & mask;
    return &builder->share[i];
}

static void share_grow(TapeBuilder *builder) {
    builder->share_size = builder->share_size ? 2 * builder->share_size : 64;
    builder->share = arena_new_array(builder->arena, uint32_t, builder->share_size);
    for (uint32_t i = 0; i < builder->nodes.count; i++)
        *share_place(builder, &builder->nodes.items[i]) = i + 1;
}

static TapeRef add_node(TapeBuilder *builder, TapeNode node, Span span) {
    if (2 * builder->nodes.count >= builder->share_size) share_grow(builder);
    uint32_t *place = share_place(builder, &node);
    if (!*place) {
        *list_push(builder->arena, &builder->nodes) = node;
        *list_push(builder->arena, &builder->spans) = span;
        *place = (uint32_t)builder->nodes.count;
    }
    return *place - 1;
}

/* ---- leaves ---- */

TapeBuilder *tape_builder_create(Arena *arena, int input_count) {
    TapeBuilder *builder = arena_new(arena, TapeBuilder);
    builder->arena = arena;
    builder->input_count = (uint32_t)input_count;
    return builder;
}

TapeRef tape_input(TapeBuilder *builder, int index) {
    return add_node(builder, (TapeNode){.op = TAPE_INPUT, .a = (uint32_t)index}, (Span){0});
}

TapeRef tape_constant(TapeBuilder *builder, double value) {
    union {
        double value;
        uint64_t bits;
    } u = {.value = isnan(value) ? (double)NAN : value};
    TapeNode node = {.op = TAPE_CONSTANT, .a = (uint32_t)u.bits, .b = (uint32_t)(u.bits >> 32)};
    return add_node(builder, node, (Span){0});
}

bool tape_is_constant(const TapeBuilder *builder, TapeRef ref, double *value) {
    const TapeNode *node = &builder->nodes.items[ref];
    if (node->op != TAPE_CONSTANT) return false;
    *value = tape_node_constant(node);
    return true;
}

static bool all_constant(const TapeBuilder *builder, const TapeRef *refs, size_t count, double *values) {
    for (size_t k = 0; k < count; k++)
        if (!tape_is_constant(builder, refs[k], &values[k])) return false;
    return true;
}

/* ---- operations ---- */

/* Simplifications that change no bit of any value. */
static bool simplify(const TapeBuilder *builder, TapeOp op, TapeRef a, TapeRef b, TapeRef *out) {
    double value;
    if (op == TAPE_NEG && builder->nodes.items[a].op == TAPE_NEG)
        return *out = builder->nodes.items[a].a, true;
    if ((op == TAPE_MUL || op == TAPE_DIV || op == TAPE_POW) && tape_is_constant(builder, b, &value) && value == 1)
        return *out = a, true;
    if (op == TAPE_MUL && tape_is_constant(builder, a, &value) && value == 1) return *out = b, true;
    if (op == TAPE_SUB && tape_is_constant(builder, b, &value) && value == 0 && !signbit(value))
        return *out = a, true;
    return false;
}

TapeRef tape_unary(TapeBuilder *builder, TapeOp op, TapeRef a, Span span) {
    double x;
    TapeRef simple;
    if (tape_is_constant(builder, a, &x)) return tape_constant(builder, tape_apply(op, x, 0, 0));
    if (simplify(builder, op, a, a, &simple)) return simple;
    return add_node(builder, (TapeNode){(uint32_t)op, a, 0, 0}, span);
}

TapeRef tape_binary(TapeBuilder *builder, TapeOp op, TapeRef a, TapeRef b, Span span) {
    double x[2];
    TapeRef simple;
    if (op == TAPE_POW && tape_is_constant(builder, b, x) && x[0] == 2)
        return tape_unary(builder, TAPE_SQR, a, span); /* rounded once, as powers should be and nearly are */
    if (all_constant(builder, (TapeRef[]){a, b}, 2, x))
        return tape_constant(builder, tape_apply(op, x[0], x[1], 0));
    if (simplify(builder, op, a, b, &simple)) return simple;
    if (op == TAPE_MUL && a == b) return tape_unary(builder, TAPE_SQR, a, span);
    if ((op == TAPE_ADD || op == TAPE_MUL) && a > b)
        return add_node(builder, (TapeNode){(uint32_t)op, b, a, 0}, span);
    return add_node(builder, (TapeNode){(uint32_t)op, a, b, 0}, span);
}

TapeRef tape_ternary(TapeBuilder *builder, TapeOp op, TapeRef a, TapeRef b, TapeRef c, Span span) {
    double x[3];
    if (all_constant(builder, (TapeRef[]){a, b, c}, 3, x))
        return tape_constant(builder, tape_apply(op, x[0], x[1], x[2]));
    if (op == TAPE_SELECT && tape_is_constant(builder, a, x)) return x[0] < 0 ? b : c;
    if (op == TAPE_SELECT && b == c) return b;
    return add_node(builder, (TapeNode){(uint32_t)op, a, b, c}, span);
}

/* ---- externals and loops ---- */

static bool fold_call(TapeBuilder *builder, const TapeExternal *external, const TapeRef *inputs,
                      TapeRef *outputs) {
    double in[TAPE_CALL_MAX], out[TAPE_CALL_MAX];
    if (!all_constant(builder, inputs, (size_t)external->input_count, in)) return false;
    external->eval(external->data, in, out);
    for (int k = 0; k < external->output_count; k++) outputs[k] = tape_constant(builder, out[k]);
    return true;
}

void tape_call(TapeBuilder *builder, const TapeExternal *external, const TapeRef *inputs, TapeRef *outputs,
               Span span) {
    if (fold_call(builder, external, inputs, outputs)) return;
    if (external->expand && external->expand(external->data, builder, inputs, outputs, span)) return;
    TapeCall *call = list_push(builder->arena, &builder->calls);
    *call = (TapeCall){.external = external};
    memcpy(call->args, inputs, (size_t)external->input_count * sizeof *inputs);
    uint32_t index = (uint32_t)(builder->calls.count - 1);
    TapeRef ref = add_node(builder, (TapeNode){.op = TAPE_CALL, .c = index}, span);
    if (builder->nodes.items[ref].c != index) builder->calls.count--;
    for (int k = 0; k < external->output_count; k++)
        outputs[k] = add_node(builder, (TapeNode){TAPE_RESULT, ref, (uint32_t)k, 0}, span);
}

/* Loops of constants are run while building when that is quick. */
static bool fold_loop(TapeBuilder *builder, bool product, const TapeRef range[2], const Tape *body,
                      const TapeRef *captured, size_t captured_count, double *value) {
    enum { QUICK = 100000 };
    double bounds[2];
    if (!all_constant(builder, range, 2, bounds)) return false;
    if (body->loop_count || (bounds[1] - bounds[0]) * (double)(body->step_count + 1) > QUICK) return false;
    ArenaMark mark = arena_mark(builder->arena);
    double *scratch = arena_new_array(builder->arena, double, body->scratch_size);
    bool known = all_constant(builder, captured, captured_count, scratch);
    if (known) *value = tape_loop_value(body, product, bounds[0], bounds[1], scratch);
    arena_reset_to(builder->arena, mark);
    return known;
}

TapeRef tape_loop(TapeBuilder *builder, bool product, TapeRef from, TapeRef to, const Tape *body,
                  const TapeRef *captured, int captured_count, Span span) {
    double value;
    size_t count = (size_t)captured_count;
    if (fold_loop(builder, product, (TapeRef[]){from, to}, body, captured, count, &value))
        return tape_constant(builder, value);
    TapeLoop *loop = list_push(builder->arena, &builder->loops);
    *loop = (TapeLoop){.body = body, .captured_count = (uint32_t)count};
    loop->captured = arena_copy(builder->arena, captured, count * sizeof *captured);
    uint32_t index = (uint32_t)(builder->loops.count - 1);
    TapeRef ref = add_node(builder, (TapeNode){product ? TAPE_PROD : TAPE_SUM, from, to, index}, span);
    if (builder->nodes.items[ref].c != index) builder->loops.count--;
    return ref;
}

/* ---- whole tapes ---- */

size_t tape_builder_size(const TapeBuilder *builder) { return builder->nodes.count; }

static void map_refs(const TapeRef *map, const TapeRef *refs, size_t count, TapeRef *out) {
    for (size_t k = 0; k < count; k++) out[k] = map[refs[k]];
}

static TapeRef inline_loop(TapeBuilder *builder, const Tape *callee, const TapeNode *node, const TapeRef *map,
                           Span span) {
    const TapeLoop *loop = &callee->loops[node->c];
    TapeRef *captured = arena_new_array(builder->arena, TapeRef, loop->captured_count);
    map_refs(map, loop->captured, loop->captured_count, captured);
    return tape_loop(builder, node->op == TAPE_PROD, map[node->a], map[node->b], loop->body, captured,
                     (int)loop->captured_count, span);
}

static TapeRef inline_node(TapeBuilder *builder, const TapeNode *node, const TapeRef *inputs,
                           const TapeRef *map, Span span) {
    switch (tape_op_arity((TapeOp)node->op)) {
    case 1: return tape_unary(builder, (TapeOp)node->op, map[node->a], span);
    case 2: return tape_binary(builder, (TapeOp)node->op, map[node->a], map[node->b], span);
    case 3: return tape_ternary(builder, (TapeOp)node->op, map[node->a], map[node->b], map[node->c], span);
    default:
        return node->op == TAPE_INPUT ? inputs[node->a] : tape_constant(builder, tape_node_constant(node));
    }
}

void tape_inline_nodes(TapeBuilder *builder, const Tape *callee, const TapeRef *inputs, TapeRef *map) {
    TapeRef results[TAPE_CALL_MAX];
    for (size_t i = 0; i < callee->node_count; i++) {
        const TapeNode *node = &callee->nodes[i];
        Span span = callee->spans[i];
        if (node->op == TAPE_CALL) { /* its RESULTs follow at once */
            const TapeCall *call = &callee->calls[node->c];
            TapeRef args[TAPE_CALL_MAX];
            map_refs(map, call->args, (size_t)call->external->input_count, args);
            tape_call(builder, call->external, args, results, span);
        } else if (node->op == TAPE_RESULT)
            map[i] = results[node->b];
        else if (node->op == TAPE_SUM || node->op == TAPE_PROD)
            map[i] = inline_loop(builder, callee, node, map, span);
        else
            map[i] = inline_node(builder, node, inputs, map, span);
    }
}

void tape_inline(TapeBuilder *builder, const Tape *callee, const TapeRef *inputs, TapeRef *outputs) {
    TapeRef *map = arena_new_array(builder->arena, TapeRef, callee->node_count);
    tape_inline_nodes(builder, callee, inputs, map);
    map_refs(map, callee->outputs, callee->output_count, outputs);
}
