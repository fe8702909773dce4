/* Finishing a tape: what no output needs is dropped, values get slots that are used again once nobody reads them. */
#include "tape/tape_builder.h"

#include <string.h>

/* ---- operands of a node ---- */

typedef void OperandVisitor(void *context, TapeRef *operand);

static size_t plain_operand_count(TapeOp op) {
    switch (op) {
    case TAPE_RESULT: return 1;
    case TAPE_SUM:
    case TAPE_PROD: return 2;
    default: return (size_t)tape_op_arity(op);
    }
}

static void visit_operands(TapeNode *node, TapeCall *calls, TapeLoop *loops, OperandVisitor *visit,
                           void *context) {
    size_t count = plain_operand_count((TapeOp)node->op);
    if (count > 0) visit(context, &node->a);
    if (count > 1) visit(context, &node->b);
    if (count > 2) visit(context, &node->c);
    if (node->op == TAPE_CALL) {
        TapeCall *call = &calls[node->c];
        for (int k = 0; k < call->external->input_count; k++) visit(context, &call->args[k]);
    } else if (node->op == TAPE_SUM || node->op == TAPE_PROD) {
        TapeLoop *loop = &loops[node->c];
        for (uint32_t k = 0; k < loop->captured_count; k++) visit(context, &loop->captured[k]);
    }
}

/* ---- dead code ---- */

static void mark_live(void *context, TapeRef *operand) { ((bool *)context)[*operand] = true; }
static void renumber(void *context, TapeRef *operand) { *operand = ((const TapeRef *)context)[*operand]; }

/* Moves the nodes that are needed together, in place; outputs[] get the new numbers. */
static void drop_dead(TapeBuilder *builder, TapeRef *outputs, size_t output_count) {
    size_t kept = 0, count = builder->nodes.count;
    TapeNode *nodes = builder->nodes.items;
    bool *live = arena_new_array(builder->arena, bool, count);
    TapeRef *map = arena_new_array(builder->arena, TapeRef, count);
    for (size_t k = 0; k < output_count; k++) live[outputs[k]] = true;
    for (size_t i = count; i-- > 0;)
        if (live[i]) visit_operands(&nodes[i], builder->calls.items, builder->loops.items, mark_live, live);
    for (size_t i = 0; i < count; i++) {
        if (!live[i]) continue;
        visit_operands(&nodes[i], builder->calls.items, builder->loops.items, renumber, map);
        map[i] = (TapeRef)kept;
        builder->spans.items[kept] = builder->spans.items[i];
        nodes[kept++] = nodes[i];
    }
    for (size_t k = 0; k < output_count; k++) outputs[k] = map[outputs[k]];
    builder->nodes.count = kept;
}

/* ---- slots ---- */

typedef struct SlotPlan {
    TapeBuilder *builder;
    uint32_t *slots;    /* of each node */
    uint32_t *last_use; /* node that reads it last; UINT32_MAX: an output */
    uint32_t *free;     /* stack of slots to use again */
    size_t free_count;
    uint32_t slot_count;
    uint32_t node; /* being visited */
} SlotPlan;

static void note_use(void *context, TapeRef *operand) {
    SlotPlan *plan = context;
    if (plan->last_use[*operand] != UINT32_MAX) plan->last_use[*operand] = plan->node;
}

static void release(void *context, TapeRef *operand) {
    SlotPlan *plan = context;
    TapeOp op = (TapeOp)plan->builder->nodes.items[*operand].op;
    if (plan->last_use[*operand] != plan->node || op == TAPE_INPUT || op == TAPE_CONSTANT || op == TAPE_CALL)
        return;
    plan->last_use[*operand] = 0; /* once, though it may be read twice by this node */
    plan->free[plan->free_count++] = plan->slots[*operand];
}

static void find_last_uses(SlotPlan *plan, const TapeRef *outputs, size_t output_count) {
    TapeBuilder *b = plan->builder;
    for (size_t k = 0; k < output_count; k++) plan->last_use[outputs[k]] = UINT32_MAX;
    for (plan->node = 0; plan->node < b->nodes.count; plan->node++)
        visit_operands(&b->nodes.items[plan->node], b->calls.items, b->loops.items, note_use, plan);
}

