#include "view.inc"
camera { cylinder 3 location <0, 1.2, 0> look_at <0, 1.1, 3> right 3*x up 2*y angle 150 }
