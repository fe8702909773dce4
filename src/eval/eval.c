#include "eval/block_setting.h"
#include "eval/eval.h"

#include "base/decimal.h"

#include "eval/eval_files.h"
#include "eval/eval_names.h"

#include <stdlib.h>
#include <string.h>

EvalLimits eval_limits_default(void) {
    return (EvalLimits){.loops = 100000000,
                        .recursion = 200,
                        .include_depth = 32,
                        .steps = 1000000000,
                        .array_elements = 64000000,
                        .mesh_vertices = 64000000,
                        .string_bytes = 64u << 20,
                        .memory_bytes = 2ull << 30,
                        .written_bytes = 256u << 20};
}

/* ---- notes of the include and macro stack ---- */

/* The macro whose text holds the span although no call of it is going on: its text was expanded into what is blamed. */
static const Macro *expanded_macro(const Eval *ev, Span span) {
    for (const Macro *m = ev->macros; m; m = m->next) {
        const TokenList *list = m->body.tokens;
        if (!m->last_call.file || list->file->id != span.file || m->body.begin >= m->body.end) continue;
        if (span.begin < list->items[m->body.begin].span.begin ||
            span.begin > list->items[m->body.end - 1].span.end)
            continue;
        for (const CallRecord *c = ev->calls; c; c = c->outer)
            if (c->macro == m->name) return NULL;
        return m;
    }
    return NULL;
}

static void add_call_notes(void *context, DiagList *list, Diagnostic *diagnostic) {
    const Eval *ev = context;
    enum { MOST_NOTES = 8 };
    int count = 0;
    const Macro *expanded = expanded_macro(ev, diagnostic->span);
    if (expanded)
        diag_note(list, diagnostic, expanded->last_call, "in macro '%s', called here", expanded->name->text);
    for (const CallRecord *c = ev->calls; c; c = c->outer, count++) {
        size_t times = 1;
        while (c->outer && c->outer->macro == c->macro && c->outer->span.file == c->span.file &&
               c->outer->span.begin == c->span.begin)
            c = c->outer, times++; /* recursion */
        if (count == MOST_NOTES && c->outer) {
            diag_note(list, diagnostic, c->span, "and further calls around this one");
            return;
        }
        if (c->macro && times > 1)
            diag_note(list, diagnostic, c->span, "in macro '%s', called here %zu times within itself",
                      c->macro->text, times);
        else if (c->macro)
            diag_note(list, diagnostic, c->span, "in macro '%s', called here", c->macro->text);
        else if (times > 1)
            diag_note(list, diagnostic, c->span, "included here %zu times within itself", times);
        else
            diag_note(list, diagnostic, c->span, "included here");
    }
}

/* ---- ParserHost of the fast road ---- */

static NameClass classify(void *context, Name name, const void **macro) {
    const Macro *m;
    NameClass class = scope_classify(context, name, &m);
    *macro = m;
    return class;
}

static Binding binding(void *context, const void *macro) { return macro_binding(context, macro); }

static bool holds_half(void *context, const TokenList *tokens, uint32_t begin, uint32_t end) {
    return macro_half_called(context, tokens, begin, end);
}

static bool is_whole(void *context, const void *macro) {
    (void)context;
    return ((const Macro *)macro)->whole;
}

static bool is_block(void *context, const void *macro) {
    (void)context;
    return ((const Macro *)macro)->is_block;
}

/* ---- includes ---- */

static TokenList *load(Eval *ev, const SourceFile *file) {
    if (file->id < ev->program_count && ev->programs[file->id]) return ev->programs[file->id]->tokens;
    TokenList *tokens = lexer_run(file, &ev->keywords, ev->parse);
    eval_program(ev, tokens);
    return tokens;
}

SourceStatus eval_load_text(Eval *ev, const char *path, Span span, const SourceFile **out) {
    SourceStatus status = source_load(ev->sources, path, NULL, out);
    switch (status) {
    case SOURCE_OK: break;
    case SOURCE_NOT_FOUND: diag_error(ev->diags, span, "there is no file '%s'", path); break;
    case SOURCE_UNREADABLE: diag_error(ev->diags, span, "'%s' cannot be read", path); break;
    case SOURCE_TOO_LARGE: diag_error(ev->diags, span, "'%s' is too large for a text", path); break;
    case SOURCE_BINARY: diag_error(ev->diags, span, "'%s' is not a text: it holds zero bytes", path); break;
    }
    return status;
}

/* The ending may be left out, as in POV-Ray. */
static const char *with_include_ending(Eval *ev, const char *name, Span span) {
    const char *path = path_find(ev, arena_printf(&ev->temp, "%s.inc", name), span, NULL, NULL);
    return path ? path : path_find(ev, arena_printf(&ev->temp, "%s.INC", name), span, NULL, NULL);
}