/* Inputs and constants get the first slots, for good. */
static void place_leaves(SlotPlan *plan, Tape *tape) {
    double *constants = arena_new_array(plan->builder->arena, double, plan->builder->nodes.count);
    plan->slot_count = tape->input_count;
    for (size_t i = 0; i < plan->builder->nodes.count; i++) {
        const TapeNode *node = &plan->builder->nodes.items[i];
        if (node->op == TAPE_INPUT) plan->slots[i] = node->a;
        if (node->op != TAPE_CONSTANT) continue;
        plan->slots[i] = plan->slot_count++;
        constants[tape->constant_count++] = tape_node_constant(node);
    }
    tape->constants = constants;
}

/* A slot of its own for the node, never one that it reads: those are released afterwards. */
static void place_node(SlotPlan *plan, uint32_t i) {
    TapeBuilder *b = plan->builder;
    TapeNode *node = &b->nodes.items[i];
    plan->node = i;
    if (node->op == TAPE_INPUT || node->op == TAPE_CONSTANT) return;
    if (node->op != TAPE_CALL)
        plan->slots[i] = plan->free_count ? plan->free[--plan->free_count] : plan->slot_count++;
    if (node->op == TAPE_RESULT)
        b->calls.items[b->nodes.items[node->a].c].result_slots[node->b] = plan->slots[i];
    visit_operands(node, b->calls.items, b->loops.items, release, plan);
}

static void place_nodes(SlotPlan *plan) {
    TapeBuilder *b = plan->builder;
    for (size_t i = 0; i < b->calls.count; i++)
        memset(b->calls.items[i].result_slots, 0xFF, sizeof b->calls.items[i].result_slots);
    for (uint32_t i = 0; i < b->nodes.count; i++) place_node(plan, i);
}

/* ---- steps ---- */

static TapeStep make_step(TapeBuilder *b, const uint32_t *slots, size_t i) {
    const TapeNode *node = &b->nodes.items[i];
    size_t count = plain_operand_count((TapeOp)node->op);
    TapeStep step = {node->op, slots[i], 0, 0, node->c};
    if (count > 0) step.a = slots[node->a];
    if (count > 1) step.b = slots[node->b];
    if (count > 2) step.c = slots[node->c];
    if (node->op == TAPE_CALL) {
        TapeCall *call = &b->calls.items[node->c];
        for (int k = 0; k < call->external->input_count; k++) call->arg_slots[k] = slots[call->args[k]];
    } else if (node->op == TAPE_SUM || node->op == TAPE_PROD) {
        TapeLoop *loop = &b->loops.items[node->c];
        loop->captured_slots = arena_new_array(b->arena, uint32_t, loop->captured_count);
        for (uint32_t k = 0; k < loop->captured_count; k++)
            loop->captured_slots[k] = slots[loop->captured[k]];
    }
    return step;
}

static void make_steps(Tape *tape, TapeBuilder *b, const uint32_t *slots) {
    TapeStep *steps = arena_new_array(b->arena, TapeStep, b->nodes.count);
    for (size_t i = 0; i < b->nodes.count; i++) {
        TapeOp op = (TapeOp)b->nodes.items[i].op;
        if (op != TAPE_INPUT && op != TAPE_CONSTANT && op != TAPE_RESULT)
            steps[tape->step_count++] = make_step(b, slots, i);
    }
    tape->steps = steps;
}

/* ---- the whole ---- */

static void plan_slots(Tape *tape, TapeBuilder *builder, const TapeRef *outputs) {
    size_t count = builder->nodes.count, extra = 0;
    SlotPlan plan = {.builder = builder};
    plan.slots = arena_new_array(builder->arena, uint32_t, count);
    plan.last_use = arena_new_array(builder->arena, uint32_t, count);
    plan.free = arena_new_array(builder->arena, uint32_t, count);
    find_last_uses(&plan, outputs, tape->output_count);
    place_leaves(&plan, tape);
    place_nodes(&plan);
    make_steps(tape, builder, plan.slots);
    for (size_t i = 0; i < builder->loops.count; i++)
        extra = size_max(extra, builder->loops.items[i].body->scratch_size);
    uint32_t *output_slots = arena_new_array(builder->arena, uint32_t, tape->output_count);
    for (size_t k = 0; k < tape->output_count; k++) output_slots[k] = plan.slots[outputs[k]];
    tape->output_slots = output_slots;
    tape->slot_count = plan.slot_count;
    tape->scratch_size = plan.slot_count + extra;
}

