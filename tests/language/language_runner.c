/* Runs programs of the language and compares what their #debug prints and which errors they meet with what they say themselves:
 *   // expect: TEXT              the next line printed
 *   // expect error: LINE TEXT   an error on that line whose message holds TEXT
 *   // expect warning: LINE TEXT
 * or with the file PROGRAM.expected beside them, which holds the printed lines that begin with "> ".
 * Each program runs twice, the second time with every statement expanded before it is read: both must agree.
 *   language_runner [--show] FILE…            --show prints instead of comparing
 *   language_runner --shared FOLDER           all .pov files there, or 77 where there is no such folder */
#include "eval/eval.h"
#include "hooks.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Run {
    StrBuf printed, problems;
    EvalStatus status;
    size_t errors;
} Run;

static void on_text(void *context, EvalStream stream, const char *text) {
    if (stream == EVAL_STREAM_DEBUG) strbuf_adds(&((Run *)context)->printed, text);
}

static char *read_whole(const char *path) {
    FILE *f = fopen(path, "rb");
    if (!f) return NULL;
    StrBuf text = {0};
    char piece[4096];
    for (size_t got; (got = fread(piece, 1, sizeof piece, f)) > 0;) strbuf_add(&text, piece, got);
    fclose(f);
    if (!text.data) strbuf_adds(&text, "");
    return text.data;
}

/* The .pov programs of others are read with POV-Ray's include files where those are installed; ours need nothing but our own. */
static const char *const include_dirs[] = {"/usr/share/povray-3.7/include", "/usr/share/povray/include", VTS_STDLIB_DIR};
static const char *const stdlib_dirs[] = {VTS_STDLIB_DIR};

static void check_diagnostics(Run *run, const char *text, SourceSet *sources, const DiagList *diags) {
    size_t expected = 0;
    for (const char *p = text; (p = strstr(p, "// expect ")); p += 10) {
        char kind[16] = "";
        unsigned line = 0;
        int used = 0;
        if (sscanf(p, "// expect %15[a-z]: %u %n", kind, &line, &used) < 2) continue;
        char wanted[256];
        snprintf(wanted, sizeof wanted, "%.*s", (int)strcspn(p + used, "\r\n"), p + used);
        Severity severity = strcmp(kind, "error") == 0 ? SEVERITY_ERROR : SEVERITY_WARNING;
        bool found = false;
        for (const Diagnostic *d = diags->first; d && !found; d = d->next)
            found = d->severity == severity && source_locate(sources, d->span).line == line &&
                    strstr(d->message, wanted);
        if (!found) strbuf_addf(&run->problems, "no %s on line %u: %s\n", kind, line, wanted);
        expected += severity == SEVERITY_ERROR;
    }
    if (diags->error_count == expected) return;
    strbuf_addf(&run->problems, "%zu errors, %zu expected\n", diags->error_count, expected);
    for (const Diagnostic *d = diags->first; d; d = d->next) diag_format(&run->problems, sources, d, false);
}

/* The value of KEY=… or +Kn of a first line `// povray-options: …`. */
static void read_options(const char *text, EvalOptions *o, struct EvalDeclare *declares) {
    static char names[8][64], values[8][64];
    const char *p = strncmp(text, "// povray-options:", 18) == 0 ? text + 18 : NULL;
    if (!p) return;
    char line[256];
    snprintf(line, sizeof line, "%.*s", (int)strcspn(p, "\r\n"), p);
    for (char *word = strtok(line, " "); word; word = strtok(NULL, " ")) {
        if (sscanf(word, "+W%d", &o->image_width) == 1 || sscanf(word, "+H%d", &o->image_height) == 1)
            continue;
        if (o->declare_count < 8 &&
            sscanf(word, "Declare=%63[^=]=%63s", names[o->declare_count], values[o->declare_count]) == 2) {
            declares[o->declare_count] =
                (struct EvalDeclare){names[o->declare_count], values[o->declare_count]};
            o->declares = declares;
            o->declare_count++;
        }
    }
}

static void run_program(Run *run, const char *path, const char *text, bool show, bool expand) {
    Arena session, parse, scene_arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    const Scene *scene;
    struct EvalDeclare declares[8];
    arena_init(&session, NULL, 0);
    arena_init(&parse, NULL, 0);
    arena_init(&scene_arena, NULL, 0);
    source_set_init(&sources, &session);
    diag_init(&diags, &session, &sources);
    interner_init(&names, &session);
    EvalGeometry geometry = hooks_geometry(&session, NULL);
    const char *suffix = strrchr(path, '.');
    bool ours = suffix && strcmp(suffix, ".vts") == 0;
    EvalOptions o = {.geometry = &geometry,
                     .include_dirs = ours ? stdlib_dirs : include_dirs,
                     .include_dir_count = ours ? VTS_ARRAY_COUNT(stdlib_dirs) : VTS_ARRAY_COUNT(include_dirs),
                     .image_width = 4,
                     .image_height = 4,
                     .limits = eval_limits_default(),
                     .keep_writes_in_memory = true,
                     .on_text = on_text,
                     .context = run,
                     .expand_always = expand};
    read_options(text, &o, declares);
    run->status = eval_file(path, &o, &sources, &diags, &names, &parse, &scene_arena, &scene);
    run->errors = diags.error_count;
    if (show) {
        fputs(run->printed.data ? run->printed.data : "", stdout);
        StrBuf out = {0};
        for (const Diagnostic *d = diags.first; d; d = d->next) diag_format(&out, &sources, d, false);
        fputs(out.data ? out.data : "", stdout);
        strbuf_free(&out);
    } else {
        check_diagnostics(run, text, &sources, &diags);
    }
    arena_destroy(&scene_arena);
    arena_destroy(&parse);
    arena_destroy(&session);
}

