/* The scene's place on the globe, and the functions that ask for it: geo(), geo_inverse(), geodesic(), utm(), sun_direction(). */
#include "eval/build_parts.h"
#include "eval/eval_function.h"

/* ---- places ---- */

/* <latitude, longitude>, or with a height; false after a report. */
static bool read_place(DiagList *diags, Span span, const Value *v, Vec3 *out) {
    if (v->kind == VALUE_ERROR) return false;
    if (v->kind != VALUE_VECTOR || v->size > 3) {
        diag_error(diags, span, "expected a place, <latitude, longitude> or <latitude, longitude, height>");
        return false;
    }
    *out = vec3(v->as.components[0], v->as.components[1], v->size > 2 ? v->as.components[2] : 0);
    if (!vec3_is_finite(*out)) {
        diag_error(diags, span, "a place on the globe needs finite numbers");
        return false;
    }
    if (fabs(out->x) <= 90) return true;
    Diagnostic *d = diag_error(diags, span, "a latitude lies between -90 and 90 degrees, found %g", out->x);
    if (fabs(out->x) <= 180 && fabs(out->y) <= 90) diag_hint(diags, d, "latitude comes first: <%g, %g>", out->y, out->x);
    return false;
}

/* ---- the scene's origin ---- */

bool geo_origin_set(BuildContext *context, const GeoOrigin *origin) {
    const GeoOrigin *old = &context->geo_origin;
    bool same = vec3_length(vec3_sub(old->place, origin->place)) == 0 && old->flat == origin->flat;
    if (old->set && !same) {
        Diagnostic *d = diag_error(context->diags, origin->span, "the scene has another origin on the globe already");
        diag_note(context->diags, d, old->span, "it was given here");
        return false;
    }
    if (!old->set) context->geo_origin = *origin;
    return true;
}

void geo_note_asked(BuildContext *context, Span span) {
    if (context->is_geo_asked) return;
    context->is_geo_asked = true;
    context->geo_asked = span;
}

void settings_read_origin(Reader *reader, const Word *word, void *target) {
    GeoOrigin origin = {.set = true, .span = word->whole};
    BuildContext *context = reader->context;
    (void)target;
    if (!word_arguments(reader, word, 1, 1) || !read_place(context->diags, word->arguments[0].span, &word->arguments[0].value, &origin.place)) return;
    origin.flat = context->geo_origin.flat;
    geo_origin_set(context, &origin);
}

/* ---- functions ---- */

static bool place_argument(Eval *ev, const Node *call, size_t index, Vec3 *out) {
    const Node *node = call->as.apply.list.items[index];
    Value v = eval_node(ev, node);
    return read_place(ev->diags, node->span, &v, out);
}

static bool point_argument(Eval *ev, const Node *call, size_t index, Vec3 *out) {
    const Node *node = call->as.apply.list.items[index];
    double c[3];
    Value v = eval_node(ev, node);
    if (v.kind == VALUE_ERROR || !value_to_vector(ev, &v, node->span, c, 3)) return false;
    *out = vec3(c[0], c[1], c[2]);
    return true;
}

static bool has_origin(Eval *ev, const Node *call) {
    if (ev->build.geo_origin.set) return true;
    const char *name = call->as.apply.base->as.name->text;
    Diagnostic *d = diag_error(ev->diags, call->span, "%s() needs the scene's place on the globe, which is not known yet", name);
    diag_hint(ev->diags, d, "write before it: global_settings { geo_origin <latitude, longitude, height> }, or a terrain");
    return false;
}

static Value ask(Eval *ev, const Node *call, const EvalGeoRequest *request) {
    const EvalGeometry *g = ev->options->geometry;
    Vec3 answer = {0};
    StrBuf error = {0};
    if (request->question != EVAL_GEODESIC && request->question != EVAL_UTM) geo_note_asked(&ev->build, call->span);
    bool ok = g && g->geo && g->geo(g->context, &ev->build.geo_origin, request, &answer, &error);
    if (!ok) diag_error(ev->diags, call->span, "%s(): %s", call->as.apply.base->as.name->text, error.size ? error.data : "not available here");
    strbuf_free(&error);
    return ok ? value_vector(ev, (double[]){answer.x, answer.y, answer.z}, 3) : value_error();
}

Value eval_geo(Eval *ev, const Node *call) {
    EvalGeoRequest request = {.question = EVAL_GEO_TO_SCENE};
    if (!has_origin(ev, call) || !place_argument(ev, call, 0, &request.a)) return value_error();
    return ask(ev, call, &request);
}

Value eval_geo_inverse(Eval *ev, const Node *call) {
    EvalGeoRequest request = {.question = EVAL_GEO_FROM_SCENE};
    if (!has_origin(ev, call) || !point_argument(ev, call, 0, &request.a)) return value_error();
    return ask(ev, call, &request);
}

Value eval_geodesic(Eval *ev, const Node *call) {
    EvalGeoRequest request = {.question = EVAL_GEODESIC};
    if (!has_origin(ev, call) || !place_argument(ev, call, 0, &request.a) || !place_argument(ev, call, 1, &request.b)) return value_error();
    return ask(ev, call, &request);
}

Value eval_utm(Eval *ev, const Node *call) {
    EvalGeoRequest request = {.question = EVAL_UTM};
    if (!has_origin(ev, call) || !place_argument(ev, call, 0, &request.a)) return value_error();
    return ask(ev, call, &request);
}

Value eval_sun_direction(Eval *ev, const Node *call) {
    EvalGeoRequest request = {.question = EVAL_SUN_DIRECTION};
    const Node *time = call->as.apply.list.items[1];
    if (!has_origin(ev, call) || !place_argument(ev, call, 0, &request.a) || !eval_string(ev, time, &request.time, NULL)) return value_error();
    return ask(ev, call, &request);
}
