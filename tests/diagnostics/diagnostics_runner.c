/* diagnostics_runner PROGRAM.vts…: compares the diagnostics of each with PROGRAM.expected, or (BLESS=1) writes it. */
#include "eval/eval.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void diagnose(const char *path, StrBuf *out) {
    Arena session, parse, scene_arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    const Scene *scene;
    arena_init(&session, NULL, 0);
    arena_init(&parse, NULL, 0);
    arena_init(&scene_arena, NULL, 0);
    source_set_init(&sources, &session);
    diag_init(&diags, &session, &sources);
    interner_init(&names, &session);
    EvalLimits limits = {
        .loops = 1000, .recursion = 50, .include_depth = 8, .array_elements = 100000, .string_bytes = 10000};
    EvalOptions o = {.image_width = 4, .image_height = 3, .limits = limits};
    EvalStatus status = eval_file(path, &o, &sources, &diags, &names, &parse, &scene_arena, &scene);
    for (const Diagnostic *d = diags.first; d; d = d->next) diag_format(out, &sources, d, false);
    strbuf_addf(out, "%s\n", status == EVAL_OK ? "accepted" : "rejected");
    arena_destroy(&scene_arena);
    arena_destroy(&parse);
    arena_destroy(&session);
}

static bool matches(const char *path, const StrBuf *got) {
    StrBuf text = {0};
    FILE *f = fopen(path, "rb");
    char piece[4096];
    for (size_t n; f && (n = fread(piece, 1, sizeof piece, f)) > 0;) strbuf_add(&text, piece, n);
    if (f) fclose(f);
    bool same = text.data && strcmp(text.data, got->data) == 0;
    if (!same) printf("--- %s\n%s--- now\n%s", path, text.data ? text.data : "", got->data);
    strbuf_free(&text);
    return same;
}

static bool bless(const char *path, const StrBuf *got) {
    FILE *f = fopen(path, "wb");
    if (!f) return false;
    bool ok = fwrite(got->data, 1, got->size, f) == got->size;
    return fclose(f) == 0 && ok;
}

int main(int argc, char **argv) {
    int failed = 0;
    for (int i = 1; i < argc; i++) {
        StrBuf got = {0};
        char expected[4096];
        snprintf(expected, sizeof expected, "%.*s.expected", (int)(strrchr(argv[i], '.') - argv[i]), argv[i]);
        diagnose(argv[i], &got);
        failed += !(getenv("BLESS") ? bless(expected, &got) : matches(expected, &got));
        strbuf_free(&got);
    }
    printf("%d of %d differ\n", failed, argc - 1);
    return failed ? 1 : 0;
}
