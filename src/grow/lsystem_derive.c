/* Words from words: all letters at once, iteration by iteration. */
#include "base/random.h"
#include "grow/lsystem_parts.h"

#include <math.h>
#include <string.h>

enum { IDENTITY = UINT16_MAX, MOST_INPUTS = LSYSTEM_MOST_FORMALS + LSYSTEM_MOST_RANDOM };
/* Letters looked at by all iterations together: what derives longer would seem to hang. */
static const double MOST_WORK = 3e8;

typedef struct Derivation {
    const LSystem *system;
    DiagList *diags;
    const atomic_bool *interrupted;
    LSystemWord word;
    const uint32_t *partners;       /* of brackets, when anyone asks */
    int iteration;                  /* from 1 */
    double inputs[MOST_INPUTS];     /* of the tapes */
    double *scratch;
    uint64_t *letters_added;        /* by each production in this iteration */
} Derivation;

/* ---- neighbours (ABOP sec. 1.8) ---- */

static void match_brackets(const LSystemWord *word, uint32_t *partners, uint32_t *open) {
    size_t depth = 0;
    for (uint32_t i = 0; i < word->count; i++) {
        if (word->letters[i] == '[') open[depth++] = i;
        if (word->letters[i] != ']') continue;
        uint32_t from = open[--depth];
        partners[i] = from;
        partners[from] = i;
    }
}

static bool is_ignored(const Derivation *d, char letter) { return d->system->ignored[(unsigned char)letter]; }

static bool fits(const LSystemWord *word, size_t i, char letter, size_t parameter_count) {
    return word->letters[i] == letter && word->first[i + 1] - word->first[i] == parameter_count;
}

static void take_parameters(Derivation *d, size_t i, size_t to) {
    const LSystemWord *w = &d->word;
    for (uint32_t k = w->first[i]; k < w->first[i + 1]; k++) d->inputs[to++] = w->parameters[k];
}

static size_t parameters_of(const LSystemLetters *letters) {
    size_t sum = 0;
    for (size_t i = 0; i < letters->count; i++) sum += letters->parameter_counts[i];
    return sum;
}

/* Towards the root: branches beside the way are passed by, and out of a branch the way leads to what bears it. */
static bool match_left(Derivation *d, const LSystemLetters *context, size_t i) {
    size_t k = context->count, formal = parameters_of(context);
    while (k > 0) {
        do {
            if (i-- == 0) return false;
            if (d->word.letters[i] == ']') {
                i = d->partners[i];
                continue;
            }
            if (d->word.letters[i] != '[' && !is_ignored(d, d->word.letters[i])) break;
        } while (true);
        k--;
        if (!fits(&d->word, i, context->letters[k], context->parameter_counts[k])) return false;
        formal -= context->parameter_counts[k];
        take_parameters(d, i, formal);
    }
    return true;
}

/* Towards the tips, from position *i and letter *k of the context to its end or the end of its branch. Branches that the context does
 * not mention are passed by; of those that it does, any may be the one. */
static bool match_right(Derivation *d, const LSystemLetters *context, size_t *k, size_t i, size_t *formal) {
    const LSystemWord *w = &d->word;
    for (; *k < context->count; ++*k) {
        if (context->letters[*k] == ']') return true;
        bool branch = context->letters[*k] == '[', found = false;
        for (; i < w->count && !found; i++) {
            if (w->letters[i] == ']') return false;
            if (w->letters[i] == '[') {
                size_t inner = *k + 1, inner_formal = *formal;
                if (branch && match_right(d, context, &inner, i + 1, &inner_formal)) {
                    *k = inner;
                    *formal = inner_formal;
                    found = true;
                }
                i = d->partners[i];
            } else if (!is_ignored(d, w->letters[i])) {
                if (branch || !fits(w, i, context->letters[*k], context->parameter_counts[*k])) return false;
                take_parameters(d, i, *formal);
                *formal += context->parameter_counts[*k];
                found = true;
            }
        }
        if (!found) return false;
    }
    return true;
}

