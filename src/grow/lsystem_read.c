/* Axioms and productions from text: "left < A(l, w) > right : condition -> (weight) successor". */
#include "base/random.h"
#include "grow/lsystem_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static LSystemReader reader_of(const LSystemText *source, const char *from, const char *to, Arena *arena, DiagList *diags) {
    return (LSystemReader){source, from, to, arena, diags};
}

static bool at_end(LSystemReader *reader) {
    lsystem_skip_space(reader);
    return reader->at == reader->end;
}

/* ---- letters ---- */

typedef struct LetterList {
    char *letters;
    uint8_t *parameter_counts;
    size_t count;
} LetterList;

static LetterList letters_begin(LSystemReader *reader) {
    size_t most = (size_t)(reader->end - reader->at) + 1;
    return (LetterList){arena_new_array(reader->arena, char, most), arena_new_array(reader->arena, uint8_t, most), 0};
}

static LSystemLetters letters_end(const LetterList *list) { return (LSystemLetters){list->letters, list->parameter_counts, list->count}; }

/* One letter, any character of ASCII but those that have another meaning. */
static bool read_letter(LSystemReader *reader, char *letter) {
    if ((unsigned char)*reader->at >= 0x80) return lsystem_fail(reader, "letters are those of ASCII: there is another");
    if (strchr("(),<>:", *reader->at)) return lsystem_fail(reader, "a letter is missing");
    *letter = *reader->at++;
    return true;
}

/* A letter of the predecessor or its contexts: A or A(l, w). */
static bool read_formals(LSystemReader *reader, LetterList *list, LSystemScope *scope) {
    int before = scope->formal_count;
    if (!read_letter(reader, &list->letters[list->count])) return false;
    if (lsystem_take(reader, '(')) {
        do {
            if (scope->formal_count == LSYSTEM_MOST_FORMALS || scope->formal_count - before == LSYSTEM_MOST_PARAMETERS)
                return lsystem_fail(reader, "there are too many parameters");
            const char *name = lsystem_name(reader);
            if (!name) return lsystem_fail(reader, "the name of a parameter is missing");
            scope->formals[scope->formal_count++] = name;
        } while (lsystem_take(reader, ','));
        if (!lsystem_take(reader, ')')) return lsystem_fail(reader, "a ')' is missing");
    }
    list->parameter_counts[list->count++] = (uint8_t)(scope->formal_count - before);
    return true;
}

static bool read_context(LSystemReader *reader, LSystemScope *scope, LSystemLetters *out) {
    LetterList list = letters_begin(reader);
    while (!at_end(reader))
        if (!read_formals(reader, &list, scope)) return false;
    if (!list.count) return lsystem_fail(reader, "a context is missing");
    *out = letters_end(&list);
    return true;
}

/* Values of a tape while it is being built. */
typedef struct RefList {
    TapeRef *items;
    size_t count, capacity;
} RefList;

/* Letters whose parameters are expressions: a successor or an axiom. */
static bool read_word(LSystemReader *reader, LSystemScope *scope, TapeBuilder *tape, LSystemLetters *out, RefList *parameters) {
    LetterList list = letters_begin(reader);
    while (!at_end(reader)) {
        if (!read_letter(reader, &list.letters[list.count])) return false;
        size_t before = parameters->count;
        if (reader->at < reader->end && *reader->at == '(') {
            reader->at++;
            do {
                TapeRef value;
                if (parameters->count - before == LSYSTEM_MOST_PARAMETERS) return lsystem_fail(reader, "there are too many parameters");
                if (!lsystem_expression(reader, scope, tape, &value)) return false;
                *list_push(reader->arena, parameters) = value;
            } while (lsystem_take(reader, ','));
            if (!lsystem_take(reader, ')')) return lsystem_fail(reader, "a ')' is missing");
        }
        list.parameter_counts[list.count++] = (uint8_t)(parameters->count - before);
    }
    *out = letters_end(&list);
    return true;
}

/* A '[' without its ']', or the other way round, leaves the turtle no way back. */
static bool check_brackets(LSystemReader *reader, const LSystemLetters *word) {
    int open = 0;
    for (size_t i = 0; i < word->count && open >= 0; i++) open += (word->letters[i] == '[') - (word->letters[i] == ']');
    if (open == 0) return true;
    diag_error(reader->diags, reader->source->span, "the brackets of \"%s\" do not match", reader->source->text);
    return false;
}

