/* Colour expressions. */
#include "parser/parser.h"

/* `assumed_gamma srgb`, `gamma srgb`: the name of a curve, no operand follows. */
static bool is_gamma_name(Parser *p, const Token *after) {
    if (parser_peek(p)->keyword != KW_srgb) return false;
    if (after->kind == '}' || after->kind == TOKEN_END) return true;
    if (after->kind != TOKEN_WORD) return false;
    if (!after->keyword) return context_is_item(p->block, after->as.name);
    KeywordClass class = keyword_class((Keyword)after->keyword);
    return class != KEYWORD_CONSTANT && class != KEYWORD_FUNCTION;
}

bool parser_begins_color(Parser *p) {
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_WORD || !t->keyword || keyword_class((Keyword)t->keyword) != KEYWORD_COLOR)
        return false;
    const Token *after = parser_peek_after(p);
    return after->kind != '{' && !is_gamma_name(p, after);
}

static bool is_color_component(int keyword) {
    return keyword == KW_red || keyword == KW_green || keyword == KW_blue || keyword == KW_filter ||
           keyword == KW_transmit || keyword == KW_alpha;
}

bool parser_begins_component(Parser *p) {
    const Token *t = parser_peek(p);
    if (t->kind != TOKEN_WORD || !is_color_component(t->keyword)) return false;
    const Token *after = parser_peek_after(p);
    return after->kind == TOKEN_NUMBER || after->kind == '(' || after->kind == '-' || after->kind == '.' ||
           (after->kind == TOKEN_WORD &&
            (!after->keyword || keyword_class((Keyword)after->keyword) == KEYWORD_CONSTANT ||
             keyword_class((Keyword)after->keyword) == KEYWORD_FUNCTION));
}

typedef struct ColorPartList {
    ColorPart *items;
    size_t count, capacity;
} ColorPartList;

static Node *color_parts(Parser *p, Span begin, ColorPartList parts) {
    Node *n = parser_node(p, NODE_COLOR, begin);
    bool have_base = parts.count > 0, named = have_base;
    while (!p->failed && !(parts.count && parser_directive_follows(p))) {
        const Token *t = parser_peek(p);
        int keyword = t->kind == TOKEN_WORD ? t->keyword : KW_NONE;
        if (keyword == KW_color || keyword == KW_colour) {
            if (named || parts.count) break;
            named = true;
            parser_take(p);
            continue;
        }
        if (is_color_component(keyword)) {
            parser_take(p);
        } else if (!have_base && keyword && keyword_class((Keyword)keyword) == KEYWORD_COLOR) {
            parser_take(p);
            have_base = true;
        } else if (!have_base && parts.count == 0 && parser_begins_expression(p, true)) {
            keyword = KW_color;
            have_base = true;
        } else {
            break;
        }
        Node *e = parser_expression(p);
        if (!e) return NULL;
        *list_push(p->arena, &parts) = (ColorPart){(uint16_t)keyword, e};
    }
    if (parts.count == 0 && !named)
        return parser_fail(p, parser_peek(p)->span, "expected a colour, found %s",
                           parser_found(p, parser_peek(p)));
    n->as.color.parts = parts.items;
    n->as.color.count = parts.count;
    n->span = span_join(n->span, p->last.span);
    return parser_fold(p, n);
}

/* color = { "color" | "colour" | color_word expression | component_word expression | expression }, at most one
 * expression that is not a component */
Node *parser_color(Parser *p) { return color_parts(p, parser_peek(p)->span, (ColorPartList){0}); }

Node *parser_color_from(Parser *p, Node *base) {
    ColorPartList parts = {0};
    *list_push(p->arena, &parts) = (ColorPart){KW_color, base};
    return color_parts(p, base->span, parts);
}