/* Whether the production fits the letter at i, its condition aside; the inputs are then those of its tapes. */
static bool matches(Derivation *d, const Production *p, size_t i) {
    if (!fits(&d->word, i, p->letter, (size_t)p->parameter_count)) return false;
    if (p->left.count && !match_left(d, &p->left, i)) return false;
    size_t formal = parameters_of(&p->left), k = 0;
    take_parameters(d, i, formal);
    formal += (size_t)p->parameter_count;
    if (p->right.count && !match_right(d, &p->right, &k, i + 1, &formal)) return false;
    for (int r = 0; r < p->random_count; r++)
        d->inputs[p->formal_count + r] = random_unit(random_hash(d->system->source->seed, (uint64_t)d->iteration, i, 2 + (uint64_t)r));
    return true;
}

/* ---- choice ---- */

typedef enum Fit { FIT_NOT, FIT_YES, FIT_BROKEN } Fit;

static Fit fit_of(Derivation *d, const Production *p, size_t i, double *weight) {
    double guard[2] = {1, 1};
    if (!matches(d, p, i)) return FIT_NOT;
    if (p->guard) tape_eval(p->guard, d->inputs, guard, d->scratch);
    *weight = guard[1];
    if (guard[0] == 0) return FIT_NOT; /* and what its weight would be is nobody's business */
    if (isfinite(guard[0]) && isfinite(guard[1]) && guard[1] >= 0) return FIT_YES;
    diag_error(d->diags, p->source->span, "the %s of the production \"%s\" is no finite number%s in iteration %d",
               isfinite(guard[0]) ? "weight" : "condition", p->source->text, isfinite(guard[1]) && guard[1] < 0 ? " above zero" : "", d->iteration);
    return FIT_BROKEN;
}

static int contexts_of(const Production *p) { return (p->left.count > 0) + (p->right.count > 0); }

/* Of all productions with weights that fit with as much context, one at random. */
static bool choose_weighted(Derivation *d, size_t i, uint32_t from, uint32_t to, double first_weight, uint16_t *choice) {
    const Production *all = d->system->productions;
    double sum = first_weight;
    double random = random_unit(random_hash(d->system->source->seed, (uint64_t)d->iteration, i, 1));
    *choice = (uint16_t)from;
    for (uint32_t k = from + 1; k < to; k++) {
        double weight;
        if (!all[k].weighted || contexts_of(&all[k]) != contexts_of(&all[from])) continue;
        Fit fit = fit_of(d, &all[k], i, &weight);
        if (fit == FIT_BROKEN) return false;
        if (fit == FIT_NOT || weight == 0) continue;
        /* The share of the newcomer decides whether it takes the place; what is left of the number is random again. */
        sum += weight;
        double keep = 1 - weight / sum;
        if (random >= keep) {
            *choice = (uint16_t)k;
            random = (random - keep) / (1 - keep);
        } else {
            random /= keep;
        }
    }
    if (sum == 0) *choice = IDENTITY;
    return true;
}

static bool has_production(const LSystem *s, char letter) { return s->first[(unsigned char)letter] < s->first[(unsigned char)letter + 1]; }

/* Leaves *choice alone where nothing fits. */
static bool choose(Derivation *d, size_t i, uint16_t *choice) {
    const LSystem *s = d->system;
    unsigned char letter = (unsigned char)d->word.letters[i];
    for (uint32_t k = s->first[letter]; k < s->first[letter + 1]; k++) {
        double weight;
        Fit fit = fit_of(d, &s->productions[k], i, &weight);
        if (fit == FIT_BROKEN) return false;
        if (fit == FIT_NOT) continue;
        if (s->productions[k].weighted) return choose_weighted(d, i, k, s->first[letter + 1], weight, choice);
        *choice = (uint16_t)k;
        return true;
    }
    return true;
}

/* ---- iterations ---- */

typedef struct Growth {
    size_t letters, parameters, segments;
    bool changed;
} Growth;

