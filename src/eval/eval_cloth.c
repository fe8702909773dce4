/* Cloth at the scene's time. */
#include "eval/build_parts.h"
#include "eval/eval_state.h"

/* Springs that may be looked at for one cloth: some ten minutes. */
static const double MOST_WORK = 5e10;

bool cloth_places(const BuildContext *context, const ClothSpec *spec, Span span, Vec3 *places) {
    Eval *ev = context->eval;
    double time = ev ? ev->options->time : 0;
    if (!(cloth_work(spec) * time < MOST_WORK)) {
        diag_error(context->diags, span, "the cloth would have to be followed for %g seconds: at most %.3g with this grid", time, MOST_WORK / cloth_work(spec));
        return false;
    }
    ArenaMark mark = arena_mark(context->arena);
    bool done = net_follow_by_states(cloth_create(spec, context->arena), cloth_spec_hash(spec), ev ? ev->options->net_states : NULL, time,
                                     ev ? ev->options->interrupted : NULL, cloth_mass_count(spec), places);
    arena_reset_to(context->arena, mark);
    if (!done) {
        ev->interrupted = ev->stopped = true;
        return false;
    }
    for (size_t i = 0; i < cloth_mass_count(spec); i++)
        if (!vec3_is_finite(places[i])) {
            diag_error(context->diags, span, "this cloth goes where no numbers are: something in it is too large");
            return false;
        }
    return true;
}
