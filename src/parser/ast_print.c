#include "parser/ast.h"

static const char *const kind_texts[] = {
    "error",    "number", "string", "value",     "name",  "constant", "vector",  "index",
    "dot",      "unary",  "binary", "condition", "call",  "builtin",  "color",   "array",  "dictionary",
    "function", "block",  "word",   "entry",     "list",  "declare",  "undef",   "if",
    "while",    "for",    "switch", "break",     "macro", "include",  "version", "default",
    "message",  "fopen",  "fclose", "read",      "write", "empty", "numbers"};

static void print_list(const NodeList *list, StrBuf *out, int indent) {
    for (size_t i = 0; i < list->count; i++) ast_print(list->items[i], out, indent);
}

static void print_body(const Body *body, StrBuf *out, int indent) {
    if (!body) return;
    strbuf_repeat(out, ' ', (size_t)indent * 2);
    if (body->tokens)
        strbuf_addf(out, "tokens %u to %u\n", body->begin, body->end);
    else
        strbuf_adds(out, "items\n"), print_list(&body->items, out, indent + 1);
}

static void print_operator(StrBuf *out, int op) {
    const char *text = op == TOKEN_LESS_EQUAL      ? "<="
                       : op == TOKEN_GREATER_EQUAL ? ">="
                       : op == TOKEN_NOT_EQUAL     ? "!="
                                                   : NULL;
    if (text)
        strbuf_addf(out, " %s\n", text);
    else
        strbuf_addf(out, " %c\n", op);
}

static void print_rest(const Node *n, StrBuf *out, int indent) {
    switch (n->kind) {
    case NODE_NUMBER: strbuf_addf(out, " %.17g\n", n->as.number); return;
    case NODE_STRING:
        strbuf_addc(out, ' '), strbuf_add_json(out, n->as.string->text), strbuf_addc(out, '\n');
        return;
    case NODE_NAME: strbuf_addf(out, " %s\n", n->as.name->text); return;
    case NODE_CONSTANT: strbuf_addf(out, " %s\n", keyword_text((Keyword)n->op)); return;
    case NODE_UNARY:
    case NODE_BINARY:
    case NODE_CONDITION:
    case NODE_DOT:
        if (n->kind == NODE_DOT)
            strbuf_addf(out, " %d\n", n->op);
        else if (n->kind == NODE_CONDITION)
            strbuf_addc(out, '\n');
        else
            print_operator(out, n->op);
        ast_print(n->as.operand.a, out, indent);
        if (n->kind == NODE_BINARY || n->kind == NODE_CONDITION) ast_print(n->as.operand.b, out, indent);
        if (n->kind == NODE_CONDITION) ast_print(n->as.operand.c, out, indent);
        return;
    case NODE_INDEX:
    case NODE_CALL:
        strbuf_addc(out, '\n');
        ast_print(n->as.apply.base, out, indent);
        print_list(&n->as.apply.list, out, indent);
        return;
    case NODE_BUILTIN:
        strbuf_addf(out, " %s\n", keyword_text((Keyword)n->op)), print_list(&n->as.list, out, indent);
        return;
    case NODE_VECTOR:
    case NODE_UNDEF:
    case NODE_FOPEN:
    case NODE_FCLOSE:
    case NODE_READ:
    case NODE_WRITE: strbuf_addc(out, '\n'), print_list(&n->as.list, out, indent); return;
    case NODE_COLOR:
        strbuf_addc(out, '\n');
        for (size_t i = 0; i < n->as.color.count; i++) ast_print(n->as.color.parts[i].value, out, indent);
        return;
    case NODE_ARRAY:
        strbuf_addc(out, '\n'), print_list(&n->as.array.dimensions, out, indent),
            print_body(n->as.array.body, out, indent);
        return;
    case NODE_FUNCTION:
        strbuf_addf(out, " %zu parameters\n", n->as.function.count),
            print_list(&n->as.function.body, out, indent);
        return;
    case NODE_BLOCK:
        strbuf_addf(out, " %s\n", n->as.block.word->text), print_body(n->as.block.body, out, indent);
        return;
    case NODE_WORD:
        strbuf_addf(out, " %s\n", n->as.word.word->text);
        print_list(&n->as.word.list, out, indent);
        print_body(n->as.word.body, out, indent);
        return;
    case NODE_DECLARE:
        strbuf_adds(out, n->as.declare.local ? " local\n" : "\n");
        ast_print(n->as.declare.target, out, indent);
        ast_print(n->as.declare.value, out, indent);
        return;
    case NODE_IF:
        strbuf_addc(out, '\n');
        for (size_t i = 0; i < n->as.branches.count; i++) {
            if (n->as.branches.branches[i].condition)
                ast_print(n->as.branches.branches[i].condition, out, indent);
            print_body(&n->as.branches.branches[i].body, out, indent);
        }
        return;
    case NODE_WHILE:
        strbuf_addc(out, '\n'), ast_print(n->as.loop.condition, out, indent),
            print_body(&n->as.loop.body, out, indent);
        return;
    case NODE_FOR:
        strbuf_addf(out, " %s\n", n->as.for_loop.name->text), print_body(&n->as.for_loop.body, out, indent);
        return;
    case NODE_MACRO:
        strbuf_addf(out, " %s\n", n->as.macro.name->text), print_body(&n->as.macro.body, out, indent);
        return;
    case NODE_INCLUDE:
    case NODE_VERSION:
    case NODE_MESSAGE: strbuf_addc(out, '\n'), ast_print(n->as.operand.a, out, indent); return;
    case NODE_ENTRY:
    case NODE_LIST:
    case NODE_DEFAULT: strbuf_addc(out, '\n'), print_body(n->as.block.body, out, indent); return;
    default: strbuf_addc(out, '\n'); return;
    }
}

void ast_print(const Node *node, StrBuf *out, int indent) {
    strbuf_repeat(out, ' ', (size_t)indent * 2);
    strbuf_adds(out, node->kind < VTS_ARRAY_COUNT(kind_texts) ? kind_texts[node->kind] : "?");
    print_rest(node, out, indent + 1);
}