TokenList *eval_load_include(Eval *ev, const Node *node, Span *path_span) {
    const char *name;
    *path_span = node->as.operand.a->span;
    if (!eval_string(ev, node->as.operand.a, &name, NULL)) return NULL;
    if (ev->include_depth >= ev->options->limits.include_depth) {
        diag_error(ev->diags, *path_span, "includes are nested more than %u deep",
                   ev->options->limits.include_depth);
        ev->stopped = true;
        return NULL;
    }
    MemoryFile *written = files_in_memory(ev, name);
    if (written)
        return load(ev, source_add_text(ev->sources, name, written->text.data ? written->text.data : "",
                                        written->text.size));
    Diagnostic *refused = NULL;
    StrBuf places = {0};
    const char *path = path_find(ev, name, *path_span, &refused, &places);
    if (!path && !refused) path = with_include_ending(ev, name, *path_span);
    const SourceFile *file = NULL;
    if (!path && !refused) {
        Diagnostic *d = diag_error(ev->diags, *path_span, "there is no file '%s'", name);
        diag_hint(ev->diags, d, "looked in %s", places.data ? places.data : "no folder");
    }
    strbuf_free(&places);
    ev->build.names_missing |= !path;
    if (!path) return NULL;
    return eval_load_text(ev, path, *path_span, &file) == SOURCE_OK ? load(ev, file) : NULL;
}

/* Where the text around an include has brackets too many or too few as well, the two complete each other. */
static bool includer_is_balanced(const Eval *ev, const Node *node) {
    uint32_t file = node->span.file;
    return file >= ev->program_count || !ev->programs[file] || ev->programs[file]->tokens->balanced;
}

Flow run_include(Eval *ev, const Node *node, Sink *sink) {
    Span span;
    TokenList *tokens = eval_load_include(ev, node, &span);
    if (!tokens) return FLOW_NEXT;
    if (!tokens->balanced && !includer_is_balanced(ev, node)) return FLOW_TEXT;
    Scope scope;
    CallRecord record = {.outer = ev->calls, .span = span};
    ev->calls = &record;
    scope_enter(ev, &scope);
    ev->include_depth++;
    Body body = {.tokens = tokens, .begin = 0, .end = tokens->count - 1};
    Flow flow = run_body(ev, &body, sink);
    ev->include_depth--;
    scope_leave(ev, &scope);
    ev->calls = record.outer;
    return flow;
}

/* ---- the whole ---- */

static void declare_options(Eval *ev) {
    for (size_t i = 0; i < ev->options->declare_count; i++) {
        const char *text = ev->options->declares[i].value;
        char *end;
        double number = decimal_strtod(text, &end);
        Value v = *text && *end == '\0' ? value_float(number) : value_string(ev, text, strlen(text));
        slot_set(ev, scope_declare(ev, intern_cstr(ev->names, ev->options->declares[i].name), false), &v);
    }
}

static void init(Eval *ev, const EvalOptions *options, SourceSet *sources, DiagList *diags, Interner *names,
                 Arena *parse, Arena *scene) {
    *ev = (Eval){.options = options,
                 .sources = sources,
                 .diags = diags,
                 .names = names,
                 .parse = parse,
                 .version = 3.7,
                 .macro_stamp = 1};
    arena_init(&ev->temp, parse->budget, 0);
    arena_init(&ev->passing, parse->budget, 0);
    arena_init(&ev->blocks, parse->budget, 0);
    keyword_table_init(&ev->keywords, names, parse);
    ev->build = (BuildContext){.arena = scene, .names = names, .diags = diags, .eval = ev};
    ev->build.is_program = options->is_program;
    ev->build.most_vertices = options->limits.mesh_vertices;
    ev->build.time = options->time;
    ev->build.cycle = options->cycle;
    ev->build.image_aspect = options->image_width > 0 && options->image_height > 0
                                 ? (double)options->image_width / options->image_height
                                 : 4.0 / 3;
    ev->fast_host = (ParserHost){
        .context = ev, .classify = classify, .macro_binding = binding, .macro_is_whole = is_whole, .holds_half_macro = holds_half,
        .macro_is_block = is_block};
    ev->index_name = intern_cstr(names, "index");
    ev->count_name = intern_cstr(names, "count");
    ev->particles_name = intern_cstr(names, "particles");
    diags->add_context_notes = add_call_notes;
    diags->context = ev;
}

/* Words of blocks, over what the text says. */
static void take_settings(Eval *ev) {
    const EvalOptions *options = ev->options;
    BlockSetting *settings = arena_new_array(ev->build.arena, BlockSetting, options->setting_count);
    for (size_t i = 0; i < options->setting_count; i++) {
        settings[i] = block_setting_make(ev->build.arena, ev->names, options->settings[i].name, options->settings[i].value);
        settings[i].used = options->settings[i].used;
    }
    ev->build.settings = settings;
    ev->build.setting_count = options->setting_count;
}

static void release(Eval *ev) {
    MemoryBudget *budget = ev->parse->budget;
    if (budget) {
        budget->on_exhausted = ev->outer_exhausted;
        budget->context = ev->outer_context;
    }
    files_close_all(ev);
    ev->diags->add_context_notes = NULL;
    ev->diags->context = NULL;
    arena_destroy(&ev->temp);
    arena_destroy(&ev->passing);
    arena_destroy(&ev->blocks);
}

