#include "four.inc"
#include "golds.inc"
Four(T_Gold_1A, T_Gold_2B, T_Gold_3C, T_Gold_5D)
