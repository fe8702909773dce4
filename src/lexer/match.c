#include "lexer/match.h"

/* Each branch of a group is taken to have the same effect on the brackets around it: that of the first branch. Brackets left
 * open by it become phantoms on the stack after #end; brackets that it closes lose their match. */
typedef struct Open {
    uint32_t index;     /* of the token; phantoms: UINT32_MAX */
    uint8_t kind;       /* '(' '[' '{' or '#' for a group */
    uint32_t last;      /* group: its latest directive, whose match comes next */
    uint32_t closed;    /* group: brackets of the surroundings that its first branch closes */
    uint32_t left_open; /* group: brackets that its first branch leaves open */
    uint32_t branch;    /* group: number of the branch */
} Open;

typedef struct Matcher {
    Token *tokens;
    Arena *arena;
    Open *items;
    size_t count, capacity;
    bool balanced;
} Matcher;

static const uint32_t PHANTOM = UINT32_MAX;

static void open_one(Matcher *m, uint32_t index, uint8_t kind) {
    *list_push(m->arena, m) = (Open){.index = index, .kind = kind, .last = index};
}

static bool has_group(const Matcher *m) {
    for (size_t i = m->count; i > 0; i--)
        if (m->items[i - 1].kind == '#') return true;
    return false;
}

/* Drops the brackets that the current branch left open; the group is then on top. */
static void end_branch(Matcher *m) {
    uint32_t left = 0;
    while (m->items[m->count - 1].kind != '#') {
        m->count--;
        left++;
    }
    Open *group = &m->items[m->count - 1];
    if (left) m->tokens[group->index].unbalanced = true;
    if (group->branch == 0) group->left_open = left;
    group->branch++;
}

static void continue_group(Matcher *m, uint32_t index) {
    if (!has_group(m)) {
        m->balanced = false;
        return;
    }
    end_branch(m);
    Open *group = &m->items[m->count - 1];
    m->tokens[group->last].match = index;
    group->last = index;
}

static void end_group(Matcher *m, uint32_t index) {
    continue_group(m, index);
    if (!has_group(m)) return;
    Open group = m->items[--m->count];
    if (m->tokens[group.index].keyword == KW_macro) return;
    for (uint32_t i = 0; i < group.closed && m->count && m->items[m->count - 1].kind != '#'; i++) m->count--;
    for (uint32_t i = 0; i < group.left_open; i++) open_one(m, PHANTOM, '{');
}

static uint8_t opener_of(uint8_t closer) { return closer == ')' ? '(' : closer == ']' ? '[' : '{'; }

static void close_one(Matcher *m, uint32_t index) {
    Open *top = m->count ? &m->items[m->count - 1] : NULL;
    if (!top) {
        m->balanced = false;
    } else if (top->kind == '#') {
        m->tokens[top->index].unbalanced = true;
        if (top->branch == 0) top->closed++;
    } else if (top->index == PHANTOM) {
        m->count--;
    } else if (top->kind == opener_of(m->tokens[index].kind)) {
        m->tokens[top->index].match = index;
        m->count--;
    } else {
        m->count--; /* a mismatch: the parser will say so where it reads it */
        m->balanced = false;
    }
}

static void match_directive(Matcher *m, uint32_t index) {
    switch (m->tokens[index].keyword) {
    case KW_if:
    case KW_ifdef:
    case KW_ifndef:
    case KW_while:
    case KW_for:
    case KW_switch:
    case KW_macro: open_one(m, index, '#'); break;
    case KW_else:
    case KW_elseif:
    case KW_case:
    case KW_range: continue_group(m, index); break;
    case KW_end: end_group(m, index); break;
    default: break;
    }
}

/* Groups without #end go on to the end of the file, where that is said. */
static void end_all(Matcher *m, uint32_t end) {
    while (has_group(m)) end_group(m, end);
}

bool token_match(Token *tokens, uint32_t count, Arena *arena) {
    Matcher m = {.tokens = tokens, .arena = arena, .balanced = true};
    for (uint32_t i = 0; i < count; i++) {
        uint8_t kind = tokens[i].kind;
        if (kind == TOKEN_DIRECTIVE)
            match_directive(&m, i);
        else if (kind == '(' || kind == '[' || kind == '{')
            open_one(&m, i, kind);
        else if (kind == ')' || kind == ']' || kind == '}')
            close_one(&m, i);
    }
    bool closed = m.balanced && m.count == 0;
    end_all(&m, count - 1);
    return closed;
}