/* ---- productions ---- */

/* The first of the texts outside of parentheses; NULL: none. */
static const char *find_outside(const char *from, const char *to, const char *text) {
    int depth = 0;
    size_t length = strlen(text);
    for (const char *p = from; p + length <= to; p++) {
        depth += (*p == '(') - (*p == ')');
        if (depth == 0 && memcmp(p, text, length) == 0) return p;
    }
    return NULL;
}

typedef struct ProductionReader {
    LSystem *system;
    Arena *arena;
    DiagList *diags;
    const LSystemText *source;
    LSystemScope scope;
} ProductionReader;

static bool read_predecessor(ProductionReader *r, const char *from, const char *to, Production *out) {
    const char *less = find_outside(from, to, "<"), *more = find_outside(less ? less + 1 : from, to, ">");
    LSystemReader left = reader_of(r->source, from, less ? less : from, r->arena, r->diags);
    LSystemReader own = reader_of(r->source, less ? less + 1 : from, more ? more : to, r->arena, r->diags);
    LSystemReader right = reader_of(r->source, more ? more + 1 : to, to, r->arena, r->diags);
    if (less && !read_context(&left, &r->scope, &out->left)) return false;
    LetterList letter = letters_begin(&own);
    if (at_end(&own)) return lsystem_fail(&own, "the letter to be replaced is missing");
    if (!read_formals(&own, &letter, &r->scope)) return false;
    if (!at_end(&own)) return lsystem_fail(&own, "only one letter can be replaced: there is another");
    out->letter = letter.letters[0];
    out->parameter_count = letter.parameter_counts[0];
    if (out->letter == '[' || out->letter == ']') return lsystem_fail(&own, "brackets cannot be replaced");
    return !more || read_context(&right, &r->scope, &out->right);
}

/* Condition and weight: "*" is always true. */
static bool read_guard(ProductionReader *r, const char *from, const char *to, LSystemReader *successor, Production *out) {
    LSystemReader condition = reader_of(r->source, from, to, r->arena, r->diags);
    LSystemScope scope = r->scope;
    TapeBuilder *tape = tape_builder_create(r->arena, scope.formal_count + LSYSTEM_MOST_RANDOM);
    TapeRef outputs[2] = {tape_constant(tape, 1), tape_constant(tape, 1)};
    bool conditional = !at_end(&condition) && !lsystem_take(&condition, '*');
    if (conditional && !lsystem_expression(&condition, &scope, tape, &outputs[0])) return false;
    if (!at_end(&condition)) return lsystem_fail(&condition, "the condition ends");
    out->weighted = lsystem_take(successor, '(');
    if (out->weighted) {
        if (!lsystem_expression(successor, &scope, tape, &outputs[1])) return false;
        if (!lsystem_take(successor, ')')) return lsystem_fail(successor, "a ')' is missing");
    }
    if (conditional || out->weighted) out->guard = tape_finish(tape, outputs, 2);
    out->random_count = scope.random_count;
    return true;
}

static bool read_production(ProductionReader *r, Production *out) {
    const char *text = r->source->text, *end = text + strlen(text), *arrow = find_outside(text, end, "->");
    r->scope.formal_count = r->scope.random_count = 0;
    *out = (Production){.source = r->source};
    if (!arrow) {
        Diagnostic *d = diag_error(r->diags, r->source->span, "the production \"%s\" has no arrow", text);
        diag_hint(r->diags, d, "productions are written \"A -> AB\"");
        return false;
    }
    const char *colon = find_outside(text, arrow, ":");
    LSystemReader successor = reader_of(r->source, arrow + 2, end, r->arena, r->diags);
    if (!read_predecessor(r, text, colon ? colon : arrow, out)) return false;
    if (!read_guard(r, colon ? colon + 1 : arrow, arrow, &successor, out)) return false;
    RefList parameters = {0};
    out->formal_count = r->scope.formal_count;
    TapeBuilder *tape = tape_builder_create(r->arena, out->formal_count + LSYSTEM_MOST_RANDOM);
    if (!read_word(&successor, &r->scope, tape, &out->successor, &parameters) || !check_brackets(&successor, &out->successor)) return false;
    out->random_count = int_max(out->random_count, r->scope.random_count);
    out->parameter_total = parameters.count;
    if (parameters.count > INT32_MAX) return lsystem_fail(&successor, "there are too many parameters");
    if (parameters.count) out->parameters = tape_finish(tape, parameters.items, (int)parameters.count);
    for (size_t i = 0; i < out->successor.count; i++) out->segments += lsystem_is_segment(out->successor.letters[i]);
    return true;
}

