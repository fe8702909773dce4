#include "eval/block_setting.h"
#include "eval/build_parts.h"

#include <string.h>

Reader reader_begin(BuildContext *context, const EvalBlock *block) {
    if (block && block->numbers) block = block_with_items(context->arena, block);
    return (Reader){.context = context, .block = block};
}

void reader_add_table(Reader *reader, const WordRule *rules, size_t count, void *target) {
    reader->tables[reader->table_count++] = (WordTable){rules, count, target};
}

Reader reader_nested(Reader *parent, const EvalBlock *body) { return reader_begin(parent->context, body); }

bool reader_end_nested(Reader *parent, Reader *nested) {
    parent->failed |= nested->failed;
    return !nested->failed;
}

Diagnostic *reader_error(Reader *reader, Span span, const char *format, ...) {
    va_list args;
    va_start(args, format);
    Diagnostic *diagnostic = diag_error_va(reader->context->diags, span, format, args);
    va_end(args);
    reader->failed = true;
    return diagnostic;
}

Span reader_after(const Reader *reader, Span span) {
    return source_blame_after(reader->context->diags->sources, span);
}

Span reader_close(const Reader *reader) {
    Span span = reader->block->span;
    if (span.end > span.begin) span.begin = span.end - 1;
    return span;
}

void reader_mismatch(Reader *reader, Span span, const char *what, const char *wanted, ValueKind found) {
    if (found == VALUE_ERROR)
        reader->failed = true; /* reported where it arose */
    else
        reader_error(reader, span, "%s takes %s, found %s", what, wanted, value_kind_text(found));
}

/* Each word once, where it stood first: a texture that a loop makes out of itself would list its words without end. */
void inert_add(const BuildContext *context, const InertNote **list, const char *word, Span span) {
    for (const InertNote *known = *list; known; known = known->next)
        if (strcmp(known->word, word) == 0) return;
    InertNote *note = arena_new(context->arena, InertNote);
    *note = (InertNote){word, span, *list};
    *list = note;
}

/* ---- items ---- */

bool item_as_word(const BlockItem *item, Word *out) {
    if (item->kind == ITEM_WORD) {
        *out = (Word){item->word->text, item->word_span,      item->span,
                      item->arguments,  item->argument_count, item->body};
        return true;
    }
    if (item->kind != ITEM_VALUE || item->value.kind != VALUE_BLOCK) return false;
    const EvalBlock *body = item->value.as.block;
    *out = (Word){body->word->text, body->word_span, item->span, NULL, 0, body};
    return true;
}

const BlockItem *reader_peek(const Reader *reader) {
    return reader->next < reader->block->count ? &reader->block->items[reader->next] : NULL;
}

bool reader_take_word(Reader *reader, const char *text, Word *out) {
    const BlockItem *item = reader_peek(reader);
    if (!item || !item_as_word(item, out) || strcmp(out->text, text) != 0) return false;
    reader->next++;
    return true;
}

bool reader_take_value(Reader *reader, ValueKind kind, Argument *out) {
    const BlockItem *item = reader_peek(reader);
    if (!item || item->kind != ITEM_VALUE || item->value.kind != kind) return false;
    *out = (Argument){item->value, item->span};
    reader->next++;
    return true;
}

/* The closing brace: where something was still expected. */
static Span block_end(const EvalBlock *block) {
    Span end = block->span;
    if (end.end > end.begin) end.begin = end.end - 1;
    return end;
}

static const char *item_text(Reader *reader, const BlockItem *item) {
    if (!item) return "'}'";
    if (item->kind == ITEM_ENTRY) return "an entry [ … ]";
    Name word = item->kind == ITEM_WORD ? item->word : item->value.as.block->word;
    return arena_printf(reader->context->arena, "'%s'", word->text);
}

/* After an include that was not found, names are what it would have declared. */
static bool silently_undeclared(Reader *reader) {
    reader->failed |= reader->context->names_missing;
    return reader->context->names_missing;
}

void reader_expect_word(Reader *reader, const Word *word, const char *words) {
    const BlockItem *item = reader_peek(reader);
    bool take = item && item->kind == ITEM_WORD && word->count == 0;
    reader_error(reader, take ? item->word_span : word->span, "expected %s after '%s'%s%s", words, word->text,
                 take ? ", found " : "", take ? item_text(reader, item) : "");
    reader->next += take;
}

static const WordRule *find_rule(const WordTable *table, const char *text) {
    for (size_t i = 0; i < table->count; i++)
        if (strcmp(table->rules[i].text, text) == 0) return &table->rules[i];
    return NULL;
}

