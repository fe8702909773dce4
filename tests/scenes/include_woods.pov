#include "four.inc"
#include "woods.inc"
Four(texture { T_Wood1 scale 2 }, texture { T_Wood10 scale 2 }, texture { T_Wood19 scale 2 }, texture { T_Wood33 scale 2 })
