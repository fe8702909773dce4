#include "four.inc"
#include "colors.inc"
#include "stones.inc"
Four(texture { T_Stone1 scale 2 }, texture { T_Stone14 scale 2 }, texture { T_Stone24 scale 2 }, texture { T_Grnt0 scale 3 })
