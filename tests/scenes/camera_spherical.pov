#include "view.inc"
camera { spherical location <0, 1.2, 0> look_at <0, 1.2, 3> angle 300 150 }
