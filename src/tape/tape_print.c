/* The printed form of tapes. */
#include "tape/tape_program.h"

static void print_operands(const TapeRef *refs, uint32_t count, StrBuf *out) {
    for (uint32_t k = 0; k < count; k++) strbuf_addf(out, " %%%u", refs[k]);
}

static void print_tape(const Tape *tape, int indent, StrBuf *out);

static void print_loop(const TapeLoop *loop, const TapeNode *node, int indent, StrBuf *out) {
    strbuf_addf(out, " %%%u %%%u (", node->a, node->b);
    print_operands(loop->captured, loop->captured_count, out);
    strbuf_adds(out, " ) {\n");
    print_tape(loop->body, indent + 2, out);
    strbuf_repeat(out, ' ', (size_t)indent);
    strbuf_addc(out, '}');
}

static void print_node(const Tape *tape, const TapeNode *node, int indent, StrBuf *out) {
    strbuf_adds(out, tape_op_text((TapeOp)node->op));
    switch ((TapeOp)node->op) {
    case TAPE_INPUT: strbuf_addf(out, " %u", node->a); break;
    case TAPE_CONSTANT: strbuf_addf(out, " %.17g", tape_node_constant(node)); break;
    case TAPE_RESULT: strbuf_addf(out, " %%%u %u", node->a, node->b); break;
    case TAPE_CALL: {
        const TapeCall *call = &tape->calls[node->c];
        strbuf_addf(out, " %s", call->external->name);
        print_operands(call->args, (uint32_t)call->external->input_count, out);
        break;
    }
    case TAPE_SUM:
    case TAPE_PROD: print_loop(&tape->loops[node->c], node, indent, out); break;
    default:
        print_operands((TapeRef[]){node->a, node->b, node->c}, (uint32_t)tape_op_arity((TapeOp)node->op),
                       out);
    }
}

static void print_tape(const Tape *tape, int indent, StrBuf *out) {
    for (size_t i = 0; i < tape->node_count; i++) {
        strbuf_repeat(out, ' ', (size_t)indent);
        strbuf_addf(out, "%%%zu = ", i);
        print_node(tape, &tape->nodes[i], indent, out);
        strbuf_addc(out, '\n');
    }
    strbuf_repeat(out, ' ', (size_t)indent);
    strbuf_adds(out, "return");
    print_operands(tape->outputs, tape->output_count, out);
    strbuf_addc(out, '\n');
}

void tape_print(const Tape *tape, StrBuf *out) { print_tape(tape, 0, out); }