/* Running out of memory leaves this function by a jump of the caller's: what only the evaluator knows is released first. */
static void on_exhausted(void *context) {
    Eval *ev = context;
    MemoryBudget *budget = ev->parse->budget;
    release(ev);
    memory_budget_fail(budget);
}

static void watch_memory(Eval *ev) {
    MemoryBudget *budget = ev->parse->budget;
    if (!budget) return;
    ev->outer_exhausted = budget->on_exhausted;
    ev->outer_context = budget->context;
    budget->on_exhausted = on_exhausted;
    budget->context = ev;
}

static bool load_scene(Eval *ev, const char *path, const SourceFile **file, EvalStatus *status) {
    SourceStatus loaded = eval_load_text(ev, path, (Span){0}, file);
    *status = loaded == SOURCE_NOT_FOUND || loaded == SOURCE_UNREADABLE ? EVAL_NO_FILE : EVAL_FAILED;
    return loaded == SOURCE_OK;
}

static void say(Eval *ev, StrBuf *text) {
    if (ev->options->on_text)
        ev->options->on_text(ev->options->context, EVAL_STREAM_STATISTICS, text->data ? text->data : "");
    strbuf_free(text);
}

/* The tree of each statement of the file that the fast road can read; nothing is run. */
static void print_tree(Eval *ev, Program *program) {
    StrBuf out = {0};
    uint32_t end = program->tokens->count - 1;
    for (uint32_t at = 0; at < end;) {
        const Statement *s = statement_at(ev, program, at, end, NULL);
        if (s->node) ast_print(s->node, &out, 0);
        at = s->node ? s->next : at + 1;
    }
    say(ev, &out);
}

static EvalStatus evaluate(Eval *ev, const SourceFile *file, const Scene **scene) {
    TokenList *tokens = load(ev, file);
    if (ev->options->print_tokens) {
        StrBuf out = {0};
        lexer_print(tokens, ev->sources, &out);
        say(ev, &out);
        return ev->diags->error_count ? EVAL_FAILED : EVAL_OK;
    }
    if (ev->options->print_ast) {
        print_tree(ev, eval_program(ev, tokens));
        return ev->diags->error_count ? EVAL_FAILED : EVAL_OK;
    }
    ev->draft = scene_draft_create(&ev->build, file->name);
    Sink sink = {.kind = SINK_SCENE};
    Body body = {.tokens = tokens, .begin = 0, .end = tokens->count - 1};
    if (ev->diags->error_count == 0 || !diag_full(ev->diags)) {
        Flow flow = run_body(ev, &body, &sink);
        if (flow == FLOW_BREAK) {
            Diagnostic *d = diag_error(ev->diags, ev->break_end, "#break outside of a loop or #switch");
            if (ev->break_end.begin != ev->last_break.begin)
                diag_note(ev->diags, d, ev->last_break, "this #break");
        }
    }
    if (ev->interrupted) return EVAL_INTERRUPTED;
    if (ev->diags->error_count) return EVAL_FAILED;
    const Scene *finished = scene_draft_finish(ev->draft, &ev->build);
    if (!finished || ev->diags->error_count) return EVAL_FAILED;
    Scene *named = arena_copy(ev->build.arena, finished, sizeof *finished);
    named->clock = ev->options->clock;
    named->time = ev->options->time;
    named->cycle = ev->options->cycle;
    eval_name_texels(ev, named);
    *scene = named;
    return EVAL_OK;
}

EvalStatus eval_file(const char *path, const EvalOptions *options, SourceSet *sources, DiagList *diags,
                     Interner *names, Arena *parse_arena, Arena *scene_arena, const Scene **scene) {
    Eval ev;
    const SourceFile *file;
    EvalStatus status;
    Scope global;
    EvalOptions filled = *options;
    if (filled.limits.loops == 0) filled.limits = eval_limits_default();
    if (filled.limits.mesh_vertices == 0) filled.limits.mesh_vertices = eval_limits_default().mesh_vertices;
    if (filled.limits.written_bytes == 0) filled.limits.written_bytes = eval_limits_default().written_bytes;
    if (filled.limits.steps == 0) filled.limits.steps = eval_limits_default().steps;
    if (filled.limits.memory_bytes == 0) filled.limits.memory_bytes = eval_limits_default().memory_bytes;
    *scene = NULL;
    init(&ev, &filled, sources, diags, names, parse_arena, scene_arena);
    ev.stack = (uintptr_t)__builtin_frame_address(0);
    watch_memory(&ev);
    eval_set_scene_path(&ev, path);
    scope_enter(&ev, &global);
    take_settings(&ev);
    declare_options(&ev);
    if (load_scene(&ev, path, &file, &status)) status = evaluate(&ev, file, scene);
    release(&ev);
    return status;
}
