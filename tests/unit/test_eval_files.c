/* What the evaluator may touch, and how it ends: files and folders, interruption, declared values, dumps, running out of memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "eval/eval.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct Run {
    Arena session, parse, scene_arena;
    SourceSet sources;
    DiagList diags;
    Interner names;
    const Scene *scene;
    EvalStatus status;
    StrBuf text[4];
    char folder[64];
} Run;

static void on_text(void *context, EvalStream stream, const char *text) {
    strbuf_adds(&((Run *)context)->text[stream], text);
}

static void write_file(const Run *run, const char *name, const char *text, size_t size) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", run->folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, size, f), size);
    fclose(f);
}

static void begin(Run *run) {
    *run = (Run){0};
    strcpy(run->folder, "/tmp/vts_eval_XXXXXX");
    assert_non_null(mkdtemp(run->folder));
}

static void evaluate_with(Run *run, const char *text, EvalOptions o, MemoryBudget *budget) {
    char path[128];
    write_file(run, "main.vts", text, strlen(text));
    snprintf(path, sizeof path, "%s/main.vts", run->folder);
    arena_init(&run->session, NULL, 0);
    arena_init(&run->parse, budget, 0);
    arena_init(&run->scene_arena, budget, 0);
    source_set_init(&run->sources, &run->session);
    diag_init(&run->diags, &run->session, &run->sources);
    interner_init(&run->names, &run->session);
    o.on_text = on_text;
    o.context = run;
    run->status = eval_file(path, &o, &run->sources, &run->diags, &run->names, &run->parse, &run->scene_arena,
                            &run->scene);
}

static void evaluate(Run *run, const char *text, EvalOptions o) { evaluate_with(run, text, o, NULL); }

static void end(Run *run) {
    for (int i = 0; i < 4; i++) strbuf_free(&run->text[i]);
    arena_destroy(&run->scene_arena);
    arena_destroy(&run->parse);
    arena_destroy(&run->session);
    char command[256];
    snprintf(command, sizeof command, "rm -r %s", run->folder);
    assert_int_equal(system(command), 0);
}

static const char *debug_text(const Run *run) {
    const char *text = run->text[EVAL_STREAM_DEBUG].data;
    return text ? text : "";
}

static bool has_error(const Run *run, const char *part) {
    for (const Diagnostic *d = run->diags.first; d; d = d->next)
        if (d->severity == SEVERITY_ERROR && strstr(d->message, part)) return true;
    return false;
}

static void test_values_from_outside(void **state) {
    (void)state;
    Run run;
    const struct EvalDeclare declares[] = {{"Trees", "12"}, {"Kind", "oak"}};
    begin(&run);
    evaluate(&run,
             "#debug concat(str(Trees, 0, 0), Kind, str(clock, 0, 1), str(image_width/image_height, 0, 1), "
             "str(frame_number, 0, 0))",
             (EvalOptions){.declares = declares,
                           .declare_count = 2,
                           .clock = 0.5,
                           .image_width = 4,
                           .image_height = 2,
                           .frame_number = 7});
    assert_int_equal(run.status, EVAL_OK);
    assert_string_equal(debug_text(&run), "12oak0.52.07");
    assert_non_null(run.scene);
    end(&run);
}

static void test_reading_stays_in_its_folders(void **state) {
    (void)state;
    Run run;
    begin(&run);
    evaluate(&run, "#include \"/etc/passwd\"\n", (EvalOptions){0});
    assert_int_equal(run.status, EVAL_FAILED);
    assert_true(has_error(&run, "may not read"));
    end(&run);
    begin(&run);
    evaluate(&run, "#fopen F \"../../etc/passwd\" read\n", (EvalOptions){0});
    assert_true(has_error(&run, "may not read"));
    end(&run);
    begin(&run); /* not even through a link */
    char link_path[128];
    snprintf(link_path, sizeof link_path, "%s/link.inc", run.folder);
    assert_int_equal(symlink("/etc/passwd", link_path), 0);
    evaluate(&run, "#include \"link.inc\"\n", (EvalOptions){0});
    assert_true(has_error(&run, "may not read"));
    end(&run);
}

