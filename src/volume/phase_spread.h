/* How light that has come a way through matter with a forward peak is scattered into an angle: the peak has turned it a little many times before, and does so after. */
#ifndef VTS_VOLUME_PHASE_SPREAD_H
#define VTS_VOLUME_PHASE_SPREAD_H

#include "base/arena.h"
#include "volume/phase.h"

typedef struct PhaseSpread PhaseSpread;

/* For a phase function and what phase_without_peak() made of it; NULL where there is no peak. On the arena. */
PhaseSpread *phase_spread_make(const Phase *phase, const Phase *rest, double peak, Arena *arena);
/* By how much more (or less) light is scattered by an angle of this cosine than phase_value() says, for light that the peak turns `before` times on the mean on its way here and
 * `after` times on that to the eye, if both ways lose only what is turned by no peak. 1 without a spread (NULL). Hardly ever negative,
 * where `rest` is more than the whole. */
double phase_spread(const PhaseSpread *spread, double mu, double before, double after);

#endif
