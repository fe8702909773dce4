/* The fast road: trees of expressions, extents of statements, and what it leaves to the slow road. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "parser/parser.h"

#include <string.h>

typedef struct Parsed {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    KeywordTable keywords;
    Parser parser;
    ParserHost host;
} Parsed;

/* Names that begin with M are macros (whose body is one sum), with F functions, with V values; others mean nothing yet. */
static NameClass classify(void *context, Name name, const void **macro) {
    (void)context;
    *macro = name;
    switch (name->text[0]) {
    case 'M': return NAME_MACRO;
    case 'F': return NAME_CALLABLE;
    case 'V': return NAME_PLAIN;
    default: return NAME_UNKNOWN;
    }
}

static Binding binding(void *context, const void *macro) {
    (void)context;
    (void)macro;
    return BIND_SUM;
}

static bool is_block(void *context, const void *macro) {
    (void)context;
    (void)macro;
    return false;
}

static Node *parse(Parsed *q, const char *text) {
    arena_init(&q->arena, NULL, 0);
    source_set_init(&q->sources, &q->arena);
    diag_init(&q->diags, &q->arena, &q->sources);
    interner_init(&q->names, &q->arena);
    keyword_table_init(&q->keywords, &q->names, &q->arena);
    TokenList *list =
        lexer_run(source_add_text(&q->sources, "test", text, strlen(text)), &q->keywords, &q->arena);
    q->host = (ParserHost){.classify = classify, .macro_binding = binding, .macro_is_whole = is_block, .macro_is_block = is_block};
    q->parser = (Parser){.arena = &q->arena,
                         .diags = &q->diags,
                         .keywords = &q->keywords,
                         .host = &q->host,
                         .list = list,
                         .end = list->count - 1};
    return parser_statement(&q->parser);
}

/* A tree as one line: (+ a b). */
static void flatten(const Node *n, StrBuf *out) {
    switch (n->kind) {
    case NODE_NUMBER: strbuf_addf(out, "%g", n->as.number); break;
    case NODE_NAME: strbuf_adds(out, n->as.name->text); break;
    case NODE_CONSTANT: strbuf_adds(out, keyword_text((Keyword)n->op)); break;
    case NODE_UNARY:
        if (n->op == '(') {
            flatten(n->as.operand.a, out);
            break;
        }
        strbuf_addf(out, "(%c ", n->op);
        flatten(n->as.operand.a, out);
        strbuf_addc(out, ')');
        break;
    case NODE_BINARY:
        strbuf_addf(out, "(%s%c ", n->op >= 128 ? "#" : "", n->op >= 128 ? '=' : n->op);
        flatten(n->as.operand.a, out);
        strbuf_addc(out, ' ');
        flatten(n->as.operand.b, out);
        strbuf_addc(out, ')');
        break;
    case NODE_CONDITION:
        strbuf_adds(out, "(? ");
        flatten(n->as.operand.a, out);
        strbuf_addc(out, ' ');
        flatten(n->as.operand.b, out);
        strbuf_addc(out, ' ');
        flatten(n->as.operand.c, out);
        strbuf_addc(out, ')');
        break;
    case NODE_DOT:
        strbuf_addf(out, "(.%d ", n->op);
        flatten(n->as.operand.a, out);
        strbuf_addc(out, ')');
        break;
    case NODE_VECTOR:
        strbuf_addc(out, '<');
        for (size_t i = 0; i < n->as.list.count; i++) {
            if (i) strbuf_addc(out, ' ');
            flatten(n->as.list.items[i], out);
        }
        strbuf_addc(out, '>');
        break;
    default: strbuf_addf(out, "[%d]", n->kind);
    }
}

static void assert_tree(const char *text, const char *tree) {
    Parsed q;
    Node *n = parse(&q, text);
    assert_non_null(n);
    StrBuf out = {0};
    flatten(n, &out);
    assert_string_equal(out.data, tree);
    strbuf_free(&out);
    arena_destroy(&q.arena);
}

