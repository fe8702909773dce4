/* Programs, with small limits: no crash, no leak, always an end. The road that expands statements before they are read takes every
 * second length of text. The program lies in a folder of its own, so that the files that it names are its own, too. */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "fuzz.h"

#include "eval/eval.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void on_text(void *context, EvalStream stream, const char *text) {
    (void)stream;
    *(size_t *)context += strlen(text);
}

static void on_exhausted(void *context) { longjmp(*(jmp_buf *)context, 1); }

static const char *own_folder(void) {
    static char folder[] = "/tmp/vts-fuzz-XXXXXX"; /* one for all texts of a process */
    static bool made;
    if (!made) made = mkdtemp(folder) != NULL;
    return folder;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char path[64];
    snprintf(path, sizeof path, "%s/scene.vts", own_folder());
    FILE *f = fopen(path, "wb");
    if (!f) return 0;
    fwrite(data, 1, size, f);
    fclose(f);
    jmp_buf jump;
    MemoryBudget budget = {.limit = 256u << 20, .on_exhausted = on_exhausted, .context = &jump};
    Arena session, parse, scene_arena;
    arena_init(&session, NULL, 0);
    arena_init(&parse, &budget, 0);
    arena_init(&scene_arena, &budget, 0);
    if (setjmp(jump) == 0) {
        SourceSet sources;
        DiagList diags;
        Interner names;
        const Scene *scene;
        size_t printed = 0;
        source_set_init(&sources, &session);
        diag_init(&diags, &session, &sources);
        interner_init(&names, &session);
        EvalOptions o = {.image_width = 4,
                         .image_height = 3,
                         .keep_writes_in_memory = true,
                         .on_text = on_text,
                         .context = &printed,
                         .expand_always = size % 2 == 1,
                         .limits = {.loops = 300,
                                    .steps = 3000,
                                    .written_bytes = 100000,
                                    .recursion = 20,
                                    .include_depth = 4,
                                    .array_elements = 10000,
                                    .mesh_vertices = 5000,
                                    .string_bytes = 10000}};
        eval_file(path, &o, &sources, &diags, &names, &parse, &scene_arena, &scene);
        StrBuf out = {0};
        for (const Diagnostic *d = diags.first; d; d = d->next) diag_format(&out, &sources, d, false);
        strbuf_free(&out);
    }
    arena_destroy(&scene_arena);
    arena_destroy(&parse);
    arena_destroy(&session);
    remove(path);
    return 0;
}
