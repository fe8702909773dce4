/* diagnostics_runner ROOT PROGRAM.vts…
 *
 * Compares the diagnostics of each program with PROGRAM.expected. Where they differ because messages got better:
 * `BLESS=1 ctest -R diagnostics` writes the .expected files anew; read what changed: is it what a user needs?
 *
 * diagnostics_runner --messages ROOT PROGRAM.vts…
 *
 * Sees that all messages of the sources are explained and provoked. When it fails on your new message:
 *   1. add a row to the fitting table of doc/diagnostics.md: | `the message` | what it means | what to do |
 *      with … for each %s, %g and the like, exactly as the test prints it;
 *   2. provoke it: add a mistake to a program in this folder, or a new program, and bless it as above.
 * A message that no program can provoke (a full disk, say) stands in unprovoked.txt, with the reason.
 *
 * A program's first line may be a comment of words that say how it runs, `// how: run --limit loops=10`:
 *   run       as `vts run` does it, else as `vts check`
 *   compiled  and prepared for rendering
 *   all       without the limit of 20 errors
 *   library   with the standard library, else without any
 *   --cycle SECONDS, of a film that goes round
 *   --limit NAME=N, --set KNOB=VALUE, --declare NAME=VALUE, --allow-read DIR, --allow-write DIR */
#include "vts.c" /* for its list of diagnostics, whose formats the public interface does not show */

#include "catalogue.h"

#include <stdio.h>

typedef struct Test {
    Arena arena;
    Catalogue seen;
} Test;

#define ADVICE "What to do is said at the top of tests/diagnostics/diagnostics_runner.c.\n"

enum { MOST_PAIRS = 8 };

typedef struct How {
    bool run, compiled, all;
    VtsPair limits[MOST_PAIRS], settings[MOST_PAIRS], declares[MOST_PAIRS];
    const char *reads[MOST_PAIRS], *writes[MOST_PAIRS];
    VtsOptions options;
} How;

static VtsPair pair_of(char *text) {
    char *equals = strchr(text, '=');
    if (equals) *equals = '\0';
    return (VtsPair){text, equals ? equals + 1 : ""};
}

static void read_how(How *how, char *words) {
    VtsOptions *o = &how->options;
    for (char *rest, *w = strtok_r(words, " \n", &rest); w; w = strtok_r(NULL, " \n", &rest)) {
        how->run |= strcmp(w, "run") == 0;
        how->compiled |= strcmp(w, "compiled") == 0;
        how->all |= strcmp(w, "all") == 0;
        if (strcmp(w, "library") == 0) o->stdlib_dir = "../../stdlib"; /* programs are run in their folder */
        if (w[0] != '-') continue;
        char *value = strtok_r(NULL, " \n", &rest);
        if (!value) return;
        if (strcmp(w, "--clock") == 0) o->clock = atof(value);
        if (strcmp(w, "--cycle") == 0) o->cycle = atof(value);
        if (strcmp(w, "--limit") == 0) how->limits[o->limit_count++] = pair_of(value);
        if (strcmp(w, "--set") == 0) how->settings[o->setting_count++] = pair_of(value);
        if (strcmp(w, "--declare") == 0) how->declares[o->declare_count++] = pair_of(value);
        if (strcmp(w, "--allow-read") == 0) how->reads[o->allow_read_count++] = value;
        if (strcmp(w, "--allow-write") == 0) how->writes[o->allow_write_count++] = value;
    }
}

/* Small limits, so that programs reach them at once. */
static const VtsPair small_limits[] = {
    {"loops", "1000"}, {"recursion", "50"}, {"includes", "8"}, {"array", "100000"}, {"string", "10000"}};

static void how_to_run(const char *path, char *line, size_t size, How *how) {
    FILE *f = fopen(path, "rb");
    if (!f || !fgets(line, (int)size, f) || strncmp(line, "// how: ", 8) != 0) line[0] = '\0';
    if (f) fclose(f);
    *how = (How){.options = vts_options_default()};
    VtsOptions *o = &how->options;
    o->threads = 1;
    o->width = 4;
    o->height = 3;
    o->stdlib_dir = "";
    for (size_t i = 0; i < VTS_ARRAY_COUNT(small_limits); i++)
        how->limits[o->limit_count++] = small_limits[i];
    if (line[0]) read_how(how, line + 8);
    o->limits = how->limits;
    o->settings = how->settings;
    o->declares = how->declares;
    o->allow_read = how->reads;
    o->allow_write = how->writes;
}

