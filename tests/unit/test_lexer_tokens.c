/* The lexer: kinds, values and spans of tokens; which brackets and groups belong together. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "lexer/lexer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Lexed {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    KeywordTable keywords;
    TokenList *list;
} Lexed;

static void lex(Lexed *l, const char *text) {
    arena_init(&l->arena, NULL, 0);
    source_set_init(&l->sources, &l->arena);
    diag_init(&l->diags, &l->arena, &l->sources);
    interner_init(&l->names, &l->arena);
    intern_cstr(&l->names, "somebody_was_here_before");
    keyword_table_init(&l->keywords, &l->names, &l->arena);
    l->list = lexer_run(source_add_text(&l->sources, "test", text, strlen(text)), &l->keywords, &l->arena);
    for (uint32_t i = 0; i < l->list->count; i++)
        if (l->list->items[i].kind == TOKEN_BROKEN) token_report_broken(&l->diags, &l->list->items[i]);
}

static const Token *at(const Lexed *l, uint32_t i) { return &l->list->items[i]; }

static void test_numbers(void **state) {
    (void)state;
    static const struct {
        const char *text;
        double value;
    } cases[] = {{"1", 1},      {"1.5", 1.5},    {".5", 0.5},      {"5.", 5},
                 {"1e3", 1000}, {"1E-3", 0.001}, {"1.25E+2", 125}, {"007", 7}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        Lexed l;
        lex(&l, cases[i].text);
        assert_int_equal(l.list->count, 2);
        assert_int_equal(at(&l, 0)->kind, TOKEN_NUMBER);
        assert_true(at(&l, 0)->as.number == cases[i].value);
        assert_int_equal(at(&l, 0)->span.end, strlen(cases[i].text));
        arena_destroy(&l.arena);
    }
    Lexed l;
    lex(&l, "1e 2e+ 3ex"); /* POV-Ray takes an e without digits for an exponent of 0, unless a word begins with it */
    assert_int_equal(l.list->count, 5);
    assert_true(at(&l, 0)->as.number == 1 && at(&l, 1)->as.number == 2 && at(&l, 2)->as.number == 3);
    assert_int_equal(at(&l, 3)->kind, TOKEN_WORD);
    arena_destroy(&l.arena);
}

/* Short decimals have a way of their own, which must round as strtod() does. */
static void test_decimals(void **state) {
    (void)state;
    static const char *const texts[] = {"0.1",
                                        "0.30000000000000004",
                                        "9007199254740993",
                                        "9007199254740992.5",
                                        "123456789012345",
                                        "999999999999999.9",
                                        "0.0000000000000000000001",
                                        "0.00000000000000000000012345",
                                        "000000000000000000000000000.5",
                                        "100000000000000000000000",
                                        "0.000000000000000000000000000",
                                        "1e22",
                                        "1.7976931348623157e308",
                                        "4.9e-324"};
    char text[64];
    uint64_t seed = 1;
    for (size_t i = 0; i < 20000; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        int digits = (int)(seed >> 60) + 1;
        snprintf(text, sizeof text, "%.*f", digits, (double)(seed >> 20 & 0xFFFFFFFF) / (double)(1 + (seed & 0xFFFFF)));
        const char *t = i < VTS_ARRAY_COUNT(texts) ? texts[i] : text;
        Lexed l;
        lex(&l, t);
        assert_int_equal(l.list->count, 2);
        assert_true(at(&l, 0)->as.number == strtod(t, NULL));
        arena_destroy(&l.arena);
    }
}

/* Tokens of large texts are counted beforehand, by rules that other texts than lists of numbers break. */
static void test_large_text(void **state) {
    (void)state;
    static const char *const parts[] = {"<1.5,-2,.3>,", "A.x.y.z+", "\"a, b\"", "/* a.b */", "1.2.3.4 ", "x=y ", "// a, b c\n"};
    static const uint32_t tokens[] = {9, 8, 1, 0, 3, 3, 0};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(parts); i++) {
        enum { TIMES = 20000 };
        StrBuf text = {0};
        for (int k = 0; k < TIMES; k++) strbuf_adds(&text, parts[i]);
        Lexed l;
        lex(&l, text.data);
        assert_int_equal(l.list->count, TIMES * tokens[i] + 1);
        arena_destroy(&l.arena);
        strbuf_free(&text);
    }
}