/* Whether a word is nobody's: neither the language's nor this block's. */
static bool is_undeclared(const Reader *reader, Name word) {
    if (eval_is_keyword(reader->context, word)) return false;
    for (size_t t = 0; t < reader->table_count; t++)
        if (find_rule(&reader->tables[t], word->text)) return false;
    return true;
}

static bool next_value(Reader *reader, const char *what, const char *wanted, Argument *out) {
    const BlockItem *item = reader_peek(reader);
    if (item && item->kind == ITEM_VALUE && item->value.kind != VALUE_BLOCK) {
        *out = (Argument){item->value, item->span};
        reader->next++;
        return true;
    }
    Span span = !item ? block_end(reader->block) : item->kind == ITEM_WORD ? item->word_span : item->span;
    if (item && item->kind == ITEM_VALUE && item->value.kind == VALUE_ERROR)
        reader->failed = true;
    else if (item && item->kind == ITEM_WORD && is_undeclared(reader, item->word))
        reader_undeclared(reader, item->word->text, span);
    else
        reader_error(reader, span, "expected %s (%s) in '%s', found %s", what, wanted,
                     reader->block->word->text, item_text(reader, item));
    return false;
}

bool reader_float(Reader *reader, const char *what, double *out, Span *span) {
    Argument argument;
    if (!next_value(reader, what, "a float", &argument)) return false;
    if (span) *span = argument.span;
    return argument_float(reader, &argument, what, out);
}

bool reader_vector(Reader *reader, const char *what, Vec3 *out, Span *span) {
    Argument argument;
    if (!next_value(reader, what, "a vector", &argument)) return false;
    if (span) *span = argument.span;
    return argument_vector(reader, &argument, what, out);
}

/* ---- promotions ---- */

bool argument_float(Reader *reader, const Argument *argument, const char *what, double *out) {
    if (argument->value.kind != VALUE_FLOAT) {
        reader_mismatch(reader, argument->span, what, "a float", argument->value.kind);
        return false;
    }
    if (!isfinite(argument->value.as.number)) {
        reader_error(reader, argument->span, "%s is not a finite number", what);
        return false;
    }
    *out = argument->value.as.number;
    return true;
}

static double component(const Value *value, size_t index) {
    return index < value->size ? value->as.components[index] : 0;
}

bool argument_vector(Reader *reader, const Argument *argument, const char *what, Vec3 *out) {
    const Value *value = &argument->value;
    if (value->kind == VALUE_FLOAT)
        *out = vec3_splat(value->as.number);
    else if (value->kind == VALUE_VECTOR && value->size <= 3)
        *out = vec3(component(value, 0), component(value, 1), component(value, 2));
    else {
        bool color = value->kind == VALUE_VECTOR || value->kind == VALUE_COLOR;
        reader_mismatch(reader, argument->span, what, color ? "a vector of 2 or 3 numbers" : "a vector",
                        color ? VALUE_COLOR : value->kind);
        return false;
    }
    if (!vec3_is_finite(*out)) {
        reader_error(reader, argument->span, "%s has a component that is not a finite number", what);
        return false;
    }
    return true;
}

bool argument_color(Reader *reader, const Argument *argument, const char *what, Color *out) {
    const Value *value = &argument->value;
    if (value->kind == VALUE_FLOAT)
        *out = (Color){value->as.number, value->as.number, value->as.number, 0, 0};
    else if (value->kind == VALUE_VECTOR || value->kind == VALUE_COLOR)
        *out = (Color){component(value, 0), component(value, 1), component(value, 2), component(value, 3),
                       component(value, 4)};
    else {
        reader_mismatch(reader, argument->span, what, "a colour", value->kind);
        return false;
    }
    if (!isfinite(out->red + out->green + out->blue + out->filter + out->transmit)) {
        reader_error(reader, argument->span, "%s has a component that is not a finite number", what);
        return false;
    }
    return true;
}

static const char *components_text(int components) {
    return components == 1 ? "a float" : "a vector <…, …, …>";
}

bool argument_function(Reader *reader, const Argument *argument, const char *what, int parameters,
                       int components, const Tape **out) {
    if (argument->value.kind != VALUE_FUNCTION) {
        reader_mismatch(reader, argument->span, what, "a function", argument->value.kind);
        return false;
    }
    const UserFunction *function = argument->value.as.function;
    if (function->parameter_count != parameters) {
        reader_error(reader, argument->span, "the function of %s takes %d parameters here, this one has %d",
                     what, parameters, function->parameter_count);
        return false;
    }
    if (tape_output_count(function->tape) != components) {
        reader_error(reader, argument->span, "the function of %s gives %s here", what,
                     components_text(components));
        return false;
    }
    *out = function->tape;
    return true;
}