static void diagnose(Test *test, const char *path, StrBuf *out) {
    char line[512];
    How how;
    how_to_run(path, line, sizeof line, &how);
    VtsSession *session = vts_session_create(&how.options, NULL);
    if (!session) return;
    if (how.all) session->diags.error_limit = SIZE_MAX;
    VtsStatus status = how.run        ? vts_run(session, path)
                       : how.compiled ? vts_dump(session, path, VTS_DUMP_COMPILED)
                                      : vts_check(session, path);
    for (const Diagnostic *d = session->diags.first; d; d = d->next) {
        catalogue_add(&test->arena, &test->seen, catalogue_message(&test->arena, d->format), path);
        diag_format(out, &session->sources, d, false);
    }
    strbuf_addf(out, "%s\n", status == VTS_OK ? "accepted" : "rejected");
    vts_session_destroy(session);
}

/* ---- expected texts ---- */

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

static int run_programs(Test *test, int count, char **programs, bool compare) {
    int failed = 0;
    for (int i = 0; i < count; i++) {
        StrBuf got = {0};
        const char *expected = arena_printf(&test->arena, "%.*s.expected",
                                            (int)(strrchr(programs[i], '.') - programs[i]), programs[i]);
        diagnose(test, programs[i], &got);
        if (compare) failed += !(getenv("BLESS") ? bless(expected, &got) : matches(expected, &got));
        strbuf_free(&got);
    }
    if (compare) printf("%d of %d programs differ\n", failed, count);
    if (failed) printf(ADVICE);
    return failed;
}

/* ---- the catalogue ---- */

static int report_missing(const Catalogue *from, const Catalogue *in, const Catalogue *or_in,
                          const char *what) {
    int missing = 0;
    for (size_t i = 0; i < from->count; i++) {
        const CatalogueEntry *e = &from->items[i];
        if (catalogue_find(in, e->message) || (or_in && catalogue_find(or_in, e->message))) continue;
        printf("%s: \"%s\" %s\n", e->place, e->message, what);
        missing++;
    }
    return missing;
}

static int check_catalogue(Test *test, const char *root) {
    Arena *a = &test->arena;
    Catalogue sources = {0}, page = {0}, unprovoked = {0};
    int failed = !catalogue_read_sources(a, arena_printf(a, "%s/src", root), &sources);
    failed += !catalogue_read_page(a, arena_printf(a, "%s/doc/diagnostics.md", root), &page);
    failed += !catalogue_read_lines(a, "unprovoked.txt", &unprovoked);
    failed += report_missing(&sources, &page, NULL, "has no row in doc/diagnostics.md");
    failed +=
        report_missing(&page, &sources, NULL, "stands in doc/diagnostics.md, but nothing says so any more");
    failed +=
        report_missing(&sources, &test->seen, &unprovoked, "is provoked by no program of tests/diagnostics");
    failed +=
        report_missing(&unprovoked, &sources, NULL, "stands in unprovoked.txt, but nothing says so any more");
    for (size_t i = 0; i < unprovoked.count; i++)
        if (catalogue_find(&test->seen, unprovoked.items[i].message))
            printf("unprovoked.txt: \"%s\" is provoked\n", unprovoked.items[i].message), failed++;
    printf("%zu messages, %zu explained, %zu provoked\n", sources.count, page.count, test->seen.count);
    if (failed) printf(ADVICE);
    return failed;
}

int main(int argc, char **argv) {
    bool messages = argc > 1 && strcmp(argv[1], "--messages") == 0;
    if (argc < 3 + messages) return 2;
    Test test = {0};
    arena_init(&test.arena, NULL, 0);
    int failed = run_programs(&test, argc - 2 - messages, argv + 2 + messages, !messages);
    if (messages) failed = check_catalogue(&test, argv[2]);
    arena_destroy(&test.arena);
    return failed ? 1 : 0;
}