static void test_writing_needs_permission(void **state) {
    (void)state;
    static const char text[] = "#fopen F \"out.txt\" write #write (F, 1, \",\", <1, 2>) #fclose F\n"
                               "#fopen F \"out.txt\" read #read (F, A, B) #debug str(B.y, 0, 0)\n";
    Run run;
    begin(&run);
    evaluate(&run, text, (EvalOptions){0});
    assert_true(has_error(&run, "may not write"));
    end(&run);
    begin(&run);
    evaluate(&run, text, (EvalOptions){.keep_writes_in_memory = true});
    assert_int_equal(run.status, EVAL_OK);
    assert_string_equal(debug_text(&run), "2");
    char path[128];
    snprintf(path, sizeof path, "%s/out.txt", run.folder);
    assert_int_not_equal(access(path, F_OK), 0);
    end(&run);
    begin(&run);
    const char *const folders[] = {run.folder};
    evaluate(&run, text, (EvalOptions){.allow_write = folders, .allow_write_count = 1});
    assert_int_equal(run.status, EVAL_OK);
    snprintf(path, sizeof path, "%s/out.txt", run.folder);
    assert_int_equal(access(path, F_OK), 0);
    end(&run);
}

static void test_files_that_are_no_scenes(void **state) {
    (void)state;
    Run run;
    begin(&run);
    evaluate(&run, "#include \"binary.inc\"\n", (EvalOptions){0});
    assert_true(has_error(&run, "there is no file"));
    end(&run);
    begin(&run);
    write_file(&run, "binary.inc", "\0\1\2\0sphere", 10);
    evaluate(&run, "#include \"binary.inc\"\n", (EvalOptions){0});
    assert_int_equal(run.diags.error_count, 1);
    assert_true(has_error(&run, "zero bytes"));
    end(&run);
    begin(&run);
    evaluate(&run, "// nothing\n", (EvalOptions){0});
    assert_int_equal(run.status, EVAL_OK);
    assert_int_equal(run.diags.warning_count, 1);
    end(&run);
    begin(&run);
    evaluate(&run, "#include \"main.vts\"\n", (EvalOptions){0}); /* itself */
    assert_true(has_error(&run, "nested more than"));
    end(&run);
}

static void test_interruption(void **state) {
    (void)state;
    Run run;
    atomic_bool now = true;
    begin(&run);
    evaluate(&run, "#while (true) #end", (EvalOptions){.interrupted = &now});
    assert_int_equal(run.status, EVAL_INTERRUPTED);
    end(&run);
}

static void test_dumps(void **state) {
    (void)state;
    Run run;
    begin(&run);
    evaluate(&run, "sphere { 0, 1 }", (EvalOptions){.print_tokens = true});
    assert_string_equal(run.text[EVAL_STREAM_STATISTICS].data,
                        "1:1 keyword sphere\n1:8 symbol {\n1:10 number 0\n1:11 symbol ,\n1:13 number 1\n1:15 "
                        "symbol }\n1:16 end \n");
    end(&run);
    begin(&run);
    evaluate(&run, "#declare A = 1 + x*2;", (EvalOptions){.print_ast = true});
    assert_string_equal(
        run.text[EVAL_STREAM_STATISTICS].data,
        "declare\n  name A\n  binary +\n    number 1\n    binary *\n      constant x\n      number 2\n");
    end(&run);
}

static void jump(void *context) { longjmp(*(jmp_buf *)context, 1); }

/* At whatever moment memory ends, the jump leaves nothing behind that a sanitizer would find. */
static void test_running_out_of_memory(void **state) {
    (void)state;
    for (volatile size_t limit = 100000; limit < 1200000; limit += 130000) {
        Run run;
        jmp_buf here;
        MemoryBudget budget = {.limit = limit, .on_exhausted = jump, .context = &here};
        begin(&run);
        if (setjmp(here) == 0)
            evaluate_with(&run,
                          "#fopen F \"out.txt\" write #declare L = array[100000]; #for (I, 0, 99999) "
                          "#declare L[I] = <I, I, I>; #end",
                          (EvalOptions){.keep_writes_in_memory = true}, &budget);
        end(&run);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_from_outside),
        cmocka_unit_test(test_reading_stays_in_its_folders),
        cmocka_unit_test(test_writing_needs_permission),
        cmocka_unit_test(test_files_that_are_no_scenes),
        cmocka_unit_test(test_interruption),
        cmocka_unit_test(test_dumps),
        cmocka_unit_test(test_running_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
