/* Places in source texts, and diagnostics as users see them. */
#include "base/diag.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct Texts {
    Arena arena;
    SourceSet sources;
    DiagList diags;
} Texts;

static int set_up(void **state) {
    Texts *t = calloc(1, sizeof *t);
    arena_init(&t->arena, NULL, 0);
    source_set_init(&t->sources, &t->arena);
    diag_init(&t->diags, &t->arena, &t->sources);
    *state = t;
    return 0;
}

static int tear_down(void **state) {
    Texts *t = *state;
    arena_destroy(&t->arena);
    free(t);
    return 0;
}

static const SourceFile *add_text(Texts *t, const char *text) { return source_add_text(&t->sources, "scene.vts", text, strlen(text)); }

static Span span_of(const SourceFile *file, const char *word) {
    const char *at = strstr(file->text, word);
    assert_non_null(at);
    uint32_t begin = (uint32_t)(at - file->text);
    return (Span){file->id, begin, begin + (uint32_t)strlen(word)};
}

/* ---- places ---- */

static void places_count_lines_and_characters(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "one\ntwo three\r\n\tfour\n\n\xC3\xA9\xE2\x82\xAC\xF0\x9F\x8C\xB3 tree\nend");
    static const struct { const char *word; uint32_t line, column; } places[] = {
        {"one", 1, 1}, {"two", 2, 1}, {"three", 2, 5}, {"four", 3, 2}, {"tree", 5, 5}, {"end", 6, 1}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(places); i++) {
        SourcePlace p = source_locate(&t->sources, span_of(f, places[i].word));
        assert_ptr_equal(p.file, f);
        assert_int_equal(p.line, places[i].line);
        assert_int_equal(p.column, places[i].column);
    }
    SourcePlace end = source_locate(&t->sources, (Span){f->id, f->size, f->size});
    assert_int_equal(end.line, 6);
    assert_int_equal(end.column, 4);
    assert_int_equal(source_locate(&t->sources, (Span){f->id, 1u << 31, 1u << 31}).line, 6); /* past the end: the end */
    assert_null(source_locate(&t->sources, (Span){0, 5, 6}).file);
    assert_null(source_locate(&t->sources, (Span){99, 5, 6}).file);
}

/* By counting from the start, for every byte of texts that end in all ways. */
static void every_offset_is_found(void **state) {
    Texts *t = *state;
    static const char *const texts[] = {"", "\n", "a", "a\n", "\n\n\n", "a\nbb\n\nccc", "\r\n\r\nx"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(texts); i++) {
        const SourceFile *f = add_text(t, texts[i]);
        uint32_t line = 1, column = 1;
        for (uint32_t at = 0; at <= f->size; at++) {
            SourcePlace p = source_locate(&t->sources, (Span){f->id, at, at});
            assert_int_equal(p.line, line);
            assert_int_equal(p.column, column);
            column++;
            if (texts[i][at] == '\n') line++, column = 1;
        }
    }
}

static void lines_come_without_their_ends(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "one\r\ntwo\n\nlast");
    static const char *const lines[] = {"one", "two", "", "last"};
    for (uint32_t i = 0; i < 4; i++) {
        size_t size;
        const char *text = source_line(&t->sources, f, i + 1, &size);
        assert_int_equal(size, strlen(lines[i]));
        assert_memory_equal(text, lines[i], size);
    }
}

static void spans_join(void **state) {
    (void)state;
    Span a = {1, 5, 8}, b = {1, 10, 12}, other = {2, 10, 12}, joined = span_join(a, b);
    assert_true(joined.file == 1 && joined.begin == 5 && joined.end == 12);
    assert_int_equal(span_join(a, other).end, 8);
    assert_int_equal(span_join(b, a).end, 12);
}

static void files_are_loaded_once(void **state) {
    Texts *t = *state;
    char path[] = "/tmp/vts-source-XXXXXX", name[64];
    int file = mkstemp(path);
    assert_true(file >= 0);
    snprintf(name, sizeof name, "short.inc");
    assert_int_equal(write(file, "abc\n", 4), 4);
    const SourceFile *a, *b;
    assert_int_equal(source_load(&t->sources, path, name, &a), SOURCE_OK);
    assert_int_equal(source_load(&t->sources, path, NULL, &b), SOURCE_OK);
    assert_ptr_equal(a, b);
    assert_string_equal(a->text, "abc\n");
    assert_string_equal(a->name, "short.inc");
    assert_string_equal(a->path, path);
    close(file);
    remove(path);
    char binary[] = "/tmp/vts-source-XXXXXX";
    file = mkstemp(binary);
    assert_int_equal(write(file, "ab\0c", 4), 4);
    close(file);
    assert_int_equal(source_load(&t->sources, binary, NULL, &a), SOURCE_BINARY);
    remove(binary);
    assert_int_equal(source_load(&t->sources, "/nowhere/at/all", NULL, &a), SOURCE_NOT_FOUND);
    assert_int_equal(source_load(&t->sources, "/tmp", NULL, &a), SOURCE_UNREADABLE);
}

/* ---- diagnostics ---- */

static void assert_formats(Texts *t, const Diagnostic *d, const char *expected) {
    StrBuf out = {0};
    diag_format(&out, &t->sources, d, false);
    assert_string_equal(out.data, expected);
    strbuf_free(&out);
}