/* What added most letters in this iteration. */
static const LSystemText *busiest(const Derivation *d) {
    size_t worst = 0;
    for (size_t k = 1; k < d->system->production_count; k++)
        if (d->letters_added[k] > d->letters_added[worst]) worst = k;
    return d->system->production_count ? d->system->productions[worst].source : &d->system->source->axiom;
}

static bool too_large(const Derivation *d, const Growth *growth) {
    uint64_t most = d->system->source->most_segments;
    if (growth->segments <= most && growth->letters / LSYSTEM_LETTERS <= most + 4096 && growth->letters < UINT32_MAX && growth->parameters < UINT32_MAX) return false;
    const LSystemText *text = busiest(d);
    if (growth->segments > most)
        diag_error(d->diags, text->span, "the L-system grows past %llu segments in iteration %d, most of all by \"%s\"", (unsigned long long)most,
                   d->iteration, text->text);
    else
        diag_error(d->diags, text->span, "the L-system grows past %llu letters in iteration %d, most of all by \"%s\"",
                   (unsigned long long)(most * LSYSTEM_LETTERS), d->iteration, text->text);
    return true;
}

/* Which production each letter takes, and how long the next word will be. False when it is too long or something is wrong. */
static bool choose_all(Derivation *d, uint16_t *choices, Growth *growth) {
    *growth = (Growth){0};
    memset(d->letters_added, 0, (d->system->production_count + 1) * sizeof *d->letters_added);
    for (size_t i = 0; i < d->word.count; i++) {
        if ((i & 0xfff) == 0 && d->interrupted && *d->interrupted) return false;
        choices[i] = IDENTITY;
        if (has_production(d->system, d->word.letters[i]) && !choose(d, i, &choices[i])) return false;
        if (choices[i] == IDENTITY) {
            growth->letters++;
            growth->parameters += d->word.first[i + 1] - d->word.first[i];
            growth->segments += lsystem_is_segment(d->word.letters[i]);
            continue;
        }
        const Production *p = &d->system->productions[choices[i]];
        d->letters_added[choices[i]] += p->successor.count;
        growth->changed = true;
        growth->letters += p->successor.count;
        growth->parameters += p->parameter_total;
        growth->segments += p->segments;
    }
    return !too_large(d, growth);
}

/* What iterations work in; kept from one to the next, since many may change little. */
typedef struct Workspace {
    LSystemWord words[2]; /* the next, and the one after */
    size_t letter_capacity[2], parameter_capacity[2];
    uint16_t *choices;
    uint32_t *partners, *open;
    size_t capacity; /* of these three */
} Workspace;

static size_t with_reserve(size_t count) { return count + count / 2 + 16; }

static LSystemWord word_for(Workspace *space, Arena *arena, int which, const Growth *growth) {
    LSystemWord *word = &space->words[which];
    if (growth->letters >= space->letter_capacity[which]) {
        space->letter_capacity[which] = with_reserve(growth->letters);
        word->letters = arena_new_array(arena, char, space->letter_capacity[which]);
        word->first = arena_new_array(arena, uint32_t, space->letter_capacity[which] + 1);
    }
    if (growth->parameters >= space->parameter_capacity[which]) {
        space->parameter_capacity[which] = with_reserve(growth->parameters);
        word->parameters = arena_new_array(arena, double, space->parameter_capacity[which]);
    }
    word->count = 0;
    return *word;
}

static void prepare(Workspace *space, Arena *arena, Derivation *d) {
    if (d->word.count >= space->capacity) {
        space->capacity = with_reserve(d->word.count);
        space->choices = arena_new_array(arena, uint16_t, space->capacity);
        if (d->system->has_context) {
            space->partners = arena_new_array(arena, uint32_t, space->capacity);
            space->open = arena_new_array(arena, uint32_t, space->capacity);
        }
    }
    if (d->system->has_context) match_brackets(&d->word, space->partners, space->open);
    d->partners = space->partners;
}

static void push_letter(LSystemWord *word, char letter, uint32_t parameter_count) {
    word->letters[word->count] = letter;
    word->first[word->count + 1] = word->first[word->count] + parameter_count;
    word->count++;
}