/* ---- words ---- */

/* `distance 25000 rgb 1`: the evaluator cannot know that the colour is no argument of `distance`. */
static bool take_surplus(Reader *reader, const Word *word, size_t from) {
    for (size_t i = from; i < word->count; i++)
        if (!reader->on_value || !reader->on_value(reader, &word->arguments[i], reader->value_target))
            return false;
    return true;
}

bool word_arguments(Reader *reader, const Word *word, size_t low, size_t high) {
    const BlockItem *next = reader_peek(reader);
    if (word->count < low && next && next->kind == ITEM_WORD && is_undeclared(reader, next->word)) {
        reader_undeclared(reader, next->word->text, next->word_span); /* it was to be the value */
        reader->next++;
        return false;
    }
    if (word->count < low) {
        reader_error(reader, word->span, "too few values for '%s': expected %s%zu, found %zu", word->text,
                     low == high ? "" : "at least ", low, word->count);
        return false;
    }
    if (word->count > high && !take_surplus(reader, word, high)) {
        reader_error(reader, word->arguments[high].span,
                     "too many values for '%s': expected %s%zu, found %zu", word->text,
                     low == high ? "" : "at most ", high, word->count);
        return false;
    }
    return true;
}

static const Argument *word_argument(Reader *reader, const Word *word, size_t index, const char *wanted) {
    if (index < word->count) return &word->arguments[index];
    reader_error(reader, word->span, "'%s' needs %s%s", word->text, index ? "another value: " : "", wanted);
    return NULL;
}

static const char *quoted(Reader *reader, const Word *word) {
    return arena_printf(reader->context->arena, "'%s'", word->text);
}

bool word_float(Reader *reader, const Word *word, size_t index, double *out) {
    const Argument *argument = word_argument(reader, word, index, "a float");
    if (!argument) return false;
    if (argument->value.kind == VALUE_FLOAT && isfinite(argument->value.as.number)) {
        *out = argument->value.as.number;
        return true;
    }
    return argument_float(reader, argument, quoted(reader, word), out);
}

bool word_int(Reader *reader, const Word *word, size_t index, int *out) {
    double value;
    if (!word_float(reader, word, index, &value)) return false;
    if (value != floor(value) || fabs(value) > 2e9) {
        reader_error(reader, word->arguments[index].span, "'%s' takes a whole number, found %g", word->text,
                     value);
        return false;
    }
    *out = (int)value;
    return true;
}

bool word_vector(Reader *reader, const Word *word, size_t index, Vec3 *out) {
    const Argument *argument = word_argument(reader, word, index, "a vector");
    if (!argument) return false;
    /* The common cases, without a text for errors. */
    if (argument->value.kind == VALUE_FLOAT) {
        *out = vec3_splat(argument->value.as.number);
        if (vec3_is_finite(*out)) return true;
    } else if (argument->value.kind == VALUE_VECTOR && argument->value.size == 3) {
        const double *c = argument->value.as.components;
        *out = vec3(c[0], c[1], c[2]);
        if (vec3_is_finite(*out)) return true;
    }
    return argument_vector(reader, argument, quoted(reader, word), out);
}

bool word_color(Reader *reader, const Word *word, size_t index, Color *out) {
    const Argument *argument = word_argument(reader, word, index, "a colour");
    return argument && argument_color(reader, argument, quoted(reader, word), out);
}

bool word_string(Reader *reader, const Word *word, size_t index, const char **out) {
    const Argument *argument = word_argument(reader, word, index, "a string");
    if (!argument) return false;
    if (argument->value.kind != VALUE_STRING) {
        reader_mismatch(reader, argument->span, quoted(reader, word), "a string", argument->value.kind);
        return false;
    }
    *out = arena_printf(reader->context->arena, "%.*s", (int)argument->value.as.string.length,
                        argument->value.as.string.text);
    return true;
}

static void read_flag(Reader *reader, const Word *word, bool *out) {
    double value = 1;
    bool number = word->count && word->arguments[0].value.kind == VALUE_FLOAT;
    if (word_arguments(reader, word, 0, number ? 1 : 0) && (!number || word_float(reader, word, 0, &value)))
        *out = value != 0;
}