/* ---- what an evaluation costs ---- */

static double passes(const Tape *tape, const TapeNode *node) {
    const TapeNode *from = &tape->nodes[node->a], *to = &tape->nodes[node->b];
    if (from->op != TAPE_CONSTANT || to->op != TAPE_CONSTANT) return 1;
    double count = tape_node_constant(to) - tape_node_constant(from) + 1;
    return count > 1 && count <= TAPE_LOOP_LIMIT ? count : 1;
}

static void estimate(Tape *tape) {
    tape->work = (double)tape->step_count;
    for (size_t i = 0; i < tape->node_count; i++) {
        const TapeNode *node = &tape->nodes[i];
        if (node->op == TAPE_CALL) {
            const TapeExternal *external = tape->calls[node->c].external;
            tape->depth = int_max(tape->depth, external->depth);
            tape->work += external->work;
        } else if (node->op == TAPE_SUM || node->op == TAPE_PROD) {
            const Tape *body = tape->loops[node->c].body;
            tape->depth = int_max(tape->depth, body->depth + 1);
            tape->work += passes(tape, node) * (body->work + 1);
        }
    }
}

static void hash_node(Hash128 *hash, const Tape *tape, const TapeNode *node) {
    hash_add_u64(hash, (uint64_t)node->op << 32 | node->a);
    hash_add_u64(hash, node->b);
    if (node->op == TAPE_CALL) {
        const TapeCall *call = &tape->calls[node->c];
        hash_add_hash(hash, call->external->hash);
        hash_add(hash, call->args, (size_t)call->external->input_count * sizeof *call->args);
    } else if (node->op == TAPE_SUM || node->op == TAPE_PROD) {
        const TapeLoop *loop = &tape->loops[node->c];
        hash_add_hash(hash, loop->body->hash);
        hash_add(hash, loop->captured, loop->captured_count * sizeof *loop->captured);
    } else
        hash_add_u64(hash, node->c);
}

static Hash128 content_hash(const Tape *tape) {
    Hash128 hash = hash_begin(0x7461706500000000u + tape->input_count);
    for (size_t i = 0; i < tape->node_count; i++) hash_node(&hash, tape, &tape->nodes[i]);
    hash_add(&hash, tape->outputs, tape->output_count * sizeof *tape->outputs);
    return hash;
}

const Tape *tape_finish(TapeBuilder *builder, const TapeRef *outputs, int output_count) {
    Tape *tape = arena_new(builder->arena, Tape);
    TapeRef *refs = arena_copy(builder->arena, outputs, (size_t)output_count * sizeof *outputs);
    tape->input_count = builder->input_count;
    tape->output_count = (uint32_t)output_count;
    drop_dead(builder, refs, (size_t)output_count);
    plan_slots(tape, builder, refs);
    tape->outputs = refs;
    tape->nodes = builder->nodes.items, tape->node_count = builder->nodes.count;
    tape->spans = builder->spans.items;
    tape->calls = builder->calls.items, tape->call_count = builder->calls.count;
    tape->loops = builder->loops.items, tape->loop_count = builder->loops.count;
    tape->hash = content_hash(tape);
    estimate(tape);
    return tape;
}

int tape_input_count(const Tape *tape) { return (int)tape->input_count; }
int tape_output_count(const Tape *tape) { return (int)tape->output_count; }
size_t tape_instruction_count(const Tape *tape) { return tape->node_count; }
Span tape_instruction_span(const Tape *tape, size_t i) { return tape->spans[i]; }
Hash128 tape_hash(const Tape *tape) { return tape->hash; }
int tape_depth(const Tape *tape) { return tape->depth; }
double tape_work(const Tape *tape) { return tape->work; }
size_t tape_scratch_size(const Tape *tape) { return tape->scratch_size; }
