#include "view.inc"
camera { orthographic location <3, 5, -6> look_at 0 right 8*x up 6*y }