static void read_positive(Reader *reader, const Word *word, double *out) {
    double value;
    if (!word_float(reader, word, 0, &value)) return;
    if (value > 0)
        *out = value;
    else
        reader_error(reader, word->arguments[0].span, "'%s' must be greater than 0, found %g", word->text,
                     value);
}

/* A word that is skipped with its numbers may have a colour behind them that is none of its. */
static void skip_arguments(Reader *reader, const Word *word) {
    for (size_t i = 1; i < word->count; i++)
        if (word->arguments[i].value.kind == VALUE_COLOR && reader->on_value)
            reader->on_value(reader, &word->arguments[i], reader->value_target);
}

static void apply_rule(Reader *reader, const Word *word, const WordRule *rule, void *target) {
    void *field = target ? (char *)target + rule->offset : NULL; /* tables without fields have no target */
    bool scalar = rule->shape >= WORD_FLOAT && rule->shape <= WORD_COLOR;
    if (scalar && !word_arguments(reader, word, 1, 1)) return;
    switch (rule->shape) {
    case WORD_MARK:
        if (word_arguments(reader, word, 0, 0)) *(bool *)field = true;
        break;
    case WORD_FLAG: read_flag(reader, word, field); break;
    case WORD_FLOAT: word_float(reader, word, 0, field); break;
    case WORD_POSITIVE: read_positive(reader, word, field); break;
    case WORD_INT: word_int(reader, word, 0, field); break;
    case WORD_VECTOR: word_vector(reader, word, 0, field); break;
    case WORD_COLOR: word_color(reader, word, 0, field); break;
    case WORD_IGNORED:
        if (!grammar_word(reader, word)) skip_arguments(reader, word);
        break;
    case WORD_INERT:
        if (!grammar_word(reader, word)) skip_arguments(reader, word);
        inert_add(reader->context, field, rule->text, word->span);
        break;
    case WORD_CUSTOM: rule->handler(reader, word, target); break;
    }
}

/* False after an error: the word stood there before. */
static bool check_once(Reader *reader, const Word *word, const WordRule *rule) {
    for (size_t i = 0; i < reader->seen_count; i++)
        if (reader->seen[i].rule == rule) {
            Diagnostic *d = reader_error(reader, word->span, "'%s' stands twice in '%s'", word->text,
                                         reader->block->word->text);
            diag_note(reader->context->diags, d, reader->seen[i].span, "first here");
            return false;
        }
    if (reader->seen_count == reader->seen_capacity)
        arena_list_grow_(reader->context->arena, (void **)&reader->seen, &reader->seen_capacity,
                         reader->seen_count, sizeof *reader->seen);
    reader->seen[reader->seen_count].rule = rule;
    reader->seen[reader->seen_count++].span = word->span;
    return true;
}

void reader_unknown_word(Reader *reader, const Word *word) {
    bool block;
    block_builder_find(reader->context, intern_cstr(reader->context->names, word->text), &block);
    if (block && !word->body) {
        reader_error(reader, (Span){word->span.file, word->span.end, word->span.end},
                     "expected '{' after '%s'", word->text);
        return;
    }
    const char *words[256];
    size_t count = 0;
    for (size_t t = 0; t < reader->table_count; t++)
        for (size_t i = 0; i < reader->tables[t].count && count < VTS_ARRAY_COUNT(words); i++)
            words[count++] = reader->tables[t].rules[i].text;
    const char *closest = eval_suggest_name(reader->context, word->text, words, count);
    if (!closest && silently_undeclared(reader)) return;
    Diagnostic *d = reader_error(reader, word->span, "'%s' is neither declared nor a word of '%s'",
                                 word->text, reader->block->word->text);
    eval_hint_name(reader->context, d, word->text, words, count);
}

void reader_undeclared(Reader *reader, const char *name, Span span) {
    if (silently_undeclared(reader)) return;
    Diagnostic *d = reader_error(reader, span, "'%s' is not declared", name);
    eval_hint_name(reader->context, d, name, NULL, 0);
}

void reader_word(Reader *reader, const Word *word) {
    for (size_t t = 0; t < reader->table_count; t++) {
        const WordRule *rule = find_rule(&reader->tables[t], word->text);
        if (!rule) continue;
        if (t == 0) reader->met |= 1ull << (size_t)(rule - reader->tables[0].rules);
        if (!rule->once || check_once(reader, word, rule))
            apply_rule(reader, word, rule, reader->tables[t].target);
        return;
    }
    if (!reader->on_word || !reader->on_word(reader, word, reader->value_target))
        reader_unknown_word(reader, word);
}