static void expected_from_comments(const char *text, StrBuf *out) {
    for (const char *p = text; (p = strstr(p, "// expect: ")); p += 11) {
        strbuf_add(out, p + 11, strcspn(p + 11, "\r\n"));
        strbuf_addc(out, '\n');
    }
}

/* The lines of `printed` that begin with "> ". */
static void marked_lines(const char *printed, StrBuf *out) {
    for (const char *p = printed; p && *p;) {
        size_t n = strcspn(p, "\n");
        if (strncmp(p, "> ", 2) == 0) {
            strbuf_add(out, p, n);
            strbuf_addc(out, '\n');
        }
        p += n + (p[n] == '\n');
    }
}

static bool test_road(const char *path, bool show, bool expand) {
    char *text = read_whole(path);
    if (!text) {
        printf("%s: cannot be read\n", path);
        return false;
    }
    Run run = {0};
    StrBuf wanted = {0}, got = {0};
    run_program(&run, path, text, show, expand);
    char expected_path[4096];
    snprintf(expected_path, sizeof expected_path, "%.*s.expected", (int)(strrchr(path, '.') - path), path);
    char *expected = read_whole(expected_path);
    if (expected) {
        strbuf_adds(&wanted, expected);
        marked_lines(run.printed.data, &got);
    } else {
        expected_from_comments(text, &wanted);
        strbuf_adds(&got, run.printed.data ? run.printed.data : "");
    }
    const char *w = wanted.data ? wanted.data : "", *g = got.data ? got.data : "";
    bool ok = show || (strcmp(w, g) == 0 && !run.problems.size);
    if (!ok) {
        printf("FAILED %s%s\n", path, expand ? " (expanded)" : "");
        if (strcmp(w, g) != 0) printf("--- expected\n%s--- printed\n%s", w, g);
        if (run.problems.data) printf("%s", run.problems.data);
    }
    free(text);
    free(expected);
    strbuf_free(&wanted);
    strbuf_free(&got);
    strbuf_free(&run.printed);
    strbuf_free(&run.problems);
    return ok;
}

static bool test_program(const char *path, bool show) {
    return test_road(path, show, false) && (show || test_road(path, show, true));
}

static int is_program(const struct dirent *entry) {
    const char *dot = strrchr(entry->d_name, '.');
    return dot && strcmp(dot, ".pov") == 0;
}

/* Programs that need more than the evaluator: several frames, the geometry of objects, pigments as functions, fonts, or noises that no
 * description gives. */
static bool needs_more(const char *name) {
    static const char *const numbers[] = {"202", "225", "226", "227", "237", "250"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++)
        if (strncmp(name, numbers[i], 3) == 0) return true;
    return false;
}

static int test_folder(const char *folder) {
    const char *shared = getenv("VTS_SHARED");
    char path[4096];
    if (shared)
        snprintf(path, sizeof path, "%s/conformance/language", shared);
    else
        snprintf(path, sizeof path, "%s", folder);
    struct dirent **entries;
    int count = scandir(path, &entries, is_program, alphasort);
    if (count < 0) return 77;
    int passed = 0, skipped = 0;
    for (int i = 0; i < count; i++) {
        if (needs_more(entries[i]->d_name)) {
            skipped++;
            free(entries[i]);
            continue;
        }
        char file[8192];
        snprintf(file, sizeof file, "%s/%s", path, entries[i]->d_name);
        passed += test_program(file, false);
        free(entries[i]);
    }
    free(entries);
    printf("%d of %d programs passed, %d need more than the evaluator\n", passed, count, skipped);
    return passed + skipped == count ? 0 : 1;
}

int main(int argc, char **argv) {
    bool show = argc > 1 && strcmp(argv[1], "--show") == 0;
    if (argc > 2 && strcmp(argv[1], "--shared") == 0) return test_folder(argv[2]);
    int failed = 0;
    for (int i = show ? 2 : 1; i < argc; i++) failed += !test_program(argv[i], show);
    printf("%d of %d programs failed\n", failed, argc - (show ? 2 : 1));
    return failed ? 1 : 0;
}
