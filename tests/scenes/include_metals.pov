#include "four.inc"
#include "metals.inc"
Four(T_Copper_2B, T_Chrome_3C, T_Brass_4A, T_Silver_1B)
