/* How diagnostics are kept: cascades, repetitions, limits; and what counts as a character. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "base/diag.h"
#include "base/utf8.h"

#include <string.h>

typedef struct Fixture {
    Arena arena;
    SourceSet sources;
    DiagList diags;
    const SourceFile *file;
} Fixture;

static void begin(Fixture *f) {
    arena_init(&f->arena, NULL, 0);
    source_set_init(&f->sources, &f->arena);
    diag_init(&f->diags, &f->arena, &f->sources);
    f->file = source_add_text(&f->sources, "text", "one two\nthree\n", 14);
}

static Span at(const Fixture *f, uint32_t begin_at) { return (Span){f->file->id, begin_at, begin_at + 1}; }

static void test_second_error_at_a_place_is_dropped_but_counts_as_failure(void **state) {
    (void)state;
    Fixture f;
    begin(&f);
    assert_non_null(diag_error(&f.diags, at(&f, 4), "first"));
    assert_null(diag_error(&f.diags, at(&f, 4), "second"));
    assert_int_equal(f.diags.error_count, 1);
    assert_int_equal(f.diags.failures, 2);
    arena_destroy(&f.arena);
}

static void test_errors_before_on_the_line(void **state) {
    (void)state;
    Fixture f;
    begin(&f);
    diag_error(&f.diags, at(&f, 4), "first");
    assert_true(diag_error_before(&f.diags, at(&f, 6)));
    assert_false(diag_error_before(&f.diags, at(&f, 0)));
    assert_false(diag_error_before(&f.diags, at(&f, 9)));
    arena_destroy(&f.arena);
}

static void test_a_loop_warns_once(void **state) {
    (void)state;
    Fixture f;
    begin(&f);
    for (int i = 0; i < 5; i++) diag_warning(&f.diags, at(&f, 4), "pass %d", i);
    assert_non_null(diag_warning(&f.diags, at(&f, 9), "elsewhere"));
    assert_int_equal(f.diags.kept_warnings, 2);
    assert_int_equal(f.diags.warning_count, 6);
    assert_string_equal(f.diags.first->message, "pass 0");
    assert_string_equal(f.diags.first->format, "pass %d");
    arena_destroy(&f.arena);
}

static void test_errors_past_the_limit_are_counted(void **state) {
    (void)state;
    Fixture f;
    begin(&f);
    f.diags.error_limit = 3;
    for (uint32_t i = 0; i < 10; i++) diag_error(&f.diags, at(&f, i), "error");
    size_t kept = 0;
    for (const Diagnostic *d = f.diags.first; d; d = d->next) kept++;
    assert_int_equal(kept, 3);
    assert_int_equal(f.diags.error_count, 10);
    assert_true(diag_full(&f.diags));
    arena_destroy(&f.arena);
}

static void test_characters(void **state) {
    (void)state;
    static const struct {
        const char *text;
        size_t size;
    } cases[] = {{"a", 1},
                 {"\xC3\xA4", 2},
                 {"\xE2\x88\x9E", 3},
                 {"\xF0\x9F\x8C\xBF", 4},
                 {"\xC3", 0},
                 {"\x80", 0},
                 {"\xC0\xAF", 0},
                 {"\xE0\x80\xAF", 0},
                 {"\xED\xA0\x80", 0},
                 {"\xF4\x90\x80\x80", 0},
                 {"\xF0\x80\x80\xAF", 0},
                 {"\xFF", 0},
                 {"", 0}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++)
        assert_int_equal(utf8_size(cases[i].text, strlen(cases[i].text)), cases[i].size);
    assert_int_equal(utf8_size("\xE2\x88\x9E", 2), 0);
}

/* The excerpt of any bytes is valid UTF-8. */
static void test_excerpts_of_broken_text_are_whole(void **state) {
    (void)state;
    char line[400];
    for (size_t i = 0; i < sizeof line; i++) line[i] = (char)(0x7F + i % 0x81);
    Fixture f;
    begin(&f);
    f.file = source_add_text(&f.sources, "broken", line, sizeof line);
    for (uint32_t i = 0; i < sizeof line; i += 7) {
        StrBuf out = {0};
        Diagnostic *d = diag_error(&f.diags, (Span){f.file->id, i, i + 90}, "here");
        if (d) diag_format(&out, &f.sources, d, false);
        for (size_t k = 0, n; k < out.size; k += n) {
            n = utf8_size(out.data + k, out.size - k);
            assert_true(n > 0);
        }
        strbuf_free(&out);
    }
    arena_destroy(&f.arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_second_error_at_a_place_is_dropped_but_counts_as_failure),
        cmocka_unit_test(test_errors_before_on_the_line),
        cmocka_unit_test(test_a_loop_warns_once),
        cmocka_unit_test(test_errors_past_the_limit_are_counted),
        cmocka_unit_test(test_characters),
        cmocka_unit_test(test_excerpts_of_broken_text_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
