/* Cloth at the scene's time. */
#include "eval/build_parts.h"
#include "eval/eval_state.h"

/* Springs that may be looked at for one cloth: some ten minutes. */
static const double MOST_WORK = 5e10;

/* Seconds from one state that is kept on the way to the next. */
enum { STATE_SECONDS = 1 };

/* From the state that was kept, by those that are to be kept. */
static bool follow(Cloth *cloth, Hash128 key, const Eval *ev, double time, Vec3 *places) {
    const EvalClothStates *states = ev ? ev->options->cloth_states : NULL;
    const atomic_bool *interrupted = ev ? ev->options->interrupted : NULL;
    if (!states) return cloth_follow(cloth, time, interrupted, places);
    uint64_t last = cloth_tick_of(time), step = STATE_SECONDS * CLOTH_TICKS;
    states->find(states->context, key, last, cloth);
    for (uint64_t next = (cloth_tick(cloth) / step + 1) * step; next <= last; next += step) {
        if (!cloth_follow(cloth, (double)next / CLOTH_TICKS, interrupted, places)) return false;
        states->keep(states->context, key, cloth, false);
    }
    if (!cloth_follow(cloth, time, interrupted, places)) return false;
    states->keep(states->context, key, cloth, true);
    return true;
}

bool cloth_places(const BuildContext *context, const ClothSpec *spec, Span span, Vec3 *places) {
    Eval *ev = context->eval;
    double time = ev ? ev->options->time : 0;
    if (!(cloth_work(spec) * time < MOST_WORK)) {
        diag_error(context->diags, span, "the cloth would have to be followed for %g seconds: at most %.3g with this grid", time, MOST_WORK / cloth_work(spec));
        return false;
    }
    ArenaMark mark = arena_mark(context->arena);
    bool done = follow(cloth_create(spec, context->arena), cloth_spec_hash(spec), ev, time, places);
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