static void test_precedence(void **state) {
    (void)state;
    assert_tree("1 + 2*3", "(+ 1 (* 2 3))");
    assert_tree("1 - 2 - 3", "(- (- 1 2) 3)");
    assert_tree("8/4*2", "(* (/ 8 4) 2)");
    assert_tree("-V.y*2", "(* (- (.1 V)) 2)");
    assert_tree("(1 | 0 & 0)", "(& (| 1 0) 0)");
    assert_tree("(1 + 2 < 4 ? 5 : 6 + 1)", "(? (< (+ 1 2) 4) 5 (+ 6 1))");
    assert_tree("<1 2, -3 4>", "<1 2 (- 3) 4>");
    assert_tree("<(1 < 2), 3 > ", "<(< 1 2) 3>");
}

static void assert_taken(const char *text, uint32_t tokens) {
    Parsed q;
    assert_non_null(parse(&q, text));
    assert_int_equal(q.parser.at, tokens);
    arena_destroy(&q.arena);
}

static void test_extent_of_items(void **state) {
    (void)state;
    assert_taken("1 < 2", 1);                      /* no comparison outside of brackets */
    assert_taken("distance 50 rgb 1", 2);          /* a colour is an item of its own … */
    assert_taken("checker rgb 0, rgb 1 scale", 6); /* … unless a comma says otherwise */
    assert_taken("diffuse 0.5, 0.3 specular 1", 4);
    assert_taken("translate x*2 VNext", 5);
    assert_taken("no_shadow unknown", 1);
    assert_taken("count 3 { life 1 } life", 6);
    assert_taken("sphere { 0, 1 } box", 6);
}

static void assert_left_to_slow_road(const char *text, bool expected) {
    Parsed q;
    Node *n = parse(&q, text);
    assert_true((n == NULL) == expected);
    assert_int_equal(q.diags.error_count, 0);
    arena_destroy(&q.arena);
}

static void test_what_the_fast_road_leaves(void **state) {
    (void)state;
    assert_left_to_slow_road("#declare A = (1 + #if (1) 2 #end);", true);
    assert_left_to_slow_road("#if (1) sphere { 0, #else box { -1, #end 2 }", true);
    assert_left_to_slow_road("#if (1) 2 + #end 3", true);
    assert_left_to_slow_road("#declare A = (1 + ;", true);
    assert_left_to_slow_road("#if (1) sphere { 0, 1 } #else #declare A = 2; #end", false);
    assert_left_to_slow_road("union { #for (I, 1, 3) sphere { I*x, 1 } #end }", false);
}

/* What a call needs of its macro's body depends on the operators around it. */
static void test_needs_of_calls(void **state) {
    (void)state;
    static const struct {
        const char *text;
        Binding need;
    } cases[] = {{"#declare A = M(1);", BIND_ANY},         {"#declare A = M(1) + 2;", BIND_SUM},
                 {"#declare A = M(1) * 2;", BIND_PRODUCT}, {"#declare A = 2 + M(1);", BIND_PRIMARY},
                 {"#declare A = -M(1);", BIND_PRIMARY},    {"#declare A = M(1).x;", BIND_PRIMARY}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        Parsed q;
        assert_non_null(parse(&q, cases[i].text));
        Binding need = BIND_NONE;
        for (size_t k = 0; k < q.parser.assumptions.count; k++)
            if (q.parser.assumptions.items[k].call) need = (Binding)q.parser.assumptions.items[k].call->need;
        assert_int_equal(need, cases[i].need);
        arena_destroy(&q.arena);
    }
}

static void test_deep_nesting_ends(void **state) {
    (void)state;
    char text[4096];
    memset(text, '(', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    assert_left_to_slow_road(text, true);
    memset(text, '-', sizeof text - 1);
    assert_left_to_slow_road(text, true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_precedence),
        cmocka_unit_test(test_extent_of_items),
        cmocka_unit_test(test_what_the_fast_road_leaves),
        cmocka_unit_test(test_needs_of_calls),
        cmocka_unit_test(test_deep_nesting_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