/* ---- the system ---- */

static int contexts_of(const Production *p) { return (p->left.count > 0) + (p->right.count > 0); }

/* By letter; of one letter those with more context first (ABOP p. 30), else as they stand in the text. */
static void sort_productions(LSystem *system, const Production *unsorted, Arena *arena) {
    system->productions = arena_new_array(arena, Production, system->production_count + 1);
    uint32_t count = 0;
    for (int letter = 0; letter < 256; letter++) {
        system->first[letter] = count;
        for (int contexts = 2; contexts >= 0; contexts--)
            for (size_t i = 0; i < system->production_count; i++)
                if ((unsigned char)unsorted[i].letter == letter && contexts_of(&unsorted[i]) == contexts) system->productions[count++] = unsorted[i];
    }
    system->first[256] = count;
}

static void measure(LSystem *system, const Production *p) {
    const Tape *tapes[2] = {p->guard, p->parameters};
    for (int i = 0; i < 2; i++)
        if (tapes[i] && tape_scratch_size(tapes[i]) > system->scratch) system->scratch = tape_scratch_size(tapes[i]);
    if (contexts_of(p)) system->has_context = true;
}

static bool read_axiom(ProductionReader *r, LSystemWord *word) {
    const LSystemText *text = &r->system->source->axiom;
    LSystemReader reader = reader_of(text, text->text, text->text + strlen(text->text), r->arena, r->diags);
    TapeBuilder *tape = tape_builder_create(r->arena, LSYSTEM_MOST_RANDOM);
    LSystemLetters letters;
    RefList parameters = {0};
    r->scope.formal_count = r->scope.random_count = 0;
    if (!read_word(&reader, &r->scope, tape, &letters, &parameters) || !check_brackets(&reader, &letters)) return false;
    *word = (LSystemWord){arena_new_array(r->arena, char, letters.count + 1), arena_new_array(r->arena, uint32_t, letters.count + 1),
                          arena_new_array(r->arena, double, parameters.count + 1), letters.count};
    for (size_t i = 0; i < letters.count; i++) {
        word->letters[i] = letters.letters[i];
        word->first[i + 1] = word->first[i] + letters.parameter_counts[i];
    }
    if (!parameters.count) return true;
    double random[LSYSTEM_MOST_RANDOM];
    for (int i = 0; i < LSYSTEM_MOST_RANDOM; i++) random[i] = random_unit(random_hash(r->system->source->seed, 0, (uint64_t)i, 2));
    const Tape *values = tape_finish(tape, parameters.items, (int)parameters.count);
    tape_eval_once(values, random, word->parameters);
    for (size_t i = 0; i < parameters.count; i++)
        if (!isfinite(word->parameters[i])) {
            diag_error(r->diags, text->span, "a parameter of the axiom \"%s\" is no finite number", text->text);
            return false;
        }
    return true;
}

LSystem *lsystem_read(const LSystemSource *source, Arena *arena, DiagList *diags) {
    LSystem *system = arena_new(arena, LSystem);
    *system = (LSystem){.source = source, .production_count = source->rule_count};
    ProductionReader r = {system, arena, diags, NULL, {.constants = source->constants, .constant_count = source->constant_count}};
    Production *unsorted = arena_new_array(arena, Production, source->rule_count + 1);
    bool done = read_axiom(&r, &system->axiom);
    for (size_t i = 0; i < source->rule_count; i++) {
        r.source = &source->rules[i];
        if (read_production(&r, &unsorted[i])) measure(system, &unsorted[i]);
        else done = false;
    }
    if (!done) return NULL;
    for (const char *p = source->ignored; p && *p; p++) system->ignored[(unsigned char)*p] = true;
    sort_productions(system, unsorted, arena);
    return system;
}