static void test_strings(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "\"a\\n\\\"b\\\\\\u00e9 // no comment\" \"two\nlines\"");
    assert_int_equal(l.diags.error_count, 0);
    assert_string_equal(at(&l, 0)->as.string->text, "a\n\"b\\\xC3\xA9 // no comment");
    assert_string_equal(at(&l, 1)->as.string->text, "two\nlines");
    arena_destroy(&l.arena);
    lex(&l, "x \"never ends\n y");
    assert_int_equal(l.diags.error_count, 1);
    assert_int_equal(l.diags.first->span.begin, 2);
    arena_destroy(&l.arena);
}

static void test_comments_and_directives(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "a /* b /* c */ d */ e // f\n # /* apart */ if #nonsense");
    assert_int_equal(l.list->count, 5);
    assert_string_equal(at(&l, 1)->as.name->text, "e");
    assert_int_equal(at(&l, 2)->kind, TOKEN_DIRECTIVE);
    assert_int_equal(at(&l, 2)->keyword, KW_if);
    assert_int_equal(at(&l, 3)->keyword, KW_NONE);
    assert_string_equal(at(&l, 3)->as.name->text, "nonsense");
    arena_destroy(&l.arena);
}

static void test_keywords_are_reserved_and_others_not(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "sphere texel Sphere <= != rgbft");
    assert_int_equal(at(&l, 0)->keyword, KW_sphere);
    assert_int_equal(at(&l, 1)->keyword, KW_NONE);
    assert_int_equal(at(&l, 2)->keyword, KW_NONE);
    assert_int_equal(at(&l, 3)->kind, TOKEN_LESS_EQUAL);
    assert_int_equal(at(&l, 4)->kind, TOKEN_NOT_EQUAL);
    assert_int_equal(keyword_class((Keyword)at(&l, 5)->keyword), KEYWORD_COLOR);
    arena_destroy(&l.arena);
}

static void test_matches(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "{ ( [ ] ) #if (A) { } #else ( ) #end }");
    assert_true(l.list->balanced);
    assert_int_equal(at(&l, 0)->match, l.list->count - 2);
    assert_int_equal(at(&l, 2)->match, 3);
    assert_int_equal(at(&l, 5)->keyword, KW_if);
    assert_int_equal(at(&l, at(&l, 5)->match)->keyword, KW_else);
    assert_false(at(&l, 5)->unbalanced);
    arena_destroy(&l.arena);
}

/* Each branch opens a brace that the text after #end closes: none of the three has a match, what is around them has. */
static void test_branches_that_open(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "{ #if (A) sphere { 0, #else box { -1, #end 2 } }");
    assert_true(l.list->balanced);
    assert_true(at(&l, 1)->unbalanced);
    assert_int_equal(at(&l, 0)->match, l.list->count - 2);
    for (uint32_t i = 1; i < l.list->count; i++)
        if (at(&l, i)->kind == '{') assert_int_equal(at(&l, i)->match, 0);
    arena_destroy(&l.arena);
}

static void test_branches_that_close(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "{ sphere { 0, 1 #if (A) } #else scale 2 } #end }");
    assert_true(l.list->balanced);
    assert_int_equal(at(&l, 2)->match, 0);
    assert_int_equal(at(&l, 0)->match, l.list->count - 2);
    arena_destroy(&l.arena);
}

static void test_garbage_is_kept_for_the_parser(void **state) {
    (void)state;
    Lexed l;
    lex(&l, "#if (0) \xC3\xA9 $ @ #end");
    assert_int_equal(l.diags.error_count, 0);
    assert_int_equal(at(&l, 4)->kind, '$');
    arena_destroy(&l.arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_decimals),
        cmocka_unit_test(test_large_text),
        cmocka_unit_test(test_strings),
        cmocka_unit_test(test_comments_and_directives),
        cmocka_unit_test(test_keywords_are_reserved_and_others_not),
        cmocka_unit_test(test_matches),
        cmocka_unit_test(test_branches_that_open),
        cmocka_unit_test(test_branches_that_close),
        cmocka_unit_test(test_garbage_is_kept_for_the_parser),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