static void diagnostics_point_at_the_word(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "sphere {\n  0, 1\n\tpigmnet { Red }\r\n}\n");
    Diagnostic *d = diag_error(&t->diags, span_of(f, "pigmnet"), "unknown word '%s'", "pigmnet");
    diag_hint(&t->diags, d, "did you mean '%s'?", "pigment");
    diag_note(&t->diags, d, span_of(f, "sphere"), "in this block");
    assert_formats(t, d,
        "scene.vts:3:2: error: unknown word 'pigmnet'\n"
        "    3 |  pigmnet { Red }\n"
        "      |  ^~~~~~~\n"
        "      = help: did you mean 'pigment'?\n"
        "scene.vts:1:1: note: in this block\n"
        "    1 | sphere {\n"
        "      | ^~~~~~\n");
}

static void carets_count_characters(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "\"\xC3\xA9t\xC3\xA9\" \xE2\x82\xAC\xE2\x82\xAC x");
    assert_formats(t, diag_warning(&t->diags, span_of(f, "\xE2\x82\xAC\xE2\x82\xAC"), "euros"),
        "scene.vts:1:7: warning: euros\n"
        "    1 | \"\xC3\xA9t\xC3\xA9\" \xE2\x82\xAC\xE2\x82\xAC x\n"
        "      |       ^~\n");
    assert_formats(t, diag_error(&t->diags, (Span){f->id, f->size, f->size}, "the file ends here"),
        "scene.vts:1:11: error: the file ends here\n"
        "    1 | \"\xC3\xA9t\xC3\xA9\" \xE2\x82\xAC\xE2\x82\xAC x\n"
        "      |           ^\n");
    assert_formats(t, diag_error(&t->diags, (Span){0, 0, 0}, "no place"), "vts: error: no place\n");
}

static void spans_over_lines_end_with_the_first(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "ab {\n  long\n}\n");
    assert_formats(t, diag_error(&t->diags, (Span){f->id, 3, 13}, "block"),
        "scene.vts:1:4: error: block\n"
        "    1 | ab {\n"
        "      |    ^\n");
}

static void long_lines_are_shown_in_part(void **state) {
    Texts *t = *state;
    char text[3001];
    memset(text, 'a', 3000);
    text[3000] = 0;
    memcpy(text + 2000, "HERE", 4);
    const SourceFile *f = add_text(t, text);
    StrBuf out = {0};
    diag_format(&out, &t->sources, diag_error(&t->diags, span_of(f, "HERE"), "far"), false);
    assert_true(out.size < 700);
    const char *here = strstr(out.data, "HERE"), *line = strstr(out.data, "    1 | "), *caret = strstr(out.data, "^~~~");
    const char *caret_line = caret;
    while (caret_line[-1] != '\n') caret_line--;
    assert_non_null(here);
    /* The ellipsis is one character of three bytes. */
    assert_int_equal(here - line - 2, caret - caret_line);
    strbuf_free(&out);
}

static void cascades_and_floods_are_kept_short(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "a b c d e f g h i j k l m n o p q r s t u v w x y z");
    assert_non_null(diag_error(&t->diags, (Span){f->id, 0, 1}, "first"));
    assert_null(diag_error(&t->diags, (Span){f->id, 0, 1}, "again at the same place"));
    assert_non_null(diag_warning(&t->diags, (Span){f->id, 0, 1}, "a warning may be there too"));
    for (uint32_t i = 1; i < 26; i++) diag_error(&t->diags, (Span){f->id, 2 * i, 2 * i + 1}, "error %u", i);
    assert_int_equal(t->diags.error_count, 26);
    assert_int_equal(t->diags.warning_count, 1);
    assert_true(diag_full(&t->diags));
    size_t kept = 0;
    for (const Diagnostic *d = t->diags.first; d; d = d->next) kept += d->severity == SEVERITY_ERROR;
    assert_int_equal(kept, 20);
    diag_note(&t->diags, NULL, (Span){0, 0, 0}, "nobody");
    diag_hint(&t->diags, NULL, "nobody");
}

static void colours_only_when_asked(void **state) {
    Texts *t = *state;
    const SourceFile *f = add_text(t, "word");
    const Diagnostic *d = diag_error(&t->diags, span_of(f, "word"), "m");
    StrBuf out = {0};
    diag_format(&out, &t->sources, d, true);
    assert_string_equal(out.data, "scene.vts:1:1: \033[1;31merror:\033[0m m\n    1 | word\n      | \033[1;32m^~~~\033[0m\n");
    strbuf_free(&out);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(places_count_lines_and_characters, set_up, tear_down),
        cmocka_unit_test_setup_teardown(every_offset_is_found, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lines_come_without_their_ends, set_up, tear_down),
        cmocka_unit_test(spans_join),
        cmocka_unit_test_setup_teardown(files_are_loaded_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(diagnostics_point_at_the_word, set_up, tear_down),
        cmocka_unit_test_setup_teardown(carets_count_characters, set_up, tear_down),
        cmocka_unit_test_setup_teardown(spans_over_lines_end_with_the_first, set_up, tear_down),
        cmocka_unit_test_setup_teardown(long_lines_are_shown_in_part, set_up, tear_down),
        cmocka_unit_test_setup_teardown(cascades_and_floods_are_kept_short, set_up, tear_down),
        cmocka_unit_test_setup_teardown(colours_only_when_asked, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