static bool push_successor(Derivation *d, const Production *p, size_t i, LSystemWord *next) {
    double *values = next->parameters + next->first[next->count];
    for (size_t k = 0; k < p->successor.count; k++) push_letter(next, p->successor.letters[k], p->successor.parameter_counts[k]);
    if (!p->parameters) return true;
    matches(d, p, i);
    tape_eval(p->parameters, d->inputs, values, d->scratch);
    for (size_t k = 0; k < p->parameter_total; k++)
        if (!isfinite(values[k])) {
            diag_error(d->diags, p->source->span, "parameter %zu of what the production \"%s\" makes is no finite number in iteration %d", k + 1,
                       p->source->text, d->iteration);
            return false;
        }
    return true;
}

/* Letters from `from` to before `to` stay as they are: most do, where a long word has few buds. */
static void copy_letters(const LSystemWord *w, size_t from, size_t to, LSystemWord *next) {
    uint32_t first = next->first[next->count], shift = first - w->first[from];
    memcpy(next->letters + next->count, w->letters + from, to - from);
    if (w->first[to] > w->first[from]) memcpy(next->parameters + first, w->parameters + w->first[from], (w->first[to] - w->first[from]) * sizeof *w->parameters);
    for (size_t i = from; i < to; i++) next->first[++next->count] = w->first[i + 1] + shift;
}

static bool rewrite(Derivation *d, const uint16_t *choices, LSystemWord *next) {
    const LSystemWord *w = &d->word;
    for (size_t i = 0, from = 0; i < w->count; from = i) {
        while (i < w->count && choices[i] == IDENTITY) i++;
        if (i > from) copy_letters(w, from, i, next);
        if (i == w->count) break;
        if (!push_successor(d, &d->system->productions[choices[i]], i, next)) return false;
        i++;
    }
    return true;
}

bool lsystem_derive(const LSystem *system, Arena *arena, DiagList *diags, const atomic_bool *interrupted, LSystemWord *word) {
    Derivation d = {.system = system, .diags = diags, .interrupted = interrupted, .word = system->axiom};
    d.scratch = arena_new_array(arena, double, system->scratch + 1);
    d.letters_added = arena_new_array(arena, uint64_t, system->production_count + 1);
    Growth growth = {.letters = d.word.count};
    double work = 0;
    Workspace space = {0};
    for (size_t i = 0; i < d.word.count; i++) growth.segments += lsystem_is_segment(d.word.letters[i]);
    if (too_large(&d, &growth)) return false;
    for (d.iteration = 1; d.iteration <= system->source->iterations; d.iteration++) {
        prepare(&space, arena, &d);
        if (!choose_all(&d, space.choices, &growth)) return false;
        if (!growth.changed) break;
        work += (double)growth.letters;
        if (work > MOST_WORK) {
            const LSystemText *text = busiest(&d);
            diag_error(diags, text->span, "the L-system is still at work after %.0f letters, in iteration %d, most of all by \"%s\"", work, d.iteration,
                       text->text);
            return false;
        }
        LSystemWord next = word_for(&space, arena, d.iteration & 1, &growth);
        if (!rewrite(&d, space.choices, &next)) return false;
        d.word = next;
    }
    *word = d.word;
    return true;
}

/* ---- words as text ---- */

void lsystem_print(const LSystemWord *word, StrBuf *out) {
    for (size_t i = 0; i < word->count; i++) {
        strbuf_add(out, &word->letters[i], 1);
        for (uint32_t k = word->first[i]; k < word->first[i + 1]; k++)
            strbuf_addf(out, "%s%.12g%s", k == word->first[i] ? "(" : ",", word->parameters[k], k + 1 == word->first[i + 1] ? ")" : "");
    }
}

size_t lsystem_count(const LSystemWord *word, char letter) {
    size_t count = 0;
    for (size_t i = 0; i < word->count; i++) count += word->letters[i] == letter;
    return count;
}
