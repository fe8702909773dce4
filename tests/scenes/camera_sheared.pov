// A camera that is transformed, with direction, up and right of its own.
#include "view.inc"
camera { location <0, 0, -9> direction 1.6*z up <0.1, 1, 0> right <-1.3, 0, 0> rotate <20, 25, 5> translate 1*y }