/* More values of the kind are as wrong: `rgb 1, 0, 0` is one mistake. */
static void refuse_value(Reader *reader, const BlockItem *item) {
    reader_error(reader, item->span, "%s has no meaning here in '%s'", value_kind_text(item->value.kind),
                 reader->block->word->text);
    for (const BlockItem *next; (next = reader_peek(reader)); reader->next++)
        if (next->kind != ITEM_VALUE || next->value.kind != item->value.kind ||
            item->value.kind == VALUE_BLOCK)
            return;
}

static void read_value(Reader *reader, const BlockItem *item) {
    Argument argument = {item->value, item->span};
    if (item->value.kind == VALUE_ERROR)
        reader->failed = true;
    else if (!reader->on_value || !reader->on_value(reader, &argument, reader->value_target))
        refuse_value(reader, item);
}

static void read_objects(Reader *reader, const BlockItem *item) {
    for (size_t i = 0; i < item->objects.count; i++) {
        const Object *object = item->objects.items[i];
        const BlockItem one = {
            .kind = ITEM_VALUE, .span = object->span, .value = {.kind = VALUE_OBJECT, .as.object = object}};
        read_value(reader, &one);
    }
}

static void read_items(Reader *reader) {
    const BlockItem *item;
    while ((item = reader_peek(reader))) {
        reader->next++;
        Word word;
        if (item->kind == ITEM_ENTRY)
            reader_error(reader, item->span, "an entry [ … ] has no meaning in '%s'",
                         reader->block->word->text);
        else if (item_as_word(item, &word))
            reader_word(reader, &word);
        else if (item->kind == ITEM_OBJECTS)
            read_objects(reader, item);
        else
            read_value(reader, item);
        if (diag_full(reader->context->diags)) break;
    }
}

/* ---- what is set from outside ---- */

static const WordRule *find_rule_anywhere(const Reader *reader, const char *text) {
    const WordRule *rule = NULL;
    for (size_t t = 0; t < reader->table_count && !rule; t++) rule = find_rule(&reader->tables[t], text);
    return rule;
}

/* It takes the place of the word that stands in the block. */
static void forget_once(Reader *reader, const WordRule *rule) {
    for (size_t i = 0; i < reader->seen_count; i++)
        if (reader->seen[i].rule == rule) reader->seen[i--] = reader->seen[--reader->seen_count];
}

/* As if the block ended with the setting's words; whatever is wrong with them is so at the block's own word. */
static void apply_setting(Reader *reader, const BlockSetting *setting) {
    const EvalBlock *block = reader->block;
    BlockItem *items = arena_copy(reader->context->arena, setting->items, setting->count * sizeof *items);
    for (size_t i = 0; i < setting->count; i++) {
        Argument *arguments = arena_copy(reader->context->arena, items[i].arguments, items[i].argument_count * sizeof *arguments);
        for (size_t k = 0; k < items[i].argument_count; k++) arguments[k].span = block->word_span;
        items[i].arguments = arguments;
        items[i].span = items[i].word_span = block->word_span;
    }
    const EvalBlock words = {.word = block->word, .word_span = block->word_span, .span = block->word_span, .items = items, .count = setting->count, .outer = block->outer};
    size_t next = reader->next;
    reader->block = &words;
    reader->next = 0;
    read_items(reader);
    reader->block = block;
    reader->next = next;
    *setting->used = true;
}

static void apply_settings(Reader *reader) {
    const BuildContext *context = reader->context;
    for (size_t i = 0; i < context->setting_count && reader->block->word; i++) {
        const BlockSetting *setting = &context->settings[i];
        const WordRule *rule = strcmp(setting->block, reader->block->word->text) == 0 ? find_rule_anywhere(reader, setting->word) : NULL;
        if (!rule) continue;
        forget_once(reader, rule);
        apply_setting(reader, setting);
    }
}

bool reader_run(Reader *reader) {
    read_items(reader);
    apply_settings(reader);
    return !reader->failed;
}

bool reader_mesh_fits(Reader *reader, Span span, double vertices) {
    uint64_t most = reader->context->most_vertices;
    if (most == 0 || vertices <= (double)most) return true;
    Diagnostic *d = reader_error(reader, span, "'%s' would have more than %llu vertices", reader->block->word->text,
                                 (unsigned long long)most);
    if (d) diag_hint(reader->context->diags, d, "--limit mesh=N allows more");
    return false;
}
